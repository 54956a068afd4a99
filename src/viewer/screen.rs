//! The last frame with the layers over it, and the bytes that update the terminal.

use super::explain::ExplainPanel;
use super::frame::Frame;
use super::help::{HelpKey, HelpPanel};
use super::layers::{Canvas, FrameStatistics, Layer, Layers};
use super::legend::Legends;
use super::note::Note;
use super::orders::RenderOrdersPanel;
use super::progress::ProgressPanel;
use super::status::StatusLine;
use super::theme;
use super::tracked::Tracked;
use super::view_layout::INITIAL_WIPE;
use crate::capabilities::{Capabilities, Colors, Shifts};
use crate::cell::{self, Painter};
use crate::control::{KeyMode, Keymap};
use crate::encode::{Allowance, Encoder, Order, Quality};
use crate::grid::{Grid, HalfBlocks, Size};
use crate::pace::Limit;
use std::time::Duration;

/// Least time between two frames that only replace approximate colours by exact ones.
// tmux drops the output of a pane that sends faster than its client draws; at 30 frames a second it drops none.
const EXACT_COLORS_INTERVAL: Duration = Duration::from_millis(33);

/// Approximate bytes per cell of a frame in which every cell changes.
// A cell with two colours of 24 bits costs up to 38 bytes, but most cells share colours with their neighbours.
const USUAL_BYTES_PER_CELL: usize = 8;

/// The sequence that erases the whole window (ED 2). Many terminals fill it with the pen's
/// background colour.
const ERASE: &[u8] = b"\x1b[2J";
/// The sequence that resets the pen and erases the whole window, which then has the terminal's
/// default background.
const RESET_ERASE: &[u8] = b"\x1b[m\x1b[2J";

/// The sequences that reset the margins of a program that was killed, but neither cursor nor pen.
// Without margins, which make no difference to cells that are written, each shift moves whole rows. DECSTBM moves the
// cursor, which is saved and restored.
const RESET_MARGINS: &[u8] = b"\x1b7\x1b[r\x1b[?69l\x1b8";

/// The content of the user's screen, and the encoder that brings the terminal to it.
pub(super) struct Screen {
    content: Tracked<Content>,
    /// The capabilities with which the screen is drawn.
    capabilities: Capabilities,
    painter: Painter,
    encoder: Encoder,
    /// The cells of the frame that is drawn.
    // The grid is kept between frames, because allocating it takes longer than filling it: with the grid and the buffer
    // of bytes kept, a key press at 200x60 causes 210 page faults instead of 571.
    grid: Grid,
    cell_order: Option<Order>,
    quality: Option<Quality>,
    /// Whether the view moves, so that cells keep their glyphs where they can.
    is_picture_moving: bool,
    /// Whether the next frame's bytes erase the whole window first.
    erases: bool,
    /// Whether the next frame's bytes reset the margins first, which limit shifts.
    resets_margins: bool,
    /// Time at which the last frame was drawn.
    drawn: Option<Duration>,
    rate: FrameRate,
    /// Time that making the cells and bytes of the last frame took.
    encode: Duration,
}

/// The content of the screen before it is turned into cells.
struct Content {
    frame: Option<Frame>,
    /// Position of the line between two maps, as a share of the width.
    wipe: f32,
    /// Whether the eye flies or orbits.
    moving: KeyMode,
    /// The name of the scene.
    name: String,
    layers: Layers,
}

impl Content {
    /// Returns the modes of the keymap in force on a screen of this size, in order of precedence.
    fn active_modes(&self, size: Size) -> Vec<KeyMode> {
        self.layers.active_modes(theme::area(size), self.moving)
    }
}

impl Screen {
    pub(super) fn new(capabilities: &Capabilities, cell_order: Option<Order>, quality: Option<Quality>) -> Self {
        let mut layers = Layers::default();
        layers.open(Legends);
        Self {
            content: Tracked::new_changed(Content {
                frame: None,
                wipe: INITIAL_WIPE,
                moving: KeyMode::Fly,
                name: String::new(),
                layers,
            }),
            capabilities: *capabilities,
            painter: painter(capabilities),
            encoder: encoder(Encoder::new(), capabilities),
            grid: Grid::new(Size::new(0, 0)),
            cell_order,
            quality,
            is_picture_moving: false,
            erases: false,
            resets_margins: capabilities.shifts != Shifts::Off,
            drawn: None,
            rate: FrameRate::default(),
            encode: Duration::ZERO,
        }
    }

