//! Triangles that reach behind the eye or far beyond the picture, which are clipped and filled in
//! f64.

use super::depth_buffer::DepthBuffer;
use super::projection::Projection;
use glam::{DVec2, DVec3, Vec3};

/// Draws the part of a triangle that is in front of the eye, and returns the number of tested
/// pixels.
#[cold]
pub(super) fn draw(projection: &Projection, corners: [Vec3; 3], object: u32, buffer: &mut DepthBuffer) -> u64 {
    let corners = corners.map(|corner| projection.in_camera_space_f64(corner));
    let farthest = corners.iter().fold(0.0_f64, |z, corner| z.max(corner.z));
    // The near plane is not at depth 0, because a corner at the depth of the eye would be projected to infinity.
    let near = 1e-6 * farthest;
    if farthest <= 0.0 {
        return 0;
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
    let triangles = (2..polygon.len()).map(|at| [polygon[0], polygon[at - 1], polygon[at]]);
    triangles.map(|corners| fill(projection, corners, object, buffer)).sum()
}

/// Fills a triangle in front of the eye: the pixels whose centre is on the inner side of all edges.
fn fill(projection: &Projection, corners: [DVec3; 3], object: u32, buffer: &mut DepthBuffer) -> u64 {
    let [a, b, c] = corners.map(|corner| projection.project(corner));
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 || !area.is_finite() {
        return 0;
    }
    let rectangle = projection.rectangle(a.min(b).min(c), a.max(b).max(c));
    // 1 / t is linear in the picture, and so are the barycentric weights: each edge function divided by `area`, their
    // sum.
    let inverse = corners.map(|corner| 1.0 / corner.z);
    for y in rectangle.rows() {
        for x in rectangle.columns() {
            let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let weight = |from: DVec2, to: DVec2| (to - from).perp_dot(middle - from) / area;
            let weights = [weight(b, c), weight(c, a), weight(a, b)];
            if weights.iter().all(|&weight| weight >= 0.0) {
                let inverse: f64 = weights.iter().zip(inverse).map(|(weight, inverse)| weight * inverse).sum();
                buffer.draw([x, y], (1.0 / inverse) as f32, object);
            }
        }
    }
    // Minus 1, because `DrawTriangles` has already counted the test of the triangle itself.
    rectangle.primitive_and_pixel_tests() - 1
}
