//! Lights that the user moves.

use super::Live;
use crate::camera::Camera;
use crate::control::{self, Command, Toward};
use crate::light::PointLight;
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// A press moves a light by so much of the picture's height,
const STEP: f32 = 1.0 / 32.0;
/// and with Shift so many times as far.
const FASTER: f32 = 4.0;

/// The lights of the scene that is shown.
#[derive(Default)]
pub(super) struct Lights {
    /// With the lights where they are.
    scene: Option<Arc<Scene>>,
    /// As the scene's file has them.
    written: Vec<PointLight>,
    /// Which one the user has taken hold of.
    held: Option<usize>,
    /// Whether any has moved since a frame was begun.
    changed: bool,
}

impl Lights {
    /// As the scene has them.
    pub(super) fn of(scene: &Arc<Scene>) -> Self {
        Self { scene: Some(Arc::clone(scene)), written: scene.lights.clone(), held: None, changed: false }
    }

    fn all(&self) -> &[PointLight] {
        self.scene.as_ref().map_or(&[], |scene| &scene.lights)
    }

    /// Where the one is that is held.
    fn held(&self) -> Option<Vec3> {
        self.all().get(self.held?).map(|light| light.position)
    }

    /// Moves the one that is held; whether there is one, and a place that is finite.
    fn move_held(&mut self, to: Vec3) -> bool {
        let (Some(scene), Some(held)) = (&mut self.scene, self.held) else { return false };
        if !to.is_finite() {
            return false;
        }
        Arc::make_mut(scene).lights[held].position = to;
        self.changed = true;
        true
    }

    /// The scene, if any light of it has moved since it was last asked for.
    pub(super) fn take_changed(&mut self) -> Option<Arc<Scene>> {
        std::mem::take(&mut self.changed).then(|| self.scene.clone()).flatten()
    }
}

impl Live {
    /// Takes hold of the light that is nearest to the pointer on the screen; of the next one, if one is held.
    pub(super) fn take_light(&mut self) {
        let count = self.lights.all().len();
        let Some(light) = self.lights.held.map(|held| (held + 1) % count).or_else(|| self.nearest_light()) else {
            self.screen.say("this scene has no light that could be moved");
            return;
        };
        self.lights.held = Some(light);
        let at = self.lights.held();
        let is_seen = |camera: Camera| at.is_some_and(|at| control::place_of(&camera, at, 1.0).is_some());
        let behind = if self.eye.camera().is_some_and(is_seen) { "" } else { ", behind the eye" };
        self.screen.mark_light(at);
        self.screen.say(format!(
            "light {} of {count}{behind}: drag it{}",
            light + 1,
            self.hint(Command::Help, "shows its keys")
        ));
    }

    /// Lets go of it; whether there was one.
    pub(super) fn leave_light(&mut self) -> bool {
        self.screen.mark_light(None);
        self.lights.held.take().is_some()
    }

    pub(super) fn holds_light(&self) -> bool {
        self.lights.held.is_some()
    }

    /// In front of the eye, if there is one there.
    fn nearest_light(&self) -> Option<usize> {
        let camera = self.eye.camera()?;
        let aspect_ratio = self.part().aspect_ratio();
        let pointer = self.pointer.at().unwrap_or(Vec2::splat(0.5));
        let away = |light: &PointLight| {
            let place = control::place_of(&camera, light.position, aspect_ratio);
            place.map_or(f32::INFINITY, |place| ((place - pointer) * Vec2::new(aspect_ratio, 1.0)).length())
        };
        let lights = self.lights.all().iter().map(away).enumerate();
        lights.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(light, _)| light)
    }

    /// The light goes one step as the screen has it.
    pub(super) fn step_light(&mut self, toward: Toward, more: bool) {
        let (across, down) = match toward {
            Toward::Left => (-1.0, 0.0),
            Toward::Right => (1.0, 0.0),
            Toward::Up => (0.0, -1.0),
            Toward::Down => (0.0, 1.0),
        };
        let step = if more { FASTER * STEP } else { STEP };
        self.drag_light(step * Vec2::new(across / self.part().aspect_ratio(), down));
    }

    /// The light goes so far to the right and down, in parts of the picture's width and height.
    pub(super) fn drag_light(&mut self, by: Vec2) {
        let aspect_ratio = self.part().aspect_ratio();
        if let (Some(camera), Some(from)) = (self.eye.camera(), self.lights.held()) {
            self.light_to(control::point_dragged(&camera, from, by, aspect_ratio));
        }
    }

    /// The light goes away from the eye.
    pub(super) fn wheel_light(&mut self, notches: f32) {
        if let (Some(camera), Some(from)) = (self.eye.camera(), self.lights.held()) {
            self.light_to(control::point_wheeled(&camera, from, notches));
        }
    }

    /// The light goes back to where the scene has it.
    pub(super) fn put_light_back(&mut self) {
        let written = self.lights.held.and_then(|held| self.lights.written.get(held));
        if let Some(written) = written.map(|light| light.position) {
            self.light_to(written);
        }
    }

    fn light_to(&mut self, to: Vec3) {
        if self.lights.move_held(to) {
            self.screen.mark_light(Some(to));
            self.stale = true;
        }
    }
}
