//! The memory of encoders: what each keeps, and that frames allocate none.

use super::scenes::{Kind, Sequence};
use allocation_counter::measure;
use std::time::Duration;
use termtrace::internals::capabilities::Shifts;
use termtrace::internals::cell::Colors;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{CellMode, Encoder, Grid, Order, Painter, Quality, Size};

const SIZES: [(Size, i64); 2] = [(Size::new(80, 24), 75_000), (Size::new(200, 60), 410_000)];

/// Without a limit, with one that is far exceeded, and with one that some frames are within.
const LIMITS: [Option<usize>; 3] = [None, Some(1_667), Some(8_000)];

/// Returns the grids of a moving picture.
fn frames(size: Size, colors: Colors) -> Vec<Grid> {
    let (sequence, mut painter) =
        (Sequence::of(Kind::Orbit), Painter::new(CellMode { colors, ..CellMode::HALF_BLOCK }));
    (0..10).map(|k| painter.grid(&sequence.frame(k, size))).collect()
}

fn encoder(order: Order, shifts: Shifts) -> Encoder {
    let encoder = Encoder::new().with_order(order).with_half_blocks(HalfBlocks::Either);
    encoder.with_synchronized_output(true).with_shifts(shifts)
}

/// The orders, without shifts and with those that order by colour may have.
const WAYS: [(Order, Shifts); 3] =
    [(Order::Raster, Shifts::Off), (Order::Color, Shifts::Off), (Order::Color, Shifts::Direct)];

/// Encodes the frames from a time on, all but the very first within the limit.
fn send(encoder: &mut Encoder, frames: &[Grid], start: Duration, max_bytes: Option<usize>, bytes: &mut Vec<u8>) {
    for (k, grid) in (0..).zip(frames) {
        bytes.clear();
        let now = start + Duration::from_secs(k) / 30;
        let max_bytes = max_bytes.filter(|_| now > Duration::ZERO);
        encoder.encode_within(grid, Allowance { quality: Quality::Equal, now, max_bytes }, bytes);
    }
}

#[test]
fn frames_allocate_nothing_after_the_first_ones() {
    for (size, _) in SIZES {
        let frames = frames(size, Colors::Truecolor);
        for ((order, shifts), max_bytes) in WAYS.into_iter().flat_map(|way| LIMITS.map(|max| (way, max))) {
            let (mut encoder, mut bytes) = (encoder(order, shifts), Vec::new());
            // Several times, so that the lists have had to hold the largest frame at the exchange rates that come up.
            let passes = [0, 1, 2, 3, 4, 5].map(|pass| {
                let start = Duration::from_secs(pass);
                measure(|| send(&mut encoder, &frames, start, max_bytes, &mut bytes)).count_total
            });
            assert!(
                passes[1..].contains(&0),
                "{size:?}, {order:?}, {shifts:?}, at most {max_bytes:?} bytes: {passes:?} allocations"
            );
        }
    }
}

#[test]
fn an_encoder_keeps_little() {
    for (size, most) in SIZES {
        for colors in [Colors::Truecolor, Colors::Indexed256, Colors::None] {
            let frames = frames(size, colors);
            for max_bytes in LIMITS {
                let mut bytes = Vec::new();
                // The thread's working memory is not the encoder's.
                let encoder = || encoder(Order::Color, Shifts::Direct);
                send(&mut encoder(), &frames, Duration::ZERO, max_bytes, &mut bytes);
                let mut kept = None;
                let used = measure(|| {
                    let mut encoder = encoder();
                    send(&mut encoder, &frames, Duration::ZERO, max_bytes, &mut bytes);
                    kept = Some(Box::new(encoder));
                });
                assert!(
                    used.bytes_current <= most,
                    "{size:?}, {colors:?}, {max_bytes:?}: {} bytes",
                    used.bytes_current
                );
                drop(kept);
            }
        }
    }
}
