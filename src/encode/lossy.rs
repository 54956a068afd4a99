//! Lossy frames: grids that hardly differ from the wanted one and take fewer bytes to show.
//!
//! Only the picture may differ, never text. The colour of a half cell may differ up to the quality's cap in OKLab, as
//! long as the whole picture keeps its signal-to-noise ratio. A cell that already shows a near colour is not written,
//! and the other cells get colours that many of them can share (see [`palette`](super::palette)).
// Bytes at 80x24 relative to those of ratatui's backend, including the exact frame at rest, for the bench's scenes
// orbit, plain, sphere and gradient: .56, .52, .82 and .62 with `Exact`; .23, .15, .42 and .23 with `Equal`; .19,
// .10, .31 and .16 with `Fast`.

use super::Quality;
use super::change_times::ChangeTimes;
use super::halves::{Halves, Tolerance, half_block_cell, picture_halves, squared_difference};
use super::palette::Reduction;
use crate::grid::{Grid, HalfBlocks, PackedInk};
use std::cell::RefCell;
use std::cmp::Reverse;

/// The working memory of a frame, which all encoders of a thread share.
#[derive(Default)]
struct Scratch {
    differences: Vec<Difference>,
    /// The indices of the cells that are text in the wanted grid.
    text: Vec<usize>,
    /// The indices in `differences` of the cells to write inexactly; `snapped` has their halves.
    inexact: Vec<usize>,
    snapped: Vec<Halves>,
    reduction: Reduction,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// The share of the full tolerance that the last frames could use, from 0.05 to 1.
///
/// The next frame starts with this share, and so seldom needs a second try.
#[derive(Clone, Copy, Debug)]
pub(super) struct UsedPart(f64);

impl Default for UsedPart {
    fn default() -> Self {
        Self(1.0)
    }
}

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
    pub(super) change_times: &'a ChangeTimes,
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

/// The differences between the shown and the wanted grid.
pub(super) struct Plan<'a> {
    frame: LossyFrame<'a>,
    tolerance: Tolerance,
    scratch: &'a mut Scratch,
    /// The number of differences to write, from the first.
    writes: usize,
    /// Whether the differences to write are in order, the most urgent first.
    is_sorted: bool,
}

/// Calls `draw` with the plan of a frame.
pub(super) fn with_plan<T>(frame: LossyFrame<'_>, draw: impl FnOnce(&mut Plan<'_>) -> T) -> T {
    SCRATCH.with_borrow_mut(|scratch| draw(&mut Plan::new(frame, scratch)))
}

/// A bound on the error of OKLab distances that are computed with approximate cube roots.
const DISTANCE_ERROR: f32 = 4e-6;

impl<'a> Plan<'a> {
    fn new(frame: LossyFrame<'a>, scratch: &'a mut Scratch) -> Self {
        let tolerance = Tolerance { distance: frame.caps.distance - DISTANCE_ERROR, square: 0 };
        let mut plan = Self { tolerance, frame, scratch, writes: 0, is_sorted: false };
        plan.find_differences();
        plan.tolerance.square = plan.max_square();
        plan.rank_differences();
        plan
    }

