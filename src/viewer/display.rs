//! The terminal's window and capabilities, which determine the picture's size and its kind of
//! cells.

use super::extent;
use crate::capabilities::{Capabilities, Findings, GlyphChoice, Hints};
use crate::cell;
use crate::framebuffer::Resolution;
use crate::grid::{Size, Window};
use crate::input::Reply;
use crate::memory::OutOfMemory;
use crate::protocol::{InitialQueries, TerminalMode};

/// The size of the terminal's window, its replies to the initial queries, and the capabilities
/// concluded from them.
pub(super) struct Display {
    hints: Hints,
    window: Window,
    queries: InitialQueries,
    capabilities: Capabilities,
    /// Whether cells have the glyphs of a picture at rest.
    rests: bool,
}

impl Display {
    /// Returns a display whose capabilities are concluded from `hints` alone, without replies.
    pub(super) fn new(hints: Hints, window: Window) -> Self {
        // The first picture does not wait for replies, so capabilities are first concluded without them.
        let queries = InitialQueries::needed(&hints);
        let capabilities = capabilities(&hints, &window, &queries, false);
        Self { hints, window, queries, capabilities, rests: false }
    }

    pub(super) fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    pub(super) fn queries(&self) -> &InitialQueries {
        &self.queries
    }

    /// Sets the user's choice of glyphs, and returns the choice before.
    pub(super) fn choose_glyphs(&mut self, choice: GlyphChoice) -> GlyphChoice {
        let before = self.hints.choose_glyphs(choice);
        self.rests = false;
        self.conclude_capabilities();
        before
    }

    /// Sets whether cells have the glyphs of a picture at rest, and returns whether they have.
    ///
    /// They do not if there are none, if the window is too large for pictures with that many pixels, or if memory is
    /// short.
    pub(super) fn set_rests(&mut self, rests: bool) -> bool {
        let before = self.picture_size();
        self.rests = rests;
        self.conclude_capabilities();
        self.rests &= self.capabilities.resting_glyphs.is_some();
        if self.rests && (self.picture_size() != before || self.check_memory().is_err()) {
            self.rests = false;
            self.conclude_capabilities();
        }
        self.rests
    }

    /// Returns the size of the whole window.
    pub(super) fn window_size(&self) -> Size {
        self.window.size
    }

    /// Returns the part of the window that the picture covers, from its upper left corner.
    pub(super) fn picture_size(&self) -> Size {
        extent::covered_size(self.window.size, self.capabilities.cell_mode)
    }

    pub(super) fn resolution(&self) -> Resolution {
        cell::resolution(self.capabilities.cell_mode, self.picture_size(), self.capabilities.cell_aspect)
            .expect("the size is bounded, and the aspect was checked when it was found")
    }

    /// Sets the window's size.
    pub(super) fn set_window(&mut self, window: Window) {
        self.window = window;
        self.conclude_capabilities();
    }

    /// Records a reply to the initial queries.
    ///
    /// All replies take effect together, with the last one. Returns whether `reply` was the last.
    pub(super) fn record_initial_reply(&mut self, reply: &Reply) -> bool {
        let was_last = self.queries.take_and_check_end(reply);
        if was_last {
            self.conclude_capabilities();
        }
        was_last
    }

    /// Stops waiting for replies to the initial queries. Returns whether any were outstanding.
    pub(super) fn close_queries(&mut self) -> bool {
        let was_open = self.queries.close();
        if was_open {
            self.conclude_capabilities();
        }
        was_open
    }

    fn conclude_capabilities(&mut self) {
        self.capabilities = capabilities(&self.hints, &self.window, &self.queries, self.rests);
    }

    /// Checks that there is memory for pictures of the current size.
    ///
    /// # Errors
    /// If there is not enough.
    pub(super) fn check_memory(&self) -> Result<(), OutOfMemory> {
        extent::check_memory(self.picture_size(), self.capabilities.cell_mode)
    }

    /// Returns whether the terminal supports the kitty keyboard protocol.
    pub(super) fn supports_kitty_keyboard(&self) -> bool {
        !self.queries.is_open() && self.queries.replies().kitty_keyboard == Some(true)
    }

    /// Returns a cell's size in pixels, if the terminal reports mouse positions in pixels.
    pub(super) fn pixel_mouse_cell_size(&self) -> Option<(u16, u16)> {
        let replies = self.queries.replies();
        let knows = !self.queries.is_open() && replies.pixel_mouse == Some(true);
        let is_cell = |&(width, height): &(u16, u16)| width > 0 && height > 0;
        // The kernel's cell size comes first: it follows a change of the font, while the terminal's reply is from the
        // start.
        self.window.cell_pixels.or(replies.cell_pixels).filter(is_cell).filter(|_| knows)
    }

    /// Returns the terminal modes to switch on in addition to those that every terminal supports.
    pub(super) fn optional_modes(&self) -> impl Iterator<Item = TerminalMode> {
        let keyboard = self.supports_kitty_keyboard().then_some(TerminalMode::Keyboard);
        // These modes are set only if the replies report support, because other terminals might print the sequences.
        keyboard.into_iter().chain(self.pixel_mouse_cell_size().map(|_| TerminalMode::MousePixels))
    }
}

/// Returns the capabilities of a terminal, for a picture that `rests` or not.
fn capabilities(hints: &Hints, window: &Window, queries: &InitialQueries, rests: bool) -> Capabilities {
    let found = Findings::new(hints, window.cell, queries.replies()).capabilities();
    let found = if rests { found.at_rest() } else { found };
    // Shifts move whole rows of the window, of which the picture may cover only a part.
    let covers_all = extent::covered_size(window.size, found.cell_mode) == window.size && !window.is_part;
    if covers_all { found } else { found.without_shifts() }
}
