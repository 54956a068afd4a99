//! Pictures made by hand, and the cells that show them.

use termtrace::capabilities::CellMode;
use termtrace::cell::{RAMP, grid_from_picture, resolution};
use termtrace::color::Srgb8;
use termtrace::export;
use termtrace::framebuffer::Resolution;
use termtrace::grid::{Cell, Glyph, Grid, Ink, Size};
use termtrace::tone::Picture;

/// Rows of pixels, each a letter: b(lack), w(hite), r(ed), g(rey).
fn picture(rows: &[&str]) -> Picture {
    let pixels = rows.iter().flat_map(|row| row.chars()).map(color).collect();
    Picture { width: rows[0].len() as u32, height: rows.len() as u32, pixels }
}

fn color(letter: char) -> Srgb8 {
    match letter {
        'b' => Srgb8::new(0, 0, 0),
        'w' => Srgb8::new(255, 255, 255),
        'r' => Srgb8::new(255, 0, 0),
        'g' => Srgb8::new(119, 119, 119),
        other => panic!("no colour {other}"),
    }
}

/// Cells as the glyph, the character's colour and the one behind it; a minus for the terminal's own.
fn written(grid: &Grid) -> Vec<String> {
    let letter = |ink: Ink| match ink {
        Ink::Default => '-',
        Ink::Rgb(found) => "bwrg".chars().find(|&letter| color(letter) == found).unwrap_or('?'),
        Ink::Indexed(_) => '?',
    };
    let cell = |cell: &Cell| format!("{}{}{}", cell.glyph, letter(cell.fg), letter(cell.bg));
    grid.rows().map(|row| row.iter().map(cell).collect::<Vec<_>>().join(" ")).collect()
}

#[track_caller]
fn assert_half_blocks(rows: &[&str], expected: &[&str]) {
    assert_eq!(written(&grid_from_picture(CellMode::HalfBlock, &picture(rows))), expected, "{rows:?}");
}

/// The lower half block: its colour is the lower pixel's, the upper one's lies behind it.
#[test]
fn a_half_block_is_the_lower_pixel_on_the_upper() {
    assert_half_blocks(&["b", "w"], &["▄wb"]);
    assert_half_blocks(&["bw", "wr", "rg", "gb"], &["▄wb ▄rw", "▄gr ▄bg"]);
}

/// A full block would show hairlines in some fonts.
#[test]
fn a_flat_cell_is_a_space() {
    assert_half_blocks(&["r", "r"], &[" -r"]);
    assert_half_blocks(&["rrb", "rbb"], &[" -r ▄br  -b"]);
}

/// Below the edge there is nothing: the terminal's own colour.
#[test]
fn an_odd_row_fills_the_upper_half() {
    assert_half_blocks(&["r"], &["▀r-"]);
    assert_half_blocks(&["bw", "br", "rw"], &[" -b ▄rw", "▀r- ▀w-"]);
}

/// No modifiers in a picture, and one column for each pixel.
#[test]
fn a_grid_is_as_wide_as_its_picture() {
    for (width, height, rows) in [(1, 1, 1), (1, 2, 1), (2, 3, 2), (7, 4, 2), (300, 1, 1), (1, 301, 151)] {
        let picture = Picture { width, height, pixels: vec![Srgb8::default(); (width * height) as usize] };
        for mode in [CellMode::HalfBlock, CellMode::Ramp] {
            let grid = grid_from_picture(mode, &picture);
            assert_eq!(grid.size(), Size::new(width as u16, rows), "{width}x{height}");
            assert!(grid.cells().iter().all(|cell| cell.modifier.is_empty()));
        }
    }
}

#[track_caller]
fn assert_ramp(rows: &[&str], expected: &str) {
    let grid = grid_from_picture(CellMode::Ramp, &picture(rows));
    assert_eq!(export::text(&grid), expected, "{rows:?}");
    assert!(grid.cells().iter().all(|cell| (cell.fg, cell.bg) == (Ink::Default, Ink::Default)), "no colour");
}

/// Lightness by hand: red's luminance is 0.2126, L* = 116 * 0.5968 - 16 = 53.2, the sixth step; the grey's is 0.1845,
/// L* = 50.03, the sixth as well.
#[test]
fn the_ramp_is_by_lightness() {
    assert_ramp(&["bwrg", "bwrg"], " @++\n");
    assert_ramp(&["w"], "@\n");
    assert_ramp(&["b"], " \n");
}

