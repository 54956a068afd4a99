//! The shown scene, and the views in which other scenes were left.

use super::eye::View;
use super::lights::Lights;
use crate::camera::Camera;
use crate::scene::Scene;
use std::collections::HashMap;

/// The shown scene and the saved views of the others.
#[derive(Default)]
pub(super) struct Gallery {
    /// `None` without a scene.
    now: Option<Now>,
    /// The view in which each scene was left, by the scene's number.
    left: HashMap<usize, View>,
    /// Number of scenes shown so far.
    count: u32,
}

struct Now {
    /// The scene's number in the driver's list.
    of: usize,
    /// The scene's own camera.
    home: Camera,
    lights: Lights,
}

impl Gallery {
    /// Shows a scene. Returns the view to start from, or `None` to keep the current one because it is of a scene with
    /// the same camera. A scene with the same camera as when it was left starts from where it was left.
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

    /// Records the view in which a scene is left.
    pub(super) fn leave(&mut self, of: usize, view: View) {
        self.left.insert(of, view);
    }

    /// Returns the number of the shown scene in the driver's list.
    pub(super) fn shown(&self) -> Option<usize> {
        self.now.as_ref().map(|now| now.of)
    }

    /// Returns the number of scenes shown so far.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// Returns the lights of the shown scene.
    pub(super) fn lights(&self) -> Option<&Lights> {
        self.now.as_ref().map(|now| &now.lights)
    }

    /// Returns the lights of the shown scene, to move them.
    pub(super) fn lights_mut(&mut self) -> Option<&mut Lights> {
        self.now.as_mut().map(|now| &mut now.lights)
    }
}
