//! Lossy frames: grids that hardly differ from the wanted one and take fewer bytes to show.
//!
//! Only the picture may differ, never text. The colour of a half cell may differ up to the quality's cap in OKLab, as
//! long as the whole picture keeps its signal-to-noise ratio. A cell that already shows a near colour is not written,
//! and the other cells get colours that many of them can share (see [`palette`](super::palette)).
// Bytes at 80x24 relative to those of ratatui's backend, including the exact frame at rest, for the bench's scenes
// orbit, plain, sphere and gradient: .56, .52, .82 and .62 with `Exact`; .23, .15, .42 and .23 with `Equal`; .19,
// .10, .31 and .16 with `Fast`.

use super::Quality;
use super::cell_ages::CellAges;
use super::differences::Differences;
use super::halves::{Halves, Tolerance, half_block_cell_with_glyph_of, squared_differences, sum};
use super::oklab_pairs::OklabPairs;
use super::palette::Reduction;
use crate::grid::{Grid, HalfBlocks, PackedInk};
use std::cell::RefCell;

/// The working memory of a frame, which all encoders of a thread share.
#[derive(Default)]
struct LossyScratch {
    /// The differences that are small enough to be tolerated in sRGB.
    small: OklabPairs,
    /// The differences to write.
    written: Vec<WrittenDifference>,
    /// The indices in the grid of cells that are within the tolerance and wait to be made exact.
    waiting: Vec<u32>,
    /// The indices in the grid of the cells to write inexactly; their wanted halves are in
    /// `unsnapped`, those of the palette in `snapped`.
    inexact: Vec<u32>,
    unsnapped: Vec<Halves>,
    snapped: Vec<Halves>,
    reduction: Reduction,
}

/// A difference to write: its urgency, complemented, and its index among all differences.
// In one number, because sorting pairs of an enum and an index takes three times as long.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct WrittenDifference(u64);

impl WrittenDifference {
    fn new(urgency: Urgency, at: usize) -> Self {
        Self(u64::from(!urgency.0) << 32 | at as u64)
    }

    fn urgency(self) -> Urgency {
        Urgency(!((self.0 >> 32) as u32))
    }

    fn at(self) -> usize {
        self.0 as u32 as usize
    }
}

thread_local! {
    static SCRATCH: RefCell<LossyScratch> = RefCell::default();
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
#[derive(Clone, Copy)]
pub(super) struct LossyFrame<'a> {
    pub(super) wanted: &'a Grid,
    pub(super) differences: &'a Differences,
    pub(super) caps: QualityCaps,
    /// The half blocks that cells may use. With both, a pair of colours can be drawn either way
    /// round.
    pub(super) half_blocks: HalfBlocks,
    /// The pen's foreground and background colours.
    pub(super) pen: [PackedInk; 2],
    pub(super) ages: &'a CellAges,
}

/// The urgency of writing a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Urgency(u32);

impl Urgency {
    /// The shown halves are within the tolerance, but the cell is due to be shown exactly.
    // These cells are not ordered by the size of the difference, which is invisible: neighbours that are written in one
    // frame take the fewest bytes.
    const REFINES: Self = Self(0);

    /// The halves differ by more than the tolerance. The larger squared difference of the two is
    /// added.
    const DIFFERS: Self = Self(1);

    /// The cell does not show the picture yet, but text or unknown contents.
    const APPEARS: Self = Self(u32::MAX);
}

