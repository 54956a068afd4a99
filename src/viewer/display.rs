//! What is known of the terminal, and so how large the picture on it is and what it is made of.

use super::extent;
use crate::capabilities::{Capabilities, Findings, Hints};
use crate::cell;
use crate::framebuffer::Resolution;
use crate::grid::{Size, Window};
use crate::input::Reply;
use crate::memory::OutOfMemory;
use crate::protocol::{Mode, Questions};

/// A terminal's window, and what is known of it.
pub(super) struct Display {
    hints: Hints,
    window: Window,
    questions: Questions,
    capabilities: Capabilities,
}

impl Display {
    /// What is known before the terminal is asked.
    pub(super) fn new(hints: Hints, window: Window) -> Self {
        let questions = Questions::needed(&hints);
        let capabilities = Findings::new(&hints, window.cell, questions.answers()).capabilities();
        Self { hints, window, questions, capabilities }
    }

    pub(super) fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    pub(super) fn questions(&self) -> &Questions {
        &self.questions
    }

    /// The size of the whole window.
    pub(super) fn window_size(&self) -> Size {
        self.window.size
    }

    /// How much of the window is the picture's, from its upper left corner on.
    pub(super) fn size(&self) -> Size {
        extent::covered(self.window.size, self.capabilities.cell_mode)
    }

    pub(super) fn resolution(&self) -> Resolution {
        cell::resolution(self.capabilities.cell_mode, self.size(), self.capabilities.cell_aspect)
            .expect("the size is bounded, and the aspect was checked when it was found")
    }

    /// The window has this size now.
    pub(super) fn set_window(&mut self, window: Window) {
        self.window = window;
        self.conclude();
    }

    /// Takes a reply, if it is to a question. Replies count all at once, when the last is there: whether this was the last.
    pub(super) fn take_reply(&mut self, reply: &Reply) -> bool {
        let was_last = self.questions.take(reply);
        if was_last {
            self.conclude();
        }
        was_last
    }

    /// No more replies to the questions will come. Whether any could have come until now.
    pub(super) fn close_questions(&mut self) -> bool {
        let was_open = self.questions.close();
        if was_open {
            self.conclude();
        }
        was_open
    }

    fn conclude(&mut self) {
        let findings = Findings::new(&self.hints, self.window.cell, self.questions.answers());
        self.capabilities = findings.capabilities();
    }

    /// Finds out whether there is the memory for pictures of this size.
    ///
    /// # Errors
    /// If there is not.
    pub(super) fn check_memory(&self) -> Result<(), OutOfMemory> {
        extent::check(self.size(), self.capabilities.cell_mode)
    }

    /// Whether the terminal knows the kitty keyboard protocol.
    pub(super) fn knows_keyboard(&self) -> bool {
        !self.questions.is_open() && self.questions.answers().kitty_keyboard == Some(true)
    }

    /// A cell's size in pixels, where the terminal tells places of the mouse in them.
    pub(super) fn mouse_pixels(&self) -> Option<(u16, u16)> {
        let answers = self.questions.answers();
        let knows = !self.questions.is_open() && answers.pixel_mouse == Some(true);
        let is_cell = |&(width, height): &(u16, u16)| width > 0 && height > 0;
        self.window.cell_pixels.or(answers.cell_pixels).filter(is_cell).filter(|_| knows)
    }

    /// The modes that are to be on besides those that every terminal knows.
    pub(super) fn modes(&self) -> impl Iterator<Item = Mode> {
        let keyboard = self.knows_keyboard().then_some(Mode::Keyboard);
        keyboard.into_iter().chain(self.mouse_pixels().map(|_| Mode::MousePixels))
    }
}
