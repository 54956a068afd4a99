//! What is written over the picture: the status line and the help.

use crate::capabilities::{CellMode, Colors, Glyphs};
use crate::control::BINDINGS;
use crate::grid::Size;
use glam::Vec3;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Rect};
use ratatui::style::{Color, Style};
use ratatui::symbols::border;
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Paragraph, Widget};
use std::time::Duration;

/// Colours and border of panels. Where the picture has neither colour nor block characters, nor have they.
#[derive(Clone, Copy)]
pub(super) struct Look {
    style: Style,
    border: border::Set<'static>,
}

impl Look {
    pub(super) fn of(cell_mode: CellMode) -> Self {
        let style = match cell_mode.colors {
            Colors::Truecolor => Style::new().fg(Color::Rgb(0xe6, 0xe6, 0xe6)).bg(Color::Rgb(0x18, 0x1c, 0x24)),
            Colors::Indexed256 => Style::new().fg(Color::Indexed(254)).bg(Color::Indexed(234)),
            Colors::Indexed16(_) => Style::new().fg(Color::White).bg(Color::Black),
            Colors::None => Style::new(),
        };
        let border = match cell_mode.glyphs {
            Glyphs::Half => border::ROUNDED,
            Glyphs::Shape | Glyphs::Ramp => ASCII_BORDER,
        };
        Self { style, border }
    }
}

const ASCII_BORDER: border::Set<'static> = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

/// What the status line says.
pub(super) struct Status {
    pub(super) cells: Size,
    /// How long tracing took.
    pub(super) trace: Duration,
    /// How long cells and bytes took.
    pub(super) encode: Duration,
    /// Frames shown per second, while something moves.
    pub(super) shown: Option<f32>,
    pub(super) rays: u64,
    /// The rate of the link if it is slow, in bytes per second.
    pub(super) slow: Option<f64>,
    pub(super) eye: Vec3,
}

/// The lowest row.
pub(super) fn status_area(screen: Rect) -> Rect {
    Rect { y: screen.bottom().saturating_sub(1), height: screen.height.min(1), ..screen }
}

impl Status {
    pub(super) fn draw(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        Paragraph::new(self.text()).style(look.style).render(area, buffer);
    }

    fn text(&self) -> String {
        let Self { cells, eye, .. } = self;
        let shown = self.shown.map_or_else(|| "-".to_owned(), |fps| format!("{fps:.0}"));
        // What holds the frames up.
        let stages = match self.slow {
            Some(rate) => format!("slow link {}B/s", short(rate)),
            None => {
                format!("trace {} encode {}", short(per_second(1.0, self.trace)), short(per_second(1.0, self.encode)))
            }
        };
        format!(
            " {}x{}  {} rays/s  {stages} shown {shown} fps  eye {:.2} {:.2} {:.2}",
            cells.columns,
            cells.rows,
            short(per_second(self.rays as f64, self.trace)),
            eye.x,
            eye.y,
            eye.z,
        )
    }
}

fn per_second(count: f64, time: Duration) -> f64 {
    count / time.as_secs_f64().max(1e-9)
}

/// Two or three digits and a letter: 812, 3.9k, 12M.
fn short(value: f64) -> String {
    let (value, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    if value >= 10.0 { format!("{value:.0}{unit}") } else { format!("{value:.1}{unit}") }
}

const HELP_NOTES: [&str; 1] = ["Shift with a movement: faster"];

/// In the middle, as large as its text, or as the screen.
pub(super) fn help_area(screen: Rect) -> Rect {
    let lines = help_lines();
    let width = lines.iter().map(Line::width).max().unwrap_or(0) as u16 + 4;
    let height = lines.len() as u16 + 2;
    let (width, height) = (width.min(screen.width), height.min(screen.height));
    Rect::new((screen.width - width) / 2, (screen.height - height) / 2, width, height)
}

pub(super) fn draw_help(look: Look, area: Rect, buffer: &mut Buffer) {
    Clear.render(area, buffer);
    Block::bordered().border_set(look.border).title(" keys ").style(look.style).render(area, buffer);
    Paragraph::new(help_lines()).style(look.style).render(area.inner(Margin::new(2, 1)), buffer);
}

/// A line for each binding.
fn help_lines() -> Vec<Line<'static>> {
    let labels = BINDINGS.iter().map(|binding| binding.label.len()).max().unwrap_or(0);
    let bindings = BINDINGS.iter().map(|b| format!("{:labels$}  {}", b.label, b.does));
    bindings.chain(HELP_NOTES.map(str::to_owned)).map(Line::from).collect()
}
