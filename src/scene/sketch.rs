//! A scene to look at while its large meshes are built.

use super::{Checked, Draft, Object, Scene};
use crate::shape::{Mesh, Shape};

/// Of so many triangles and more the scene is sketched: fewer are built as quickly.
const MANY: u32 = 1 << 17;

/// A sketched mesh has about so many details along its longest side: as many as a screen shows.
const DETAILS: f32 = 64.0;

impl Draft {
    /// The scene with coarse meshes, which take a moment to build: something to look at until the scene itself is there.
    /// `None` if it will be there as soon.
    pub fn sketch(&self) -> Option<Scene> {
        let meshes = || self.checked.objects.iter().filter_map(|object| mesh_of(&object.shape));
        if meshes().map(Mesh::triangle_count).fold(0, u32::saturating_add) < MANY {
            return None;
        }
        let details = DETAILS / (meshes().count() as f32).sqrt();
        let sketched = |object: &Object| match mesh_of(&object.shape) {
            Some(mesh) => {
                mesh.file().coarse(details as u32).map(|mesh| Object::new(Mesh::of_checked(mesh), object.material))
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
