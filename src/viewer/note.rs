//! A note in the lowest row until the next key, or until it fades.

use super::layers::{Canvas, Layer, Level};
use super::legend;
use std::time::Duration;

/// Time for which a note is shown.
// A line of 80 characters is read in four seconds.
pub(super) const NOTE_TIME: Duration = Duration::from_secs(5);

/// A line of text.
pub(super) struct Note {
    text: String,
    /// Whether it stays until the next key.
    lasts: bool,
    /// Time at which it fades; `None` before it was shown.
    fades_at: Option<Duration>,
}

impl Note {
    /// Returns a note that fades.
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), lasts: false, fades_at: None }
    }

    /// Returns a note that stays until the next key.
    pub(super) fn lasting(text: impl Into<String>) -> Self {
        Self { lasts: true, ..Self::new(text) }
    }

    /// Returns the time at which the note fades, which begins with the first call.
    ///
    /// `None` if it stays until the next key.
    pub(super) fn fades_at(&mut self, now: Duration) -> Option<Duration> {
        (!self.lasts).then(|| *self.fades_at.get_or_insert(now + NOTE_TIME))
    }
}

impl Layer for Note {
    fn level(&self) -> Level {
        Level::Note
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        canvas.lay(canvas.foot(0), |theme, area, buffer| legend::draw(&self.text, theme, area, buffer));
    }
}
