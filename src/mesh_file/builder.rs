//! A mesh under construction.

use super::attribute::Attribute;
use super::fault::MeshFault;
use super::limits::MAX_TRIANGLES;
use super::{MeshFile, MeshMaterial};
use crate::color::LinearRgb;
use glam::{DVec3, Vec2, Vec3};

/// The triangles and attributes read so far.
#[derive(Default)]
pub(super) struct MeshBuilder {
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) normals: Attribute<Vec3>,
    pub(super) texture_coordinates: Attribute<Vec2>,
    pub(super) colors: Attribute<LinearRgb>,
    pub(super) materials: Vec<MeshMaterial>,
    pub(super) material_runs: Vec<(u32, Option<u32>)>,
}

/// The indices of a triangle's corners, for its positions and each attribute that it has.
#[derive(Clone, Copy)]
pub(super) struct TriangleIndices {
    pub(super) positions: [u32; 3],
    pub(super) normals: Option<[u32; 3]>,
    pub(super) texture_coordinates: Option<[u32; 3]>,
    pub(super) colors: Option<[u32; 3]>,
}

impl TriangleIndices {
    /// Returns a triangle whose corners have positions and no other attributes.
    pub(super) fn new(positions: [u32; 3]) -> Self {
        Self { positions, normals: None, texture_coordinates: None, colors: None }
    }
}

impl MeshBuilder {
    /// Adds a triangle, whose indices must be in range.
    pub(super) fn push(&mut self, triangle: TriangleIndices) -> Result<(), MeshFault> {
        if self.triangles.len() >= MAX_TRIANGLES {
            return Err(MeshFault::of_file(too_many_triangles()));
        }
        let TriangleIndices { positions, normals, texture_coordinates, colors } = triangle;
        self.normals.push(&self.triangles, positions, normals);
        self.texture_coordinates.push(&self.triangles, positions, texture_coordinates);
        self.colors.push(&self.triangles, positions, colors);
        self.triangles.push(positions);
        Ok(())
    }

    /// Sets the material of the triangles added from here on.
    pub(super) fn set_material(&mut self, material: Option<u32>) {
        let from = self.triangles.len() as u32; // at most MAX_TRIANGLES
        // A run that has no triangle yet is replaced, so that no two runs start at the same triangle.
        if self.material_runs.last().is_some_and(|&(start, _)| start == from) {
            self.material_runs.pop();
        }
        if self.material_runs.last().and_then(|&(_, before)| before) != material {
            self.material_runs.push((from, material));
        }
    }

    /// Returns the mesh. `nothing` describes the contents of a file without triangles, for the
    /// message.
    pub(super) fn finish(mut self, nothing: &str) -> Result<MeshFile, MeshFault> {
        if self.triangles.is_empty() {
            return Err(MeshFault::of_file(format!("there are no triangles in this file: {nothing}")));
        }
        self.shrink_to_fit();
        let Self { positions, triangles, normals, texture_coordinates, colors, materials, material_runs } = self;
        let mesh = MeshFile { positions, triangles, normals, texture_coordinates, colors, materials, material_runs };
        // Readers have already checked all this, and reported faults with their positions; this is the last line of
        // defence.
        if mesh.is_valid() {
            Ok(mesh)
        } else {
            Err(MeshFault::of_file("this mesh has numbers or indices out of range"))
        }
    }

    /// Frees unused capacity: a mesh lives as long as its scene, and a vector that grew is up to
    /// twice as large.
    fn shrink_to_fit(&mut self) {
        self.positions.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.normals.shrink_to_fit();
        self.texture_coordinates.shrink_to_fit();
        self.colors.shrink_to_fit();
    }
}

/// Returns the message about a mesh with too many triangles.
pub(super) fn too_many_triangles() -> String {
    format!("there are more than {MAX_TRIANGLES} triangles in this file, which is the most that are read")
}

/// Returns `direction` as a unit vector, or zero if its length is zero.
pub(super) fn unit(direction: DVec3) -> Vec3 {
    // Divided by its largest component first, so that no square overflows or underflows.
    let direction = direction / direction.abs().max_element();
    let length = direction.length();
    // False also for NaN, which the division above makes of a zero vector.
    if length > 0.0 { (direction / length).as_vec3() } else { Vec3::ZERO }
}
