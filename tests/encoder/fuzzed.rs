//! Properties of any grids, pen and damage drawn from bytes, for the fuzzer and for its corpus.

use super::grids::{filled, put_at};
use super::screens::{Clusters, glyph_of};
use super::watched::Watched;
use arbitrary::{Result, Unstructured};
use std::time::Duration;
use termtrace::internals::capabilities::Shifts;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::{Attributes, HalfBlocks};
use termtrace::{Cell, Glyph, Grid, Ink, Order, Quality, Size, Srgb8};

const GLYPHS: [&str; 9] = ["▄", "▀", " ", "a", "@", "é", "│", "世", "🙂"];

/// Asserts that all terminals show what they should.
pub(crate) fn hold_for(data: &[u8]) {
    // By the last byte, so that the inputs of the corpus make the choices that they made before there were shifts.
    let Some((&last, story)) = data.split_last() else { return };
    let shifts = [Shifts::Off, Shifts::Direct, Shifts::ThroughTmux][usize::from(last) % 3];
    // The session ends with the bytes.
    let _ = tell(&mut Unstructured::new(story), shifts);
}

fn tell(bytes: &mut Unstructured<'_>, shifts: Shifts) -> Result<()> {
    let order = if bytes.arbitrary()? { Order::Color } else { Order::Raster };
    let mut grid = Grid::new(size(bytes)?);
    let half_blocks = if bytes.arbitrary()? { HalfBlocks::Either } else { HalfBlocks::Lower };
    let mut watched = Watched::new(order, half_blocks, grid.size(), Clusters::None)
        .in_pieces(vec![bytes.int_in_range(1..=64)?, bytes.int_in_range(1..=8)?]);
    if shifts != Shifts::Off {
        watched = watched.with_shifts(shifts);
    }
    let mut now = Duration::ZERO;
    while !bytes.is_empty() {
        match bytes.int_in_range(0..=15)? {
            0 => watched.disturb(grid.size()),
            1 => {
                grid = Grid::new(size(bytes)?);
                watched.resize(grid.size());
            }
            2 => grid = filled(grid.size(), &vec![cell(bytes)?; grid.cells().len()]),
            3 => {
                watched.send(&grid);
            }
            4..=6 => {
                now += Duration::from_millis(bytes.int_in_range(0..=700)?);
                let last = Allowance { quality: quality(bytes)?, now, max_bytes: max_bytes(bytes)? };
                watched.send_within(&grid, last);
                if bytes.ratio(1, 4)? {
                    now += watched.rest(&grid, last).after;
                }
            }
            7 => grid = panned(&grid, bytes.arbitrary()?),
            _ => {
                let place = bytes.int_in_range(0..=grid.cells().len() - 1)?;
                put_at(&mut grid, place, &cell(bytes)?);
            }
        }
    }
    watched.send(&grid);
    Ok(())
}

/// Returns the grid with its columns one place further, or its rows.
fn panned(grid: &Grid, by_rows: bool) -> Grid {
    // What a wide character covers goes with it.
    let uncovered = |cell: Cell| if cell.glyph == Glyph::Covered { Cell::BLANK } else { cell };
    let cells: Vec<Cell> = grid.cells().map(uncovered).collect();
    let count = if by_rows { usize::from(grid.size().columns) } else { 1 };
    filled(grid.size(), &[&cells[count..], &cells[..count]].concat())
}

fn size(bytes: &mut Unstructured<'_>) -> Result<Size> {
    Ok(Size::new(bytes.int_in_range(1..=12)?, bytes.int_in_range(1..=5)?))
}

fn quality(bytes: &mut Unstructured<'_>) -> Result<Quality> {
    bytes.choose(&[Quality::Equal, Quality::Fast, Quality::Exact]).copied()
}

fn max_bytes(bytes: &mut Unstructured<'_>) -> Result<Option<usize>> {
    Ok(if bytes.arbitrary()? { Some(bytes.int_in_range(0..=1_000)?) } else { None })
}

fn cell(bytes: &mut Unstructured<'_>) -> Result<Cell> {
    let underline = if bytes.ratio(1, 8)? { ink(bytes)? } else { Ink::Default };
    let attributes = if bytes.ratio(1, 4)? { bytes.arbitrary()? } else { 0 };
    Ok(Cell {
        glyph: glyph_of(bytes.choose(&GLYPHS)?),
        fg: ink(bytes)?,
        bg: ink(bytes)?,
        underline,
        attributes: Attributes::from_bits_truncate(attributes),
    })
}

/// Returns one of few colours, which neighbours often share, or a colour near another.
fn ink(bytes: &mut Unstructured<'_>) -> Result<Ink> {
    Ok(match bytes.int_in_range(0..=9)? {
        0 => Ink::Default,
        1 => Ink::Indexed(bytes.arbitrary()?),
        2 => Ink::Rgb(Srgb8::new(bytes.arbitrary()?, bytes.arbitrary()?, bytes.arbitrary()?)),
        3..=5 => Ink::Rgb(Srgb8::new(100, 100 + bytes.int_in_range(0..=7)?, 120)),
        near => Ink::Rgb(Srgb8::new(near, 255, 0)),
    })
}
