use super::*;

/// Returns the character for a cell whose eight pixels are given as letters, row by row, from a
/// (black) to z (white).
fn character(pixels: &str) -> String {
    let grey = |letter: char| ((letter as u32 - 'a' as u32) * 255 / 25) as u8;
    let pixels = pixels.chars().map(|letter| Srgb8::new(grey(letter), grey(letter), grey(letter)));
    let [width, height] = [2, 4];
    let mut grid = Grid::new(crate::grid::Size::new(1, 1));
    fill(&mut grid, &Picture::from_pixels(width, height, pixels.collect()).expect("all pixels are there"));
    grid.cell(0, 0).glyph.to_string()
}

/// Checks that a cell whose light equals a glyph's ink gets this glyph, or one with nearly equal
/// ink.
#[test]
fn a_glyph_is_nearest_to_its_own_ink() {
    let white = INK.iter().map(|ink| ink.iter().map(|&part| u32::from(part)).sum::<u32>()).max().expect("95");
    let mut found = 0;
    for (character, ink) in (b' '..).zip(&INK) {
        let samples = ink.map(|part| f32::from(part) * SAMPLES as f32 / white as f32);
        found += usize::from(MATCHER.nearest(&samples) == char::from(character));
    }
    assert!(found >= 90, "{found} of 95");
}

#[test]
fn the_ink_is_where_the_light_is() {
    assert_eq!(character("aaaaaaaa"), " ");
    assert_eq!(character("zzzzzzzz"), "Q");
    // Samples 0 to 3 are the upper half of the cell, and even ones its left half.
    for (pixels, lit) in
        [("zzzzaaaa", [0, 1, 2, 3]), ("aaaazzzz", [4, 5, 6, 7]), ("zazazaza", [0, 2, 4, 6]), ("azazazaz", [1, 3, 5, 7])]
    {
        let character = character(pixels);
        let ink = INK[usize::from(character.as_bytes()[0] - b' ')];
        let sum =
            |is_lit| (0..SAMPLES).filter(|&at| lit.contains(&at) == is_lit).map(|at| u32::from(ink[at])).sum::<u32>();
        assert!(sum(true) > sum(false), "{pixels}: {character}");
    }
}
