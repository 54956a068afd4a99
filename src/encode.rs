//! Encoding of grids: the bytes that change a terminal's screen from one grid to another.
//!
//! Only changed cells are sent, and only the colours that differ from the pen, the state with which the terminal would
//! write now, which is tracked from cell to cell and from frame to frame. What remains to be chosen is the order of the
//! cells, the half block of each, and the moves of the cursor:
//!
//! - [`Order::Raster`] goes row by row. A compressing link (`ssh -C`) sends the fewest bytes with it, because the bytes
//!   resemble those of the frame before.
//! - [`Order::Color`] goes from cell to cell by the colours that they share: about a fifth fewer bytes on a raw link.
//!
//! [`Encoder::encode`] shows exactly the wanted grid. [`Encoder::encode_within`] may show a grid near it for a while
//! (see [`Quality`]), which saves half of a moving picture's bytes or more.
//!
//! [`EncoderBackend`] is an encoder for programs that use ratatui.
//!
//! Only escape sequences are used that every terminal and multiplexer understands: CUP, CUF, CHA, CR, BS, LF, and SGR
//! with `38;2` and `48;2`, 30 to 37 and 40 to 47 for the first eight colours, `7` and `27` (also for spaces in the
//! pen's glyph colour), and `58:2` for the colour of an underline, which terminals without it ignore. None of them
//! repeats, erases or scrolls, except for scrolling that ratatui requests from a backend. If the terminal is known to
//! execute them, shifts use ICH, DCH, IL and DL besides. The terminal has to be in raw mode, in which a line feed keeps
//! the column.

use crate::capabilities::Shifts;
use crate::grid::{Grid, HalfBlocks, PackedCell, Size};

#[cfg(feature = "backend")]
mod backend;
mod by_color;
mod capped;
mod cell_ages;
mod differences;
mod eights;
#[cfg(feature = "backend")]
mod foreign_output;
mod halves;
mod lossy;
mod moves;
mod numbering;
mod numbers;
mod oklab_pairs;
mod palette;
mod pen;
mod shifts;
mod strokes;
mod widths;
mod wrong_cells;

#[cfg(feature = "backend")]
pub use backend::EncoderBackend;
use cell_ages::CellAges;
use differences::Differences;
use moves::{CellPosition, KnownCursor};
pub(crate) use pen::Pen;
use shifts::{ShiftMemory, ShiftTerms};
use std::cell::RefCell;
use std::io::{self, Write};
use std::mem;
use std::time::Duration;
use strokes::Strokes;
use wrong_cells::WrongCells;

/// The order in which cells are sent.
// Bytes per frame relative to ratatui's crossterm backend, for the bench's scenes orbit, plain, sphere and gradient: at
// 80x24 raster .70 .67 .90 .81, color .56 .52 .82 .62; at 200x60 raster .63 .61 .88 .68, color .46 .42 .66 .47. Color
// order takes half a millisecond longer, which is not worth it on a fast link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Order {
    /// Row by row from the top: for links that compress, and for fast links.
    #[default]
    Raster,
    /// Cells of equal colours one after another: for slow links that do not compress.
    Color,
}

/// The accuracy of a moving picture: how far shown colours may differ from the wanted ones.
///
/// Text is always exact, and the picture becomes exact within a second after its last change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quality {
    /// Every half cell has its exact colour.
    #[default]
    Exact,
    /// An invisible difference: every half cell is within 0.01 of its colour in OKLab.
    ///
    /// The peak signal-to-noise ratio of the picture is at least 44 dB.
    Equal,
    /// A hardly visible difference: every half cell is within 0.02 of its colour in OKLab.
    ///
    /// The peak signal-to-noise ratio of the picture is at least 41 dB.
    Fast,
}

