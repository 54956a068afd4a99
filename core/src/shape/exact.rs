//! Bounded surfaces whose crossings are computed in f64, and rounded to f32 once.
//!
//! f64 has 29 bits more than the rays, the t and the points of a picture. In f64, the lecture's equations need none of
//! the care against rounding that they need in f32 (see [`sphere`](super::sphere)), and each surface has its formula in
//! the code only once. For a ray that grazes the surface, or passes through an edge between two of its parts, all
//! kernels decide by the same computation whether it hits. The price is speed: surfaces are tested one by one.

use super::described::length_in_words;
use super::equation::{Equation, EquationStep};
use super::placement::{AffineMap, Placeable, Placement, shape_line};
use super::{ChartPoint, Points, Shape, Surface, SurfacePoint, flat_footprint};
use crate::bounds::Bounds;
use crate::formula::Line;
use crate::lanes::{F32x8, Number, Vector, set_bits};
use crate::ray::{EightRays, Interval, Probe, Ray, clamp_keeping_nan};
use glam::{DVec3, Vec2, Vec3};
use std::sync::Arc;

/// The largest number of crossings of a line and a surface: a torus has up to four.
const MAX_CROSSINGS: usize = 4;

/// The largest number of crossings that an explanation shows, preferably in front of the eye.
const MAX_SHOWN: usize = 2;

/// Lower bound of the size that scales a point's clearance, as a fraction of the surface's extent.
// It makes the clearance at least 1.9e-12 of the extent. The error of positions in f64 is below 1e-13 of the extent for
// rays that start up to 1,000 extents away.
const RELATIVE_ERROR: f32 = 1e-6;

/// A bounded surface whose crossings with a line follow from a formula in f64.
///
/// Lines and points are in the coordinates of the shape, before it is scaled, rotated and moved, and relative to the
/// [centre](Self::center).
pub(crate) trait Exact {
    /// Returns the bounds and the placement of the surface.
    fn placed_bounds(&self) -> &PlacedBounds;

    /// Returns the bounds and the placement of the surface, to be changed.
    fn placed_bounds_mut(&mut self) -> &mut PlacedBounds;

    /// Returns the middle of the surface.
    fn center(&self) -> DVec3;

    /// Returns the largest dot product of a vector and a point of the surface.
    ///
    /// The bounds follow from it.
    fn reach(&self, direction: DVec3) -> f64;

    /// Returns the crossings of a line whose origin is its point nearest to the centre.
    fn crossings(&self, line: &Line) -> Crossings;

    /// Returns the outward normal, of any length, at a point on a part of the surface.
    fn normal(&self, part: u8, at: DVec3) -> DVec3;

    /// Returns the origin of patterns.
    fn pattern_origin(&self) -> DVec3 {
        DVec3::ZERO
    }

    /// Returns the axes u and v of patterns at points with a given normal; `None` without patterns.
    fn pattern_axes(&self, _normal: Vec3) -> Option<[Vec3; 2]> {
        None
    }

    /// Returns the coordinates of a picture at a point with a unit normal on either side.
    fn chart_at(&self, _at: DVec3, _normal: DVec3) -> Option<Vec2> {
        None
    }
}

/// The bounds of a surface in the scene, and its map to the scene if it is placed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlacedBounds {
    bounds: Bounds,
    map: Option<Arc<AffineMap>>,
}

impl PlacedBounds {
    /// The placeholder of a surface whose bounds [`with_bounds`] has not computed yet.
    pub(super) const NONE: Self = Self { bounds: Bounds { min: Vec3::ZERO, max: Vec3::ZERO }, map: None };

    /// Returns the bounds in the scene.
    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Returns the line of a ray in the coordinates of the shape.
    #[inline]
    pub(super) fn line(&self, ray: &Ray) -> Line {
        shape_line(self.map.as_deref(), ray)
    }

    /// Returns a point of the scene in the coordinates of the shape.
    pub(super) fn scene_to_shape(&self, scene_point: Vec3) -> DVec3 {
        self.shape_point(scene_point.as_dvec3())
    }

    #[inline]
    fn shape_point(&self, point: DVec3) -> DVec3 {
        self.map.as_ref().map_or(point, |map| map.shape_point(point))
    }

