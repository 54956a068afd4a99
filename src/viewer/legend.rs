//! The legends of maps in the lowest row, one under each map.

use super::layers::{Canvas, Layer, Level};
use super::theme::Theme;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::widgets::Widget;
use ratatui_widgets::paragraph::Paragraph;

/// The layer with the legends of the shown frame's maps.
pub(super) struct Legends;

impl Layer for Legends {
    fn level(&self) -> Level {
        Level::Legend
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let legends = canvas.frame.filter(|_| canvas.has_room()).map_or(&[][..], |frame| &frame.legends);
        for (text, area) in legend_areas(legends, canvas.foot(canvas.status_rows)) {
            canvas.lay(area, |theme, area, buffer| draw(text, theme, area, buffer));
        }
    }
}

/// Returns each legend with its area in row `line`.
///
/// An area is only as wide as its text, so that the picture is visible beside it.
fn legend_areas(texts: &[String], line: Rect) -> impl Iterator<Item = (&str, Rect)> {
    let count = texts.len().max(1) as u16;
    (0..).zip(texts).map(move |(at, text)| {
        let room = line.width / count;
        // Legends are ASCII, so their length in bytes is their width in columns.
        let width = (text.len() as u16).saturating_add(2).min(room);
        (text.as_str(), Rect { x: line.x + (line.width * at).div_ceil(count), width, ..line })
    })
}

pub(super) fn draw(text: &str, theme: Theme, area: Rect, buffer: &mut Buffer) {
    Paragraph::new(format!(" {text} ")).style(theme.style()).render(area, buffer);
}

#[cfg(all(test, unit_tests))]
mod tests;
