//! Where lines enter and leave solids.

use super::{Operation, Part, Solid};
use crate::ray::{Interval, Probe, Ray};
use crate::shape::exact::{self, Crossings, Inside};
use crate::shape::{Plane, Shape, Sphere, Torus};
use glam::Vec3;
use std::cmp::Ordering;

/// The most shapes in a solid, those of the solids among its parts counted.
// A line has up to four crossings with each, and all of them are kept in an array on the stack.
pub(super) const MAX_SHAPES: usize = 16;

/// The most boundaries of a solid along a line.
pub(super) const MAX_BOUNDARIES: usize = 4 * MAX_SHAPES;

/// The room for boundaries that is enough for most solids.
// Room is written before it is used. For the most boundaries, that took longer than finding the few that a line has.
pub(super) const FEW_BOUNDARIES: usize = 16;

/// The distance, relative to the largest t, within which two boundaries are one.
// Two parts that share a face compute its t with different roundings, of about 1e-15. Points in f32 are off by 1e-7.
const TOLERANCE: f64 = 1e-11;

/// An end of a piece of a line inside a solid.
#[derive(Clone, Copy)]
pub(super) struct Boundary {
    pub(super) t: f64,
    /// The number of the part on whose surface it is.
    part: u8,
    /// The number of the shape on whose surface it is, among the shapes of all parts.
    pub(super) shape: u8,
    /// Whether that shape is a plane.
    is_of_plane: bool,
    /// Whether the line enters the solid here.
    pub(super) enters: bool,
}

/// Up to `N` boundaries of a solid along a line, in ascending order.
pub(super) struct Boundaries<const N: usize> {
    found: [Boundary; N],
    count: usize,
    /// Whether the line begins inside, at t = -infinity.
    pub(super) begins_inside: bool,
}

impl<const N: usize> Boundaries<N> {
    /// Returns the boundaries of a line that misses the solid.
    fn none() -> Self {
        let unused = Boundary { t: 0.0, part: 0, shape: 0, is_of_plane: false, enters: false };
        Self { found: [unused; N], count: 0, begins_inside: false }
    }

