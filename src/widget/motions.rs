//! What keys and the mouse do to the camera of a pane.

use super::SceneState;
use crate::camera::Grip;
use crate::hit::closest_hit;
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use ratatui_core::layout::Position;

impl SceneState {
    /// Moves the eye around the target, to the right and upwards, by angles in radians: see
    /// [`Camera::orbited`](crate::camera::Camera::orbited).
    pub fn orbit(&mut self, right: f32, up: f32) {
        self.move_camera(self.camera().orbited(right, up));
    }

    /// Moves eye and target to the right and upwards, by parts of the picture's height at the target.
    pub fn pan(&mut self, right: f32, up: f32) {
        let aspect_ratio = self.aspect_ratio();
        self.move_camera(self.camera().panned(Vec2::new(-right / aspect_ratio, up), aspect_ratio));
    }

    /// Multiplies the distance from the eye to the target by `factor`. It stays within 0.001 and 10,000 times the distance
    /// that it had in the camera that was [set](Self::set_camera) last, or after [`frame`](Self::frame).
    pub fn nearer(&mut self, factor: f32) {
        self.move_camera(self.camera().nearer_within(factor, self.scale()));
    }

    /// Looks in the same direction from where the pane is filled by everything in the scene that has an end. Nothing
    /// happens in a scene without such objects. Before the first draw call the pane is taken for a square.
    pub fn frame(&mut self, scene: &Scene) {
        if let Some(bounds) = scene.bounds() {
            let camera = self.camera().framing(&bounds, self.aspect_ratio());
            self.set_camera(&camera);
        }
    }

    /// Takes hold of the picture, if the position is inside it, until [`release`](Self::release). Returns whether it is.
    pub fn press(&mut self, at: Position, grip: Grip) -> bool {
        self.hold(self.ray_through(at).map(|_| (grip, at)));
        self.held().is_some()
    }

    /// Drags what is held to a position, which may be outside the pane. Nothing happens if nothing is held.
    pub fn drag(&mut self, to: Position) {
        let (Some((grip, from)), Some(size)) = (self.held(), self.size()) else { return };
        self.hold(Some((grip, to)));
        let way = |from: u16, to: u16| f32::from(to) - f32::from(from);
        let by = Vec2::new(way(from.x, to.x), way(from.y, to.y)) / size;
        let aspect_ratio = self.aspect_ratio();
        self.move_camera(match grip {
            Grip::Turn => self.camera().dragged_around(by, aspect_ratio),
            Grip::Pan => self.camera().panned(by, aspect_ratio),
        });
    }

    /// Lets go of the picture.
    pub fn release(&mut self) {
        self.hold(None);
    }

    /// Moves nearer to what is seen in the cell at a position, which stays where it is in the picture, by notches of the mouse
    /// wheel: away for less than 0. Returns whether the position is inside the picture.
    pub fn scroll(&mut self, scene: &Scene, at: Position, notches: f32) -> bool {
        let Some(point) = self.point_at(scene, at) else { return false };
        self.move_camera(self.camera().wheeled_around(point, notches, self.scale()));
        true
    }

    /// The point that is seen in a cell; where there is nothing, one as far away as the target.
    fn point_at(&self, scene: &Scene, at: Position) -> Option<Vec3> {
        let ray = self.ray_through(at)?;
        // Along -w, t is the depth.
        Some(ray.at(closest_hit(scene, &ray).map_or(self.camera().target_distance(), |hit| hit.t)))
    }
}
