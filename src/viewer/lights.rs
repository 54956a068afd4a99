//! The scene with the lights where the user has moved them.

use crate::light::Light;
use crate::scene::Scene;
use glam::Vec3;

/// The lights of the shown scene.
pub(super) struct Lights {
    /// The scene with its lights moved.
    scene: Scene,
    /// The scene as in its file.
    written: Vec<Light>,
    /// Index of the held light.
    held: Option<usize>,
    /// Number of moves so far.
    moves: u32,
}

impl Lights {
    /// Returns the scene with its lights unmoved.
    pub(super) fn of(scene: Scene) -> Self {
        Self { written: scene.lights().to_vec(), scene, held: None, moves: 0 }
    }

    /// Returns the scene with its lights moved.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn all(&self) -> &[Light] {
        self.scene.lights()
    }

    /// Returns the number of moves so far.
    pub(super) fn moves(&self) -> u32 {
        self.moves
    }

    /// Takes hold of the light after the held one, or of the one that `first` returns, and returns
    /// its index. Lights at infinity cannot be held.
    pub(super) fn take_next(&mut self, first: impl FnOnce(&[Light]) -> Option<usize>) -> Option<usize> {
        let lights = self.all();
        let after =
            |held: usize| (held + 1..lights.len()).chain(0..=held).find(|&next| lights[next].position().is_some());
        // In the order of the file, so that repeating the key visits every light.
        self.held = self.held.and_then(after).or_else(|| first(lights));
        self.held
    }

    /// Releases the held light. Returns whether there was one.
    pub(super) fn release(&mut self) -> bool {
        self.held.take().is_some()
    }

    /// Returns the position of the held light.
    pub(super) fn held(&self) -> Option<Vec3> {
        self.all().get(self.held?).and_then(Light::position)
    }

    /// Returns the position of the held light in the scene file.
    pub(super) fn home(&self) -> Option<Vec3> {
        self.written.get(self.held?).and_then(Light::position)
    }

    /// Moves the held light, if any, to a finite position.
    pub(super) fn move_held(&mut self, to: Vec3) {
        // A drag near the horizon may end in infinity.
        if let Some(held) = self.held.filter(|_| to.is_finite()) {
            let mut lights = self.all().to_vec();
            lights[held] = lights[held].moved_to(to);
            // Cheap: copies of a scene share its objects and trees.
            self.scene = self.scene.clone().with_lights(lights);
            self.moves += 1;
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
