//! Frames within an allowance: lossy frames of the allowed quality, or within a limit of bytes.

use super::capped;
use super::differences::Differences;
use super::halves::PictureHalves;
use super::lossy;
use super::moves::KnownCursor;
use super::shifts::{ShiftMemory, ShiftTerms};
use super::wrong_cells::WrongCells;
use super::{Allowance, Encoder, Order, Pen, TerminalState};
use crate::capabilities::Shifts;
use crate::grid::{Grid, Size};
use std::cell::RefCell;
use std::time::Duration;

/// Largest number of bytes, per cell of the screen, for a frame that makes lossy cells exact.
// tmux discards pending output above 8 bytes per cell of the screen (its `TTY_BLOCK_START`).
const TMUX_BYTES_PER_CELL: usize = 8;

impl Encoder {
    /// Appends a lossy frame without the marks of a synchronized update.
    ///
    /// Returns the cursor after the frame. Its position depends on the terminal in the last column, and after a
    /// grapheme cluster.
    pub(super) fn draw_within(&mut self, wanted: &Grid, allowance: Allowance, bytes: &mut Vec<u8>) -> KnownCursor {
        let Some(caps) = lossy::QualityCaps::for_quality(allowance.quality) else { return self.draw(wanted, bytes) };
        if self.ages.size() != wanted.size() {
            // A frame of another size takes other numbers of bytes.
            self.shortage = capped::Shortage::default();
        }
        let in_motion = self.ages.record(wanted, allowance.now);
        let mut known = self.take_or_reset_state(wanted.size(), bytes);
        FRAME.with_borrow_mut(|frame| {
            frame.halves.read_wanted(wanted);
            frame.halves.read_shown(&known.shown);
            frame.differences.find(&frame.halves);
            let has_few_appearing = frame.differences.appearing <= capped::MAX_APPEARING;
            // At rest, frames stay under the cap while errors are large. Once they are lossy they stay so, even if they
            // exceed the limit: otherwise the two kinds of frame might alternate forever.
            let is_capped = has_few_appearing && (in_motion || self.shortage.leaves_large_errors());
            let cap = allowance.max_bytes.filter(|&max_bytes| is_capped && max_bytes >= capped::LEAST_BYTES);
            if let Some(max_bytes) = cap.filter(|_| self.shortage.is_present()) {
                return self.draw_capped(wanted, known, (max_bytes, allowance.now, in_motion), frame, bytes);
            }
            let start = bytes.len();
            // Below a cap that leaves out cells, vacated ones, which cannot wait, would take the room of others.
            if in_motion && has_few_appearing && (cap.is_some() || allowance.max_bytes.is_none()) {
                self.shift(&mut known.shown, ShiftTerms::EQUAL, frame, bytes);
            }
            self.draw_lossy(wanted, known, (allowance, caps, in_motion, cap), (frame, start), bytes)
        })
    }

    /// Shifts what the terminal shows, where that is cheaper than writing cells: appends the
    /// operations, and updates the shown grid and the differences.
    ///
    /// The frame's halves must be those of the two grids.
    ///
    /// Returns whether anything has been shifted. The shown grid before it is then in the frame's memory.
    fn shift(
        &self,
        shown: &mut Grid,
        terms: ShiftTerms,
        FrameMemory { before, shifts, halves, differences, .. }: &mut FrameMemory,
        bytes: &mut Vec<u8>,
    ) -> bool {
        let is_shifted = self.uses_shifts() && shifts.shift([shown, before], halves, (self.shifts, terms), bytes);
        if is_shifted {
            differences.find(halves);
            differences.mark_vacated(&shifts.vacated);
        }
        is_shifted
    }

    /// Returns whether frames may shift what the terminal shows.
    pub(super) fn uses_shifts(&self) -> bool {
        self.order == Order::Color && self.shifts != Shifts::Off
    }

    /// Shifts what the terminal shows, as [`shift`](Self::shift) does, before an exact frame.
    pub(super) fn shift_exactly(&self, shown: &mut Grid, wanted: &Grid, bytes: &mut Vec<u8>) {
        FRAME.with_borrow_mut(|frame| {
            frame.halves.read_wanted(wanted);
            frame.halves.read_shown(shown);
            self.shift(shown, ShiftTerms::EXACT, frame, bytes);
        });
    }

