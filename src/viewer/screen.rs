//! The last frame with the layers over it, and the bytes that update the terminal.

use super::explain::ExplainPanel;
use super::frame::Frame;
use super::help::HelpPanel;
use super::layers::{Canvas, FrameStatistics, Layer, Layers};
use super::legend::Legends;
use super::progress::ProgressPanel;
use super::status::StatusLine;
use super::theme;
use super::tracked::Tracked;
use super::view_layout::INITIAL_WIPE;
use crate::capabilities::{Capabilities, Colors};
use crate::cell::{self, Painter};
use crate::control::{KeyMode, Keymap};
use crate::encode::{Allowance, Encoder, Order, Quality};
use crate::grid::{Grid, HalfBlocks, Size};
use crate::pace::Limit;
use std::time::Duration;

/// Least time between frames that only make colours exact.
// tmux drops output of a pane that sends faster than its client draws; at 30 frames a second it drops none.
const EXACT_COLORS_INTERVAL: Duration = Duration::from_millis(33);

/// Approximate bytes per cell of a frame in which everything moves.
// Two colours of 24 bits cost up to 38 bytes a cell, but neighbours share most of them.
const USUAL_BYTES_PER_CELL: usize = 8;

/// Erases the whole window (ED 2), which many terminals fill with the pen's colour.
const ERASE: &[u8] = b"\x1b[2J";
/// Resets the pen and erases the whole window, in the terminal's own colours.
const RESET_ERASE: &[u8] = b"\x1b[m\x1b[2J";

/// The content that the user is to see, and the state of the terminal.
pub(super) struct Screen {
    content: Tracked<Content>,
    painter: Painter,
    encoder: Encoder,
    /// The wanted grid.
    // Kept, because allocating it takes longer than filling it: with this and the buffer of bytes kept, a key at 200x60
    // causes 210 page faults instead of 571.
    grid: Grid,
    order: Option<Order>,
    quality: Option<Quality>,
    /// Whether the next bytes erase the whole window first.
    erases: bool,
    /// Time at which the last bytes were drawn.
    drawn: Option<Duration>,
    rate: FrameRate,
    /// Time for cells and bytes of the last frame.
    encode: Duration,
}

/// The content that the user is to see.
struct Content {
    frame: Option<Frame>,
    /// Position of the line between two maps, as a share of the width.
    wipe: f32,
    /// Whether the eye flies or orbits.
    moving: KeyMode,
    layers: Layers,
}

impl Content {
    /// Returns the modes of keys on a screen of this size, topmost first.
    fn modes(&self, size: Size) -> Vec<KeyMode> {
        self.layers.modes(theme::area(size), self.moving)
    }
}

impl Screen {
    pub(super) fn new(capabilities: &Capabilities, order: Option<Order>, quality: Option<Quality>) -> Self {
        let mut layers = Layers::default();
        layers.open(Legends);
        Self {
            content: Tracked::new(Content { frame: None, wipe: INITIAL_WIPE, moving: KeyMode::Fly, layers }),
            painter: painter(capabilities),
            encoder: encoder(Encoder::new(), capabilities),
            grid: Grid::new(Size::new(0, 0)),
            order,
            quality,
            erases: false,
            drawn: None,
            rate: FrameRate::default(),
            encode: Duration::ZERO,
        }
    }

    /// Returns the approximate bytes of a frame in which everything moves.
    pub(super) fn usual_bytes(size: Size) -> usize {
        USUAL_BYTES_PER_CELL * size.cell_count()
    }

    /// Adopts new findings about the terminal.
    pub(super) fn set_capabilities(&mut self, capabilities: &Capabilities) {
        let mode = self.painter.mode();
        self.painter = painter(capabilities);
        self.encoder = encoder(std::mem::take(&mut self.encoder), capabilities);
        self.content.touch();
        // The cells on the screen were made with other glyphs or colours, and do not tell what is shown now.
        if mode != self.painter.mode() {
            self.encoder.forget();
        }
        self.encoder.set_half_blocks(capabilities.half_blocks);
    }

    /// Takes a frame, with the time if something moves.
    pub(super) fn take_frame(&mut self, mut frame: Frame, moving: Option<Duration>) {
        let content = &mut *self.content;
        // The line may have been moved while the frame was traced.
        frame.wipe(content.wipe);
        content.layers.take_frame(&frame);
        content.frame = Some(frame);
        self.rate.count(moving);
    }