/// The limits on a lossy frame: quality, number of bytes, and the time at which it is sent.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// How far the picture's colours may differ from the wanted ones.
    pub quality: Quality,
    /// The time at which the frame is sent, counted from any start that all frames share.
    pub now: Duration,
    /// The largest number of bytes that the frame should take; `None` for no limit.
    ///
    /// While the picture changes, cells get coarser colours, or keep those of earlier frames, so that the frame fits
    /// with a small error. The longer a cell differs visibly, the more its error weighs, so that few differ for over a
    /// second, or over one and a half times as long as frames of the allowed quality would take. At rest, the cells
    /// with the smallest errors wait for a later frame. Cells that are within the quality's caps, and only made
    /// exact, also wait if the frame would take more than 8 bytes per cell of the screen. Text and picture cells that
    /// replace text or unknown contents never wait; with [`Quality::Exact`] no cell does.
    pub max_bytes: Option<usize>,
}

/// An encoder of grids into bytes, which tracks what the terminal shows.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    order: Order,
    half_blocks: HalfBlocks,
    synchronized: bool,
    shifts: Shifts,
    colorless: bool,
    /// The terminal's state; `None` at first and after a resize.
    known: Option<TerminalState>,
    ages: CellAges,
    /// The time at which the cells that are not exact are to be sent; `None` if all are exact.
    due: Option<Duration>,
    shortage: capped::Shortage,
    used_part: lossy::UsedPart,
    /// Whether the last lossy frame took over 90 % of the bytes that a frame may take if it makes
    /// cells exact.
    is_full: bool,
}

/// The state of the terminal, as known from the bytes sent.
#[derive(Clone, Debug)]
struct TerminalState {
    /// The grid that the terminal shows.
    shown: Grid,
    /// The colours and attributes with which the terminal would write the next character.
    pen: Pen,
}

/// Largest number of bytes, per cell of the screen, for a frame that makes lossy cells exact.
// tmux discards pending output above 8 bytes per cell of the screen (its `TTY_BLOCK_START`).
const TMUX_BYTES_PER_CELL: usize = 8;

/// The sequence that begins synchronized output (DEC private mode 2026).
const BEGIN_SYNCHRONIZED: &[u8] = b"\x1b[?2026h";

/// The sequence that ends synchronized output and shows the frame.
const END_SYNCHRONIZED: &[u8] = b"\x1b[?2026l";

impl Encoder {
    /// Returns an encoder for an unknown terminal, in raster order and with lower half blocks only.
    ///
    /// ```
    /// use termtrace::{Encoder, Grid, Order, Size};
    ///
    /// let mut encoder = Encoder::new().with_order(Order::Color);
    /// let mut bytes = Vec::new();
    /// encoder.encode(&Grid::new(Size::new(80, 24)), &mut bytes);
    /// assert!(bytes.starts_with(b"\x1b["));
    ///
    /// bytes.clear();
    /// encoder.encode(&Grid::new(Size::new(80, 24)), &mut bytes);
    /// assert!(bytes.is_empty(), "nothing has changed");
    /// ```
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the order in which cells are sent.
    pub fn with_order(self, order: Order) -> Self {
        Self { order, ..self }
    }

    /// Sets the order in which cells are sent from the next frame on.
    #[cfg(feature = "live")]
    pub(crate) fn set_order(&mut self, order: Order) {
        self.order = order;
    }

    /// Sets the half blocks that cells may use: [`HalfBlocks::Lower`] unless set otherwise.
    ///
    /// With [`HalfBlocks::Either`] a moving picture takes about a tenth fewer bytes. It is right if a cell has an even
    /// number of pixel rows. At odd heights some terminals split the two glyphs a pixel row apart, and a mix of them is
    /// visible.
    pub fn with_half_blocks(self, half_blocks: HalfBlocks) -> Self {
        Self { half_blocks, ..self }
    }

    /// Sets the half blocks that cells may use from the next frame on.
    // The best choice changes when the window moves to a screen whose cells have another height in pixels.
    #[cfg(feature = "live")]
    pub(crate) fn set_half_blocks(&mut self, half_blocks: HalfBlocks) {
        self.half_blocks = half_blocks;
    }

    /// Sets whether frames are enclosed in synchronized output.
    ///
    /// A terminal that supports it shows each frame at once; others ignore the sequences.
    #[doc(hidden)]
    pub fn with_synchronized_output(self, synchronized: bool) -> Self {
        Self { synchronized, ..self }
    }

