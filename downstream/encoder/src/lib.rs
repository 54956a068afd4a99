//! The screens of a job monitor, drawn with widgets of ratatui.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Position};
use ratatui::style::{Color, Style, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Circle, Map, MapResolution};
use ratatui::widgets::{
    Axis, BarChart, Block, Cell, Chart, Dataset, Gauge, Paragraph, Row, Sparkline, Table, TableState, Tabs, Wrap,
};

const JOBS: [(&str, Color); 5] = [
    ("compile", Color::Green),
    ("link", Color::Cyan),
    ("テスト", Color::Yellow),
    ("paint 🎨", Color::Magenta),
    ("ship e\u{301}", Color::Rgb(250, 120, 40)),
];

/// Draws the screen of frame number `time`.
pub fn monitor(frame: &mut Frame<'_>, time: u16) {
    let [tabs, top, middle, foot] =
        Layout::vertical([Constraint::Length(1), Constraint::Length(6), Constraint::Fill(1), Constraint::Length(3)])
            .areas(frame.area());
    let names = ["jobs", "map", "log"];
    frame.render_widget(Tabs::new(names).select(usize::from(time / 40) % names.len()), tabs);
    let [left, right] = Layout::horizontal([Constraint::Percentage(60), Constraint::Fill(1)]).areas(top);
    levels(frame, left, time);
    bars(frame, right, time);
    let [jobs, curves, world] =
        Layout::horizontal([Constraint::Percentage(35), Constraint::Percentage(35), Constraint::Fill(1)]).areas(middle);
    table(frame, jobs, time);
    chart(frame, curves, time);
    map(frame, world, time);
    let words = Line::from(vec![
        "queued ".dim(),
        Span::styled(format!("{} ", time % 60), Style::new().bold().fg(Color::Indexed(208))),
        "held ".italic().crossed_out(),
        "failed".reversed().red(),
        " 漢字と仮名 👩‍👩‍👧 🇩🇪 ".into(),
    ]);
    frame.render_widget(Paragraph::new(words).wrap(Wrap { trim: true }).block(Block::bordered().title("state")), foot);
    if time % 3 == 0 {
        frame.set_cursor_position(Position::new(2, foot.y + 1));
    }
}

fn levels(frame: &mut Frame<'_>, area: ratatui::layout::Rect, time: u16) {
    let [above, below] = Layout::vertical([Constraint::Length(3), Constraint::Fill(1)]).areas(area);
    let gauge = Gauge::default().use_unicode(true).gauge_style(Color::LightBlue).ratio(f64::from(time % 90) / 90.0);
    frame.render_widget(gauge.block(Block::bordered().title("whole")), above);
    let data: Vec<u64> = (0..area.width).map(|at| u64::from((at + time).wrapping_mul(7919) % 61)).collect();
    frame.render_widget(Sparkline::default().data(&data).style(Color::Green), below);
}

fn bars(frame: &mut Frame<'_>, area: ratatui::layout::Rect, time: u16) {
    let data = [("a", time % 17), ("b", time % 11), ("c", time % 7)].map(|(name, height)| (name, u64::from(height)));
    frame.render_widget(BarChart::default().bar_width(4).data(&data).block(Block::bordered()), area);
}

fn table(frame: &mut Frame<'_>, area: ratatui::layout::Rect, time: u16) {
    let rows = (0..40).map(|at| {
        let (name, color) = JOBS[usize::from(at + time / 4) % JOBS.len()];
        Row::new([Cell::from(name).style(color), Cell::from(format!("#{}", at + time / 4))])
    });
    let table = Table::new(rows, [Constraint::Fill(1), Constraint::Length(6)]).row_highlight_style(Style::new().bold());
    let mut state = TableState::default().with_selected(Some(usize::from(time / 6 % 20)));
    frame.render_stateful_widget(table.block(Block::bordered().title("jobs")), area, &mut state);
}

fn chart(frame: &mut Frame<'_>, area: ratatui::layout::Rect, time: u16) {
    let points: Vec<_> = (0..160)
        .map(|at| {
            let x = f64::from(at) / 8.0;
            (x, ((x + f64::from(time) / 5.0) / 2.0).sin() * 9.0)
        })
        .collect();
    let load = Dataset::default().marker(Marker::Braille).style(Color::Yellow).data(&points);
    let [x, y] = [[0.0, 20.0], [-10.0, 10.0]].map(|bounds| Axis::default().bounds(bounds));
    frame.render_widget(Chart::new(vec![load]).x_axis(x).y_axis(y).block(Block::bordered().title("load".bold())), area);
}

fn map(frame: &mut Frame<'_>, area: ratatui::layout::Rect, time: u16) {
    let canvas =
        Canvas::default().x_bounds([-180.0, 180.0]).y_bounds([-90.0, 90.0]).marker(Marker::Dot).paint(|context| {
            context.draw(&Map { color: Color::White, resolution: MapResolution::High });
            context.draw(&Circle { x: f64::from(time % 180) - 90.0, y: 20.0, radius: 12.0, color: Color::Red });
        });
    frame.render_widget(canvas.block(Block::bordered().title("where")), area);
}
