use super::*;
use crate::grid::Size;

/// Returns the rows of characters of a picture whose objects and light are functions of position.
fn text(
    [columns, rows]: [usize; 2],
    background: Background,
    object: impl Fn(f32, f32) -> u32,
    light: impl Fn(f32, f32) -> u8,
) -> Vec<String> {
    let geometry = Geometry::of_objects(columns, rows, object);
    let pixel = |at: usize| {
        let (x, y) = (at % (ACROSS * columns), at / (ACROSS * columns));
        let grey = light((x as f32 + 0.5) / ACROSS as f32, (y as f32 + 0.5) / DOWN as f32);
        Srgb8::new(grey, grey, grey)
    };
    let [width, height] = [(ACROSS * columns) as u32, (DOWN * rows) as u32];
    let picture = Picture::from_pixels(width, height, (0..columns * rows * ACROSS * DOWN).map(pixel).collect())
        .expect("all pixels are there");
    let mut grid = Grid::new(Size::new(columns as u16, rows as u16));
    fill(&mut grid, &picture, &geometry, (background, Colors::None), None);
    grid.rows().map(|row| row.map(|cell| cell.glyph.to_string()).collect()).collect()
}

/// Checks the character in the middle of a cell that a straight border crosses.
#[test]
fn straight_borders_have_the_characters_that_run_along_them() {
    type Side = fn(f32, f32) -> bool;
    let borders: [(Side, char); 7] = [
        (|x, _| x < 1.5, '|'),
        (|_, y| y < 1.55, '-'),
        (|_, y| y < 1.95, '_'),
        // The diagonals of the middle cell, which is 1.0..2.0 in x and y: positions are in cells.
        (|x, y| x + y < 3.0, '/'),
        (|x, y| x - y < 0.0, '\\'),
        // Borders through the upper and the lower part of the cell.
        (|_, y| y < 1.2, '"'),
        (|x, y| 0.5 * x + y < 2.45, ','),
    ];
    for (is_first, expected) in borders {
        let text = text([3, 3], Background::Dark, |x, y| if is_first(x, y) { 1 } else { 2 }, |_, _| 128);
        assert_eq!(text[1].chars().nth(1), Some(expected), "{text:?}");
    }
}

#[test]
fn a_disc_on_nothing_has_a_closed_outline() {
    let is_disc = |x: f32, y: f32| u32::from((x - 8.0) * (x - 8.0) + 4.0 * (y - 4.0) * (y - 4.0) < 40.0);
    let text = text([16, 8], Background::Dark, is_disc, |x, _| (40.0 + 12.0 * x) as u8);
    assert_eq!(
        text,
        [
            r"      _,,_      ",
            r#"   ,"`xxoX`",   "#,
            r"  /;;+xxoXX##\  ",
            r" \:;;+xxoXX##`/ ",
            r" /:;;+xxoXX##_\ ",
            r"  \;;+xxoXX##/  ",
            r#"   "\__xo__/"   "#,
            r"      ````      ",
        ]
    );
}

/// Checks that the characters of an object get denser with its light, and reach from the first to
/// the last; on a light background from the last to the first.
#[test]
fn an_object_uses_all_characters() {
    let light = |x: f32, _: f32| (10.0 + 2.0 * x) as u8;
    let mut row = text([64, 1], Background::Dark, |_, _| 1, light)[0].clone().into_bytes();
    row.dedup();
    assert_eq!(String::from_utf8_lossy(&row), ":;+xoX#@");
    let mut row = text([64, 1], Background::Light, |_, _| 1, light)[0].clone().into_bytes();
    row.dedup();
    assert_eq!(String::from_utf8_lossy(&row), "@#Xox+;:");
}

#[test]
fn a_flat_object_has_one_character_and_nothing_is_blank() {
    for light in [0, 128, 255] {
        assert_eq!(text([4, 1], Background::Dark, |_, _| 1, |_, _| light), ["oooo"]);
        assert_eq!(text([4, 1], Background::Light, |_, _| 0, |_, _| light), ["    "]);
    }
}

/// Checks that small objects in a crowd are drawn by their fill, and not by outlines around them.
#[test]
fn small_objects_in_a_crowd_are_filled() {
    let object = |x: f32, y: f32| 1 + (x / 3.0) as u32 + 100 * (y / 2.0) as u32;
    let light = |x: f32, _: f32| if ((x / 3.0) as u32).is_multiple_of(2) { 20 + (60.0 * (x % 3.0)) as u8 } else { 90 };
    let rows = text([24, 8], Background::Dark, object, light);
    let lines = rows.concat().chars().filter(|glyph| "/\\|".contains(*glyph)).count();
    assert_eq!(lines, 0, "{rows:#?}");
}

#[test]
fn colours_are_the_hues_of_objects() {
    let geometry = Geometry::of_objects(2, 1, |_, _| 1);
    let pixels = vec![Srgb8::new(60, 20, 10); 16];
    let picture = Picture::from_pixels(4, 4, pixels).expect("all pixels are there");
    for (colors, background, expected) in [
        (Colors::Truecolor, Background::Dark, Ink::Rgb(Srgb8::new(255, 85, 42))),
        (Colors::Truecolor, Background::Light, Ink::Rgb(Srgb8::new(153, 51, 25))),
        (Colors::Indexed256, Background::Dark, Ink::Indexed(16 + 36 * 5 + 6)),
        (Colors::SIXTEEN, Background::Dark, Ink::Indexed(9)),
        (Colors::None, Background::Dark, Ink::Default),
    ] {
        let mut grid = Grid::new(Size::new(2, 1));
        fill(&mut grid, &picture, &geometry, (background, colors), None);
        assert_eq!(grid.cell(1, 0), Cell::new('o', expected, Ink::Default), "{colors:?} {background:?}");
    }
}
