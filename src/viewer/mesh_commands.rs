//! Commands for looking at a single object: its sides, its metadata, and the axis that is up.

use super::Viewer;
use super::axes::Axes;
use super::metadata::Metadata;
use crate::bounds::Bounds;
use crate::camera::{Camera, Pose};
use crate::control::{Command, KeyMode};
use crate::hit::{Hit, closest_hit};
use crate::scene::Scene;
use crate::text::number;
use glam::{Vec2, Vec3};

/// The direction from the target to the eye in a view from above: 0.02 radians from the vertical,
/// because exactly from above the up vector has no direction in the picture.
const ABOVE: Vec3 = Vec3::new(0.0, 0.9998, 0.02);

impl Viewer {
    /// Turns the mesh so that the next axis of its file points up.
    pub(super) fn turn_mesh(&mut self) {
        match self.scene_at_current_time().and_then(|scene| scene.mesh()) {
            Some(mesh) => self.requests.push_back(super::Request::TurnMesh(mesh.up)),
            None => self.show_note("only a mesh that is opened by itself can be turned"),
        }
    }

    /// Warns of a guessed axis of the mesh that `scene` was made around, and of its animation.
    pub(super) fn warn_about_mesh(&mut self, scene: &Scene) {
        let Some(mesh) = scene.mesh() else { return };
        if mesh.is_guess {
            let turn = self.hint(Command::TurnMesh, "turns it");
            self.warn(format!("{} is up in this {} (a guess){turn}", mesh.up.name(), mesh.format));
        }
        if let Some(seconds) = scene.animation_length() {
            let pause = if self.options.reduced_motion {
                "; --reduced-motion pauses it".to_owned()
            } else {
                self.hint(Command::Pause, "pauses it")
            };
            self.warn(format!("an animation of {} s{pause}", number(seconds as f32)));
        }
    }

    /// Looks at all bounded objects from the side that the command `side` names: front, right or
    /// above.
    pub(super) fn look_from(&mut self, side: Command) {
        let direction = match side {
            Command::Front => Vec3::Z,
            Command::FromRight => Vec3::X,
            _ => ABOVE,
        };
        let Some(bounds) = self.screen.frame().and_then(|frame| frame.scene.bounds()) else {
            self.show_note("nothing finite to fit in view");
            return;
        };
        let aspect_ratio = self.first_map_resolution().aspect_ratio();
        self.eye.jump(self.now, |camera| {
            let target = bounds.min + 0.5 * bounds.extent();
            // The distance does not matter, because `Camera::framing` replaces it.
            let pose = Pose { eye: target + direction * bounds.extent().length(), target, up: Vec3::Y };
            camera.with_pose(pose).map_or(*camera, |camera| camera.framing(&bounds, aspect_ratio))
        });
    }

    /// Shows or hides the drawing of the axes.
    pub(super) fn toggle_axes(&mut self) {
        if self.screen.close::<Axes>().is_none() {
            self.screen.open(Axes);
        }
    }

    /// Opens or closes the panel of facts about the scene, whose name the driver knows.
    pub(super) fn toggle_metadata(&mut self) {
        if self.screen.close::<Metadata>().is_none() {
            self.requests.push_back(super::Request::ShowMetadata);
        }
    }

    /// Opens the panel of facts about the shown scene; `name` is the scene's name in the panel.
    pub(crate) fn show_metadata(&mut self, name: String) {
        if let Some(scene) = self.scene_at_current_time() {
            self.screen.open(Metadata::for_scene(&scene, name));
        }
    }

    /// Returns the closest hit at a position of the screen, and the point that was hit.
    fn hit_at(&self, at: Vec2) -> Option<(Hit, Vec3)> {
        let ray = self.eye_ray_at(at)?;
        let hit = closest_hit(&self.screen.frame()?.scene, &ray)?;
        Some((hit, ray.at(hit.t)))
    }

    /// Returns the object at a position of the screen.
    pub(super) fn object_at(&self, at: Vec2) -> Option<u32> {
        self.hit_at(at).map(|(hit, _)| hit.object)
    }

    /// Makes the surface point at a position of the screen the target, in the middle of the
    /// picture.
    ///
    /// Does nothing except in orbit mode, in which the camera turns about the target.
    pub(super) fn centre_on(&mut self, at: Vec2) {
        if self.eye.mode() == KeyMode::Orbit
            && let Some((_, point)) = self.hit_at(at)
        {
            self.eye.jump(self.now, |camera| panned_to_target(camera, point));
        }
    }

    /// Moves the eye until an object fills the picture.
    ///
    /// Without an object, or with an unbounded one, all bounded objects together fill it.
    pub(super) fn frame_object(&mut self, object: Option<u32>) {
        match object.and_then(|object| self.bounds_of(object)) {
            Some(bounds) => {
                let aspect_ratio = self.first_map_resolution().aspect_ratio();
                self.eye.jump(self.now, |camera| camera.framing(&bounds, aspect_ratio));
            }
            None => self.frame_everything(),
        }
    }

    fn bounds_of(&self, object: u32) -> Option<Bounds> {
        self.screen.frame()?.scene.objects().get(object as usize)?.shape.bounds()
    }
}

/// Returns the camera shifted sideways so that `target` becomes its target, at an unchanged depth.
fn panned_to_target(camera: &Camera, target: Vec3) -> Camera {
    let (pose, w) = (camera.pose(), camera.basis().w);
    let depth = (pose.eye - target).dot(w);
    camera.with_pose(Pose { eye: target + depth * w, target, ..pose }).unwrap_or(*camera)
}
