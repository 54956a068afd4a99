//! What is written over the picture: how it looks, where there is room for it, and the status line.

use crate::capabilities::{CellMode, Colors, Glyphs};
use crate::grid::Size;
use crate::progress::{Progress, Work};
use crate::render::Sampling;
use crate::text::visible;
use glam::Vec3;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::border;
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Paragraph, Widget};
use std::path::Path;
use std::time::Duration;
use unicode_width::UnicodeWidthStr;

/// Colours and border of panels. Where the picture has neither colour nor block characters, nor have they.
#[derive(Clone, Copy)]
pub(super) struct Look {
    style: Style,
    /// How marks on the picture are written.
    mark: Style,
    border: border::Set<'static>,
    /// What is done of something, and what is not.
    bar: [char; 2],
}

impl Look {
    pub(super) fn of(cell_mode: CellMode) -> Self {
        let style = match cell_mode.colors {
            Colors::Truecolor => Style::new().fg(Color::Rgb(0xe6, 0xe6, 0xe6)).bg(Color::Rgb(0x18, 0x1c, 0x24)),
            Colors::Indexed256 => Style::new().fg(Color::Indexed(254)).bg(Color::Indexed(234)),
            Colors::Indexed16(_) => Style::new().fg(Color::White).bg(Color::Black),
            Colors::None => Style::new(),
        };
        let (border, bar) = match cell_mode.glyphs {
            Glyphs::Half => (border::ROUNDED, ['█', '░']),
            Glyphs::Shape | Glyphs::Ramp => (ASCII_BORDER, ['#', '.']),
        };
        let mark = match cell_mode.colors {
            Colors::None => style.add_modifier(Modifier::BOLD),
            _ => style.fg(Color::LightYellow),
        };
        Self { style, mark, border, bar }
    }

    pub(super) fn border(self) -> border::Set<'static> {
        self.border
    }

    /// How marks on the picture are written.
    pub(super) fn mark(self) -> Style {
        self.mark
    }

    /// How text is written.
    pub(super) fn style(self) -> Style {
        self.style
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
    pub(super) sampling: Sampling,
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

/// The least screen on which panels lie over the picture.
pub(super) const LEAST: (u16, u16) = (40, 12);

/// Whether panels may lie over the picture: on a smaller screen they would hide what they speak of.
pub(super) fn has_room(screen: Rect) -> bool {
    screen.width >= LEAST.0 && screen.height >= LEAST.1
}

/// The lowest row of the screen with so many below it.
pub(super) fn foot(screen: Rect, below: u16) -> Rect {
    Rect { y: screen.bottom().saturating_sub(1 + below), height: screen.height.min(1), ..screen }
}

/// Text on a row of its own.
pub(super) fn draw_line(text: &str, look: Look, area: Rect, buffer: &mut Buffer) {
    Paragraph::new(text).style(look.style).render(area, buffer);
}

impl Status {
    pub(super) fn draw(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        draw_line(&self.text(), look, area, buffer);
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
            " {}x{}x{}  {} rays/s  {stages} shown {shown} fps  eye {:.2} {:.2} {:.2}",
            cells.columns,
            cells.rows,
            samples(self.sampling),
            short(per_second(self.rays as f64, self.trace)),
            eye.x,
            eye.y,
            eye.z,
        )
    }
}

