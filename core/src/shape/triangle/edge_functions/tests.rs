use super::super::Triangle;
use crate::lanes::{F32x8, LANES, LaneMask, Number};
use crate::ray::{EightRays, ProjectionCenter, Ray, Rays};
use crate::shape::triangle::{TriangleN, weight_error_bound};
use crate::shape::{Crossable, SoaLeaf};
use glam::Vec3;
use std::array::from_fn;

/// A reproducible sequence of pseudo-random numbers from -1 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

fn two_to(power: i32) -> f32 {
    f32::from_bits(((127 + power) as u32) << 23)
}

/// Returns eight triangles, and groups of rays aimed at or just beside a corner or an edge.
///
/// All rays start at a common point, or reach one at t = 1. The triangles are small, large or without area, and near,
/// far or behind the rays.
fn random_case(seed: u64) -> (Vec<Triangle>, [EightRays; LANES]) {
    let mut numbers = Numbers(seed);
    let scale = two_to((seed % 41) as i32 * 2 - 40);
    let size = two_to(-((seed / 41 % 12) as i32));
    let middle = numbers.point();
    let shared = if seed.is_multiple_of(3) { middle + numbers.point() * size * 4.0 } else { numbers.point() * 3.0 };
    let mut triangles = Vec::new();
    for at in 0..LANES {
        let first = middle + numbers.point() * size;
        let mut corners = [first, first + numbers.point() * size, first + numbers.point() * size];
        if at == 7 {
            corners[2] = corners[0].midpoint(corners[1]);
        }
        triangles.push(Triangle::unchecked(corners.map(|corner| corner * scale)));
    }
    let shared = shared * scale;
    let mut aim = |group: usize| {
        let corners = triangles[(group + seed as usize) % LANES].corners();
        from_fn::<Ray, LANES, _>(|lane| {
            // The rays of every other group all aim at the same edge, so that the group is narrow.
            let (at, is_beside) =
                if group.is_multiple_of(2) { (lane, lane % 2 == 1) } else { (group / 2, group % 4 == 1) };
            let share = [0.0, 0.25, 0.5, 1.0][(at + seed as usize / 2) % 4];
            let on_edge = corners[at % 3].lerp(corners[(at + 1) % 3], share);
            let hair = numbers.point() * scale * size * two_to(-3 * (seed % 9) as i32);
            let point = if is_beside { on_edge + hair } else { on_edge };
            if is_backward(seed) {
                let origin = point + (point - shared) * [0.1, 1000.0][seed as usize / 2 % 2];
                Ray { origin, direction: shared - origin }
            } else {
                let is_behind = seed.is_multiple_of(7) && lane.is_multiple_of(2);
                Ray { origin: shared, direction: if is_behind { shared - point } else { point - shared } }
            }
        })
    };
    let rays = from_fn(|group| EightRays::of(&aim(group)));
    (triangles, rays)
}

/// Returns whether the rays of a random case reach the projection center at t = 1, as shadow
/// rays reach a light.
fn is_backward(seed: u64) -> bool {
    seed % 2 == 1
}

/// Tests rays with a packet's error bound. Returns the bits of t, or of -1 for rays that miss.
fn t_bits(shape: &TriangleN<F32x8>, rays: &Rays<F32x8>, packet_error_bound: f32) -> Option<[u32; LANES]> {
    let crossing =
        shape.first_crossing_in_packet(rays, [F32x8::ZERO, F32x8::splat(f32::MAX)], F32x8::splat(packet_error_bound));
    crossing.map(|(crosses, t)| F32x8::select(crosses, t, F32x8::splat(-1.0)).0.map(f32::to_bits))
}

