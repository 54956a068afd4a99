//! The runs of cells of a row that are written with one pair.
//!
//! Between two runs the cursor moves, which takes as many bytes as the glyphs of several cells: on a screen of 200x60
//! cells, moves took 60 % of a small frame. The cells of a row to write, and their pairs, are therefore chosen
//! together: by a path through the row with nearly the least cost, moves included (Viterbi 1967). Compared with a mean
//! price of a move for each cell, that gains up to 0.3 dB of PSNR at 80x24, and 0.5 to 0.6 dB at 200x60.
//!
//! A run continues after cells that keep what they show. Any other cell is priced as if the cursor came from the pair's
//! last run in the rows above, although it may come from an earlier run in this row: with the price of that move, rows
//! were cut into short runs, and the PSNR was 0.3 to 1 dB lower.

use super::ActiveCell;
use super::pair_colors::{KEYS, PairColors, glyph_len};
use crate::encode::moves::{CellPosition, KnownCursor, Move, cheapest_len};

/// Marks the absence of a state or a row.
const NONE: u32 = u32::MAX;

/// The largest number of pairs that are tried for a cell.
// Its own, that of the cell above, and those of four cells beside it. With two cells beside it the PSNR is 0.1 dB
// lower, and with six at most 0.05 dB higher.
const MAX_PAIRS: usize = 6;

/// The greatest distance in columns of a cell whose pair is tried.
const FARTHEST: usize = 3;

/// A state of a path: a cell, and the way it is shown.
#[derive(Clone, Copy)]
struct State {
    /// The cell's index in the row's active cells.
    cell: u32,
    /// The index of the state before; the cells between keep what they show.
    before: u32,
    /// The pair with which the cell is written; `None` to keep what it shows.
    pair: Option<u16>,
    /// The cost of all cells up to this one.
    // The cost of a row has more digits than an f32, and differences of costs decide.
    path_cost: f64,
    /// The cost of this cell, the move to it included.
    cost: f32,
}

/// The last run of a pair: in the rows above, and in the current one.
#[derive(Clone, Copy)]
struct LastRun {
    /// The cursor after the pair's last run in the rows above.
    cursor: KnownCursor,
    /// The row of `state`.
    row: u32,
    /// The index of the row's state from which a path continues most cheaply.
    state: u32,
}

const NO_RUN: LastRun = LastRun { cursor: KnownCursor::Unknown, row: NONE, state: NONE };

/// The number of a key whose pair no cell has.
const NO_NUMBER: u16 = u16::MAX;

/// The working memory of a frame's runs.
#[derive(Default)]
pub(super) struct Runs {
    /// The states of a row, cell by cell; the first of each cell keeps what it shows.
    states: Vec<State>,
    /// Prefix sums: the cost of the row's first active cells if none of them is written.
    kept: Vec<f64>,
    /// The index of the row's last vacated cell so far, which no path may skip.
    vacated: u32,
    /// The numbers of the cells' pairs, by key: lists by number fit the processor's caches.
    numbers: Vec<u16>,
    /// The keys of the cells' pairs, by number.
    keys: Vec<u16>,
    /// The last runs, by the numbers of their pairs.
    last: Vec<LastRun>,
    /// The pairs of the last row above that has active cells, by column.
    above: Vec<Option<u16>>,
}

impl Runs {
    /// Chooses for each cell one of the pairs near it, or none.
    ///
    /// The active cells must be in reading order. Vacated cells must have a pair, and keep one.
    pub(super) fn choose(&mut self, active: &mut [ActiveCell], colors: &PairColors<'_>, columns: usize) {
        self.number_pairs(active);
        self.above.clear();
        self.above.resize(columns, None);
        for cells in active.chunk_by_mut(|a, b| a.at / columns == b.at / columns) {
            let row = Row { row: cells[0].at / columns, columns };
            let last_state = self.add_row(cells, colors, row);
            self.take_path(cells, last_state, row);
        }
    }

    /// Numbers the pairs of the cells.
    fn number_pairs(&mut self, active: &[ActiveCell]) {
        let Self { numbers, keys, last, .. } = self;
        numbers.resize(KEYS, NO_NUMBER);
        for key in keys.drain(..) {
            numbers[usize::from(key)] = NO_NUMBER;
        }
        for key in active.iter().filter_map(|cell| cell.pair) {
            let number = &mut numbers[usize::from(key)];
            if *number == NO_NUMBER {
                *number = keys.len() as u16;
                keys.push(key);
            }
        }
        last.clear();
        last.resize(keys.len(), NO_RUN);
    }

    /// Returns the last run of a pair.
    fn last(&mut self, key: u16) -> &mut LastRun {
        &mut self.last[usize::from(self.numbers[usize::from(key)])]
    }

    /// Lists the states of a row's cells, each with the cheapest path to it.
    ///
    /// Returns the last state of the cheapest path through the row.
    fn add_row(&mut self, cells: &[ActiveCell], colors: &PairColors<'_>, row: Row) -> u32 {
        self.states.clear();
        self.kept.clear();
        self.kept.push(0.0);
        self.vacated = 0;
        let mut best = NONE;
        for (at, cell) in cells.iter().enumerate() {
            let before = self.path_cost(best);
            let first = self.states.len();
            let (pairs, count) = self.pairs_near(cells, at, row);
            let must_be_written = cell.is_vacated && count > 0;
            self.states.push(State {
                cell: at as u32,
                before: best,
                pair: None,
                path_cost: if must_be_written { f64::INFINITY } else { before + f64::from(cell.stay) },
                cost: cell.stay,
            });
            for &pair in &pairs[..count] {
                let last = *self.last(pair);
                let enter = colors.rate * row.move_len(last.cursor, cell);
                let (mut path_cost, mut before_state, mut cost) = (before + f64::from(enter), best, enter);
                if last.row == row.number() {
                    let (continued, move_cost) = self.continued(last.state, cells, at, colors.rate, row);
                    if continued < path_cost {
                        (path_cost, before_state, cost) = (continued, last.state, move_cost);
                    }
                }
                let written = colors.cheapest(pair, cell).0 + colors.rate * glyph_len(pair);
                self.states.push(State {
                    cell: at as u32,
                    before: before_state,
                    pair: Some(pair),
                    path_cost: path_cost + f64::from(written),
                    cost: cost + written,
                });
            }
            self.kept.push(self.kept[at] + f64::from(cell.stay));
            if must_be_written {
                self.vacated = at as u32;
            }
            best = self.end_cell(first, cells, colors.rate, row);
        }
        best
    }

