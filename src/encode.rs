//! Grid -> bytes: what to write so that a terminal that shows one grid shows another.
//!
//! Only cells that changed are sent, only the colour that differs, and the pen (the colours the terminal would write
//! with now) is kept from cell to cell and from frame to frame. What is left to choose is the order of the cells, the
//! glyph of each, and the way of the cursor from one to the next:
//!
//! - [`Order::Raster`] goes row by row. What a compressing link (`ssh -C`) sends after it is smallest, because its
//!   neighbourhoods are those of the frame before.
//! - [`Order::Color`] goes from cell to cell by the colours they share: about a fifth less on a raw link.
//!
//! [`Encoder::encode`] shows exactly what is wanted. [`Encoder::encode_within`] may show something near it for a while
//! (see [`Quality`]), which halves the bytes of a moving picture or better.
//!
//! [`EncoderBackend`] is an encoder for ratatui's programs.
//!
//! The escape sequences used are the safe core that every terminal and multiplexer understands: CUP, CUF, CHA, CR, BS,
//! LF and SGR with `38;2`/`48;2`, with 30 to 37 and 40 to 47 for the first eight colours, with `7`/`27` (also for
//! spaces of a colour that the pen has for glyphs), and with `58:2`, the colour of an underline, which those that do
//! not know it pass over. Nothing that repeats, erases or scrolls, but what ratatui asks a backend to scroll. A
//! terminal in raw mode is taken for granted: a line feed keeps the column.

use crate::grid::{Cell, Glyph, Grid, HalfBlocks, Size};

#[cfg(feature = "backend")]
mod backend;
mod by_color;
mod change_times;
#[cfg(feature = "backend")]
mod foreign_output;
mod halves;
mod lossy;
mod moves;
mod numbers;
mod palette;
mod pen;
mod strokes;
mod widths;

#[cfg(feature = "backend")]
pub use backend::EncoderBackend;
use change_times::ChangeTimes;
use moves::CellPosition;
pub(crate) use pen::Pen;
use std::io::{self, Write};
use std::time::Duration;

/// The order in which cells are sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Order {
    /// Row by row from the top: for links that compress.
    #[default]
    Raster,
    /// So that colours are reused: for links that do not.
    Color,
}

/// How near a moving picture is to the wanted one. Text is always exact, and so is the picture within a second after it
/// last changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quality {
    /// Every half cell has its colour.
    #[default]
    Exact,
    /// Nobody sees a difference: every half cell is within 0.01 of its colour in OKLab, and the picture has a peak
    /// signal-to-noise ratio of 44 dB or more.
    Equal,
    /// Hardly anybody does: within 0.02, and 41 dB.
    Fast,
}

/// What a frame may differ in, and what it may take.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// How near to the wanted picture it is.
    pub quality: Quality,
    /// When it is sent, from any start that all frames share.
    pub now: Duration,
    /// The most bytes that it should take: what does not fit, the least errors, waits for a later frame, even if it
    /// exceeds the quality's caps. `None`: nothing that exceeds them waits. Exact colours also wait beyond 8 bytes for
    /// each cell of the screen, of which tmux throws away what it cannot take. (Text never waits, nor what has to
    /// replace text or an unknown screen, nor the largest error, and with [`Quality::Exact`] nothing does.)
    pub max_bytes: Option<usize>,
}

/// Turns wanted grids into bytes, and remembers what the terminal shows.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    order: Order,
    half_blocks: HalfBlocks,
    synchronized: bool,
    colorless: bool,
    /// Nothing at first and after a resize.
    known: Option<TerminalState>,
    change_times: ChangeTimes,
    due: Option<Duration>,
}

/// What is known of the terminal.
#[derive(Clone, Debug)]
struct TerminalState {
    /// What it shows.
    shown: Grid,
    /// What it would write with now.
    pen: Pen,
}

/// tmux holds back what it cannot pass on, and throws it away when it is more than this for each cell of the screen
/// (its `TTY_BLOCK_START`).
const TMUX_BYTES_PER_CELL: usize = 8;

/// What makes a terminal hold the screen back (DEC private mode 2026).
const BEGIN_SYNCHRONIZED: &[u8] = b"\x1b[?2026h";

/// What makes it show all that has come since.
const END_SYNCHRONIZED: &[u8] = b"\x1b[?2026l";

impl Encoder {
    /// For a terminal of which nothing is known: row by row, every cell with the character that it has in the grid.
    pub fn new() -> Self {
        Self::default()
    }

    /// In that order.
    pub fn with_order(self, order: Order) -> Self {
        Self { order, ..self }
    }

