//! The sequences of `cargo bench --bench bytes`, and two random ones, in every order and at every
//! quality.
//!
//! Every frame is shown as wanted or near it, and exactly in the end. Of the 120 frames every eighth is encoded on a
//! small screen and every thirtieth on a large one. All of them: `cargo test --release --test encoder -- --ignored`.

use super::WAYS;
use super::near::{distance, halves};
use super::scenes::{FRAMES, Kind, Sequence};
use super::screens::Clusters;
use super::watched::Watched;
use std::time::Duration;
use termtrace::internals::cell::grid_from_picture;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{CellMode, Encoder, Grid, Order, Quality, Size};

const SMALL: Size = Size::new(80, 24);
const LARGE: Size = Size::new(200, 60);

/// Returns every `step`-th frame, and when it is sent.
fn frames(sequence: &Sequence, size: Size, step: usize) -> Vec<(Duration, Grid)> {
    let time = |k: usize| Duration::from_secs(k as u64) / 30;
    let grid = |k| grid_from_picture(CellMode::HALF_BLOCK, &sequence.frame(k, size));
    (0..FRAMES).step_by(step).map(|k| (time(k), grid(k))).collect()
}

/// Sends the frames and what is due after them, and judges each.
#[track_caller]
fn assert_played((order, half_blocks): (Order, HalfBlocks), quality: Quality, frames: &[(Duration, Grid)]) {
    let (end, last) = frames.last().expect("there are frames");
    let mut watched = Watched::new(order, half_blocks, last.size(), Clusters::None);
    let allowed = |now| Allowance { quality, now, max_bytes: None };
    for (now, grid) in frames {
        watched.send_within(grid, allowed(*now));
    }
    let rest = watched.rest(last, allowed(*end));
    assert!(rest.after <= Duration::from_secs(1), "at rest only after {:?}", rest.after);
    let mut whole = Vec::new();
    Encoder::new().with_order(order).with_half_blocks(half_blocks).encode(last, &mut whole);
    let parts = rest.bytes as f64 / whole.len() as f64;
    assert!(parts <= 1.5, "{parts} full frames until all was at rest");
    if half_blocks == HalfBlocks::Lower {
        watched.assert_no_upper_half();
    }
}

fn assert_all_played(sequence: &Sequence, size: Size, step: usize) {
    let frames = frames(sequence, size, step);
    for quality in [Quality::Exact, Quality::Equal, Quality::Fast] {
        for way in WAYS {
            println!("{}: {sequence}; {size:?}, {quality:?}, {way:?}", sequence.kind.name());
            assert_played(way, quality, &frames);
        }
    }
}

#[test]
fn orbit() {
    assert_all_played(&Sequence::of(Kind::Orbit), SMALL, 8);
    assert_all_played(&Sequence::of(Kind::Orbit), LARGE, 30);
}

#[test]
fn plain() {
    assert_all_played(&Sequence::of(Kind::Plain), SMALL, 8);
    assert_all_played(&Sequence::of(Kind::Plain), LARGE, 30);
}

#[test]
fn sphere() {
    assert_all_played(&Sequence::of(Kind::Sphere), SMALL, 8);
    assert_all_played(&Sequence::of(Kind::Sphere), LARGE, 30);
}

#[test]
fn gradient() {
    assert_all_played(&Sequence::of(Kind::Gradient), SMALL, 8);
    assert_all_played(&Sequence::of(Kind::Gradient), LARGE, 30);
}

#[test]
fn random_sequences() {
    for sequence in Sequence::drawn(11) {
        assert_all_played(&sequence, SMALL, 8);
    }
}

