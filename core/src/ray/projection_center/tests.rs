use super::*;
use crate::lanes::F32x8;
use crate::ray::{EightRays, Ray};
use glam::Vec3;
use std::array::from_fn;

/// Returns the projection center of a packet whose rays start at zero, except for `others`: group,
/// lane and ray.
fn projection_center_with(others: &[(usize, usize, Ray)]) -> Option<ProjectionCenter<F32x8>> {
    let mut rays = [[Ray { origin: Vec3::ZERO, direction: Vec3::new(0.1, 0.1, 1.0) }; LANES]; LANES];
    for &(group, lane, ray) in others {
        rays[group][lane] = ray;
    }
    let groups: [Rays<F32x8>; LANES] = from_fn(|group| Rays::load(&EightRays::of(&rays[group]), true));
    ProjectionCenter::find(&groups)
}

#[test]
fn a_ray_beside_the_origin_is_noticed() {
    let beside = Ray { origin: Vec3::X * 5.0, direction: Vec3::new(0.1, 0.1, 1.0) };
    let endless = Ray { origin: Vec3::ZERO, direction: Vec3::new(0.1, 0.1, f32::INFINITY) };
    let across = Ray { origin: Vec3::ZERO, direction: Vec3::new(1.0, 0.0, 0.0) };
    assert!(projection_center_with(&[]).is_some());
    for others in [vec![(1, 3, beside)], vec![(1, 3, beside), (2, 3, endless)], vec![(7, 0, across)]] {
        assert!(projection_center_with(&others).is_none(), "{others:?}");
    }
}
