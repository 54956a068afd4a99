//! Frames under a limit of bytes: the picture with the smallest error that fits.
//!
//! An exchange rate decides which cells are written: the squared error, in 8-bit sRGB summed over the channels of both
//! halves of a cell, that each byte has to remove. The rate is adapted from frame to frame so that frames come close to
//! the limit: the larger the shortage of bytes, the higher the rate, and the larger the errors that stay.
//!
//! 1. [Overdue](overdue) cells, which must not stay wrong for longer, are written whatever they gain. Of the others,
//!    those whose error is worth two bytes are active. The [`colors`] of their halves become a palette, whose colours
//!    are as far apart as the rate allows.
//! 2. A [pair](pairs) of these colours is opened, that is, may be used, if it removes more error than the bytes that
//!    set its two colours are worth. Each cell takes the cheapest open pair, or keeps what it shows.
//! 3. Row by row, cells take the pairs of cells near them where longer [runs] save moves of the cursor.
//! 4. If the bytes exceed the limit, the pairs that gain the least per byte are given up, and overdue cells after them.
//!    Cells that a [shift](super::shifts) has vacated are not: if they do not fit, the frame is drawn without shifts.
//!
//! The picture here is what [`picture_halves`](super::halves::picture_halves) takes for one: half blocks and spaces in
//! truecolor. All else is text.
//!
//! Step 2 is facility location (Cornuejols, Nemhauser and Wolsey 1990), solved in one greedy pass, because a full
//! search gains another tenth of the quality in forty times the time.

use super::Order;
use super::cell_ages::CellAges;
use super::differences::{Differences, VACATED};
use super::halves::{Halves, half_block_cell_with_glyph_of};
use super::moves::CellPosition;
use crate::grid::{Grid, HalfBlocks, PackedCell, PackedInk};
use colors::FramePalette;
use overdue::OverdueCells;
use pair_colors::PairColors;
use pairs::Pairs;
use std::cell::RefCell;

mod colors;
mod overdue;
mod pair_colors;
mod pairs;
mod runs;

/// An exchange rate of a frame: the squared error that each byte has to remove.
pub(super) type ExchangeRate = f32;

/// A cell whose error is large enough to be worth bytes.
struct ActiveCell {
    /// The cell's index in the grid.
    at: usize,
    wanted: Halves,
    /// The channels of the wanted halves.
    channels: [Channels; 2],
    /// The factor of the cell's errors.
    weight: f32,
    /// The weighted error if the cell is not written.
    ///
    /// That of a vacated cell, which must be written, is set to be worth any change of the pen.
    stay: f32,
    /// Whether a shift of this frame has vacated the cell.
    is_vacated: bool,
    /// The least cost of this cell among the choices tried so far.
    ///
    /// A cost is the weighted error that is left, plus the bytes written times the exchange rate.
    cost: f32,
    /// The key of the pair with which the cell is written; `None` to keep what it shows.
    pair: Option<u16>,
    /// The palette indices of the pair's colours, first that of the upper half.
    shown: [u8; 2],
    /// The indices of the nearest and the second nearest colour of each half.
    nearest: [[u8; 2]; 2],
}

/// The smallest limit on a frame's bytes at which the exchange rate is used.
///
/// A smaller frame may have no room for a single change of the pen.
pub(super) const LEAST_BYTES: usize = 200;

/// The smallest number of bytes for the picture of a frame from which the rate is adapted.
///
/// Below it, only a frame without any cell lowers the rate.
// Text may leave hardly any room, whatever the rate is. The marks of a synchronized update and a changed status line
// leave more of the smallest limit.
const LEAST_PICTURE_BYTES: usize = LEAST_BYTES / 2;

/// The rate below which errors are invisible: a frame of the allowed quality is tried again.
const LEAST_RATE: ExchangeRate = 0.3;

/// The greatest rate: two bytes are worth half of the greatest error of a cell.
// Bytes that no rate can save, such as those of overdue cells, would raise it without end.
const MOST_RATE: ExchangeRate = 1e5;

/// The rate below which a picture at rest gets its final colours.
// Final colours take 20 bytes a cell and more. At 200x60 and 50 KB/s the picture of three motions of four had 35 dB 1.7
// to 3.1 seconds after their end when the first still frame began with them; it has 35 dB after 0.4 to 0.8 seconds, and
// takes up to an eighth longer to become exact. With 0.3 it would take a fifth longer; 10 would save hardly anything.
const RESTING_RATE: ExchangeRate = 3.0;

