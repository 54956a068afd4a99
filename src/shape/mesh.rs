//! A mesh: triangles that share their corners.

use super::{Surface, SurfacePoint, Triangle};
use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::mesh_file::MeshFile;
use crate::ray::{Interval, Probe, Ray};
use glam::{Vec2, Vec3};
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

    /// Whether any of them stand for a smooth surface.
    pub fn is_smooth(&self) -> bool {
        self.file.has_normals()
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
        let point = self.triangle.at_crossing(ray, t);
        match self.smooth(point.position, point.facing, point.uv) {
            Some((position, normal)) => SurfacePoint { position, normal, ..point },
            None => point,
        }
    }
}

impl Facet<'_> {
    /// The triangle itself.
    pub fn triangle(&self) -> &Triangle {
        &self.triangle
    }

    /// Position and normal of the smooth surface that the triangle stands for, if it does, at the point that is seen from
    /// that side: the corners may go round either way.
    pub fn smooth(&self, position: Vec3, facing: Vec3, uv: Vec2) -> Option<(Vec3, Vec3)> {
        let normals = self.mesh.file.normals_of(self.index as usize)?;
        let smooth = between(normals, uv).normalize_or(facing);
        let sign = if smooth.dot(facing) < 0.0 { -1.0 } else { 1.0 };
        Some((position + self.lift(position, uv, normals.map(|normal| normal * sign)), smooth * sign))
    }

    /// From the triangle up to where the smooth surface bulges over it: between the planes through the corners,
    /// perpendicular to their normals (Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, chapter 4). Rays that
    /// start there do not meet the triangle's neighbours where the smooth surface is lit.
    fn lift(&self, position: Vec3, uv: Vec2, normals: [Vec3; 3]) -> Vec3 {
        let [a, b, c] = self.triangle.corners();
        let above = |corner: Vec3, normal: Vec3| normal * (corner - position).dot(normal).max(0.0);
        between([above(a, normals[0]), above(b, normals[1]), above(c, normals[2])], uv)
    }

    /// The product of what the file has for it: its material's, the texture's and the corners' colours.
    pub(super) fn reflectance(&self, uv: Vec2) -> Option<LinearRgb> {
        let (file, index) = (&self.mesh.file, self.index as usize);
        let material = file.material_of(index).map(|index| &file.materials()[index]);
        let colors = file.colors_of(index).map(|colors| between(colors, uv));
        let textured = material.and_then(|material| {
            let texture = material.texture.as_ref()?;
            let at = between(file.texture_coordinates_of(index)?, uv);
            Some(texture.texture.color_at(texture.at(at)))
        });
        let own = [material.map(|material| material.reflectance), textured, colors];
        own.into_iter().flatten().reduce(|a, b| a * b)
    }
}

/// What lies between the corners' values at the shares of the second and the third.
fn between<T: Add<Output = T> + Mul<f32, Output = T>>([a, b, c]: [T; 3], shares: Vec2) -> T {
    a * (1.0 - shares.x - shares.y) + b * shares.x + c * shares.y
}