/// A cell is as light as the mean of its pixels' light, not of their numbers: half black and half white is a luminance
/// of 0.5, L* = 76.1, the eighth step; red and black 0.1063, L* = 38.9, the fourth.
#[test]
fn the_ramp_takes_the_mean_of_light() {
    assert_ramp(&["bwr", "wbb"], "##-\n");
    assert_ramp(&["bw", "wb", "wr"], "##\n@+\n");
}

#[test]
fn the_ramp_is_a_promise() {
    assert_eq!(RAMP, b" .:-=+*#%@");
}

#[test]
fn trailing_blanks_are_kept() {
    assert_ramp(&["wbb", "wbb", "bbb", "bbb"], "@  \n   \n");
}

/// Two pixels to a cell, one above the other, each as high as half of it.
#[test]
fn pixels_of_a_screen() {
    for mode in [CellMode::HalfBlock, CellMode::Ramp] {
        for (cell_aspect, pixel_aspect) in [(2.0, 1.0), (1.0, 0.5), (3.0, 1.5)] {
            let expected = Resolution { width: 80, height: 48, pixel_aspect };
            assert_eq!(resolution(mode, Size::new(80, 24), cell_aspect), expected);
        }
    }
    // 65,535 rows are more pixels than 16 bits can count.
    assert_eq!(resolution(CellMode::HalfBlock, Size::new(1, 65_535), 2.0).height, 131_070);
}

/// The escape sequences of a file by hand: only what differs is said, and no colour is left on at a line's end.
#[test]
fn ansi_of_a_picture() {
    let grid = grid_from_picture(CellMode::HalfBlock, &picture(&["bb", "ww", "rr"]));
    let expected = "\x1b[48;2;0;0;0m\x1b[38;2;255;255;255m▄▄\x1b[0m\n\x1b[38;2;255;0;0m▀▀\x1b[0m\n";
    assert_eq!(String::from_utf8_lossy(&export::ansi(&grid)), expected);
}

/// The second half of a wide character is no character, and a cluster is written whole.
#[test]
fn covered_cells_are_not_written_to_files() {
    let mut grid = Grid::new(Size::new(6, 1));
    grid.put(0, 0, &Cell::new('世', Ink::Default, Ink::Default), 2);
    grid.put(2, 0, &Cell { glyph: Glyph::Cluster("e\u{301}".into()), ..Cell::BLANK }, 1);
    grid.put(3, 0, &Cell { glyph: Glyph::Cluster("👨\u{200d}👩\u{200d}👧".into()), ..Cell::BLANK }, 2);
    assert_eq!(export::text(&grid), "世e\u{301}👨\u{200d}👩\u{200d}👧 \n");
    assert_eq!(String::from_utf8_lossy(&export::ansi(&grid)), "世e\u{301}👨\u{200d}👩\u{200d}👧 \x1b[0m\n");
}

/// What is put over half of something wide leaves blanks of its colours beside it.
#[test]
fn what_is_cut_becomes_blanks() {
    let wide = |text: &str| Cell { glyph: Glyph::Cluster(text.into()), bg: Ink::Indexed(1), ..Cell::BLANK };
    let letter = |cell: &Cell| if cell.glyph == Glyph::Covered { "<".to_owned() } else { cell.glyph.to_string() };
    for (column, columns, expected) in [
        (0, 1, "x  .b<<."),
        (1, 1, " x .b<<."),
        (2, 1, "  x.b<<."),
        (3, 1, "a<<xb<<."),
        (3, 2, "a<<x<  ."),
        (2, 3, "  x<<  ."),
        (5, 2, "a<<. x<."),
        (7, 1, "a<<.b<<x"),
    ] {
        let mut grid = Grid::new(Size::new(8, 1));
        for column in [3, 7] {
            grid.cell_mut(column, 0).glyph = '.'.into();
        }
        grid.put(0, 0, &wide("a"), 3);
        grid.put(4, 0, &wide("b"), 3);
        grid.put(column, 0, &Cell::new('x', Ink::Default, Ink::Default), columns);
        let shown: String = grid.cells().iter().map(letter).collect();
        assert_eq!(shown, expected, "{columns} columns at {column}");
        assert_eq!(
            [2, 4].map(|column| grid.cell(column, 0).bg == Ink::Indexed(1)),
            [2, 4].map(|c| !(column..column + columns).contains(&c))
        );
    }
}
