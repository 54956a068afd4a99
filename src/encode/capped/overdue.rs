//! Overdue cells: those that must be written for none to be visibly wrong for too long.
//!
//! By the exchange rate alone, small errors would stay for as long as the picture moves. Cells are therefore written
//! before their deadline whatever they gain, in colours that look like those wanted: the cells with the earliest
//! deadlines (Liu and Layland 1973), as many as the frames until then would have no room for. They get few pairs of
//! colours, by the same [`Reduction`] as the cells of a lossy frame. If even these do not fit, pairs that the most
//! cells share come first, as they take the fewest bytes per cell.

use super::{CappedFrame, LEAST_PICTURE_BYTES, WrittenCell, is_unknown};
use crate::encode::Order;
use crate::encode::differences::{Differences, VACATED};
use crate::encode::halves::{Halves, Tolerance, squared_differences, sum};
use crate::encode::numbering::Numbering;
use crate::encode::oklab_pairs::OklabPairs;
use crate::encode::palette::Reduction;
use crate::encode::wrong_cells::VISIBLE;
use crate::grid::{HalfBlocks, PackedInk};
use std::cmp::Reverse;

/// The largest part of a frame's limit for overdue cells.
// With 0.1, up to 24 cells of 1,920 stayed wrong for too long (orbit, 80x24, 1.0 kB). With 0.5, the PSNR is 0.1 dB
// lower where the link is too slow for all of them (200x60, 1.7 kB).
const MOST_OF_LIMIT: f32 = 0.4;

/// The share of its time for which a cell has been wrong before it can be overdue.
///
/// It is less where two frames take more than half of that time.
// With 0.3, more cells share the room where the link is too slow, and 98 of 12,000 cells were wrong for too long
// instead of 26 (200x60, 3.3 kB).
const LEAST_SHARE: f32 = 0.5;

/// The largest number of overdue cells of a frame.
// It bounds the time for choosing their pairs.
const MOST_CELLS: usize = 512;

/// The number of frames before its deadline that a cell cannot count on.
// One is the frame that writes it; half of another is lost to rounding, and to frames with less room.
const SLACK: f32 = 1.5;

/// The largest difference of colours that look the same.
// A little less than [`VISIBLE`], for the error of the cube roots.
const TOLERANCE: Tolerance = Tolerance { distance: 0.999 * VISIBLE, square: u32::MAX };

/// The mean numbers of bytes of overdue cells.
#[derive(Clone, Copy)]
struct MeanLens {
    /// The bytes of a cell before its pair is known.
    unpaired: f32,
    /// The bytes of a pair's pen.
    pen: f32,
    /// The bytes of a cell with a known pair: the glyph, and the move where cells are apart.
    cell: f32,
}

impl MeanLens {
    fn of(order: Order) -> Self {
        match order {
            Order::Color => Self { unpaired: 10.0, pen: 20.0, cell: 6.0 },
            // In reading order, each cell may need a change of the pen.
            Order::Raster => Self { unpaired: 26.0, pen: 0.0, cell: 26.0 },
        }
    }
}

/// The overdue cells of a frame that are written, and the memory for choosing them.
#[derive(Default)]
pub(super) struct OverdueCells {
    candidates: Vec<Candidate>,
    compared: OklabPairs,
    wanted: Vec<Halves>,
    snapped: Vec<Halves>,
    reduction: Reduction,
    pairs: Numbering<[PackedInk; 2]>,
    groups: Vec<Group>,
    /// The numbers of the groups, the largest first.
    largest: Vec<u32>,
    cells: Vec<WrittenCell>,
    /// About the number of bytes of the cells.
    bytes: f32,
}

/// A cell that has been wrong for long.
#[derive(Clone, Copy)]
struct Candidate {
    /// The index of its difference.
    index: u32,
    wrong_share: f32,
    /// The number of its group.
    group: u32,
}

/// The cells with one pair of colours.
#[derive(Clone, Copy, Default)]
struct Group {
    cells: u32,
    /// The number of cells that are still to be listed.
    left: u32,
}

impl OverdueCells {
    /// Returns the cells to write, in reading order.
    pub(super) fn cells(&self) -> &[WrittenCell] {
        &self.cells
    }

    /// Returns about the number of bytes of the cells.
    pub(super) fn bytes(&self) -> f32 {
        self.bytes
    }

    /// Gives up half of the cells, the last ones in reading order.
    // That seldom happens: their bytes must exceed the estimate two and a half times.
    pub(super) fn halve(&mut self) {
        self.cells.truncate(self.cells.len() / 2);
        self.bytes /= 2.0;
    }

    /// Chooses the cells to write, and their colours.
    pub(super) fn choose(&mut self, frame: &CappedFrame<'_>) {
        self.cells.clear();
        self.bytes = 0.0;
        if frame.max_bytes < LEAST_PICTURE_BYTES {
            return;
        }
        let room = MOST_OF_LIMIT * frame.max_bytes.saturating_sub(frame.shift_bytes) as f32;
        let lens = MeanLens::of(frame.order);
        self.find_candidates(frame);
        self.candidates.truncate(self.count_overdue(frame.share_of_deadline, room, lens));
        if self.candidates.is_empty() {
            return;
        }
        self.choose_colors(frame.differences, frame.half_blocks);
        self.group(frame.half_blocks);
        self.share_out(room, lens);
        self.list_cells(frame.differences);
    }

