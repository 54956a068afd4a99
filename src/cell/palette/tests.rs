use super::super::Colors;
use super::*;

#[test]
fn the_colours_of_a_palette_are_flat() {
    let Colors::Indexed16(sixteen) = Colors::SIXTEEN else { unreachable!() };
    let cube: Vec<_> = (16..=255).map(xterm_color).collect();
    for (mut palette, colors, first) in
        [(Palette::cube_and_greys(), &cube[..], 16), (Palette::from_colors(&sixteen), &sixteen[..], 0)]
    {
        for &color in colors {
            for (x, y) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let shown = palette.index(color, x, y);
                assert_eq!(colors[usize::from(shown - first)], color);
                assert_eq!(palette.flat_index(color), shown);
            }
        }
    }
}

/// Checks that greys between two palette greys show each number of lighter pixels out of four.
#[test]
fn a_share_of_four_pixels_is_lighter() {
    let mut palette = Palette::from_colors(&[Srgb8::new(90, 90, 90), Srgb8::new(200, 200, 200)]);
    let mut patterns = Vec::new();
    for grey in 0..=255 {
        let color = Srgb8::new(grey, grey, grey);
        patterns.push([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| palette.index(color, x, y)));
    }
    patterns.dedup();
    assert_eq!(patterns, [[0, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 1], [1, 1, 0, 1], [1, 1, 1, 1]]);
}

#[test]
fn painters_with_one_palette_share_its_choices() {
    let used = |mut palette: Palette| {
        palette.index(Srgb8::new(90, 160, 40), 0, 0);
        palette.choices.expect("it was used")
    };
    // A palette that no other test has.
    let theme: Vec<_> = (0..16).map(|at| Srgb8::new(at, 17 * at, 255 - at)).collect();
    let other = used(Palette::from_colors(&theme[..15]));
    let first = used(Palette::from_colors(&theme));
    let second = used(Palette::from_colors(&theme));
    assert!(Arc::ptr_eq(&first, &second) && !Arc::ptr_eq(&first, &other));
    // Unused choices are not kept.
    let kept = Arc::downgrade(&first);
    drop((first, second));
    assert_eq!(kept.strong_count(), 0);
}
