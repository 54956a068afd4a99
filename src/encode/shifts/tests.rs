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

/// Returns a grid with the half blocks of some colours, row by row, and with text elsewhere.
fn grid_of(columns: usize, inks: &[Option<PackedInk>]) -> Grid {
    let mut grid = Grid::new(Size::new(columns as u16, (inks.len() / columns) as u16));
    for (at, ink) in inks.iter().enumerate() {
        let text = PackedCell::new('x', PackedInk::DEFAULT, PackedInk::DEFAULT);
        grid.set_packed(at, ink.map_or(text, |ink| PackedCell::new('▄', ink, ink)));
    }
    grid
}

/// Returns the operations that shift a grid towards another, for equal frames.
fn operations([shown, wanted]: [&Grid; 2], shifts: Shifts) -> String {
    let (mut bytes, mut shown, mut before) = (Vec::new(), shown.clone(), Grid::new(shown.size()));
    let mut memory = ShiftMemory::default();
    memory.shift([&mut shown, &mut before], wanted, (shifts, ShiftTerms::EQUAL), &mut bytes);
    let vacated = shown.packed().iter().filter(|cell| cell.is_foreign()).count();
    assert_eq!(vacated, memory.vacated.len());
    String::from_utf8(bytes).expect("ASCII")
}

/// Each row begins with cells of one colour, so that several windows remove the same error.
#[test]
fn all_cells_of_rows_are_shifted_if_that_takes_fewer_bytes() {
    let mut number = noise(7);
    let mut ink = || Some(PackedInk::rgb(crate::color::Srgb8::new(number() as u8, number() as u8, number() as u8)));
    let (columns, flat) = (24, ink());
    let mut rows = [vec![], vec![]];
    for _ in 0..3 {
        let inks: Vec<_> = (0..=columns).map(|column| if column < 9 { flat } else { ink() }).collect();
        rows[0].extend_from_slice(&inks[..columns]);
        rows[1].extend_from_slice(&inks[1..]);
    }
    let [a, b] = rows.map(|inks| grid_of(columns, &inks));
    assert_eq!(operations([&a, &b], Shifts::Direct), "\x1b[H\x1b[P\r\n\x1b[P\r\n\x1b[P");
    assert_eq!(operations([&b, &a], Shifts::Direct), "\x1b[H\x1b[@\r\n\x1b[@\r\n\x1b[@");
    // tmux addresses each operation anew.
    assert_eq!(operations([&a, &b], Shifts::ThroughTmux), "\x1b[1;9H\x1b[P\x1b[9G\n\x1b[P\x1b[9G\n\x1b[P");
}

#[test]
fn the_distance_of_the_row_above_is_tried() {
    let mut number = noise(9);
    let mut ink = || Some(PackedInk::rgb(crate::color::Srgb8::new(number() as u8, number() as u8, number() as u8)));
    let columns = 40;
    let moved: Vec<_> = (0..columns + 4).map(|_| ink()).collect();
    // A single cell that moves is not worth an operation with an address.
    let (flat, other) = (ink(), ink());
    let mut dots = vec![flat; columns + 4];
    dots[20] = other;
    let rows = |first: &[Option<PackedInk>], second: &[Option<PackedInk>]| grid_of(columns, &[first, second].concat());
    let (a, b) = (rows(&moved[..40], &dots[..40]), rows(&moved[1..41], &dots[1..41]));
    assert_eq!(operations([&a, &b], Shifts::Direct), "\x1b[H\x1b[P\r\n\x1b[P");
    let (a, b) = (rows(&dots[..40], &moved[..40]), rows(&dots[1..41], &moved[1..41]));
    assert_eq!(operations([&a, &b], Shifts::Direct), "\x1b[2H\x1b[P", "no row above it");
    // It may be farther than all cells of the picture.
    let mut text = [vec![None; columns], vec![None; columns]];
    for row in &mut text {
        row[30..33].fill_with(&mut ink);
    }
    let (a, b) = (rows(&moved[..40], &text[0]), rows(&moved[4..], &text[1]));
    assert_eq!(operations([&a, &b], Shifts::Direct), "\x1b[H\x1b[4P");
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
