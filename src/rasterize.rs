//! Object order, for comparison with ray tracing: for each object, the pixels at which it is
//! visible (lecture, "Looking ahead").
//!
//! Triangles are projected to the view rectangle and filled by their edge functions. Spheres, planes and other formulas
//! are intersected with the eye rays of the pixels in their projected bounds. A depth buffer keeps the nearest object
//! of each pixel. Nothing is shaded: the time is that of visibility, as for eye rays.

use crate::camera::{Basis, Camera, EyeRays};
use crate::framebuffer::Resolution;
use crate::ray::{Interval, Probe};
use crate::scene::Scene;
use crate::shape::{Primitive, Surface};
use glam::{BVec3, DVec2, DVec3, Vec3};
use std::ops::Range;

/// The nearest object of each pixel, from the upper left, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthBuffer {
    width: u32,
    height: u32,
    /// The t of the eye ray of each pixel at the nearest surface, infinite where there is none.
    t: Vec<f32>,
    /// The index of the object with this surface in the scene.
    objects: Vec<u32>,
}

impl DepthBuffer {
    /// Returns the object at a pixel and its depth, or `None` if none is visible there.
    pub fn at(&self, x: u32, y: u32) -> Option<(u32, f32)> {
        let index = (y * self.width + x) as usize;
        (self.t[index] < f32::INFINITY).then(|| (self.objects[index], self.t[index]))
    }

    /// Returns the number of pixels that show an object, and the sum of their depths.
    pub fn hits_and_depths(&self) -> (u64, f64) {
        let seen = self.t.iter().filter(|t| t.is_finite());
        seen.fold((0, 0.0), |(count, sum), &t| (count + 1, sum + f64::from(t)))
    }

    fn draw(&mut self, [x, y]: [u32; 2], t: f32, object: u32) {
        let index = (y * self.width + x) as usize;
        if t < self.t[index] {
            (self.t[index], self.objects[index]) = (t, object);
        }
    }
}

/// Draws all objects of a scene, one after the other, on the calling thread.
pub fn rasterize(scene: &Scene, camera: &Camera, resolution: Resolution) -> DepthBuffer {
    let (width, height) = (resolution.width(), resolution.height());
    let projection = Projection::new(camera, resolution);
    let pixels = resolution.pixel_count();
    let mut buffer = DepthBuffer { width, height, t: vec![f32::INFINITY; pixels], objects: vec![0; pixels] };
    for (object, index) in scene.objects().iter().zip(0..) {
        for primitive in 0..object.shape.primitive_count() {
            match object.shape.primitive(primitive) {
                Primitive::Triangle(triangle) => projection.draw_triangle(triangle.corners(), index, &mut buffer),
                Primitive::Facet(facet) => projection.draw_triangle(facet.triangle().corners(), index, &mut buffer),
                formula => projection.draw_formula(&formula, index, &mut buffer),
            }
        }
    }
    buffer
}

/// The projection of points to pixels.
struct Projection {
    eye: DVec3,
    basis: [DVec3; 3],
    /// The middle of the view rectangle on the plane at distance 1.
    middle: DVec2,
    /// Pixels per unit on the plane at distance 1, to the right and down.
    scale: DVec2,
    size: [u32; 2],
    rays: EyeRays,
}

impl Projection {
    fn new(camera: &Camera, resolution: Resolution) -> Self {
        let Basis { u, v, w } = camera.rectangle_basis();
        let aspect_ratio = resolution.aspect_ratio();
        let (width, height, middle) = camera.rectangle().width_height_middle(aspect_ratio);
        let size = [resolution.width(), resolution.height()];
        let scale = DVec2::new(f64::from(size[0]) / f64::from(width), -f64::from(size[1]) / f64::from(height));
        Self {
            eye: camera.pose().eye.as_dvec3(),
            basis: [u, v, -w].map(Vec3::as_dvec3),
            middle: middle.as_dvec2(),
            scale,
            size,
            rays: camera.eye_rays(aspect_ratio),
        }
    }

    /// Returns a point in the camera's coordinates: along u and v, and its depth.
    fn in_camera_space(&self, point: Vec3) -> DVec3 {
        let away = point.as_dvec3() - self.eye;
        DVec3::from(self.basis.map(|axis| axis.dot(away)))
    }

    /// Returns the position in pixels, from the upper left, of a point in front of the eye.
    fn pixel(&self, from_eye: DVec3) -> DVec2 {
        let half = 0.5 * DVec2::new(self.size[0].into(), self.size[1].into());
        (from_eye.truncate() / from_eye.z - self.middle) * self.scale + half
    }

