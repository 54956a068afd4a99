use super::*;
use crate::grid::{Cell, Ink};
use std::collections::HashSet;

const BLACK: Srgb8 = Srgb8::new(0, 0, 0);
const BLUE: Srgb8 = Srgb8::new(0, 0, 255);

/// Checks that a glyph kind is complete with one file, its `mod` line and its row of the table, as
/// `Dots` is.
#[test]
fn a_glyph_kind_for_tests_is_found_and_painted() {
    let glyphs = Glyphs::from_name("dots").expect("by its name");
    let picture = Picture::from_pixels(2, 1, vec![BLUE, BLACK]).expect("all pixels are there");
    let mode = CellMode { glyphs, colors: Colors::Truecolor };
    let resolution = resolution(mode, Size::new(2, 1), 2.0).expect("a small screen");
    assert_eq!((resolution.width(), resolution.height()), (picture.width(), picture.height()));
    let grid = grid_from_picture(mode, &picture);
    assert_eq!(grid.cell(0, 0), Cell::new('o', Ink::Rgb(BLUE), Ink::Rgb(BLACK)));
    assert_eq!(grid.cell(1, 0), Cell::new(' ', Ink::Default, Ink::Rgb(BLACK)));
    let on_light = Painter::new(mode.without_colors()).with_light_background(true).grid(&picture);
    assert_eq!(on_light.cells().map(|cell| cell.glyph.to_string()).collect::<String>(), "oo");
}

#[test]
fn glyph_kinds_have_unique_names_and_plain_kinds_of_equal_pixel_counts() {
    let mut names = HashSet::new();
    for &glyphs in Glyphs::ALL {
        assert!(names.insert(glyphs.name()), "{glyphs:?}");
        let mode = CellMode { glyphs, colors: Colors::Truecolor };
        assert_eq!(mode.without_colors().pixels_per_cell(), mode.pixels_per_cell(), "{glyphs:?}");
        assert_eq!(mode.without_colors().without_colors(), mode.without_colors(), "{glyphs:?}");
    }
}
