//! A mesh: triangles that share their corners.

use super::{Surface, SurfacePoint, Triangle};
use crate::bounds::Bounds;
use crate::ray::{Interval, Probe, Ray};
use glam::Vec3;

/// Many triangles, and where wanted the normals of the smooth surface that they stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// One for each position, or none at all.
    normals: Vec<Vec3>,
}

impl Mesh {
    /// The triangles between these points, each of which is named by the places of its corners.
    ///
    /// # Panics
    /// If there is no such point, or there are 2^32 triangles or more; in debug builds, unless all points are finite.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        debug_assert!(positions.iter().all(|position| position.is_finite()), "a mesh's points are finite");
        assert!(u32::try_from(triangles.len()).is_ok(), "a mesh has fewer than 2^32 triangles");
        let is_there = |&corner: &u32| (corner as usize) < positions.len();
        assert!(triangles.iter().flatten().all(is_there), "a triangle's corners are points of the mesh");
        Self { positions, triangles, normals: Vec::new() }
    }

    /// With the normal of a smooth surface at each point, which is interpolated between them; where one has no length,
    /// the triangle's own counts.
    ///
    /// # Panics
    /// Unless there are as many as points.
    pub fn with_normals(self, normals: Vec<Vec3>) -> Self {
        assert_eq!(normals.len(), self.positions.len(), "a mesh has as many normals as points");
        Self { normals, ..self }
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> u32 {
        self.triangles.len() as u32
    }

    /// One of the triangles.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn facet(&self, index: u32) -> Facet<'_> {
        let corners = self.triangles[index as usize];
        Facet { mesh: self, corners, triangle: Triangle::new(corners.map(|corner| self.positions[corner as usize])) }
    }
}

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<'m> {
    mesh: &'m Mesh,
    corners: [u32; 3],
    triangle: Triangle,
}

impl Surface for Facet<'_> {
    fn bounds(&self) -> Option<Bounds> {
        self.triangle.bounds()
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        self.triangle.closest_crossing(probe, within)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let point = self.triangle.at_crossing(ray, t);
        if self.mesh.normals.is_empty() {
            return point;
        }
        let [a, b, c] = self.corners.map(|corner| self.mesh.normals[corner as usize]);
        let smooth = (a + (b - a) * point.uv.x + (c - a) * point.uv.y).normalize_or(point.facing);
        // On the side that is seen: the corners may go round either way.
        let normal = if smooth.dot(point.facing) < 0.0 { -smooth } else { smooth };
        SurfacePoint { normal, ..point }
    }
}
