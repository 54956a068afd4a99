//! Gestures of the mouse, recognised from its events and their times.

use crate::camera::Grip;
use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use glam::Vec2;
use std::time::Duration;

/// A gesture of the mouse.
///
/// Positions are shares of the screen's width and height, from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gesture {
    /// A button is pressed.
    Press {
        /// The position.
        at: Vec2,
        /// The motion that the button and Shift select.
        grip: Grip,
    },
    /// The pointer moves while a button is held.
    Drag {
        /// The previous position.
        from: Vec2,
        /// The new position.
        to: Vec2,
        /// The motion that the button and Shift select.
        grip: Grip,
    },
    /// The button is released.
    Release,
    /// Two clicks of the left button at the same position, in quick succession.
    DoubleClick,
    /// The wheel is turned.
    Wheel {
        /// The position of the pointer.
        at: Vec2,
        /// Number of notches, positive away from the user.
        notches: f32,
    },
}

/// Longest time between the clicks of a double click. Desktops use 400 to 500 ms by default.
const DOUBLE_CLICK_TIME: Duration = Duration::from_millis(400);
/// Greatest distance between the clicks of a double click, as a share of the screen in either
/// direction: 1.6 columns of 80, because without pixel reports a tremor of the hand may cross a cell boundary.
const DOUBLE_CLICK_DISTANCE: f32 = 0.02;

/// The state of the mouse: position, held button and last click.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pointer {
    at: Option<Vec2>,
    held: Option<Grip>,
    clicked: Option<(Duration, Vec2)>,
}

impl Pointer {
    /// Returns the last reported position.
    pub fn at(&self) -> Option<Vec2> {
        self.at
    }

    /// Returns whether a button is held.
    pub fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// Releases the held button, because its release will not be reported.
    pub fn release(&mut self) {
        self.held = None;
    }

    /// Takes an event at a position and a time, and returns the gesture that it completes, if any.
    pub fn take(&mut self, event: &MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        // The position of every event counts, so that a drag starts where the button was pressed.
        let from = self.at.replace(at).unwrap_or(at);
        match event.kind {
            MouseEventKind::Down(button) => Some(self.press(button, event.modifiers, at, now)),
            // Without a press before it, the button was pressed in another program, and the drag is not for this one.
            MouseEventKind::Drag(_) => self.held.map(|grip| Gesture::Drag { from, to: at, grip }),
            MouseEventKind::Up(_) => self.held.take().map(|_| Gesture::Release),
            MouseEventKind::ScrollUp => Some(Gesture::Wheel { at, notches: 1.0 }),
            MouseEventKind::ScrollDown => Some(Gesture::Wheel { at, notches: -1.0 }),
            // Motion without a button is not requested from the terminal, and has no meaning here.
            MouseEventKind::Moved | MouseEventKind::ScrollLeft | MouseEventKind::ScrollRight => None,
        }
    }

    fn press(&mut self, button: MouseButton, modifiers: KeyModifiers, at: Vec2, now: Duration) -> Gesture {
        // Any other button pans, and so does Shift: a touchpad has often only one button.
        let pans = button != MouseButton::Left || modifiers.contains(KeyModifiers::SHIFT);
        let grip = if pans { Grip::Pan } else { Grip::Turn };
        self.held = Some(grip);
        let is_same = |(then, there): (Duration, Vec2)| {
            now.saturating_sub(then) <= DOUBLE_CLICK_TIME && (at - there).abs().max_element() <= DOUBLE_CLICK_DISTANCE
        };
        // A panning click neither completes nor starts a double click.
        let clicked = self.clicked.replace((now, at)).filter(|_| !pans);
        if clicked.is_some_and(is_same) {
            // So that a third click starts a new double click instead of completing a second one.
            self.clicked = None;
            return Gesture::DoubleClick;
        }
        // Panning is not part of a double click: its frame-all would undo the pan.
        if pans {
            self.clicked = None;
        }
        Gesture::Press { at, grip }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