    /// Returns the approximate bytes of a frame in which every cell changes.
    pub(super) fn usual_bytes(size: Size) -> usize {
        USUAL_BYTES_PER_CELL * size.cell_count()
    }

    /// Sets the capabilities by which pictures become cells and cells become bytes.
    pub(super) fn set_capabilities(&mut self, capabilities: &Capabilities) {
        let mode = self.painter.mode();
        self.resets_margins |= capabilities.shifts != self.capabilities.shifts;
        self.capabilities = *capabilities;
        self.painter = painter(capabilities);
        self.encoder = encoder(std::mem::take(&mut self.encoder), capabilities);
        self.content.mark_changed();
        // The encoder's cells were made with other glyphs or colours, and no longer describe what the terminal shows.
        if mode != self.painter.mode() {
            self.encoder.forget();
        }
        self.encoder.set_half_blocks(capabilities.half_blocks);
    }

    /// Returns the capabilities by which pictures become cells and cells become bytes.
    pub(super) fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// Replaces the frame. While the view moves, `moving` is the current time, from which the frame
    /// rate is computed.
    pub(super) fn take_frame(&mut self, mut frame: Frame, moving: Option<Duration>) {
        let content = &mut *self.content;
        // The user may have moved the line between two maps while the frame was traced.
        frame.wipe_to(content.wipe);
        content.layers.take_frame(&frame);
        content.frame = Some(frame);
        self.rate.count_frame(moving);
    }

    /// Moves the line between the two maps of a wipe to this share of the width.
    pub(super) fn wipe_to(&mut self, share: f32) {
        let content = &mut *self.content;
        content.wipe = share.clamp(0.0, 1.0);
        if let Some(frame) = &mut content.frame {
            frame.wipe_to(content.wipe);
        }
    }

    /// Returns the position of the line between the two maps of a wipe, as a share of the width.
    pub(super) fn wipe(&self) -> f32 {
        self.content.wipe
    }

    /// Swaps the grid that frames are drawn in, whose cells are of no further use, for another one.
    #[cfg(feature = "serve")]
    pub(super) fn swap_grid(&mut self, grid: &mut Grid) {
        std::mem::swap(&mut self.grid, grid);
    }

    /// Forgets the last frame. Until the next one nothing is drawn.
    #[cfg(feature = "serve")]
    pub(super) fn forget_frame(&mut self) {
        self.content.frame = None;
    }

    /// Opens a layer and replaces the open one of its type.
    pub(super) fn open<L: Layer>(&mut self, layer: L) {
        self.content.layers.open(layer);
    }

    /// Closes the layer of a type, if open, and returns it.
    pub(super) fn close<L: Layer>(&mut self) -> Option<L> {
        // `get` comes first, because any access for writing counts as a change, which draws the screen.
        self.get::<L>()?;
        self.content.layers.close()
    }

    /// Closes the note if its time is over; otherwise returns the time at which it fades.
    pub(super) fn close_faded_note(&mut self, now: Duration) -> Option<Duration> {
        // Uses `quietly`, because any other access for writing counts as a change, which draws the screen.
        let fades_at = self.content.quietly().layers.get_mut::<Note>()?.fades_at(now)?;
        if fades_at <= now {
            self.close::<Note>();
            return None;
        }
        Some(fades_at)
    }

    /// Returns a mutable reference to the layer of a type, if open.
    pub(super) fn get_mut<L: Layer>(&mut self) -> Option<&mut L> {
        // Checked first, because any access for writing counts as a change, which draws the screen.
        self.get::<L>()?;
        self.content.layers.get_mut()
    }

    /// Calls `change` with the layer of a type, if open, without counting it as a change.
    ///
    /// The next frame that is drawn shows the change.
    #[cfg(feature = "serve")]
    pub(super) fn change_quietly<L: Layer>(&mut self, change: impl FnOnce(&mut L)) {
        if let Some(layer) = self.content.quietly().layers.get_mut() {
            change(layer);
        }
    }

    /// Builds the pictures of image order and object order up to `now`.
    ///
    /// Returns the time of the next step, if there is one.
    pub(super) fn advance_orders(&mut self, now: Duration) -> Option<Duration> {
        let (has_changed, next) = self.content.quietly().layers.get_mut::<RenderOrdersPanel>()?.advance(now);
        if has_changed {
            self.content.mark_changed();
        }
        next
    }

    /// Closes the layer of a type without counting it as a change, because the next frame redraws
    /// the screen anyway.
    pub(super) fn close_quietly<L: Layer>(&mut self) {
        self.content.quietly().layers.close::<L>();
    }

