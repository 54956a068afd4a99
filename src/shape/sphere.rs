//! Ray-sphere intersection (lecture, "Ray intersection").

use super::{CLEARANCE, Side, Surface, SurfacePoint, largest_coordinate};
use crate::bounds::Bounds;
use crate::ray::{Interval, Probe, Ray};
use glam::{Vec2, Vec3};

/// From so many radii on, a crossing is improved by a second look.
const FAR: f32 = 8.0;

/// The square of the cosine to the normal below which a ray only grazes the sphere.
const GRAZING: f32 = 1e-3;

/// All points x with ||x - c||^2 - r^2 = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: Vec3,
    radius: f32,
}

impl Sphere {
    /// The sphere about `center` with that radius.
    ///
    /// # Panics
    /// In debug builds, unless the centre is finite and the radius is finite and greater than 0.
    pub fn new(center: Vec3, radius: f32) -> Self {
        debug_assert!(center.is_finite(), "a sphere's centre is finite");
        debug_assert!(radius > 0.0 && radius.is_finite(), "a sphere's radius is greater than 0");
        Self { center, radius }
    }

    /// The lecture's **c**.
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The lecture's r, greater than 0.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Both roots of f(p + t d) = 0 in ascending order, or none if the line misses the sphere.
    ///
    /// The lecture solves (d.d) t^2 + 2 (f.d) t + (f.f - r^2) = 0, with f = p - c, by
    ///
    /// ```text
    /// t = (-f.d ± sqrt((f.d)^2 - (d.d)(f.f - r^2))) / d.d
    /// ```
    ///
    /// which is right on paper and loses its digits in f32 twice: in the difference under the root when the sphere
    /// is small or far (at 2,000 radii one ray in forty is wrong about hitting at all), and in the sum before the
    /// division when the two terms nearly cancel (a ground made of a large sphere). So, after Haines, Günther and
    /// Akenine-Möller (Ray Tracing Gems, chapter 7): the term under the root comes from the distance between the
    /// centre and the line, ||f - ((f.d)/(d.d)) d||, and only the root without cancellation is computed directly;
    /// the other follows from the product of the roots, (f.f - r^2) / (d.d).
    pub fn crossings(&self, ray: &Ray) -> Option<[f32; 2]> {
        let d = ray.direction;
        let f = ray.origin - self.center;
        let dd = d.dot(d);
        let half_b = -f.dot(d);
        let to_line = f + d * (half_b / dd);
        let under_root = self.radius * self.radius - to_line.dot(to_line);
        // The negation also turns NaN away.
        if !(under_root >= 0.0) {
            return None;
        }
        let root = (dd * under_root).sqrt();
        let q = if half_b < 0.0 { half_b - root } else { half_b + root };
        let c = f.dot(f) - self.radius * self.radius;
        let (t0, t1) = (c / q, q / dd);
        let crossings = if t0 <= t1 { [t0, t1] } else { [t1, t0] };
        let is_far = f.dot(f) > FAR * FAR * self.radius * self.radius;
        Some(if is_far { crossings.map(|t| self.improved(t, f, d)) } else { crossings })
    }

    /// One step of Newton's method towards the root near t. From afar t is a long way, off by units of its own; what is
    /// left to the surface at its end is short, and known better. (Near the edge, where the ray only grazes the sphere,
    /// the step would be one into the blue.)
    fn improved(&self, t: f32, f: Vec3, d: Vec3) -> f32 {
        let outward = f + d * t;
        let along = outward.dot(d);
        let squared_radius = self.radius * self.radius;
        if along * along > GRAZING * squared_radius * d.dot(d) {
            t - 0.5 * (outward.dot(outward) - squared_radius) / along
        } else {
            t
        }
    }
}

impl Surface for Sphere {
    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds { min: self.center - self.radius, max: self.center + self.radius })
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let crossings = self.crossings(&probe.ray)?;
        let inside = self.bounds()?.crossed(probe);
        crossings.into_iter().filter_map(|t| inside.nearest(t)).find(|&t| within.contains(t))
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let outward = (ray.at(t) - self.center).normalize();
        let position = self.center + outward * self.radius;
        let seen_from_outside = ray.direction.dot(outward) < 0.0;
        let (normal, side) = if seen_from_outside { (outward, Side::Front) } else { (-outward, Side::Back) };
        let clearance = CLEARANCE * (largest_coordinate(self.center) + self.radius);
        SurfacePoint {
            position,
            normal,
            facing: normal,
            side,
            clearance,
            uv: Vec2::ZERO,
            footprint: Vec2::ZERO,
            own_reflectance: None,
        }
    }
}
