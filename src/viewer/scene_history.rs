//! The shown scene, and the views in which other scenes were left.

use super::eye::ViewState;
use super::lights::Lights;
use crate::camera::Camera;
use crate::scene::Scene;
use std::collections::HashMap;

/// The shown scene and the saved views of the others.
#[derive(Default)]
pub(super) struct SceneHistory {
    /// `None` without a scene.
    current: Option<Current>,
    /// The view in which each scene was left, by the scene's number.
    left: HashMap<usize, ViewState>,
    /// Number of scenes shown so far.
    count: u32,
}

struct Current {
    /// The scene's number in the driver's list.
    of: usize,
    /// The scene's own camera.
    home: Camera,
    lights: Lights,
}

impl SceneHistory {
    /// Shows a scene.
    ///
    /// Returns the view to start from, or `None` to keep the current one because it is of a scene with the same camera.
    /// A scene with the same camera as when it was left starts from where it was left.
    pub(super) fn show(&mut self, scene: Scene, of: usize, orbits: bool) -> Option<ViewState> {
        let home = *scene.camera();
        let before = self.current.as_ref().map(|current| (current.of, current.home));
        // A reload with the same camera keeps the user's view: only something else in the file was edited. If the
        // camera was edited, the user wants to see the new one.
        let view = (before != Some((of, home))).then(|| {
            // Only if the file's camera is still the same: an edited camera is meant to be seen.
            let left = self.left.remove(&of).filter(|left| left.home() == home);
            left.unwrap_or_else(|| ViewState::of(&scene, orbits))
        });
        self.current = Some(Current { of, home, lights: Lights::of(scene) });
        self.count += 1;
        view
    }

    /// Records the view in which a scene is left.
    pub(super) fn leave(&mut self, of: usize, view: ViewState) {
        self.left.insert(of, view);
    }

    /// Returns the number of the shown scene in the driver's list.
    pub(super) fn shown(&self) -> Option<usize> {
        self.current.as_ref().map(|current| current.of)
    }

    /// Returns the number of scenes shown so far.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// Returns the lights of the shown scene.
    pub(super) fn lights(&self) -> Option<&Lights> {
        self.current.as_ref().map(|current| &current.lights)
    }

    /// Returns the lights of the shown scene, to move them.
    pub(super) fn lights_mut(&mut self) -> Option<&mut Lights> {
        self.current.as_mut().map(|current| &mut current.lights)
    }
}
