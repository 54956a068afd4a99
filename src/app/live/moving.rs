//! How the eye moves, beside what held keys do.

use super::Live;
use crate::hit::closest_hit;
use crate::ray::Ray;
use glam::Vec3;

impl Live {
    /// The eye goes around what is in the middle of the picture, or flies again.
    pub(super) fn change_mode(&mut self) {
        let in_the_middle = self.in_the_middle();
        self.eye.change_mode(in_the_middle);
        self.screen.set_moving(self.eye.mode());
    }

    /// The point of the scene that the eye looks at.
    fn in_the_middle(&self) -> Option<Vec3> {
        let (scene, camera) = (&self.screen.frame()?.scene, self.eye.camera()?);
        let ray = Ray { origin: camera.pose().eye, direction: -camera.basis().w };
        closest_hit(scene, &ray).map(|hit| ray.at(hit.t))
    }
}