    /// Finds the cells that have been wrong for the longest, in that order.
    fn find_candidates(&mut self, frame: &CappedFrame<'_>) {
        let Self { candidates, compared, .. } = self;
        let Differences { places, wanted, shown, squares, .. } = frame.differences;
        let least_share = (1.0 - 2.0 * frame.share_of_deadline).clamp(f32::MIN_POSITIVE, LEAST_SHARE);
        candidates.clear();
        for (index, (&at, &squares)) in (0..).zip(places.iter().zip(squares)) {
            let wrong_share = frame.ages.wrong_share(at as usize);
            if wrong_share >= least_share && squares != VACATED && !is_unknown(squares) {
                candidates.push(Candidate { index, wrong_share, group: 0 });
            }
        }
        // The picture or a shift may have made a cell right since the last frame.
        let halves = candidates.iter().map(|cell| [shown, wanted].map(|halves| halves[cell.index as usize]));
        compared.compare(halves, TOLERANCE);
        let mut are_near = compared.are_near();
        candidates.retain(|_| are_near.next() != Some(true));
        let longest_first =
            |a: &Candidate, b: &Candidate| b.wrong_share.total_cmp(&a.wrong_share).then(a.index.cmp(&b.index));
        if candidates.len() > MOST_CELLS {
            candidates.select_nth_unstable_by(MOST_CELLS, longest_first);
            candidates.truncate(MOST_CELLS);
        }
        candidates.sort_unstable_by(longest_first);
    }

    /// Returns the number of candidates that are overdue.
    ///
    /// A cell is overdue if the frames until its deadline have no room for it after the cells before it. Then the cells
    /// before it are overdue too.
    fn count_overdue(&self, share_of_deadline: f32, room: f32, lens: MeanLens) -> usize {
        let is_overdue = |&(before, cell): &(usize, &Candidate)| {
            let frames = (1.0 - cell.wrong_share) / share_of_deadline - SLACK;
            before as f32 * lens.unpaired >= frames * room
        };
        self.candidates.iter().enumerate().rev().find(is_overdue).map_or(0, |(before, _)| before + 1)
    }

    /// Chooses colours that look like those wanted.
    fn choose_colors(&mut self, differences: &Differences, half_blocks: HalfBlocks) {
        let Self { candidates, wanted, snapped, reduction, .. } = self;
        wanted.clear();
        wanted.extend(candidates.iter().map(|cell| differences.wanted[cell.index as usize]));
        reduction.snap(wanted, [PackedInk::DEFAULT; 2], TOLERANCE, half_blocks, snapped);
        for (cell, (&wanted, snapped)) in candidates.iter().zip(wanted.iter().zip(snapped)) {
            // A colour that looks nearer may differ more in sRGB, and no frame may raise that error.
            if sum(squared_differences(*snapped, wanted)) > sum(differences.squares[cell.index as usize]) {
                *snapped = wanted;
            }
        }
    }

    /// Groups the cells by the pairs of their snapped colours.
    fn group(&mut self, half_blocks: HalfBlocks) {
        let Self { candidates, snapped, pairs, groups, .. } = self;
        pairs.clear(candidates.len());
        groups.clear();
        for (cell, &[upper, lower]) in candidates.iter_mut().zip(&*snapped) {
            // One pen shows both orders if cells may use either half block.
            let is_exchanged = half_blocks == HalfBlocks::Either && lower < upper;
            let group = pairs.add(if is_exchanged { [lower, upper] } else { [upper, lower] });
            if group == groups.len() {
                groups.push(Group::default());
            }
            cell.group = group as u32;
            groups[group].cells += 1;
        }
    }

    /// Shares out the bytes among the groups, the largest first.
    fn share_out(&mut self, room: f32, lens: MeanLens) {
        let Self { groups, largest, bytes, .. } = self;
        largest.clear();
        largest.extend(0..groups.len() as u32);
        largest.sort_unstable_by_key(|&group| (Reverse(groups[group as usize].cells), group));
        for &group in &*largest {
            let group = &mut groups[group as usize];
            let left = room - *bytes - lens.pen;
            if left < lens.cell {
                break;
            }
            group.left = group.cells.min((left / lens.cell) as u32);
            *bytes += lens.pen + lens.cell * group.left as f32;
        }
    }

    /// Lists the cells that the groups have room for, of each group those that have been wrong for
    /// the longest.
    fn list_cells(&mut self, differences: &Differences) {
        let Self { candidates, snapped, groups, cells, .. } = self;
        for (cell, &halves) in candidates.iter().zip(&*snapped) {
            let group = &mut groups[cell.group as usize];
            if group.left > 0 {
                group.left -= 1;
                cells.push(WrittenCell { at: differences.places[cell.index as usize] as usize, halves });
            }
        }
        cells.sort_unstable_by_key(|cell| cell.at);
    }
}
