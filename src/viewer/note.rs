//! A note in the lowest row until the next key.

use super::layers::{Canvas, Layer, Level};
use super::legend;

/// A line of text.
pub(super) struct Note(pub(super) String);

impl Layer for Note {
    fn level(&self) -> Level {
        Level::Note
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if canvas.has_room() {
            canvas.lay(canvas.foot(0), |theme, area, buffer| legend::draw(&self.0, theme, area, buffer));
        }
    }
}
