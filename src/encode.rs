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
use crate::grid::{Grid, HalfBlocks, Size};

#[cfg(feature = "backend")]
mod backend;
mod by_color;
mod capped;
mod cell_ages;
mod changes;
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
mod within;
mod wrong_cells;

#[cfg(feature = "backend")]
pub use backend::EncoderBackend;
use cell_ages::CellAges;
use changes::update_grid;
use moves::{CellPosition, KnownCursor};
pub(crate) use pen::Pen;
use std::cell::RefCell;
use std::io::{self, Write};
use std::mem;
use std::time::Duration;
use strokes::Strokes;

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
    /// second, or over one and a half times as long as frames of the allowed quality would take. When the picture stops
    /// changing, frames continue like this until errors are small; then cells get their final colours, and those with
    /// the smallest errors wait for a later frame. Cells that are within the quality's caps, and only made exact, also
    /// wait if the frame would take more than 8 bytes per cell of the screen. Text and picture cells that replace text
    /// or unknown contents never wait; with [`Quality::Exact`] no cell does.
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
        if self.uses_shifts() {
            self.shift_exactly(&mut known.shown, wanted, bytes);
        }
        let cursor = self.write(wanted, &mut known.shown, &mut known.pen, bytes);
        self.known = Some(known);
        self.due = None;
        self.shortage = capped::Shortage::default();
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

#[cfg(all(test, unit_tests))]
mod tests;
