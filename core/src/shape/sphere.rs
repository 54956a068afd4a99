//! Ray-sphere intersection (lecture, "Ray intersection").

use super::placement::{Placeable, Placement};
use super::{
    AtCrossing, ChartPoint, CheckedShape, Crossable, Described, Ellipsoid, Equation, EquationStep, Meshes, Points,
    Shape, SoaLeaf, Surface, SurfacePoint, chart,
};
use crate::bounds::{Bounds, crossed};
use crate::checks::{self, SceneFault};
use crate::lanes::{F32x8, Lanes, Mask, Number, Vector};
use crate::ray::{Interval, Probe, Ray, Rays, clamp_keeping_nan};
use crate::text::number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenNumber, WrittenVector};
use glam::{DVec3, Vec2, Vec3};
use std::array::from_fn;

/// The distance from a ray's origin to the center, in radii, from which on a Newton step refines
/// the crossing.
// For example, from 200 radii away, the step reduces the crossing's distance from the surface from 6e-5 to 5e-5 radii.
const NEWTON_MIN_RADII: f32 = 8.0;

/// The squared cosine between ray and normal below which the ray is grazing.
///
/// For a grazing ray the derivative of f is near zero, so that a Newton step would diverge.
const GRAZING_COSINE_SQUARED: f32 = 1e-3;

/// A sphere: all points x with ||x - c||^2 - r^2 = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: Vec3,
    radius: f32,
}

impl Sphere {
    /// Returns the sphere about `center`.
    ///
    /// # Errors
    /// Unless the centre's coordinates lie within ±1e9, and the radius between 1e-9 and 1e9.
    pub fn new(center: Vec3, radius: f32) -> Result<Self, SceneFault> {
        let center = checks::checked_point("center", center)?;
        let radius = checks::checked_number("radius", radius, |radius| checks::length("radius", radius))?;
        Ok(Self { center, radius })
    }

    /// Returns the sphere without checking the arguments.
    #[doc(hidden)]
    pub fn unchecked(center: Vec3, radius: f32) -> Self {
        Self { center, radius }
    }

    /// Returns the center, **c** in the lecture.
    #[doc(hidden)]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// Returns the radius, r in the lecture; greater than 0.
    #[doc(hidden)]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    fn as_one_lane(&self) -> SphereN<f32> {
        SphereN { center: Vector::splat(self.center), radius: self.radius }
    }
}

/// One sphere, or eight in SoA layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereN<N> {
    center: Vector<N>,
    radius: N,
}

impl<N: Number> SphereN<N> {
    /// Improves the crossing `t` by one Newton step, except for grazing rays.
    ///
    /// `f` is the vector from the center to the ray's origin. From afar, t is large, and so is its rounding error; the
    /// remaining distance to the surface is short, and computed more exactly.
    #[inline(always)]
    fn newton_step(&self, t: N, f: Vector<N>, rays: &Rays<N>) -> N {
        let squared_radius = self.radius * self.radius;
        let outward = f + rays.direction * t;
        let along = outward.dot(rays.direction);
        let is_steep = (N::splat(GRAZING_COSINE_SQUARED) * squared_radius * rays.squared_length).lt(along * along);
        let step = N::splat(0.5) * (outward.dot(outward) - squared_radius) / along;
        N::select(is_steep, t - step, t)
    }
}

