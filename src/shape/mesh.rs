//! A mesh: triangles that share their corners.

use super::{Surface, SurfacePoint, Triangle};
use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::mesh_file::MeshFile;
use crate::ray::{Interval, Probe, Ray};
use glam::Vec3;
use std::ops::{Add, Mul};

/// Many triangles, with what their file says of them: the normals of the smooth surface that they stand for, colours and
/// textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    file: MeshFile,
}

impl From<MeshFile> for Mesh {
    fn from(file: MeshFile) -> Self {
        Self { file }
    }
}

impl Mesh {
    /// How many triangles there are; at least one.
    pub fn triangle_count(&self) -> u32 {
        self.file.triangles().len() as u32
    }

    /// What it is made of.
    pub fn file(&self) -> &MeshFile {
        &self.file
    }

    /// One of the triangles.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn facet(&self, index: u32) -> Facet<'_> {
        let corners = self.file.triangles()[index as usize];
        let positions = self.file.positions();
        Facet { mesh: self, index, triangle: Triangle::new(corners.map(|corner| positions[corner as usize])) }
    }
}

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<'m> {
    mesh: &'m Mesh,
    index: u32,
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
        self.finished(self.triangle.at_crossing(ray, t))
    }
}

impl Facet<'_> {
    /// The point on the triangle with what the file says of it.
    pub(super) fn finished(&self, point: SurfacePoint) -> SurfacePoint {
        let point = SurfacePoint { own_reflectance: self.reflectance(&point), ..point };
        match self.mesh.file.normals_of(self.index as usize) {
            Some(normals) => self.smoothed(&point, normals),
            None => point,
        }
    }

    /// The triangle itself.
    pub fn triangle(&self) -> &Triangle {
        &self.triangle
    }

    /// The point on the smooth surface that has these normals at the corners, seen from the same side: the corners may go
    /// round either way.
    fn smoothed(&self, point: &SurfacePoint, normals: [Vec3; 3]) -> SurfacePoint {
        let smooth = between(normals, point).normalize_or(point.facing);
        let sign = if smooth.dot(point.facing) < 0.0 { -1.0 } else { 1.0 };
        let normals = normals.map(|normal| normal * sign);
        SurfacePoint { normal: smooth * sign, position: point.position + self.lift(point, normals), ..*point }
    }

    /// From the triangle up to where the smooth surface bulges over it: between the planes through the corners,
    /// perpendicular to their normals (Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, chapter 4). Rays that
    /// start there do not meet the triangle's neighbours where the smooth surface is lit.
    fn lift(&self, point: &SurfacePoint, normals: [Vec3; 3]) -> Vec3 {
        let [a, b, c] = self.triangle.corners();
        let above = |corner: Vec3, normal: Vec3| normal * (corner - point.position).dot(normal).max(0.0);
        between([above(a, normals[0]), above(b, normals[1]), above(c, normals[2])], point)
    }

    /// The product of what the file has for it: its material's, the texture's and the corners' colours.
    fn reflectance(&self, point: &SurfacePoint) -> Option<LinearRgb> {
        let (file, index) = (&self.mesh.file, self.index as usize);
        let material = file.material_of(index).map(|index| &file.materials()[index]);
        let colors = file.colors_of(index).map(|colors| between(colors, point));
        let textured = material.and_then(|material| {
            let texture = material.texture.as_ref()?;
            let uv = between(file.texture_coordinates_of(index)?, point);
            Some(texture.texture.color_at(texture.at(uv)))
        });
        let own = [material.map(|material| material.reflectance), textured, colors];
        own.into_iter().flatten().reduce(|a, b| a * b)
    }
}

/// What lies between the corners' values at the point.
fn between<T: Add<Output = T> + Mul<f32, Output = T>>([a, b, c]: [T; 3], point: &SurfacePoint) -> T {
    let [second, third] = point.uv.to_array();
    a * (1.0 - second - third) + b * second + c * third
}
