//! An encoder whose bytes four terminals read; after each frame they are asked.

use super::near::{Caps, assert_text_is_exact, assert_within, distance, halves, square};
use super::screens::{Clusters, Loss, Screens};
use std::time::Duration;
use termtrace::internals::capabilities::Shifts;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{Cell, Encoder, Grid, Ink, Order, Quality, Size};

/// The encoder, and the terminals.
pub(crate) struct Watched {
    encoder: Encoder,
    half_blocks: HalfBlocks,
    has_shifts: bool,
    asserts_belief: bool,
    clusters: Clusters,
    screens: Screens,
    /// The last wanted grid. (A blank of text looks like one of the picture.)
    last: Option<Grid>,
    /// Whether the encoder knows the screens. If not, it has to draw the whole picture, whatever
    /// the limit.
    is_known: bool,
    /// The lengths of the pieces in which the terminals read, which repeat.
    pieces: Vec<usize>,
    /// The mark of the next frame that is lost.
    loss: Option<Loss>,
    /// The bytes of the last frame.
    sent: Vec<u8>,
}

/// The time and bytes from a frame until all is exact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rest {
    pub(crate) bytes: usize,
    pub(crate) after: Duration,
}

impl Watched {
    pub(crate) fn new(order: Order, half_blocks: HalfBlocks, size: Size, clusters: Clusters) -> Self {
        let encoder = Encoder::new().with_order(order).with_half_blocks(half_blocks);
        Self {
            encoder,
            half_blocks,
            has_shifts: false,
            asserts_belief: false,
            clusters,
            screens: Screens::disturbed(size, clusters),
            last: None,
            is_known: false,
            pieces: vec![usize::MAX],
            loss: None,
            sent: Vec::new(),
        }
    }

    /// Makes the terminals read pieces of these lengths from now on, which are not 0.
    pub(crate) fn in_pieces(self, pieces: Vec<usize>) -> Self {
        Self { pieces, ..self }
    }

    /// Lets the encoder shift what the terminals show.
    pub(crate) fn with_shifts(self, shifts: Shifts) -> Self {
        Self { encoder: self.encoder.with_shifts(shifts), has_shifts: true, ..self }
    }

    /// Asserts after each lossy frame that the encoder believes what the terminals show.
    ///
    /// The wanted grids must have no upper half blocks, of which it may have written the other form.
    pub(crate) fn asserting_belief(self) -> Self {
        Self { asserts_belief: true, ..self }
    }

    /// Makes each frame a synchronized update.
    pub(crate) fn synchronized(self) -> Self {
        Self { encoder: self.encoder.with_synchronized_output(true), ..self }
    }

    /// Makes the next frame lose a mark of its synchronized update.
    pub(crate) fn lose(&mut self, loss: Option<Loss>) {
        self.loss = loss;
    }

    /// Returns the bytes of the last frame.
    pub(crate) fn sent(&self) -> &[u8] {
        &self.sent
    }

    /// Returns the cells that the terminals show.
    pub(crate) fn shown(&self) -> &[Cell] {
        self.screens.shown()
    }

    #[track_caller]
    fn feed(&mut self, bytes: Vec<u8>) {
        if let Some(loss) = self.loss.take().filter(|_| !bytes.is_empty()) {
            self.screens.feed_losing(loss, &self.pieces, &bytes);
        } else {
            self.screens.feed_in(&self.pieces, &bytes);
            assert!(bytes.is_empty() || !self.screens.is_held(), "a synchronized update has no end");
        }
        self.sent = bytes;
    }

    /// Resizes the window.
    ///
    /// The encoder notices a new size by the next frame; if that has the last frame's size again, it has to be told.
    pub(crate) fn resize(&mut self, size: Size) {
        if self.last.as_ref().is_some_and(|last| last.size() == size) {
            self.encoder.forget();
        }
        self.is_known = false;
        self.screens.resize(size);
    }

    /// Writes on the screen as another program, and tells the encoder so.
    pub(crate) fn disturb(&mut self, size: Size) {
        self.is_known = false;
        self.screens = Screens::disturbed(size, self.clusters);
        self.encoder.forget();
    }

    /// Sends a frame that is exact at once; how many bytes that took.
    #[track_caller]
    pub(crate) fn send(&mut self, wanted: &Grid) -> usize {
        let mut bytes = Vec::new();
        self.encoder.encode(wanted, &mut bytes);
        let length = bytes.len();
        self.feed(bytes);
        self.last = Some(wanted.clone());
        self.is_known = true;
        self.assert_exact(wanted);
        let mut more = Vec::new();
        self.encoder.encode(wanted, &mut more);
        assert!(more.is_empty(), "nothing has changed, and {:?} is sent", String::from_utf8_lossy(&more));
        length
    }

