use super::*;
use crossterm::event::{KeyCode, KeyModifiers, MouseButton};

#[test]
fn of_ways_that_lead_on_the_last_one_counts() {
    let mouse =
        |kind, column| Input::Event(Event::Mouse(MouseEvent { kind, column, row: 0, modifiers: KeyModifiers::NONE }));
    let (left, right) = (MouseEventKind::Drag(MouseButton::Left), MouseEventKind::Drag(MouseButton::Right));
    let way = mouse(left, 1);
    assert!(is_superseded(&way, Some(&mouse(left, 2))));
    let key = Input::Event(Event::Key(KeyCode::Char('w').into()));
    let (up, wheel) = (mouse(MouseEventKind::Up(MouseButton::Left), 2), mouse(MouseEventKind::ScrollUp, 2));
    for next in [None, Some(&up), Some(&mouse(right, 2)), Some(&wheel), Some(&key)] {
        assert!(!is_superseded(&way, next), "{next:?}");
    }
    assert!(!is_superseded(&wheel, Some(&wheel)) && !is_superseded(&key, Some(&key)), "each of them counts");
}
