use super::*;
use crate::color::Srgb8;
use crate::encode::capped::channels;
use crate::encode::capped::colors::FramePalette;
use crate::grid::{HalfBlocks, PackedInk};

/// Returns Marsaglia's xorshift.
fn noise(mut state: u32) -> impl FnMut() -> u32 {
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    }
}

/// Returns an active cell of a flat grey.
fn cell(at: usize, grey: u8, stay: f32, pair: Option<u16>) -> ActiveCell {
    let wanted = [PackedInk::rgb(Srgb8 { r: grey, g: grey, b: grey }); 2];
    ActiveCell {
        at,
        wanted,
        channels: wanted.map(channels),
        weight: 1.0,
        stay,
        is_vacated: false,
        cost: stay,
        pair,
        shown: [0; 2],
        nearest: [[0; 2]; 2],
    }
}

/// Returns the key of the flat pair of a colour.
fn flat(color: u8) -> u16 {
    u16::from_be_bytes([color; 2])
}

/// Returns the cost of a row's cells if they are written with some pairs, if no row above has runs.
fn cost(cells: &[ActiveCell], pairs: &[Option<u16>], colors: &PairColors<'_>, row: Row) -> f32 {
    let mut before: Option<(u16, KnownCursor)> = None;
    let cells = cells.iter().zip(pairs);
    cells
        .map(|(cell, &pair)| {
            let Some(key) = pair else { return cell.stay };
            let cursor = before.filter(|&(other, _)| other == key).map_or(KnownCursor::Unknown, |(_, cursor)| cursor);
            before = Some((key, row.cursor_after(cell)));
            colors.rate * (row.move_len(cursor, cell) + glyph_len(key)) + colors.cheapest(key, cell).0
        })
        .sum()
}

#[test]
fn the_cheapest_way_to_show_a_row_is_chosen() {
    let mut palette = FramePalette::default();
    palette.set_colors(&[[100; 3], [110; 3]]);
    let colors = PairColors { palette: &palette, rate: 20.0, half_blocks: HalfBlocks::Either };
    let ways = [None, Some(flat(0)), Some(flat(1))];
    let row = Row { row: 3, columns: 40 };
    let mut number = noise(11);
    let (mut written, mut kept, mut runs) = (0, 0, Runs::default());
    for case in 0..2_000 {
        let start = row.row * row.columns + number() as usize % 35;
        // With or without a cell between that is shown exactly, and so is not active.
        let columns = [0, 1, 2 + usize::from(number().is_multiple_of(2))];
        let mut cells: Vec<ActiveCell> = columns
            .map(|column| {
                let (grey, stay) = (95 + number() as u8 % 20, (number() % 1_000) as f32);
                cell(start + column, grey, stay, ways[number() as usize % 3])
            })
            .into();
        let tried: Vec<Option<u16>> = cells.iter().map(|cell| cell.pair).chain([None]).collect();
        let all = (0..27).map(|number| [1, 3, 9].map(|step| ways[number / step % 3]));
        let all = all.filter(|pairs| pairs.iter().all(|pair| tried.contains(pair)));
        let least = all.map(|pairs| cost(&cells, &pairs, &colors, row)).fold(f32::INFINITY, f32::min);
        runs.choose(&mut cells, &colors, row.columns);
        let pairs: Vec<Option<u16>> = cells.iter().map(|cell| cell.pair).collect();
        let found = cost(&cells, &pairs, &colors, row);
        let sum: f32 = cells.iter().map(|cell| cell.cost).sum();
        assert!((found - least).abs() < 0.1, "case {case}: {pairs:?} costs {found}, the least is {least}");
        assert!((found - sum).abs() < 0.1, "case {case}: {found} is the sum of the cells' costs, {sum}");
        written += pairs.iter().flatten().count();
        kept += pairs.iter().filter(|pair| pair.is_none()).count();
    }
    assert!(written > 500 && kept > 500, "{written} cells are written, {kept} kept");
}

/// A cell whose own pair costs a move takes the one of the run around it, and a cell without a pair
/// that of the cell above.
#[test]
fn a_run_is_not_interrupted_for_a_small_error() {
    let mut palette = FramePalette::default();
    palette.set_colors(&[[100; 3], [110; 3]]);
    let colors = PairColors { palette: &palette, rate: 100.0, half_blocks: HalfBlocks::Either };
    let cells = [(0, 0), (1, 0), (2, 8), (3, 0), (42, 0), (79, 0), (119, 0)];
    let pair = |at: usize, more: u8| (at < 40).then_some(flat(u8::from(more > 0)));
    let mut active: Vec<ActiveCell> =
        cells.iter().map(|&(at, more)| cell(at, 100 + more, 1e6, pair(at, more))).collect();
    active[5].pair = Some(flat(0));
    Runs::default().choose(&mut active, &colors, 40);
    assert!(active.iter().all(|cell| cell.pair == Some(flat(0))), "one run, and cells below it");
    // From the end of the run in column 4, BS, BS and LF lead to column 2 of the next row.
    assert_eq!(active[4].cost, 100.0 * (3.0 + 1.0));
    // From the last column of a row, only CHA and LF lead to that of the next one.
    assert_eq!(active[6].cost, 100.0 * (6.0 + 1.0));
}

/// Other cells with larger errors are not worth their bytes.
#[test]
fn vacated_cells_are_written_at_any_rate() {
    let mut palette = FramePalette::default();
    palette.set_colors(&[[100; 3], [110; 3]]);
    for rate in [0.3, 30.0, 1e4] {
        let colors = PairColors { palette: &palette, rate, half_blocks: HalfBlocks::Either };
        let mut active: Vec<ActiveCell> =
            [0_usize, 1, 2, 3].map(|at| cell(at, 100, 1e9, Some(flat(u8::from(at % 2 == 1))))).into();
        // Both colours are far from theirs, so that a path past them would cost less.
        for at in [1, 2] {
            active[at] = ActiveCell { is_vacated: true, ..cell(at, 160, 0.1, active[at].pair) };
        }
        Runs::default().choose(&mut active, &colors, 40);
        assert!(active.iter().all(|cell| cell.pair.is_some()), "at a rate of {rate}");
    }
}
