//! A scene on its way: read and checked, but not built.

use super::{Checked, Scene};
use crate::accel::Accelerator;
use crate::camera::Camera;
use crate::progress::{Cancelled, Watcher};
use std::sync::Arc;

/// A scene of which all is known, and which no ray can be sent into yet: for that it is
/// [built](Self::build_or_cancel). In the meantime a [sketch](Self::sketch) can be looked at.
#[derive(Clone, Debug)]
pub struct Draft {
    pub(super) checked: Arc<Checked>,
}

impl Draft {
    pub(super) fn new(checked: Checked) -> Self {
        Self { checked: checked.into() }
    }

    /// Where the scene wants to be looked at from.
    pub fn camera(&self) -> &Camera {
        &self.checked.camera
    }

    /// The same scene, looked at from somewhere else.
    pub fn with_camera(mut self, camera: Camera) -> Self {
        Arc::make_mut(&mut self.checked).camera = camera;
        self
    }

    /// The scene, built on all threads of the current rayon pool, until the watcher cancels it.
    ///
    /// # Errors
    /// [`Cancelled`], if the watcher cancels it.
    pub fn build_or_cancel(self, watcher: &Watcher<'_>) -> Result<Scene, Cancelled> {
        let accelerator = Accelerator::new_or_cancel(self.checked.shapes(), watcher)?.into();
        Ok(Scene { checked: self.checked, accelerator })
    }

    /// The scene, however long it takes.
    pub fn finish(self) -> Scene {
        let accelerator = Accelerator::new(self.checked.shapes()).into();
        Scene { checked: self.checked, accelerator }
    }
}
