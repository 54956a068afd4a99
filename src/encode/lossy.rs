//! Lossy frames: grids that hardly differ from the wanted one and take fewer bytes to show.
//!
//! Only the picture may differ, never text. The colour of a half cell may differ up to the quality's cap in OKLab, as
//! long as the whole picture keeps its signal-to-noise ratio. A cell that already shows a near colour is not written,
//! and the other cells get colours that many of them can share (see [`palette`](super::palette)).
// Bytes at 80x24 relative to those of ratatui's backend, including the exact frame at rest, for the bench's scenes
// orbit, plain, sphere and gradient: .56, .52, .82 and .62 with `Exact`; .23, .15, .42 and .23 with `Equal`; .19,
// .10, .31 and .16 with `Fast`.

use super::Quality;
use super::halves::{Halves, Tolerance, half_block_cell, picture_halves, squared_difference};
use super::palette;
use crate::grid::{Grid, HalfBlocks, PackedInk};
use std::cmp::Reverse;

/// The limits of a quality on the difference between the shown and the wanted picture.
#[derive(Clone, Copy)]
pub(super) struct QualityCaps {
    /// The largest OKLab distance between the shown and the wanted colour of a half cell.
    distance: f32,
    /// The largest mean squared difference per channel, in 8-bit sRGB, over all half cells.
    ///
    /// A peak signal-to-noise ratio of `d` decibels is `255^2 / 10^(d / 10)`.
    mean_square: f64,
}

impl QualityCaps {
    pub(super) fn for_quality(quality: Quality) -> Option<Self> {
        match quality {
            Quality::Exact => None,
            // The mean squares correspond to signal-to-noise ratios of 44 and 41 decibels.
            Quality::Equal => Some(Self { distance: 0.01, mean_square: 2.588_6 }),
            Quality::Fast => Some(Self { distance: 0.02, mean_square: 5.165_1 }),
        }
    }
}

/// The inputs of a lossy frame.
pub(super) struct LossyFrame<'a> {
    pub(super) shown: &'a Grid,
    pub(super) wanted: &'a Grid,
    pub(super) caps: QualityCaps,
    /// The half blocks that cells may use. With both, a pair of colours can be drawn either way
    /// round.
    pub(super) half_blocks: HalfBlocks,
    /// The pen's foreground and background colours.
    pub(super) pen: [PackedInk; 2],
    /// Returns whether the cell at an index has waited long enough and is to be made exact now.
    pub(super) has_waited: &'a dyn Fn(usize) -> bool,
}

/// A cell of the picture that does not show its wanted halves.
struct Difference {
    /// The cell's index in the grid.
    at: usize,
    wanted: Halves,
    /// The halves that the terminal shows; `None` if the cell shows text or is unknown.
    shown: Option<Halves>,
    urgency: Urgency,
}

/// The urgency of writing a cell, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Urgency {
    /// The shown halves are within the tolerance and need not be written now.
    Waits,
    /// The shown halves are within the tolerance, but the cell is due to be shown exactly.
    // These cells are not ordered by the size of the difference, which is invisible: neighbours that are written in one
    // frame take the fewest bytes.
    Refines,
    /// The halves differ by more than the tolerance; the number is the larger squared difference of
    /// the two.
    Differs(u32),
    /// The cell does not show the picture yet, but text or unknown contents.
    Appears,
}

/// The differences between the shown and the wanted grid, the most urgent first.
pub(super) struct Plan<'a> {
    frame: LossyFrame<'a>,
    tolerance: Tolerance,
    differences: Vec<Difference>,
    /// The number of `differences` to write, from the first.
    writes: usize,
    /// The indices of the cells that are text in the wanted grid.
    text: Vec<usize>,
}

impl<'a> Plan<'a> {
    pub(super) fn new(frame: LossyFrame<'a>) -> Self {
        let mut plan = Self {
            tolerance: Tolerance { distance: frame.caps.distance, square: 0 },
            frame,
            differences: Vec::new(),
            writes: 0,
            text: Vec::new(),
        };
        plan.find_differences();
        plan.tolerance.square = plan.max_square();
        plan.rank_differences();
        plan
    }

    fn find_differences(&mut self) {
        let wanted = self.frame.wanted.packed();
        let shown = self.frame.shown.packed();
        for (at, &cell) in wanted.iter().enumerate() {
            let Some(wanted) = picture_halves(cell) else {
                self.text.push(at);
                continue;
            };
            let shown = picture_halves(shown[at]);
            if shown != Some(wanted) {
                self.differences.push(Difference { at, wanted, shown, urgency: Urgency::Appears });
            }
        }
    }

