use super::*;
use crate::grid::PackedInk;

/// Returns Marsaglia's xorshift.
fn noise(mut state: u32) -> impl FnMut() -> u32 {
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    }
}

/// Returns the gain of a window, added up place by place.
fn gain_of(window: Range<usize>, by: isize, [stay, shifted]: [&[i64]; 2], most: i64, price: i64) -> i64 {
    let gain = |place: usize| match place.checked_add_signed(by).filter(|from| window.contains(from)) {
        Some(_) => stay[place] - shifted[place],
        None => stay[place] - most,
    };
    window.clone().map(gain).sum::<i64>() - price
}

#[test]
fn the_best_window_gains_the_most() {
    let mut number = noise(3);
    let (mut windows, mut inner) = (0, 0);
    for _ in 0..3_000 {
        let count = 1 + number() as usize % 9;
        let most = 10;
        let mut errors = || (0..count).map(|_| i64::from(number() % 11)).collect::<Vec<_>>();
        let (stay, shifted) = (errors(), errors());
        let sums: Vec<i64> = (0..=count).map(|end| stay[..end].iter().sum()).collect();
        let prices = Prices { one: 3, two: 5 };
        for by in [1_isize, -1, 2, -2, 5, -5] {
            for is_last in [false, true] {
                let price = |end: usize| if is_last && end == count { prices.one } else { prices.two };
                let all = (0..count).flat_map(|start| (start + 1..=count).map(move |end| start..end));
                let gains = all
                    .filter(|window| window.len() > by.unsigned_abs())
                    .map(|window| gain_of(window.clone(), by, [&stay, &shifted], most, price(window.end)));
                let expected = gains.max().filter(|&gain| gain > 0);
                let places = Places { sums: &sums, most };
                let found = best_window(&places, |place| shifted[place], by, prices, is_last);
                assert_eq!(found.map(|window| window.gain), expected, "{stay:?} {shifted:?} {by} {is_last}");
                let Some(Window { start, end, gain, .. }) = found else { continue };
                assert_eq!(gain, gain_of(start..end, by, [&stay, &shifted], most, price(end)), "{start}..{end}");
                windows += 1;
                inner += usize::from(start > 0 && end < count);
            }
        }
    }
    assert!(windows > 1_000 && inner > 100, "{windows} windows, {inner} of them within the places");
}

#[test]
fn errors_are_squared_differences_up_to_a_limit() {
    let mut number = noise(5);
    let mut ink = || PackedInk::rgb(crate::color::Srgb8::new(number() as u8, number() as u8 % 4, 7));
    let mut grid = || {
        let mut grid = Grid::new(Size::new(23, 2));
        for at in 0..46 {
            grid.set_packed(at, PackedCell::new('▄', ink(), ink()));
        }
        grid
    };
    let (a, b) = (grid(), grid());
    let (mut planes_a, mut planes_b) = (Planes::default(), Planes::default());
    planes_a.fill(&a);
    planes_b.fill(&b);
    for limit in [1, 300, u16::MAX] {
        let mut errors = vec![9; 20];
        put_errors([&planes_a, &planes_b], [26, 24], limit, &mut errors);
        for (place, &error) in errors.iter().enumerate() {
            let (a, b) = (a.packed()[26 + place], b.packed()[24 + place]);
            let squares = [(a.fg, b.fg), (a.bg, b.bg)].map(|(a, b)| super::super::halves::squared_difference(a, b));
            assert_eq!(u32::from(error), squares.iter().sum::<u32>().min(limit.into()), "cell {place}");
        }
    }
}

#[test]
fn windows_are_written_with_deletion_before_insertion() {
    let size = Size::new(80, 24);
    let columns_from = |cursor, start, end, by| {
        let mut bytes = Vec::new();
        write_column_shift(4, Window { start, end, by, gain: 1 }, size, cursor, &mut bytes);
        String::from_utf8(bytes).expect("ASCII")
    };
    let columns = |start, end, by| columns_from(KnownCursor::Unknown, start, end, by);
    assert_eq!(columns(10, 80, 3), "\x1b[5;11H\x1b[3P");
    assert_eq!(columns(10, 80, -3), "\x1b[5;11H\x1b[3@");
    assert_eq!(columns(10, 40, 1), "\x1b[5;11H\x1b[P\x1b[40G\x1b[@");
    assert_eq!(columns(10, 40, -2), "\x1b[5;39H\x1b[2P\x1b[11G\x1b[2@");
    assert_eq!(columns_from(KnownCursor::InRow(3), 10, 80, 3), "\x1b[11G\n\x1b[3P");
    assert_eq!(columns_from(KnownCursor::InRow(4), 50, 80, -3), "\x1b[51G\x1b[3@", "a second window of the row");
    assert_eq!(columns_from(KnownCursor::InRow(2), 0, 40, -2), "\x1b[39G\n\n\x1b[2P\r\x1b[2@");
    let rows = |start, end, by| {
        let mut bytes = Vec::new();
        write_row_shift(Window { start, end, by, gain: 1 }, size, &mut bytes);
        String::from_utf8(bytes).expect("ASCII")
    };
    assert_eq!(rows(2, 24, 1), "\x1b[3H\x1b[M");
    assert_eq!(rows(2, 24, -2), "\x1b[3H\x1b[2L");
    assert_eq!(rows(2, 20, 2), "\x1b[3H\x1b[2M\x1b[19H\x1b[2L");
    assert_eq!(rows(0, 20, -1), "\x1b[20H\x1b[M\x1b[H\x1b[L");
}
