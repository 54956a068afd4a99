use super::*;
use MouseButton::{Left, Middle, Right};
use MouseEventKind::{Down, Drag, Moved, ScrollDown, ScrollUp, Up};

const A: Vec2 = Vec2::new(0.5, 0.5);
const B: Vec2 = Vec2::new(0.75, 0.25);

fn event(kind: MouseEventKind, modifiers: KeyModifiers) -> MouseEvent {
    MouseEvent { kind, column: 0, row: 0, modifiers }
}

/// Returns the gesture of each event, if any; the events are 100 ms apart and have no modifiers.
fn gestures(events: &[(MouseEventKind, Vec2)]) -> Vec<Option<Gesture>> {
    let mut pointer = Pointer::default();
    let at = |number: usize| Duration::from_millis(100 * number as u64);
    let events = events.iter().enumerate();
    events.map(|(number, &(kind, place))| pointer.take(&event(kind, KeyModifiers::NONE), place, at(number))).collect()
}

#[test]
fn a_pressed_grip_drags_until_its_release() {
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
