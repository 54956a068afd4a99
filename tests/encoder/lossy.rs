//! Lossy frames: the exact ones' sequences at a pace, at every quality and under limits, until all
//! is exact.

use super::grids::filled;
use super::near::{distance, halves};
use super::screens::Clusters;
use super::watched::Watched;
use super::{CELLS, PICTURE, Stage, Step, WAYS, anything, cell, config, panel, rgb, size, step};
use proptest::collection::vec;
use proptest::prelude::*;
use std::time::Duration;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{Cell, Encoder, Grid, Ink, Order, Quality, Size};

/// Returns colours that are near each other, further apart than a quality allows, and in between.
fn near_ink() -> impl Strategy<Value = Ink> {
    prop_oneof![
        4 => (0_u8..8).prop_map(|step| rgb(100 + step, 120, 140 - step)),
        3 => (0_u8..12).prop_map(|step| rgb(60 + 3 * step, 60, 60 + step)),
        1 => (0_u8..6).prop_map(|step| rgb(step, 2, 0)),
        1 => any::<[u8; 3]>().prop_map(|[r, g, b]| rgb(r, g, b)),
    ]
}

fn picture_cell() -> impl Strategy<Value = Cell> {
    let glyph = prop::sample::select(&['▄', '▄', '▄', ' ', '▀'][..]);
    (glyph, near_ink(), near_ink()).prop_map(|(glyph, ink, bg)| {
        let fg = if glyph == ' ' { Ink::Default } else { ink };
        Cell::new(glyph, fg, bg)
    })
}

/// Returns cells of a picture, with some text.
fn cells() -> impl Strategy<Value = Vec<Cell>> {
    vec(prop_oneof![9 => picture_cell(), 1 => cell(anything(Clusters::None))], CELLS)
}

fn lossy_step() -> impl Strategy<Value = Step> {
    let other = prop_oneof![picture_cell(), cell(PICTURE)];
    prop_oneof![
        2 => step(Clusters::None),
        4 => vec((0..CELLS, other), 1..30).prop_map(Step::Change),
        3 => cells().prop_map(Step::Redraw),
        1 => (cells(), panel(Clusters::None)).prop_map(|(cells, panel)| Step::Panel(cells, panel)),
    ]
}

/// How the next frame is sent.
#[derive(Clone, Copy, Debug)]
struct Pace {
    wait: Duration,
    quality: Quality,
    max_bytes: Option<usize>,
}

fn pace() -> impl Strategy<Value = Pace> {
    let wait = prop_oneof![Just(33), Just(250), Just(500), Just(1_000), 0_u64..1_200].prop_map(Duration::from_millis);
    let quality = prop_oneof![1 => Just(Quality::Exact), 4 => Just(Quality::Equal), 4 => Just(Quality::Fast)];
    let max_bytes = prop_oneof![3 => Just(None), 2 => (0_usize..2_000).prop_map(Some)];
    (wait, quality, max_bytes).prop_map(|(wait, quality, max_bytes)| Pace { wait, quality, max_bytes })
}

proptest! {
    #![proptest_config(config(600))]

    #[test]
    fn every_terminal_shows_nearly_every_frame(
        size in size(),
        cells in cells(),
        first in pace(),
        steps in vec((lossy_step(), pace()), 1..8),
        pieces in vec(1_usize..40, 1..9),
    ) {
        for way in WAYS {
            let mut stage = Stage::new(way, filled(size, &cells), Clusters::None);
            stage.watched = stage.watched.in_pieces(pieces.clone());
            let mut last = Allowance { quality: first.quality, now: first.wait, max_bytes: first.max_bytes };
            stage.watched.send_within(&stage.grid, last);
            for (step, Pace { wait, quality, max_bytes }) in &steps {
                stage.take(step);
                last = Allowance { quality: *quality, now: last.now + *wait, max_bytes: *max_bytes };
                stage.watched.send_within(&stage.grid, last);
            }
            let rest = stage.watched.rest(&stage.grid, last);
            let in_time = last.max_bytes.is_some() || rest.after <= Duration::from_secs(1);
            prop_assert!(in_time, "all is exact only after {:?}", rest.after);
        }
    }

    /// Exact and lossy frames look the same, in whatever pieces they are read.
    #[test]
    fn a_frame_is_the_same_in_any_pieces(
        size in size(),
        cells in vec(cell(anything(Clusters::None)), CELLS),
        steps in vec(step(Clusters::None), 1..5),
        pieces in vec(1_usize..12, 1..9),
    ) {
        for mut stage in Stage::all(&filled(size, &cells), Clusters::None) {
            stage.watched = stage.watched.in_pieces(pieces.clone());
            stage.send(usize::MAX);
            for step in &steps {
                stage.take(step);
                stage.send(usize::MAX);
            }
        }
    }
}

