use super::super::Node;
use super::*;
use crate::bounds::crossed;
use crate::lanes::{F32x8, Number};
use crate::ray::{EightRays, Ray};
use glam::Vec3;
use std::array::from_fn;

/// A reproducible sequence of pseudo-random numbers from -1 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

fn two_to(power: i32) -> f32 {
    f32::from_bits(((127 + power) as u32) << 23)
}

/// Returns the length of directions, and the distance of origins from zero, for a random case.
fn length_and_distance(seed: u64) -> (f32, f32) {
    let length = two_to([-120, -60, -8, 0, 0, 8, 60, 117, 123][seed as usize % 9]);
    (length, two_to([0, 0, -30, 30, -100, 100][seed as usize / 9 % 6]))
}

/// Returns the rays of a packet, narrow or wide, and two groups of eight boxes.
///
/// The boxes are ahead of rays, behind them, or at an origin, and some are flat.
fn random_case(seed: u64) -> ([EightRays; GROUPS], [[Vector<F32x8>; 2]; 2]) {
    let (mut numbers, (length, scale)) = (Numbers(seed), length_and_distance(seed));
    let width = two_to(-((seed / 54 % 14) as i32));
    let (origin, direction) = (numbers.vector(), numbers.vector());
    let mut ray = || {
        let mut direction = direction + numbers.vector() * width;
        if seed.is_multiple_of(5) {
            direction[seed as usize % 3] = 0.0;
        }
        Ray { origin: (origin + numbers.vector() * width) * scale, direction: direction * length }
    };
    let rays: [[Ray; LANES]; GROUPS] = from_fn(|_| from_fn(|_| ray()));
    let mut some_box = |lane: usize| {
        let through = &rays[lane][lane];
        let t = [0.0, 1.0, -1.0, 3.0][lane % 4] * scale / length;
        let at = through.origin + if t.is_finite() { through.direction * t } else { Vec3::ZERO };
        let [from, to] = [0, 1].map(|_| at + numbers.vector() * scale * width * [0.0, 1e-3, 1.0][lane % 3]);
        [from.min(to), from.max(to)]
    };
    let boxes = from_fn(|_| {
        let boxes: [[Vec3; 2]; LANES] = from_fn(&mut some_box);
        [Vector::of(boxes.map(|[min, _]| min)), Vector::of(boxes.map(|[_, max]| max))]
    });
    (rays.map(|rays| EightRays::of(&rays)), boxes)
}

/// No box that a ray hits is culled for its packet or group; over a third of the other boxes are
/// culled.
#[test]
fn a_packet_hits_all_boxes_that_its_rays_hit() {
    let (mut met, mut missed, mut kept) = (0, 0, 0);
    for seed in 0..20_000 {
        let (rays, boxes) = random_case(seed);
        let groups: [Rays<F32x8>; GROUPS] = from_fn(|group| Rays::load(&rays[group], false));
        let packet = Packet::of(&groups);
        // Packets of mixed signs whose distances, divided by the direction, may round to zero are skipped:
        // the proof in `culling.md`, 5, does not cover them.
        let (length, scale) = length_and_distance(seed);
        if scale / length < two_to(-60) && packet.signs.contains(&DirectionSign::Mixed) {
            continue;
        }
        let within = [F32x8::ZERO, <F32x8 as Number>::splat(f32::MAX)];
        let [starts, ends] = packet.crossed(Node::EMPTY.boxes(), within);
        assert_eq!(starts.le(ends).bits(), 0, "seed {seed}: an unused lane is met");
        for boxes in boxes {
            let [starts, ends] = packet.crossed(boxes, within);
            let by_all = starts.le(ends).bits();
            for lane in 0..LANES {
                let one = boxes.map(|corner| Vector::splat(corner.of_lane(lane)));
                let [by_starts, by_ends] = packet.crossed_by_groups(one, within);
                let by_groups = by_starts.le(by_ends).bits();
                for (group, rays) in groups.iter().enumerate() {
                    let [enters, leaves] = crossed(one, rays);
                    let by_rays = enters.max(F32x8::ZERO).le(leaves.min(<F32x8 as Number>::splat(f32::MAX))).bits();
                    let may_meet = by_all >> lane & by_groups >> group & 1 == 1;
                    assert!(by_rays == 0 || may_meet, "seed {seed}: box {lane}, group {group}");
                    let first = set_bits(by_rays).map(|ray| enters.0[ray].max(0.0)).fold(f32::MAX, f32::min);
                    let start = starts.0[lane].max(by_starts.0[group]);
                    assert!(by_rays == 0 || start <= first, "seed {seed}: box {lane}, group {group}: {start}");
                    met += u32::from(by_rays != 0);
                    missed += u32::from(by_rays == 0);
                    kept += u32::from(!may_meet);
                }
            }
        }
    }
    assert!(met > 100_000 && kept > missed / 3, "{met} are met, {kept} of {missed} kept away");
}