    /// The same for an encoder in use.
    #[cfg(feature = "live")]
    pub(crate) fn set_order(&mut self, order: Order) {
        self.order = order;
    }

    /// Whether a half-block cell may be written with either half, whichever saves a change of colour: right where a
    /// cell has an even number of pixel rows. At odd heights some terminals split the two glyphs a pixel row apart, and
    /// their mix would show.
    #[doc(hidden)]
    pub fn with_half_blocks(self, half_blocks: HalfBlocks) -> Self {
        Self { half_blocks, ..self }
    }

    /// The same for an encoder in use: a window may have come to other cells.
    #[cfg(feature = "live")]
    pub(crate) fn set_half_blocks(&mut self, half_blocks: HalfBlocks) {
        self.half_blocks = half_blocks;
    }

    /// Whether frames stand in the brackets of synchronized output: a terminal that knows them shows each frame at
    /// once, others pass over them.
    #[doc(hidden)]
    pub fn with_synchronized_output(self, synchronized: bool) -> Self {
        Self { synchronized, ..self }
    }

    /// Whether the terminal is told anything of colours: where not, not even to go back to its own.
    #[doc(hidden)]
    pub fn with_colors(self, colors: bool) -> Self {
        Self { colorless: !colors, ..self }
    }

    /// From here on nothing is known of the screen: the next frame is drawn whole, and is due at once.
    ///
    /// To be called when the terminal's size has changed, even if it has changed back since the last frame: a terminal
    /// that becomes smaller loses what no longer fits, and from equal sizes the encoder cannot tell.
    #[doc(hidden)]
    pub fn forget(&mut self) {
        self.known = None;
        self.due = Some(Duration::ZERO);
    }

    /// Appends the bytes that make the terminal show `wanted`, exactly; none if it does already.
    pub fn encode(&mut self, wanted: &Grid, bytes: &mut Vec<u8>) {
        let start = bytes.len();
        self.draw(wanted, bytes);
        self.bracket(start, bytes);
    }

    /// Writes the bytes that make the terminal show `wanted`, exactly, all at once; nothing if it does already.
    ///
    /// # Errors
    /// If the writer has one. As nobody knows then how much has arrived, the next frame is drawn whole.
    #[doc(hidden)]
    pub fn encode_to(&mut self, writer: &mut impl Write, wanted: &Grid) -> io::Result<()> {
        let mut bytes = Vec::new();
        self.encode(wanted, &mut bytes);
        self.send(&bytes, writer)
    }

    /// Appends the bytes that make the terminal show `wanted`, or something near it for a while; none if it does
    /// already.
    #[doc(hidden)]
    pub fn encode_within(&mut self, wanted: &Grid, allowance: Allowance, bytes: &mut Vec<u8>) {
        let start = bytes.len();
        self.draw_within(wanted, allowance, bytes);
        self.bracket(start, bytes);
    }

    /// Appends such a frame without its brackets; returns where the cursor is after it, if that is certain.
    fn draw_within(&mut self, wanted: &Grid, allowance: Allowance, bytes: &mut Vec<u8>) -> Option<CellPosition> {
        let Some(caps) = lossy::QualityCaps::of(allowance.quality) else { return self.draw(wanted, bytes) };
        self.change_times.record(wanted, allowance.now);
        let known = self.take_state(wanted.size(), bytes);
        let has_waited = |at| self.change_times.exact_at(at) <= allowance.now;
        let plan = lossy::Plan::new(lossy::LossyFrame {
            shown: &known.shown,
            wanted,
            caps,
            half_blocks: self.half_blocks,
            pen: [known.pen.fg, known.pen.bg],
            has_waited: &has_waited,
        });
        let max_bytes = allowance.max_bytes.unwrap_or(usize::MAX);
        let usual = max_bytes.min(TMUX_BYTES_PER_CELL * wanted.size().cell_count());
        let refines_from = plan.min_writes(true);
        let mut writes = plan.writes();
        let start = bytes.len();
        let (next, cursor) = loop {
            let mut next = known.clone();
            let cursor = self.write(&plan.grid(writes), &mut next, bytes);
            let taken = bytes.len() - start + self.bracket_len();
            let refines = writes > refines_from;
            let (limit, fewest) = if refines { (usual, refines_from) } else { (max_bytes, plan.min_writes(false)) };
            // One at least, or all might wait for ever.
            let fewest = fewest.max(1);
            if taken <= limit || writes <= fewest {
                break (next, cursor);
            }
            bytes.truncate(start);
            // A little less than the share that fits, so that few tries are needed.
            writes = (writes * limit / taken * 31 / 32).clamp(fewest, writes - 1);
        };
        let is_cut = writes < plan.writes();
        // All at once, when the last of them is due: one after another they take more bytes.
        let refines = plan.inexact(&next.shown).map(|at| self.change_times.exact_at(at)).max();
        self.due = if is_cut { Some(allowance.now) } else { refines };
        self.known = Some(next);
        cursor
    }

