//! The wire map: the edges of triangles over surfaces in plain grey.

use crate::camera::Camera;
use crate::color::Srgb8;
use crate::framebuffer::Resolution;
use crate::ray::Ray;
use crate::render::GBufferSample;
use crate::scene::Scene;
use crate::shape::{Primitive, Triangle};
use glam::Vec3;

/// The colour of edges.
const EDGE: [f32; 3] = [255.0, 208.0, 64.0];
/// The least mean height, in pixels, of a triangle whose edges have their full colour. The edges of
/// smaller triangles are fainter, because they would otherwise cover the whole surface.
const FULL_HEIGHT: f32 = 7.0;
/// The opacity of the edges of the smallest triangles.
const LEAST_OPACITY: f32 = 0.1;

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

/// Returns the opacity, from 0 to 1, of the triangle's edges in the pixel of `ray`. `pixel_height`
/// is the height of a pixel at the hit, in world units.
fn edge_opacity(triangle: &Triangle, ray: &Ray, pixel_height: f32) -> f32 {
    let [a, b, c] = triangle.corners();
    // The distance in space between the line of the ray and the line of an edge. Unlike a distance within the
    // triangle's plane, it corresponds to pixels even if the triangle is tilted.
    let distance = |point: Vec3, from: Vec3, to: Vec3| {
        let normal = ray.direction.cross(to - from);
        (from - point).dot(normal).abs() / normal.length().max(f32::MIN_POSITIVE)
    };
    let nearest =
        [(a, b), (b, c), (c, a)].map(|(from, to)| distance(ray.origin, from, to)).into_iter().fold(f32::MAX, f32::min);
    // The share of the pixel that a line with a width of one pixel covers.
    let coverage = (1.0 - nearest / pixel_height).max(0.0);
    // The mean of the triangle's three heights as they are seen. It is the harmonic mean, because the share of the
    // triangle that the lines of its edges cover is the sum, over the edges, of the line's width divided by the height
    // over the edge.
    let heights = [(a, b, c), (b, c, a), (c, a, b)].map(|(from, to, corner)| distance(corner, from, to));
    let height = 3.0 / heights.into_iter().map(|height| height.max(f32::MIN_POSITIVE).recip()).sum::<f32>();
    coverage * (height / (FULL_HEIGHT * pixel_height)).clamp(LEAST_OPACITY, 1.0)
}

#[cfg(all(test, unit_tests))]
mod tests;
