use super::*;

#[test]
fn small_screens_have_no_room() {
    let fits = |columns, rows| has_room(Rect::new(0, 0, columns, rows));
    assert!(fits(40, 12) && !fits(39, 24) && !fits(80, 11));
}
