//! Commands that move the camera at once. Held keys move it continuously, in `eye`.

use super::Viewer;
use super::lost::{Hiding, LostNotice};
use crate::camera::{Camera, CameraError};
use crate::control::Command;
use crate::framebuffer::Resolution;
use crate::hit::closest_hit;
use crate::ray::Ray;
use glam::Vec3;

/// Factor by which a key press scales the view rectangle.
// 1.1^7 is about 2, so that a held key doubles the zoom in seven repeats, a quarter of a second.
pub(super) const ZOOM_FACTOR: f32 = 1.1;

impl Viewer {
    /// Shows a notice if the user has moved the eye so that nothing of the scene is visible.
    pub(super) fn update_lost_notice(&mut self) {
        // No notice for the view that the scene's author has chosen.
        let frame = self.screen.frame().filter(|_| self.eye.moved_camera().is_some());
        let aspect_ratio = self.first_map_resolution().aspect_ratio();
        let hiding = frame.and_then(|frame| Hiding::find(&frame.scene, frame.camera(), aspect_ratio));
        let modes = self.screen.active_modes(self.picture_size());
        let key = |(command, does): (Command, &str)| Some(format!("{} {does}", self.keymap().key_of(&modes, command)?));
        let keys: Vec<_> =
            [(Command::Reset, "first view"), (Command::FrameAll, "frame all")].into_iter().filter_map(key).collect();
        let notice = hiding.map(|hiding| LostNotice::new(&hiding, &keys.join(", ")));
        self.screen.set(notice);
    }

    /// Switches between flight and orbit about the point in the middle of the picture.
    pub(super) fn change_mode(&mut self) {
        // The point is seen from the current camera, in the scene of the shown frame, which may be older.
        let in_the_middle = self.point_in_the_middle();
        self.eye.change_mode(in_the_middle);
        self.screen.set_movement_mode(self.eye.mode());
        self.show_note(format!("{}{}", self.eye.mode().name(), self.hint(Command::Help, "shows its keys")));
    }

    /// Returns the end of a note that names the key of `command`, such as `; ? shows its keys`.
    ///
    /// Empty if no key is bound to `command`.
    pub(super) fn hint(&self, command: Command, does: &str) -> String {
        let key = self.keymap().key_of(&self.screen.active_modes(self.picture_size()), command);
        key.map_or_else(String::new, |key| format!("; {key} {does}"))
    }

    /// Returns the surface point that is seen in the middle of the picture, or `None` if nothing is
    /// hit there.
    fn point_in_the_middle(&self) -> Option<Vec3> {
        let (scene, camera) = (&self.screen.frame()?.scene, self.eye.camera()?);
        let ray = Ray { origin: camera.pose().eye, direction: -camera.basis().w };
        closest_hit(scene, &ray).map(|hit| ray.at(hit.t))
    }

    /// Moves the eye so that all finite objects, which excludes planes, fill the picture.
    pub(super) fn frame_everything(&mut self) {
        let Some(bounds) = self.screen.frame().and_then(|frame| frame.scene.bounds()) else {
            self.show_note("nothing finite to fit in view");
            return;
        };
        let aspect_ratio = self.first_map_resolution().aspect_ratio();
        self.eye.jump(self.now, |camera| camera.framing(&bounds, aspect_ratio));
    }

    /// Jumps back to the view before the last jump, or with `forward` to the view that the last
    /// jump back has left.
    pub(super) fn retrace_views(&mut self, forward: bool) {
        if !self.eye.retrace(forward, self.now) {
            self.show_note(if forward { "no view after this one" } else { "no view before this one" });
        }
    }

    /// Returns the size in pixels of one map: the whole picture, or the left one of two maps side
    /// by side.
    pub(super) fn first_map_resolution(&self) -> Resolution {
        let whole = self.resolution();
        self.shown_layout().map_sizes(whole).first().map_or(whole, |(_, part)| *part)
    }

    /// Scales the view rectangle by `factor`, and shows the field of view in a note.
    pub(super) fn zoom(&mut self, factor: f32) {
        // Scaling the view rectangle keeps the perspective, which moving the eye would change.
        self.eye.change(self.now, |camera, _| camera.zoomed(factor));
        if let Some(camera) = self.eye.camera() {
            let degrees = camera.rectangle().vertical_fov().to_degrees();
            self.show_note(format!("field of view: {degrees:.1} degrees"));
        }
    }

    /// Shifts the view rectangle by steps to the right and upwards, and shows the shift in a note.
    pub(super) fn shift_rectangle(&mut self, steps: [f32; 2]) {
        self.change_rectangle("shift", |camera| camera.shifted_rectangle(steps.into()));
    }

    /// Tilts the view rectangle by steps to the right and upwards, and shows the tilt in a note.
    pub(super) fn tilt_rectangle(&mut self, steps: [f32; 2]) {
        self.change_rectangle("tilt", |camera| camera.tilted_rectangle(steps.into()));
    }

    /// Changes the view rectangle of the first camera, and shows the result or the error in a note.
    ///
    /// The result is the rectangle's new `offset`, which is "shift" or "tilt".
    fn change_rectangle(&mut self, offset: &str, change: impl FnOnce(&Camera) -> Result<Camera, CameraError>) {
        let Some(camera) = self.first_camera() else { return };
        let camera = match change(&camera) {
            Ok(camera) => camera,
            Err(error) => return self.show_note(error.to_string()),
        };
        self.change_first_camera(camera);
        let text = camera.rectangle().offset_texts().into_iter().find(|text| text.starts_with(offset));
        let mut text = text.unwrap_or_else(|| format!("{offset} 0 0"));
        if offset == "tilt" && camera.has_upright_rectangle() {
            text += ": verticals are parallel";
        }
        self.show_note(text);
    }

    /// Starts or stops the turntable, unless the user has asked for reduced motion.
    pub(super) fn toggle_turntable(&mut self) {
        if self.options.reduced_motion {
            self.show_note("the turntable is off: --reduced-motion");
            return;
        }
        self.eye.toggle_turntable(self.now);
    }

    /// Moves the camera to view `number`: the one saved by the user, or the one in the scene file.
    pub(super) fn go_to_view(&mut self, number: u8) {
        if self.eye.go_to(number, self.now).is_none() {
            let hint = self.hint(Command::SaveView, "saves this one");
            self.show_note(format!("there is no view {number}{hint}"));
        }
    }

    /// Saves the current view under a number until the program ends.
    pub(super) fn save_view(&mut self, number: u8) {
        self.eye.save(number);
        let hint = self.hint(Command::KeepView, "saves it to the scene file");
        self.show_note(format!("saved as view {number} until you quit{hint}"));
    }
}
