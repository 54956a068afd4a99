//! What the mouse does: events at times -> gestures, pure.

use crate::camera::Grip;
use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use glam::Vec2;
use std::time::Duration;

/// What a person does with the mouse. Places are parts of the screen's width and height, from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gesture {
    /// Something is taken hold of.
    Press {
        /// Where.
        at: Vec2,
        /// With what.
        grip: Grip,
    },
    /// What was taken hold of is moved.
    Drag {
        /// From the place that was heard of before.
        from: Vec2,
        /// To this one.
        to: Vec2,
        /// With what.
        grip: Grip,
    },
    /// It is let go of.
    Release,
    /// Two clicks of the left button in one place, one after the other.
    DoubleClick,
    /// The wheel is turned away from the person, by so many notches.
    Wheel {
        /// Where the pointer is.
        at: Vec2,
        /// Less than zero: towards the person.
        notches: f32,
    },
}

/// Two clicks are one double click when they are no further apart in time,
const DOUBLE_CLICK_TIME: Duration = Duration::from_millis(400);
/// and on the screen, in parts of it.
const DOUBLE_CLICK_DISTANCE: f32 = 0.02;

/// What has been heard of the mouse.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pointer {
    at: Option<Vec2>,
    held: Option<Grip>,
    clicked: Option<(Duration, Vec2)>,
}

impl Pointer {
    /// The last place that was heard of.
    pub fn at(&self) -> Option<Vec2> {
        self.at
    }

    /// Whether something is held.
    pub fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// The same place on another screen, where nothing is held.
    pub fn release(&mut self) {
        self.held = None;
    }

    /// An event at a place and a time: what it comes to.
    pub fn take(&mut self, event: &MouseEvent, at: Vec2, now: Duration) -> Option<Gesture> {
        let from = self.at.replace(at).unwrap_or(at);
        match event.kind {
            MouseEventKind::Down(button) => Some(self.press(button, event.modifiers, at, now)),
            // What was pressed elsewhere, before we listened, is nothing that is held here.
            MouseEventKind::Drag(_) => self.held.map(|grip| Gesture::Drag { from, to: at, grip }),
            MouseEventKind::Up(_) => self.held.take().map(|_| Gesture::Release),
            MouseEventKind::ScrollUp => Some(Gesture::Wheel { at, notches: 1.0 }),
            MouseEventKind::ScrollDown => Some(Gesture::Wheel { at, notches: -1.0 }),
            MouseEventKind::Moved | MouseEventKind::ScrollLeft | MouseEventKind::ScrollRight => None,
        }
    }

    fn press(&mut self, button: MouseButton, modifiers: KeyModifiers, at: Vec2, now: Duration) -> Gesture {
        let pans = button != MouseButton::Left || modifiers.contains(KeyModifiers::SHIFT);
        let grip = if pans { Grip::Pan } else { Grip::Turn };
        self.held = Some(grip);
        let is_same = |(then, there): (Duration, Vec2)| {
            now.saturating_sub(then) <= DOUBLE_CLICK_TIME && (at - there).abs().max_element() <= DOUBLE_CLICK_DISTANCE
        };
        let clicked = self.clicked.replace((now, at)).filter(|_| !pans);
        if clicked.is_some_and(is_same) {
            // A third click begins anew.
            self.clicked = None;
            return Gesture::DoubleClick;
        }
        if pans {
            self.clicked = None;
        }
        Gesture::Press { at, grip }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use MouseButton::{Left, Middle, Right};
    use MouseEventKind::{Down, Drag, Moved, ScrollDown, ScrollUp, Up};

    const A: Vec2 = Vec2::new(0.5, 0.5);
    const B: Vec2 = Vec2::new(0.75, 0.25);

    fn event(kind: MouseEventKind, modifiers: KeyModifiers) -> MouseEvent {
        MouseEvent { kind, column: 0, row: 0, modifiers }
    }

    /// All gestures of plain events, a tenth of a second apart.
    fn gestures(events: &[(MouseEventKind, Vec2)]) -> Vec<Option<Gesture>> {
        let mut pointer = Pointer::default();
        let at = |number: usize| Duration::from_millis(100 * number as u64);
        let events = events.iter().enumerate();
        events
            .map(|(number, &(kind, place))| pointer.take(&event(kind, KeyModifiers::NONE), place, at(number)))
            .collect()
    }

    #[test]
    fn what_is_pressed_is_dragged_and_released() {
        for (button, grip) in [(Left, Grip::Turn), (Right, Grip::Pan), (Middle, Grip::Pan)] {
            assert_eq!(
                gestures(&[(Down(button), A), (Drag(button), B), (Up(button), B), (Drag(button), A)]),
                [
                    Some(Gesture::Press { at: A, grip }),
                    Some(Gesture::Drag { from: A, to: B, grip }),
                    Some(Gesture::Release),
                    None
                ]
            );
        }
        let shift = Pointer::default().take(&event(Down(Left), KeyModifiers::SHIFT), A, Duration::ZERO);
        assert_eq!(shift, Some(Gesture::Press { at: A, grip: Grip::Pan }));
    }

    #[test]
    fn the_wheel_turns_where_the_pointer_is() {
        assert_eq!(
            gestures(&[(ScrollUp, A), (ScrollDown, B), (Moved, A)]),
            [Some(Gesture::Wheel { at: A, notches: 1.0 }), Some(Gesture::Wheel { at: B, notches: -1.0 }), None]
        );
    }

    #[test]
    fn two_clicks_in_one_place_are_a_double_click() {
        let clicks = |places: &[Vec2]| -> Vec<bool> {
            let events: Vec<_> = places.iter().flat_map(|&at| [(Down(Left), at), (Up(Left), at)]).collect();
            gestures(&events).iter().step_by(2).map(|gesture| *gesture == Some(Gesture::DoubleClick)).collect()
        };
        assert_eq!(clicks(&[A, A, A, A]), [false, true, false, true]);
        assert_eq!(clicks(&[A, B, B]), [false, false, true]);
        let late = [(Down(Left), A), (Up(Left), A), (Moved, A), (Moved, A), (Moved, A), (Down(Left), A)];
        assert_ne!(gestures(&late)[5], Some(Gesture::DoubleClick));
        assert_ne!(gestures(&[(Down(Right), A), (Down(Right), A)])[1], Some(Gesture::DoubleClick));
    }
}
