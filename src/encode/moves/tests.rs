use super::*;

fn bytes(from: Option<(u16, u16)>, to: (u16, u16)) -> String {
    let position = |(column, row)| CellPosition { column, row };
    let cheapest = cheapest_move(from.map(position), position(to));
    let mut bytes = Vec::new();
    cheapest.write(&mut bytes);
    assert_eq!(bytes.len(), cheapest.len(), "{cheapest:?}");
    let absolute = Move::To(position(to)).len();
    assert_eq!(bytes.len(), cheapest_len(from.map(position), position(to), absolute), "{cheapest:?}");
    String::from_utf8(bytes).unwrap()
}

#[test]
fn the_cheapest_move_is_made() {
    for (from, to, expected) in [
        (None, (0, 0), "\x1b[H"),
        (None, (0, 4), "\x1b[5H"),
        (None, (9, 4), "\x1b[5;10H"),
        (Some((3, 3)), (3, 3), ""),
        (Some((3, 3)), (4, 3), "\x1b[C"),
        (Some((3, 3)), (14, 3), "\x1b[11C"),
        (Some((3, 3)), (0, 3), "\r"),
        (Some((9, 3)), (7, 3), "\x08\x08"),
        (Some((99, 3)), (7, 3), "\x1b[8G"),
        (Some((3, 3)), (3, 5), "\n\n"),
        (Some((3, 3)), (0, 5), "\n\n\r"),
        (Some((4, 3)), (3, 4), "\n\x08"),
        (Some((4, 3)), (5, 4), "\n\x1b[C"),
        (Some((4, 9)), (5, 4), "\x1b[5;6H"),
        (Some((4, 3)), (200, 4), "\n\x1b[196C"),
        (Some((4, 0)), (4, 50), "\x1b[51;5H"),
    ] {
        assert_eq!(bytes(from, to), expected, "{from:?} to {to:?}");
    }
}