    /// Sets whether and how the terminal shifts shown cells, where that takes fewer bytes than
    /// writing them.
    ///
    /// The grids must be as large as the terminal's window, which has to execute ICH, DCH, IL and DL, and synchronized
    /// output, without which half-shifted screens would be visible. No scrolling region and no horizontal margins may
    /// be set. Only [`Order::Color`] uses shifts.
    #[doc(hidden)]
    pub fn with_shifts(self, shifts: Shifts) -> Self {
        Self { shifts, ..self }
    }

    /// Sets whether sequences that set or reset colours are sent at all.
    #[doc(hidden)]
    pub fn with_colors(self, colors: bool) -> Self {
        Self { colorless: !colors, ..self }
    }

    /// Forgets the terminal's state: the next frame is drawn whole, and is due at once.
    ///
    /// Call it after each change of the terminal's size, even if the size has changed back since the last frame: a
    /// terminal that becomes smaller loses cells, and the encoder cannot notice that from equal sizes.
    #[doc(hidden)]
    pub fn forget(&mut self) {
        self.known = None;
        self.due = Some(Duration::ZERO);
        self.ages.clear_wrong();
    }

    /// Appends a reset of the pen's colours.
    ///
    /// Other output then does not inherit them, and two terminals that show the same cells are in the same state.
    #[cfg(any(feature = "backend", feature = "serve"))]
    pub(crate) fn reset_pen(&mut self, bytes: &mut Vec<u8>) {
        if let Some(known) = &mut self.known {
            known.pen.switch_to(Pen::default(), bytes);
        }
    }

    /// Appends the bytes that make the terminal show `wanted` exactly; none if it does already.
    pub fn encode(&mut self, wanted: &Grid, bytes: &mut Vec<u8>) {
        let start = bytes.len();
        self.draw(wanted, bytes);
        self.enclose_in_synchronized(start, bytes);
    }

    /// Writes the bytes that make the terminal show `wanted` exactly; nothing if it does already.
    ///
    /// # Errors
    /// If writing fails. The next frame is then drawn whole, as it is unknown how many bytes have arrived.
    #[doc(hidden)]
    pub fn encode_to(&mut self, writer: &mut impl Write, wanted: &Grid) -> io::Result<()> {
        let mut bytes = Vec::new();
        self.encode(wanted, &mut bytes);
        self.send(&bytes, writer)
    }

    /// Appends the bytes that make the terminal show `wanted` or a grid within the allowance.
    #[doc(hidden)]
    pub fn encode_within(&mut self, wanted: &Grid, allowance: Allowance, bytes: &mut Vec<u8>) {
        let start = bytes.len();
        self.draw_within(wanted, allowance, bytes);
        self.enclose_in_synchronized(start, bytes);
    }

    /// Appends a lossy frame without the marks of a synchronized update.
    ///
    /// Returns the cursor after the frame. Its position depends on the terminal in the last column, and after a
    /// grapheme cluster.
    fn draw_within(&mut self, wanted: &Grid, allowance: Allowance, bytes: &mut Vec<u8>) -> KnownCursor {
        let Some(caps) = lossy::QualityCaps::for_quality(allowance.quality) else { return self.draw(wanted, bytes) };
        if self.ages.size() != wanted.size() {
            // A frame of another size takes other numbers of bytes.
            self.shortage = capped::Shortage::default();
        }
        let in_motion = self.ages.record(wanted, allowance.now);
        let mut known = self.take_or_reset_state(wanted.size(), bytes);
        FRAME.with_borrow_mut(|frame| {
            frame.differences.find(&known.shown, wanted);
            // At rest, the cells get their final colours, those with the largest errors first: coarser colours
            // (`draw_capped`) would soon have to be sent again.
            let is_capped = in_motion && frame.differences.appearing <= capped::MAX_APPEARING;
            let cap = allowance.max_bytes.filter(|&max_bytes| is_capped && max_bytes >= capped::LEAST_BYTES);
            if let Some(max_bytes) = cap.filter(|_| self.shortage.is_present()) {
                return self.draw_capped(wanted, known, (max_bytes, allowance.now), frame, bytes);
            }
            let start = bytes.len();
            // Below a cap that leaves out cells, vacated ones, which cannot wait, would take the room of others.
            if is_capped && (cap.is_some() || allowance.max_bytes.is_none()) {
                self.shift(&mut known.shown, wanted, ShiftTerms::EQUAL, frame, bytes);
            }
            self.draw_lossy(wanted, known, (allowance, caps, in_motion, cap), (frame, start), bytes)
        })
    }

