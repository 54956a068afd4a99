//! Motions of a pane's camera by keys and the mouse.

use super::SceneState;
use crate::camera::Grip;
use crate::hit::closest_hit;
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use ratatui_core::layout::Position;

impl SceneState {
    /// Moves the eye around the target, to the right and upwards, by angles in radians.
    ///
    /// See [`Camera::orbited`](crate::camera::Camera::orbited).
    pub fn orbit(&mut self, right: f32, up: f32) {
        self.set_camera_only(self.camera().orbited(right, up));
    }

    /// Moves eye and target to the right and upwards.
    ///
    /// Distances are shares of the height of the view rectangle at the target's distance.
    pub fn pan(&mut self, right: f32, up: f32) {
        let aspect_ratio = self.aspect_ratio();
        self.set_camera_only(self.camera().panned(Vec2::new(-right / aspect_ratio, up), aspect_ratio));
    }

    /// Multiplies the distance from eye to target by `distance_factor`: below 1 moves nearer.
    ///
    /// The distance stays within 0.001 and 10,000 times that of the camera [set](Self::set_camera) last, or of the last
    /// [`frame`](Self::frame).
    pub fn nearer(&mut self, distance_factor: f32) {
        self.set_camera_only(self.camera().nearer_within(distance_factor, self.initial_target_distance()));
    }

    /// Moves the camera so that all bounded objects of the scene fill the pane, without turning it.
    ///
    /// Does nothing if there are no such objects. Before the first draw call the pane counts as a square.
    pub fn frame(&mut self, scene: &Scene) {
        if let Some(bounds) = scene.bounds() {
            let camera = self.camera().framing(&bounds, self.aspect_ratio());
            self.set_camera(&camera);
        }
    }

    /// Starts a drag, until [`release`](Self::release).
    ///
    /// Returns whether the position is inside the picture.
    pub fn press(&mut self, at: Position, grip: Grip) -> bool {
        // A press outside the picture ends a previous drag, so that a missed release does no harm.
        self.set_drag_state(self.ray_through(at).map(|_| (grip, at)));
        self.drag_state().is_some()
    }

    /// Continues a drag to a position, which may be outside the pane. Does nothing without a drag.
    pub fn drag(&mut self, to: Position) {
        let (Some((grip, from)), Some(size)) = (self.drag_state(), self.size_in_cells()) else { return };
        self.set_drag_state(Some((grip, to)));
        let delta = |from: u16, to: u16| f32::from(to) - f32::from(from);
        let by = Vec2::new(delta(from.x, to.x), delta(from.y, to.y)) / size;
        let aspect_ratio = self.aspect_ratio();
        self.set_camera_only(match grip {
            Grip::Turn => self.camera().dragged_around(by, aspect_ratio),
            Grip::Pan => self.camera().panned(by, aspect_ratio),
        });
    }

    /// Ends a drag.
    pub fn release(&mut self) {
        self.set_drag_state(None);
    }

    /// Moves the eye towards the point shown at a position, by notches of the mouse wheel.
    ///
    /// Negative notches move away. The point keeps its place in the picture. Returns whether the position is inside the
    /// picture.
    pub fn scroll(&mut self, scene: &Scene, at: Position, notches: f32) -> bool {
        let Some(point) = self.zoom_point_at(scene, at) else { return false };
        self.set_camera_only(self.camera().scaled_about(point, notches, self.initial_target_distance()));
        true
    }

    /// Returns the surface point seen in a cell, or a point at the target's distance if there is
    /// none.
    fn zoom_point_at(&self, scene: &Scene, position: Position) -> Option<Vec3> {
        let ray = self.ray_through(position)?;
        // Eye rays have a component of 1 along -w, so t is the depth, as the target's distance is.
        Some(ray.at(closest_hit(scene, &ray).map_or(self.camera().target_distance(), |hit| hit.t)))
    }
}
