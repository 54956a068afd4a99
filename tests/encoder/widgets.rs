//! All of ratatui's widgets, frame by frame, through our backend and ratatui's own: equal screens.

use super::backend::{Pair, Strict, Wire, assert_bracketed, commonly_known};
use super::screens::Clusters;
use ratatui::Frame;
use ratatui::Viewport;
use ratatui::layout::{Constraint, Size};
use ratatui::style::{Color, Modifier, Style, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::calendar::{CalendarEventStore, Monthly};
use ratatui::widgets::canvas::{Canvas, Circle, Map, MapResolution, Points, Rectangle};
use ratatui::widgets::{
    Axis, Bar, BarChart, BarGroup, Block, BorderType, Cell, Chart, Clear, Dataset, Fill, Gauge, GraphType, LineGauge,
    List, ListItem, ListState, MascotEyeColor, Padding, Paragraph, RatatuiLogo, RatatuiLogoSize, RatatuiMascot, Row,
    Scrollbar, ScrollbarOrientation, ScrollbarState, Sparkline, Table, TableState, Tabs, Wrap,
};
use termtrace::{Encoder, Order};
use time::{Date, Month};

const SIZE: Size = Size::new(40, 12);

/// A widget at some time.
type Draw = fn(&mut Frame<'_>, u8);

const WIDGETS: &[(&str, Draw)] = &[
    ("BarChart", bar_chart),
    ("Block", block),
    ("Canvas", canvas),
    ("Chart", chart),
    ("Clear", clear),
    ("Fill", fill),
    ("Gauge", gauge),
    ("LineGauge", line_gauge),
    ("List", list),
    ("Monthly", monthly),
    ("Paragraph", paragraph),
    ("RatatuiLogo", logo),
    ("RatatuiMascot", mascot),
    ("Scrollbar", scrollbar),
    ("Sparkline", sparkline),
    ("Table", table),
    ("Tabs", tabs),
];

fn bar_chart(frame: &mut Frame<'_>, time: u8) {
    let bars: Vec<Bar<'_>> =
        (0..6).map(|k| Bar::with_label(format!("b{k}"), value(time, k)).fg(Color::Indexed(k))).collect();
    let chart = BarChart::default().data(BarGroup::default().bars(&bars)).bar_width(4).max(100);
    frame.render_widget(chart.value_style(Style::new().black().on_green()), frame.area());
}

/// Returns a number from 0 to 100, another for each time.
fn value(time: u8, k: u8) -> u64 {
    u64::from(time.wrapping_mul(37).wrapping_add(k.wrapping_mul(59)) % 101)
}

fn block(frame: &mut Frame<'_>, time: u8) {
    let borders =
        [BorderType::Plain, BorderType::Rounded, BorderType::Double, BorderType::Thick, BorderType::QuadrantInside];
    let block = Block::bordered()
        .border_type(borders[usize::from(time) % borders.len()])
        .border_style(Style::new().fg(Color::Indexed(time)).add_modifier(Modifier::CROSSED_OUT))
        .title_top(Line::from(format!(" 世界 {time} ")).bold().centered())
        .title_bottom(Line::from("below").italic().right_aligned())
        .padding(Padding::uniform(1));
    let inside = block.inner(frame.area());
    frame.render_widget(block, frame.area());
    frame.render_widget(Block::new().on_light_blue(), inside);
}

fn canvas(frame: &mut Frame<'_>, time: u8) {
    let markers = [Marker::Dot, Marker::Block, Marker::Bar, Marker::Braille, Marker::HalfBlock];
    let at = f64::from(time);
    let canvas = Canvas::default().marker(markers[usize::from(time) % markers.len()]);
    let canvas = canvas.x_bounds([-180.0, 180.0]).y_bounds([-90.0, 90.0]).paint(|context| {
        context.draw(&Map { resolution: MapResolution::Low, color: Color::Green });
        context.layer();
        context.draw(&Rectangle { x: -100.0 + 9.0 * at, y: -40.0, width: 90.0, height: 60.0, color: Color::Yellow });
        context.draw(&Circle { x: 20.0, y: at, radius: 40.0, color: Color::Rgb(200, 10, 99) });
        context.draw(&Points { coords: &[(1.0, 1.0), (90.0, at)], color: Color::White });
        context.print(at, at, "here".red());
    });
    frame.render_widget(canvas, frame.area());
}

fn chart(frame: &mut Frame<'_>, time: u8) {
    let points = |k: u8| (0..20).map(|x| (f64::from(x), value(time.wrapping_add(x), k) as f64)).collect::<Vec<_>>();
    let (a, b) = (points(1), points(2));
    let sets = vec![
        Dataset::default().name("a").marker(Marker::Braille).graph_type(GraphType::Line).cyan().data(&a),
        Dataset::default().name("b").marker(Marker::Dot).graph_type(GraphType::Bar).magenta().data(&b),
    ];
    let axis = |end: f64| Axis::default().bounds([0.0, end]).labels(["0".bold(), Span::from(end.to_string())]);
    frame.render_widget(Chart::new(sets).x_axis(axis(20.0).title("x")).y_axis(axis(100.0).gray()), frame.area());
}

/// A window over text, now and then.
fn clear(frame: &mut Frame<'_>, time: u8) {
    paragraph(frame, 0);
    if time % 2 == 1 {
        let window = frame.area().centered(Constraint::Length(15), Constraint::Length(4));
        frame.render_widget(Clear, window);
        frame.render_widget(Block::bordered().title("window"), window);
    }
}

fn fill(frame: &mut Frame<'_>, time: u8) {
    let symbols = ["/", "░", "世", "."];
    let fill = Fill::new(symbols[usize::from(time) % 4]).style(Style::new().fg(Color::Indexed(time * 9)));
    frame.render_widget(fill, frame.area());
}

fn gauge(frame: &mut Frame<'_>, time: u8) {
    let gauge = Gauge::default().ratio(value(time, 1) as f64 / 101.0).use_unicode(true);
    frame.render_widget(gauge.gauge_style(Style::new().red().on_black().italic()), frame.area());
}

fn line_gauge(frame: &mut Frame<'_>, time: u8) {
    let gauge = LineGauge::default().ratio(value(time, 2) as f64 / 100.0).label("done");
    frame
        .render_widget(gauge.filled_style(Style::new().blue().bold()).unfilled_style(Style::new().dim()), frame.area());
}

fn list(frame: &mut Frame<'_>, time: u8) {
    let items = (0..20).map(|k| ListItem::new(format!("item {k} 項目")).fg(Color::Indexed(k)));
    let list = List::new(items).highlight_symbol("> ").highlight_style(Style::new().reversed().bold());
    let mut state = ListState::default().with_selected(Some(usize::from(time) * 5));
    frame.render_stateful_widget(list, frame.area(), &mut state);
}

fn monthly(frame: &mut Frame<'_>, time: u8) {
    let date = Date::from_calendar_date(2024, Month::February, time + 1).expect("a day");
    let mut events = CalendarEventStore::default();
    events.add(date, Style::new().red().bold().underlined());
    let calendar =
        Monthly::new(date, events).show_month_header(Style::new().green()).show_weekdays_header(Style::new());
    frame.render_widget(calendar.show_surrounding(Style::new().dim()), frame.area());
}

fn paragraph(frame: &mut Frame<'_>, time: u8) {
    let text = vec![
        Line::from(vec!["bold ".bold(), "dim ".dim(), "italic ".italic(), "line ".underlined(), "back".reversed()]),
        Line::from(vec![
            "blink ".slow_blink(),
            "hidden ".hidden(),
            "struck ".crossed_out(),
            "all".bold().italic().underlined(),
        ]),
        Line::from(vec![
            "named ".light_magenta().on_gray(),
            Span::from("true").fg(Color::Rgb(1, 2, 3)).bg(Color::Rgb(250, 99, time)),
        ]),
        Line::from(vec![
            Span::from("indexed ").fg(Color::Indexed(200)),
            "reset".fg(Color::Reset),
            " wide: 世界 end".into(),
        ]),
        Line::from(format!("{time} is the time, and this line is longer than the screen is wide: it is wrapped"))
            .right_aligned(),
    ];
    frame.render_widget(
        Paragraph::new(text).wrap(Wrap { trim: true }).scroll((u16::from(time) % 3, 0)).on_blue(),
        frame.area(),
    );
}

fn logo(frame: &mut Frame<'_>, time: u8) {
    let size = if time.is_multiple_of(2) { RatatuiLogoSize::Tiny } else { RatatuiLogoSize::Small };
    frame.render_widget(RatatuiLogo::new(size), frame.area());
}

fn mascot(frame: &mut Frame<'_>, time: u8) {
    let eye = if time.is_multiple_of(2) { MascotEyeColor::Default } else { MascotEyeColor::Red };
    frame.render_widget(RatatuiMascot::new().set_eye(eye), frame.area());
}

fn scrollbar(frame: &mut Frame<'_>, time: u8) {
    for orientation in [
        ScrollbarOrientation::VerticalLeft,
        ScrollbarOrientation::VerticalRight,
        ScrollbarOrientation::HorizontalTop,
        ScrollbarOrientation::HorizontalBottom,
    ] {
        let mut state = ScrollbarState::new(30).position(usize::from(time) * 7 % 30);
        let bar =
            Scrollbar::new(orientation).thumb_style(Style::new().yellow()).track_style(Style::new().on_dark_gray());
        frame.render_stateful_widget(bar, frame.area(), &mut state);
    }
}

fn sparkline(frame: &mut Frame<'_>, time: u8) {
    let line = Sparkline::default().data((0..30).map(|k| (k % 7 != 0).then(|| value(time, k))));
    frame.render_widget(
        line.max(100).absent_value_symbol("x").absent_value_style(Style::new().red()).light_cyan(),
        frame.area(),
    );
}

fn table(frame: &mut Frame<'_>, time: u8) {
    let rows = (0..20).map(|k| Row::new([Cell::from(k.to_string()).bold(), format!("値 {}", value(time, k)).into()]));
    let widths = [Constraint::Length(5), Constraint::Fill(1)];
    let table = Table::new(rows, widths).header(Row::new(["k", "value"]).underlined()).column_spacing(2);
    let table = table.row_highlight_style(Style::new().on_green()).highlight_symbol("» ");
    let mut state = TableState::default().with_selected(Some(usize::from(time) * 4));
    frame.render_stateful_widget(table, frame.area(), &mut state);
}

fn tabs(frame: &mut Frame<'_>, time: u8) {
    let tabs = Tabs::new(["one", "二", "three", "four"]).select(usize::from(time) % 4).divider("|").padding("  ", " ");
    frame.render_widget(tabs.highlight_style(Style::new().black().on_yellow().underlined()), frame.area());
}

/// Our backend in each way of encoding, beside ratatui's.
fn pairs() -> impl Iterator<Item = (Pair, bool)> {
    let orders = [(Order::Raster, false), (Order::Raster, true), (Order::Color, true)];
    orders.into_iter().map(|(order, synchronized)| {
        let encoder = Encoder::new().with_order(order).with_synchronized_output(synchronized);
        (Pair::new(SIZE, encoder, &Viewport::Fullscreen, ""), synchronized)
    })
}

/// Each several times over itself.
#[test]
fn every_widget_at_several_times() {
    for (name, widget) in WIDGETS {
        for (mut pair, synchronized) in pairs() {
            pair.line.take_writes();
            let frames = (0..6).map(|time| {
                pair.draw(|frame| widget(frame, time));
                let writes = pair.line.take_writes();
                for write in &writes {
                    assert_bracketed(write, synchronized);
                }
                writes.len()
            });
            let frames: Vec<usize> = frames.collect();
            assert_eq!(frames[0], 1, "{name}");
            assert!(frames[1..].contains(&1), "{name} does not change");
            assert!(frames.iter().all(|&writes| writes <= 1), "{name}: {frames:?} writes");
        }
    }
}

/// A widget and a time, each widget over each other one.
fn transitions() -> impl Iterator<Item = (Draw, u8)> {
    let count = WIDGETS.len();
    (1..count).flat_map(move |step| (0..count).map(move |at| (WIDGETS[at * step % count].1, at as u8)))
}

/// A widget that replaces another leaves nothing of it.
///
/// Without wide characters: over half of one, ratatui's own backend leaves some of its successor's colour.
#[test]
fn every_widget_over_every_other() {
    for (mut pair, _) in pairs() {
        for (widget, time) in transitions() {
            pair.draw(|frame| {
                widget(frame, time);
                let buffer = frame.buffer_mut();
                *buffer = commonly_known(std::mem::take(buffer));
            });
        }
        // As docs/library.md says: about seven tenths.
        let sum = |line: &Wire| line.take_writes().iter().map(String::len).sum::<usize>();
        let (ours, theirs) = (sum(&pair.line), sum(&pair.other_line));
        assert!(ours * 100 < theirs * 73, "{ours} bytes, and ratatui's own backend sends {theirs}");
        pair.clear();
        pair.draw(|frame| table(frame, 0));
    }
}

/// With wide characters our screen is what the program has drawn.
#[test]
fn every_widget_over_every_other_with_wide_characters() {
    for order in [Order::Raster, Order::Color] {
        let mut strict = Strict::new(SIZE, Encoder::new().with_order(order), Clusters::None);
        for (widget, time) in transitions() {
            strict.draw(|frame| widget(frame, time));
        }
    }
}
