//! The wire map: the edges of triangles over surfaces in plain grey.

use crate::camera::Camera;
use crate::color::Srgb8;
use crate::framebuffer::Resolution;
use crate::ray::Ray;
use crate::render::GBufferSample;
use crate::scene::Scene;
use crate::shape::{Primitive, Triangle};

/// The colour of edges.
const EDGE: [f32; 3] = [255.0, 208.0, 64.0];
/// Half the width of a line, in pixels.
const HALF_WIDTH: f32 = 0.6;
/// The least height, in pixels, of a triangle whose edges have their full colour. The edges of
/// smaller triangles are fainter, because they would otherwise cover the whole surface.
const FULL_HEIGHT: f32 = 5.0;

/// Returns the colour of a pixel: a grey by the angle of the surface, and edges. `None` without a
/// hit.
pub(super) fn color(scene: &Scene, camera: &Camera, resolution: Resolution, sample: &GBufferSample) -> Option<Srgb8> {
    let (hit, surface) = sample.hit.zip(sample.surface(scene))?;
    let direction = sample.ray.direction;
    let facing = surface.shading_normal.dot(direction).abs() / direction.length();
    let grey = 30.0 + 110.0 * facing;
    let step = camera.eye_rays(resolution.aspect_ratio()).steps(resolution.width(), resolution.height())[1].length();
    let primitive = hit.surface(scene);
    let triangle = match &primitive {
        Primitive::Facet(facet) => Some(facet.triangle()),
        Primitive::Triangle(triangle) => Some(*triangle),
        _ => None,
    };
    let line = triangle.map_or(0.0, |triangle| edge_opacity(triangle, &sample.ray, hit.t * step));
    let [r, g, b] = EDGE.map(|edge| (grey + line * (edge - grey)) as u8);
    Some(Srgb8::new(r, g, b))
}

/// Returns the opacity, from 0 to 1, of the triangle's edges in the pixel of `ray`. `pixel` is the
/// height of a pixel at the hit, in world units.
fn edge_opacity(triangle: &Triangle, ray: &Ray, pixel: f32) -> f32 {
    let [a, b, c] = triangle.corners();
    // The distance in space between the ray and the line of an edge, which unlike a distance within the triangle's
    // plane corresponds to pixels even if the triangle is tilted.
    let distance = |from: glam::Vec3, to: glam::Vec3| {
        let normal = ray.direction.cross(to - from);
        (from - ray.origin).dot(normal).abs() / normal.length().max(f32::MIN_POSITIVE)
    };
    let nearest = distance(a, b).min(distance(b, c)).min(distance(c, a));
    if nearest > HALF_WIDTH * pixel {
        return 0.0;
    }
    let height = distance(a, b).max(distance(b, c)).max(distance(c, a));
    (height / (FULL_HEIGHT * pixel)).clamp(0.15, 1.0)
}

#[cfg(all(test, unit_tests))]
mod tests;
