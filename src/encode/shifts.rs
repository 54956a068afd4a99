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

use super::halves::{NO_PICTURE, PictureHalves};
use super::moves::KnownCursor;
use crate::capabilities::Shifts;
use crate::grid::{Grid, PackedCell, Size};
use crate::lanes::{F32x8, LANES};
use crate::simd::dispatch;
use operations::{write_column_shift, write_row_shift};
use planes::{Planes, PutRowErrors, PutShiftedErrors};
use std::ops::Range;
use windows::{Distances, MOST_DISTANCE, PlaceErrors, Prices, Window};

mod operations;
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
    fn price(&self, bytes: usize) -> f32 {
        (bytes * usize::from(self.limit) / self.bytes_per_cell as usize).max(1) as f32
    }

    /// Returns the greatest error of a cell.
    fn most(&self) -> f32 {
        f32::from(self.limit)
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
    /// The errors of the rows of the screen, and then those of the cells of a row.
    errors: PlaceErrors,
    /// The errors of the cells of a row, of which only the sum is used.
    of_cells: Vec<F32x8>,
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
    /// `halves` are those of `shown`, which are updated too, and of the wanted grid.
    ///
    /// Returns whether anything has been shifted; `before` is then a copy of what was shown.
    pub(super) fn shift(
        &mut self,
        [shown, before]: [&mut Grid; 2],
        halves: &mut PictureHalves,
        (shifts, terms): (Shifts, ShiftTerms),
        bytes: &mut Vec<u8>,
    ) -> bool {
        self.vacated.clear();
        let lens = OperationLens::of(shifts);
        if terms.max_bytes < terms.bytes(lens.full_row, 1) || halves.shown == halves.wanted {
            return false;
        }
        let size = shown.size();
        self.shown.fill(&halves.shown, size);
        self.wanted.fill(&halves.wanted, size);
        let mut left = terms.max_bytes;
        let rows = self.best_rows(terms, lens, size);
        if let Some((window, taken)) = rows {
            before.clone_from(shown);
            left -= taken;
            write_row_shift(window, size, bytes);
            let columns = usize::from(size.columns);
            let cells = window.start * columns..window.end * columns;
            self.vacate(shown, halves, cells, window.by * columns.cast_signed());
            self.shown.fill(&halves.shown, size);
        }
        self.choose_columns(terms, lens, left, shown);
        if self.chosen.is_empty() {
            return rows.is_some();
        }
        if rows.is_none() {
            before.clone_from(shown);
        }
        let mut cursor = KnownCursor::Unknown;
        for at in 0..self.chosen.len() {
            let RowShift { row, window, .. } = self.chosen[at];
            write_column_shift(row, window, size, cursor, bytes);
            cursor = KnownCursor::InRow(row as u16);
            let start = row * usize::from(size.columns);
            self.vacate(shown, halves, start + window.start..start + window.end, window.by);
        }
        self.vacated.sort_unstable();
        true
    }

    /// Moves a range of cells of the shown grid, and their halves, by `by` cells towards its start,
    /// or if negative towards its end. Lists the vacated cells, which are unknown.
    fn vacate(&mut self, shown: &mut Grid, halves: &mut PictureHalves, cells: Range<usize>, by: isize) {
        let Range { start, end } = cells;
        let distance = by.unsigned_abs();
        let (moved, to, vacated) = if by > 0 {
            (start + distance..end, start, end - distance..end)
        } else {
            (start..end - distance, start + distance, start..start + distance)
        };
        shown.copy_within(moved.clone(), to);
        halves.shown.copy_within(moved, to);
        halves.shown[vacated.clone()].fill(NO_PICTURE);
        for at in vacated {
            shown.set_packed(at, PackedCell::FOREIGN);
            self.vacated.push(at as u32);
        }
    }

    /// Returns the best window of rows, and the number of bytes that it takes.
    fn best_rows(&mut self, terms: ShiftTerms, lens: OperationLens, size: Size) -> Option<(Window, usize)> {
        let (columns, rows) = (usize::from(size.columns), usize::from(size.rows));
        let taken = |distance: usize| terms.bytes(lens.two, distance * columns);
        let farthest = (1..=FARTHEST_ROW).rev().find(|&distance| taken(distance) <= terms.max_bytes)?;
        let distances = Distances { farthest };
        self.errors.distances = distances;
        self.errors.stay.clear();
        self.errors.stay.resize(rows.div_ceil(LANES), F32x8::ZERO);
        for row in 0..rows {
            self.errors.stay[row / LANES].0[row % LANES] = self.row_error([row, row], terms);
        }
        self.errors.sum_up(rows);
        let prices = terms.prices(lens);
        // Nothing is gained beyond the errors that there are.
        if self.errors.staying(0..rows) <= prices.one {
            return None;
        }
        let groups = distances.groups().len();
        self.errors.shifted.clear();
        self.errors.shifted.resize(rows * groups, F32x8::ZERO);
        for row in 0..rows {
            for by in (1..=farthest.cast_signed()).flat_map(|by| [by, -by]) {
                let Some(from) = row.checked_add_signed(by).filter(|&from| from < rows) else { continue };
                let (group, lane) = distances.slot(by);
                self.errors.shifted[row * groups + group].0[lane] = self.row_error([from, row], terms);
            }
        }
        let Self { shown, wanted, errors, .. } = self;
        let most = terms.most() * columns as f32;
        let is_picture = |row| shown.is_picture_row(row) && wanted.is_picture_row(row);
        let best = best_of_segments(segments(0..rows, is_picture), |segment| {
            let is_last = segment.end == rows;
            errors.best_window(segment, most, prices, is_last, None)
        })?;
        Some((best, taken(best.by.unsigned_abs())))
    }

    /// Returns the error of a row of the wanted picture that comes from a row of the shown one.
    fn row_error(&mut self, [from, to]: [usize; 2], terms: ShiftTerms) -> f32 {
        let Self { shown, wanted, of_cells, .. } = self;
        dispatch(PutRowErrors { rows: [(shown, from), (wanted, to)], limit: terms.most(), errors: of_cells })
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
            if self.put_staying_errors(row, columns, terms) <= terms.price(lens.full_row.min(lens.one)) {
                continue;
            }
            self.put_shifted_errors(row, columns, terms);
            let windows = self.windows_of_row(row, columns, terms, lens);
            let full = self.full_row(row, &windows, columns, terms, lens);
            let windows = if full.is_some() { [full, None, None] } else { windows };
            for window in windows.into_iter().flatten() {
                let bytes = terms.bytes(lens.of_window(window, columns), window.by.unsigned_abs());
                self.chosen.push(RowShift { row, window, bytes });
            }
        }
        let per_byte = |shift: &RowShift| f64::from(shift.window.gain) / shift.bytes as f64;
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

    /// Sets the errors of the cells of a row if nothing is shifted, and returns their sum.
    fn put_staying_errors(&mut self, row: usize, columns: usize, terms: ShiftTerms) -> f32 {
        let Self { shown, wanted, errors, .. } = self;
        let rows = [(&*shown, row), (&*wanted, row)];
        let sum = dispatch(PutRowErrors { rows, limit: terms.most(), errors: &mut errors.stay });
        errors.sum_up(columns);
        sum
    }

    /// Sets the errors of the cells of a row that come from other columns.
    fn put_shifted_errors(&mut self, row: usize, columns: usize, terms: ShiftTerms) {
        let Self { shown, wanted, errors, .. } = self;
        let distances = Distances { farthest: farthest(columns) };
        errors.distances = distances;
        let errors = &mut errors.shifted;
        dispatch(PutShiftedErrors { shown, wanted, row, limit: terms.most(), distances, errors });
    }

    /// Returns the best window of a row, and the best one on each side of it, from left to right.
    fn windows_of_row(
        &self,
        row: usize,
        columns: usize,
        terms: ShiftTerms,
        lens: OperationLens,
    ) -> [Option<Window>; 3] {
        let Self { shown, wanted, errors, .. } = self;
        let (prices, start) = (terms.prices(lens), row * columns);
        let is_picture = |column| shown.is_picture(start + column) && wanted.is_picture(start + column);
        // Where several distances gain the same, most rows move as the one above.
        let likely = self.distance_of_row_above(row);
        let best_of = |part: Range<usize>| {
            best_of_segments(segments(part, is_picture), |segment| {
                let is_last = segment.end == columns;
                errors.best_window(segment, terms.most(), prices, is_last, likely)
            })
        };
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
        &self,
        row: usize,
        windows: &[Option<Window>; 3],
        columns: usize,
        terms: ShiftTerms,
        lens: OperationLens,
    ) -> Option<Window> {
        let above = self.distance_of_row_above(row);
        let Self { shown, wanted, errors, .. } = self;
        if !shown.is_picture_row(row) || !wanted.is_picture_row(row) {
            return None;
        }
        let stay = errors.staying(0..columns);
        let bytes = |window: &Window| terms.bytes(lens.of_window(*window, columns), window.by.unsigned_abs());
        let windows = windows.iter().flatten();
        let mut best_gain = windows.clone().map(|window| window.gain).sum::<f32>();
        let mut fewest_bytes = windows.clone().map(bytes).sum::<usize>();
        let mut best = None;
        for by in windows.map(|window| window.by).chain(above) {
            let distance = by.unsigned_abs();
            let filled = if by > 0 { 0..columns - distance } else { distance..columns };
            let errors = errors.shifted_by(by, filled) + terms.most() * distance as f32;
            let gain = stay - errors - terms.price(lens.full_row);
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
}

/// The greatest number of rows by which rows are shifted.
const FARTHEST_ROW: usize = 2;

/// Returns the greatest number of columns by which cells are shifted.
// A turn of the camera moves the picture by a share of its width.
fn farthest(columns: usize) -> usize {
    (columns / 10).clamp(1, MOST_DISTANCE)
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

/// Returns the best of the windows of some segments.
fn best_of_segments(
    segments: impl Iterator<Item = Range<usize>>,
    best_window: impl Fn(Range<usize>) -> Option<Window>,
) -> Option<Window> {
    let mut best: Option<Window> = None;
    for window in segments.filter_map(best_window) {
        if best.is_none_or(|best| window.gain > best.gain) {
            best = Some(window);
        }
    }
    best
}

#[cfg(all(test, unit_tests))]
mod tests;
