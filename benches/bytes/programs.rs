//! Programs of ratatui on both backends: what each sends, and whether the screens are equal.

use crate::scenes::{FRAMES, Kind, Sequence};
use crate::table;
use ratatui::backend::Backend;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Map, MapResolution, Rectangle};
use ratatui::widgets::{
    Axis, BarChart, Block, Chart, Dataset, Gauge, LineGauge, List, ListItem, ListState, Paragraph, Sparkline, Tabs,
    Wrap,
};
use ratatui::{Frame, Terminal, TerminalOptions, Viewport};
use ratatui_crossterm::CrosstermBackend;
use std::cell::RefCell;
use std::fmt::Debug;
use std::io::{self, Write};
use std::num::NonZeroU16;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{Encoder, EncoderBackend, Order, Picture, Quality, Size};

/// The columns beside the list.
const LIST: u16 = 24;

/// A function that draws the step of a program.
type Draw<'a> = &'a dyn Fn(&mut Frame<'_>, usize);

/// A line with an emulator at its end.
#[derive(Clone)]
struct Wire(Rc<RefCell<(vt100::Parser, usize)>>);

impl Wire {
    fn new(size: Size) -> Self {
        let side = |length| NonZeroU16::new(length).expect("a screen has cells");
        Self(Rc::new(RefCell::new((vt100::Parser::new(side(size.rows), side(size.columns), 0), 0))))
    }

    /// Returns the look of each cell: of a blank its background, of a half block both colours.
    fn cells(&self, size: Size) -> Vec<String> {
        let places = (0..size.rows).flat_map(|row| (0..size.columns).map(move |column| (row, column)));
        let line = self.0.borrow();
        let shown = |(row, column)| {
            let cell = line.0.screen().cell(row, column).expect("the cell is on the screen");
            let (fg, bg) = (cell.fgcolor(), cell.bgcolor());
            let (fg, bg) = if cell.inverse() { (bg, fg) } else { (fg, bg) };
            let halves = match cell.contents() {
                "" | " " => Some([bg, bg]),
                "▄" => Some([bg, fg]),
                "▀" => Some([fg, bg]),
                _ => None,
            };
            if let Some(halves) = halves
                && !cell.underline()
            {
                return format!("{halves:?}");
            }
            let looks = [cell.bold(), cell.dim(), cell.italic(), cell.underline(), cell.inverse()];
            format!("{} {:?} {:?} {looks:?}", cell.contents(), cell.fgcolor(), cell.bgcolor())
        };
        places.map(shown).collect()
    }
}

impl Write for Wire {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (parser, count) = &mut *self.0.borrow_mut();
        parser.process(bytes);
        *count += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The bytes of a program's frames, and every tenth screen.
struct Run {
    bytes: usize,
    screens: Vec<Vec<String>>,
}

fn run<B: Backend>(mut terminal: Terminal<B>, line: &Wire, size: Size, step: &AtomicU32, draw: Draw<'_>) -> Run
where
    B::Error: Debug,
{
    let mut screens = Vec::new();
    for frame in 0..FRAMES {
        step.store(frame as u32, Ordering::Relaxed);
        terminal.draw(|to| draw(to, frame)).expect("an emulator takes everything");
        if frame % 10 == 9 {
            screens.push(line.cells(size));
        }
    }
    let bytes = line.0.borrow().1;
    Run { bytes, screens }
}

fn ratatui(size: Size, draw: Draw<'_>) -> Run {
    let line = Wire::new(size);
    // Only so does it not ask the terminal that it is not on.
    let viewport = Viewport::Fixed(Rect::new(0, 0, size.columns, size.rows));
    let terminal = Terminal::with_options(CrosstermBackend::new(line.clone()), TerminalOptions { viewport });
    run(terminal.expect("an emulator takes everything"), &line, size, &AtomicU32::new(0), draw)
}

/// A way to send a program's frames.
#[derive(Clone, Copy)]
struct Way {
    name: &'static str,
    order: Order,
    half_blocks: HalfBlocks,
    quality: Quality,
}

const WAYS: [Way; 5] = [
    Way { name: "`raster`", order: Order::Raster, half_blocks: HalfBlocks::Lower, quality: Quality::Exact },
    Way { name: "`color`", order: Order::Color, half_blocks: HalfBlocks::Lower, quality: Quality::Exact },
    Way { name: "`color`, either half", order: Order::Color, half_blocks: HalfBlocks::Either, quality: Quality::Exact },
    Way { name: "`equal`", order: Order::Color, half_blocks: HalfBlocks::Lower, quality: Quality::Equal },
    Way { name: "`equal`, either half", order: Order::Color, half_blocks: HalfBlocks::Either, quality: Quality::Equal },
];

/// The number of exact ways, which come first.
const EXACT: usize = 3;

fn ours(size: Size, way: Way, draw: Draw<'_>) -> Run {
    let (line, step) = (Wire::new(size), Arc::new(AtomicU32::new(0)));
    let clock = Arc::clone(&step);
    let backend = EncoderBackend::new(line.clone(), (size.columns, size.rows))
        .with_encoder(Encoder::new().with_order(way.order).with_half_blocks(way.half_blocks))
        .with_quality(way.quality, move || Duration::from_secs(1) / 30 * clock.load(Ordering::Relaxed));
    run(Terminal::new(backend).expect("an emulator takes everything"), &line, size, &step, draw)
}

/// The bytes of a program, over those by ratatui's own backend.
struct Measured {
    size: Size,
    ratatui: usize,
    /// The bytes of each of [`WAYS`], over ratatui's.
    ways: [f64; WAYS.len()],
    /// The limits of these figures.
    wanted: [f64; WAYS.len()],
    is_equal: bool,
}

fn measure(size: Size, wanted: [f64; WAYS.len()], draw: Draw<'_>) -> Measured {
    let theirs = ratatui(size, draw);
    let runs = WAYS.map(|way| ours(size, way, draw));
    Measured {
        size,
        wanted,
        is_equal: runs[..EXACT].iter().all(|run| run.screens == theirs.screens),
        ways: runs.map(|run| run.bytes as f64 / theirs.bytes as f64),
        ratatui: theirs.bytes,
    }
}

/// Measures the programs at some sizes, and prints a table of each.
pub(crate) fn print(is_test: bool) {
    let sizes: &[(Size, f64)] = &[(Size::new(80, 24), 0.69), (Size::new(120, 40), 0.63), (Size::new(200, 60), 0.56)];
    let sizes = if is_test { &sizes[..1] } else { sizes };
    let demos: Vec<_> = sizes.iter().map(|&(size, wanted)| measure(size, [wanted; WAYS.len()], &demo)).collect();
    print_table("a dashboard", &demos);
    let panes: Vec<_> = sizes.iter().map(|&(size, _)| measure_pane(size)).collect();
    print_table("a list and a turning pane", &panes);
}

fn print_table(name: &str, programs: &[Measured]) {
    let sizes: Vec<String> =
        programs.iter().map(|program| format!("{}x{}", program.size.columns, program.size.rows)).collect();
    println!("\n| {name}: bytes, of ratatui's (wanted) | {} |", sizes.join(" | "));
    println!("|---|{}", "--:|".repeat(programs.len()));
    let row = |name: &str, value: &dyn Fn(&Measured) -> String| {
        println!("| {name} | {} |", programs.iter().map(value).collect::<Vec<_>>().join(" | "));
    };
    row("ratatui, bytes a frame", &|program| (program.ratatui / FRAMES).to_string());
    for (at, way) in WAYS.iter().enumerate() {
        row(way.name, &|program| table::limited(program.ways[at], program.wanted[at]));
    }
    row("screens equal, cell by cell", &|program| table::yes(program.is_equal));
}

/// A picture that turns beside a list, as a widget would draw it.
fn measure_pane(size: Size) -> Measured {
    let pane = Size::new(size.columns - LIST, size.rows);
    let sequence = Sequence::of(Kind::Orbit);
    let pictures: Vec<Picture> = (0..FRAMES).map(|frame| sequence.frame(frame, pane)).collect();
    let draw = |frame: &mut Frame<'_>, step: usize| {
        let [left, right] = Layout::horizontal([Constraint::Length(LIST), Constraint::Fill(1)]).areas(frame.area());
        let list =
            List::new((0..12).map(|number| format!("object {number}"))).block(Block::bordered().title("Objects"));
        let mut state = ListState::default().with_selected(Some(step / 30));
        frame.render_stateful_widget(list.highlight_style(Modifier::REVERSED), left, &mut state);
        let pixel = |column: u16, row: usize| {
            let pixel = pictures[step].pixels()[row * usize::from(pane.columns) + usize::from(column)];
            Color::Rgb(pixel.r, pixel.g, pixel.b)
        };
        for at in right.positions() {
            let (column, row) = (at.x - right.x, 2 * usize::from(at.y - right.y));
            let (upper, lower) = (pixel(column, row), pixel(column, row + 1));
            let cell = &mut frame.buffer_mut()[at];
            if upper == lower {
                cell.set_symbol(" ").set_bg(upper);
            } else {
                cell.set_symbol("▄").set_bg(upper).set_fg(lower);
            }
        }
    };
    measure(size, [f64::INFINITY, 0.70, 0.70, 0.40, 0.40], &draw)
}

/// Draws a dashboard that moves: gauges, a sparkline, lists, charts, a map, styled text.
fn demo(frame: &mut Frame<'_>, step: usize) {
    let rows = [Constraint::Length(3), Constraint::Length(8), Constraint::Fill(1), Constraint::Length(4)];
    let [top, gauges, middle, bottom] = Layout::vertical(rows).areas(frame.area());
    let tabs = Tabs::new(["Graphs", "Servers", "Colours"]).select(step / 40 % 3).highlight_style(Color::Yellow);
    frame.render_widget(tabs.block(Block::bordered().title("Dashboard")).fg(Color::Green), top);
    draw_gauges(frame, gauges, step);
    let widths = [Constraint::Percentage(30), Constraint::Percentage(40), Constraint::Fill(1)];
    let [left, centre, right] = Layout::horizontal(widths).areas(middle);
    draw_log(frame, left, step);
    draw_chart(frame, centre, step);
    draw_map(frame, right, step);
    let text = vec![
        Line::from(vec!["plain, ".into(), "underlined".underlined(), ", ".into(), "struck".crossed_out().red()]),
        Line::from(vec![format!("step {step} ").bold(), "dim ".dim(), "of 256".fg(Color::Indexed(200))]),
    ];
    frame.render_widget(Paragraph::new(text).block(Block::bordered().title("Text")).wrap(Wrap { trim: true }), bottom);
}

fn draw_gauges(frame: &mut Frame<'_>, area: Rect, step: usize) {
    let rows = [Constraint::Length(2), Constraint::Length(4), Constraint::Length(2)];
    let [top, middle, bottom] = Layout::vertical(rows).areas(area);
    let ratio = (step % 100) as f64 / 100.0;
    let style = Style::new().magenta().on_black().italic().bold();
    let gauge = Gauge::default().block(Block::new().title("Gauge:")).gauge_style(style).use_unicode(true);
    frame.render_widget(gauge.label(format!("{:.2}%", 100.0 * ratio)).ratio(ratio), top);
    let points: Vec<u64> = (0..middle.width).map(|at| noise(usize::from(at) + step)).collect();
    let line = Sparkline::default().block(Block::new().title("Sparkline:")).style(Color::Green).data(points);
    frame.render_widget(line, middle);
    let line = LineGauge::default().block(Block::new().title("LineGauge:")).filled_style(Color::Magenta).ratio(ratio);
    frame.render_widget(line, bottom);
}

/// Numbers below 100 in no visible order.
fn noise(at: usize) -> u64 {
    (at * 7_919 % 97) as u64
}

fn draw_log(frame: &mut Frame<'_>, area: Rect, step: usize) {
    let [top, bottom] = Layout::vertical([Constraint::Fill(1), Constraint::Fill(1)]).areas(area);
    let levels = [("INFO", Color::Blue), ("WARNING", Color::Yellow), ("ERROR", Color::Red)];
    let items = (0..usize::from(top.height)).map(|row| {
        let event = row + step / 5;
        let (level, color) = levels[event % 3];
        ListItem::new(Line::from(vec![Span::styled(format!("{level:<9}"), color), format!("Event{event}").into()]))
    });
    let mut state = ListState::default().with_selected(Some(step / 7 % 8));
    let list = List::new(items).block(Block::bordered().title("Log")).highlight_style(Modifier::BOLD);
    frame.render_stateful_widget(list.highlight_symbol("> "), top, &mut state);
    let bars: Vec<(String, u64)> = (0..9).map(|bar| (format!("B{bar}"), noise(bar + step / 4))).collect();
    let bars: Vec<(&str, u64)> = bars.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    let chart = BarChart::default().block(Block::bordered().title("Bars")).data(&bars).bar_width(3).bar_gap(1);
    frame.render_widget(chart.value_style(Style::new().black().on_green().italic()).bar_style(Color::Green), bottom);
}

fn draw_chart(frame: &mut Frame<'_>, area: Rect, step: usize) {
    let wave = |stretch: f64, height: f64| -> Vec<(f64, f64)> {
        let at = |point: u32| f64::from(point) * 0.2;
        (0..200).map(|point| (at(point), libm::sin((at(point) + step as f64 * 0.2) / stretch) * height)).collect()
    };
    let (slow, fast) = (wave(3.0, 18.0), wave(2.0, 10.0));
    let sets = vec![
        Dataset::default().name("data2").marker(Marker::Dot).cyan().data(&slow),
        Dataset::default().name("data3").marker(Marker::Braille).yellow().data(&fast),
    ];
    let axis = |title: &'static str, labels: [&'static str; 3]| Axis::default().title(title).gray().labels(labels);
    let chart = Chart::new(sets).block(Block::bordered().title("Chart".cyan().bold()));
    let x_axis = axis("X Axis", ["0", "20", "40"]).bounds([0.0, 40.0]);
    frame.render_widget(chart.x_axis(x_axis).y_axis(axis("Y Axis", ["-20", "0", "20"]).bounds([-20.0, 20.0])), area);
}

fn draw_map(frame: &mut Frame<'_>, area: Rect, step: usize) {
    let canvas = Canvas::default().block(Block::bordered().title("World")).marker(Marker::Dot);
    let canvas = canvas.x_bounds([-180.0, 180.0]).y_bounds([-90.0, 90.0]).paint(|context| {
        context.draw(&Map { color: Color::White, resolution: MapResolution::High });
        context.layer();
        let x = (step % 100) as f64;
        context.draw(&Rectangle { x, y: 30.0, width: 10.0, height: 10.0, color: Color::Yellow });
    });
    frame.render_widget(canvas, area);
}