    /// Returns the layer of a type, if open.
    pub(super) fn get<L: Layer>(&self) -> Option<&L> {
        self.content.layers.get()
    }

    /// Opens `layer`, unless an equal one is open already; if `None`, closes the layer of type `L`.
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

    /// Returns whether a frame has been drawn since the start.
    pub(super) fn has_shown(&self) -> bool {
        self.drawn.is_some()
    }

    /// Passes a key to the open help, and closes the help if the key does.
    pub(super) fn take_help_key(&mut self, key: HelpKey, keymap: &Keymap, size: Size) {
        let (modes, screen) = (self.active_modes(size), theme::area(size));
        if let Some(help) = self.content.layers.get_mut::<HelpPanel>()
            && !help.take_key(key, keymap, &modes, screen)
        {
            self.close::<HelpPanel>();
        }
    }

    /// Returns the modes of the keymap in force on a screen of this size, in order of precedence.
    pub(super) fn active_modes(&self, size: Size) -> Vec<KeyMode> {
        self.content.active_modes(size)
    }

    /// Sets whether the eye flies or orbits.
    pub(super) fn set_movement_mode(&mut self, moving: KeyMode) {
        // The mode is written only if it differs, because any access for writing counts as a change, which draws the
        // screen.
        if self.content.moving != moving {
            self.content.moving = moving;
        }
    }

    /// Sets whether the view moves.
    pub(super) fn set_picture_moving(&mut self, is_picture_moving: bool) {
        // When a motion ends, the picture is drawn once more: at rest its glyphs do not depend on those of the frame
        // before.
        if self.is_picture_moving && !is_picture_moving && self.painter.mode().needs_geometry() {
            self.content.mark_changed();
        }
        self.is_picture_moving = is_picture_moving;
    }

    /// Sets the name of the scene.
    pub(super) fn set_name(&mut self, name: &str) {
        name.clone_into(&mut self.content.name);
    }

    /// Closes the explanation of a pixel if it is open; otherwise opens one for the pixel in the
    /// middle.
    pub(super) fn toggle_explaining(&mut self) {
        if self.close::<ExplainPanel>().is_none()
            && let Some(explaining) = self.frame().and_then(ExplainPanel::new)
        {
            self.open(explaining);
        }
    }

    /// Calls `change` with the open explanation and the frame, if there are both.
    pub(super) fn explain(&mut self, change: impl FnOnce(&mut ExplainPanel, &Frame)) {
        if self.get::<ExplainPanel>().is_none() {
            return;
        }
        let Content { frame, layers, .. } = &mut *self.content;
        if let (Some(explaining), Some(frame)) = (layers.get_mut(), frame) {
            change(explaining, frame);
        }
    }

    /// Forgets what the terminal shows, so that the next bytes draw all cells.
    ///
    /// `half_blocks` tells which half blocks these and later bytes may use. With `covers_a_part` (the picture covers
    /// only a part of the window) the next bytes erase the window first.
    pub(super) fn forget_shown(&mut self, half_blocks: HalfBlocks, covers_a_part: bool) {
        self.encoder.forget();
        self.erases = covers_a_part;
        self.resets_margins = true;
        self.encoder.set_half_blocks(half_blocks);
        self.content.mark_changed();
    }

    /// Returns whether the content has changed since it was drawn last and can be drawn at this
    /// size.
    pub(super) fn is_changed(&self, size: Size) -> bool {
        self.content.is_changed() && self.can_show(size)
    }

    /// Returns the time from which a frame may replace the shown approximate colours by exact ones.
    ///
    /// `None` if the shown colours are exact.
    pub(super) fn improvable_at(&self, size: Size) -> Option<Duration> {
        let due = self.encoder.due().filter(|_| self.can_show(size))?;
        Some(self.drawn.map_or(due, |drawn| due.max(drawn + EXACT_COLORS_INTERVAL)))
    }

    /// Returns whether a scene is still being loaded, so that at best a sketch of it is shown.
    pub(super) fn is_loading_scene(&self) -> bool {
        self.get::<ProgressPanel>().is_some()
    }

    /// Returns whether a screen of this size can be drawn: the last frame has this size, or there
    /// is no frame and a scene is loading.
    ///
    /// Before the first frame, the panels about loading are drawn on black.
    fn can_show(&self, size: Size) -> bool {
        let Some(frame) = self.frame() else { return self.is_loading_scene() };
        // After a resize the old frame would be cut off, or would leave a part of the window empty.
        let wanted = cell::resolution(self.painter.mode(), size, 1.0);
        wanted.is_ok_and(|wanted| (frame.picture.width(), frame.picture.height()) == (wanted.width(), wanted.height()))
    }