    /// Shifts what the terminal shows, where that is cheaper than writing cells: appends the
    /// operations, and updates the shown grid and the differences.
    ///
    /// Returns whether anything has been shifted. The shown grid before it is then in the frame's memory.
    fn shift(
        &self,
        shown: &mut Grid,
        wanted: &Grid,
        terms: ShiftTerms,
        FrameMemory { before, shifts, differences, .. }: &mut FrameMemory,
        bytes: &mut Vec<u8>,
    ) -> bool {
        let uses_shifts = self.order == Order::Color;
        let is_shifted = uses_shifts && shifts.shift([shown, before], wanted, (self.shifts, terms), bytes);
        if is_shifted {
            differences.find(shown, wanted);
            differences.mark_vacated(&shifts.vacated);
        }
        is_shifted
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
            Ok(Drawn { pen, cursor, due, is_full }) => {
                self.is_full = is_full;
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
                    frame.differences.find(&known.shown, wanted);
                }
                self.draw_capped(wanted, known, (max_bytes, allowance.now), frame, bytes)
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
                // All inexact cells are made exact together, when the last of them is due. When each was sent at its
                // own time, a dozen frames of a few scattered cells followed each movement: 1.40 full frames of bytes
                // (orbit, 80x24) instead of 1.14.
                let refines = self.ages.all_exact_at(plan.inexact_cells(writes));
                let due = if is_cut { Some(allowance.now) } else { refines };
                return Ok(Drawn { pen, cursor, due, is_full: is_full(taken) });
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
        (max_bytes, now): (usize, Duration),
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
        }
        let max_bytes = max_bytes.saturating_sub(bytes.len() - start + self.synchronized_len());
        let (after_text, pen) = (bytes.len(), known.pen);
        let mut drawn = Err(VacatedExceed);
        // Vacated cells that do not fit are tried with half of the bytes for shifts, and then without shifts.
        for divisor in [1, 2] {
            let terms = ShiftTerms::at_rate(self.shortage.rate(), max_bytes / divisor);
            if max_bytes < capped::LEAST_BYTES || !self.shift(&mut known.shown, wanted, terms, frame, bytes) {
                break;
            }
            let lens = (max_bytes, bytes.len() - after_text);
            drawn = self.draw_capped_picture(wanted, &mut known, lens, &frame.differences, bytes);
            if drawn.is_ok() {
                break;
            }
            bytes.truncate(after_text);
            known.pen = pen;
            known.shown.clone_from(&frame.before);
            frame.shifts.vacated.clear();
            frame.differences.find(&known.shown, wanted);
        }
        if drawn.is_err() {
            drawn = self.draw_capped_picture(wanted, &mut known, (max_bytes, 0), &frame.differences, bytes);
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
        (max_bytes, shift_bytes): (usize, usize),
        differences: &Differences,
        bytes: &mut Vec<u8>,
    ) -> Result<KnownCursor, VacatedExceed> {
        let (start, pen) = (bytes.len(), known.pen);
        let TerminalState { shown, pen: pen_after } = known;
        let (half_blocks, ages) = (self.half_blocks, &self.ages);
        let frame = capped::CappedFrame { shown, wanted, differences, ages, half_blocks, max_bytes, shift_bytes };
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

    /// Returns the time at which to encode the last grid again if it has not changed.
    ///
    /// That frame sends the cells that are not exact yet. `None` means that all cells are exact.
    #[doc(hidden)]
    pub fn due(&self) -> Option<Duration> {
        self.due
    }

    /// Takes the known state of the terminal. If it is unknown, or of another size, appends a reset
    /// of the colours and returns a state with unknown cells.
    fn take_or_reset_state(&mut self, size: Size, bytes: &mut Vec<u8>) -> TerminalState {
        self.known.take().filter(|known| known.shown.size() == size).unwrap_or_else(|| {
            let mut pen = Pen::default();
            if !self.colorless {
                // The terminal's pen is unknown until a reset.
                pen.reset(bytes);
            }
            TerminalState { shown: Grid::foreign(size), pen }
        })
    }

    /// Appends an exact frame without the marks of a synchronized update.
    ///
    /// Returns the cursor after the frame.
    fn draw(&mut self, wanted: &Grid, bytes: &mut Vec<u8>) -> KnownCursor {
        let mut known = self.take_or_reset_state(wanted.size(), bytes);
        if self.shifts != Shifts::Off {
            FRAME.with_borrow_mut(|frame| self.shift(&mut known.shown, wanted, ShiftTerms::EXACT, frame, bytes));
        }
        let cursor = self.write(wanted, &mut known.shown, &mut known.pen, bytes);
        self.known = Some(known);
        self.due = None;
        self.ages.clear_wrong();
        cursor
    }

    /// Encloses the bytes from `start` in synchronized output, if there are any.
    fn enclose_in_synchronized(&self, start: usize, bytes: &mut Vec<u8>) {
        if self.synchronized && bytes.len() > start {
            bytes.extend_from_slice(BEGIN_SYNCHRONIZED);
            // Whether the frame is empty is known only now, so the beginning sequence is appended and then rotated to
            // the front.
            bytes[start..].rotate_right(BEGIN_SYNCHRONIZED.len());
            bytes.extend_from_slice(END_SYNCHRONIZED);
        }
    }

    /// Returns the number of bytes that [`Self::enclose_in_synchronized`] adds.
    fn synchronized_len(&self) -> usize {
        if self.synchronized { BEGIN_SYNCHRONIZED.len() + END_SYNCHRONIZED.len() } else { 0 }
    }

    /// Writes the bytes to `writer`; on an error, forgets the terminal's state.
    fn send(&mut self, bytes: &[u8], writer: &mut impl Write) -> io::Result<()> {
        if bytes.is_empty() {
            return Ok(());
        }
        writer.write_all(bytes).and_then(|()| writer.flush()).inspect_err(|_| self.forget())
    }

    /// Appends the bytes that change the `shown` grid to `wanted`. Returns the cursor after them.
    fn write(&self, wanted: &Grid, shown: &mut Grid, pen: &mut Pen, bytes: &mut Vec<u8>) -> KnownCursor {
        WRITING.with_borrow_mut(|writing| {
            let mut changed = mem::take(&mut writing.changed);
            update_grid(shown, wanted, &mut changed);
            let cursor = writing.write(self, wanted, &changed, pen, bytes);
            writing.changed = changed;
            cursor
        })
    }

    /// Appends the bytes that write the `changed` cells of `wanted`. Returns the cursor after them.
    fn write_changed(
        &self,
        wanted: &Grid,
        changed: &[CellPosition],
        pen: &mut Pen,
        bytes: &mut Vec<u8>,
    ) -> KnownCursor {
        WRITING.with_borrow_mut(|writing| writing.write(self, wanted, changed, pen, bytes))
    }
}

/// A lossy frame that fits: the pen and the cursor after it, and when to encode it again.
struct Drawn {
    pen: Pen,
    cursor: KnownCursor,
    due: Option<Duration>,
    /// Whether the frame took over 90 % of the bytes that a frame may take if it makes cells exact.
    is_full: bool,
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
    differences: Differences,
    wrong: WrongCells,
}

/// The working memory of the bytes of a frame.
#[derive(Default)]
struct Writing {
    changed: Vec<CellPosition>,
    order: Vec<CellPosition>,
    by_color: by_color::OrderScratch,
    strokes: Strokes,
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
            differences: Differences::default(),
            wrong: WrongCells::default(),
        }
    });
    static WRITING: RefCell<Writing> = RefCell::default();
}

