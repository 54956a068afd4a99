//! Commands that take hold of a light, move it and release it.

use super::Viewer;
use super::light_marker::LightMarker;
use super::lights::Lights;
use crate::camera::Camera;
use crate::control::{Command, Toward};
use crate::hit::closest_hit;
use crate::light::Light;
use crate::ray::Ray;
use glam::{Vec2, Vec3};

/// Distance that a key press moves the light, as a share of the picture's height.
// 32 presses move the light across the picture, or 8 with Shift.
const LIGHT_STEP: f32 = 1.0 / 32.0;
/// Factor by which Shift multiplies [`LIGHT_STEP`].
// The same factor as for the movement keys, which the help names once for all: "4x faster".
const LIGHT_SHIFT_FACTOR: f32 = 4.0;

impl Viewer {
    /// Takes hold of the light nearest to the pointer on the screen, or of the next one if a light
    /// is held.
    pub(super) fn take_light(&mut self) {
        let (camera, aspect_ratio) = (self.eye.camera(), self.first_map_resolution().aspect_ratio());
        // Before the first mouse event, the middle of the screen counts as the pointer.
        let pointer = self.pointer.at().unwrap_or(Vec2::splat(0.5));
        let nearest = |lights: &[Light]| nearest_light(lights, &camera?, pointer, aspect_ratio);
        let taken = self.scenes.lights_mut().and_then(|lights| {
            let light = lights.cycle_held(nearest)?;
            Some((light, lights.all().len(), lights.held_position()))
        });
        let Some((light, count, at)) = taken else {
            self.show_note("this scene has no movable light");
            return;
        };
        let is_seen = |camera: Camera| at.is_some_and(|at| camera.project(at, 1.0).is_some());
        let behind = if camera.is_some_and(is_seen) { "" } else { ", behind the eye" };
        self.mark_light();
        let hint = self.hint(Command::Help, "shows its keys");
        self.show_note(format!("light {} of {count}{behind}: drag it{hint}", light + 1));
    }

    /// Opens the marker of the held light, or closes it if none is held.
    pub(super) fn mark_light(&mut self) {
        let scene = self.scenes.lights().map(Lights::scene);
        let marker = self.held_light().zip(scene).map(|(light, scene)| {
            let down = Ray { origin: light, direction: Vec3::NEG_Y };
            LightMarker { light, below: closest_hit(scene, &down).map(|hit| down.at(hit.t)) }
        });
        self.screen.set(marker);
    }

    fn held_light(&self) -> Option<Vec3> {
        self.scenes.lights()?.held_position()
    }

    /// Releases the held light. Returns whether a light was held.
    pub(super) fn release_light(&mut self) -> bool {
        let was_held = self.scenes.lights_mut().is_some_and(Lights::release);
        self.mark_light();
        was_held
    }

    pub(super) fn holds_light(&self) -> bool {
        self.held_light().is_some()
    }

    /// Moves the held light by one step in a direction of the screen.
    pub(super) fn step_light(&mut self, toward: Toward, faster: bool) {
        let (across, down) = match toward {
            Toward::Left => (-1.0, 0.0),
            Toward::Right => (1.0, 0.0),
            Toward::Up => (0.0, -1.0),
            Toward::Down => (0.0, 1.0),
        };
        let step = if faster { LIGHT_SHIFT_FACTOR * LIGHT_STEP } else { LIGHT_STEP };
        // The step is a share of the picture's height, but `drag_light` counts horizontally in shares of its width.
        self.drag_light(step * Vec2::new(across / self.first_map_resolution().aspect_ratio(), down));
    }

    /// Moves the held light right and down by shares of the picture's width and height, at constant
    /// depth.
    pub(super) fn drag_light(&mut self, shares: Vec2) {
        let aspect_ratio = self.first_map_resolution().aspect_ratio();
        self.move_light(|camera, from| camera.point_dragged(from, shares, aspect_ratio));
    }

    /// Moves the held light away from the eye by notches of the mouse wheel; negative notches move
    /// it nearer.
    pub(super) fn wheel_light(&mut self, notches: f32) {
        self.move_light(|camera, from| camera.point_pushed_away(from, notches));
    }

    /// Moves the held light back to its position in the scene file.
    pub(super) fn put_light_back(&mut self) {
        if let Some(lights) = self.scenes.lights_mut()
            && let Some(home) = lights.held_position_in_file()
        {
            lights.move_held(home);
        }
    }

    fn move_light(&mut self, moved: impl FnOnce(&Camera, Vec3) -> Vec3) {
        if let Some(camera) = self.eye.camera()
            && let Some(lights) = self.scenes.lights_mut()
            && let Some(from) = lights.held_position()
        {
            lights.move_held(moved(&camera, from));
        }
    }
}

/// Returns the index of the light that is nearest to the pointer on the screen.
///
/// Lights behind the eye count as infinitely far from the pointer, and lights at infinity are left out.
fn nearest_light(lights: &[Light], camera: &Camera, pointer: Vec2, aspect_ratio: f32) -> Option<usize> {
    let away = |position: Vec3| {
        let place = camera.project(position, aspect_ratio);
        // Measured in heights of the picture along both axes, so that distances are those that the user sees.
        place.map_or(f32::INFINITY, |place| ((place - pointer) * Vec2::new(aspect_ratio, 1.0)).length())
    };
    let lights = lights.iter().enumerate().filter_map(|(light, of)| Some((light, away(of.position()?))));
    lights.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(light, _)| light)
}
