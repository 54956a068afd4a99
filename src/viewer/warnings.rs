//! Warnings about the shown scene, above the lowest row until the next key.

use super::error_panel::wrapped;
use super::layers::{Canvas, Layer, LayerLevel};
use ratatui_core::layout::Rect;

/// Limit on the rows of all warnings together.
const MAX_ROWS: usize = 4;

/// The warnings about a scene: faults of its files despite which it is shown.
#[derive(Default)]
pub(super) struct Warnings(Vec<String>);

impl Warnings {
    /// Adds a warning, unless the list already contains it.
    pub(super) fn add(&mut self, warning: String) {
        if !self.0.contains(&warning) {
            self.0.push(warning);
        }
    }

    /// Returns the warnings, wrapped into lines for a row of this width; at most [`MAX_ROWS`]
    /// lines.
    fn lines(&self, width: u16) -> Vec<String> {
        let lines = self.0.iter().flat_map(|warning| wrapped(warning, usize::from(width.saturating_sub(2)).max(1)));
        lines.take(MAX_ROWS).collect()
    }
}

impl Layer for Warnings {
    fn level(&self) -> LayerLevel {
        LayerLevel::Warning
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        // The warnings are above the rows in which a note may be shown at the same time.
        let row = canvas.row_from_bottom(canvas.status_rows.max(canvas.note_rows));
        let lines = self.lines(row.width);
        for (above, line) in (0..).zip(lines.iter().rev()).take_while(|&(above, _)| above < row.y) {
            canvas.write_line(&format!(" {line}"), Rect { y: row.y - above, ..row });
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
