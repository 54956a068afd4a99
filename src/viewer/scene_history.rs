//! The shown scene, and the views in which the user left other scenes.

use super::eye::ViewState;
use super::lights::Lights;
use crate::camera::Camera;
use crate::scene::Scene;
use std::collections::HashMap;

/// The shown scene, and the view in which the user left each of the other scenes.
#[derive(Default)]
pub(super) struct SceneHistory {
    /// The shown scene; `None` before the first.
    current: Option<Current>,
    /// The view in which each scene was left, by the scene's index in the driver's list.
    left: HashMap<usize, ViewState>,
    /// Number of scenes shown so far; a scene that is loaded again counts again.
    count: u32,
}

struct Current {
    /// The scene's index in the driver's list.
    index: usize,
    /// The scene's own camera.
    home: Camera,
    lights: Lights,
}

impl SceneHistory {
    /// Makes `scene` the shown one and returns the view that it starts from.
    ///
    /// That is the view in which the scene was left, if the scene's own camera has not changed since then, and
    /// otherwise its initial view. `None` keeps the current view: the scene was shown already and is loaded again with
    /// the same own camera.
    pub(super) fn show(&mut self, scene: Scene, index: usize, orbits: bool) -> Option<ViewState> {
        let home = *scene.camera();
        let before = self.current.as_ref().map(|current| (current.index, current.home));
        // If a scene is loaded again with the same own camera, something else in its file was edited, and the user's
        // view is kept. If the camera was edited, the user wants to see the new one.
        let view = (before != Some((index, home))).then(|| {
            // The view in which the user left the scene is restored only if the scene's own camera was not edited
            // since.
            let left = self.left.remove(&index).filter(|left| left.home() == home);
            left.unwrap_or_else(|| ViewState::initial(&scene, orbits))
        });
        self.current = Some(Current { index, home, lights: Lights::new(scene) });
        self.count += 1;
        view
    }

    /// Records the view in which a scene is left.
    pub(super) fn record_left(&mut self, index: usize, view: ViewState) {
        self.left.insert(index, view);
    }

    /// Returns the index of the shown scene in the driver's list.
    pub(super) fn shown(&self) -> Option<usize> {
        self.current.as_ref().map(|current| current.index)
    }

    /// Returns the number of scenes shown so far.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// Returns the lights of the shown scene.
    pub(super) fn lights(&self) -> Option<&Lights> {
        self.current.as_ref().map(|current| &current.lights)
    }

    /// Returns the lights of the shown scene, for moving them.
    pub(super) fn lights_mut(&mut self) -> Option<&mut Lights> {
        self.current.as_mut().map(|current| &mut current.lights)
    }
}