    /// Moves the line between two maps to this share of the width.
    pub(super) fn wipe_to(&mut self, share: f32) {
        let content = &mut *self.content;
        content.wipe = share.clamp(0.0, 1.0);
        if let Some(frame) = &mut content.frame {
            frame.wipe(content.wipe);
        }
    }

    /// Returns the position of that line.
    pub(super) fn wipe(&self) -> f32 {
        self.content.wipe
    }

    /// Opens a layer and replaces the open one of its type.
    pub(super) fn open<L: Layer>(&mut self, layer: L) {
        self.content.layers.open(layer);
    }

    /// Closes the layer of a type, if open, and returns it.
    pub(super) fn close<L: Layer>(&mut self) -> Option<L> {
        // Without this look, closing nothing would count as a change and draw the screen.
        self.get::<L>()?;
        self.content.layers.close()
    }

    /// Closes the layer of a type when the picture is to show something else.
    pub(super) fn close_quietly<L: Layer>(&mut self) {
        self.content.quietly().layers.close::<L>();
    }

    /// Returns the layer of a type, if open.
    pub(super) fn get<L: Layer>(&self) -> Option<&L> {
        self.content.layers.get()
    }

    /// Opens `layer` unless it is open already; closes the layer of its type if `None`.
    pub(super) fn set<L: Layer + PartialEq>(&mut self, layer: Option<L>) {
        match layer {
            Some(layer) if self.get() == Some(&layer) => {}
            Some(layer) => self.open(layer),
            None => drop(self.close::<L>()),
        }
    }

    /// Returns the last frame.
    pub(super) fn frame(&self) -> Option<&Frame> {
        self.content.frame.as_ref()
    }

    /// Returns whether a frame has been shown.
    pub(super) fn has_shown(&self) -> bool {
        self.drawn.is_some()
    }

    /// Opens the help, turns to its next page, or closes it after the last one.
    pub(super) fn turn_help(&mut self, keymap: &Keymap, size: Size) {
        let page = match self.close::<HelpPanel>() {
            None => Some(HelpPanel::FIRST),
            Some(page) => page.next(keymap, &self.modes(size), theme::area(size)),
        };
        if let Some(page) = page {
            self.open(page);
        }
    }

    /// Returns the modes of keys on a screen of this size, topmost first.
    pub(super) fn modes(&self, size: Size) -> Vec<KeyMode> {
        self.content.modes(size)
    }

    /// Sets whether the eye flies or orbits.
    pub(super) fn set_moving(&mut self, moving: KeyMode) {
        // Compared first, because a write counts as a change.
        if self.content.moving != moving {
            self.content.moving = moving;
        }
    }

    /// Starts or ends the explanation of a pixel.
    pub(super) fn toggle_explaining(&mut self) {
        if self.close::<ExplainPanel>().is_none()
            && let Some(explaining) = self.frame().and_then(ExplainPanel::new)
        {
            self.open(explaining);
        }
    }

    /// Changes the explanation.
    pub(super) fn explain(&mut self, change: impl FnOnce(&mut ExplainPanel, &Frame)) {
        if self.get::<ExplainPanel>().is_none() {
            return;
        }
        let Content { frame, layers, .. } = &mut *self.content;
        if let (Some(explaining), Some(frame)) = (layers.get_mut(), frame) {
            change(explaining, frame);
        }
    }

    /// Forgets what the terminal shows: the next bytes draw everything, with these half blocks.
    ///
    /// They erase the window first if the picture covers only a part of it.
    pub(super) fn redraw(&mut self, half_blocks: HalfBlocks, covers_a_part: bool) {
        self.encoder.forget();
        self.erases = covers_a_part;
        self.encoder.set_half_blocks(half_blocks);
        self.content.touch();
    }

    /// Returns whether the screen differs from the wanted content and can be updated.
    pub(super) fn is_changed(&self, size: Size) -> bool {
        self.content.is_changed() && self.can_show(size)
    }

    /// Returns the time at which the shown colours can be made exact, if they are not.
    pub(super) fn improvable_at(&self, size: Size) -> Option<Duration> {
        let due = self.encoder.due().filter(|_| self.can_show(size))?;
        Some(self.drawn.map_or(due, |drawn| due.max(drawn + EXACT_COLORS_INTERVAL)))
    }