    /// Appends a frame of the allowed quality or, if that exceeds `cap`, one within the cap.
    ///
    /// The frame begins at `start` of the bytes, with shifts if there are any. Returns the cursor after the frame.
    fn draw_lossy(
        &mut self,
        wanted: &Grid,
        mut known: TerminalState,
        (allowance, caps, in_motion, cap): (Allowance, lossy::QualityCaps, bool, Option<usize>),
        (frame, start): (&mut FrameMemory, usize),
        bytes: &mut Vec<u8>,
    ) -> KnownCursor {
        let FrameMemory { drawn, next, differences, .. } = &mut *frame;
        let has_shifts = bytes.len() > start;
        let mut used = self.used_part;
        let inputs = lossy::LossyFrame {
            wanted,
            differences,
            caps,
            half_blocks: self.half_blocks,
            pen: [known.pen.fg, known.pen.bg],
            ages: &self.ages,
        };
        let result = lossy::with_plan(inputs, |plan| {
            self.draw_plan(plan, &known, (allowance, in_motion, cap), &mut used, ([drawn, next], start, &mut *bytes))
        });
        self.used_part = used;
        match result {
            Ok(Drawn { pen, cursor, due, is_full, is_within_caps }) => {
                self.is_full = is_full;
                if is_within_caps {
                    self.shortage = capped::Shortage::default();
                }
                // Copied instead of swapped: the thread's grid may have the memory of a larger screen, which the
                // encoder would keep.
                known.shown.clone_from(next);
                self.known = Some(TerminalState { pen, ..known });
                self.due = due;
                self.ages.clear_wrong();
                cursor
            }
            Err(Exceeds { bytes: taken, max_bytes }) => {
                self.shortage.set_first_rate(taken, max_bytes);
                if has_shifts {
                    bytes.truncate(start);
                    known.shown.clone_from(&frame.before);
                    frame.halves.read_shown(&known.shown);
                    frame.differences.find(&frame.halves);
                }
                self.draw_capped(wanted, known, (max_bytes, allowance.now, in_motion), frame, bytes)
            }
        }
    }

    /// Appends the frame of a plan: all of it or, above the limit, its most urgent cells.
    ///
    /// Sets `next` to the grid that the terminal shows after the frame.
    fn draw_plan(
        &self,
        plan: &mut lossy::Plan<'_>,
        known: &TerminalState,
        (allowance, in_motion, cap): (Allowance, bool, Option<usize>),
        used: &mut lossy::UsedPart,
        ([drawn, next], frame_start, bytes): ([&mut Grid; 2], usize, &mut Vec<u8>),
    ) -> Result<Drawn, Exceeds> {
        let max_bytes = allowance.max_bytes.unwrap_or(usize::MAX);
        let usual = max_bytes.min(TMUX_BYTES_PER_CELL * known.shown.size().cell_count());
        let refines_from = plan.min_writes(true);
        let is_full = |taken: usize| taken > usual / 10 * 9;
        // In motion, no cells are made exact if the last frame had hardly any room for them.
        let mut writes = if in_motion && self.is_full { refines_from } else { plan.write_count() };
        let start = bytes.len();
        loop {
            drawn.clone_from(&known.shown);
            plan.draw(writes, used, drawn);
            next.clone_from(&known.shown);
            let mut pen = known.pen;
            let cursor = self.write(drawn, next, &mut pen, bytes);
            let taken = bytes.len() - frame_start + self.synchronized_len();
            let refines = writes > refines_from;
            let (limit, fewest) = if refines { (usual, refines_from) } else { (max_bytes, plan.min_writes(false)) };
            // At least one cell is written; otherwise all might wait for ever.
            let fewest = fewest.max(1);
            // Cells that shifts have vacated need not be written if the frame is drawn without shifts.
            if taken <= limit || writes <= fewest && (cap.is_none() || frame_start == start) {
                let is_cut = writes < plan.write_count();
                let is_within_caps = writes >= refines_from;
                // All inexact cells are made exact together, when the last of them is due. When each was sent at its
                // own time, a dozen frames of a few scattered cells followed each movement: 1.40 full frames of bytes
                // (orbit, 80x24) instead of 1.14.
                let refines = self.ages.all_exact_at(plan.inexact_cells(writes));
                let due = if is_cut { Some(allowance.now) } else { refines };
                return Ok(Drawn { pen, cursor, due, is_full: is_full(taken), is_within_caps });
            }
            bytes.truncate(start);
            if let Some(max_bytes) = cap.filter(|_| !refines) {
                return Err(Exceeds { bytes: taken, max_bytes });
            }
            // Tries again with 31/32 of the cells that should fit, so that the next try hardly ever fails. With 15/16,
            // 84.5 to 85.2 % of a link of 50 kB/s were used instead of 86.5 to 87.3 %. A cell that is made exact takes
            // as many bytes as about three other cells.
            let (others, weight) = if refines { (refines_from, 3) } else { (0, 1) };
            let all = others + weight * (writes - others);
            let fitting = (all * limit / taken * 31 / 32).saturating_sub(others) / weight;
            writes = (others + fitting).clamp(fewest, writes - 1);
        }
    }