/// The bytes of the chosen cells at which the rate aims, as a share of the limit.
// A little too much: giving up the worst pairs uses 94 to 98 % of the limit. An aim of 1 used 92 to 96 % (0.1 dB less
// with 1.0 and 1.7 kB), and 1.08 cost 0.4 dB with 8 kB in the bench's random motions.
const AIM: f32 = 1.05;

/// How scarce bytes are, as learnt from the frames so far, for choosing the cells of the next one.
///
/// It is not a number of bytes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shortage {
    /// The exchange rate of the next frame; `None` while frames of the allowed quality fit the
    /// limit.
    rate: Option<ExchangeRate>,
    /// The least squared distance of two colours in the last frame's palette.
    ///
    /// It is for halves of weight 1.
    radius: f32,
    /// The bytes of the frame of the allowed quality with which the shortage began.
    allowed_bytes: u32,
}

impl Shortage {
    /// Returns whether frames of the allowed quality exceed the limit at present.
    pub(super) fn is_present(self) -> bool {
        self.rate.is_some()
    }

    /// Returns whether a picture at rest is still to be mended with coarse colours.
    pub(super) fn leaves_large_errors(self) -> bool {
        self.rate() > RESTING_RATE
    }

    /// Returns the exchange rate of the next frame.
    pub(super) fn rate(self) -> ExchangeRate {
        self.rate.unwrap_or(LEAST_RATE)
    }

    /// Sets the first rate, after a frame of the allowed quality took `bytes` instead of
    /// `max_bytes`.
    pub(super) fn set_first_rate(&mut self, bytes: usize, max_bytes: usize) {
        let share = bytes as f32 / max_bytes as f32;
        self.rate = Some((2.0 * share * share).min(MOST_RATE));
        self.allowed_bytes = bytes as u32;
    }

    /// Returns the share that a frame has of the time for which a cell may be wrong.
    ///
    /// That time is a second or, if longer, one and a half of the times that a frame of the allowed quality takes.
    /// `elapsed` are the seconds since the frame before.
    // A frame fills the link until the next one, so that the share of its bytes is the share of the time.
    pub(super) fn share_of_deadline(self, elapsed: f32, max_bytes: usize) -> f32 {
        elapsed.min(max_bytes as f32 / (1.5 * self.allowed_bytes as f32)).min(1.0)
    }

    /// Adapts the rate after a frame whose chosen cells would take `share_of_limit` times the
    /// limit.
    ///
    /// Returns whether the rate was far off, so that the frame should be chosen again.
    fn adapt_rate(&mut self, rate: ExchangeRate, share_of_limit: f32) -> bool {
        // The square root damps the change: with the share itself the rate swings from frame to frame.
        let next = rate * (share_of_limit / AIM).sqrt().clamp(0.1, 3.0);
        self.rate = (next >= LEAST_RATE).then_some(next.min(MOST_RATE));
        !(0.6..=1.6).contains(&share_of_limit) && self.rate.is_some_and(|next| next != rate)
    }
}

/// The inputs of a frame under a byte limit, before which text and shifts have been written.
pub(super) struct CappedFrame<'a> {
    /// The grid that the terminal shows; updated to the grid that it shows after the frame.
    pub(super) shown: &'a mut Grid,
    pub(super) wanted: &'a Grid,
    /// The differences of `wanted` from the shown grid or, without shifts, from the grid that was
    /// shown before the text.
    pub(super) differences: &'a Differences,
    pub(super) ages: &'a CellAges,
    /// The share that the frame has of the time for which a cell may be wrong.
    pub(super) share_of_deadline: f32,
    pub(super) half_blocks: HalfBlocks,
    pub(super) order: Order,
    /// The largest number of bytes of the picture, with its shifts.
    pub(super) max_bytes: usize,
    /// The bytes of it that shifts have taken.
    pub(super) shift_bytes: usize,
}

/// The working memory of a frame, which all encoders of a thread share.
#[derive(Default)]
struct CappedScratch {
    active: Vec<ActiveCell>,
    palette: FramePalette,
    pairs: Pairs,
    overdue: OverdueCells,
    /// The cells to write.
    cells: Vec<WrittenCell>,
    /// The cells that the frame replaces, with their indices.
    replaced: Vec<(usize, PackedCell)>,
    changed: Vec<CellPosition>,
}

thread_local! {
    static SCRATCH: RefCell<CappedScratch> = RefCell::default();
}

