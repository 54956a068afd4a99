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
///
/// `shifted` has the errors of all places at its distance.
fn gain_of(window: Range<usize>, by: isize, [stay, shifted]: [&[f32]; 2], most: f32, price: f32) -> f32 {
    let gain = |place: usize| match place.checked_add_signed(by).filter(|from| window.contains(from)) {
        Some(_) => stay[place] - shifted[place],
        None => stay[place] - most,
    };
    window.clone().map(gain).sum::<f32>() - price
}

/// Returns the errors of places with some errors at each distance.
fn place_errors(farthest: usize, stay: &[f32], shifted: impl Fn(isize, usize) -> f32) -> PlaceErrors {
    let distances = Distances { farthest };
    let groups = distances.groups().len();
    let mut errors = PlaceErrors::default();
    errors.distances = distances;
    errors.stay.resize(stay.len().div_ceil(LANES), F32x8::ZERO);
    // Errors at distances beyond the farthest, which must not count.
    errors.shifted.resize(groups * stay.len(), F32x8([-1e6; LANES]));
    for (place, &error) in stay.iter().enumerate() {
        errors.stay[place / LANES].0[place % LANES] = error;
        for by in (1..=farthest.cast_signed()).flat_map(|by| [by, -by]) {
            let (group, lane) = distances.slot(by);
            errors.shifted[place * groups + group].0[lane] = shifted(by, place);
        }
    }
    errors.sum_up(stay.len());
    errors
}

#[test]
fn the_best_window_gains_the_most() {
    let mut number = noise(3);
    let (mut windows, mut inner, mut far) = (0, 0, 0);
    for _ in 0..1_500 {
        let (count, farthest) = (1 + number() as usize % 40, 1 + number() as usize % MOST_DISTANCE);
        let (most, prices) = ((number() % 7) as f32, Prices { one: 3.0, two: 5.0 });
        let mut errors = |most: u32| (0..count).map(|_| (number() % most) as f32).collect::<Vec<_>>();
        let stay = errors(11);
        let distances: Vec<isize> = (1..=farthest.cast_signed()).flat_map(|by| [by, -by]).collect();
        let shifted: Vec<Vec<f32>> = distances.iter().map(|_| errors(7)).collect();
        let of = |by: isize| &shifted[distances.iter().position(|&other| other == by).expect("a distance")];
        let errors = place_errors(farthest, &stay, |by, place| of(by)[place]);
        let start = number() as usize % count;
        let part = start..start + 1 + number() as usize % (count - start);
        for is_last in [false, true] {
            let price = |end: usize| if is_last && end == part.end { prices.one } else { prices.two };
            let gain =
                |window: Range<usize>, by: isize| gain_of(window.clone(), by, [&stay, of(by)], most, price(window.end));
            let mut expected = 0.0_f32;
            for &by in &distances {
                for start in part.clone() {
                    for end in start + 1 + by.unsigned_abs()..=part.end {
                        expected = expected.max(gain(start..end, by));
                    }
                }
            }
            let found = errors.best_window(part.clone(), most, prices, is_last, None);
            let gains = found.map_or(0.0, |window| window.gain);
            assert_eq!(gains, expected, "{stay:?} {shifted:?} {part:?} {is_last}");
            let Some(Window { start, end, by, gain: found }) = found else { continue };
            assert_eq!(found, gain(start..end, by), "{start}..{end} by {by}");
            windows += 1;
            inner += usize::from(start > part.start && end < part.end);
            far += usize::from(by.unsigned_abs() > LANES);
        }
    }
    assert!(windows > 1_000 && inner > 100 && far > 20, "{windows} windows, {inner} of them inner, {far} of them far");
}

#[test]
fn the_likely_distance_is_taken_among_equal_ones() {
    let errors = place_errors(9, &[5.0; 30], |_, _| 0.0);
    let by =
        |likely| errors.best_window(0..30, 0.0, Prices { one: 1.0, two: 1.0 }, true, likely).map(|window| window.by);
    assert_eq!((by(None), by(Some(-9)), by(Some(4)), by(Some(10))), (Some(1), Some(-9), Some(4), Some(1)));
}

#[test]
fn errors_are_squared_differences_up_to_a_limit() {
    let mut number = noise(5);
    let mut ink = || PackedInk::rgb(crate::color::Srgb8::new(number() as u8, number() as u8 % 4, number() as u8 % 64));
    let size = Size::new(23, 2);
    let mut halves = || (0..46).map(|_| [ink(), ink()]).collect::<Vec<_>>();
    let (a, b) = (halves(), halves());
    let (mut planes_a, mut planes_b) = (Planes::default(), Planes::default());
    // Another size first, whose numbers must not stay in the margins.
    planes_a.fill(&[[ink(), ink()]; 60], Size::new(20, 3));
    planes_a.fill(&a, size);
    planes_b.fill(&b, size);
    for limit in [1_u32, 300, 60_000] {
        let expected = |from: usize, to: usize| {
            crate::encode::halves::squared_differences(a[from], b[to]).iter().sum::<u32>().min(limit) as f32
        };
        let mut of_row = Vec::new();
        let rows = [(&planes_a, 1), (&planes_b, 0)];
        let sum = dispatch(PutRowErrors { rows, limit: limit as f32, errors: &mut of_row });
        let errors: Vec<f32> = of_row.iter().flat_map(|eight| eight.0).collect();
        let all: Vec<f32> = (0..23).map(|column| expected(23 + column, column)).collect();
        assert_eq!((&errors[..23], sum), (&*all, all.iter().sum::<f32>()));
        let (distances, mut errors) = (Distances { farthest: 16 }, Vec::new());
        let (shown, wanted, limit) = (&planes_a, &planes_b, limit as f32);
        dispatch(PutShiftedErrors { shown, wanted, row: 1, limit, distances, errors: &mut errors });
        for column in 0..23_isize {
            for by in (1..=16).flat_map(|by| [by, -by]).filter(|by| (0..23).contains(&(column + by))) {
                let (group, lane) = distances.slot(by);
                let error = errors[4 * column as usize + group].0[lane];
                assert_eq!(error, expected((23 + column + by) as usize, 23 + column as usize), "{column} by {by}");
            }
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
    let mut halves = PictureHalves::default();
    halves.read_shown(&shown);
    halves.read_wanted(wanted);
    memory.shift([&mut shown, &mut before], &mut halves, (shifts, ShiftTerms::EQUAL), &mut bytes);
    let mut halves_after = PictureHalves::default();
    halves_after.read_shown(&shown);
    assert!(halves.shown == halves_after.shown, "the halves are shifted with the cells");
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
        write_column_shift(4, Window { start, end, by, gain: 1.0 }, size, cursor, &mut bytes);
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
        write_row_shift(Window { start, end, by, gain: 1.0 }, size, &mut bytes);
        String::from_utf8(bytes).expect("ASCII")
    };
    assert_eq!(rows(2, 24, 1), "\x1b[3H\x1b[M");
    assert_eq!(rows(2, 24, -2), "\x1b[3H\x1b[2L");
    assert_eq!(rows(2, 20, 2), "\x1b[3H\x1b[2M\x1b[19H\x1b[2L");
    assert_eq!(rows(0, 20, -1), "\x1b[20H\x1b[M\x1b[H\x1b[L");
}