    #[track_caller]
    fn assert_exact(&self, wanted: &Grid) {
        if self.half_blocks == HalfBlocks::Either {
            self.screens.assert_show_halves(wanted);
        } else {
            self.screens.assert_show(wanted);
        }
        assert_eq!(self.encoder.due(), None, "all is exact");
    }

    /// Sends a frame that may be near the wanted one; how many bytes that took.
    #[track_caller]
    pub(crate) fn send_within(&mut self, wanted: &Grid, allowance: Allowance) -> usize {
        let before = self.pictures_shown();
        let mut bytes = Vec::new();
        self.encoder.encode_within(wanted, allowance, &mut bytes);
        let length = bytes.len();
        self.feed(bytes);
        let seen = assert_text_is_exact(&self.screens, wanted);
        let caps = Caps::of(allowance.quality);
        match allowance.max_bytes {
            Some(most) if allowance.quality != Quality::Exact => {
                assert_limited(&before, &seen, wanted, (length, most));
                // A shift counts errors up to that of a cell that is worth writing: a few may grow beyond it.
                if !self.has_shifts {
                    assert_nearer(caps, &before, &seen, wanted);
                }
            }
            _ => assert_within(caps, &seen, wanted),
        }
        self.last = Some(wanted.clone());
        self.is_known = true;
        self.assert_due(&seen, wanted, allowance);
        if self.asserts_belief {
            self.assert_believed(&seen);
        }
        length
    }

    /// Returns the sum of the squared differences of all halves on the screen from those wanted.
    pub(crate) fn error(&self, wanted: &Grid) -> u64 {
        let seen = assert_text_is_exact(&self.screens, wanted);
        let all = (0..wanted.size().cell_count()).filter_map(|at| Some((halves(seen.at(at))?, halves(wanted.at(at))?)));
        all.map(|(seen, wanted)| u64::from(square(seen[0], wanted[0]) + square(seen[1], wanted[1]))).sum()
    }

    /// Asserts that the encoder believes what the terminals show: to show it exactly takes no
    /// bytes.
    #[track_caller]
    fn assert_believed(&self, seen: &Grid) {
        let mut shown = seen.clone();
        for at in 0..seen.size().cell_count() {
            // Without upper half blocks of its own, the encoder takes one for text.
            let is_text = self.half_blocks == HalfBlocks::Lower && seen.at(at).glyph == '▀';
            if let Some([upper, lower]) = halves(seen.at(at)).filter(|_| !is_text) {
                let (ink, bg) = (Ink::Rgb(lower), Ink::Rgb(upper));
                let cell = if ink == bg { Cell::new(' ', Ink::Default, bg) } else { Cell::new('▄', ink, bg) };
                shown.set_at(at, &cell);
            }
        }
        let mut bytes = Vec::new();
        self.encoder.clone().with_shifts(Shifts::Off).encode(&shown, &mut bytes);
        assert!(bytes.is_empty(), "the encoder believes another screen: {:?}", String::from_utf8_lossy(&bytes));
    }

    /// Returns the picture's cells that the screen is known to show, and a mark where it shows
    /// text.
    fn pictures_shown(&self) -> Vec<Cell> {
        let last = self.last.iter().flat_map(Grid::cells).map(|cell| halves(cell).is_some());
        let is_picture = last.chain(std::iter::repeat(true)).map(|is| is && self.is_known);
        self.screens
            .shown()
            .iter()
            .zip(is_picture)
            .map(|(cell, is)| if is { cell.clone() } else { Cell::BLANK })
            .collect()
    }

    /// Asserts that a frame is due if any cell is not exact, and that none is sent before.
    #[track_caller]
    fn assert_due(&mut self, seen: &Grid, wanted: &Grid, allowance: Allowance) {
        let is_exact = seen.cells().zip(wanted.cells()).all(|(a, b)| halves(a) == halves(b));
        assert_eq!(self.encoder.due().is_none(), is_exact, "due: {:?}", self.encoder.due());
        let Some(due) = self.encoder.due() else { return };
        assert!(due >= allowance.now, "{due:?} is before {:?}", allowance.now);
        if due > allowance.now {
            let mut more = Vec::new();
            self.encoder.encode_within(wanted, allowance, &mut more);
            assert!(more.is_empty(), "nothing is due, and {:?} is sent", String::from_utf8_lossy(&more));
            assert_eq!(self.encoder.due(), Some(due), "what is due does not change");
        }
    }

