//! Finer glyphs for a picture at rest.
//!
//! Half blocks have a sixteenth of the pixels of quadrants and eighths, so that in motion more frames are shown and
//! each key takes effect sooner. Once the picture rests and is final, it is traced once more for the finer glyphs of a
//! terminal that is known to show them well.

use super::orders::RenderOrdersPanel;
use super::schedule::PictureState;
use super::{DriverState, Frame, Shot, Viewer};

/// The picture that is shown in finer glyphs, if any.
#[derive(Default)]
pub(super) struct Rest {
    /// The shot of the picture in half blocks.
    shot: Option<Shot>,
}

impl Rest {
    /// Returns whether a picture is shown, or is being traced, in finer glyphs.
    pub(super) fn is_on(&self) -> bool {
        self.shot.is_some()
    }

    fn begin(&mut self, shot: Shot) {
        self.shot = Some(shot);
    }

    /// Ends the rest, and returns whether there was one.
    pub(super) fn end(&mut self) -> bool {
        self.shot.take().is_some()
    }
}

impl Viewer {
    /// Begins to show the picture in finer glyphs once it rests, and in half blocks once the view
    /// changes.
    pub(super) fn begin_or_end_rest(&mut self, busy: DriverState) {
        if let Some(shot) = self.rest.shot {
            // The glyphs change the number of pixels only.
            let is_same = |wanted| Shot { resolution: shot.resolution, ..wanted } == shot;
            if !self.current_shot().is_some_and(is_same) {
                self.end_rest();
            }
        } else if self.may_rest(busy) {
            let shot = self.current_shot();
            if let Some(shot) = shot.filter(|_| self.display.set_rests(true)) {
                self.rest.begin(shot);
            }
        }
    }

    /// Shows half blocks again.
    pub(super) fn end_rest(&mut self) {
        if self.rest.end() {
            self.display.set_rests(false);
        }
    }

    /// Lets the screen show `frame` in the glyphs that it was traced for.
    ///
    /// Until a frame for other glyphs arrives, the screen keeps those of the last frame, so that it can be drawn.
    pub(super) fn use_glyphs_of(&mut self, frame: &Frame) {
        let capabilities = self.display.capabilities();
        if frame.resolution() == self.display.resolution() && capabilities != self.screen.capabilities() {
            self.screen.set_capabilities(capabilities);
        }
    }

    /// Returns the pixels of the shown picture, across and down, that are as long as one in motion.
    pub(super) fn pixels_per_step(&self) -> [i32; 2] {
        let shown = self.shown_resolution();
        let ratio = |shown: u32, moving: u32| (shown / moving.max(1)).max(1).cast_signed();
        self.rest.shot.map_or([1, 1], |Shot { resolution, .. }| {
            [ratio(shown.width(), resolution.width()), ratio(shown.height(), resolution.height())]
        })
    }

    fn may_rest(&self, busy: DriverState) -> bool {
        let is_free = self.options.finer_at_rest
            && self.display.capabilities().resting_glyphs.is_some()
            // On slow links only half blocks are sent with fewer bytes at less quality.
            && !self.pacing.is_link_slow()
            && self.options.max_rate.is_none()
            // The second camera depends on the size of the picture, and would end the rest at once.
            && self.second_camera().is_none()
            && self.screen.get::<RenderOrdersPanel>().is_none();
        let is_shown = self.screen.has_shown()
            && !self.screen.is_changed(self.display.picture_size())
            && !self.screen.is_loading_scene()
            && self.screen.frame().is_some_and(|frame| frame.resolution() == self.display.resolution());
        let is_done = busy == DriverState::default() && self.picture_state() == PictureState::Finished;
        is_free && is_shown && is_done && !self.is_picture_moving()
    }
}