    /// Returns the factors by which the shape is scaled, to be added to its description.
    pub(super) fn scale_in_words(&self) -> String {
        match self.map.as_ref().map(|map| map.factors().map(length_in_words)) {
            Some([x, y, z]) if x != y || y != z => format!(", scaled by {x}, {y} and {z}"),
            Some([x, ..]) if x != "1" => format!(", scaled by {x}"),
            _ => String::new(),
        }
    }
}

/// Returns a surface with its bounds in the scene, computed from its reach and its map.
pub(super) fn with_bounds<S: Exact>(mut surface: S) -> S {
    let map = surface.placed_bounds().map.clone();
    let bounds = AffineMap::bounds(map.as_deref(), surface.center(), |direction| surface.reach(direction));
    *surface.placed_bounds_mut() = PlacedBounds { bounds, map };
    surface
}

impl<S: Exact + Into<Shape>> Placeable for S {
    fn placed(mut self, placement: &Placement) -> Option<Shape> {
        let (old, new) = (self.placed_bounds().map.as_deref(), placement.map());
        self.placed_bounds_mut().map = Some(Arc::new(old.map_or(new, |old| old.then(&new))));
        Some(with_bounds(self).into())
    }

    fn has_map(&self) -> bool {
        self.placed_bounds().map.is_some()
    }
}

/// A crossing of a line and a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// The t of the crossing.
    pub(crate) t: f64,
    /// The part of the surface, such as a face or a cap.
    pub(crate) part: u8,
}

/// Up to four crossings, in ascending order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossings {
    found: [Crossing; MAX_CROSSINGS],
    count: usize,
}

impl Crossings {
    /// No crossings.
    pub(crate) const NONE: Self = Self { found: [Crossing { t: 0.0, part: 0 }; MAX_CROSSINGS], count: 0 };

    /// Adds a crossing whose t is not less than that of any other; a fifth one is left out.
    pub(crate) fn push(&mut self, crossing: Crossing) {
        if let Some(free) = self.found.get_mut(self.count) {
            *free = crossing;
            self.count += 1;
        }
    }

    /// Returns the crossings.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Crossing> + use<> {
        self.found.into_iter().take(self.count)
    }
}

/// The part of a line inside a convex solid, as the crossings at both ends of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inside {
    /// The crossing at which the line enters.
    pub(crate) enters: Crossing,
    /// The crossing at which the line leaves; before `enters` if no part is inside.
    pub(crate) leaves: Crossing,
}

impl Inside {
    /// The whole line.
    pub(crate) const ALL: Self = Self::of([f64::NEG_INFINITY, f64::INFINITY], [0; 2]);

    /// No part of the line.
    pub(crate) const NOTHING: Self = Self::of([f64::INFINITY, f64::NEG_INFINITY], [0; 2]);

    /// Returns the interval between two values of t, with the parts of the surface at its ends.
    pub(crate) const fn of([enters, leaves]: [f64; 2], parts: [u8; 2]) -> Self {
        Self { enters: Crossing { t: enters, part: parts[0] }, leaves: Crossing { t: leaves, part: parts[1] } }
    }

    /// Returns the interval in which `origin + t * direction` is between two numbers.
    pub(crate) fn slab(origin: f64, direction: f64, [min, max]: [f64; 2], parts: [u8; 2]) -> Self {
        if direction == 0.0 {
            return if (min..=max).contains(&origin) { Self::ALL } else { Self::NOTHING };
        }
        let [to_min, to_max] = [(min - origin) / direction, (max - origin) / direction];
        if direction > 0.0 {
            Self::of([to_min, to_max], parts)
        } else {
            Self::of([to_max, to_min], [parts[1], parts[0]])
        }
    }

    /// Returns the interval in which |origin + t * direction| is at most `radius`.
    pub(crate) fn ball(origin: DVec3, direction: DVec3, radius: f64) -> Self {
        let squared = direction.dot(direction);
        if squared == 0.0 {
            return if origin.dot(origin) <= radius * radius { Self::ALL } else { Self::NOTHING };
        }
        let middle = -origin.dot(direction) / squared;
        let nearest = origin + direction * middle;
        let under_root = (radius * radius - nearest.dot(nearest)) / squared;
        if under_root < 0.0 {
            return Self::NOTHING;
        }
        let half = under_root.sqrt();
        Self::of([middle - half, middle + half], [0; 2])
    }

    /// Returns whether any part of the line is inside; false for NaN.
    pub(crate) fn is_any(&self) -> bool {
        self.enters.t <= self.leaves.t
    }

