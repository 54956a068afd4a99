//! Charts: where a picture lies on a surface.
//!
//! A chart gives each point of a surface two coordinates, from (0, 0) in the picture's upper left corner to (1, 1) in
//! the lower right one. Seen from outside, no picture is mirrored.

use glam::{DVec3, Mat3, Vec2, Vec3};
use std::f64::consts::PI;

/// A point of a surface on which a picture lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartPoint {
    /// The position of the point.
    pub position: Vec3,
    /// The geometric normal, on either side.
    pub normal: Vec3,
    /// The [coordinates on the surface](super::SurfacePoint::uv).
    pub uv: Vec2,
    /// The rotation from the scene to the picture, for a ball.
    pub turn: Mat3,
}

/// Returns the coordinates on a ball of the point in a direction from its middle.
///
/// The middle of the picture is at +z, its upper edge at +y, and its sides meet at -z.
pub(super) fn on_ball(direction: DVec3) -> Vec2 {
    let DVec3 { x, y, z } = direction;
    // The angle from +y by both of its sides keeps its digits near the poles, where that of y alone loses them.
    let down = libm::atan2((x * x + z * z).sqrt(), y) / PI;
    Vec2::new(around(x, z), down as f32)
}

/// Returns the coordinate around an axis: 1/2 in front, growing to the right.
pub(super) fn around(right: f64, front: f64) -> f32 {
    (0.5 + libm::atan2(right, front) / (2.0 * PI)) as f32
}

/// Returns the coordinates on a face, which go from -1/2 to 1/2 to the right and downwards.
pub(super) fn on_face([right, down]: [f64; 2]) -> Vec2 {
    Vec2::new((0.5 + right) as f32, (0.5 + down) as f32)
}
