//! Decimation of a mesh, for a coarse sketch.

use super::MeshFile;
use super::builder::{MeshBuilder, TriangleIndices};
use crate::bounds::Bounds;
use glam::{DVec3, Vec3};
use std::collections::HashSet;

/// Limit on the triangles of a decimated mesh: small enough that the trees over them are built in a
/// few hundredths of a second.
const MAX_DECIMATED_TRIANGLES: usize = 128 << 10;

/// Marks a cube that contains no vertex of the mesh.
const NO_CLUSTER: u32 = u32::MAX;

impl MeshFile {
    /// Returns the mesh decimated by vertex clustering; `None` if no triangle is left.
    ///
    /// Space is divided into cubes, `cubes` (at most 256) along the mesh's longest side, and all vertices in a cube are
    /// replaced by their mean (Rossignac and Borrel, Multi-resolution 3D approximations for rendering complex scenes,
    /// 1993). No vertex moves farther than a cube's diagonal.
    ///
    /// Keeping some of the triangles, enlarged, would be simpler, but would leave holes and distort large triangles.
    pub fn decimated(&self, cubes: u32) -> Option<Self> {
        let (corner_of, positions) = self.clusters(cubes.clamp(1, 256));
        let mut mesh = MeshBuilder { positions, materials: self.materials().to_vec(), ..MeshBuilder::default() };
        let mut seen = HashSet::new();
        for (index, corners) in self.triangles.iter().enumerate() {
            let corners = corners.map(|corner| corner_of[corner as usize]);
            let [a, b, c] = corners;
            // Triangles with two corners in one cube are dropped, and so are duplicates, of which a fine mesh has many.
            if a == b || b == c || c == a || !seen.insert(sorted_corners(corners)) {
                continue;
            }
            self.push_like(index, corners, &mut mesh).ok()?;
            if mesh.triangles.len() == MAX_DECIMATED_TRIANGLES {
                break;
            }
        }
        mesh.into_mesh()
    }

    /// Returns the cluster (index of a nonempty cube) of each vertex, and the mean position of each
    /// cluster.
    fn clusters(&self, cubes: u32) -> (Vec<u32>, Vec<Vec3>) {
        let bounds = Bounds::of(self.positions.iter().copied());
        let start = bounds.min.as_dvec3();
        let side = (bounds.max.as_dvec3() - start).max_element();
        // Scaled to a little less than `cubes`, so that the largest coordinate falls into the last cube, not beyond it.
        let scale = if side > 0.0 { f64::from(cubes) * 0.999_999 / side } else { 0.0 };
        // The cluster of each cube, in a dense table of at most 2^24 entries: a hash map would cost more for each
        // vertex.
        let mut cluster_of = vec![NO_CLUSTER; cubes.pow(3) as usize];
        let mut sums: Vec<(DVec3, u32)> = Vec::new();
        let corner_of = self.positions.iter().map(|position| {
            let position = position.as_dvec3();
            let [x, y, z] = ((position - start) * scale).to_array().map(|place| (place as u32).min(cubes - 1));
            let cluster = &mut cluster_of[((z * cubes + y) * cubes + x) as usize];
            if *cluster == NO_CLUSTER {
                *cluster = sums.len() as u32; // at most 2^24
                sums.push((DVec3::ZERO, 0));
            }
            let (sum, count) = &mut sums[*cluster as usize];
            *sum += position;
            *count += 1;
            *cluster
        });
        let corner_of = corner_of.collect();
        (corner_of, sums.into_iter().map(|(sum, count)| (sum / f64::from(count)).as_vec3()).collect())
    }

    /// Adds a triangle with these corners, and with the attributes and the material of triangle
    /// `index`.
    fn push_like(
        &self,
        index: usize,
        positions: [u32; 3],
        mesh: &mut MeshBuilder,
    ) -> Result<(), super::fault::MeshFault> {
        mesh.set_material(self.material_of(index).map(|material| material as u32)); // as many as there were
        let triangle = TriangleIndices {
            positions,
            normals: self.normals_of(index).map(|values| mesh.normals.add(values)),
            texture_coordinates: self.texture_coordinates_of(index).map(|values| mesh.texture_coordinates.add(values)),
            colors: self.colors_of(index).map(|values| mesh.colors.add(values)),
        };
        mesh.push(triangle)
    }
}

fn sorted_corners(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}

#[cfg(all(test, unit_tests))]
mod tests;
