//! The sketch: a scene with decimated meshes, shown while the trees of large meshes are built.

use super::{Checked, Draft, Object, Scene};
use crate::shape::{Mesh, Shape};

/// The least number of triangles for which a sketch is made.
// The trees of fewer triangles are built in about the same time as a sketch, a few hundredths of a second.
const MIN_SKETCHED_TRIANGLES: u32 = 1 << 17;

/// The approximate number of cubes into which decimation divides the longest side of a mesh.
// A small screen resolves about 64 details across. In a scene with several meshes each is divided into fewer cubes, so
// that the sketch takes the same time.
const DETAILS: f32 = 64.0;

impl Draft {
    /// Returns the scene with decimated meshes; this takes a few hundredths of a second.
    ///
    /// Returns `None` if the trees of the scene itself are built as fast.
    pub fn sketch(&self) -> Option<Scene> {
        let meshes = || self.checked.objects.iter().filter_map(|object| mesh_of(&object.shape));
        if meshes().map(Mesh::triangle_count).fold(0, u32::saturating_add) < MIN_SKETCHED_TRIANGLES {
            return None;
        }
        // The number of triangles of a decimated mesh grows with the square of the number of cubes along its side.
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