    /// Returns whether the scene is still loading, so that at best a sketch of it is shown.
    pub(super) fn awaits_scene(&self) -> bool {
        self.get::<ProgressPanel>().is_some()
    }

    /// Returns whether there is a frame of this size.
    ///
    /// While a scene is loading and there is none, black serves as a background for panels.
    fn can_show(&self, size: Size) -> bool {
        let Some(frame) = self.frame() else { return self.awaits_scene() };
        // After a resize the old frame would be cut off or leave a part of the window empty.
        let wanted = cell::resolution(self.painter.mode(), size, 1.0);
        wanted.is_ok_and(|wanted| (frame.picture.width, frame.picture.height) == (wanted.width(), wanted.height()))
    }

    /// Appends the bytes that bring the terminal to the wanted content.
    pub(super) fn draw(
        &mut self,
        size: Size,
        keymap: &Keymap,
        limit: Option<Limit>,
        now: Duration,
        bytes: &mut Vec<u8>,
    ) {
        let slow = limit.and_then(|limit| limit.rate);
        let figures = FrameStatistics { encode: self.encode, frames_per_second: self.rate.frames_per_second, slow };
        let cell_mode = self.painter.mode();
        // Drawing a panel may update its scroll position, which must not count as a change: the loop would never rest.
        self.content.settle();
        let content = self.content.quietly();
        let grid = &mut self.grid;
        match &content.frame {
            Some(frame) => self.painter.paint(&frame.picture, grid),
            None => grid.clear(size),
        }
        let area = theme::area(grid.size());
        let status_rows = content.layers.get::<StatusLine>().map_or(0, |_| StatusLine::rows(area));
        let modes = content.modes(grid.size());
        content.layers.draw(&mut Canvas {
            grid: &mut *grid,
            cell_mode,
            keymap,
            modes: &modes,
            frame: content.frame.as_ref(),
            figures,
            status_rows,
        });
        // Order by colour saves bytes, but takes 0.5 ms longer, which a fast link does not give back.
        let (usual, order) =
            if limit.is_some() { (Quality::Equal, Order::Color) } else { (Quality::Exact, Order::Raster) };
        self.encoder.set_order(self.order.unwrap_or(order));
        if std::mem::take(&mut self.erases) {
            bytes.extend_from_slice(if cell_mode.colors == Colors::None { ERASE } else { RESET_ERASE });
        }
        let max_bytes = limit.map(|limit| limit.max_bytes);
        let allowance = Allowance { quality: self.quality.unwrap_or(usual), now, max_bytes };
        self.encoder.encode_within(grid, allowance, bytes);
        self.drawn = Some(now);
    }

    /// Records the time for making and encoding the cells.
    pub(super) fn record_encode_time(&mut self, encode: Duration) {
        self.encode = encode;
    }
}

fn painter(capabilities: &Capabilities) -> Painter {
    Painter::new(capabilities.cell_mode).with_light_background(capabilities.light_background)
}

fn encoder(encoder: Encoder, capabilities: &Capabilities) -> Encoder {
    let has_colors = capabilities.cell_mode.colors != Colors::None;
    encoder.with_colors(has_colors).with_synchronized_output(capabilities.synchronized_output)
}

/// A count of the frames shown per second while something moves.
#[derive(Default)]
struct FrameRate {
    last: Option<Duration>,
    frames_per_second: Option<f32>,
}

impl FrameRate {
    /// Counts a frame shown at `time`, or at rest if `None`.
    ///
    /// A pause ends the count, because frames before it say nothing about those after it.
    fn count(&mut self, moving: Option<Duration>) {
        let between = self.last.zip(moving).map(|(last, now)| now.saturating_sub(last));
        self.last = moving;
        // An interval of 0 would be infinitely many frames a second.
        self.frames_per_second =
            between.filter(|&between| between < MAX_MOTION_GAP && between > Duration::ZERO).map(|between| {
                let now = 1.0 / between.as_secs_f32();
                // An exponential mean over about eight frames, because a figure that changes 60 times a second is
                // unreadable.
                self.frames_per_second.map_or(now, |mean| mean + (now - mean) / 8.0)
            });
    }
}

/// Longest time between two frames of one motion.
const MAX_MOTION_GAP: Duration = Duration::from_millis(500);

#[cfg(all(test, unit_tests))]
mod tests;
