use super::*;
use crate::cell::{CellMode, Colors, Glyphs, grid_from_picture};
use crate::color::Srgb8;
use crate::grid::{Cell, Ink};
use crate::tone::Picture;
use std::collections::HashSet;

/// The kinds of mosaics with their pixels per cell and all their glyphs but the space.
fn kinds() -> [(Glyphs, [usize; 2], Vec<char>); 3] {
    let eighths = || ('▁'..='▇').chain(['▎', '▊']);
    let octants = (1..=254).map(octant).chain(eighths());
    let quadrants = (1..=14).map(quadrant).chain(eighths());
    [
        (Glyphs::Blocks, [4, 8], quadrants.collect()),
        (Glyphs::Octants, [4, 8], octants.collect()),
        (Glyphs::Sextants, [4, 6], (1..=62).map(sextant).collect()),
    ]
}

/// Returns whether the ink of a block character covers a pixel of a cell.
fn is_inside(glyph: char, [width, height]: [usize; 2], [x, y]: [usize; 2]) -> bool {
    let BlockParts { parts: [across, down], mask } = block_parts(glyph).expect("a block character");
    mask >> (y * down / height * across + x * across / width) & 1 == 1
}

/// Returns the squared error of a cell whose pixels on each side of a glyph's ink get their mean.
fn squared_error(glyph: char, size: [usize; 2], pixels: &[Srgb8]) -> f64 {
    let sides = [true, false].map(|inside| {
        let side = pixels.iter().enumerate().filter(|(at, _)| {
            glyph == ' ' && inside || glyph != ' ' && is_inside(glyph, size, [at % size[0], at / size[0]]) == inside
        });
        side.map(|(_, c)| [c.r, c.g, c.b].map(f64::from)).collect::<Vec<_>>()
    });
    let error = |side: &[[f64; 3]], channel: usize| {
        let mean = side.iter().map(|c| c[channel]).sum::<f64>() / side.len().max(1) as f64;
        side.iter().map(|c| (c[channel] - mean) * (c[channel] - mean)).sum::<f64>()
    };
    sides.iter().map(|side| (0..3).map(|channel| error(side, channel)).sum::<f64>()).sum()
}

/// Returns a cell's pixels: noise over a step, from a fixed sequence of numbers.
fn noisy_cell(seed: u32, count: usize) -> Vec<Srgb8> {
    let mut state = seed.wrapping_mul(2_654_435_761) | 1;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    };
    let (from, to) = (next() as usize % count, next() as usize % count);
    let pixel = |at| {
        let base = if (from.min(to)..from.max(to)).contains(&at) { 180 } else { 20 };
        let mut channel = || base + (next() % 60) as u8;
        Srgb8::new(channel(), channel(), channel())
    };
    (0..count).map(pixel).collect()
}

#[test]
fn glyphs_and_colors_are_the_least_squares_best_of_all() {
    for (glyphs, size, all) in kinds() {
        for seed in 1..200 {
            let pixels = noisy_cell(seed, size[0] * size[1]);
            let picture =
                Picture::from_pixels(size[0] as u32, size[1] as u32, pixels.clone()).expect("a pixel for each place");
            let grid = grid_from_picture(CellMode { glyphs, colors: Colors::Truecolor }, &picture);
            let cell = grid.cell(0, 0);
            let chosen = cell.glyph.to_string().chars().next().expect("a character");
            let least = all.iter().map(|&glyph| squared_error(glyph, size, &pixels)).fold(f64::INFINITY, f64::min);
            let error = squared_error(chosen, size, &pixels);
            assert!(error <= least * 1.000_01, "{glyphs}, seed {seed}: {chosen:?} has {error} instead of {least}");
            let inside =
                pixels.iter().enumerate().filter(|(at, _)| is_inside(chosen, size, [at % size[0], at / size[0]]));
            let inside: Vec<f64> = inside.map(|(_, c)| f64::from(c.g)).collect();
            let Ink::Rgb(fg) = cell.fg else { panic!("{cell:?}") };
            let mean = inside.iter().sum::<f64>() / inside.len() as f64;
            assert!((f64::from(fg.g) - mean).abs() <= 0.5, "{glyphs}, seed {seed}: {fg:?} instead of {mean}");
        }
    }
}

#[test]
fn flat_cells_are_spaces_and_halves_lower_half_blocks() {
    let [dark, near, light] = [100, 102, 104].map(|grey| Srgb8::new(grey, grey, grey));
    for (glyphs, [width, height], _) in kinds() {
        let shown = |lower| {
            let pixels = (0..width * height).map(|at| if at < width * height / 2 { dark } else { lower }).collect();
            let picture = Picture::from_pixels(width as u32, height as u32, pixels).expect("a pixel for each place");
            grid_from_picture(CellMode { glyphs, colors: Colors::Truecolor }, &picture).cell(0, 0).clone()
        };
        assert_eq!(shown(near), Cell::new(' ', Ink::Default, Ink::Rgb(Srgb8::new(101, 101, 101))), "{glyphs}");
        if glyphs != Glyphs::Sextants {
            assert_eq!(shown(light), Cell::new('▄', Ink::Rgb(light), Ink::Rgb(dark)), "{glyphs}");
        }
    }
}

#[test]
fn each_mask_has_a_glyph_of_its_own_that_covers_its_parts() {
    for (glyph_of, parts, count) in
        [(quadrant as fn(u8) -> char, [2, 2], 16), (sextant, [2, 3], 64), (octant, [2, 4], 256)]
    {
        let glyphs: HashSet<char> = (0..count).map(|mask| glyph_of(mask as u8)).collect();
        assert_eq!(glyphs.len(), count, "{parts:?}");
        for mask in 1..count {
            for part in 0..parts[0] * parts[1] {
                let at = [part % parts[0] * 12 + 6, part / parts[0] * 12 + 6];
                let inside = is_inside(glyph_of(mask as u8), parts.map(|parts| 12 * parts), at);
                assert_eq!(inside, mask >> part & 1 == 1, "{parts:?}, mask {mask:#x}, part {part}");
            }
        }
    }
    // The first glyph, another one and the last glyph of each block in Unicode's tables.
    assert_eq!([0x04, 0x06, 0xfe].map(octant), ['\u{1CD00}', '\u{1CD01}', '\u{1CDE5}']);
    assert_eq!([1, 22, 62].map(sextant), ['\u{1FB00}', '\u{1FB14}', '\u{1FB3B}']);
}

#[test]
fn light_pixels_are_ink_without_colors() {
    let pixels = [0, 0, 255, 255].repeat(8).into_iter().map(|grey| Srgb8::new(grey, grey, grey)).collect();
    let picture = Picture::from_pixels(4, 8, pixels).expect("a pixel for each place");
    for (glyphs, right) in [(Glyphs::Blocks, '▐'), (Glyphs::Octants, '▐'), (Glyphs::Braille, '⢸')] {
        let grid = grid_from_picture(CellMode { glyphs, colors: Colors::None }, &picture);
        assert_eq!(grid.cell(0, 0), Cell::new(right, Ink::Default, Ink::Default));
    }
}
