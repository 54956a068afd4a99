//! A coarse scene to show while the trees of large meshes are built.

use super::{Checked, Draft, Object, Scene};
use crate::shape::{Mesh, Shape};

/// Least number of triangles for which a sketch is made: building fewer is as fast.
const MIN_SKETCHED_TRIANGLES: u32 = 1 << 17;

/// Approximate number of details along a sketched mesh's longest side: as many as a screen resolves.
const DETAILS: f32 = 64.0;

impl Draft {
    /// Returns the scene with coarse meshes, which are built in a moment; `None` if the scene itself is built as fast.
    pub fn sketch(&self) -> Option<Scene> {
        let meshes = || self.checked.objects.iter().filter_map(|object| mesh_of(&object.shape));
        if meshes().map(Mesh::triangle_count).fold(0, u32::saturating_add) < MIN_SKETCHED_TRIANGLES {
            return None;
        }
        let details = DETAILS / (meshes().count() as f32).sqrt();
        let sketched = |object: &Object| match mesh_of(&object.shape) {
            Some(mesh) => {
                mesh.file().decimated(details as u32).map(|mesh| Object::new(Mesh::of_checked(mesh), object.material))
            }
            None => Some(object.clone()),
        };
        let objects: Vec<_> = self.checked.objects.iter().filter_map(sketched).collect();
        Some(Self::new(Checked { objects: objects.into(), ..Checked::clone(&self.checked) }).finish())
    }
}

fn mesh_of(shape: &Shape) -> Option<&Mesh> {
    if let Shape::Mesh(mesh) = shape { Some(mesh) } else { None }
}
