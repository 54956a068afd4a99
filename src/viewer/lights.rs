//! The scene with the lights where the user has moved them.

use crate::light::Light;
use crate::scene::Scene;
use glam::Vec3;

/// The shown scene, its lights before they were moved, and the light that the user holds.
pub(super) struct Lights {
    /// The scene with its lights where the user has moved them.
    scene: Scene,
    /// The lights as in the scene file.
    written: Vec<Light>,
    /// Index of the held light.
    held: Option<usize>,
    /// Number of times that a light has been moved.
    move_count: u32,
}

impl Lights {
    /// Returns the lights of a scene before any move.
    pub(super) fn new(scene: Scene) -> Self {
        Self { written: scene.lights().to_vec(), scene, held: None, move_count: 0 }
    }

    /// Returns the scene with its lights where the user has moved them.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn all(&self) -> &[Light] {
        self.scene.lights()
    }

    /// Returns the number of times that a light has been moved.
    pub(super) fn move_count(&self) -> u32 {
        self.move_count
    }

    /// Takes hold of the next light after the held one and returns its index.
    ///
    /// If none is held, takes hold of the light whose index `first` returns. Lights at infinity cannot be held.
    pub(super) fn cycle_held(&mut self, first: impl FnOnce(&[Light]) -> Option<usize>) -> Option<usize> {
        let lights = self.all();
        let after = |held| next_after(held, lights.len(), |light| lights[light].position().is_some());
        // The next light is the next one in the file, so that repeating the key visits every light.
        self.held = self.held.and_then(after).or_else(|| first(lights));
        self.held
    }

    /// Releases the held light. Returns whether a light was held.
    pub(super) fn release(&mut self) -> bool {
        self.held.take().is_some()
    }

    /// Returns the position of the held light.
    pub(super) fn held_position(&self) -> Option<Vec3> {
        self.all().get(self.held?).and_then(Light::position)
    }

    /// Returns the position of the held light in the scene file.
    pub(super) fn held_position_in_file(&self) -> Option<Vec3> {
        self.written.get(self.held?).and_then(Light::position)
    }

    /// Moves the held light, if any, to this position, unless that is infinite.
    pub(super) fn move_held(&mut self, position: Vec3) {
        // A drag near the horizon may move the light to infinity.
        if let Some(held) = self.held.filter(|_| position.is_finite()) {
            let mut lights = self.all().to_vec();
            lights[held] = lights[held].moved_to(position);
            // Cloning is cheap, because clones of a scene share its objects and trees.
            self.scene = self.scene.clone().with_lights(lights);
            self.move_count += 1;
        }
    }
}

/// Returns the first of `count` indices after `held`, cyclically, for which `can_be_held` is true.
fn next_after(held: usize, count: usize, can_be_held: impl Fn(usize) -> bool) -> Option<usize> {
    (held + 1..count).chain(0..=held).find(|&next| can_be_held(next))
}

#[cfg(all(test, unit_tests))]
mod tests;
