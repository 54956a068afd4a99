//! Drafts: scenes that are read and checked but have no trees yet.

use super::{Checked, MeshOrigin, Scene, ShadingNeeds};
use crate::accel::Accelerator;
use crate::bvh::MIN_TASK_ITEMS;
use crate::camera::Camera;
use crate::progress::{Cancelled, Reporter};
use crate::shape::Shape;
use std::sync::Arc;

/// A scene whose trees are not built yet, so that no ray can be traced in it.
///
/// [`build_or_cancel`](Self::build_or_cancel) builds the trees; meanwhile a [sketch](Self::sketch) can be shown.
#[derive(Clone, Debug)]
pub struct Draft {
    pub(super) checked: Arc<Checked>,
}

impl Draft {
    pub(super) fn new(mut checked: Checked) -> Self {
        checked.needs = ShadingNeeds::of(&checked.objects);
        if checked.lecture {
            checked.needs = ShadingNeeds { holes: checked.needs.holes, ..ShadingNeeds::default() };
        }
        Self { checked: checked.into() }
    }

    /// Returns the scene's own camera.
    pub fn camera(&self) -> &Camera {
        &self.checked.camera
    }

    /// Returns the mesh file around which the scene was made; `None` for a scene with its own file.
    pub fn mesh(&self) -> Option<MeshOrigin> {
        self.checked.mesh
    }

    /// Returns the draft with the lecture's model of light only: diffuse reflection, opaque
    /// surfaces, clear air, and lights without a size that shine in all directions.
    ///
    /// A [`Sun`](crate::light::Sun) stays as it is: a point source that is infinitely far away.
    pub fn in_lecture(self) -> Self {
        let checked = Arc::unwrap_or_clone(self.checked);
        Self::new(checked.in_lecture())
    }

    /// Returns the draft with another camera.
    pub fn with_camera(mut self, camera: Camera) -> Self {
        Arc::make_mut(&mut self.checked).camera = camera;
        self
    }

    /// Returns whether the trees are large enough to be built on several threads.
    pub fn builds_in_parallel(&self) -> bool {
        let primitives = |shape: &Shape| if let Shape::Mesh(mesh) = shape { mesh.triangle_count() as usize } else { 1 };
        self.checked.shapes().map(primitives).sum::<usize>() >= MIN_TASK_ITEMS
    }

    /// Builds the trees on all threads of the current rayon pool, unless the reporter cancels the
    /// build.
    ///
    /// # Errors
    /// [`Cancelled`], if the reporter cancels.
    pub fn build_or_cancel(self, reporter: &Reporter<'_>) -> Result<Scene, Cancelled> {
        let accelerator = Accelerator::new_or_cancel(self.checked.shapes(), reporter)?.into();
        Ok(Scene { checked: self.checked, accelerator })
    }

    /// Builds the trees without a way to cancel.
    pub fn finish(self) -> Scene {
        let accelerator = Accelerator::new(self.checked.shapes()).into();
        Scene { checked: self.checked, accelerator }
    }
}
