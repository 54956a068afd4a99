//! Shifts of what the terminal shows: cells that it moves itself instead of being sent them again.
//!
//! When the camera turns, most of the new picture is the old one some columns or rows further. A terminal moves the
//! cells of a row by ICH and DCH, and whole rows by IL and DL, each of which takes fewer bytes than one written cell. A
//! frame shifts at most one [window](windows) of rows. In each row it shifts all cells, or those of at most three
//! windows: the best one, and the best one on each side of it, which save 1 % of an exact frame's bytes and 4 % of an
//! equal one's (200x60). Compared with one window, a full edit script for each row would improve the picture by 0.3 dB,
//! in forty times the time.
//!
//! A window is worth its bytes if the errors of its cells shrink by more than the exchange rate of the frame demands.
//! Cells that a shift vacates have unknown contents, because terminals disagree on the background of what comes in.
//! They are written in the same frame, and their bytes are part of the price of the shift.
//!
//! Each shift deletes before it inserts: otherwise cells to the right or below would leave the screen. Windows consist
//! of picture cells only. What is to the right of a window, or below it, moves away and back within the frame, so
//! frames with shifts have to be enclosed in synchronized output.

use super::moves::{CellPosition, KnownCursor, Move, cheapest_move, write_sequence};
use crate::capabilities::Shifts;
use crate::grid::{Grid, PackedCell, Size};
use planes::{Planes, put_errors};
use std::ops::Range;
use windows::{Places, Prices, Window, best_window};

mod planes;
mod windows;

/// The terms on which a frame may shift cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShiftTerms {
    /// The squared error of a cell at which writing the cell is the cheaper way: larger errors
    /// count as this one.
    limit: u16,
    /// The number of bytes that writing a cell takes.
    bytes_per_cell: u32,
    /// The largest number of bytes for operations and for writing the vacated cells.
    max_bytes: usize,
}

impl ShiftTerms {
    /// The terms of exact frames, in which only equal cells are worth anything.
    pub(super) const EXACT: Self = Self { limit: 1, bytes_per_cell: 20, max_bytes: usize::MAX };

    /// The terms of frames that look equal.
    // Just above the error of a cell whose six channels are all off by two: 24.
    pub(super) const EQUAL: Self = Self { limit: 25, bytes_per_cell: 7, max_bytes: usize::MAX };

    /// Returns the terms at an exchange rate: the squared error that each byte has to remove.
    pub(super) fn at_rate(rate: f32, max_bytes: usize) -> Self {
        let Self { bytes_per_cell, .. } = Self::EQUAL;
        let limit = (rate * bytes_per_cell as f32).clamp(1.0, f32::from(u16::MAX)) as u16;
        Self { limit, bytes_per_cell, max_bytes }
    }

    /// Returns the prices of one and of two operations.
    fn prices(&self, OperationLens { one, two, .. }: OperationLens) -> Prices {
        Prices { one: self.price(one), two: self.price(two) }
    }

    /// Returns the price of a number of bytes, as the error that they have to remove.
    fn price(&self, bytes: usize) -> i64 {
        (bytes.cast_signed() as i64 * i64::from(self.limit) / i64::from(self.bytes_per_cell)).max(1)
    }

    /// Returns the number of bytes of a shift: its operations, and writing the cells that it
    /// vacates.
    fn bytes(&self, operations: usize, vacated: usize) -> usize {
        operations.saturating_add(vacated.saturating_mul(self.bytes_per_cell as usize))
    }
}

/// The lengths in bytes of the operations of a window, moves of the cursor included.
#[derive(Clone, Copy)]
struct OperationLens {
    /// The length of the operation that shifts all cells of a row, in the first column.
    full_row: usize,
    /// The length of another single operation.
    one: usize,
    /// The length of two operations.
    two: usize,
}

impl OperationLens {
    // The moves of the cursor are often shorter than absolute ones would be. tmux passes each operation on with a pen
    // and a cursor of its own before and after it.
    const fn of(shifts: Shifts) -> Self {
        match shifts {
            Shifts::ThroughTmux => Self { full_row: 27, one: 27, two: 54 },
            Shifts::Off | Shifts::Direct => Self { full_row: 6, one: 8, two: 15 },
        }
    }

