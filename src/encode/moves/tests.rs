use super::KnownCursor::{At, InRow, Unknown};
use super::*;

fn bytes(from: KnownCursor, to: (u16, u16)) -> String {
    let to = CellPosition { column: to.0, row: to.1 };
    let cheapest = cheapest_move(from, to);
    let mut bytes = Vec::new();
    cheapest.write(&mut bytes);
    assert_eq!(bytes.len(), cheapest.len(), "{cheapest:?}");
    let absolute = Move::To(to).len();
    assert_eq!(bytes.len(), cheapest_len(from, to, absolute), "{cheapest:?}");
    String::from_utf8(bytes).unwrap()
}

#[test]
fn the_cheapest_move_is_made() {
    let at = |column, row| At(CellPosition { column, row });
    for (from, to, expected) in [
        (Unknown, (0, 0), "\x1b[H"),
        (Unknown, (0, 4), "\x1b[5H"),
        (Unknown, (9, 4), "\x1b[5;10H"),
        (at(3, 3), (3, 3), ""),
        (at(3, 3), (4, 3), "\x1b[C"),
        (at(3, 3), (14, 3), "\x1b[11C"),
        (at(3, 3), (0, 3), "\r"),
        (at(9, 3), (7, 3), "\x08\x08"),
        (at(99, 3), (7, 3), "\x1b[8G"),
        (at(3, 3), (3, 5), "\n\n"),
        (at(3, 3), (0, 5), "\r\n\n"),
        (at(4, 3), (3, 4), "\x08\n"),
        (at(4, 3), (5, 4), "\x1b[C\n"),
        (at(4, 9), (5, 4), "\x1b[5;6H"),
        (at(4, 3), (200, 4), "\x1b[196C\n"),
        (at(4, 0), (4, 50), "\x1b[51;5H"),
        (InRow(3), (0, 3), "\r"),
        (InRow(3), (0, 4), "\r\n"),
        (InRow(3), (7, 3), "\x1b[8G"),
        (InRow(3), (65_534, 4), "\x1b[65535G\n"),
        (InRow(3), (7, 2), "\x1b[3;8H"),
    ] {
        assert_eq!(bytes(from, to), expected, "{from:?} to {to:?}");
    }
}
