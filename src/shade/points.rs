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
    points.clear();
    simd::run(SurfacePoints { scene, rays, hits, points });
}

struct SurfacePoints<'w> {
    scene: &'w Scene,
    rays: &'w [EightRays],
    hits: &'w [EightHits],
    points: &'w mut Vec<EightPoints>,
}

impl Work for SurfacePoints<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { scene, rays, hits, points } = self;
        for (rays, hits) in rays.iter().zip(hits) {
            let mut at = EightPoints::NONE;
            at.met = hits.met();
            if at.met != 0 {
                of_hits::<N>(scene.parts(), rays, hits, &mut at);
                if scene.parts().has_smooth {
                    smooth(scene, &mut at);
                }
            }
            points.push(at);
        }
    }
}

#[inline(always)]
fn of_hits<N: Lanes>(parts: &Parts, rays: &EightRays, hits: &EightHits, at: &mut EightPoints) {
    let t = N::load(&hits.t);
    let mut points = Points::<N>::nowhere();
    let mut left = at.met;
    while left != 0 {
        let place = hits.places[left.trailing_zeros() as usize % LANES];
        // A plane is by itself; those that stand in trees are looked at together.
        let (lanes, found) = if place < parts.balls.first {
            let lanes = lanes_between(hits, [place, place + 1]);
            (lanes, parts.planes[place as usize].1.points_at(&Rays::<N>::load(rays), t))
        } else if place < parts.triangles.first {
            let lanes = lanes_between(hits, [parts.balls.first, parts.triangles.first]);
            (lanes, at_crossings(&parts.balls, hits, lanes, rays, t))
        } else {
            let lanes = lanes_between(hits, [parts.triangles.first, EightHits::NOTHING]);
            (lanes, at_crossings(&parts.triangles, hits, lanes, rays, t))
        };
        points = if lanes == ALL { found } else { Points::select(N::answers(lanes), found, points) };
        left &= !lanes;
    }
    at.position = points.position.store();
    at.facing = points.facing.store();
    at.normal = at.facing;
    at.clearance = points.clearance.store();
    at.uv = [points.uv[0].store(), points.uv[1].store()];
    for lane in set_bits(at.met) {
        at.ids[lane] = parts.id(hits.places[lane]);
    }
}

/// Who has met what has a place from the first of them up to the second.
#[inline(always)]
fn lanes_between(hits: &EightHits, [start, end]: [u32; 2]) -> u32 {
    let is_between = |place: u32| start <= place && place < end;
    (0..LANES).fold(0, |lanes, lane| lanes | u32::from(is_between(hits.places[lane])) << lane)
}

/// What some of the rays have met in a tree.
#[inline(always)]
fn at_crossings<N: Lanes, S: SideBySide>(
    grove: &Grove<S>,
    hits: &EightHits,
    lanes: u32,
    rays: &EightRays,
    t: N,
) -> Points<N> {
    let rays = Rays::load(rays);
    let first = hits.places[lanes.trailing_zeros() as usize % LANES];
    let (leaf, place) = grove.leaf(first);
    if lanes_between(hits, [first, first + 1]) == lanes {
        return leaf.shapes.splat::<N>(place).points_at(&rays, t);
    }
    // Who has met something else has it cross what stands there, and that is not looked at.
    let mut shapes = leaf.shapes;
    for lane in set_bits(lanes) {
        let (leaf, place) = grove.leaf(hits.places[lane]);
        shapes.put(lane, &leaf.shapes, place);
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