fn allowance(millis: u64, quality: Quality, max_bytes: Option<usize>) -> Allowance {
    Allowance { quality, now: Duration::from_millis(millis), max_bytes }
}

/// Returns flat cells of one grey.
fn grey(size: Size, level: u8) -> Grid {
    let mut grid = Grid::new(size);
    grid.fill(&Cell::new(' ', Ink::Default, rgb(level, level, level)));
    grid
}

fn encoded(encoder: &mut Encoder, grid: &Grid, allowance: Allowance) -> String {
    let mut bytes = Vec::new();
    encoder.encode_within(grid, allowance, &mut bytes);
    String::from_utf8(bytes).expect("UTF-8")
}

/// An invisible change is left out at first, and sent half a second later: neither earlier nor
/// twice.
#[test]
fn an_invisible_change_is_delayed_by_half_a_second() {
    for quality in [Quality::Equal, Quality::Fast] {
        let size = Size::new(9, 3);
        let mut encoder = Encoder::new();
        encoded(&mut encoder, &grey(size, 100), allowance(0, quality, None));
        assert_eq!(encoder.due(), None, "one colour is shown exactly at once");
        let wanted = grey(size, 101);
        assert_eq!(encoded(&mut encoder, &wanted, allowance(1_000, quality, None)), "", "{quality:?}");
        assert_eq!(encoder.due(), Some(Duration::from_millis(1_500)));
        assert_eq!(encoded(&mut encoder, &wanted, allowance(1_499, quality, None)), "");
        assert_ne!(encoded(&mut encoder, &wanted, allowance(1_500, quality, None)), "");
        assert_eq!(encoder.due(), None);
        assert_eq!(encoded(&mut encoder, &wanted, allowance(2_500, quality, None)), "");
    }
}

/// 7 steps of this grey are 0.0242 in `OKLab`, 4 are 0.0139, and 2 are 0.0069.
#[test]
fn each_quality_has_its_own_cap() {
    for (level, sent) in [(102, [false, false]), (104, [true, false]), (107, [true, true])] {
        for (quality, sent) in [Quality::Equal, Quality::Fast].into_iter().zip(sent) {
            let size = Size::new(40, 10);
            let mut encoder = Encoder::new();
            encoded(&mut encoder, &grey(size, 100), allowance(0, quality, None));
            // One cell of many: the signal-to-noise ratio does not matter.
            let mut wanted = grey(size, 100);
            wanted.cell_mut(7, 7).bg = rgb(level, level, level);
            let bytes = encoded(&mut encoder, &wanted, allowance(10, quality, None));
            assert_eq!(!bytes.is_empty(), sent, "{level} at {quality:?}");
        }
    }
}

/// The lower half counts as the upper one does.
#[test]
fn either_half_may_be_what_differs() {
    let base = Cell::new('▄', rgb(100, 100, 100), rgb(30, 30, 30));
    for change in [Cell { fg: rgb(130, 100, 100), ..base.clone() }, Cell { bg: rgb(60, 30, 30), ..base.clone() }] {
        let mut grid = Grid::new(Size::new(20, 20));
        grid.fill(&base);
        let mut watched = Watched::new(Order::Color, HalfBlocks::Either, grid.size(), Clusters::None);
        watched.send_within(&grid, allowance(0, Quality::Fast, None));
        *grid.cell_mut(3, 3) = change;
        assert_ne!(watched.send_within(&grid, allowance(1, Quality::Fast, None)), 0);
    }
}

/// Each frame under a limit keeps it, uses it, and brings the picture nearer.
#[test]
fn a_limit_is_kept() {
    let size = Size::new(30, 8);
    for quality in [Quality::Equal, Quality::Fast] {
        let mut watched = Watched::new(Order::Raster, HalfBlocks::Either, size, Clusters::None);
        watched.send(&grey(size, 20));
        let mut wanted = grey(size, 20);
        for at in 0..size.cell_count() {
            let level = 20 + (at * 37 % 200) as u8;
            wanted.set_at(at, &Cell::new('▄', rgb(level, 20, 20), rgb(20, level, 20)));
        }
        // The watched encoder asserts that no frame is above the limit, and that the error shrinks.
        let limited = allowance(0, quality, Some(300));
        let sent = watched.send_within(&wanted, limited);
        assert!((100..=300).contains(&sent), "{sent} bytes");
        let rest = watched.rest(&wanted, limited);
        assert!(rest.after >= Duration::from_millis(500));
    }
}