    /// Returns the cost of the path to a state.
    fn path_cost(&self, state: u32) -> f64 {
        if state == NONE { 0.0 } else { self.states[state as usize].path_cost }
    }

    /// Returns the cost of a path up to the move to a cell, and that of the move.
    ///
    /// The path continues from a state of the row, and the cells between keep what they show.
    fn continued(&self, state: u32, cells: &[ActiveCell], at: usize, rate: f32, row: Row) -> (f64, f32) {
        let State { cell, path_cost, .. } = self.states[state as usize];
        if cell < self.vacated {
            return (f64::INFINITY, 0.0);
        }
        let move_cost = rate * row.move_len(row.cursor_after(&cells[cell as usize]), &cells[at]);
        (path_cost + (self.kept[at] - self.kept[cell as usize + 1]) + f64::from(move_cost), move_cost)
    }

    /// Returns the pairs that are tried for a cell, and their number.
    fn pairs_near(&self, cells: &[ActiveCell], at: usize, row: Row) -> ([u16; MAX_PAIRS], usize) {
        let cell = &cells[at];
        let beside = |other: usize| {
            let other = cells.get(other).filter(|other| other.at.abs_diff(cell.at) <= FARTHEST)?;
            other.pair
        };
        let (mut pairs, mut count) = ([0; MAX_PAIRS], 0);
        let above = self.above[row.column(cell)];
        let others = [at.wrapping_sub(1), at + 1, at.wrapping_sub(2), at + 2].map(beside);
        for pair in [cell.pair, above].into_iter().chain(others).flatten() {
            if !pairs[..count].contains(&pair) {
                pairs[count] = pair;
                count += 1;
            }
        }
        (pairs, count)
    }

    /// Records, for each pair of the last cell, the state from which a path continues most cheaply:
    /// its own or an earlier one.
    ///
    /// Returns the cheapest state of the last cell, whose first is given.
    // Judged by the move to the next active cell, so that one state of each pair suffices. For a cell farther on the
    // other one may be cheaper, by four bytes at most.
    fn end_cell(&mut self, first: usize, cells: &[ActiveCell], rate: f32, row: Row) -> u32 {
        let next = self.states[first].cell as usize + 1;
        let mut best = first;
        for at in first + 1..self.states.len() {
            let state = self.states[at];
            if state.path_cost < self.states[best].path_cost {
                best = at;
            }
            let Some(pair) = state.pair else { continue };
            let LastRun { row: last_row, state: last, .. } = *self.last(pair);
            let is_earlier_cheaper = last_row == row.number()
                && next < cells.len()
                && self.continued(last, cells, next, rate, row).0
                    <= self.continued(at as u32, cells, next, rate, row).0;
            if !is_earlier_cheaper {
                let last = self.last(pair);
                (last.row, last.state) = (row.number(), at as u32);
            }
        }
        best as u32
    }

    /// Sets the pairs and costs of a row's cells by the path that ends with a state.
    fn take_path(&mut self, cells: &mut [ActiveCell], last_state: u32, row: Row) {
        self.above.fill(None);
        for cell in cells.iter_mut() {
            (cell.pair, cell.cost) = (None, cell.stay);
        }
        let mut at = last_state;
        // From right to left, so that the first cell of a pair is its last one in the row.
        while at != NONE {
            let State { cell, before, pair, cost, .. } = self.states[at as usize];
            let cell = &mut cells[cell as usize];
            if let Some(key) = pair {
                (cell.pair, cell.cost) = (pair, cost);
                self.above[row.column(cell)] = pair;
                let last = self.last(key);
                if last.cursor.row() != Some(row.row as u16) {
                    last.cursor = row.cursor_after(cell);
                }
            }
            at = before;
        }
    }
}

/// A row of the screen.
#[derive(Clone, Copy)]
struct Row {
    row: usize,
    columns: usize,
}

impl Row {
    fn number(self) -> u32 {
        self.row as u32
    }

    fn column(self, cell: &ActiveCell) -> usize {
        cell.at - self.row * self.columns
    }

    fn position(self, cell: &ActiveCell) -> CellPosition {
        CellPosition { column: self.column(cell) as u16, row: self.row as u16 }
    }

    /// Returns the cursor after writing a cell of the row.
    fn cursor_after(self, cell: &ActiveCell) -> KnownCursor {
        let CellPosition { column, row } = self.position(cell);
        if usize::from(column) + 1 < self.columns {
            KnownCursor::At(CellPosition { column: column + 1, row })
        } else {
            KnownCursor::InRow(row)
        }
    }

    /// Returns the number of bytes of the move to a cell of the row.
    fn move_len(self, cursor: KnownCursor, cell: &ActiveCell) -> f32 {
        let position = self.position(cell);
        if cursor == KnownCursor::At(position) {
            return 0.0;
        }
        cheapest_len(cursor, position, Move::To(position).len()) as f32
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
