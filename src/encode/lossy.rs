//! Wanted grid -> one that nobody can tell from it and that takes fewer bytes to show.
//!
//! What may differ is the picture, never text. A half cell may have another colour than the wanted one if that is within
//! the quality's cap in OKLab, and if the whole picture keeps its signal-to-noise ratio. Both liberties are used: a cell
//! that shows a colour near enough is left alone, and the others take colours that serve many of them (see
//! [`palette`](super::palette)).

use super::Quality;
use super::halves::{Halves, Tolerance, half_block_cell, picture_halves, squared_difference};
use super::palette;
use crate::grid::{Grid, HalfBlocks, Ink};
use std::cmp::Reverse;

/// How far the picture that is shown may be from the wanted one.
#[derive(Clone, Copy)]
pub(super) struct QualityCaps {
    /// The most that a half cell may differ: a distance in OKLab.
    distance: f32,
    /// The most that the halves may differ in the mean: the square of the differences of 8-bit sRGB, per channel. A peak
    /// signal-to-noise ratio of `d` decibels is `255^2 / 10^(d / 10)`.
    mean_square: f64,
}

impl QualityCaps {
    pub(super) fn of(quality: Quality) -> Option<Self> {
        match quality {
            Quality::Exact => None,
            // 44 and 41 decibels.
            Quality::Equal => Some(Self { distance: 0.01, mean_square: 2.588_6 }),
            Quality::Fast => Some(Self { distance: 0.02, mean_square: 5.165_1 }),
        }
    }
}

/// What a lossy frame is made from.
pub(super) struct LossyFrame<'a> {
    pub(super) shown: &'a Grid,
    pub(super) wanted: &'a Grid,
    pub(super) caps: QualityCaps,
    /// Whether a cell may be written with either half, so that two colours serve both ways round.
    pub(super) half_blocks: HalfBlocks,
    /// The colours that the pen has already.
    pub(super) pen: [Ink; 2],
    /// Which cells are to have their exact colours now.
    pub(super) has_waited: &'a dyn Fn(usize) -> bool,
}

/// A cell of the picture that does not show what is wanted.
struct Difference {
    /// Where it is among the grid's cells.
    at: usize,
    wanted: Halves,
    /// What it shows, if it is of a picture.
    shown: Option<Halves>,
    urgency: Urgency,
}

/// Whether a cell is to be written: the larger, the more it is worth; of as much, the first comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Urgency {
    /// It is near enough.
    Waits,
    /// It is near enough, but has waited long enough for its exact colours. Nobody sees how much it differs: neighbours
    /// are written in one frame, which costs the fewest bytes.
    Refines,
    /// It differs by so much, which is too much.
    Differs(u32),
    /// No picture is shown there.
    Appears,
}

/// What differs between a frame's two grids, that first which needs most to be written.
pub(super) struct Plan<'a> {
    frame: LossyFrame<'a>,
    tolerance: Tolerance,
    differences: Vec<Difference>,
    /// How many of them are to be written.
    writes: usize,
    /// The places of text.
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
        let wanted = self.frame.wanted.cells();
        let shown = self.frame.shown.cells();
        for (at, cell) in wanted.iter().enumerate() {
            let Some(wanted) = picture_halves(cell) else {
                self.text.push(at);
                continue;
            };
            let shown = picture_halves(&shown[at]);
            if shown != Some(wanted) {
                self.differences.push(Difference { at, wanted, shown, urgency: Urgency::Appears });
            }
        }
    }

    /// The largest square that leaves the mean of all halves within its cap: what differs more is taken for written, and
    /// then for differing by anything up to that square, by a third of it in the mean.
    fn max_square(&self) -> u32 {
        const HISTOGRAM_LEN: usize = 1024;
        let mut counts = [0_usize; HISTOGRAM_LEN];
        for difference in &self.differences {
            let squares = difference.shown.map_or([u32::MAX; 2], |shown| squares(shown, difference.wanted));
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

    /// The most that the squares of all halves may sum up to.
    fn square_budget(&self) -> f64 {
        let halves = 2 * (self.frame.wanted.cells().len() - self.text.len());
        self.frame.caps.mean_square * (3 * halves) as f64
    }

    fn rank_differences(&mut self) {
        for difference in &mut self.differences {
            let Some(shown) = difference.shown else { continue };
            let square = squares(shown, difference.wanted).into_iter().fold(0, u32::max);
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

    /// How many cells of the picture are to be written.
    pub(super) fn writes(&self) -> usize {
        self.writes
    }

    /// How many of them cannot wait for a later frame; `within_caps`: nor can those that differ too much.
    pub(super) fn min_writes(&self, within_caps: bool) -> usize {
        self.count_from(if within_caps { Urgency::Differs(0) } else { Urgency::Appears })
    }

    /// The grid to show next: the wanted text, and so many of the picture's cells written.
    pub(super) fn grid(&self, writes: usize) -> Grid {
        let (written, left) = self.differences.split_at(writes);
        let left: u64 = left.iter().filter_map(|left| Some(sum(squares(left.shown?, left.wanted)))).sum();
        let max_squares =
            if writes < self.min_writes(true) { f64::INFINITY } else { self.square_budget() - left as f64 };
        let mut tolerance = self.tolerance;
        let snapped = loop {
            let snapped = self.snapped_halves(written, tolerance);
            let squares = snapped.iter().zip(written).map(|(&snapped, write)| sum(squares(snapped, write.wanted)));
            let squares = squares.sum::<u64>() as f64;
            if squares <= max_squares || tolerance.square == 0 {
                break snapped;
            }
            // It is seldom that all cells snap far; then they snap less far.
            tolerance.square = (f64::from(tolerance.square) * (max_squares / squares).clamp(0.0, 0.75)) as u32;
        };
        let mut grid = self.shown_with_text();
        for (write, halves) in written.iter().zip(snapped) {
            grid.cells_mut()[write.at] = half_block_cell(halves, &self.frame.wanted.cells()[write.at]);
        }
        grid
    }

    /// The halves with which cells are written: exactly where they have waited for it.
    fn snapped_halves(&self, written: &[Difference], tolerance: Tolerance) -> Vec<Halves> {
        let mut snapped: Vec<Halves> = written.iter().map(|write| write.wanted).collect();
        let inexact = written.iter().zip(&mut snapped).filter(|(write, _)| !(self.frame.has_waited)(write.at));
        let mut inexact: Vec<&mut Halves> = inexact.map(|(_, halves)| halves).collect();
        palette::snap_to_palette(&mut inexact, self.frame.pen, tolerance, self.frame.half_blocks);
        snapped
    }

    /// The wanted text, and the picture as it is shown.
    fn shown_with_text(&self) -> Grid {
        let mut grid = self.frame.shown.clone();
        for &at in &self.text {
            grid.cells_mut()[at].clone_from(&self.frame.wanted.cells()[at]);
        }
        grid
    }

    /// The places where the grid does not show exactly what is wanted.
    pub(super) fn inexact(&self, grid: &Grid) -> impl Iterator<Item = usize> {
        let is_inexact =
            |difference: &&Difference| picture_halves(&grid.cells()[difference.at]) != Some(difference.wanted);
        self.differences.iter().filter(is_inexact).map(|difference| difference.at)
    }
}

fn squares(a: Halves, b: Halves) -> [u32; 2] {
    [squared_difference(a[0], b[0]), squared_difference(a[1], b[1])]
}

fn sum(squares: [u32; 2]) -> u64 {
    u64::from(squares[0]) + u64::from(squares[1])
}
