//! Commands while a pixel is explained.

use super::Viewer;
use super::explain::ExplainPanel;
use super::theme;
use crate::control::Toward;

/// Pixels that the cursor moves per key press with Shift.
// Ten presses cross a picture of 80 columns.
const SHIFT_CURSOR_PIXELS: i32 = 8;

impl Viewer {
    /// Starts or ends the explanation of a pixel.
    pub(super) fn toggle_explaining(&mut self) {
        self.screen.toggle_explaining();
        if !theme::has_room(theme::area(self.picture_size())) && self.screen.get::<ExplainPanel>().is_some() {
            self.show_note(theme::needs_room("explain"));
        }
    }

    /// Moves the cursor of the explanation by one pixel, or by several if `faster`.
    pub(super) fn point(&mut self, toward: Toward, faster: bool) {
        let pixels = if faster { SHIFT_CURSOR_PIXELS } else { 1 };
        let [across, down] = self.pixels_per_step();
        let step = match toward {
            Toward::Left => [-pixels * across, 0],
            Toward::Right => [pixels * across, 0],
            Toward::Up => [0, -pixels * down],
            Toward::Down => [0, pixels * down],
        };
        self.screen.explain(|panel, frame| panel.move_cursor_by(frame, step));
    }

    /// Turns pages of the explanation; negative numbers turn back.
    pub(super) fn turn_explanation(&mut self, pages: isize) {
        self.screen.explain(|panel, _| panel.turn_pages(pages));
    }
}