    /// Returns the columns and rows of the pixels whose middles may be within bounds of pixels.
    fn range(&self, min: DVec2, max: DVec2) -> [Range<u32>; 2] {
        let range = |min: f64, max: f64, size: u32| {
            let last = f64::from(size);
            (min - 0.5).ceil().clamp(0.0, last) as u32..((max - 0.5).floor() + 1.0).clamp(0.0, last) as u32
        };
        [range(min.x, max.x, self.size[0]), range(min.y, max.y, self.size[1])]
    }

    /// Draws the pixels at which a formula is visible.
    fn draw_formula(&self, surface: &Primitive<'_>, object: u32, buffer: &mut DepthBuffer) {
        let Some([columns, rows]) = self.projected_bounds(surface) else { return };
        let [width, height] = self.size.map(|size| size as f32);
        for y in rows {
            for x in columns.clone() {
                let ray = self.rays.through((x as f32 + 0.5) / width, (height - (y as f32 + 0.5)) / height);
                if let Some(t) = surface.closest_crossing(&Probe::new(ray), Interval::IN_FRONT) {
                    buffer.draw([x, y], t, object);
                }
            }
        }
    }

    /// Returns the columns and rows of the pixels that a surface may cover; `None` if it is behind
    /// the eye.
    fn projected_bounds(&self, surface: &Primitive<'_>) -> Option<[Range<u32>; 2]> {
        let whole = [0..self.size[0], 0..self.size[1]];
        let Some(bounds) = surface.bounds() else { return Some(whole) };
        let corners: [DVec3; 8] = std::array::from_fn(|corner| {
            let is_max = |axis: u32| corner >> axis & 1 == 1;
            let mask = BVec3::new(is_max(0), is_max(1), is_max(2));
            self.in_camera_space(Vec3::select(mask, bounds.max, bounds.min))
        });
        if corners.iter().all(|corner| corner.z <= 0.0) {
            return None;
        }
        // A box that reaches behind the eye has no bounds in the picture.
        if corners.iter().any(|corner| corner.z <= 0.0) {
            return Some(whole);
        }
        let places = corners.map(|corner| self.pixel(corner));
        let (min, max) = places.iter().fold((places[0], places[0]), |(min, max), at| (min.min(*at), max.max(*at)));
        // A pixel more on each side, for the rounding of rays.
        Some(self.range(min - 1.0, max + 1.0))
    }

    /// Draws the pixels at which a triangle is visible: clips it to the space in front of the eye,
    /// and fills the rest.
    fn draw_triangle(&self, corners: [Vec3; 3], object: u32, buffer: &mut DepthBuffer) {
        let corners = corners.map(|corner| self.in_camera_space(corner));
        let farthest = corners.iter().fold(0.0_f64, |z, corner| z.max(corner.z));
        let near = 1e-6 * farthest;
        if farthest <= 0.0 {
            return;
        }
        let mut polygon: Vec<DVec3> = Vec::with_capacity(4);
        for at in 0..3 {
            let (from, to) = (corners[at], corners[(at + 1) % 3]);
            if from.z >= near {
                polygon.push(from);
            }
            if (from.z < near) != (to.z < near) {
                polygon.push(from.lerp(to, (near - from.z) / (to.z - from.z)));
            }
        }
        for at in 2..polygon.len() {
            self.fill([polygon[0], polygon[at - 1], polygon[at]], object, buffer);
        }
    }

    /// Fills a triangle in front of the eye: pixels whose middle is on the same side of all edges.
    fn fill(&self, corners: [DVec3; 3], object: u32, buffer: &mut DepthBuffer) {
        let places = corners.map(|corner| self.pixel(corner));
        let [a, b, c] = places;
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let [columns, rows] = self.range(a.min(b).min(c), a.max(b).max(c));
        // 1 / t is linear on the screen. So are the weights of the corners: the edge functions over their sum.
        let inverse = corners.map(|corner| 1.0 / corner.z);
        for y in rows {
            for x in columns.clone() {
                let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let weight = |from: DVec2, to: DVec2| (to - from).perp_dot(middle - from) / area;
                let weights = [weight(b, c), weight(c, a), weight(a, b)];
                if weights.iter().all(|&weight| weight >= 0.0) {
                    let inverse: f64 = weights.iter().zip(inverse).map(|(weight, inverse)| weight * inverse).sum();
                    buffer.draw([x, y], (1.0 / inverse) as f32, object);
                }
            }
        }
    }
}
