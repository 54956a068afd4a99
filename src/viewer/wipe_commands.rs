//! Commands that move the line between the two maps of a wipe.

use super::Viewer;
use crate::control::ScreenSide;

/// Distance that a key press moves the line between two maps, as a share of the width.
// A held key, which repeats, moves the line across the picture in about a second.
const WIPE_STEP: f32 = 1.0 / 32.0;

impl Viewer {
    /// Moves the line of a wipe by a step to this side.
    pub(super) fn move_wipe(&mut self, side: ScreenSide) {
        let step = if side == ScreenSide::Left { -WIPE_STEP } else { WIPE_STEP };
        self.wipe_to(self.screen.wipe() + step);
    }

    /// Moves the line of a wipe to this share of the picture's width; does nothing in other
    /// layouts.
    pub(super) fn wipe_to(&mut self, share: f32) {
        if self.layout.is_wipe() {
            self.screen.wipe_to(share);
        }
    }
}