    /// Returns the number of bytes of the operations of a window of a row.
    fn of_window(self, window: Window, columns: usize) -> usize {
        if window.end < columns {
            self.two
        } else if window.start > 0 {
            self.one
        } else {
            self.full_row
        }
    }
}

/// The working memory of shifts.
#[derive(Default)]
pub(super) struct ShiftMemory {
    /// The indices in the grid of the cells that the last shifts have vacated, in reading order.
    pub(super) vacated: Vec<u32>,
    shown: Planes,
    wanted: Planes,
    stay: Vec<u16>,
    shifted: Vec<u16>,
    /// The sum of the errors of all places before each place, if nothing is shifted.
    sums: Vec<i64>,
    shifted_sums: Vec<i64>,
    chosen: Vec<RowShift>,
}

/// A window of a row, and the number of bytes that shifting it takes.
struct RowShift {
    row: usize,
    window: Window,
    bytes: usize,
}

impl RowShift {
    /// Returns the row and the first column.
    fn place(&self) -> (usize, usize) {
        (self.row, self.window.start)
    }
}

impl ShiftMemory {
    /// Shifts what the terminal shows towards what is wanted, where that is the cheaper way:
    /// appends the operations, and updates `shown`.
    ///
    /// Returns whether anything has been shifted; `before` is then a copy of what was shown.
    pub(super) fn shift(
        &mut self,
        [shown, before]: [&mut Grid; 2],
        wanted: &Grid,
        (shifts, terms): (Shifts, ShiftTerms),
        bytes: &mut Vec<u8>,
    ) -> bool {
        self.vacated.clear();
        let lens = OperationLens::of(shifts);
        if shifts == Shifts::Off || terms.max_bytes < terms.bytes(lens.full_row, 1) || shown.packed() == wanted.packed()
        {
            return false;
        }
        self.shown.fill(shown);
        self.wanted.fill(wanted);
        let mut left = terms.max_bytes;
        let rows = self.best_rows(terms, lens, shown.size());
        if let Some((window, taken)) = rows {
            before.clone_from(shown);
            left -= taken;
            write_row_shift(window, shown.size(), bytes);
            let columns = usize::from(shown.size().columns);
            let cells = window.start * columns..window.end * columns;
            shift_cells(shown, cells, window.by * columns.cast_signed(), &mut self.vacated);
            self.shown.fill(shown);
        }
        self.choose_columns(terms, lens, left, shown);
        if self.chosen.is_empty() {
            return rows.is_some();
        }
        if rows.is_none() {
            before.clone_from(shown);
        }
        let (size, mut cursor) = (shown.size(), KnownCursor::Unknown);
        for &RowShift { row, window, .. } in &self.chosen {
            write_column_shift(row, window, size, cursor, bytes);
            cursor = KnownCursor::InRow(row as u16);
            let start = row * usize::from(size.columns);
            shift_cells(shown, start + window.start..start + window.end, window.by, &mut self.vacated);
        }
        self.vacated.sort_unstable();
        true
    }

