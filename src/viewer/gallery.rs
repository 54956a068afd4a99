//! Which scene is shown, and how the others were looked at.

use super::eye::View;
use super::lights::Lights;
use crate::camera::Camera;
use crate::scene::Scene;
use std::collections::HashMap;

/// The scene that is shown, and what is kept of others.
#[derive(Default)]
pub(super) struct Gallery {
    /// `None` as long as there is nothing to see.
    now: Option<Now>,
    /// How others were looked at when they were left, by their number.
    left: HashMap<usize, View>,
    /// How many scenes were shown up to now.
    count: u32,
}

struct Now {
    /// The scene's number among those that there are to look at.
    of: usize,
    /// From where it wants to be looked at.
    home: Camera,
    lights: Lights,
}

impl Gallery {
    /// Shows a scene. Returns how it is looked at, unless that is as the one before, which wanted to be looked at in the
    /// same way: as when it was left, if it wants to be looked at as it did then; else as it wants.
    pub(super) fn show(&mut self, scene: Scene, of: usize, orbits: bool) -> Option<View> {
        let home = *scene.camera();
        let before = self.now.as_ref().map(|now| (now.of, now.home));
        let view = (before != Some((of, home))).then(|| {
            let left = self.left.remove(&of).filter(|left| left.home() == home);
            left.unwrap_or_else(|| View::of(&scene, orbits))
        });
        self.now = Some(Now { of, home, lights: Lights::of(scene) });
        self.count += 1;
        view
    }

    /// The scene of that number was looked at like this when it was left.
    pub(super) fn leave(&mut self, of: usize, view: View) {
        self.left.insert(of, view);
    }

    /// The number of the scene that is shown, among those that there are to look at.
    pub(super) fn shown(&self) -> Option<usize> {
        self.now.as_ref().map(|now| now.of)
    }

    /// How many scenes were shown up to now.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// The lights of the scene that is shown.
    pub(super) fn lights(&self) -> Option<&Lights> {
        self.now.as_ref().map(|now| &now.lights)
    }

    /// The lights of the scene that is shown, to be moved.
    pub(super) fn lights_mut(&mut self) -> Option<&mut Lights> {
        self.now.as_mut().map(|now| &mut now.lights)
    }
}
