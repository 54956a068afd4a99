//! The stack of layers over the picture: panels and marks, each of which draws itself from its own
//! state.
//!
//! A new panel is one file with a type that implements [`Layer`], and the line that opens it.

use super::frame::Frame;
use super::theme::{self, Theme};
use crate::capabilities::CellMode;
use crate::control::{KeyMode, Keymap};
use crate::grid::Grid;
use crate::overlay;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use std::any::Any;
use std::time::Duration;

/// The position of a layer in the stack, from the lowest level to the topmost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LayerLevel {
    /// A mark on something in the picture. Marks lie lowest, so that they hide no text.
    Mark,
    /// The caption at the bottom, below all panels that the user opens.
    Caption,
    /// A panel beside the thing in the picture that it describes.
    Side,
    /// A panel in the middle of the screen's lower half.
    Middle,
    /// The status line in the lowest rows.
    Status,
    Legend,
    Error,
    /// A warning above the lowest row until the next key.
    Warning,
    /// A note in the lowest row, until the next key or for some seconds.
    Note,
    /// A question that has to be answered.
    Question,
    Help,
}

/// A panel or mark over the picture.
pub(super) trait Layer: Any + Send {
    fn level(&self) -> LayerLevel;

    fn draw(&mut self, canvas: &mut Canvas<'_>);

    /// Returns the mode of the keymap that the layer adds while it is open on this screen, if any.
    fn mode(&self, _screen: Rect) -> Option<KeyMode> {
        None
    }

    /// Returns whether keys work only for this layer while it is open, and not for the layers below
    /// it.
    fn takes_all_keys(&self) -> bool {
        false
    }

    /// Updates the layer for a new frame of the picture.
    fn take_frame(&mut self, _frame: &Frame) {}
}

/// The open layers, from the lowest to the topmost; at most one of each type.
#[derive(Default)]
pub(super) struct Layers {
    // Trait objects, so that a new layer is one file with a type, and a line that opens it.
    stack: Vec<Box<dyn Layer>>,
}

impl Layers {
    /// Opens a layer and replaces the open one of its type.
    pub(super) fn open<L: Layer>(&mut self, layer: L) {
        self.close::<L>();
        // The layer is put on top of the layers of the same level, so that the layer opened last is visible.
        let at = self.stack.partition_point(|below| below.level() <= layer.level());
        self.stack.insert(at, Box::new(layer));
    }

    /// Closes the layer of a type and returns it.
    pub(super) fn close<L: Layer>(&mut self) -> Option<L> {
        let at = self.stack.iter().position(|layer| is_of_type::<L>(layer.as_ref()))?;
        let layer: Box<dyn Any> = self.stack.remove(at);
        layer.downcast().ok().map(|layer| *layer)
    }

    /// Returns the layer of a type, if open.
    pub(super) fn get<L: Layer>(&self) -> Option<&L> {
        self.stack.iter().find_map(|layer| (layer.as_ref() as &dyn Any).downcast_ref())
    }

    /// Returns a mutable reference to the layer of a type, if open.
    pub(super) fn get_mut<L: Layer>(&mut self) -> Option<&mut L> {
        self.stack.iter_mut().find_map(|layer| (layer.as_mut() as &mut dyn Any).downcast_mut())
    }

    /// Returns the modes of the keymap in force on a screen of this size, in order of precedence.
    ///
    /// `movement_mode`, the mode of the movement keys, comes after the modes of the layers.
    pub(super) fn active_modes(&self, screen: Rect, movement_mode: KeyMode) -> Vec<KeyMode> {
        // A question excludes the mode of the movement keys, so that a key that does not answer only dismisses it.
        if let Some(question) = self.stack.iter().find(|layer| layer.takes_all_keys()) {
            return question.mode(screen).into_iter().chain([KeyMode::Always]).collect();
        }
        // The modes are taken from the lowest layer up, so that keys of a mark on the picture take precedence over
        // those of a panel.
        let layers = self.stack.iter().filter_map(|layer| layer.mode(screen));
        layers.chain([movement_mode, KeyMode::Always]).collect()
    }

    /// Updates all layers for a new frame.
    pub(super) fn take_frame(&mut self, frame: &Frame) {
        for layer in &mut self.stack {
            layer.take_frame(frame);
        }
    }

    pub(super) fn draw(&mut self, canvas: &mut Canvas<'_>) {
        for layer in &mut self.stack {
            layer.draw(canvas);
        }
    }
}

fn is_of_type<L: Layer>(layer: &dyn Layer) -> bool {
    (layer as &dyn Any).is::<L>()
}

/// The cells that layers draw on, and the state that all layers may read.
pub(super) struct Canvas<'a> {
    pub(super) grid: &'a mut Grid,
    pub(super) cell_mode: CellMode,
    pub(super) keymap: &'a Keymap,
    /// The modes of the keymap that are in force, in order of precedence.
    pub(super) modes: &'a [KeyMode],
    pub(super) frame: Option<&'a Frame>,
    /// The name of the scene.
    pub(super) name: &'a str,
    /// Position of the line between the two maps of a wipe, as a share of the width.
    pub(super) wipe: f32,
    pub(super) figures: FrameStatistics,
    /// Number of rows that the status line takes at the bottom of the screen.
    pub(super) status_rows: u16,
    /// Number of rows that the note takes at the bottom of the screen; one without a note, so that
    /// a note opened later covers nothing.
    pub(super) note_rows: u16,
}

/// Statistics of the frames shown.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrameStatistics {
    /// Time that making the cells and bytes of the last frame took.
    pub(super) encode: Duration,
    /// Frames shown per second, while something moves.
    pub(super) frames_per_second: Option<f32>,
    /// The rate of the link in bytes per second, if it is slow.
    pub(super) slow: Option<f64>,
}

impl Canvas<'_> {
    /// Returns the area of the whole screen.
    pub(super) fn screen(&self) -> Rect {
        theme::area(self.grid.size())
    }

    pub(super) fn theme(&self) -> Theme {
        Theme::for_cell_mode(self.cell_mode)
    }

    /// Returns whether the screen is large enough for panels.
    pub(super) fn has_room(&self) -> bool {
        theme::has_room(self.screen())
    }

    /// Returns the row of the screen that has `below` rows under it.
    pub(super) fn row_from_bottom(&self, below: u16) -> Rect {
        theme::row_from_bottom(self.screen(), below)
    }

    /// Calls `draw` on an empty ratatui buffer of this area, and lays the buffer over the cells.
    pub(super) fn lay(&mut self, area: Rect, draw: impl FnOnce(Theme, Rect, &mut Buffer)) {
        let mut buffer = Buffer::empty(area);
        draw(self.theme(), area, &mut buffer);
        // The buffer is only as large as the area, because `lay_over` visits each of its cells.
        overlay::lay_over(self.grid, &buffer);
    }

    /// Writes text into a row of the screen.
    pub(super) fn write_line(&mut self, text: &str, row: Rect) {
        self.lay(row, |theme, area, buffer| theme::draw_line(text, theme, area, buffer));
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