    /// Adds a boundary of a part; one without a place on the line is left out.
    fn push(&mut self, boundary: Boundary) {
        // There is always a free place: the number of shapes is limited.
        if !boundary.t.is_nan()
            && let Some(free) = self.found.get_mut(self.count)
        {
            *free = boundary;
            self.count += 1;
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Boundary> {
        self.found.iter().take(self.count).copied()
    }

    /// Adds the boundaries of the part with this number along the line of a ray, in ascending
    /// order.
    ///
    /// Returns whether the line begins inside the part, at t = -infinity.
    fn add_part(&mut self, number: u8, Part { shape, first_shape, .. }: &Part, probe: &Probe) -> bool {
        let (ray, unplaced) =
            (&probe.ray, Boundary { t: 0.0, part: number, shape: *first_shape, is_of_plane: false, enters: false });
        let crossings = match shape {
            Shape::Solid(solid) => {
                let mut boundaries = Boundaries::<N>::none();
                solid.find(probe, &mut boundaries);
                for boundary in boundaries.iter() {
                    self.push(Boundary { part: number, shape: first_shape + boundary.shape, ..boundary });
                }
                return boundaries.begins_inside;
            }
            Shape::Plane(plane) => return self.add_half_space(unplaced, plane, ray),
            Shape::Torus(torus) => {
                self.add_torus(unplaced, torus, ray);
                return false;
            }
            Shape::Sphere(sphere) => sphere_crossings(sphere, ray),
            Shape::Cuboid(shape) => exact::crossings(shape, ray),
            Shape::Cylinder(shape) => exact::crossings(shape, ray),
            Shape::Cone(shape) => exact::crossings(shape, ray),
            Shape::Capsule(shape) => exact::crossings(shape, ray),
            Shape::Ellipsoid(shape) => exact::crossings(shape, ray),
            _ => Crossings::NONE,
        };
        for (number, crossing) in crossings.iter().enumerate() {
            self.push(Boundary { t: crossing.t, enters: number % 2 == 0, ..unplaced });
        }
        false
    }

    /// Adds the boundaries of a torus, without the points at which a line only touches it.
    fn add_torus(&mut self, unplaced: Boundary, torus: &Torus, ray: &Ray) {
        let crossings = exact::crossings(torus, ray);
        let mut crossings = crossings.iter().map(|crossing| crossing.t).peekable();
        let mut is_inside = false;
        while let Some(t) = crossings.next() {
            let enters = crossings.peek().is_some_and(|next| torus.contains_at(ray, 0.5 * (t + next)));
            if enters != is_inside {
                is_inside = enters;
                self.push(Boundary { t, enters, ..unplaced });
            }
        }
    }

    /// Adds the boundary of all that is behind a plane, and returns whether the line begins there.
    fn add_half_space(&mut self, unplaced: Boundary, plane: &Plane, ray: &Ray) -> bool {
        let [point, normal] = [plane.point(), plane.normal()].map(Vec3::as_dvec3);
        let height = (ray.origin.as_dvec3() - point).dot(normal);
        let change = ray.direction.as_dvec3().dot(normal);
        if change == 0.0 {
            return height < 0.0;
        }
        self.push(Boundary { t: -height / change, is_of_plane: true, enters: change < 0.0, ..unplaced });
        change > 0.0
    }

    /// Replaces the boundaries of the parts by those of the solid.
    ///
    /// `inside` is the mask of the parts in which the line begins, and `count` the number of parts.
    fn combine(&mut self, operation: Operation, mut inside: u32, count: usize) {
        let events = &mut self.found[..self.count];
        // A stable sort, so that boundaries at one t keep the order of the parts.
        events.sort_by(|a, b| a.t.partial_cmp(&b.t).unwrap_or(Ordering::Equal));
        let contains = |inside| operation.contains(inside, count);
        self.begins_inside = contains(inside);
        // The t of a plane that is almost parallel to the line is no measure of the solid.
        let bounded = events.iter().filter(|boundary| !boundary.is_of_plane);
        let largest = bounded.map(|boundary| boundary.t.abs()).filter(|t| t.is_finite()).fold(0.0, f64::max);
        let (mut start, mut was_inside, mut kept) = (0, self.begins_inside, 0);
        while start < events.len() {
            let mut end = start;
            let mut decisive = None;
            while let Some(event) = events.get(end)
                && (end == start || event.t - events[start].t <= TOLERANCE * largest)
            {
                let before = contains(inside);
                inside ^= 1 << event.part;
                if contains(inside) != before {
                    decisive = Some(*event);
                }
                end += 1;
            }
            if contains(inside) != was_inside
                && let Some(boundary) = decisive
            {
                was_inside = !was_inside;
                // At most one boundary is kept of each group, so the place has been read.
                events[kept] = Boundary { enters: was_inside, ..boundary };
                kept += 1;
            }
            start = end;
        }
        self.count = kept;
    }
}

/// Returns the crossings of a sphere, computed in f64.
fn sphere_crossings(sphere: &Sphere, ray: &Ray) -> Crossings {
    let from_center = ray.origin.as_dvec3() - sphere.center().as_dvec3();
    Inside::ball(from_center, ray.direction.as_dvec3(), sphere.radius().into()).crossings()
}

impl Solid {
    /// Returns where the line of a ray enters and leaves the solid.
    ///
    /// `N` is at least [`most_boundaries`](Self::most_boundaries).
    pub(super) fn boundaries<const N: usize>(&self, probe: &Probe) -> Boundaries<N> {
        let mut boundaries = Boundaries::none();
        self.find(probe, &mut boundaries);
        boundaries
    }

    /// Returns the first boundary that a ray may reach, as [`exact::first_in_box`] does.
    ///
    /// `N` is at least [`most_boundaries`](Self::most_boundaries).
    pub(super) fn first_boundary<const N: usize>(&self, ray: &Ray, inside: Interval, within: Interval) -> Option<f32> {
        if !exact::overlap(inside, within) {
            return None;
        }
        let mut boundaries = Boundaries::<N>::none();
        self.find(&Probe::new(*ray), &mut boundaries);
        exact::first_reached(boundaries.iter().map(|boundary| boundary.t), inside, within)
    }

    /// Adds where the line of a ray enters and leaves the solid, to no boundaries.
    // Into a place of the caller's, because returned values are copied.
    fn find<const N: usize>(&self, probe: &Probe, boundaries: &mut Boundaries<N>) {
        let mut inside = 0_u32;
        for (number, part) in (0..).zip(&*self.parts) {
            let before = boundaries.count;
            // Most lines miss most parts. No crossing is lost (`culling.md`, 3).
            if part.bounds.is_none_or(|bounds| bounds.is_crossed(probe)) {
                inside |= u32::from(boundaries.add_part(number, part, probe)) << number;
            }
            // The line is outside the whole part, and so outside the solid.
            if boundaries.count == before && inside >> number & 1 == 0 && self.operation.needs(number.into()) {
                boundaries.count = 0;
                return;
            }
        }
        boundaries.combine(self.operation, inside, self.parts.len());
    }

    /// Returns an upper bound of the number of boundaries along any line.
    pub(super) fn most_boundaries(&self) -> usize {
        let of_part = |part: &Part| match &part.shape {
            Shape::Solid(solid) => solid.most_boundaries(),
            Shape::Torus(_) => 4,
            Shape::Plane(_) => 1,
            _ => 2,
        };
        self.parts.iter().map(of_part).sum()
    }
}