/// Text is sent under any limit; the picture is delayed.
#[test]
fn a_limit_does_not_keep_text_back() {
    let size = Size::new(30, 8);
    let mut watched = Watched::new(Order::Color, HalfBlocks::Either, size, Clusters::None);
    watched.send(&grey(size, 20));
    let mut wanted = grey(size, 200);
    for column in 0..30 {
        *wanted.cell_mut(column, 3) = Cell::new('x', rgb(255, column as u8, 0), Ink::Default);
    }
    let limited = allowance(0, Quality::Fast, Some(100));
    assert!(watched.send_within(&wanted, limited) > 100);
    watched.rest(&wanted, limited);
}

/// A frame whose text alone exceeds the limit changes no cell of the picture, whether or not bytes
/// were scarce before.
#[test]
fn text_that_exceeds_the_limit_is_sent_alone() {
    let size = Size::new(30, 8);
    let limited = |millis| allowance(millis, Quality::Equal, Some(400));
    for frames_before in [0, 5] {
        let mut watched = Watched::new(Order::Color, HalfBlocks::Either, size, Clusters::None);
        watched.send(&grey(size, 20));
        let mut number = super::pictures::noise(3);
        for k in 0..frames_before {
            assert!(watched.send_within(&noisy(size, &mut number), limited(33 * k)) <= 400);
        }
        let shown = watched.shown().to_vec();
        let mut wanted = grey(size, 200);
        for column in 0..30 {
            *wanted.cell_mut(column, 3) = Cell::new('x', rgb(255, 8 * column as u8, 0), Ink::Default);
        }
        let sent = watched.send_within(&wanted, limited(300));
        assert!(sent > 400, "{sent} bytes");
        let is_text = |at: usize| (90..120).contains(&at);
        for (at, shown) in shown.iter().enumerate().filter(|&(at, _)| !is_text(at)) {
            assert_eq!(&watched.shown()[at], shown, "cell {at} after {frames_before} frames");
        }
        watched.rest(&wanted, limited(300));
    }
}

/// Returns a picture of noise.
fn noisy(size: Size, number: &mut impl FnMut() -> u32) -> Grid {
    let mut grid = Grid::new(size);
    for at in 0..size.cell_count() {
        let mut ink = || {
            let [r, g, b, _] = number().to_le_bytes();
            rgb(r, g, b)
        };
        grid.set_at(at, &Cell::new('▄', ink(), ink()));
    }
    grid
}

/// Returns a picture in which all halves have a colour of their own, moved by some columns.
fn gradient(size: Size, moved: usize) -> Grid {
    let mut grid = Grid::new(size);
    for at in 0..size.cell_count() {
        let columns = usize::from(size.columns);
        let (column, row) = (at % columns + moved, at / columns);
        let ink = |half: usize| rgb((3 * column) as u8, (9 * half) as u8, (2 * column + 5 * half) as u8);
        grid.set_at(at, &Cell::new('▄', ink(2 * row + 1), ink(2 * row)));
    }
    grid
}

/// After a motion the picture is mended with coarse colours first, then exactly, also under the
/// smallest limit.
#[test]
fn still_frames_begin_with_coarse_colours() {
    for max_bytes in [200, 216, 400, 800] {
        mend_gradient(max_bytes);
    }
}

fn mend_gradient(max_bytes: usize) {
    let size = Size::new(60, 12);
    let mut watched = Watched::new(Order::Color, HalfBlocks::Either, size, Clusters::None).synchronized();
    watched.send(&gradient(size, 0));
    let limited = |frame: u64| allowance(33 * frame, Quality::Equal, Some(max_bytes));
    for frame in 1..=10 {
        watched.send_within(&gradient(size, 2 * frame as usize), limited(frame));
    }
    let wanted = gradient(size, 20);
    let before = (watched.shown().to_vec(), watched.psnr(&wanted));
    for frame in 11..=15 {
        watched.send_within(&wanted, limited(frame));
    }
    let cells = watched.shown().iter().zip(&before.0).zip(wanted.cells());
    let changed = cells.filter(|((after, before), _)| after != before);
    // Final colours are exact, or nearly so.
    let is_coarse = |shown: &Cell, wanted: &Cell| {
        let near = |a: Ink, b: Ink| matches!((a, b), (Ink::Rgb(a), Ink::Rgb(b)) if a.r.abs_diff(b.r) < 9);
        !near(shown.bg, wanted.bg)
    };
    let coarse = changed.filter(|((after, _), wanted)| is_coarse(after, wanted)).count();
    assert!(coarse > 10, "{coarse} coarse cells with {max_bytes} bytes");
    assert!(watched.psnr(&wanted) > before.1, "{:.1} dB after {:.1}", watched.psnr(&wanted), before.1);
    watched.rest(&wanted, limited(15));
}