    /// Appends the bytes that bring the terminal to the current content.
    ///
    /// `limit` is the limit of a slow link on the frame's bytes.
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
        // Drawing a panel may clamp its scroll position. If that counted as a change, every frame would cause another.
        self.content.mark_unchanged();
        let content = self.content.quietly();
        let grid = &mut self.grid;
        match &content.frame {
            Some(frame) => {
                let built = content.layers.get::<RenderOrdersPanel>().and_then(|orders| orders.partial_picture(frame));
                let picture = built.as_ref().unwrap_or(&frame.picture);
                self.painter.paint_view(picture, frame.geometry.as_deref(), self.is_picture_moving, grid);
            }
            None => grid.clear(size),
        }
        let area = theme::area(grid.size());
        let status_rows = content.layers.get::<StatusLine>().map_or(0, |_| StatusLine::rows(area));
        let note_rows = content.layers.get::<Note>().map_or(1, Note::rows);
        let modes = content.active_modes(grid.size());
        content.layers.draw(&mut Canvas {
            grid: &mut *grid,
            cell_mode,
            keymap,
            modes: &modes,
            frame: content.frame.as_ref(),
            name: &content.name,
            wipe: content.wipe,
            figures,
            status_rows,
            note_rows,
        });
        // Order by colour is used on slow links: it takes 0.5 ms longer, more than fewer bytes save on a fast link.
        let (usual, order) =
            if limit.is_some() { (Quality::Equal, Order::Color) } else { (Quality::Exact, Order::Raster) };
        let order = self.cell_order.unwrap_or(order);
        self.encoder.set_order(order);
        if std::mem::take(&mut self.erases) {
            bytes.extend_from_slice(if cell_mode.colors == Colors::None { ERASE } else { RESET_ERASE });
        }
        // Frames in raster order have no shifts.
        let may_shift = self.capabilities.shifts != Shifts::Off && order == Order::Color;
        if may_shift && std::mem::take(&mut self.resets_margins) {
            bytes.extend_from_slice(RESET_MARGINS);
        }
        let max_bytes = limit.map(|limit| limit.max_bytes);
        let allowance = Allowance { quality: self.quality.unwrap_or(usual), now, max_bytes };
        self.encoder.encode_within(grid, allowance, bytes);
        self.drawn = Some(now);
    }

    /// Records how long making and encoding the cells of the last frame took.
    pub(super) fn record_encode_time(&mut self, encode: Duration) {
        self.encode = encode;
    }
}

fn painter(capabilities: &Capabilities) -> Painter {
    Painter::new(capabilities.cell_mode).with_light_background(capabilities.light_background)
}

fn encoder(encoder: Encoder, capabilities: &Capabilities) -> Encoder {
    let has_colors = capabilities.cell_mode.colors != Colors::None;
    encoder
        .with_colors(has_colors)
        .with_synchronized_output(capabilities.synchronized_output)
        .with_shifts(capabilities.shifts)
}

/// A running mean of the frames shown per second while the view is moving.
#[derive(Default)]
struct FrameRate {
    last: Option<Duration>,
    frames_per_second: Option<f32>,
}

impl FrameRate {
    /// Counts a frame shown at the time `moving`, or a frame shown at rest if `None`.
    ///
    /// A frame at rest or a pause longer than [`MAX_MOTION_GAP`] starts the mean anew.
    fn count_frame(&mut self, moving: Option<Duration>) {
        let between = self.last.zip(moving).map(|(last, now)| now.saturating_sub(last));
        self.last = moving;
        // An interval of zero starts the mean anew too, because it would be infinitely many frames a second.
        self.frames_per_second =
            between.filter(|&between| between < MAX_MOTION_GAP && between > Duration::ZERO).map(|between| {
                let now = 1.0 / between.as_secs_f32();
                // An exponential mean over about eight frames, because a figure that changes 60 times a second is
                // unreadable.
                self.frames_per_second.map_or(now, |mean| mean + (now - mean) / 8.0)
            });
    }
}

/// Greatest time between two frames of the same motion, for the mean frame rate.
const MAX_MOTION_GAP: Duration = Duration::from_millis(500);

#[cfg(all(test, unit_tests))]
mod tests;
