//! Hits -> the surfaces there, eight at a time.

use crate::hit::EightHits;
use crate::lanes::{ALL, Eight, LANES, Lanes, Vector, set_bits};
use crate::ray::{EightRays, Rays};
use crate::scene::{Grove, PartId, Parts, Scene};
use crate::shape::{AtCrossing, Part, Points, SideBySide};
use crate::simd::{self, Work};
use glam::Vec2;

/// The surfaces that eight rays have met.
#[derive(Clone, Copy, Debug)]
pub struct EightPoints {
    /// Which of the rays have met one, a bit for each. What stands for the others has no meaning.
    pub met: u32,
    /// Whose it is.
    pub(super) ids: [PartId; LANES],
    /// As [`SurfacePoint`](crate::shape::SurfacePoint) has them.
    pub(super) position: Vector<Eight>,
    pub(super) normal: Vector<Eight>,
    pub(super) facing: Vector<Eight>,
    pub(super) clearance: Eight,
    pub(super) uv: [Eight; 2],
}

impl EightPoints {
    /// Of rays that have met nothing.
    const NONE: Self = Self {
        met: 0,
        ids: [PartId { object: 0, part: 0 }; LANES],
        position: Vector::ZERO,
        normal: Vector::ZERO,
        facing: Vector::ZERO,
        clearance: Eight::ZERO,
        uv: [Eight::ZERO; 2],
    };

    /// These have met that.
    #[inline(always)]
    fn set_ids(&mut self, lanes: u32, id: PartId) {
        if lanes == ALL {
            self.ids = [id; LANES];
        } else {
            set_bits(lanes).for_each(|lane| self.ids[lane] = id);
        }
    }

    #[inline(always)]
    pub(super) fn uv(&self, lane: usize) -> Vec2 {
        Vec2::new(self.uv[0].0[lane], self.uv[1].0[lane])
    }

    /// The object, by its place in [`Scene::objects`], and the normal that one of the rays has met.
    #[inline]
    pub fn seen(&self, lane: usize) -> Option<(u32, glam::Vec3)> {
        (self.met >> lane & 1 == 1).then(|| (self.ids[lane].object, self.normal.of_lane(lane)))
    }
}

/// The surface at each hit.
pub fn surface_points(scene: &Scene, rays: &[EightRays], hits: &[EightHits], points: &mut Vec<EightPoints>) {
    points.resize(hits.len(), EightPoints::NONE);
    simd::run(SurfacePoints { scene, rays, hits, points });
}

struct SurfacePoints<'w> {
    scene: &'w Scene,
    rays: &'w [EightRays],
    hits: &'w [EightHits],
    points: &'w mut [EightPoints],
}

impl Work for SurfacePoints<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { scene, rays, hits, points } = self;
        for ((rays, hits), at) in rays.iter().zip(hits).zip(points) {
            at.met = hits.met;
            if at.met != 0 {
                of_hits::<N>(scene.parts(), rays, hits, at);
                if scene.parts().has_smooth {
                    smooth(scene, at);
                }
            }
        }
    }
}

#[inline(always)]
fn of_hits<N: Lanes>(parts: &Parts, rays: &EightRays, hits: &EightHits, at: &mut EightPoints) {
    let t = N::load(&hits.t);
    let mut points = Points::<N>::nowhere();
    let mut left = at.met;
    while left != 0 {
        let place = hits.place(left.trailing_zeros() as usize % LANES);
        // A plane is by itself; those that stand in trees are looked at together.
        let (lanes, found) = if place < parts.balls.first {
            let lanes = hits.at::<N>(place);
            let (id, plane) = &parts.planes[place as usize];
            at.set_ids(lanes, *id);
            (lanes, plane.points_at(&Rays::<N>::load(rays, false), t))
        } else if place < parts.triangles.first {
            let lanes = hits.between(parts.balls.first, parts.triangles.first);
            (lanes, in_grove(&parts.balls, rays, hits, lanes, at))
        } else {
            let lanes = hits.between(parts.triangles.first, EightHits::NOTHING);
            (lanes, in_grove(&parts.triangles, rays, hits, lanes, at))
        };
        points = if lanes == ALL { found } else { Points::select(N::answers(lanes), found, points) };
        left &= !lanes;
    }
    at.position = points.position.store();
    at.facing = points.facing.store();
    at.normal = at.facing;
    at.clearance = points.clearance.store();
    at.uv = [points.uv[0].store(), points.uv[1].store()];
}

/// What these of the rays have met in a tree.
#[inline(always)]
fn in_grove<N: Lanes, S: SideBySide>(
    grove: &Grove<S>,
    rays: &EightRays,
    hits: &EightHits,
    lanes: u32,
    at: &mut EightPoints,
) -> Points<N> {
    let (rays, t) = (Rays::load(rays, true), N::load(&hits.t));
    let first = hits.place(lanes.trailing_zeros() as usize % LANES);
    let (leaf, place) = grove.leaf(first);
    if hits.at::<N>(first) == lanes {
        at.set_ids(lanes, grove.id(first));
        return leaf.splat::<N>(place).points_at(&rays, t);
    }
    // Who has met something else has it cross what stands there, and that is not looked at.
    let mut shapes = *leaf;
    for lane in set_bits(lanes) {
        let (leaf, place) = grove.leaf(hits.place(lane));
        shapes.put(lane, leaf, place);
        at.ids[lane] = grove.id(hits.place(lane));
    }
    shapes.load::<N>().points_at(&rays, t)
}

/// Goes over to the smooth surfaces that triangles stand for.
fn smooth(scene: &Scene, at: &mut EightPoints) {
    for lane in set_bits(at.met) {
        let PartId { object, part } = at.ids[lane];
        if let Part::Facet(facet) = scene.objects()[object as usize].shape.part(part)
            && let Some((position, normal)) =
                facet.smooth(at.position.of_lane(lane), at.facing.of_lane(lane), at.uv(lane))
        {
            at.position.put(lane, position);
            at.normal.put(lane, normal);
        }
    }
}
