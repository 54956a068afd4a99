//! A line about work in the background: a recording of the session, and a large picture.

use super::layers::{Canvas, Layer, LayerLevel};
use super::legend;
use ratatui_core::layout::Rect;

/// The work shown in the upper right corner: a recording of the session, and a large picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Activity {
    /// Whether the session is recorded.
    pub(crate) records: bool,
    /// The percentage of the large picture that is done; `None` if there is none.
    pub(crate) picture: Option<u32>,
}

impl Activity {
    /// Returns whether there is any work in the background to show.
    pub(super) fn is_any(self) -> bool {
        self != Self::default()
    }

    /// Returns the line; with `is_short`, without hints on keys and in as few words as possible.
    fn text(self, is_short: bool) -> String {
        let picture = self.picture.map(|percent| {
            if is_short { format!("{percent}%") } else { format!("large picture {percent} %, Esc cancels") }
        });
        let records = self.records.then(|| "REC".to_owned());
        records.into_iter().chain(picture).collect::<Vec<_>>().join("  ")
    }
}

impl Layer for Activity {
    fn level(&self) -> LayerLevel {
        LayerLevel::Note
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let (screen, text) = (canvas.screen(), self.text(!canvas.has_room()));
        // The line is ASCII, so it has as many columns as bytes.
        let width = (text.len() as u16 + 2).min(screen.width);
        let corner = Rect { x: screen.right() - width, width, height: screen.height.min(1), ..screen };
        canvas.lay(corner, |theme, area, buffer| legend::draw(&text, theme, area, buffer));
    }
}
