//! The criteria by which rays leave their packet and go on as single rays.
//!
//! A packet is worth its work as long as many of its rays meet the same nodes. Where it meets several boxes of a node,
//! the rays that meet the node are counted; if they are few, they go on singly from there.
//!
//! The constants were measured on spheres and meshes of 3 to 871,000 primitives, at 1024x1024 and 200x120, against
//! packets alone and single rays alone. Rejected: to leave where only one group of eight meets the node (bunny 13
//! instead of 19 Mrays/s, dragon 871k half as fast as single rays), and never to leave (dragon 871k at 200x120 five
//! times slower).

use crate::bvh::GROUPS;
use crate::lanes::set_bits;

/// The number of rays that meet a node up to which they go on as single rays.
// With 8 instead of 6, and all groups counted, 1,000 spheres took 1.14 times as long.
const MAX_SINGLE_RAYS: u32 = 6;

/// The number of rays per group up to which they go on as single rays, where that is more.
const MAX_SINGLE_RAYS_PER_GROUP: u32 = 2;

/// The number of groups that may meet a node up to which the rays of all groups are counted.
// Counting more takes longer than the node. Beyond, one group of shadow rays stands for the others, and eye rays are
// not counted at all: they have never been found to be few there, as their groups are as narrow as their pixels.
// Without the count the bunny is 1.10 times as fast (51.7 to 56.8 Mrays/s).
const MAX_COUNTED_GROUPS: u32 = 5;

/// The number of rays in the sampled group up to which all groups are counted after all.
// With 2 instead of 1, shadow rays of 100,000 spheres took 1.03 times as long.
const MAX_SAMPLED_RAYS: u32 = 1;

/// Returns the number of boxes that a packet must meet for its rays to be counted.
// Fewer boxes take the packet less work than the count. Counted before the boxes are tested, shadow rays of 1,000
// spheres and eye rays of 100,000 spheres took 1.05 times as long. From 3 boxes on, shadow rays of 100,000 spheres take
// 1.08 times as long.
pub(super) const fn min_boxes_to_split(any: bool) -> u32 {
    if any { 2 } else { 4 }
}

/// The number of visited leaves up to which a packet left by its rays counts as inefficient.
// Such a packet did the work of both ways. With the rest of the tile traced singly after it, dragon 871k at 100x60
// takes 0.91 instead of 1.10 ms.
const MAX_INEFFICIENT_LEAVES: u32 = 6;

/// The rays of a packet at a node.
// A trait instead of a closure: closures do not inherit the target features of the function that they are written in.
// With a closure 1,000 spheres took 1.6 times as long.
pub(super) trait NodeRays {
    /// Returns the mask of a group's rays that meet the node.
    fn hit_mask(&self, group: usize) -> u32;
}

/// Returns the masks of rays that leave the packet at a node, or `None` if the packet goes on.
///
/// `groups` is the mask of groups that may meet the node.
#[inline(always)]
pub(super) fn split_at_node<const ANY: bool>(groups: u32, node: &impl NodeRays) -> Option<[u32; GROUPS]> {
    let count = groups.count_ones();
    let max_rays = MAX_SINGLE_RAYS.max(count * MAX_SINGLE_RAYS_PER_GROUP);
    if count > MAX_COUNTED_GROUPS {
        if !ANY {
            return None;
        }
        // Six or more of eight groups include one of the last five; the first of these stands for the others, as it
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

/// Returns whether a packet was left by more rays than it has, with hardly a leaf visited.
///
/// `rays_left` counts a ray each time that it leaves: in several trees, and at several nodes of one.
#[inline(always)]
pub(super) fn is_inefficient(leaves: u32, rays_left: u32, active: u32) -> bool {
    leaves <= MAX_INEFFICIENT_LEAVES && rays_left > active
}

#[cfg(all(test, unit_tests))]
mod tests;
