//! The state of the mouse pointer, and the target that a drag moves.

use crate::control::{Gesture, Pointer};
use crossterm::event::MouseEvent;
use glam::Vec2;
use std::time::Duration;

/// The state of the mouse pointer, and the target that the current or last drag moves.
#[derive(Default)]
pub(super) struct PointerState {
    pointer: Pointer,
    target: DragTarget,
    /// Whether the pointer has moved since the button was pressed.
    has_moved: bool,
    /// The object under the pointer when the button was pressed.
    object: Option<u32>,
}

/// The thing that a drag with the mouse moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum DragTarget {
    #[default]
    View,
    /// The line between the two maps of a wipe, which can be moved to the left and right.
    Line,
    /// The cursor that marks the explained pixel; it follows the pointer.
    Cursor,
    Light,
}

impl PointerState {
    /// Returns the gesture that a mouse event completes, if any; `at` is in shares of the screen's
    /// width and height.
    pub(super) fn take(&mut self, event: MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        self.pointer.take(&event, at, now)
    }

    /// Starts a drag that moves `thing`. `object` is the object under the pointer, if any.
    pub(super) fn start_drag(&mut self, thing: DragTarget, object: Option<u32>) {
        (self.target, self.object, self.has_moved) = (thing, object, false);
    }

    /// Records that the pointer has moved since the button was pressed.
    pub(super) fn record_motion(&mut self) {
        self.has_moved = true;
    }

    /// Returns whether the button was pressed on an object, and the pointer has not moved since.
    pub(super) fn is_click_on_object(&self) -> bool {
        !self.has_moved && self.object.is_some()
    }

    /// Returns the object that was under the pointer when the button was pressed.
    // After a double click this is the object of the first click, because that click may have shifted the picture.
    pub(super) fn object(&self) -> Option<u32> {
        self.object
    }

    pub(super) fn drag_target(&self) -> DragTarget {
        self.target
    }

    /// Returns whether a button is held.
    pub(super) fn holds(&self) -> bool {
        self.pointer.holds()
    }

    pub(super) fn release(&mut self) {
        self.pointer.release();
    }

    /// Returns the pointer's last position, as shares of the screen's width and height, if known.
    pub(super) fn at(&self) -> Option<Vec2> {
        self.pointer.at()
    }
}
