//! The mouse pointer, and what it drags.

use crate::control::{Gesture, Pointer};
use crossterm::event::MouseEvent;
use glam::Vec2;
use std::time::Duration;

/// The mouse pointer, and what the current or last drag moves.
#[derive(Default)]
pub(super) struct PointerState {
    pointer: Pointer,
    target: DragTarget,
}

/// The thing that a drag moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum DragTarget {
    #[default]
    View,
    /// The line between the two maps of a wipe.
    Line,
    /// The cursor of the explanation.
    Cursor,
    Light,
}

impl PointerState {
    /// Returns the gesture that a mouse event completes, if any; `at` is in shares of the screen's
    /// width and height.
    pub(super) fn take(&mut self, event: MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        self.pointer.take(&event, at, now)
    }

    pub(super) fn start_drag(&mut self, target: DragTarget) {
        self.target = target;
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
