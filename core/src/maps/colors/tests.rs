use super::*;
use crate::color::Oklab;

#[test]
fn depths_are_white_grey_and_black() {
    let greys = [0.0, 5.0, 10.0, 20.0, f32::MAX].map(|t| depth(t, 10.0).r);
    assert_eq!(greys, [255, 204, 128, 51, 0]);
    let color = depth(10.0, 10.0);
    assert!(color.r == color.g && color.g == color.b);
}

#[test]
fn normals_are_their_coordinates() {
    assert_eq!(normal(Vec3::X), Srgb8::new(255, 128, 128));
    assert_eq!(normal(-Vec3::Y), Srgb8::new(128, 0, 128));
    assert_eq!(normal(Vec3::Z), Srgb8::new(128, 128, 255));
}

#[test]
fn shares_go_from_dark_to_white() {
    assert_eq!([0, 1, 2].map(|count| share_grey(count, 2).r), [56, 156, 255]);
    assert_eq!(share_grey(0, 0).r, 56);
}

#[test]
fn heat_has_a_colour_for_each_power_of_four() {
    let at = |power: usize| HEAT[power].map(channel);
    for (count, power) in [(0, 0), (1, 0), (4, 1), (16, 2), (64, 3), (256, 4), (1024, 5), (u32::MAX, 5)] {
        let Srgb8 { r, g, b } = heat(count);
        assert_eq!([r, g, b], at(power), "{count}");
    }
    assert!(heat(8) != heat(4) && heat(8) != heat(16) && heat(9) != heat(8), "and others between");
}

/// Checks that consecutive objects have clearly different colours, and a thousand objects over 900
/// colours.
#[test]
fn objects_have_colours_of_their_own() {
    let colors: Vec<_> = (0..1000).map(object).collect();
    for near in colors.windows(3) {
        for (at, &a) in near.iter().enumerate() {
            for &b in &near[..at] {
                assert!(Oklab::from_srgb8(a).distance(Oklab::from_srgb8(b)) > 0.1, "{a:?} {b:?}");
            }
        }
    }
    let mut distinct = colors.clone();
    distinct.sort();
    distinct.dedup();
    assert!(distinct.len() > 900, "{} colours", distinct.len());
}

#[test]
fn lengths_are_short() {
    let lengths = [0.0012, 6.4126, 12.345, 123.45, 98_765.4].map(length_text);
    assert_eq!(lengths, ["1.2e-3", "6.41", "12.3", "123", "9.9e4"]);
}
