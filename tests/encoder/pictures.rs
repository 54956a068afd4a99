//! Whole pictures that are hard on an encoder, and movements in them.

use super::grids::put;
use super::screens::Clusters;
use super::{Stage, rgb};
use termtrace::{Cell, Grid, Ink, Size};

const SIZE: Size = Size::new(53, 17);

/// Returns a picture from the colour of each half cell.
///
/// As in the program's pictures a cell of one colour is a space.
fn picture(size: Size, mut color: impl FnMut(u16, u16) -> Ink) -> Grid {
    let mut grid = Grid::new(size);
    for row in 0..size.rows {
        for column in 0..size.columns {
            let (upper, lower) = (color(column, 2 * row), color(column, 2 * row + 1));
            let glyph = if upper == lower { ' ' } else { '▄' };
            *grid.cell_mut(column, row) = Cell::new(glyph, lower, upper);
        }
    }
    grid
}

/// Returns Marsaglia's xorshift: noise that is the same in every run.
pub(crate) fn noise(mut state: u32) -> impl FnMut() -> u32 {
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    }
}

fn any_color(number: u32) -> Ink {
    let [r, g, b, _] = number.to_le_bytes();
    rgb(r, g, b)
}

/// Asserts that every terminal shows each frame, for all settings of the encoder.
#[track_caller]
fn assert_shown(frames: &[Grid]) {
    for mut stage in Stage::all(&frames[0], Clusters::None) {
        for frame in frames {
            stage.grid.clone_from(frame);
            // The most bytes of a cell: a row, a column, two colours and a half block.
            stage.send(4 + 48 * frame.size().cell_count());
        }
    }
}

#[test]
fn noise_of_all_colours() {
    let mut number = noise(1);
    let frames: Vec<Grid> = (0..3).map(|_| picture(SIZE, |_, _| any_color(number()))).collect();
    assert_shown(&frames);
}

/// Each colour has many neighbours, and each pair comes more than once.
#[test]
fn noise_of_few_colours() {
    for count in [2, 5, 30] {
        let mut number = noise(count);
        let frames: Vec<Grid> =
            (0..3).map(|_| picture(SIZE, |_, _| any_color((number() >> 8) % count * 0x01_02_03))).collect();
        assert_shown(&frames);
    }
}

/// Neighbours share a colour all over the picture, and every cell changes with every frame.
#[test]
fn gradients_that_move() {
    let shade = |t: u16| rgb(t as u8, (t / 2) as u8, 255 - t as u8);
    assert_shown(&[0, 1, 2, 9].map(|time| picture(SIZE, |x, y| shade(x + y + time))));
    assert_shown(&[0, 1, 2, 9].map(|time| picture(SIZE, |x, y| shade(2 * x + 3 * y + time))));
}

/// A square moves over long runs of spaces, whose gaps are cheaper to write again than to skip.
#[test]
fn flat_areas_with_a_square_that_moves() {
    let flat = |x: u16, y: u16| if (x / 20 + y / 12).is_multiple_of(2) { rgb(255, 255, 255) } else { rgb(0, 0, 0) };
    let square = |at: u16| move |x: u16, y: u16| (at..at + 5).contains(&x) && (at / 2..at / 2 + 5).contains(&y);
    assert_shown(
        &[0, 1, 2, 7, 28, 48, 1]
            .map(|at| picture(SIZE, |x, y| if square(at)(x, y) { rgb(9, 90, 200) } else { flat(x, y) })),
    );
}

/// Thousands of pairs of colours share one: nothing may take the square of that.
#[test]
fn one_colour_under_all_others() {
    let mut number = noise(7);
    let size = Size::new(250, 100);
    assert_shown(&[picture(size, |_, y| if y.is_multiple_of(2) { rgb(5, 5, 5) } else { any_color(number()) })]);
}

/// Wide characters over a picture, that come, go and move by one column, up to the last one.
#[test]
fn wide_characters_over_a_picture() {
    let mut number = noise(3);
    let frames: Vec<Grid> = (0..40)
        .map(|_| {
            let mut grid = picture(SIZE, |x, y| rgb((x / 8) as u8, (y / 8) as u8, 0));
            for _ in 0..200 {
                let [column, row, glyph, color] = number().to_le_bytes();
                let glyph = ['世', '🙂', 'x', ' '][usize::from(glyph % 4)];
                let (column, row) = (u16::from(column) % SIZE.columns, u16::from(row) % SIZE.rows);
                put(&mut grid, column, row, &Cell::new(glyph, rgb(color % 3, 0, 0), rgb(0, color % 2, 0)));
            }
            grid
        })
        .collect();
    assert_shown(&frames);
}