/// How many samples a pixel has, at most.
fn samples(sampling: Sampling) -> String {
    match sampling {
        Sampling::Coarse => "1/4".to_owned(),
        Sampling::Each(samples) | Sampling::UpTo(samples) => samples.to_string(),
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

/// The panel that says how far the scene is takes so much where there is room.
const PROGRESS_WIDTH: u16 = 46;
const PROGRESS_HEIGHT: u16 = 4;

/// Above the lowest row, in the middle.
pub(super) fn progress_area(screen: Rect) -> Rect {
    let (width, height) = (PROGRESS_WIDTH.min(screen.width), PROGRESS_HEIGHT.min(screen.height));
    let y = (screen.height - height).saturating_sub(1);
    Rect::new((screen.width - width) / 2, y, width, height)
}

pub(super) fn draw_progress(progress: &Progress, look: Look, area: Rect, buffer: &mut Buffer) {
    Clear.render(area, buffer);
    Block::bordered().border_set(look.border).style(look.style).render(area, buffer);
    let inside = area.inner(Margin::new(2, 1));
    let lines = [what_is_done(&progress.work, look, inside.width.into()), bar(progress, look, inside.width.into())];
    Paragraph::new(lines.map(Line::from).to_vec()).style(look.style).render(inside, buffer);
}

/// The work and, where there is room for a part of it, the file's name: its end tells more than its beginning.
fn what_is_done(work: &Work, look: Look, width: usize) -> String {
    let (verb, name) = match work {
        Work::Reading(name) => ("reading", name),
        Work::Parsing(name) => ("parsing", name),
        Work::Building => return "building".to_owned(),
    };
    let room = width.saturating_sub(verb.len() + 1);
    let name = Path::new(name).file_name().map_or_else(|| name.into(), |name| name.to_string_lossy());
    let is_shown = |c: char| c.is_ascii() || !look.bar[0].is_ascii();
    let mut name: String = visible(&name).chars().map(|c| if is_shown(c) { c } else { '?' }).collect();
    while name.width() > room {
        name.remove(0);
    }
    format!("{verb} {name}")
}

/// A bar as wide as there is room, and the share in per cent; nothing where nobody knows it.
fn bar(progress: &Progress, look: Look, width: usize) -> String {
    if progress.total == 0 {
        return String::new();
    }
    let share = (progress.done as f64 / progress.total as f64).min(1.0);
    let per_cent = format!(" {:3.0} %", (100.0 * share).floor());
    let room = width.saturating_sub(per_cent.len());
    let filled = (share * room as f64) as usize;
    let [done, open] = look.bar;
    (0..room).map(|at| if at < filled { done } else { open }).chain(per_cent.chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capabilities::CellMode;

    /// The panel's rows on a screen of that size.
    fn panel(progress: &Progress, cell_mode: CellMode, columns: u16, rows: u16) -> Vec<String> {
        let area = progress_area(Rect::new(0, 0, columns, rows));
        assert!(area.right() <= columns && area.bottom() <= rows);
        let mut buffer = Buffer::empty(area);
        draw_progress(progress, Look::of(cell_mode), area, &mut buffer);
        let row = |y| (area.left()..area.right()).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        (area.top()..area.bottom()).map(row).collect()
    }

    fn parsing(name: &str, done: usize, total: usize) -> Progress {
        Progress { work: Work::Parsing(name.to_owned()), done, total }
    }

    #[test]
    fn small_screens_have_no_room() {
        let fits = |columns, rows| has_room(Rect::new(0, 0, columns, rows));
        assert!(fits(40, 12) && !fits(39, 24) && !fits(80, 11));
    }

    #[test]
    fn the_panel_says_what_is_done_and_how_far() {
        let half = CellMode::HALF_BLOCK;
        let rows = panel(&parsing("meshes/dragon.ply", 25, 100), half, 20, 5);
        assert_eq!(
            rows,
            ["╭──────────────────╮", "│ parsing agon.ply │", "│ ██░░░░░░░░  25 % │", "╰──────────────────╯"]
        );
        let rows = panel(&parsing("a\u{1b}b.ply", 100, 100), half, 80, 24);
        assert_eq!(rows[1], format!("│ {:42} │", "parsing a\u{fffd}b.ply"));
        assert_eq!(rows[2], format!("│ {} 100 % │", "█".repeat(36)));
        let building = Progress { work: Work::Building, done: 999, total: 1000 };
        let ascii = CellMode { glyphs: Glyphs::Ramp, ..half };
        assert_eq!(panel(&parsing("é.ply", 0, 1), ascii, 80, 24)[1], format!("| {:42} |", "parsing ?.ply"));
        let rows = panel(&building, ascii, 80, 24);
        assert_eq!([&*rows[0], &*rows[2]], [format!("+{}+", "-".repeat(44)), format!("| {}.  99 % |", "#".repeat(35))]);
    }

    /// No bar where nobody knows how much there is; and no screen is too small.
    #[test]
    fn the_panel_goes_with_any_file_and_screen() {
        let unknown = parsing("x.glb", 0, 0);
        assert_eq!(panel(&unknown, CellMode::HALF_BLOCK, 20, 5)[2], format!("│ {:16} │", ""));
        for (columns, rows) in [(1, 1), (3, 2), (5, 3), (9, 9), (1, 24)] {
            for progress in [&unknown, &parsing(&"x".repeat(300), 1, 3), &parsing("", 7, 3)] {
                panel(progress, CellMode::HALF_BLOCK, columns, rows);
            }
        }
    }
}