/// The number of columns with noise in [`brightening`].
const NOISY_COLUMNS: usize = 10;

/// Returns a picture with a strip of noise, and a gradient that gets lighter, each column a
/// frame after the last, by one level in every second frame.
fn brightening(size: Size, frame: usize, number: &mut impl FnMut() -> u32) -> Grid {
    let mut grid = noisy(size, number);
    let columns = usize::from(size.columns);
    for at in (0..size.cell_count()).filter(|at| at % columns >= NOISY_COLUMNS) {
        let lighter = frame.saturating_sub(at % columns) / 2;
        let ink = |half: usize| rgb((100 + at % columns + lighter) as u8, (60 + 3 * half) as u8, 90);
        let row = at / columns;
        grid.set_at(at, &Cell::new('▄', ink(2 * row + 1), ink(2 * row)));
    }
    grid
}

/// Errors that are too small to be worth their bytes beside large ones are mended within a second.
#[test]
fn no_cell_is_visibly_wrong_for_more_than_a_second() {
    for (order, half_blocks) in WAYS {
        // Without an order by colours, each cell may need a change of the pen.
        let bytes = if order == Order::Color { [1_000, 1_600, 3_000] } else { [2_600, 4_000, 5_000] };
        for (max_bytes, frames_per_second) in bytes.into_iter().zip([30, 15, 5]) {
            let longest = longest_wrong(order, half_blocks, max_bytes, frames_per_second);
            let what = format!("{longest} frames at {frames_per_second} a second, {max_bytes} bytes, {order:?}");
            assert!(longest <= frames_per_second, "a cell is wrong for {what}");
            assert!(longest > frames_per_second / 2, "no cell waits: {what}");
        }
    }
}

/// Returns the largest number of successive frames in which a cell of a gradient is visibly wrong.
fn longest_wrong(order: Order, half_blocks: HalfBlocks, max_bytes: usize, frames_per_second: usize) -> usize {
    let size = Size::new(60, 12);
    let mut watched = Watched::new(order, half_blocks, size, Clusters::None);
    let mut number = super::pictures::noise(5);
    watched.send(&brightening(size, 0, &mut number));
    let (mut ages, mut longest) = (vec![0; size.cell_count()], 0);
    for frame in 1..=3 * frames_per_second {
        let wanted = brightening(size, 30 * frame / frames_per_second, &mut number);
        let millis = (1_000 * frame / frames_per_second) as u64;
        watched.send_within(&wanted, allowance(millis, Quality::Equal, Some(max_bytes)));
        for (at, ((age, shown), wanted)) in ages.iter_mut().zip(watched.shown()).zip(wanted.cells()).enumerate() {
            let (Some(shown), Some(wanted)) = (halves(shown), halves(wanted)) else { panic!("all is picture") };
            let is_wrong = (0..2).any(|half| distance(shown[half], wanted[half]) > 0.02);
            *age = if is_wrong { *age + 1 } else { 0 };
            if at % usize::from(size.columns) >= NOISY_COLUMNS {
                longest = longest.max(*age);
            }
        }
    }
    longest
}

/// Returns a picture of noise near one grey.
fn nearly_grey(size: Size, number: &mut impl FnMut() -> u32) -> Grid {
    let mut grid = Grid::new(size);
    for at in 0..size.cell_count() {
        let mut ink = || {
            let [a, b, c, _] = number().to_le_bytes().map(|byte| 100 + byte % 4);
            rgb(a, b, c)
        };
        grid.set_at(at, &Cell::new('▄', ink(), ink()));
    }
    grid
}