    /// Appends a frame of at most `max_bytes` without the marks of a synchronized update.
    ///
    /// Only text may take more.
    ///
    /// Returns the cursor after the frame.
    fn draw_capped(
        &mut self,
        wanted: &Grid,
        mut known: TerminalState,
        (max_bytes, now, in_motion): (usize, Duration, bool),
        frame: &mut FrameMemory,
        bytes: &mut Vec<u8>,
    ) -> KnownCursor {
        let start = bytes.len();
        let share = self.shortage.share_of_deadline(self.ages.elapsed(), max_bytes);
        let mut cursor = KnownCursor::Unknown;
        let FrameMemory { drawn, differences, shifts, .. } = &mut *frame;
        shifts.vacated.clear();
        if differences.has_text(&known.shown, wanted) {
            drawn.clone_from(&known.shown);
            capped::put_text_and_unknown(wanted, differences, drawn);
            cursor = self.write(drawn, &mut known.shown, &mut known.pen, bytes);
            frame.halves.read_shown(&known.shown);
        }
        let max_bytes = max_bytes.saturating_sub(bytes.len() - start + self.synchronized_len());
        let (after_text, pen) = (bytes.len(), known.pen);
        let mut drawn = Err(VacatedExceed);
        // Vacated cells that do not fit are tried with half of the bytes for shifts, and then without shifts.
        for divisor in [1, 2] {
            let terms = ShiftTerms::at_rate(self.shortage.rate(), max_bytes / divisor);
            // At rest nothing is shifted: coarse colours of vacated cells might raise the error, and the next frame
            // might shift them again.
            let may_shift = in_motion && max_bytes >= capped::LEAST_BYTES;
            if !may_shift || !self.shift(&mut known.shown, terms, frame, bytes) {
                break;
            }
            let lens = (max_bytes, bytes.len() - after_text);
            drawn = self.draw_capped_picture(wanted, &mut known, (lens, share), &frame.differences, bytes);
            if drawn.is_ok() {
                break;
            }
            bytes.truncate(after_text);
            known.pen = pen;
            known.shown.clone_from(&frame.before);
            frame.shifts.vacated.clear();
            frame.halves.read_shown(&known.shown);
            frame.differences.find(&frame.halves);
        }
        if drawn.is_err() {
            drawn = self.draw_capped_picture(wanted, &mut known, ((max_bytes, 0), share), &frame.differences, bytes);
        }
        if bytes.len() > after_text {
            cursor = drawn.unwrap_or_default();
        }
        self.ages.record_wrong(frame.wrong.find(&known.shown, &frame.differences), share);
        self.due = (!frame.wrong.are_all_exact()).then_some(now);
        self.known = Some(known);
        cursor
    }

    /// Appends the picture of a frame under a cap, after its text and its shifts.
    ///
    /// Returns the cursor after the picture.
    fn draw_capped_picture(
        &mut self,
        wanted: &Grid,
        known: &mut TerminalState,
        ((max_bytes, shift_bytes), share_of_deadline): ((usize, usize), f32),
        differences: &Differences,
        bytes: &mut Vec<u8>,
    ) -> Result<KnownCursor, VacatedExceed> {
        let (start, pen) = (bytes.len(), known.pen);
        let TerminalState { shown, pen: pen_after } = known;
        let (half_blocks, order, ages) = (self.half_blocks, self.order, &self.ages);
        let frame = capped::CappedFrame {
            shown,
            wanted,
            differences,
            ages,
            share_of_deadline,
            half_blocks,
            order,
            max_bytes,
            shift_bytes,
        };
        let mut cursor = KnownCursor::Unknown;
        let mut shortage = self.shortage;
        let is_whole = capped::draw(frame, &mut shortage, |grid, changed| {
            bytes.truncate(start);
            *pen_after = pen;
            if !changed.is_empty() {
                cursor = self.write_changed(grid, changed, pen_after, bytes);
            }
            bytes.len() - start
        });
        if is_whole {
            self.shortage = shortage;
        }
        if is_whole { Ok(cursor) } else { Err(VacatedExceed) }
    }
}

/// A lossy frame that fits: the pen and the cursor after it, and when to encode it again.
struct Drawn {
    pen: Pen,
    cursor: KnownCursor,
    due: Option<Duration>,
    /// Whether the frame took over 90 % of the bytes that a frame may take if it makes cells exact.
    is_full: bool,
    /// Whether all cells are within the quality's caps after the frame.
    is_within_caps: bool,
}

/// The failure of a lossy frame: the bytes that it takes, and the fewer bytes that are allowed.
struct Exceeds {
    bytes: usize,
    max_bytes: usize,
}

/// The failure of a frame with shifts: the cells that they vacate take more bytes than are allowed.
struct VacatedExceed;

/// The working memory of a lossy frame.
struct FrameMemory {
    /// The grid to encode: the shown grid with the changes of this frame.
    drawn: Grid,
    /// The grid that the terminal shows after the frame.
    next: Grid,
    /// The grid that the terminal showed before the shifts of this frame.
    before: Grid,
    shifts: ShiftMemory,
    halves: PictureHalves,
    differences: Differences,
    wrong: WrongCells,
}

thread_local! {
    // Working memory per thread instead of per encoder, because a server has many encoders and few threads.
    static FRAME: RefCell<FrameMemory> = RefCell::new({
        let empty = Grid::new(Size::new(0, 0));
        FrameMemory {
            drawn: empty.clone(),
            next: empty.clone(),
            before: empty,
            shifts: ShiftMemory::default(),
            halves: PictureHalves::default(),
            differences: Differences::default(),
            wrong: WrongCells::default(),
        }
    });
}