    /// Returns the best window of rows, and the number of bytes that it takes.
    fn best_rows(&mut self, terms: ShiftTerms, lens: OperationLens, size: Size) -> Option<(Window, usize)> {
        let (columns, rows) = (usize::from(size.columns), usize::from(size.rows));
        let prices = terms.prices(lens);
        self.stay.resize(columns, 0);
        self.shifted.resize(columns, 0);
        self.sums.clear();
        self.sums.push(0);
        for row in 0..rows {
            let at = row * columns;
            put_errors([&self.shown, &self.wanted], [at, at], terms.limit, &mut self.stay);
            self.sums.push(self.sums[row] + sum(&self.stay));
        }
        // Nothing is gained beyond the errors that there are.
        if self.sums[rows] <= prices.one {
            return None;
        }
        let Self { shown, wanted, shifted, sums, shifted_sums, .. } = self;
        let mut best: Option<(Window, usize)> = None;
        for by in [1, -1, 2, -2_isize] {
            let taken = terms.bytes(lens.two, by.unsigned_abs() * columns);
            if taken > terms.max_bytes {
                continue;
            }
            for segment in segments(0..rows, |row| shown.is_picture_row(row) && wanted.is_picture_row(row)) {
                let most = i64::from(terms.limit) * columns.cast_signed() as i64;
                let places = Places { sums: &sums[segment.start..=segment.end], most };
                shifted_sums.clear();
                for row in segment.clone() {
                    let from = row.checked_add_signed(by).filter(|from| segment.contains(from));
                    shifted_sums.push(from.map_or(0, |from| {
                        put_errors([&*shown, &*wanted], [from * columns, row * columns], terms.limit, shifted);
                        sum(shifted)
                    }));
                }
                let window = best_window(&places, |row| shifted_sums[row], by, prices, segment.end == rows);
                if let Some(window) = window.filter(|window| best.is_none_or(|(best, _)| window.gain > best.gain)) {
                    best = Some((window.moved_by(segment.start), taken));
                }
            }
        }
        best
    }

    /// Lists the best windows of the rows: those with the largest gain for their bytes, up to
    /// `max_bytes`.
    fn choose_columns(&mut self, terms: ShiftTerms, lens: OperationLens, max_bytes: usize, shown: &Grid) {
        let Size { columns, rows } = shown.size();
        self.chosen.clear();
        for row in 0..usize::from(rows) {
            let cells = shown.packed_row_from(0, row as u16);
            // Terminals disagree on the columns of clusters, and on wide characters that are cut.
            if cells.iter().any(|cell| cell.is_cluster() || cell.is_covered() || cell.is_foreign()) {
                continue;
            }
            let columns = columns.into();
            let windows = self.windows_of_row(row, columns, terms, lens);
            let full = self.full_row(row, &windows, columns, terms, lens);
            let windows = if full.is_some() { [full, None, None] } else { windows };
            for window in windows.into_iter().flatten() {
                let bytes = terms.bytes(lens.of_window(window, columns), window.by.unsigned_abs());
                self.chosen.push(RowShift { row, window, bytes });
            }
        }
        let per_byte = |shift: &RowShift| shift.window.gain as f64 / shift.bytes as f64;
        self.chosen.sort_unstable_by(|a, b| per_byte(b).total_cmp(&per_byte(a)).then(a.place().cmp(&b.place())));
        let mut left = max_bytes;
        self.chosen.retain(|shift| {
            let fits = shift.bytes <= left;
            if fits {
                left -= shift.bytes;
            }
            fits
        });
        self.chosen.sort_unstable_by_key(RowShift::place);
    }

    /// Returns the best window of a row, and the best one on each side of it, from left to right.
    fn windows_of_row(
        &mut self,
        row: usize,
        columns: usize,
        terms: ShiftTerms,
        lens: OperationLens,
    ) -> [Option<Window>; 3] {
        let mut best_of = |part: Range<usize>| self.best_columns(row, part, columns, terms, lens);
        let Some(best) = best_of(0..columns) else { return [None; 3] };
        [best_of(0..best.start), Some(best), best_of(best.end..columns)]
    }

