//! A scene, and its lights where the user has moved them.

use crate::light::PointLight;
use crate::scene::Scene;
use glam::Vec3;

/// The lights of the scene that is shown.
pub(super) struct Lights {
    /// With the lights where they are.
    scene: Scene,
    /// As the scene's file has them.
    written: Vec<PointLight>,
    /// Which one the user has taken hold of.
    held: Option<usize>,
    /// How many times one was moved.
    moves: u32,
}

impl Lights {
    /// As the scene has them.
    pub(super) fn of(scene: Scene) -> Self {
        Self { written: scene.lights().to_vec(), scene, held: None, moves: 0 }
    }

    /// The scene, with the lights where they are.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn all(&self) -> &[PointLight] {
        self.scene.lights()
    }

    /// How many times one was moved.
    pub(super) fn moves(&self) -> u32 {
        self.moves
    }

    /// Takes hold of the light after the one that is held, or else of the one that `first` gives; its number.
    pub(super) fn take_next(&mut self, first: impl FnOnce(&[PointLight]) -> Option<usize>) -> Option<usize> {
        let count = self.all().len();
        self.held = self.held.map(|held| (held + 1) % count).or_else(|| first(self.all()));
        self.held
    }

    /// Lets go; whether there was one that was held.
    pub(super) fn let_go(&mut self) -> bool {
        self.held.take().is_some()
    }

    /// Where the one is that is held.
    pub(super) fn held(&self) -> Option<Vec3> {
        self.all().get(self.held?).map(|light| light.position)
    }

    /// Where the scene has the one that is held.
    pub(super) fn home(&self) -> Option<Vec3> {
        self.written.get(self.held?).map(|light| light.position)
    }

    /// Moves the one that is held, if there is one, to a place that is finite.
    pub(super) fn move_held(&mut self, to: Vec3) {
        if let Some(held) = self.held.filter(|_| to.is_finite()) {
            let mut lights = self.all().to_vec();
            lights[held].position = to;
            self.scene = self.scene.clone().with_lights(lights);
            self.moves += 1;
        }
    }
}