    /// Sends the wanted grid whenever a frame is due, until all is exact and stays so.
    #[track_caller]
    pub(crate) fn rest(&mut self, wanted: &Grid, from: Allowance) -> Rest {
        let mut rest = Rest { bytes: 0, after: Duration::ZERO };
        // A frame for each cell that a limit lets through, coarse and then exact, and for each time at which one was
        // changed.
        let mut left = 2 * wanted.size().cell_count() + 40;
        while let Some(due) = self.encoder.due() {
            rest.after = due.saturating_sub(from.now);
            rest.bytes += self.send_within(wanted, Allowance { now: due, ..from });
            left = left.checked_sub(1).expect("something is due for ever");
        }
        self.screens.assert_show_halves(wanted);
        let mut more = Vec::new();
        self.encoder.encode_within(wanted, Allowance { now: from.now + Duration::from_secs(99), ..from }, &mut more);
        assert!(more.is_empty(), "all is exact, and {:?} is sent", String::from_utf8_lossy(&more));
        rest
    }

    /// Asserts that all is exact, and no frame is due.
    #[track_caller]
    pub(crate) fn assert_rests(&self, what: &str) {
        assert_eq!(self.encoder.due(), None, "{what}: a frame is due");
    }

    /// Returns the peak signal-to-noise ratio of the picture that is shown, in decibels.
    pub(crate) fn psnr(&self, wanted: &Grid) -> f64 {
        let cells = self.screens.shown().iter().zip(wanted.cells());
        let pairs = cells.filter_map(|(shown, wanted)| Some([halves(shown)?, halves(wanted)?]));
        let squares = pairs.flat_map(|[shown, wanted]| [square(shown[0], wanted[0]), square(shown[1], wanted[1])]);
        let sum: u32 = squares.sum();
        10.0 * libm::log10(255.0 * 255.0 * (6 * wanted.cells().len()) as f64 / f64::from(sum))
    }

    /// Asserts that these cells have their exact colours.
    #[track_caller]
    pub(crate) fn assert_exact_at(&self, places: impl Iterator<Item = usize>, wanted: &Grid) {
        for at in places {
            let (shown, wanted) = (&self.screens.shown()[at], wanted.at(at));
            assert!(halves(&wanted).is_some(), "only the picture is asked for");
            assert_eq!(halves(shown), halves(wanted), "cell {at}");
        }
    }

    /// Asserts that no cell is written with its upper half: all are as wanted but for the colours.
    #[track_caller]
    pub(crate) fn assert_no_upper_half(&self) {
        assert!(self.screens.shown().iter().all(|cell| cell.glyph != '▀'), "an upper half is shown");
    }
}

/// Returns the halves before, after and wanted of each cell for which all three are a picture's.
fn pictures<'a>(
    before: &'a [Cell],
    seen: &'a Grid,
    wanted: &'a Grid,
) -> impl Iterator<Item = [[termtrace::Srgb8; 2]; 3]> {
    let cells = before.iter().zip(seen.cells()).zip(wanted.cells());
    cells.filter_map(|((before, seen), wanted)| Some([halves(before)?, halves(seen)?, halves(wanted)?]))
}

/// Asserts that a limit is kept.
///
/// A frame over the limit has no cell that could be delayed but the one that every frame may have.
#[track_caller]
fn assert_limited(before: &[Cell], seen: &Grid, wanted: &Grid, (bytes, most): (usize, usize)) {
    let written = pictures(before, seen, wanted).filter(|[before, seen, _]| before != seen).count();
    assert!(bytes <= most || written <= 1, "{bytes} bytes for {written} cells, where {most} are allowed");
}

/// Asserts that a frame brings the picture no further from the wanted one.
///
/// A half cell within the quality's distance may get any colour within it: such a difference is invisible, and the frame
/// saves bytes by it.
#[track_caller]
fn assert_nearer(caps: Caps, before: &[Cell], seen: &Grid, wanted: &Grid) {
    let (mut error_before, mut error_after) = (0, 0);
    for [before, seen, wanted] in pictures(before, seen, wanted) {
        for half in 0..2 {
            error_before += u64::from(square(before[half], wanted[half]));
            if distance(seen[half], wanted[half]) > caps.distance + 1e-6 {
                error_after += u64::from(square(seen[half], wanted[half]));
            }
        }
    }
    assert!(error_after <= error_before, "the squared error grew from {error_before} to {error_after}");
}
