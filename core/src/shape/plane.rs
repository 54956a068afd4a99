//! Ray-plane intersection (lecture, "Ray intersection").

use super::equation::finite_quotient;
use super::placement::{Placeable, Placement};
use super::{
    AtCrossing, ChartPoint, CheckedShape, Crossable, Described, Endless, Equation, EquationStep, Meshes, Points, Shape,
    Surface, SurfacePoint, flat_footprint,
};
use crate::bounds::Bounds;
use crate::checks::{self, SceneFault};
use crate::formula::Line;
use crate::lanes::{Lanes, Number, Vector};
use crate::ray::{Interval, Probe, Ray, Rays};
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenVector};
use glam::{DVec3, Vec2, Vec3};

/// A plane: all points x with (x - a).n = 0. It is unbounded, and visible from both sides.
///
/// ```
/// use glam::Vec3;
/// use termtrace::Plane;
///
/// let floor = Plane::new(Vec3::ZERO, Vec3::Y)?;
/// assert!(Plane::new(Vec3::ZERO, Vec3::ZERO).is_err(), "the normal has no direction");
/// # let _ = floor;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: Vec3,
    normal: Vec3,
    /// The axes u and v of patterns, whose dot products with an offset are its coordinates.
    ///
    /// Unless the plane was scaled, u, normal and v are a right-handed orthonormal basis.
    u: Vec3,
    v: Vec3,
}

impl Plane {
    /// Returns the plane through `point`, perpendicular to `normal`.
    ///
    /// The normal may have any length but 0.
    ///
    /// # Errors
    /// Unless all coordinates lie within ±1e9, and the normal has a length.
    pub fn new(point: Vec3, normal: Vec3) -> Result<Self, SceneFault> {
        let point = checks::checked_point("point", point)?;
        Ok(Self::unchecked(point, checks::checked_direction("normal", normal)?))
    }

    /// Returns the plane without checking the arguments; `normal` must have unit length.
    #[doc(hidden)]
    pub fn unchecked(point: Vec3, normal: Vec3) -> Self {
        let u = pattern_axis(normal);
        // On a floor, whose normal is +y, u is +x and v is +z.
        Self { point, normal, u, v: u.cross(normal) }
    }

    /// Returns the point of the plane that is the origin of patterns.
    #[doc(hidden)]
    pub fn point(&self) -> Vec3 {
        self.point
    }

    /// Returns the normal, of unit length.
    #[doc(hidden)]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Solves (p + t d - a).n = 0: t = (a - p).n / d.n.
    ///
    /// The result is infinite or NaN for a ray parallel to the plane.
    #[inline(always)]
    fn crossing<N: Number>(&self, rays: &Rays<N>) -> N {
        let normal = Vector::splat(self.normal);
        (Vector::splat(self.point) - rays.origin).dot(normal) / rays.direction.dot(normal)
    }
}

/// Returns the axis u of patterns: the x axis projected into the plane, or the z axis if the normal
/// is close to x.
pub(super) fn pattern_axis(normal: Vec3) -> Vec3 {
    // 0.9 keeps the projection longer than 0.43, far from a division by zero.
    let axis = if normal.x.abs() < 0.9 { Vec3::X } else { Vec3::Z };
    (axis - normal * axis.dot(normal)).normalize()
}

impl<N: Number> Crossable<N> for Plane {
    #[inline(always)]
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)> {
        let t = self.crossing(rays);
        // For a parallel ray t is infinite or NaN, because of a division by zero, and one of the comparisons is false.
        Some((min.le(t) & t.le(N::splat(f32::MAX)), t))
    }

    #[inline(always)]
    fn boxes(&self) -> [Vector<N>; 2] {
        [Vector::splat(Vec3::NEG_INFINITY), Vector::splat(Vec3::INFINITY)]
    }
}

impl Surface for Plane {
    fn bounds(&self) -> Option<Bounds> {
        None
    }

