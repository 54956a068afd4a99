use super::*;

const CLOSEST: bool = false;
const ANY: bool = true;

/// A node, given by pairs of a group's index and the mask of the group's rays that hit the node.
///
/// Panics if the rays of a group that is not given are counted.
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
fn a_packet_left_by_more_rays_than_it_has_is_inefficient() {
    assert!(is_inefficient(6, 65, 64));
    assert!(!is_inefficient(7, 65, 64) && !is_inefficient(6, 64, 64));
}