impl Writing {
    /// Appends the bytes that write the `changed` cells of `wanted`, and returns the cursor after
    /// them.
    fn write(
        &mut self,
        encoder: &Encoder,
        wanted: &Grid,
        changed: &[CellPosition],
        pen: &mut Pen,
        bytes: &mut Vec<u8>,
    ) -> KnownCursor {
        let half_blocks = encoder.half_blocks;
        match encoder.order {
            Order::Raster => self.strokes.choose(wanted, changed, half_blocks, *pen),
            Order::Color => {
                by_color::order(wanted, changed, half_blocks, *pen, &mut self.by_color, &mut self.order);
                self.strokes.choose(wanted, &self.order, half_blocks, *pen);
                // Spaces take the glyph colour of the next stroke in this order only. In raster order that costs more
                // bytes than it saves, because a compressor then finds fewer repetitions.
                self.strokes.share_next_fg();
            }
        }
        self.strokes.write(wanted, half_blocks, pen, bytes)
    }
}

/// Makes `shown` equal to `wanted`, and lists the cells to write, row by row.
///
/// Cells that a wide glyph covers, and foreign cells, are never written.
// The grid is updated in place, which saves copying it for each frame.
fn update_grid(shown: &mut Grid, wanted: &Grid, changed: &mut Vec<CellPosition>) {
    changed.clear();
    let columns = usize::from(wanted.size().columns);
    for row in 0..wanted.size().rows {
        let start = usize::from(row) * columns;
        let of_wanted = &wanted.packed()[start..start + columns];
        // Packed cells refer to clusters by number, and each grid has its own numbers: equal cells may have different
        // texts.
        if shown.packed()[start..start + columns] != *of_wanted || of_wanted.iter().any(|cell| cell.is_cluster()) {
            update_row(shown, wanted, start, columns, |column| changed.push(CellPosition { column, row }));
        }
    }
}

