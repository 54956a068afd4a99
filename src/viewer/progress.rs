//! The panel with the progress of loading a scene.

use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::Theme;
use crate::progress::{Progress, Work};
use crate::text::visible;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use std::path::Path;
use unicode_width::UnicodeWidthStr;

/// A panel that names the current work and shows how much of it is done.
pub(super) struct ProgressPanel(pub(super) Progress);

impl Layer for ProgressPanel {
    fn level(&self) -> LayerLevel {
        LayerLevel::Middle
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        canvas.lay(area(canvas.screen()), |theme, area, buffer| draw(&self.0, theme, area, buffer));
    }
}

/// The panel's width in columns, on screens that are wide enough.
// The width is enough for the verb and file names of 34 characters; longer names lose their beginning.
const PROGRESS_WIDTH: u16 = 46;
const PROGRESS_HEIGHT: u16 = 4;

/// Returns the panel's area: horizontally in the middle, above the lowest row.
fn area(screen: Rect) -> Rect {
    let (width, height) = (PROGRESS_WIDTH.min(screen.width), PROGRESS_HEIGHT.min(screen.height));
    let y = (screen.height - height).saturating_sub(1);
    Rect::new((screen.width - width) / 2, y, width, height)
}

fn draw(progress: &Progress, theme: Theme, area: Rect, buffer: &mut Buffer) {
    Clear.render(area, buffer);
    Block::bordered().border_set(theme.border()).style(theme.style()).render(area, buffer);
    let inside = area.inner(Margin::new(2, 1));
    let lines =
        [work_line(&progress.work, theme, inside.width.into()), progress_bar(progress, theme, inside.width.into())];
    Paragraph::new(lines.map(Line::from).to_vec()).style(theme.style()).render(inside, buffer);
}

/// Returns the line that names the work and its file.
///
/// A name that does not fit loses its beginning, because the end of a name says more.
fn work_line(work: &Work, theme: Theme, width: usize) -> String {
    let (verb, Some(name)) = work.verb_and_file() else {
        return work.verb_and_file().0.to_owned();
    };
    let room = width.saturating_sub(verb.len() + 1);
    let name = Path::new(name).file_name().map_or_else(|| name.into(), |name| name.to_string_lossy());
    // A terminal whose progress bar is ASCII may lack all other characters too, so `?` replaces them in the name.
    let is_shown = |c: char| c.is_ascii() || !theme.bar()[0].is_ascii();
    let mut name: String = visible(&name).chars().map(|c| if is_shown(c) { c } else { '?' }).collect();
    while name.width() > room {
        name.remove(0);
    }
    format!("{verb} {name}")
}

/// Returns a bar of this width with the percentage; empty if the total is unknown.
fn progress_bar(progress: &Progress, theme: Theme, width: usize) -> String {
    if progress.total == 0 {
        return String::new();
    }
    let share = (progress.done as f64 / progress.total as f64).min(1.0);
    // The percentage is rounded down, so that 100 % means that nothing is left.
    let per_cent = format!(" {:3.0} %", (100.0 * share).floor());
    let room = width.saturating_sub(per_cent.len());
    let filled = (share * room as f64) as usize;
    let [done, open] = theme.bar();
    (0..room).map(|at| if at < filled { done } else { open }).chain(per_cent.chars()).collect()
}

#[cfg(all(test, unit_tests))]
mod tests;
