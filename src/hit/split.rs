//! When rays leave their packet and go on as single rays.
//!
//! A packet is worth its work as long as many of its rays meet the same nodes. Where it meets several boxes of a node, the
//! rays that meet the node are counted; if they are few, they go on one by one from there. The constants were measured on spheres and meshes of 3 to
//! 871,000 primitives, at 1024x1024 and 200x120, against packets alone and single rays alone. Tried instead: one group of
//! eight as the measure (bunny 13 in the place of 19 Mrays/s, dragon 871k half as fast as single rays), and no measure
//! (dragon 871k at 200x120 at a fifth of the speed).

use crate::bvh::GROUPS;
use crate::lanes::set_bits;

/// At a node that no more rays than these meet, they go on as single rays. With 8 in the place of 6, and all groups
/// counted, 1,000 spheres took 1.14 times as long.
const MAX_SINGLE_RAYS: u32 = 6;

/// The same for the rays of each group on average, where that is more.
const MAX_SINGLE_RAYS_PER_GROUP: u32 = 2;

/// If more groups than these may meet a node, eye rays are not counted, and of shadow rays only one group is: it stands for
/// the others. To count all takes longer than the node. (Eye rays, whose groups are as narrow as their pixels, were never
/// found to be few there: without the count bunny is 1.10 times as fast.)
const MAX_COUNTED_GROUPS: u32 = 5;

/// If more rays of the group that stands for the others meet the node, the packet goes on. With 2 in the place of 1, shadow
/// rays of 100,000 spheres took 1.03 times as long.
const MAX_SAMPLED_RAYS: u32 = 1;

/// Rays are counted at nodes of which the packet meets at least this number of boxes. Of fewer, a packet gets rid with less
/// work than the count takes. Counted before the boxes are tested, shadow rays of 1,000 spheres took 1.05 times as long,
/// eye rays of 100,000 spheres 1.05 times. From 3 boxes on, shadow rays of 100,000 spheres take 1.08 times as long.
pub(super) const fn min_boxes_to_split(any: bool) -> u32 {
    if any { 2 } else { 4 }
}

/// A packet that has met no more leaves than these before its rays left it is of no use to the tile: its neighbours are
/// traced as single rays from the start (dragon 871k at 100x60: .91 ms in the place of 1.10).
const MAX_INEFFICIENT_LEAVES: u32 = 6;

/// The rays of a packet at a node. A trait, as closures are not compiled for the registers of their caller: with one,
/// 1,000 spheres took 1.6 times as long.
pub(super) trait NodeRays {
    /// Returns the mask of a group's rays that meet the node.
    fn hit_mask(&self, group: usize) -> u32;
}

/// Returns the rays of each group that go on as single rays from a node that these groups may meet, or nothing if the
/// packet goes on.
#[inline(always)]
pub(super) fn split_at_node<const ANY: bool>(groups: u32, node: &impl NodeRays) -> Option<[u32; GROUPS]> {
    let count = groups.count_ones();
    let max_rays = MAX_SINGLE_RAYS.max(count * MAX_SINGLE_RAYS_PER_GROUP);
    if count > MAX_COUNTED_GROUPS {
        if !ANY {
            return None;
        }
        // Of six groups and more one is among the last five.
        let middle = 3 + (groups >> 3).trailing_zeros() as usize;
        if node.hit_mask(middle).count_ones() > MAX_SAMPLED_RAYS {
            return None;
        }
    }
    let (mut rays, mut sum) = ([0; GROUPS], 0);
    for group in set_bits(groups) {
        rays[group] = node.hit_mask(group);
        sum += rays[group].count_ones();
    }
    (sum <= max_rays).then_some(rays)
}

/// Returns whether packets like one whose rays left it so often, after it had met that number of leaves, had better be
/// traced as single rays from the start.
#[inline(always)]
pub(super) fn is_inefficient(leaves: u32, left: u32, active: u32) -> bool {
    leaves <= MAX_INEFFICIENT_LEAVES && left > active
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOSEST: bool = false;
    const ANY: bool = true;

    /// The mask of each group; of the others nothing is known.
    struct Masks<'m>(&'m [(usize, u32)]);

    impl NodeRays for Masks<'_> {
        fn hit_mask(&self, group: usize) -> u32 {
            self.0.iter().find(|(known, _)| *known == group).expect("this group is not to be counted").1
        }
    }

    #[test]
    fn few_rays_leave_the_packet() {
        assert_eq!(split_at_node::<CLOSEST>(0, &Masks(&[])), Some([0; GROUPS]));
        let rays = split_at_node::<CLOSEST>(0b11, &Masks(&[(0, 0b111), (1, 0b1110_0000)]));
        assert_eq!(rays, Some([0b111, 0b1110_0000, 0, 0, 0, 0, 0, 0]));
        assert_eq!(split_at_node::<CLOSEST>(0b11, &Masks(&[(0, 0b1111), (1, 0b1111)])), None);
        assert!(split_at_node::<CLOSEST>(0b1111, &Masks(&[(0, 0b11), (1, 0b11), (2, 0b11), (3, 0b11)])).is_some());
    }

    #[test]
    fn many_groups_are_not_all_counted() {
        assert_eq!(split_at_node::<CLOSEST>(0b11_1111, &Masks(&[])), None);
        assert_eq!(split_at_node::<ANY>(0b11_1111, &Masks(&[(3, 0b11)])), None);
        let all: Vec<_> = (0..GROUPS).map(|group| (group, u32::from(group == 3))).collect();
        assert!(split_at_node::<ANY>(0xff, &Masks(&all)).is_some());
    }

    #[test]
    fn a_packet_is_inefficient_that_is_left_by_more_rays_than_it_has() {
        assert!(is_inefficient(6, 65, 64));
        assert!(!is_inefficient(7, 65, 64) && !is_inefficient(6, 64, 64));
    }
}
