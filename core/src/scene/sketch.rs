//! The sketch: a scene with decimated meshes, shown while the trees of large meshes are built.

use super::{Checked, Draft, Object, Scene};
use crate::shape::{Mesh, Shape};
use std::collections::HashMap;
use std::sync::Arc;

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
        let meshes = self.checked.objects.iter().filter_map(|object| mesh_of(&object.shape));
        // Instances share a file, which is decimated once.
        let files: HashMap<_, _> = meshes.map(|mesh| (Arc::as_ptr(mesh.shared_file()), mesh)).collect();
        if files.values().map(|mesh| mesh.triangle_count()).fold(0, u32::saturating_add) < MIN_SKETCHED_TRIANGLES {
            return None;
        }
        // The number of triangles of a decimated mesh grows with the square of the number of cubes along its side.
        let (details, mut decimated) = (DETAILS / (files.len() as f32).sqrt(), HashMap::new());
        let sketched = |object: &Object| match mesh_of(&object.shape) {
            Some(mesh) => {
                let file = decimated.entry(Arc::as_ptr(mesh.shared_file()));
                let file = file.or_insert_with(|| mesh.file().decimated(details as u32).map(Arc::new));
                Some(Object { shape: mesh.with_file(Arc::clone(file.as_ref()?)).into(), ..object.clone() })
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
