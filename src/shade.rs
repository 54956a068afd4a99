//! How much light goes from a surface to the eye (lecture, "Shading").
//!
//! Direct light from point sources, reflected diffusely:
//!
//! ```text
//! L = reflectance * (ambient + sum over lights of V * I * max(0, n.l) / d^2)
//! ```
//!
//! V is 0 where something stands between the point and the light, else 1; n is the normal on the seen side, l the
//! unit vector to the light, d the distance to it; the 1/pi of diffuse reflection is folded into the intensity I.
//! Nothing in it depends on where the eye is, but for the side of the surface that it sees.

use crate::color::LinearRgb;
use crate::light::{Falloff, PointLight};
use crate::ray::{Interval, Ray};
use crate::scene::{Background, Scene};
use crate::shape::SurfacePoint;
use glam::Vec3;

/// What one light does at a point that it faces, if nothing is in its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// The lecture's **l**: the direction to the light. Unit length.
    pub l: Vec3,
    /// The distance to the light.
    pub distance: f32,
    /// n.l, greater than 0.
    pub cosine: f32,
    /// I * n.l / d^2, or without the division where the light has no falloff.
    pub light: LinearRgb,
}

/// What the light does at the point, or nothing where the surface faces away from it.
pub fn incidence(light: &PointLight, point: &SurfacePoint) -> Option<Incidence> {
    let to_light = light.position - point.position;
    let distance_squared = to_light.dot(to_light);
    let distance = distance_squared.sqrt();
    let l = to_light / distance;
    let cosine = point.normal.dot(l);
    // False also for NaN: a light that lies in the surface.
    if !(cosine > 0.0) {
        return None;
    }
    let weakening = match light.falloff {
        Falloff::InverseSquare => cosine / distance_squared,
        Falloff::None => cosine,
    };
    Some(Incidence { l, distance, cosine, light: bounded(light.intensity * weakening) })
}

/// A light nearly in its surface may be brighter than f32 can say. Bounded here, all sums and products that follow are
/// numbers: NaN has other bits on other CPUs. (`min` of NaN and a number is the number.)
fn bounded(light: LinearRgb) -> LinearRgb {
    const BRIGHTEST: f32 = 1e30;
    LinearRgb::new(light.r.min(BRIGHTEST), light.g.min(BRIGHTEST), light.b.min(BRIGHTEST))
}

/// The ray from a point to a light. The light is at t = 1.
pub fn shadow_ray(light: &PointLight, point: &SurfacePoint) -> Ray {
    let origin = point.ray_origin();
    Ray { origin, direction: light.position - origin }
}

/// Where on a [`shadow_ray`] an object is in the light's way. Not at t = 0: at the origin of the coordinates a clearance
/// in proportion to them is nothing, and the point lies in its surface exactly.
pub const TO_THE_LIGHT: Interval = Interval { min: f32::MIN_POSITIVE, max: 1.0 };

/// The light that comes along a ray that meets nothing.
pub fn background(scene: &Scene, ray: &Ray) -> LinearRgb {
    match scene.background {
        Background::Color(color) => color,
        Background::Gradient { bottom, top } => {
            let up = ray.direction.normalize().y;
            bottom.lerp(top, 0.5 * (up + 1.0))
        }
    }
}