impl<N: Number> Crossable<N> for SphereN<N> {
    /// Returns the smaller root of f(p + t d) = 0 that is not below `min`.
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
    #[inline(always)]
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)> {
        let (d, zero) = (rays.direction, N::splat(0.0));
        let squared_radius = self.radius * self.radius;
        let f = rays.origin - self.center;
        let half_b = -f.dot(d);
        let to_line = f + d * (half_b * rays.inverse_squared_length);
        let under_root = squared_radius - to_line.dot(to_line);
        // Comparisons with NaN are false, so NaN counts as a miss.
        let crosses = zero.le(under_root);
        // Without a hit the square root and the division are skipped: they take longer than the rest.
        if !crosses.any() {
            return None;
        }
        let root = (rays.squared_length * under_root).sqrt();
        // Adds two terms of the same sign, so that they do not cancel.
        let q = N::select(half_b.lt(zero), half_b - root, half_b + root);
        let ff = f.dot(f);
        let (t0, t1) = ((ff - squared_radius) / q, q * rays.inverse_squared_length);
        // The sign of f.d decides which of the two roots is the smaller one.
        let is_sorted = t0.le(t1);
        let (first, second) = (N::select(is_sorted, t0, t1), N::select(is_sorted, t1, t0));
        let t = N::select(min.le(first), first, second);
        let is_far = (N::splat(NEWTON_MIN_RADII * NEWTON_MIN_RADII) * squared_radius).lt(ff);
        // The Newton step is skipped if no lane needs it.
        let t = if is_far.any() { N::select(is_far, self.newton_step(t, f, rays), t) } else { t };
        let [start, end] = crossed(self.boxes(), rays);
        let t = clamp_keeping_nan(start, end, t);
        Some((crosses & start.le(end) & min.le(t), t))
    }

    #[inline(always)]
    fn boxes(&self) -> [Vector<N>; 2] {
        let radius = Vector { x: self.radius, y: self.radius, z: self.radius };
        [self.center - radius, self.center + radius]
    }
}

impl<N: Number> AtCrossing<N> for SphereN<N> {
    #[inline(always)]
    fn points_at(&self, rays: &Rays<N>, t: N) -> Points<N> {
        let outward = rays.origin + rays.direction * t - self.center;
        let outward = outward * (N::splat(1.0) / outward.dot(outward).sqrt());
        let position = self.center + outward * self.radius;
        Points::seen_by(rays, position, outward, self.center.max_abs_coordinate() + self.radius, [N::splat(0.0); 2])
    }
}

impl SoaLeaf for SphereN<F32x8> {
    type Shape = Sphere;
    type Of<'l, N: Lanes> = SphereN<N>;

    fn of(shapes: &[Sphere]) -> Self {
        let sphere = |lane: usize| shapes.get(lane).copied().unwrap_or(NEVER_HIT);
        Self {
            center: Vector::of(from_fn(|lane| sphere(lane).center)),
            radius: F32x8(from_fn(|lane| sphere(lane).radius)),
        }
    }

    #[inline(always)]
    fn one_per_lane<N: Lanes>(&self) -> SphereN<N> {
        SphereN { center: self.center.load(), radius: N::load(&self.radius) }
    }

    #[inline(always)]
    fn splat<N: Lanes>(&self, lane: usize) -> SphereN<N> {
        SphereN { center: Vector::splat(self.center.of_lane(lane)), radius: N::splat(self.radius.0[lane]) }
    }

    #[inline(always)]
    fn gather<N: Lanes>(&self, lanes: N) -> SphereN<N> {
        let SphereN { center, radius } = self.one_per_lane::<N>();
        SphereN { center: center.gather(lanes), radius: radius.gather(lanes) }
    }

    #[inline(always)]
    fn select<'l, N: Lanes>(mask: N::Mask, yes: SphereN<N>, no: SphereN<N>) -> SphereN<N>
    where
        Self: 'l,
    {
        SphereN { center: Vector::select(mask, yes.center, no.center), radius: N::select(mask, yes.radius, no.radius) }
    }
}

/// The sphere of unused lanes, which no ray hits.
// With its center at infinity the term under the root is NaN, and comparisons with NaN are false.
const NEVER_HIT: Sphere = Sphere { center: Vec3::INFINITY, radius: 1.0 };