/// Tests packets that mix directions of different lengths, from 2^-126 to 2^127 and infinite.
#[test]
fn unusual_lengths_are_not_decided_by_the_packet_bound() {
    let forward = Ray { origin: Vec3::ZERO, direction: Vec3::new(0.1, 0.1, 1.0) };
    let endless = Ray { direction: Vec3::new(0.1, 0.1, f32::INFINITY), ..forward };
    let across = [Vec3::new(-1.0, -1.0, 5.0), Vec3::new(3.0, -1.0, 5.0), Vec3::new(-1.0, 3.0, 5.0)];
    let along = [Vec3::new(1.0, -1.0, 1000.0), Vec3::new(-1.0, -1.0, -800.0), Vec3::new(0.0, 1.0, 0.0)];
    let close = [Vec3::new(1e-9, -1e-9, 2e-7), Vec3::new(-1e-9, -1e-9, 2e-7), Vec3::new(0.0, 1e-9, 2e-7)];
    let cases = [-126, -120, -60, -30, 0, 30, 60, 120, 127].map(|power| {
        (
            Ray { direction: Vec3::Z * two_to(power), ..forward },
            Ray { direction: forward.direction * two_to(power), ..forward },
        )
    });
    for (one, other) in cases.into_iter().chain([(forward, endless)]) {
        let mut rays = [[one; LANES]; LANES];
        rays[3][5] = other;
        let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&EightRays::of(&rays[group]), true));
        let projection_center = ProjectionCenter::find(&groups).expect("all rays start in one point");
        let shapes = TriangleN::<F32x8>::of(&[across, along, close].map(Triangle::unchecked));
        let edges = shapes.edge_functions(&projection_center);
        for lane in 0..3 {
            let (shape, packet_error_bound) = (shapes.splat::<F32x8>(lane), edges.packet_error_bound.0[lane]);
            for rays in &groups {
                assert_eq!(
                    t_bits(&shape, rays, packet_error_bound),
                    t_bits(&shape, rays, f32::INFINITY),
                    "{one:?} {lane}"
                );
            }
        }
    }
}

/// The packet's bound is also tight: for most groups less than 100 times the rays' own bound.
#[test]
fn the_packet_bound_is_at_least_the_bound_of_each_ray() {
    let (mut near, mut all) = (0, 0);
    for seed in 0..6_000 {
        let (triangles, rays) = random_case(seed);
        let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&rays[group], true));
        let Some(projection_center) = ProjectionCenter::find(&groups) else { continue };
        let shapes = TriangleN::<F32x8>::of(&triangles);
        let edges = shapes.edge_functions(&projection_center);
        for lane in 0..LANES {
            let (shape, packet_error_bound) = (shapes.splat::<F32x8>(lane), edges.packet_error_bound.0[lane]);
            for (group, rays) in groups.iter().enumerate() {
                let own = weight_error_bound(shape.sheared_corners(rays), rays.shear.length).reduce_max();
                assert!(
                    own <= packet_error_bound,
                    "seed {seed}: triangle {lane}, group {group}: {own} and {packet_error_bound}"
                );
                assert_eq!(
                    t_bits(&shape, rays, packet_error_bound),
                    t_bits(&shape, rays, f32::INFINITY),
                    "seed {seed}"
                );
                all += usize::from(packet_error_bound.is_finite());
                near += usize::from(own * 100.0 > packet_error_bound);
            }
        }
    }
    assert!(all > 100_000 && near > all / 2, "{near} of {all}");
}

/// More than a quarter of the groups that miss a triangle are culled, and no group that hits it.
#[test]
fn culled_groups_do_not_cross_the_triangle() {
    let (mut passing, mut missing, mut packets) = (0, 0, [0; 2]);
    for seed in 0..6_000 {
        let (triangles, rays) = random_case(seed);
        let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&rays[group], true));
        let shapes = TriangleN::<F32x8>::of(&triangles);
        let Some(projection_center) = ProjectionCenter::find(&groups) else { continue };
        let edges = shapes.edge_functions(&projection_center);
        packets[usize::from(is_backward(seed))] += 1;
        for lane in 0..LANES {
            let culled_groups = edges.culled_groups(lane, &projection_center);
            for (group, rays) in groups.iter().enumerate() {
                let crossing = shapes.splat::<F32x8>(lane).first_crossing(rays, F32x8::splat(f32::MIN));
                let crosses = crossing.map_or(0, |(crosses, _)| crosses.bits());
                let is_passed_by = culled_groups >> group & 1 == 1;
                assert!(!is_passed_by || crosses == 0, "seed {seed}: triangle {lane}, group {group}: {crosses:b}");
                missing += u32::from(crosses == 0);
                passing += u32::from(is_passed_by);
            }
        }
    }
    assert!(packets.into_iter().all(|count| count > 1_000), "{packets:?} packets");
    assert!(passing > missing / 4, "{passing} of {missing} are culled");
}