    #[inline]
    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let t = self.crossing(&probe.rays);
        within.contains(t).then_some(t)
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        AtCrossing::points_at(self, &Probe::new(*ray).rays, t).point()
    }

    #[inline(always)]
    fn footprint<N: Number>(
        &self,
        direction: Vector<N>,
        t: N,
        _: impl Fn() -> Vector<N>,
        direction_steps: [Vec3; 2],
    ) -> [N; 2] {
        let (normal, u, v) = (Vector::splat(self.normal), Vector::splat(self.u), Vector::splat(self.v));
        flat_footprint(direction, t, normal, [u, v], direction_steps)
    }

    /// Returns the coordinates of patterns, in which the picture has a side of 1: u is to the
    /// right, and v down.
    fn chart(&self, point: &ChartPoint) -> Option<Vec2> {
        Some(point.uv)
    }
}

impl Endless for Plane {
    type Of<N: Lanes> = Self;

    #[inline(always)]
    fn splat<N: Lanes>(&self) -> Self {
        *self
    }
}

impl<N: Number> AtCrossing<N> for Plane {
    #[inline(always)]
    fn points_at(&self, rays: &Rays<N>, t: N) -> Points<N> {
        let (point, normal) = (Vector::splat(self.point), Vector::splat(self.normal));
        let hit = rays.origin + rays.direction * t;
        // The error of `hit` is proportional to t. Projecting `hit` onto the plane makes its error proportional to its
        // coordinates.
        let position = hit - normal * (hit - point).dot(normal);
        let from_point = position - point;
        let uv = [from_point.dot(Vector::splat(self.u)), from_point.dot(Vector::splat(self.v))];
        Points::seen_by(rays, position, normal, position.max_abs_coordinate() + point.max_abs_coordinate(), uv)
    }
}

impl Described for Plane {
    const KIND: &'static str = "plane";

    fn described(&self, color: &str) -> String {
        format!("an endless {color} plane")
    }

    fn equation(&self, ray: &Ray) -> Equation {
        let line = Line { origin: ray.origin.as_dvec3(), direction: ray.direction.as_dvec3() };
        equation(&line, self.point.as_dvec3(), self.normal.as_dvec3())
    }
}

/// Solves t = (a - o).n / d.n, for a point a of a plane and its normal n.
pub(super) fn equation(&Line { origin: o, direction: d }: &Line, a: DVec3, n: DVec3) -> Equation {
    let (above, below) = ((a - o).dot(n), d.dot(n));
    let t = finite_quotient(above, below);
    let steps = vec![
        EquationStep::Text("(o + t d - a).n = 0"),
        EquationStep::Value("(a-o).n", above),
        EquationStep::Value("d.n", below),
        EquationStep::Value("t = (a-o).n / d.n", t.unwrap_or_default()),
    ];
    Equation { steps, roots: t.into_iter().collect(), without_root: "parallel", is_outside: false }
}

/// A plane as written: `Plane(point: ..., normal: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenPlane {
    /// Any point of the plane.
    pub point: Option<WrittenVector>,
    /// The normal, of any length but 0.
    pub normal: Option<WrittenVector>,
}

impl InSceneFile for Plane {
    type Written = WrittenPlane;

    const NAME: &'static str = "Plane";
    const OWNER: &'static str = "a Plane";
    const FORM: &'static str = "Plane(point: ..., normal: ...)";
    const FIELDS: &'static [&'static str] = &["point", "normal"];
    const SUMMARY: &'static str = "An endless plane, seen from both sides.";
    const MEANINGS: &'static [&'static str] = &["any point of the plane", "the normal, of any length"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenPlane {
        WrittenPlane {
            point: reader.required(fields, "point", NodeReader::point),
            normal: reader.required(fields, "normal", NodeReader::direction),
        }
    }
}

impl CheckedShape for Plane {
    const HAS_COORDINATES: bool = true;

    fn check(written: &WrittenPlane, validator: &mut Validator<'_>, _: &mut dyn Meshes) -> Option<Shape> {
        let point = written.point.and_then(|point| validator.point(point));
        let normal = written.normal.and_then(|normal| validator.unit_vector("normal", normal));
        Some(Self::unchecked(point?, normal?.as_vec3()).into())
    }
}

impl Placeable for Plane {
    fn placed(self, placement: &Placement) -> Option<Shape> {
        let (map, point) = (placement.map(), self.point.as_dvec3());
        let [normal, u, v] = [self.normal, self.u, self.v].map(|vector| map.normal(vector.as_dvec3()));
        let [normal, u, v] = [normal.normalize(), u, v].map(DVec3::as_vec3);
        Some(Self { point: map.point(point).as_vec3(), normal, u, v }.into())
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
