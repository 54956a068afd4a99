//! Words for numbers, colours and positions.

use super::survey::PictureRect;
use crate::color::{LinearRgb, Oklab, Srgb8};
use glam::Vec3;

/// Colours that have a common English name.
const COLORS: [(&str, Srgb8); 32] = [
    ("black", Srgb8::new(0, 0, 0)),
    ("dark grey", Srgb8::new(72, 72, 72)),
    ("grey", Srgb8::new(128, 128, 128)),
    ("light grey", Srgb8::new(211, 211, 211)),
    ("white", Srgb8::new(255, 255, 255)),
    ("red", Srgb8::new(220, 40, 40)),
    ("dark red", Srgb8::new(120, 20, 20)),
    ("light red", Srgb8::new(245, 130, 120)),
    ("pink", Srgb8::new(255, 180, 200)),
    ("dark pink", Srgb8::new(220, 60, 130)),
    ("orange", Srgb8::new(250, 140, 30)),
    ("light orange", Srgb8::new(255, 190, 120)),
    ("brown", Srgb8::new(130, 75, 35)),
    ("light brown", Srgb8::new(190, 145, 95)),
    ("dark brown", Srgb8::new(70, 42, 25)),
    ("yellow", Srgb8::new(245, 220, 50)),
    ("gold", Srgb8::new(235, 180, 50)),
    ("light yellow", Srgb8::new(255, 245, 170)),
    ("warm white", Srgb8::new(250, 235, 210)),
    ("beige", Srgb8::new(225, 210, 180)),
    ("olive", Srgb8::new(125, 125, 30)),
    ("green", Srgb8::new(50, 165, 60)),
    ("dark green", Srgb8::new(20, 85, 30)),
    ("light green", Srgb8::new(150, 225, 140)),
    ("teal", Srgb8::new(30, 140, 135)),
    ("turquoise", Srgb8::new(80, 215, 210)),
    ("blue", Srgb8::new(40, 90, 220)),
    ("dark blue", Srgb8::new(20, 35, 110)),
    ("light blue", Srgb8::new(140, 190, 245)),
    ("purple", Srgb8::new(130, 50, 170)),
    ("dark purple", Srgb8::new(70, 25, 95)),
    ("light purple", Srgb8::new(190, 150, 235)),
];

/// Returns the name of the named colour that is nearest to `light`.
pub(super) fn color(light: LinearRgb) -> &'static str {
    let seen = Oklab::from_srgb8(Srgb8::from_linear(light));
    // The distance is taken in OKLab with a and b (hue and chroma) doubled, because they affect a colour's name more
    // than lightness does.
    let away = |color: Srgb8| {
        let Oklab { l, a, b } = Oklab::from_srgb8(color);
        let (l, a, b) = (seen.l - l, 2.0 * (seen.a - a), 2.0 * (seen.b - b));
        l * l + a * a + b * b
    };
    let nearest = COLORS.into_iter().min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
    nearest.map_or("", |(name, _)| name)
}

/// Formats a number without an exponent, as is usual in prose.
pub(super) fn number(value: f32) -> String {
    let text = crate::text::number(value);
    // Formatted again as f64, because the standard library's `Display` writes no exponents.
    text.parse::<f64>().map_or(text, |number| number.to_string())
}

/// Formats a point as a scene file writes it.
pub(super) fn point_text(point: Vec3) -> String {
    format!("({}, {}, {})", number(point.x), number(point.y), number(point.z))
}

/// Describes a range of distances: "nearest 2" if the farthest is over 1.5 times as far,
/// otherwise "2 away".
pub(super) fn distance(nearest: f32, farthest: f32) -> String {
    if farthest > 1.5 * nearest { format!("nearest {}", number(nearest)) } else { format!("{} away", number(nearest)) }
}

/// Formats `part` out of `whole` as a percentage.
pub(super) fn percent(part: usize, whole: usize) -> String {
    match 100 * part / whole.max(1) {
        0 => "less than 1%".to_owned(),
        share => format!("{share}%"),
    }
}

/// Describes the position of a rectangle in the picture, such as "upper left".
pub(super) fn position(rect: PictureRect) -> &'static str {
    const FULL_EXTENT: f32 = 0.8;
    /// Returns the place along one axis: 0 for left or top, 1 for the middle, 2 for right or
    /// bottom, 3 for the full extent.
    // Only the middle sixth of the picture counts as the middle, so that the side of an object is mentioned more often.
    fn place_on_axis(middle: f32, extent: f32) -> usize {
        match middle {
            _ if extent > FULL_EXTENT => 3,
            m if m < 0.42 => 0,
            m if m > 0.58 => 2,
            _ => 1,
        }
    }
    const POSITIONS: [[&str; 4]; 4] = [
        ["upper left", "at the top", "upper right", "across the top"],
        ["on the left", "in the middle", "on the right", "across the middle"],
        ["lower left", "at the bottom", "lower right", "across the bottom"],
        ["all along the left", "from top to bottom in the middle", "all along the right", "all over the picture"],
    ];
    let PictureRect { middle, extent } = rect;
    POSITIONS[place_on_axis(middle[1], extent[1])][place_on_axis(middle[0], extent[0])]
}

#[cfg(all(test, unit_tests))]
mod tests;
