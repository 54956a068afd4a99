//! Commands that move the dividing line between two pictures side by side.

use super::Viewer;
use crate::control::Side;

/// Distance that a key press moves the line, as a share of the width.
// A repeated key crosses the picture in about a second.
const WIPE_STEP: f32 = 1.0 / 32.0;

impl Viewer {
    /// Moves the line between two maps, if there is one. Nothing is traced for it.
    pub(super) fn move_wipe(&mut self, side: Side) {
        let step = if side == Side::Left { -WIPE_STEP } else { WIPE_STEP };
        self.wipe_to(self.screen.wipe() + step);
    }

    /// Moves that line to a share of the width.
    pub(super) fn wipe_to(&mut self, share: f32) {
        if self.layout.is_wipe() {
            self.screen.wipe_to(share);
        }
    }
}
