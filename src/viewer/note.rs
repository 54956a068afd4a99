//! A note in the lowest row until the next key, or until it fades.

use super::layers::{Canvas, Layer, LayerLevel};
use super::legend;
use ratatui_core::layout::Rect;
use std::time::Duration;
use unicode_width::UnicodeWidthStr;

/// Time for which a note is shown.
// A line of 80 characters is read in four seconds.
pub(super) const NOTE_TIME: Duration = Duration::from_secs(5);

/// A note: a line of text, perhaps with another line above it.
pub(super) struct Note {
    text: String,
    /// The line above the text, if there is one.
    above: Option<String>,
    /// Whether the note stays until the next key.
    lasts: bool,
    /// Time at which the note fades; `None` before it was shown.
    fades_at: Option<Duration>,
}

impl Note {
    /// Returns a note that fades.
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), above: None, lasts: false, fades_at: None }
    }

    /// Returns a note that stays until the next key.
    pub(super) fn lasting(text: impl Into<String>) -> Self {
        Self { lasts: true, ..Self::new(text) }
    }

    /// Returns the note with another line above it.
    pub(super) fn with_line_above(self, text: String) -> Self {
        Self { above: Some(text), ..self }
    }

    /// Returns the number of rows that the note takes.
    pub(super) fn rows(&self) -> u16 {
        1 + u16::from(self.above.is_some())
    }

    /// Returns the time at which the note fades: [`NOTE_TIME`] after the first call.
    ///
    /// `None` if it stays until the next key.
    pub(super) fn fades_at(&mut self, now: Duration) -> Option<Duration> {
        (!self.lasts).then(|| *self.fades_at.get_or_insert(now + NOTE_TIME))
    }
}

impl Layer for Note {
    fn level(&self) -> LayerLevel {
        LayerLevel::Note
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        for (below, text) in (0..).zip([Some(&self.text), self.above.as_ref()].into_iter().flatten()) {
            let row = canvas.row_from_bottom(below);
            let text = drop_clauses_to_fit(text, usize::from(row.width.saturating_sub(2)));
            let area = Rect { width: (text.width() as u16 + 2).min(row.width), ..row };
            let area = extended(area, legend::shown_legends(canvas).into_iter().map(|(_, area)| area));
            canvas.lay(area, |theme, area, buffer| legend::draw(&text, theme, area, buffer));
        }
    }
}

/// Returns the area of a note, extended to the right so that it covers each legend that it touches.
///
/// A part of a legend cannot be read.
fn extended(area: Rect, legends: impl Iterator<Item = Rect>) -> Rect {
    let ends = legends.filter(|legend| legend.intersects(area)).map(Rect::right);
    Rect { width: ends.chain([area.right()]).max().unwrap_or(0) - area.x, ..area }
}

/// Returns the text, shortened to `width` columns by leaving out parts between semicolons.
///
/// The second part is left out first, then the third, and so on; the first one stays.
fn drop_clauses_to_fit(text: &str, width: usize) -> String {
    let mut parts: Vec<_> = text.split("; ").collect();
    while parts.len() > 1 && parts.join("; ").width() > width {
        parts.remove(1);
    }
    parts.join("; ")
}

#[cfg(all(test, unit_tests))]
mod tests;
