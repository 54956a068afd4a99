use super::*;

#[test]
fn a_long_note_loses_whole_parts() {
    let hint = "drag or WASD to move; v maps; x explain; ? keys; q quit";
    assert_eq!(shortened(hint, 78), hint);
    assert_eq!(shortened(hint, 38), "drag or WASD to move; ? keys; q quit");
    assert_eq!(shortened(hint, 35), "drag or WASD to move; q quit");
    assert_eq!(shortened(hint, 10), "drag or WASD to move");
    assert_eq!(shortened("", 10), "");
}