    /// When to encode the last wanted grid again, if nothing else is wanted until then: what is not shown exactly yet
    /// is to be so then. `None`: all is exact, and nothing would be sent.
    #[doc(hidden)]
    pub fn due(&self) -> Option<Duration> {
        self.due
    }

    /// What is known of a terminal of that size.
    fn take_state(&mut self, size: Size, bytes: &mut Vec<u8>) -> TerminalState {
        self.known.take().filter(|known| known.shown.size() == size).unwrap_or_else(|| {
            let mut pen = Pen::default();
            if !self.colorless {
                // Whatever the pen was, it is known from here on.
                pen.reset(bytes);
            }
            TerminalState { shown: Grid::foreign(size), pen }
        })
    }

    /// A frame without its brackets; where the cursor is after it, if that is sure.
    fn draw(&mut self, wanted: &Grid, bytes: &mut Vec<u8>) -> Option<CellPosition> {
        let mut known = self.take_state(wanted.size(), bytes);
        let cursor = self.write(wanted, &mut known, bytes);
        self.known = Some(known);
        self.due = None;
        cursor
    }

    /// Puts the frame that begins there into its brackets, if there is anything in it.
    fn bracket(&self, start: usize, bytes: &mut Vec<u8>) {
        if self.synchronized && bytes.len() > start {
            bytes.extend_from_slice(BEGIN_SYNCHRONIZED);
            bytes[start..].rotate_right(BEGIN_SYNCHRONIZED.len());
            bytes.extend_from_slice(END_SYNCHRONIZED);
        }
    }

    fn bracket_len(&self) -> usize {
        if self.synchronized { BEGIN_SYNCHRONIZED.len() + END_SYNCHRONIZED.len() } else { 0 }
    }

    fn send(&mut self, bytes: &[u8], writer: &mut impl Write) -> io::Result<()> {
        if bytes.is_empty() {
            return Ok(());
        }
        writer.write_all(bytes).and_then(|()| writer.flush()).inspect_err(|_| self.forget())
    }

    /// Appends the bytes that make the terminal show the grid; where the cursor is after them, if that is sure.
    fn write(&self, wanted: &Grid, known: &mut TerminalState, bytes: &mut Vec<u8>) -> Option<CellPosition> {
        let changed = update(&mut known.shown, wanted);
        let strokes = match self.order {
            Order::Raster => strokes::choose(wanted, &changed, self.half_blocks, known.pen),
            Order::Color => {
                let order = by_color::order(wanted, &changed, self.half_blocks, known.pen);
                let mut strokes = strokes::choose(wanted, &order, self.half_blocks, known.pen);
                // Not row by row: a compressor finds fewer repetitions then, which costs more than this saves.
                strokes::share_next_fg(wanted, &mut strokes);
                strokes
            }
        };
        strokes::write(wanted, &strokes, self.half_blocks, &mut known.pen, bytes)
    }
}

/// Makes the grid show what is wanted; the positions that are to be written for it, row by row. A covered cell is never
/// one, nor a foreign one.
fn update(shown: &mut Grid, wanted: &Grid) -> Vec<CellPosition> {
    let mut changed = Vec::new();
    for ((shown, wanted), row) in shown.rows_mut().zip(wanted.rows()).zip(0..) {
        update_row(shown, wanted, |column| changed.push(CellPosition { column, row }));
    }
    changed
}

/// What stands behind a cluster is written again with it: a terminal that takes the cluster apart has written over it.
fn update_row(shown: &mut [Cell], wanted: &[Cell], mut write: impl FnMut(u16)) {
    let mut safe_from = 0;
    let mut column = 0;
    while column < wanted.len() {
        let end = column + widths::leading_width(&wanted[column..]);
        let (shown, wanted) = (&mut shown[column..end], &wanted[column..end]);
        let is_ours = !matches!(wanted[0].glyph, Glyph::Covered | Glyph::Foreign);
        if is_ours && (column < safe_from || shown != wanted) {
            let looks_alike = shown.iter().zip(wanted).all(|(shown, wanted)| pen::look_alike(shown, wanted));
            // Also where it looks alike: a panel's blank is not the picture's.
            shown.clone_from_slice(wanted);
            if !looks_alike || column < safe_from {
                write(column as u16);
                if let Glyph::Cluster(text) = &wanted[0].glyph {
                    safe_from = safe_from.max(column + widths::max_cluster_width(text));
                }
            }
        }
        column = end;
    }
}