impl Surface for Sphere {
    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds { min: self.center - self.radius, max: self.center + self.radius })
    }

    #[inline]
    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let (crosses, t) = self.as_one_lane().first_crossing(&probe.rays, within.min)?;
        (crosses && t <= within.max).then_some(t)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        self.as_one_lane().points_at(&Probe::new(*ray).rays, t).point()
    }

    /// Returns the coordinates of the point in the direction of the normal, which has more digits
    /// than the position far from the origin.
    fn chart(&self, &ChartPoint { position, normal, turn, .. }: &ChartPoint) -> Option<Vec2> {
        let outward = if (position - self.center).dot(normal) < 0.0 { -normal } else { normal };
        Some(chart::on_ball((turn * outward).as_dvec3()))
    }
}

impl Described for Sphere {
    const KIND: &'static str = "sphere";

    fn described(&self, color: &str) -> String {
        format!("a {color} sphere of radius {}", number(self.radius))
    }

    /// Solves A t^2 + 2 B t + C = 0, as the lecture does.
    fn equation(&self, ray: &Ray) -> Equation {
        let (d, from_center) = (ray.direction.as_dvec3(), ray.origin.as_dvec3() - self.center.as_dvec3());
        let radius = f64::from(self.radius);
        // In f64 the formula of the lecture is exact enough as it stands, without the steps against cancellation.
        let (a, b, c) = (d.dot(d), from_center.dot(d), from_center.dot(from_center) - radius * radius);
        let under_root = b * b - a * c;
        let root = |sign: f64| (-b + sign * under_root.sqrt()) / a;
        let roots = if under_root >= 0.0 { vec![root(-1.0), root(1.0)] } else { Vec::new() };
        let steps = vec![
            EquationStep::Text("|o + t d - c|^2 - r^2 = 0"),
            EquationStep::Text("A t^2 + 2 B t + C = 0"),
            EquationStep::Value("A = d.d", a),
            EquationStep::Value("B = (o-c).d", b),
            EquationStep::Value("C = (o-c).(o-c) - r^2", c),
            EquationStep::Text("t = (-B +- sqrt(B^2 - A C)) / A"),
            EquationStep::Values("  = ", " or ", roots.clone()),
        ];
        Equation { steps, roots, without_root: "miss", is_outside: false }
    }

    fn encloses(&self, point: Vec3) -> bool {
        self.center.distance(point) < self.radius
    }

    fn silhouette_sphere(&self) -> Option<(Vec3, f32)> {
        Some((self.center, self.radius))
    }
}

/// A sphere as written: `Sphere(center: ..., radius: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenSphere {
    /// The centre.
    pub center: Option<WrittenVector>,
    /// The radius.
    pub radius: Option<WrittenNumber>,
}

impl InSceneFile for Sphere {
    type Written = WrittenSphere;

    const NAME: &'static str = "Sphere";
    const OWNER: &'static str = "a Sphere";
    const FORM: &'static str = "Sphere(center: ..., radius: ...)";
    const FIELDS: &'static [&'static str] = &["center", "radius"];
    const SUMMARY: &'static str = "All points at one distance from a centre.";
    const MEANINGS: &'static [&'static str] = &["the centre", "the radius"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenSphere {
        WrittenSphere {
            center: reader.required(fields, "center", NodeReader::point),
            radius: reader.required(fields, "radius", NodeReader::number),
        }
    }
}

impl CheckedShape for Sphere {
    const HAS_CHART: bool = true;

    fn check(written: &WrittenSphere, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let center = written.center.and_then(|center| validator.point(center));
        let radius = written.radius.and_then(|radius| validator.length("radius", radius));
        Some(Self { center: center?, radius: radius? }.into())
    }
}

impl Placeable for Sphere {
    /// Maps the sphere to a sphere, or to an ellipsoid if the placement's scale factors differ.
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let (center, radius) = (self.center.as_dvec3(), f64::from(self.radius));
        let Some(scale) = placement.uniform_scale() else {
            return Ellipsoid::new(center, DVec3::splat(radius)).placed(placement);
        };
        Some(Self { center: placement.map().point(center).as_vec3(), radius: (radius * scale) as f32 }.into())
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