/// A cell to write.
#[derive(Clone, Copy)]
struct WrittenCell {
    /// The cell's index in the grid.
    at: usize,
    halves: Halves,
}

/// Largest number of times that the cells of a frame are chosen.
// With a single try the PSNR is 0.1 to 0.2 dB lower.
const MAX_TRIES: usize = 3;

/// Chooses the cells of a frame and their colours, and calls `write` with the grid to show and the
/// positions of these cells.
///
/// `write` returns the number of bytes. It may be called again, and then replaces what its last call has written.
///
/// Returns whether all vacated cells are written: they may take more than the limit.
pub(super) fn draw(
    mut frame: CappedFrame<'_>,
    shortage: &mut Shortage,
    mut write: impl FnMut(&Grid, &[CellPosition]) -> usize,
) -> bool {
    SCRATCH.with_borrow_mut(|scratch| {
        scratch.overdue.choose(&frame);
        for left in (0..MAX_TRIES).rev() {
            let rate = shortage.rate();
            let written = scratch.choose_and_write_fitting(&mut frame, rate, &mut shortage.radius, &mut write);
            let bytes = frame.shift_bytes + written.bytes_of_all;
            let share_of_limit = bytes as f32 / frame.max_bytes.max(1) as f32;
            if frame.max_bytes < LEAST_PICTURE_BYTES && bytes > 0
                || !shortage.adapt_rate(rate, share_of_limit)
                || left == 0
            {
                return written.has_all_vacated;
            }
            scratch.restore(frame.shown);
        }
        false
    })
}

/// The outcome of choosing and writing cells.
struct Written {
    /// The number of bytes that all chosen cells would take.
    bytes_of_all: usize,
    /// Whether no vacated cell has been left out.
    has_all_vacated: bool,
}

impl CappedScratch {
    /// Chooses the cells at an exchange rate, and writes those that fit.
    fn choose_and_write_fitting(
        &mut self,
        frame: &mut CappedFrame<'_>,
        rate: ExchangeRate,
        radius: &mut f32,
        write: &mut impl FnMut(&Grid, &[CellPosition]) -> usize,
    ) -> Written {
        let Self { active, palette, pairs, overdue, .. } = self;
        find_active(frame.differences, frame.ages, rate, overdue.cells(), active);
        palette.choose(active, rate, radius);
        let colors = PairColors { palette, rate, half_blocks: frame.half_blocks };
        pairs.choose(active, &colors, frame.wanted.size().columns.into());
        let (mut ranks, mut most_cells) = (pairs.ranks(), usize::MAX);
        let (has_vacated, max_bytes) = (pairs.has_vacated(), frame.max_bytes.saturating_sub(frame.shift_bytes));
        let mut all = None;
        loop {
            self.pairs.list_cells(&self.active, ranks, &mut self.cells);
            self.cells.truncate(most_cells);
            let of_pairs = self.cells.len();
            self.add_overdue();
            self.apply(frame);
            let bytes = write(frame.shown, &self.changed);
            let bytes_of_all = *all.get_or_insert(bytes);
            let fits = bytes <= max_bytes || self.cells.is_empty();
            let has_overdue = !self.overdue.cells().is_empty();
            if fits || ranks == 0 && has_vacated && !has_overdue {
                return Written { bytes_of_all, has_all_vacated: fits };
            }
            self.restore(frame.shown);
            if ranks > 1 {
                let of_overdue = self.overdue.bytes().min(max_bytes as f32 / 2.0);
                let share = (max_bytes as f32 - of_overdue) / (bytes as f32 - of_overdue);
                ranks = self.pairs.ranks_within_bytes(ranks, share).max(1);
            } else if ranks == 1 && has_vacated {
                ranks = 0;
            } else if of_pairs > 0 && !has_vacated {
                // Not even the cells of one pair fit: the first of them in reading order are written.
                most_cells = (of_pairs * max_bytes / bytes).min(of_pairs - 1);
            } else {
                self.overdue.halve();
            }
        }
    }

    /// Adds the overdue cells to those to write, which stay in reading order.
    fn add_overdue(&mut self) {
        if !self.overdue.cells().is_empty() {
            self.cells.extend(self.overdue.cells());
            self.cells.sort_unstable_by_key(|cell| cell.at);
        }
    }

