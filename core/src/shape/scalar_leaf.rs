//! A leaf for surfaces whose formula is written for one ray and one surface.

use super::{AtCrossing, Crossable, Points, SoaLeaf, Surface};
use crate::bounds::crossed;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Vector, set_bits};
use crate::ray::{EightRays, Rays};
use glam::Vec3;
use std::array::from_fn;
use std::ptr;
use std::sync::Arc;

/// A leaf with up to eight surfaces of any type, each tested against all rays of its lanes at once.
#[derive(Clone, Debug, PartialEq)]
pub struct ScalarLeaf<S> {
    /// The surfaces, one per lane from the first lane on.
    // Reference-counted, so that a copy of the tree shares them.
    surfaces: Arc<[S]>,
    /// The boxes of the surfaces. Unused lanes have an inverted infinite box, which no ray hits.
    boxes: [Vector<F32x8>; 2],
}

impl<S> ScalarLeaf<S> {
    /// Replaces all surfaces by others with the same bounds.
    pub(crate) fn replace(&mut self, by: impl Fn(&S) -> S) {
        self.surfaces = self.surfaces.iter().map(by).collect();
    }
}

impl<S: Surface + Clone + Send + Sync> SoaLeaf for ScalarLeaf<S> {
    type Shape = S;
    type Of<'l, N: Lanes>
        = ScalarLanes<'l, S, N>
    where
        S: 'l;

    fn of(shapes: &[S]) -> Self {
        let bounds = |lane: usize| shapes.get(lane).and_then(Surface::bounds);
        let min = from_fn(|lane| bounds(lane).map_or(Vec3::INFINITY, |bounds| bounds.min));
        let max = from_fn(|lane| bounds(lane).map_or(Vec3::NEG_INFINITY, |bounds| bounds.max));
        Self { surfaces: shapes.into(), boxes: [Vector::of(min), Vector::of(max)] }
    }

    #[inline(always)]
    fn one_per_lane<N: Lanes>(&self) -> ScalarLanes<'_, S, N> {
        ScalarLanes { surfaces: from_fn(|lane| self.surfaces.get(lane)), boxes: self.boxes.map(|corner| corner.load()) }
    }

    #[inline(always)]
    fn splat<N: Lanes>(&self, lane: usize) -> ScalarLanes<'_, S, N> {
        ScalarLanes {
            surfaces: [self.surfaces.get(lane); LANES],
            boxes: self.boxes.map(|corner| Vector::splat(corner.of_lane(lane))),
        }
    }

    #[inline(always)]
    fn gather<N: Lanes>(&self, lanes: N) -> ScalarLanes<'_, S, N> {
        let index = lanes.store();
        ScalarLanes {
            surfaces: from_fn(|lane| self.surfaces.get(index.0[lane].to_bits() as usize % LANES)),
            boxes: self.boxes.map(|corner| corner.load().gather(lanes)),
        }
    }

    #[inline(always)]
    fn select<'l, N: Lanes>(
        mask: N::Mask,
        yes: ScalarLanes<'l, S, N>,
        no: ScalarLanes<'l, S, N>,
    ) -> ScalarLanes<'l, S, N>
    where
        Self: 'l,
    {
        let bits = mask.bits();
        let of_two = |corner: usize| Vector::select(mask, yes.boxes[corner], no.boxes[corner]);
        ScalarLanes {
            surfaces: from_fn(|lane| if bits >> lane & 1 == 1 { yes.surfaces[lane] } else { no.surfaces[lane] }),
            boxes: [of_two(0), of_two(1)],
        }
    }
}

/// Surfaces of [`ScalarLeaf`]s, one per lane.
// References, because a reference count that each test of a surface increased made threads wait for each other's cache
// line.
pub struct ScalarLanes<'l, S, N: Lanes> {
    /// The surface of each lane; `None` if the lane is unused.
    surfaces: [Option<&'l S>; LANES],
    boxes: [Vector<N>; 2],
}

impl<S: Surface, N: Lanes> ScalarLanes<'_, S, N> {
    /// Returns the mask of the active rays that cross their lanes' surfaces, and the t of each.
    fn crossings(&self, mut rays: EightRays, inside: &[F32x8; 2], within: &[F32x8; 2]) -> (u32, F32x8) {
        let (mut crosses, mut t, mut left) = (0, F32x8::ZERO, rays.active);
        while let Some(first) = set_bits(left).next() {
            // Tests all active lanes with the same surface together.
            let surface = self.surfaces[first];
            let is_same = |lane: &usize| self.surfaces[*lane].map(ptr::from_ref) == surface.map(ptr::from_ref);
            rays.active = set_bits(left).filter(is_same).fold(0, |lanes, lane| lanes | 1 << lane);
            left &= !rays.active;
            let Some(surface) = surface else { continue };
            let (found, crossings) = surface.closest_crossings(&rays, inside, within);
            set_bits(found).for_each(|lane| t.0[lane] = crossings.0[lane]);
            crosses |= found;
        }
        (crosses, t)
    }
}

impl<S: Surface, N: Lanes> Crossable<N> for ScalarLanes<'_, S, N> {
    #[inline(always)]
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)> {
        self.first_crossing_with_hint(rays, [min, N::splat(f32::MAX)])
    }

    // Without inlining, each load and store would be a call; these calls took most of the time of rays that miss the
    // box.
    #[inline(always)]
    fn first_crossing_with_hint(&self, rays: &Rays<N>, [min, max]: [N; 2]) -> Option<(N::Mask, N)> {
        let [enters, leaves] = crossed(self.boxes, rays);
        let active = enters.max(min).le(leaves.min(max)).bits();
        if active == 0 {
            return None;
        }
        let rays = EightRays { origin: rays.origin.store(), direction: rays.direction.store(), active };
        let (crosses, t) = self.crossings(rays, &[enters.store(), leaves.store()], &[min.store(), max.store()]);
        (crosses != 0).then(|| (N::mask_from_bits(crosses), N::load(&t)))
    }

    #[inline(always)]
    fn boxes(&self) -> [Vector<N>; 2] {
        self.boxes
    }
}

impl<S: Surface, N: Lanes> AtCrossing<N> for ScalarLanes<'_, S, N> {
    #[inline(always)]
    fn points_at(&self, rays: &Rays<N>, t: N) -> Points<N> {
        let (t, rays) =
            (t.store(), EightRays { origin: rays.origin.store(), direction: rays.direction.store(), active: 0 });
        let points = from_fn::<_, LANES, _>(|lane| {
            let surface = self.surfaces[lane]?;
            Some(surface.at_crossing(&rays.ray(lane), t.0[lane]))
        });
        Points::of_lanes(&points)
    }
}
