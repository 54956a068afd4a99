//! The mouse, and what it has taken hold of.

use crate::control::{Gesture, Pointer};
use crossterm::event::MouseEvent;
use glam::Vec2;
use std::time::Duration;

/// The pointer, and the thing under it while a button is held.
#[derive(Default)]
pub(super) struct Hand {
    pointer: Pointer,
    grasped: Grasped,
}

/// What the mouse has taken hold of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Grasped {
    #[default]
    View,
    /// The line between two maps.
    Line,
    /// The cursor of an explanation.
    Cursor,
    Light,
}

impl Hand {
    /// Returns what an event at that place of the screen means.
    pub(super) fn take(&mut self, event: MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        self.pointer.take(&event, at, now)
    }

    pub(super) fn grasp(&mut self, thing: Grasped) {
        self.grasped = thing;
    }

    pub(super) fn grasped(&self) -> Grasped {
        self.grasped
    }

    /// Whether a button is held.
    pub(super) fn holds(&self) -> bool {
        self.pointer.holds()
    }

    pub(super) fn let_go(&mut self) {
        self.pointer.let_go();
    }

    /// Where the pointer is, as a share of the screen's width and height, if it was seen.
    pub(super) fn at(&self) -> Option<Vec2> {
        self.pointer.at()
    }
}
