//! How the eye moves, beside what held keys do.

use super::Viewer;
use crate::control::Command;
use crate::framebuffer::Resolution;
use crate::hit::closest_hit;
use crate::ray::Ray;
use glam::Vec3;

/// How many times as large a press makes the view rectangle.
pub(super) const ZOOM_FACTOR: f32 = 1.1;

impl Viewer {
    /// The eye goes around what is in the middle of the picture, or flies again.
    pub(super) fn change_mode(&mut self) {
        let in_the_middle = self.in_the_middle();
        self.eye.change_mode(in_the_middle);
        self.screen.set_moving(self.eye.mode());
        self.say(format!("{}{}", self.eye.mode().name(), self.hint(Command::Help, "shows its keys")));
    }

    /// What a key does about what a note says, for its end; nothing, if no key is bound to that.
    pub(super) fn hint(&self, command: Command, does: &str) -> String {
        let key = self.keymap().key_of(&self.screen.modes(self.size()), command);
        key.map_or_else(String::new, |key| format!("; {key} {does}"))
    }

    /// The point of the scene that the eye looks at.
    fn in_the_middle(&self) -> Option<Vec3> {
        let (scene, camera) = (&self.screen.frame()?.scene, self.eye.camera()?);
        let ray = Ray { origin: camera.pose().eye, direction: -camera.basis().w };
        closest_hit(scene, &ray).map(|hit| ray.at(hit.t))
    }

    /// All that has an end is seen, as large as it can be; from the same direction.
    pub(super) fn frame_everything(&mut self) {
        let Some(bounds) = self.screen.frame().and_then(|frame| frame.scene.bounds()) else {
            self.say("nothing here has an end");
            return;
        };
        let aspect_ratio = self.part().aspect_ratio();
        self.eye.change(self.now, |camera, _| camera.framing(&bounds, aspect_ratio));
    }

    /// The picture's size; of two maps side by side, each is a picture of its own.
    pub(super) fn part(&self) -> Resolution {
        let whole = self.resolution();
        self.layout.parts(whole).first().map_or(whole, |(_, part)| *part)
    }

    /// The field of view becomes narrower or wider, and is told.
    pub(super) fn zoom(&mut self, factor: f32) {
        self.eye.change(self.now, |camera, _| camera.zoomed(factor));
        if let Some(camera) = self.eye.camera() {
            let degrees = camera.rectangle().vertical_fov().to_degrees();
            self.say(format!("field of view: {degrees:.1} degrees"));
        }
    }

    /// The eye goes around by itself, where the user has not asked that nothing does.
    pub(super) fn toggle_turntable(&mut self) {
        if self.options.reduced_motion {
            self.say("nothing moves by itself with --reduced-motion");
            return;
        }
        self.eye.toggle_turntable(self.now);
    }

    /// To a view of the scene's file, or one that was saved.
    pub(super) fn go_to_view(&mut self, number: u8) {
        if self.eye.go_to(number, self.now).is_none() {
            let hint = self.hint(Command::SaveView, "saves this one");
            self.say(format!("there is no view {number}{hint}"));
        }
    }

    /// This view can be come back to.
    pub(super) fn save_view(&mut self, number: u8) {
        self.eye.save(number);
        let hint = self.hint(Command::KeepView, "writes it into the scene's file");
        self.say(format!("saved as view {number}, until you leave{hint}"));
    }
}
