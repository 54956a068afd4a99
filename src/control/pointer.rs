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
        /// The pointer's position, in shares of the screen's width and height.
        at: Vec2,
        /// The motion that the button and Shift select.
        grip: Grip,
    },
    /// The pointer moves while a button is held.
    Drag {
        /// The pointer's previous position.
        from: Vec2,
        /// The pointer's new position.
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
        /// The pointer's position, in shares of the screen's width and height.
        at: Vec2,
        /// Number of notches, positive if turned away from the user.
        notches: f32,
    },
}

/// Longest time between the two presses of a double click. Desktops use 400 to 500 ms by default.
const DOUBLE_CLICK_TIME: Duration = Duration::from_millis(400);
/// Largest distance between the two clicks of a double click, as a share of the screen's width and
/// height.
// 0.02 is 1.6 of 80 columns: without mouse reports in pixels, a slight move of the hand may cross a cell boundary.
const DOUBLE_CLICK_DISTANCE: f32 = 0.02;

/// The state of the mouse: position, held button and last click.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pointer {
    at: Option<Vec2>,
    held: Option<Grip>,
    clicked: Option<(Duration, Vec2)>,
}

impl Pointer {
    /// Returns the pointer's last reported position.
    pub fn at(&self) -> Option<Vec2> {
        self.at
    }

    /// Returns whether a button is held.
    pub fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// Releases the held button, for cases in which the terminal will not report its release.
    pub fn release(&mut self) {
        self.held = None;
    }

    /// Handles a mouse event at position `at` and time `now`. Returns the gesture that it
    /// completes, if any.
    pub fn take(&mut self, event: &MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        // Every event updates the position, so that a drag starts where the button was pressed.
        let from = self.at.replace(at).unwrap_or(at);
        match event.kind {
            MouseEventKind::Down(button) => Some(self.press(button, event.modifiers, at, now)),
            // A drag without a press before it is ignored: the button was pressed in another program.
            MouseEventKind::Drag(_) => self.held.map(|grip| Gesture::Drag { from, to: at, grip }),
            MouseEventKind::Up(_) => self.held.take().map(|_| Gesture::Release),
            MouseEventKind::ScrollUp => Some(Gesture::Wheel { at, notches: 1.0 }),
            MouseEventKind::ScrollDown => Some(Gesture::Wheel { at, notches: -1.0 }),
            // No gesture uses these; motion without a button is not even requested from the terminal.
            MouseEventKind::Moved | MouseEventKind::ScrollLeft | MouseEventKind::ScrollRight => None,
        }
    }

    fn press(&mut self, button: MouseButton, modifiers: KeyModifiers, at: Vec2, now: Duration) -> Gesture {
        // All buttons but the left one pan. Shift with the left button pans too, because many touchpads have a single
        // button.
        let pans = button != MouseButton::Left || modifiers.contains(KeyModifiers::SHIFT);
        let grip = if pans { Grip::Pan } else { Grip::Turn };
        self.held = Some(grip);
        let is_same = |(then, there): (Duration, Vec2)| {
            now.saturating_sub(then) <= DOUBLE_CLICK_TIME && (at - there).abs().max_element() <= DOUBLE_CLICK_DISTANCE
        };
        // `clicked` is the previous click. A panning click neither completes nor starts a double click.
        let clicked = self.clicked.replace((now, at)).filter(|_| !pans);
        if clicked.is_some_and(is_same) {
            // Forget the first click. Otherwise the third of three clicks would complete another double click.
            self.clicked = None;
            return Gesture::DoubleClick;
        }
        // A double click frames the whole scene, which would undo the pan, so a panning click is not remembered.
        if pans {
            self.clicked = None;
        }
        Gesture::Press { at, grip }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
