//! The criteria by which rays leave their packet and go on as single rays.
//!
//! A packet is efficient as long as many of its rays hit the same nodes. When a packet hits several boxes of a node,
//! the rays that hit the node are counted; if they are few, they go on as single rays from there.
//!
//! The constants were measured on spheres and meshes of 3 to 871,000 primitives, at 1024x1024 and 200x120, against
//! packets alone and single rays alone. Rejected: to split where only one group of eight hits the node (bunny 13
//! instead of 19 Mrays/s, dragon 871k half as fast as single rays), and never to split (dragon 871k at 200x120 five
//! times slower).

use crate::bvh::GROUPS;
use crate::lanes::set_bits;

/// The largest number of rays at a node that leave the packet to go on as single rays.
// With 8 instead of 6 rays, and the rays of all groups counted, 1,000 spheres took 1.14 times as long.
const MAX_SINGLE_RAYS: u32 = 6;

/// The largest number of rays that leave the packet at a node, per group that may hit the node.
///
/// The larger of this limit and [`MAX_SINGLE_RAYS`] applies.
const MAX_SINGLE_RAYS_PER_GROUP: u32 = 2;

/// The largest number of groups at a node for which all their rays are counted, without a sample.
///
/// The count decides whether the rays leave the packet.
// Counting the rays of more groups takes longer than the test of the node. If more groups may hit the node, shadow rays
// are first counted in one group, as a sample. Eye rays are not counted at all: with more than five groups they were
// never few enough to leave the packet, as the rays of a group are as close together as pixels. Not counting eye rays
// makes the bunny 1.10 times as fast (51.7 to 56.8 Mrays/s).
const MAX_COUNTED_GROUPS: u32 = 5;

/// The largest number of rays of the sampled group that may hit a node for all rays to be counted.
// With 2 instead of 1 ray of the sampled group, shadow rays of 100,000 spheres took 1.03 times as long.
const MAX_SAMPLED_RAYS: u32 = 1;

/// Returns the least number of a node's boxes that a packet must hit for its rays to be counted.
///
/// The count decides whether the rays leave the packet. `any` is whether any hit is wanted, as for shadow rays.
// If the packet hits fewer boxes, tracing it takes less time than counting its rays. When rays were counted before the
// boxes were tested, shadow rays of 1,000 spheres and eye rays of 100,000 spheres took 1.05 times as long. With 3
// instead of 2 boxes, shadow rays of 100,000 spheres take 1.08 times as long.
pub(super) const fn min_boxes_to_split(any: bool) -> u32 {
    if any { 2 } else { 4 }
}

/// The largest number of leaves that an inefficient packet visits.
///
/// A packet that visits more leaves counts as efficient, however many of its rays have left it.
// An inefficient packet does the work of a packet and then that of single rays. If the rest of its tile is traced by
// single rays, dragon 871k at 100x60 takes 0.91 instead of 1.10 ms.
const MAX_INEFFICIENT_LEAVES: u32 = 6;

/// The rays of a packet at a node.
// A trait instead of a closure: closures do not inherit the target features of the function that they are written in.
// With a closure 1,000 spheres took 1.6 times as long.
pub(super) trait NodeRays {
    /// Returns the mask of a group's rays that hit the node.
    fn hit_mask(&self, group: usize) -> u32;
}

/// Returns the masks of rays that leave the packet at a node, or `None` if the packet goes on.
///
/// `groups` is the mask of groups that may hit the node.
#[inline(always)]
pub(super) fn split_at_node<const ANY: bool>(groups: u32, node: &impl NodeRays) -> Option<[u32; GROUPS]> {
    let count = groups.count_ones();
    let max_rays = MAX_SINGLE_RAYS.max(count * MAX_SINGLE_RAYS_PER_GROUP);
    if count > MAX_COUNTED_GROUPS {
        if !ANY {
            return None;
        }
        // Of six or more groups at least one is among the last five (3 to 7). The first of these is the sample, as it
        // lies near the middle of the packet.
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

/// Returns whether a packet visited few leaves, and `rays_left` exceeds `active`.
///
/// `active` is the number of the packet's rays. `rays_left` counts a ray each time that it leaves the packet: in
/// several trees, and at several nodes of a tree.
#[inline(always)]
pub(super) fn is_inefficient(leaves: u32, rays_left: u32, active: u32) -> bool {
    leaves <= MAX_INEFFICIENT_LEAVES && rays_left > active
}

#[cfg(all(test, unit_tests))]
mod tests;