    /// Returns the part of the line inside both solids.
    pub(crate) fn and(self, other: Self) -> Self {
        let enters = if self.enters.t < other.enters.t { other.enters } else { self.enters };
        let leaves = if other.leaves.t < self.leaves.t { other.leaves } else { self.leaves };
        Self { enters, leaves }
    }

    /// Returns the smallest interval that contains both intervals.
    pub(crate) fn around(self, other: Self) -> Self {
        if !(self.is_any() && other.is_any()) {
            return if self.is_any() { self } else { other };
        }
        let enters = if other.enters.t < self.enters.t { other.enters } else { self.enters };
        let leaves = if self.leaves.t < other.leaves.t { other.leaves } else { self.leaves };
        Self { enters, leaves }
    }

    /// Returns the crossings at both ends.
    pub(crate) fn crossings(self) -> Crossings {
        self.crossings_within(&Self::ALL)
    }

    /// Returns the crossings at both ends that are within another interval.
    pub(crate) fn crossings_within(self, range: &Self) -> Crossings {
        let mut crossings = Crossings::NONE;
        if self.is_any() {
            let is_within = |crossing: &Crossing| range.enters.t <= crossing.t && crossing.t <= range.leaves.t;
            [self.enters, self.leaves].into_iter().filter(is_within).for_each(|crossing| crossings.push(crossing));
        }
        crossings
    }
}

/// Returns the crossings of a surface and the line of a ray.
pub(super) fn crossings<S: Exact>(surface: &S, ray: &Ray) -> Crossings {
    let Line { origin, direction } = surface.placed_bounds().line(ray);
    let from_center = origin - surface.center();
    // With the line's origin at its point nearest to the centre, all its numbers are about as large as the surface.
    let nearest = -from_center.dot(direction) / direction.dot(direction);
    let mut crossings = surface.crossings(&Line { origin: from_center + direction * nearest, direction });
    crossings.found.iter_mut().for_each(|crossing| crossing.t += nearest);
    crossings
}

/// Returns the first of a line's crossings, in ascending order, that a ray may reach.
///
/// It is moved into the interval of the surface's box. Crossings are only computed if that interval has a part within
/// the ray's.
pub(super) fn first_in_box<I: Iterator<Item = f64>>(
    inside: Interval,
    within: Interval,
    crossings: impl FnOnce() -> I,
) -> Option<f32> {
    if overlap(inside, within) { first_reached(crossings(), inside, within) } else { None }
}

/// Returns whether the interval of a surface's box has a part within a ray's.
pub(super) fn overlap(Interval { min, max }: Interval, within: Interval) -> bool {
    min <= max && within.min <= max && min <= within.max
}

/// Returns the first of a line's crossings that a ray may reach, moved into the interval of the
/// surface's box.
pub(super) fn first_reached(
    crossings: impl Iterator<Item = f64>,
    Interval { min, max }: Interval,
    within: Interval,
) -> Option<f32> {
    let finite = crossings.filter(|t| t.is_finite());
    finite.map(|t| clamp_keeping_nan(min, max, t as f32)).find(|&t| within.contains(t))
}

/// Computes [`first_in_box`] for the active rays, and returns the mask of those with a crossing.
///
/// `first` is given a lane, its ray, the interval of the surface's box, and that of the ray.
pub(super) fn first_in_boxes(
    rays: &EightRays,
    inside: &[F32x8; 2],
    within: &[F32x8; 2],
    first: impl Fn(usize, &Ray, Interval, Interval) -> Option<f32>,
) -> (u32, F32x8) {
    let (mut crosses, mut t) = (0, F32x8::ZERO);
    let interval = |[min, max]: &[F32x8; 2], lane: usize| Interval { min: min.0[lane], max: max.0[lane] };
    for lane in set_bits(rays.active) {
        if let Some(crossing) = first(lane, &rays.ray(lane), interval(inside, lane), interval(within, lane)) {
            crosses |= 1 << lane;
            t.0[lane] = crossing;
        }
    }
    (crosses, t)
}

/// Returns the axes of patterns, for dot products with vectors of the scene.
fn pattern_axes_in_scene<S: Exact>(surface: &S, normal: Vec3) -> Option<[Vec3; 2]> {
    let Some(map) = &surface.placed_bounds().map else { return surface.pattern_axes(normal) };
    let axes = surface.pattern_axes(map.shape_normal(normal.as_dvec3()).as_vec3());
    axes.map(|axes| axes.map(|axis| map.normal(axis.as_dvec3()).as_vec3()))
}

