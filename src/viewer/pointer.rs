//! The mouse pointer and the thing that it drags.

use crate::control::{Gesture, Pointer};
use crossterm::event::MouseEvent;
use glam::Vec2;
use std::time::Duration;

/// The pointer, and the thing under it while a button is held.
#[derive(Default)]
pub(super) struct PointerState {
    pointer: Pointer,
    target: DragTarget,
}

/// The thing that is dragged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum DragTarget {
    #[default]
    View,
    /// The line between two maps.
    Line,
    /// The cursor of the explanation.
    Cursor,
    Light,
}

impl PointerState {
    /// Returns the meaning of an event at this position of the screen.
    pub(super) fn take(&mut self, event: MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        self.pointer.take(&event, at, now)
    }

    pub(super) fn start_drag(&mut self, thing: DragTarget) {
        self.target = thing;
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
