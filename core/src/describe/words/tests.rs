use super::*;

#[test]
fn colours_have_everyday_names() {
    for (hex, name) in [
        (Srgb8::new(0xe0, 0x45, 0x2f), "red"),
        (Srgb8::new(0xf0, 0xb1, 0x3a), "gold"),
        (Srgb8::new(0x2a, 0x9d, 0x94), "teal"),
        (Srgb8::new(0x80, 0x80, 0x84), "grey"),
        (Srgb8::new(0x10, 0x30, 0x90), "dark blue"),
        (Srgb8::new(0xff, 0xff, 0xf8), "white"),
    ] {
        assert_eq!(color(LinearRgb::from_srgb8(hex)), name);
    }
    for (name, srgb) in COLORS {
        assert_eq!(color(LinearRgb::from_srgb8(srgb)), name);
    }
}

#[test]
fn numbers_have_three_digits() {
    let numbers = [0.0, -0.001, 1.0, 2.104, 0.55, 36.04, 123.4, -0.0].map(number);
    assert_eq!(numbers, ["0", "-0.001", "1", "2.1", "0.55", "36", "123", "0"]);
    assert_eq!(point_text(Vec3::new(0.0, 2.1, 6.3)), "(0, 2.1, 6.3)");
}

#[test]
fn positions_have_everyday_words() {
    let at = |x, y, width, height| position(PictureRect { middle: [x, y], extent: [width, height] });
    assert_eq!(at(0.1, 0.1, 0.2, 0.2), "upper left");
    assert_eq!(at(0.5, 0.5, 0.2, 0.2), "in the middle");
    assert_eq!(at(0.9, 0.5, 0.2, 0.2), "on the right");
    assert_eq!(at(0.5, 0.8, 1.0, 0.4), "across the bottom");
    assert_eq!(at(0.2, 0.5, 0.3, 1.0), "all along the left");
    assert_eq!(at(0.5, 0.5, 1.0, 1.0), "all over the picture");
}
