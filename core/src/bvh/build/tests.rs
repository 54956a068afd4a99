use super::*;
use crate::bounds::Bounds;
use crate::bvh::Child;
use glam::Vec3;

#[test]
fn boxes_too_large_for_f32_areas_are_all_reached() {
    let boxes: Vec<_> =
        (0..200).map(|at| Bounds { min: Vec3::splat(-3e38), max: Vec3::new(3e38, at as f32 * 1e36, 3e38) }).collect();
    let (bvh, leaves) = Bvh::new(&boxes);
    let mut reached: Vec<_> = (0..leaves.leaf_count()).flat_map(|leaf| leaves.boxes(leaf).to_vec()).collect();
    reached.sort_unstable();
    assert_eq!(reached, (0..200).collect::<Vec<_>>());
    let children = bvh.nodes.iter().flat_map(|node| node.children);
    assert_eq!(children.filter_map(Child::as_leaf).count(), leaves.leaf_count());
}