/// Makes the row from the index `start` equal in both grids, and calls `write` with the column of
/// each glyph to write.
// The cells after a grapheme cluster are written again with it, because a terminal that shows the cluster's characters
// one by one overwrites them.
fn update_row(shown: &mut Grid, wanted: &Grid, start: usize, columns: usize, mut write: impl FnMut(u16)) {
    let mut safe_from = 0;
    let mut column = 0;
    let row = &wanted.packed()[start..start + columns];
    while column < columns {
        let (own, other) = (shown.packed()[start + column], row[column]);
        let is_ours = !other.is_covered() && !other.is_foreign();
        // The common case first: characters of one column, as in pictures.
        if row.get(column + 1).is_none_or(|next| !next.is_covered()) && !own.is_cluster() && !other.is_cluster() {
            let is_overwritten = column < safe_from;
            if is_ours && (is_overwritten || own != other) {
                shown.set_packed(start + column, other);
                if is_overwritten || !pen::look_alike(own, other) {
                    write(column as u16);
                }
            }
            column += 1;
            continue;
        }
        let end = column + widths::leading_width(&row[column..]);
        let cells = || (column..end).map(|column| (start + column, shown.packed()[start + column], row[column]));
        let is_same = cells().all(|(_, own, other)| shown.is_same(own, wanted, other));
        if is_ours && (column < safe_from || !is_same) {
            let looks_alike = cells().all(|(_, own, other)| look_alike(shown, own, wanted, other));
            // Updated even if both look alike, because cells also record whether they are text, as a panel's blank is,
            // or picture.
            (column..end).for_each(|column| shown.copy_cell(start + column, wanted, row[column]));
            if !looks_alike || column < safe_from {
                write(column as u16);
                if let Some(text) = wanted.cluster(other) {
                    safe_from = safe_from.max(column + widths::max_cluster_width(text));
                }
            }
        }
        column = end;
    }
}

/// Returns whether the cells of two grids look the same in every terminal.
fn look_alike(shown: &Grid, own: PackedCell, wanted: &Grid, other: PackedCell) -> bool {
    if own.is_cluster() || other.is_cluster() {
        return shown.cluster(own) == wanted.cluster(other) && pen::look_alike(own, other.with_glyph_of(own));
    }
    pen::look_alike(own, other)
}

#[cfg(all(test, unit_tests))]
mod tests;