    /// Returns the shift of all cells of a row, if it gains more than the row's best windows or, as
    /// much in fewer bytes.
    ///
    /// The distances of these windows are tried, and that of the row above.
    // The cursor gets to the next row's first column by CR and LF. Where a picture moves as a whole, windows that begin
    // elsewhere took up to 4 bytes more in each row: without full rows the PSNR is 0.5 dB lower at 200x60 with 1.0 kB a
    // frame, and 0.15 dB with 1.7 kB.
    fn full_row(
        &mut self,
        row: usize,
        windows: &[Option<Window>; 3],
        columns: usize,
        terms: ShiftTerms,
        lens: OperationLens,
    ) -> Option<Window> {
        let above = self.distance_of_row_above(row);
        let start = row * columns;
        let Self { shown, wanted, stay, shifted, .. } = self;
        if !shown.is_picture_row(row) || !wanted.is_picture_row(row) {
            return None;
        }
        stay.resize(columns, 0);
        put_errors([&*shown, &*wanted], [start, start], terms.limit, stay);
        let stay = sum(stay);
        let bytes = |window: &Window| terms.bytes(lens.of_window(*window, columns), window.by.unsigned_abs());
        let windows = windows.iter().flatten();
        let mut best_gain = windows.clone().map(|window| window.gain).sum::<i64>();
        let mut fewest_bytes = windows.clone().map(bytes).sum::<usize>();
        let mut best = None;
        for by in windows.map(|window| window.by).chain(above) {
            let distance = by.unsigned_abs();
            let (from, to) = if by > 0 { (distance, 0) } else { (0, distance) };
            shifted.resize(columns - distance, 0);
            put_errors([&*shown, &*wanted], [start + from, start + to], terms.limit, shifted);
            let vacated = i64::from(terms.limit) * distance.cast_signed() as i64;
            let gain = stay - sum(shifted) - vacated - terms.price(lens.full_row);
            let window = Window { start: 0, end: columns, by, gain };
            let bytes = bytes(&window);
            if gain > best_gain || gain == best_gain && bytes < fewest_bytes {
                (best_gain, fewest_bytes, best) = (gain, bytes, Some(window));
            }
        }
        best
    }

    /// Returns the distance of the last window of the row above a row.
    fn distance_of_row_above(&self, row: usize) -> Option<isize> {
        self.chosen.last().filter(|shift| shift.row + 1 == row).map(|shift| shift.window.by)
    }

    /// Returns the best window in a part of a row.
    fn best_columns(
        &mut self,
        row: usize,
        part: Range<usize>,
        columns: usize,
        terms: ShiftTerms,
        lens: OperationLens,
    ) -> Option<Window> {
        let prices = terms.prices(lens);
        // Most rows move as the one above. With its distance tried first, `most_gain` rules out most others without a
        // search.
        let likely = self.distance_of_row_above(row);
        let Self { shown, wanted, stay, shifted, sums, .. } = self;
        let start = row * columns;
        let mut best: Option<Window> = None;
        for segment in segments(part, |column| shown.is_picture(start + column) && wanted.is_picture(start + column)) {
            let (at, len) = (start + segment.start, segment.len());
            stay.resize(len, 0);
            put_errors([&*shown, &*wanted], [at, at], terms.limit, stay);
            if sum(stay) <= prices.one {
                continue;
            }
            sums.clear();
            sums.push(0);
            let mut sum_so_far = 0;
            sums.extend(stay.iter().map(|&error| {
                sum_so_far += i64::from(error);
                sum_so_far
            }));
            let places = Places { sums, most: terms.limit.into() };
            let farthest = farthest(columns).min(len - 1).cast_signed();
            let likely = likely.filter(|by| by.unsigned_abs() < len);
            let others = (1..=farthest).flat_map(|by| [by, -by]).filter(|&by| Some(by) != likely);
            for by in likely.into_iter().chain(others) {
                let (from, to) = if by > 0 { (by.unsigned_abs(), 0) } else { (0, by.unsigned_abs()) };
                shifted.resize(len - by.unsigned_abs(), 0);
                put_errors([&*shown, &*wanted], [at + from, at + to], terms.limit, shifted);
                let least = best.map_or(0, |best| best.gain);
                if most_gain(&stay[to..], shifted) <= least + prices.one {
                    continue;
                }
                let error = |place: usize| i64::from(shifted[place - to]);
                let window = best_window(&places, error, by, prices, segment.end == columns);
                if let Some(window) = window.filter(|window| window.gain > least) {
                    best = Some(window.moved_by(segment.start));
                }
            }
        }
        best
    }
}

/// Returns the greatest number of columns by which cells are shifted.
// A turn of the camera moves the picture by a share of its width.
fn farthest(columns: usize) -> usize {
    (columns / 10).clamp(1, 16)
}