    fn find_differences(&mut self) {
        let wanted = self.frame.wanted.packed();
        let shown = self.frame.shown.packed();
        let Scratch { differences, text, .. } = &mut *self.scratch;
        differences.clear();
        text.clear();
        for (at, (&cell, &shown)) in wanted.iter().zip(shown).enumerate() {
            let Some(wanted) = picture_halves(cell) else {
                text.push(at);
                continue;
            };
            let shown = picture_halves(shown);
            if shown != Some(wanted) {
                differences.push(Difference { at, wanted, shown, urgency: Urgency::Appears });
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
        for difference in &self.scratch.differences {
            let squares = difference.shown.map_or([u32::MAX; 2], |shown| squared_differences(shown, difference.wanted));
            for square in squares {
                counts[(square as usize).min(HISTOGRAM_LEN - 1)] += 1;
            }
        }
        let (mut beyond, mut sum, mut max_square) = (2 * self.scratch.differences.len(), 0.0, 0);
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
        let halves = 2 * (self.frame.wanted.packed().len() - self.scratch.text.len());
        self.frame.caps.mean_square * (3 * halves) as f64
    }

    /// Finds the urgency of all differences, and puts those to write first.
    fn rank_differences(&mut self) {
        let LossyFrame { change_times, .. } = self.frame;
        let differences = &mut self.scratch.differences;
        for at in 0..differences.len() {
            let difference = &mut differences[at];
            if let Some(shown) = difference.shown {
                let square = squared_differences(shown, difference.wanted).into_iter().fold(0, u32::max);
                let is_near = square <= self.tolerance.square
                    && (0..2).all(|half| self.tolerance.allows(shown[half], difference.wanted[half]));
                difference.urgency = match (is_near, is_near && change_times.has_waited(difference.at)) {
                    (false, _) => Urgency::Differs(square),
                    (true, true) => Urgency::Refines,
                    (true, false) => Urgency::Waits,
                };
            }
            if difference.urgency >= Urgency::Refines {
                differences.swap(at, self.writes);
                self.writes += 1;
            }
        }
    }

    /// Sorts the differences to write, the most urgent first.
    // Only for frames that do not fit: in others the order does not matter.
    fn sort(&mut self) {
        if !self.is_sorted {
            let written = &mut self.scratch.differences[..self.writes];
            written.sort_unstable_by_key(|difference| (Reverse(difference.urgency), difference.at));
            self.is_sorted = true;
        }
    }

    fn count_from(&self, least: Urgency) -> usize {
        self.scratch.differences[..self.writes].iter().filter(|difference| difference.urgency >= least).count()
    }

    /// Returns the number of picture cells to write.
    pub(super) fn write_count(&self) -> usize {
        self.writes
    }

    /// Returns the number of picture cells that must be written in this frame.
    ///
    /// They are those that replace text or unknown contents and, with `within_caps`, those that exceed the quality's
    /// caps.
    pub(super) fn min_writes(&self, within_caps: bool) -> usize {
        self.count_from(if within_caps { Urgency::Differs(0) } else { Urgency::Appears })
    }

    /// Draws the wanted text and the `writes` most urgent picture cells into `grid`.
    ///
    /// `grid` must be a copy of the shown grid.
    pub(super) fn draw(&mut self, writes: usize, used: &mut UsedPart, grid: &mut Grid) {
        if writes < self.writes {
            self.sort();
        }
        self.find_inexact(writes);
        self.snap(writes, used);
        let Scratch { differences, text, inexact, snapped, .. } = &*self.scratch;
        let wanted = self.frame.wanted;
        for &at in text {
            grid.copy_cell(at, wanted, wanted.packed()[at]);
        }
        for &Difference { at, wanted: halves, .. } in &differences[..writes] {
            grid.set_packed(at, half_block_cell(halves, wanted.packed()[at]));
        }
        for (&inexact, &halves) in inexact.iter().zip(snapped) {
            let at = differences[inexact].at;
            grid.set_packed(at, half_block_cell(halves, wanted.packed()[at]));
        }
    }

    /// Lists the first `writes` differences without the cells that are due to be exact.
    fn find_inexact(&mut self, writes: usize) {
        let Scratch { differences, inexact, .. } = &mut *self.scratch;
        inexact.clear();
        inexact.extend((0..writes).filter(|&at| !self.frame.change_times.has_waited(differences[at].at)));
    }

    /// Chooses palette colours for the cells that need not be exact.
    fn snap(&mut self, writes: usize, used: &mut UsedPart) {
        let square = |difference: &Difference| Some(sum(squared_differences(difference.shown?, difference.wanted)));
        let left: u64 = self.scratch.differences[writes..].iter().filter_map(square).sum();
        let is_whole = writes >= self.min_writes(true);
        let max_squares = if is_whole { self.square_budget() - left as f64 } else { f64::INFINITY };
        let LossyFrame { pen, half_blocks, .. } = self.frame;
        let Scratch { differences, inexact, snapped, reduction, .. } = &mut *self.scratch;
        let mut tolerance = self.tolerance;
        let full = f64::from(tolerance.square);
        if is_whole {
            tolerance.square = (full * used.0) as u32;
        }
        loop {
            snapped.clear();
            snapped.extend(inexact.iter().map(|&at| differences[at].wanted));
            reduction.snap(snapped, pen, tolerance, half_blocks);
            let of_cell = |(&at, &halves): (&usize, &Halves)| sum(squared_differences(halves, differences[at].wanted));
            let squares = inexact.iter().zip(&*snapped).map(of_cell).sum::<u64>() as f64;
            if squares <= max_squares || tolerance.square == 0 {
                if is_whole && full > 0.0 {
                    // The used share grows only while the error is well below its cap, so that the next frame does not
                    // exceed the cap.
                    let growth = if squares < 0.8 * max_squares { 0.85 * max_squares / squares } else { 1.0 };
                    used.0 = (f64::from(tolerance.square) / full * growth.min(1.3)).clamp(0.05, 1.0);
                }
                return;
            }
            // The sum of the errors exceeds its cap, because most halves use the whole tolerance. The tolerance shrinks
            // by the ratio of cap and sum, and a little more, so that few tries are needed.
            let step = (0.85 * max_squares / squares).clamp(0.0, 0.85);
            tolerance.square = (f64::from(tolerance.square) * step) as u32;
        }
    }

    /// Returns the indices of the picture cells that differ between `grid` and the wanted grid.
    pub(super) fn inexact_cells(&self, grid: &Grid) -> impl Iterator<Item = usize> {
        let is_inexact =
            |difference: &&Difference| picture_halves(grid.packed()[difference.at]) != Some(difference.wanted);
        self.scratch.differences.iter().filter(is_inexact).map(|difference| difference.at)
    }
}

fn squared_differences(a: Halves, b: Halves) -> [u32; 2] {
    [squared_difference(a[0], b[0]), squared_difference(a[1], b[1])]
}

fn sum(squares: [u32; 2]) -> u64 {
    u64::from(squares[0]) + u64::from(squares[1])
}
