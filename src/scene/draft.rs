//! A scene on its way: read and checked, but not built.

use super::{Checked, Object, Scene};
use crate::accel::Accelerator;
use crate::camera::Camera;
use crate::progress::{Cancelled, Watcher};
use crate::shape::{Mesh, Shape};
use std::sync::Arc;

/// A scene of which all is known, and which no ray can be sent into yet: for that it is
/// [built](Self::build_or_cancel). In the meantime a [sketch](Self::sketch) can be looked at.
#[derive(Clone, Debug)]
pub struct Draft {
    checked: Arc<Checked>,
}

/// Of so many triangles and more the scene is sketched: fewer are built as quickly.
const MANY: u32 = 1 << 17;

/// A sketched mesh has about so many details along its longest side: as many as a screen shows.
const DETAILS: f32 = 64.0;

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

    /// The scene with coarse meshes, which take a moment to build: something to look at until the scene itself is there.
    /// `None` if it will be there as soon.
    pub fn sketch(&self) -> Option<Scene> {
        let meshes = || self.checked.objects.iter().filter_map(|object| mesh_of(&object.shape));
        if meshes().map(Mesh::triangle_count).fold(0, u32::saturating_add) < MANY {
            return None;
        }
        let details = DETAILS / (meshes().count() as f32).sqrt();
        let sketched = |object: &Object| match mesh_of(&object.shape) {
            Some(mesh) => mesh.file().coarse(details as u32).map(|mesh| Object::new(Mesh::from(mesh), object.material)),
            None => Some(object.clone()),
        };
        let objects: Vec<_> = self.checked.objects.iter().filter_map(sketched).collect();
        Some(Self::new(Checked { objects: objects.into(), ..Checked::clone(&self.checked) }).finish())
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

fn mesh_of(shape: &Shape) -> Option<&Mesh> {
    if let Shape::Mesh(mesh) = shape { Some(mesh) } else { None }
}