    /// Sets the cells to write in the frame's grid, and lists those that change.
    fn apply(&mut self, frame: &mut CappedFrame<'_>) {
        let columns = usize::from(frame.shown.size().columns);
        self.replaced.clear();
        self.changed.clear();
        for cell in &self.cells {
            let new = half_block_cell_with_glyph_of(cell.halves, frame.wanted.packed()[cell.at]);
            let old = frame.shown.packed()[cell.at];
            if old != new {
                frame.shown.set_packed(cell.at, new);
                self.replaced.push((cell.at, old));
                let (column, row) = (cell.at % columns, cell.at / columns);
                self.changed.push(CellPosition { column: column as u16, row: row as u16 });
            }
        }
    }

    /// Undoes what [`apply`](Self::apply) did.
    fn restore(&mut self, shown: &mut Grid) {
        for (at, cell) in self.replaced.drain(..).rev() {
            shown.set_packed(at, cell);
        }
    }
}

/// Largest number of cells of a frame whose picture replaces text or unknown contents.
///
/// Such cells never wait, and are written exactly, before the exchange rate decides on the others.
// A status line that gets shorter uncovers a few cells, which are below this limit. A closing panel uncovers more:
// their exact colours would take more bytes than a frame of the allowed quality, so the exchange rate is not used.
pub(super) const MAX_APPEARING: usize = 64;

/// Draws the wanted text into `grid`, and the wanted picture where the terminal shows text
/// or unknown contents.
pub(super) fn put_text_and_unknown(wanted: &Grid, differences: &Differences, grid: &mut Grid) {
    differences.copy_text(wanted, grid);
    for (&place, _) in differences.places.iter().zip(&differences.squares).filter(|&(_, &squares)| is_unknown(squares))
    {
        grid.set_packed(place as usize, wanted.packed()[place as usize]);
    }
}

/// The number of bytes that the error of a cell must be worth for the cell to be considered.
// Without a move of the cursor, a half block takes three bytes and a space one. With a limit of 1, choosing the cells
// of a frame takes a tenth longer.
const LEAST_GAIN: f32 = 2.0;

/// Collects the cells whose error is worth the bytes of a glyph.
fn find_active(
    differences: &Differences,
    ages: &CellAges,
    rate: ExchangeRate,
    overdue: &[WrittenCell],
    active: &mut Vec<ActiveCell>,
) {
    let mut overdue = overdue.iter().map(|cell| cell.at).peekable();
    let Differences { places, wanted, squares, .. } = differences;
    active.clear();
    for ((&place, &wanted), &[upper, lower]) in places.iter().zip(wanted).zip(squares) {
        if overdue.next_if_eq(&(place as usize)).is_some() {
            continue;
        }
        let weight = weight(ages.wrong_share(place as usize));
        let stay = upper.saturating_add(lower) as f32 * weight;
        // Halves that were unknown are shown exactly by now.
        let is_vacated = [upper, lower] == VACATED;
        if stay > LEAST_GAIN * rate && !is_unknown([upper, lower]) {
            active.push(ActiveCell {
                at: place as usize,
                wanted,
                channels: wanted.map(channels),
                weight,
                stay,
                is_vacated,
                cost: stay,
                pair: None,
                shown: [0; 2],
                nearest: [[0; 2]; 2],
            });
        }
    }
}

/// Returns the factor of the errors of a cell that has been wrong for a share of the time that it
/// may be.
// Long before a cell is overdue, more weight makes its small error worth the bytes beside cells that are written
// anyway. Without weights, at the same PSNR, twice as many cells or more become overdue.
fn weight(wrong_share: f32) -> f32 {
    // The share has an end, because colours are chosen by the mean weight of their halves.
    let wrong_share = wrong_share.min(2.0);
    1.0 + 3.0 * wrong_share * wrong_share
}

fn is_unknown(squares: [u32; 2]) -> bool {
    squares == [u32::MAX; 2]
}

/// Red, green and blue, from 0 to 255.
type Channels = [f32; 3];

fn channels(ink: PackedInk) -> Channels {
    ink.channels().map(f32::from)
}

/// Returns the squared difference of two colours.
#[inline]
fn square([r, g, b]: Channels, [other_r, other_g, other_b]: Channels) -> f32 {
    let (r, g, b) = (r - other_r, g - other_g, b - other_b);
    r * r + g * g + b * b
}

/// Returns the squared error of both halves.
#[inline]
fn error(shown: [Channels; 2], wanted: [Channels; 2]) -> f32 {
    square(shown[0], wanted[0]) + square(shown[1], wanted[1])
}