    /// Returns the largest squared difference of a half cell that may be tolerated without
    /// exceeding the cap on the mean.
    // Halves that differ more are written. Their new squared difference may be anything up to this value, and is
    // counted as a third of it.
    fn max_square(&self) -> u32 {
        const HISTOGRAM_LEN: usize = 1024;
        let mut counts = [0_usize; HISTOGRAM_LEN];
        for difference in &self.differences {
            let squares = difference.shown.map_or([u32::MAX; 2], |shown| squared_differences(shown, difference.wanted));
            for square in squares {
                counts[(square as usize).min(HISTOGRAM_LEN - 1)] += 1;
            }
        }
        let (mut beyond, mut sum, mut max_square) = (2 * self.differences.len(), 0.0, 0);
        for (square, count) in counts.into_iter().enumerate() {
            beyond -= count;
            sum += (square * count) as f64;
            if sum + (beyond * square) as f64 / 3.0 > self.square_budget() {
                break;
            }
            max_square = square as u32;
        }
        max_square
    }

    /// Returns the largest allowed sum of the squared differences of all half cells.
    fn square_budget(&self) -> f64 {
        let halves = 2 * (self.frame.wanted.packed().len() - self.text.len());
        self.frame.caps.mean_square * (3 * halves) as f64
    }

    fn rank_differences(&mut self) {
        for difference in &mut self.differences {
            let Some(shown) = difference.shown else { continue };
            let square = squared_differences(shown, difference.wanted).into_iter().fold(0, u32::max);
            let is_near = (0..2).all(|half| self.tolerance.allows(shown[half], difference.wanted[half]));
            difference.urgency = match (is_near, (self.frame.has_waited)(difference.at)) {
                (false, _) => Urgency::Differs(square),
                (true, true) => Urgency::Refines,
                (true, false) => Urgency::Waits,
            };
        }
        self.differences.sort_by_key(|difference| Reverse(difference.urgency));
        self.writes = self.count_from(Urgency::Refines);
    }

    fn count_from(&self, least: Urgency) -> usize {
        self.differences.partition_point(|difference| difference.urgency >= least)
    }

    /// Returns the number of picture cells to write.
    pub(super) fn write_count(&self) -> usize {
        self.writes
    }

    /// Returns the number of picture cells that must be written in this frame.
    ///
    /// They include the cells that exceed the quality's caps if `within_caps` is set.
    pub(super) fn min_writes(&self, within_caps: bool) -> usize {
        self.count_from(if within_caps { Urgency::Differs(0) } else { Urgency::Appears })
    }

    /// Returns the grid to show next: the shown one with the wanted text and the `writes` most
    /// urgent picture cells.
    pub(super) fn grid(&self, writes: usize) -> Grid {
        let (written, left) = self.differences.split_at(writes);
        let left: u64 = left.iter().filter_map(|left| Some(sum(squared_differences(left.shown?, left.wanted)))).sum();
        let max_squares =
            if writes < self.min_writes(true) { f64::INFINITY } else { self.square_budget() - left as f64 };
        let mut tolerance = self.tolerance;
        let snapped = loop {
            let snapped = self.snapped_halves(written, tolerance);
            let squares =
                snapped.iter().zip(written).map(|(&snapped, write)| sum(squared_differences(snapped, write.wanted)));
            let squares = squares.sum::<u64>() as f64;
            if squares <= max_squares || tolerance.square == 0 {
                break snapped;
            }
            // Rarely, the colours of most halves are at the tolerance, and the sum exceeds its cap. The tolerance then
            // shrinks in proportion, so that few tries are needed.
            tolerance.square = (f64::from(tolerance.square) * (max_squares / squares).clamp(0.0, 0.75)) as u32;
        };
        let mut grid = self.shown_with_text();
        for (write, halves) in written.iter().zip(snapped) {
            grid.set_packed(write.at, half_block_cell(halves, self.frame.wanted.packed()[write.at]));
        }
        grid
    }

    /// Returns the halves to write for the cells in `written`: exact ones where a cell is due,
    /// otherwise palette colours.
    fn snapped_halves(&self, written: &[Difference], tolerance: Tolerance) -> Vec<Halves> {
        let mut snapped: Vec<Halves> = written.iter().map(|write| write.wanted).collect();
        let inexact = written.iter().zip(&mut snapped).filter(|(write, _)| !(self.frame.has_waited)(write.at));
        let mut inexact: Vec<&mut Halves> = inexact.map(|(_, halves)| halves).collect();
        palette::snap_to_palette(&mut inexact, self.frame.pen, tolerance, self.frame.half_blocks);
        snapped
    }

    /// Returns the shown grid with its text cells replaced by the wanted ones.
    fn shown_with_text(&self) -> Grid {
        let mut grid = self.frame.shown.clone();
        for &at in &self.text {
            grid.copy_cell(at, self.frame.wanted, self.frame.wanted.packed()[at]);
        }
        grid
    }

    /// Returns the indices of the picture cells that differ between `grid` and the wanted grid.
    pub(super) fn inexact_cells(&self, grid: &Grid) -> impl Iterator<Item = usize> {
        let is_inexact =
            |difference: &&Difference| picture_halves(grid.packed()[difference.at]) != Some(difference.wanted);
        self.differences.iter().filter(is_inexact).map(|difference| difference.at)
    }
}

fn squared_differences(a: Halves, b: Halves) -> [u32; 2] {
    [squared_difference(a[0], b[0]), squared_difference(a[1], b[1])]
}

fn sum(squares: [u32; 2]) -> u64 {
    u64::from(squares[0]) + u64::from(squares[1])
}
