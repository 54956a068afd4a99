use super::*;
use crate::color::Srgb8;

/// Returns colours from all parts of the cube.
fn colors() -> impl Iterator<Item = Srgb8> {
    (0..1 << 15).map(|at: u32| {
        let channel = |shift: u32| (at >> shift & 31) as u8 * 8 + (at % 7) as u8;
        Srgb8::new(channel(0), channel(5), channel(10))
    })
}

fn list(colors: impl Iterator<Item = Srgb8>) -> ColorList {
    let mut list = ColorList::default();
    list.fill(&colors.map(PackedInk::rgb).collect::<Vec<_>>());
    list
}

#[test]
fn converted_colors_are_near_those_of_oklab() {
    let list = list(colors());
    for (at, color) in colors().enumerate() {
        let Vec3 { x: l, y: a, z: b } = list.eights[at / LANES].oklab.of_lane(at % LANES);
        let distance = Oklab { l, a, b }.distance(Oklab::from_srgb8(color));
        assert!(distance <= 2e-6, "{color:?}: {distance}");
    }
}

#[test]
fn a_color_is_compared_with_the_next_ones() {
    for len in [1, 7, 8, 9, 24, 25, 40] {
        let grey = |at: u8| Srgb8::new(100 + at / 2, 100, 100);
        let mut masks = Vec::new();
        list((0..len).map(grey)).compare_with_following(Tolerance { distance: 1.0, square: 9 }, &mut masks);
        for (at, mask) in masks.into_iter().enumerate() {
            let is_near = |next: &usize| grey(*next as u8).r.abs_diff(grey(at as u8).r) <= 3;
            let near = (at + 1..usize::from(len)).take_while(is_near).take(24);
            assert_eq!(mask, near.fold(0, |mask, next| mask | 1 << (next - at - 1)), "color {at} of {len}");
        }
    }
}