/// Returns the equation with the steps `steps` and up to [`MAX_SHOWN`] crossings as its roots.
pub(super) fn equation<S: Exact>(surface: &S, ray: &Ray, mut steps: Vec<EquationStep>) -> Equation {
    let mut roots: Vec<_> = crossings(surface, ray).iter().map(|crossing| crossing.t).collect();
    let behind = roots.iter().filter(|&&root| root < 0.0).count();
    roots.drain(..behind.min(roots.len().saturating_sub(MAX_SHOWN)));
    roots.truncate(MAX_SHOWN);
    steps.push(EquationStep::Values("t = ", " or ", roots.clone()));
    Equation { steps, roots, without_root: "miss", is_outside: false }
}

/// Returns the largest dot product of a vector and a point of a circle of radius 1 about an axis.
pub(super) fn reach_of_circle(axis: DVec3, direction: DVec3) -> f64 {
    (direction - axis * direction.dot(axis)).length()
}

impl<S: Exact> Surface for S {
    fn bounds(&self) -> Option<Bounds> {
        Some(*self.placed_bounds().bounds())
    }

    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
        let in_box = self.placed_bounds().bounds().crossed(probe);
        first_in_box(in_box, within, || crossings(self, &probe.ray).iter().map(|crossing| crossing.t))
    }

    fn closest_crossings(&self, rays: &EightRays, inside: &[F32x8; 2], within: &[F32x8; 2]) -> (u32, F32x8) {
        first_in_boxes(rays, inside, within, |_, ray, inside, within| {
            first_in_box(inside, within, || crossings(self, ray).iter().map(|crossing| crossing.t))
        })
    }

    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
        let off = |crossing: &Crossing| (crossing.t as f32 - t).abs();
        let nearest = crossings(self, ray).iter().min_by(|one, other| off(one).total_cmp(&off(other)));
        let Crossing { t, part } = nearest.unwrap_or(Crossing { t: f64::from(t), part: 0 });
        let direction = ray.direction.as_dvec3();
        let position = ray.origin.as_dvec3() + direction * t;
        let at = self.placed_bounds().shape_point(position);
        let shape_normal = self.normal(part, at - self.center());
        let normal = self.placed_bounds().map.as_ref().map_or(shape_normal, |map| map.normal(shape_normal));
        let length = normal.dot(normal).sqrt();
        // The tip of a pointed torus has no normal.
        let normal = if length > 0.0 { normal / length } else { -direction / direction.dot(direction).sqrt() };
        let normal = normal.as_vec3();
        let uv = self.pattern_axes(shape_normal.normalize_or_zero().as_vec3()).map(|axes| {
            let from_origin = at - self.pattern_origin();
            axes.map(|axis| from_origin.dot(axis.as_dvec3()) as f32)
        });
        let position = position.as_vec3();
        let size =
            position.abs().max_element().max(RELATIVE_ERROR * self.placed_bounds().bounds().extent().max_element());
        let rays = Probe::new(*ray).rays;
        Points::seen_by(&rays, Vector::splat(position), Vector::splat(normal), size, uv.unwrap_or_default()).point()
    }

    fn chart(&self, &ChartPoint { position, normal, .. }: &ChartPoint) -> Option<Vec2> {
        let (placed, normal) = (self.placed_bounds(), normal.as_dvec3());
        let normal = placed.map.as_ref().map_or(normal, |map| map.shape_normal(normal));
        self.chart_at(placed.scene_to_shape(position) - self.center(), normal)
    }

    /// Computes lane by lane, because this code is compiled once for each vector type, and stays
    /// short.
    fn footprint<N: Number>(
        &self,
        direction: Vector<N>,
        t: N,
        normal: impl Fn() -> Vector<N>,
        direction_steps: [Vec3; 2],
    ) -> [N; 2] {
        let (Vector { x: dx, y: dy, z: dz }, Vector { x, y, z }) = (direction, normal());
        N::map_lanes([dx, dy, dz, t, x, y, z], |[dx, dy, dz, t, x, y, z]| {
            let (direction, normal) = (Vector { x: dx, y: dy, z: dz }, Vector { x, y, z });
            let axes = pattern_axes_in_scene(self, normal.into());
            axes.map_or([0.0; 2], |axes| flat_footprint(direction, t, normal, axes.map(Vector::splat), direction_steps))
        })
    }
}
