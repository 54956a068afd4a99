//! A leaf for surfaces whose formula is written for one ray and one surface.

use super::{AtCrossing, Crossable, Points, SoaLeaf, Surface};
use crate::bounds::crossed;
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, Vector, set_bits};
use crate::ray::{EightRays, Rays};
use glam::Vec3;
use std::array::from_fn;
use std::sync::Arc;

/// A leaf with up to eight surfaces of any type, each tested against all rays of its lanes at once.
///
/// A lane holds only the index of its surface, so surfaces of any size in memory fit.
#[derive(Clone, Debug, PartialEq)]
pub struct ScalarLeaf<S> {
    // Reference-counted, because `splat` and `gather` return a new leaf with the same surfaces for each test.
    surfaces: Arc<[S]>,
    /// The index of each lane's surface; an unused lane has an index beyond `surfaces`.
    lanes: [u8; LANES],
}

impl<S> ScalarLeaf<S> {
    /// Returns a leaf with the same surfaces; `surface_of` returns the index of the surface for a
    /// lane.
    fn with_lanes(&self, surface_of: impl FnMut(usize) -> u8) -> Self {
        Self { surfaces: Arc::clone(&self.surfaces), lanes: from_fn(surface_of) }
    }

    /// Replaces all surfaces by others with the same bounds.
    pub(crate) fn replace(&mut self, by: impl Fn(&S) -> S) {
        self.surfaces = self.surfaces.iter().map(by).collect();
    }

    /// Returns the mask of the active rays that cross their lanes' surfaces, and the t of each.
    fn crossings(&self, mut rays: EightRays, inside: &[F32x8; 2], within: &[F32x8; 2]) -> (u32, F32x8)
    where
        S: Surface,
    {
        let (mut crosses, mut t, mut left) = (0, F32x8::ZERO, rays.active);
        while let Some(first) = set_bits(left).next() {
            // Tests all active lanes with the same surface together.
            let is_same = |lane: &usize| self.lanes[*lane] == self.lanes[first];
            rays.active = set_bits(left).filter(is_same).fold(0, |lanes, lane| lanes | 1 << lane);
            left &= !rays.active;
            // Unused lanes have no surface.
            let Some(surface) = self.surface(first) else { continue };
            let (found, crossings) = surface.closest_crossings(&rays, inside, within);
            set_bits(found).for_each(|lane| t.0[lane] = crossings.0[lane]);
            crosses |= found;
        }
        (crosses, t)
    }

    /// Returns the surface that the leaf holds in `lane`, or `None` if the lane is unused.
    fn surface(&self, lane: usize) -> Option<&S> {
        self.surfaces.get(usize::from(self.lanes[lane]))
    }
}

impl<S: Surface + Clone + Send + Sync> SoaLeaf for ScalarLeaf<S> {
    type Shape = S;
    type Of<N: Lanes> = Self;

    fn of(shapes: &[S]) -> Self {
        Self { surfaces: shapes.into(), lanes: from_fn(|lane| lane as u8) }
    }

    #[inline(always)]
    fn one_per_lane<N: Lanes>(&self) -> Self {
        self.clone()
    }

    #[inline(always)]
    fn splat<N: Lanes>(&self, lane: usize) -> Self {
        self.with_lanes(|_| self.lanes[lane])
    }

    #[inline(always)]
    fn gather<N: Lanes>(&self, lanes: N) -> Self {
        let lanes = lanes.store();
        self.with_lanes(|lane| self.lanes[lanes.0[lane].to_bits() as usize % LANES])
    }

    /// Returns a new leaf with the surface of `yes` where the mask is set, else that of `no`.
    #[inline(always)]
    fn select<N: Lanes>(mask: N::Mask, yes: Self, no: Self) -> Self {
        let bits = mask.bits();
        let of_lane = |lane: usize| if bits >> lane & 1 == 1 { yes.surface(lane) } else { no.surface(lane) };
        let (mut surfaces, mut lanes) = (Vec::new(), [u8::MAX; LANES]);
        for (lane, index) in lanes.iter_mut().enumerate() {
            if let Some(surface) = of_lane(lane) {
                *index = surfaces.len() as u8;
                surfaces.push(surface.clone());
            }
        }
        Self { surfaces: surfaces.into(), lanes }
    }
}

impl<S: Surface, N: Lanes> Crossable<N> for ScalarLeaf<S> {
    #[inline(always)]
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)> {
        self.first_crossing_with_hint(rays, [min, N::splat(f32::MAX)])
    }

    // Without inlining, each load and store would be a call; these calls took most of the time of rays that miss the
    // box.
    #[inline(always)]
    fn first_crossing_with_hint(&self, rays: &Rays<N>, [min, max]: [N; 2]) -> Option<(N::Mask, N)> {
        let [enters, leaves] = crossed(Crossable::<N>::boxes(self), rays);
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
        let bounds = |lane: usize| self.surface(lane).and_then(Surface::bounds);
        // Unused lanes have an inverted infinite box, which no ray hits.
        let min = from_fn(|lane| bounds(lane).map_or(Vec3::INFINITY, |bounds| bounds.min));
        let max = from_fn(|lane| bounds(lane).map_or(Vec3::NEG_INFINITY, |bounds| bounds.max));
        [Vector::of(min).load(), Vector::of(max).load()]
    }
}

impl<S: Surface, N: Lanes> AtCrossing<N> for ScalarLeaf<S> {
    #[inline(always)]
    fn points_at(&self, rays: &Rays<N>, t: N) -> Points<N> {
        let (t, rays) =
            (t.store(), EightRays { origin: rays.origin.store(), direction: rays.direction.store(), active: 0 });
        let points = from_fn::<_, LANES, _>(|lane| {
            let surface = self.surface(lane)?;
            Some(surface.at_crossing(&rays.ray(lane), t.0[lane]))
        });
        Points::of_lanes(&points)
    }
}