/// Returns the maximal ranges of consecutive places that satisfy `is_good`.
fn segments(places: Range<usize>, mut is_good: impl FnMut(usize) -> bool) -> impl Iterator<Item = Range<usize>> {
    let Range { start: mut next, end } = places;
    std::iter::from_fn(move || {
        let start = (next..end).find(|&place| is_good(place))?;
        next = (start..end).find(|&place| !is_good(place)).unwrap_or(end);
        Some(start..next)
    })
}

// A row has at most 65,535 cells, whose errors add up to less than 2^32.
fn sum(errors: &[u16]) -> i64 {
    errors.iter().map(|&error| u32::from(error)).sum::<u32>().into()
}

/// Returns the sum of all gains, without the losses.
fn most_gain(stay: &[u16], shifted: &[u16]) -> i64 {
    stay.iter().zip(shifted).map(|(stay, shifted)| u32::from(stay.saturating_sub(*shifted))).sum::<u32>().into()
}

/// Moves a range of cells by `by` cells towards its start, or if negative towards its end. Lists
/// the vacated cells, which are unknown.
fn shift_cells(grid: &mut Grid, cells: Range<usize>, by: isize, vacated: &mut Vec<u32>) {
    let distance = by.unsigned_abs();
    let unknown = if by > 0 {
        for to in cells.start..cells.end - distance {
            grid.set_packed(to, grid.packed()[to + distance]);
        }
        cells.end - distance..cells.end
    } else {
        for to in (cells.start + distance..cells.end).rev() {
            grid.set_packed(to, grid.packed()[to - distance]);
        }
        cells.start..cells.start + distance
    };
    for at in unknown {
        grid.set_packed(at, PackedCell::FOREIGN);
        vacated.push(at as u32);
    }
}

/// Appends the operations of a window of a row: DCH and ICH, or one if it has the last column.
// A terminal that moves the cursor by an operation leaves it in the row, where CR or CHA finds any column.
fn write_column_shift(row: usize, window: Window, size: Size, cursor: KnownCursor, bytes: &mut Vec<u8>) {
    let distance = window.by.unsigned_abs();
    let (delete, insert) = places(window);
    let (is_cut, is_last) = (window.by > 0, window.end == usize::from(size.columns));
    let row = row as u16;
    let position = |column: usize| CellPosition { column: column as u16, row };
    // An insertion in a window that ends with the row pushes cells off the screen: none has to be deleted first.
    if is_cut || !is_last {
        cheapest_move(cursor, position(delete)).write(bytes);
        write_operation(distance, b'P', bytes);
        if is_cut && is_last {
            return;
        }
        cheapest_move(KnownCursor::InRow(row), position(insert)).write(bytes);
    } else {
        cheapest_move(cursor, position(insert)).write(bytes);
    }
    write_operation(distance, b'@', bytes);
}

/// Appends the operations of a window of rows: DL and IL, or one if the window has the last row.
fn write_row_shift(window: Window, size: Size, bytes: &mut Vec<u8>) {
    let distance = window.by.unsigned_abs();
    let (delete, insert) = places(window);
    let is_last = window.end == usize::from(size.rows);
    let to = |row: usize| Move::To(CellPosition { column: 0, row: row as u16 });
    if window.by > 0 || !is_last {
        to(delete).write(bytes);
        write_operation(distance, b'M', bytes);
    }
    if window.by < 0 || !is_last {
        to(insert).write(bytes);
        write_operation(distance, b'L', bytes);
    }
}

/// Returns the places at which a shift deletes, and then inserts.
fn places(Window { start, end, by, .. }: Window) -> (usize, usize) {
    let other = end - by.unsigned_abs();
    if by > 0 { (start, other) } else { (other, start) }
}

/// Appends the sequence that deletes or inserts a number of cells or rows.
fn write_operation(count: usize, last: u8, bytes: &mut Vec<u8>) {
    if count == 1 {
        bytes.extend_from_slice(&[b'\x1b', b'[', last]);
    } else {
        write_sequence(bytes, count as u16, last);
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
