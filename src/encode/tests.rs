use super::*;
use crate::grid::{PackedCell, PackedInk};

const SIZE: Size = Size::new(20, 6);

/// Returns a picture in which each cell has colours of its own.
fn picture(size: Size, shift: usize) -> Grid {
    let mut grid = Grid::new(size);
    for at in 0..size.cell_count() {
        let level = |factor: usize| ((at + shift) * factor % 256) as u8;
        let ink = |factor: usize| PackedInk::rgb(crate::color::Srgb8::new(level(factor), level(3 * factor), level(7)));
        grid.set_packed(at, PackedCell::new('▄', ink(37), ink(91)));
    }
    grid
}

/// Encodes frames under a tight limit, after which cells are wrong.
fn encoder_with_wrong_cells() -> Encoder {
    let (mut encoder, mut bytes) = (Encoder::new().with_order(Order::Color), Vec::new());
    for k in 0..8_u32 {
        let max_bytes = (k > 0).then_some(capped::LEAST_BYTES + 50);
        let allowance = Allowance { quality: Quality::Equal, now: k * Duration::from_millis(33), max_bytes };
        encoder.encode_within(&picture(SIZE, 13 * k as usize), allowance, &mut bytes);
    }
    assert!(encoder.shortage.is_present() && wrong_cells(&encoder) > 0);
    encoder
}

fn wrong_cells(encoder: &Encoder) -> usize {
    (0..encoder.ages.size().cell_count()).filter(|&at| encoder.ages.wrong_share(at) > 0.0).count()
}

#[test]
fn frames_without_a_limit_leave_no_cell_wrong() {
    let within = |encoder: &mut Encoder, bytes: &mut Vec<u8>| {
        let allowance = Allowance { quality: Quality::Equal, now: Duration::from_millis(300), max_bytes: None };
        encoder.encode_within(&picture(SIZE, 5), allowance, bytes);
    };
    let exact = |encoder: &mut Encoder, bytes: &mut Vec<u8>| encoder.encode(&picture(SIZE, 5), bytes);
    let forgotten = |encoder: &mut Encoder, _: &mut Vec<u8>| encoder.forget();
    for (name, act) in [("within", &within as &dyn Fn(&mut _, &mut _)), ("exact", &exact), ("forgotten", &forgotten)] {
        let mut encoder = encoder_with_wrong_cells();
        act(&mut encoder, &mut Vec::new());
        assert_eq!(wrong_cells(&encoder), 0, "{name}");
    }
}

#[test]
fn a_shortage_ends_with_a_change_of_size() {
    let mut encoder = encoder_with_wrong_cells();
    let allowance = Allowance { quality: Quality::Equal, now: Duration::from_millis(300), max_bytes: Some(500) };
    encoder.encode_within(&picture(Size::new(6, 20), 5), allowance, &mut Vec::new());
    assert!(!encoder.shortage.is_present());
}