/// Under the limit of a slow link all frames fit, use it, and are near the wanted ones.
#[test]
fn frames_under_a_limit_are_near() {
    const MAX_BYTES: usize = 1_667;
    let frames = frames(&Sequence::of(Kind::Orbit), SMALL, 1);
    let mut watched = Watched::new(Order::Color, HalfBlocks::Either, SMALL, Clusters::None);
    let (mut sum, mut used) = (0.0, 0);
    for (k, (now, grid)) in frames.iter().enumerate() {
        let max_bytes = (k > 0).then_some(MAX_BYTES);
        let sent = watched.send_within(grid, Allowance { quality: Quality::Equal, now: *now, max_bytes });
        if k > 0 {
            assert!(sent <= MAX_BYTES, "frame {k} has {sent} bytes");
            used += sent;
            sum += watched.psnr(grid);
        }
    }
    let count = frames.len() - 1;
    let (psnr, used) = (sum / count as f64, used as f64 / (count * MAX_BYTES) as f64);
    println!("{psnr:.2} dB with {used:.3} of the limit");
    assert!(psnr >= 29.0 && used >= 0.9, "{psnr} dB with {used} of the limit");
}

/// Under the limit of a slow link hardly any cell is wrong in all frames of a second.
///
/// If errors did not weigh more the longer they last, 104 and 6 cells would be.
#[test]
fn wrong_cells_are_mended_within_a_second() {
    let frames: Vec<_> = (0..120).map(|k| Sequence::of(Kind::Orbit).frame(k, SMALL)).collect();
    for (max_bytes, most) in [(1_667, 30.0), (3_333, 1.0)] {
        let mut watched = Watched::new(Order::Color, HalfBlocks::Either, SMALL, Clusters::None);
        let mut ages = vec![0; SMALL.cell_count()];
        let mut late = 0;
        for (k, picture) in frames.iter().enumerate() {
            let (now, max_bytes) = (Duration::from_secs(k as u64) / 30, (k > 0).then_some(max_bytes));
            let grid = grid_from_picture(CellMode::HALF_BLOCK, picture);
            watched.send_within(&grid, Allowance { quality: Quality::Equal, now, max_bytes });
            for (age, (shown, wanted)) in ages.iter_mut().zip(watched.shown().iter().zip(grid.cells())) {
                let halves = halves(shown).zip(halves(wanted)).expect("a picture");
                let is_wrong = (0..2).any(|half| distance(halves.0[half], halves.1[half]) > 0.02);
                *age = if is_wrong { *age + 1 } else { 0 };
                late += usize::from(*age > 30);
            }
        }
        let mean = late as f64 / 89.0;
        println!("{mean:.2} cells are late at {max_bytes} bytes");
        assert!(mean <= most, "{mean} cells are late at {max_bytes} bytes");
    }
}

/// While one sphere moves, what has been still for a second is exact.
#[test]
fn cells_at_rest_are_exact() {
    let frames = frames(&Sequence::of(Kind::Sphere), SMALL, 1);
    for quality in [Quality::Equal, Quality::Fast] {
        let mut watched = Watched::new(Order::Color, HalfBlocks::Either, SMALL, Clusters::None);
        let mut since = vec![Duration::ZERO; SMALL.cell_count()];
        let mut last = &frames[0].1;
        for (now, grid) in &frames {
            for (since, (a, b)) in since.iter_mut().zip(last.cells().zip(grid.cells())) {
                *since = if halves(a) == halves(b) { *since } else { *now };
            }
            last = grid;
            watched.send_within(grid, Allowance { quality, now: *now, max_bytes: None });
            let still = (0..since.len()).filter(|&at| since[at] + Duration::from_secs(1) <= *now);
            watched.assert_exact_at(still, grid);
        }
        let still = since.iter().filter(|&&since| since == Duration::ZERO).count();
        assert!(still > SMALL.cell_count() / 2, "most of the picture was still, and so was judged");
    }
}

#[test]
#[ignore = "minutes: by hand, in a release build"]
fn all_frames_of_all_sequences() {
    let drawn = [11, 12].into_iter().flat_map(Sequence::drawn);
    for sequence in Kind::ALL.into_iter().map(Sequence::of).chain(drawn) {
        for size in [SMALL, LARGE] {
            assert_all_played(&sequence, size, 1);
        }
    }
}