/// A picture of noise becomes exact in frames that tmux does not drop, unless nothing else is to be
/// sent.
#[test]
fn exact_colours_are_spread_over_frames() {
    let size = Size::new(40, 10);
    let mut number = super::pictures::noise(5);
    let (first, near) = (nearly_grey(size, &mut number), nearly_grey(size, &mut number));
    let mut watched = Watched::new(Order::Color, HalfBlocks::Either, size, Clusters::None);
    watched.send(&first);
    let allowed = allowance(0, Quality::Fast, None);
    assert_eq!(watched.send_within(&near, allowed), 0, "the difference is invisible");
    let mut now = Duration::from_millis(500);
    let mut frames = 0;
    loop {
        let sent = watched.send_within(&near, Allowance { now, ..allowed });
        if sent == 0 {
            break;
        }
        frames += 1;
        assert!(sent <= 8 * size.cell_count(), "{sent} bytes in one frame");
        now += Duration::from_millis(33);
    }
    assert!(frames > 1, "there was more to send than one frame may take");
}

/// All cells become exact, on a screen of any size.
#[test]
fn small_screens_become_exact() {
    for size in [(1, 1), (2, 1), (1, 2), (3, 1), (10, 1), (5, 3)] {
        let size = Size::new(size.0, size.1);
        let mut watched = Watched::new(Order::Raster, HalfBlocks::Either, size, Clusters::None);
        watched.send(&grey(size, 100));
        let mut wanted = grey(size, 101);
        for at in 0..size.cell_count() {
            let bg = rgb(101, 100 + (at % 2) as u8, 100);
            wanted.set_at(at, &Cell { bg, ..wanted.at(at) });
        }
        let allowed = allowance(0, Quality::Fast, None);
        watched.send_within(&wanted, allowed);
        watched.rest(&wanted, allowed);
    }
}

/// `Exact` is the same as `encode`, whatever the limit.
#[test]
fn exact_is_exact() {
    let size = Size::new(9, 3);
    for (level, max_bytes) in [(1, None), (2, Some(0)), (3, Some(50))] {
        let (mut one, mut other) = (Encoder::new(), Encoder::new());
        let mut bytes = Vec::new();
        for level in [0, level] {
            bytes.clear();
            one.encode(&grey(size, level), &mut bytes);
            let within = encoded(&mut other, &grey(size, level), allowance(0, Quality::Exact, max_bytes));
            assert_eq!(within.as_bytes(), bytes);
            assert_eq!(other.due(), None);
        }
    }
}

/// A panel's blanks are text: they are not delayed, and the picture behind them comes back and gets
/// exact.
#[test]
fn blanks_of_text_do_not_wait() {
    let size = Size::new(30, 8);
    let mut watched = Watched::new(Order::Color, HalfBlocks::Either, size, Clusters::None);
    watched.send(&grey(size, 20));
    let mut panel = grey(size, 20);
    for column in 3..20 {
        *panel.cell_mut(column, 3) = Cell::new(' ', rgb(255, 255, 255), rgb(21, 20, 20));
    }
    let allowed = allowance(0, Quality::Fast, Some(0));
    assert!(watched.send_within(&panel, allowed) > 0);
    assert_eq!(watched.rest(&panel, allowed).bytes, 0, "all was there at once");
    let mut alike = grey(size, 20);
    for column in 3..20 {
        *alike.cell_mut(column, 3) = Cell::new(' ', Ink::Default, rgb(21, 20, 20));
    }
    let later = allowance(10, Quality::Fast, None);
    assert_eq!(watched.send_within(&alike, later), 0, "it looks as before");
    watched.rest(&alike, later);
}

/// A limit above that of one frame has no effect.
#[test]
fn a_generous_limit_does_not_loosen_the_usual_one() {
    let size = Size::new(40, 10);
    let mut number = super::pictures::noise(7);
    let (first, near) = (nearly_grey(size, &mut number), nearly_grey(size, &mut number));
    let mut watched = Watched::new(Order::Raster, HalfBlocks::Either, size, Clusters::None);
    watched.send(&first);
    let generous = |millis| allowance(millis, Quality::Fast, Some(usize::MAX));
    watched.send_within(&near, generous(0));
    let sent = watched.send_within(&near, generous(500));
    assert!((1..=8 * size.cell_count()).contains(&sent), "{sent} bytes");
    watched.rest(&near, generous(533));
}

#[test]
fn a_forgotten_screen_is_due_at_once() {
    let mut encoder = Encoder::new();
    encoded(&mut encoder, &grey(Size::new(3, 1), 9), allowance(0, Quality::Exact, None));
    assert_eq!(encoder.due(), None);
    encoder.forget();
    assert_eq!(encoder.due(), Some(Duration::ZERO));
}