/// The plan of a lossy frame: the differences to write, and the tolerance of the others.
pub(super) struct Plan<'a> {
    frame: LossyFrame<'a>,
    tolerance: Tolerance,
    scratch: &'a mut LossyScratch,
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
    fn new(frame: LossyFrame<'a>, scratch: &'a mut LossyScratch) -> Self {
        let tolerance = Tolerance { distance: frame.caps.distance - DISTANCE_ERROR, square: 0 };
        let mut plan = Self { tolerance, frame, scratch, is_sorted: false };
        plan.tolerance.square = plan.max_square();
        plan.compare_small_in_oklab();
        plan.list_written();
        plan
    }

    /// Returns the largest squared difference of a half cell that may be tolerated without
    /// exceeding the cap on the mean.
    // Halves that differ more are written. Their new squared difference may be anything up to this value, and is
    // counted as a third of it.
    fn max_square(&self) -> u32 {
        const HISTOGRAM_LEN: usize = 1024;
        let mut counts = [0_usize; HISTOGRAM_LEN];
        let squares = self.frame.differences.squares.as_flattened();
        for &square in squares {
            counts[(square as usize).min(HISTOGRAM_LEN - 1)] += 1;
        }
        let (mut beyond, mut sum, mut max_square) = (squares.len(), 0.0, 0);
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
        let halves = 2 * (self.frame.wanted.packed().len() - self.frame.differences.text.len());
        self.frame.caps.mean_square * (3 * halves) as f64
    }

    /// Compares the colours of all differences that are small enough to be tolerated in sRGB.
    fn compare_small_in_oklab(&mut self) {
        let Differences { wanted, shown, squares, .. } = self.frame.differences;
        let small = (0..squares.len()).filter(|&at| is_small(squares[at], self.tolerance));
        self.scratch.small.compare(small.map(|at| [shown[at], wanted[at]]), self.tolerance);
    }

    /// Lists the differences to write, and their urgency.
    fn list_written(&mut self) {
        let Differences { places, squares, .. } = self.frame.differences;
        let LossyScratch { small, written, waiting, .. } = &mut *self.scratch;
        written.clear();
        waiting.clear();
        let mut are_near = small.are_near();
        for (at, (&squares, &place)) in squares.iter().zip(places).enumerate() {
            let is_near = is_small(squares, self.tolerance) && are_near.next() == Some(true);
            let urgency = if !is_near {
                // Unknown halves have the largest difference.
                Urgency(squares[0].max(squares[1]).saturating_add(Urgency::DIFFERS.0))
            } else if self.frame.ages.has_waited(place as usize) {
                Urgency::REFINES
            } else {
                waiting.push(place);
                continue;
            };
            written.push(WrittenDifference::new(urgency, at));
        }
    }

    /// Sorts the differences to write, the most urgent first.
    // Only for frames that do not fit: in others the order does not matter.
    fn sort(&mut self) {
        if !self.is_sorted {
            self.scratch.written.sort_unstable();
            self.is_sorted = true;
        }
    }

    /// Returns the places of the picture cells that are not exact after the last
    /// [`draw`](Self::draw) of `writes` differences.
    pub(super) fn inexact_cells(&self, writes: usize) -> impl Iterator<Item = usize> {
        let LossyScratch { written, waiting, inexact, unsnapped, snapped, .. } = &*self.scratch;
        let places = &self.frame.differences.places;
        let unwritten = written[writes..].iter().map(|written| places[written.at()]);
        let snapped = inexact.iter().zip(unsnapped.iter().zip(snapped));
        let inexact = snapped.filter(|(_, (wanted, snapped))| wanted != snapped).map(|(&place, _)| place);
        waiting.iter().copied().chain(unwritten).chain(inexact).map(|place| place as usize)
    }

    fn count_from(&self, least: Urgency) -> usize {
        self.scratch.written.iter().filter(|written| written.urgency() >= least).count()
    }

    /// Returns the number of picture cells to write.
    pub(super) fn write_count(&self) -> usize {
        self.scratch.written.len()
    }

    /// Returns the number of picture cells that must be written in this frame.
    ///
    /// They are those that replace text or unknown contents and, with `within_caps`, those that exceed the quality's
    /// caps.
    pub(super) fn min_writes(&self, within_caps: bool) -> usize {
        self.count_from(if within_caps { Urgency::DIFFERS } else { Urgency::APPEARS })
    }

    /// Draws the wanted text and the `writes` most urgent picture cells into `grid`.
    ///
    /// `grid` must be a copy of the shown grid.
    pub(super) fn draw(&mut self, writes: usize, used: &mut UsedPart, grid: &mut Grid) {
        if writes < self.write_count() {
            self.sort();
        }
        let LossyFrame { wanted, differences, ages, .. } = self.frame;
        differences.copy_text(wanted, grid);
        let LossyScratch { written, inexact, unsnapped, .. } = &mut *self.scratch;
        inexact.clear();
        unsnapped.clear();
        for at in written[..writes].iter().map(|written| written.at()) {
            let (place, halves) = (differences.places[at], differences.wanted[at]);
            if ages.has_waited(place as usize) {
                grid.set_packed(place as usize, half_block_cell_with_glyph_of(halves, wanted.packed()[place as usize]));
            } else {
                inexact.push(place);
                unsnapped.push(halves);
            }
        }
        self.snap(writes, used);
        for (&place, &halves) in self.scratch.inexact.iter().zip(&self.scratch.snapped) {
            grid.set_packed(place as usize, half_block_cell_with_glyph_of(halves, wanted.packed()[place as usize]));
        }
    }

    /// Chooses palette colours for the cells that are written inexactly.
    fn snap(&mut self, writes: usize, used: &mut UsedPart) {
        let squares = &self.frame.differences.squares;
        let all: u64 = squares.as_flattened().iter().map(|&square| u64::from(square)).sum();
        let written = self.scratch.written[..writes].iter().map(|written| sum(squares[written.at()]));
        let left = all - written.sum::<u64>();
        let is_whole = writes >= self.min_writes(true);
        let max_squares = if is_whole { self.square_budget() - left as f64 } else { f64::INFINITY };
        let LossyFrame { pen, half_blocks, .. } = self.frame;
        let LossyScratch { unsnapped, snapped, reduction, .. } = &mut *self.scratch;
        let mut tolerance = self.tolerance;
        let full = f64::from(tolerance.square);
        if is_whole {
            tolerance.square = (full * used.0) as u32;
        }
        loop {
            reduction.snap(unsnapped, pen, tolerance, half_blocks, snapped);
            let halves = unsnapped.iter().zip(&*snapped);
            let squares =
                halves.map(|(&wanted, &snapped)| sum(squared_differences(snapped, wanted))).sum::<u64>() as f64;
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
}

/// Returns whether the differences of both halves are small enough to be tolerated in sRGB.
fn is_small(squares: [u32; 2], tolerance: Tolerance) -> bool {
    squares[0].max(squares[1]) <= tolerance.square
}
