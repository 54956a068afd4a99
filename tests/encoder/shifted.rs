//! Frames that shift what the terminals show: they show what the encoder believes, under panels,
//! resizes and limits.

use super::grids::put;
use super::pictures::noise;
use super::screens::{Clusters, Loss, glyph_of};
use super::watched::Watched;
use super::{config, rgb};
use proptest::collection::vec;
use proptest::prelude::*;
use std::time::Duration;
use termtrace::internals::capabilities::Shifts;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{Cell, Encoder, Grid, Ink, Order, Quality, Size};

/// A plane of coloured squares on a gradient, and the part of it that is in view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) seed: u32,
    /// The column and the row of half cells at the top left.
    pub(crate) at: [i32; 2],
    /// The number of levels by which the halves of a square differ: 0 for flat squares.
    pub(crate) grain: u32,
    /// The levels that are added to all colours.
    pub(crate) shade: u8,
}

impl View {
    fn color(&self, x: i32, y: i32) -> Ink {
        let square = [x.div_euclid(5), y.div_euclid(4)].map(i32::cast_unsigned);
        let mixed = |n: u32| {
            let n = (n ^ n >> 15).wrapping_mul(0x85eb_ca6b);
            (n ^ n >> 13).wrapping_mul(0xc2b2_ae35) >> 16
        };
        let of_square = mixed(self.seed ^ square[0].wrapping_mul(0x9e37_79b9) ^ square[1].wrapping_mul(0x7feb_352d));
        let grain =
            mixed(self.seed ^ x.cast_unsigned().wrapping_mul(0x27d4_eb2f) ^ y.cast_unsigned()) % (self.grain + 1);
        let level = |shift: u32| (40 + (of_square >> shift) % 6 * 30 + grain) as u8 + self.shade;
        rgb(level(0), level(3), level(6))
    }

    pub(crate) fn grid(&self, size: Size) -> Grid {
        let mut grid = Grid::new(size);
        for row in 0..size.rows {
            for column in 0..size.columns {
                let [x, y] = [self.at[0] + i32::from(column), self.at[1] + 2 * i32::from(row)];
                let (upper, lower) = (self.color(x, y), self.color(x, y + 1));
                let cell =
                    if upper == lower { Cell::new(' ', Ink::Default, upper) } else { Cell::new('▄', lower, upper) };
                *grid.cell_mut(column, row) = cell;
            }
        }
        grid
    }
}

/// A change from one frame to the next.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    /// The view moves by columns and rows of half cells.
    Pan(i32, i32),
    /// Text is laid over a corner of the picture, or at a place of it.
    Panel {
        column: u16,
        row: u16,
        columns: u16,
        rows: u16,
        text: &'static str,
    },
    /// The panel is closed.
    Close,
    Resize(Size),
    /// Another program writes on the screen.
    Disturb,
}

fn screen() -> impl Strategy<Value = Size> {
    (1_u16..=90, 1_u16..=14).prop_map(|(columns, rows)| Size::new(columns, rows))
}

fn event() -> impl Strategy<Value = Event> {
    let text = prop::sample::select(&["plain text ", "世界", "🙂 ok ", "│ ─ é "][..]);
    let panel = (0_u16..80, 0_u16..12, 1_u16..30, 1_u16..6, text)
        .prop_map(|(column, row, columns, rows, text)| Event::Panel { column, row, columns, rows, text });
    prop_oneof![
        5 => (-9_i32..=9, -1_i32..=1).prop_map(|(x, y)| Event::Pan(x, y)),
        4 => (-1_i32..=1, -4_i32..=4).prop_map(|(x, y)| Event::Pan(x, y)),
        2 => panel,
        1 => Just(Event::Close),
        1 => screen().prop_map(Event::Resize),
        1 => Just(Event::Disturb),
    ]
}

/// The way in which a frame is sent, and the time since the last.
fn pace() -> impl Strategy<Value = (Quality, Option<usize>, u64)> {
    let quality = prop_oneof![1 => Just(Quality::Exact), 4 => Just(Quality::Equal), 1 => Just(Quality::Fast)];
    let limit = prop_oneof![1 => Just(None), 3 => (200_usize..3_000).prop_map(Some)];
    (quality, limit, prop_oneof![4 => Just(33), 1 => 0_u64..1_200])
}

/// A mark that the frame loses, if any.
fn loss() -> impl Strategy<Value = Option<Loss>> {
    prop::sample::select(&[None, None, Some(Loss::Begin), Some(Loss::End), Some(Loss::EndUntilNextFrame)][..])
}

fn put_text(grid: &mut Grid, panel: &Event) {
    let Event::Panel { column, row, columns, rows, text } = *panel else { return };
    let Size { columns: most_columns, rows: most_rows } = grid.size();
    for row in row..(row + rows).min(most_rows) {
        let (mut at, end) = (column, (column + columns).min(most_columns));
        for character in text.chars().cycle() {
            if at >= end {
                break;
            }
            let glyph = glyph_of(character.encode_utf8(&mut [0; 4]));
            put(grid, at, row, &Cell { glyph, ..Cell::new(' ', rgb(250, 250, 250), rgb(20, 20, 60)) });
            at += 1 + u16::from(character as u32 > 0x2fff);
        }
    }
}

/// Sends a view with shifts, and its panel.
pub(crate) struct Story {
    pub(crate) watched: Watched,
    view: View,
    size: Size,
    panel: Option<Event>,
    now: Duration,
}

impl Story {
    pub(crate) fn new(view: View, size: Size, half_blocks: HalfBlocks, shifts: Shifts) -> Self {
        let watched =
            Watched::new(Order::Color, half_blocks, size, Clusters::None).with_shifts(shifts).asserting_belief();
        Self { watched, view, size, panel: None, now: Duration::ZERO }
    }

    pub(crate) fn take(&mut self, event: &Event) {
        match *event {
            Event::Pan(x, y) => self.view.at = [self.view.at[0] + x, self.view.at[1] + y],
            Event::Panel { .. } => self.panel = Some(event.clone()),
            Event::Close => self.panel = None,
            Event::Resize(size) => {
                self.size = size;
                self.watched.resize(size);
            }
            Event::Disturb => self.watched.disturb(self.size),
        }
    }

    fn grid(&self) -> Grid {
        let mut grid = self.view.grid(self.size);
        if let Some(panel) = &self.panel {
            put_text(&mut grid, panel);
        }
        grid
    }

    #[track_caller]
    pub(crate) fn send(&mut self, quality: Quality, max_bytes: Option<usize>, millis: u64) -> usize {
        self.now += Duration::from_millis(millis);
        self.watched.send_within(&self.grid(), Allowance { quality, now: self.now, max_bytes })
    }
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn terminals_show_what_the_encoder_believes(
        seed in any::<u32>(),
        grain in 0_u32..4,
        size in screen(),
        is_exact_first in any::<bool>(),
        steps in vec((event(), pace()), 1..12),
    ) {
        let view = View { seed, at: [0; 2], grain, shade: 0 };
        for (half_blocks, shifts) in
            [(HalfBlocks::Lower, Shifts::Direct), (HalfBlocks::Either, Shifts::ThroughTmux)]
        {
            let mut story = Story::new(view, size, half_blocks, shifts);
            if is_exact_first {
                let grid = story.grid();
                story.watched.send(&grid);
            }
            let mut last = (Quality::Equal, None);
            for (event, (quality, max_bytes, millis)) in &steps {
                story.take(event);
                story.send(*quality, *max_bytes, *millis);
                last = (*quality, *max_bytes);
            }
            let (grid, (quality, max_bytes)) = (story.grid(), last);
            story.watched.rest(&grid, Allowance { quality, now: story.now, max_bytes });
        }
    }

    /// Sends all events in synchronized updates that lose the mark of their begin or end.
    #[test]
    fn lost_marks_of_synchronized_updates_do_no_harm(
        seed in any::<u32>(),
        size in screen(),
        pieces in vec(1_usize..200, 1..4),
        steps in vec((event(), pace(), loss()), 1..12),
    ) {
        let view = View { seed, at: [0; 2], grain: 2, shade: 0 };
        let mut story = Story::new(view, size, HalfBlocks::Either, Shifts::Direct);
        story.watched = story.watched.synchronized().in_pieces(pieces);
        for (event, (quality, max_bytes, millis), loss) in &steps {
            story.take(event);
            story.watched.lose(*loss);
            story.send(*quality, *max_bytes, *millis);
        }
        let grid = story.grid();
        story.watched.lose(None);
        story.watched.send(&grid);
    }

    /// Exact frames with shifts are exact.
    #[test]
    fn shifted_frames_are_exact(seed in any::<u32>(), size in screen(), events in vec(event(), 1..10)) {
        let view = View { seed, at: [0; 2], grain: 3, shade: 0 };
        let mut story = Story::new(view, size, HalfBlocks::Either, Shifts::Direct);
        for event in &events {
            story.take(event);
            let grid = story.grid();
            story.watched.send(&grid);
        }
    }

    /// The limit is never exceeded by a picture, however it moves.
    #[test]
    fn shifts_keep_the_limit(
        seed in any::<u32>(),
        grain in 0_u32..4,
        max_bytes in 250_usize..2_000,
        moves in vec((-9_i32..=9, -4_i32..=4), 1..20),
    ) {
        let size = Size::new(90, 20);
        let view = View { seed, at: [0; 2], grain, shade: 0 };
        let mut story = Story::new(view, size, HalfBlocks::Either, Shifts::Direct);
        story.send(Quality::Equal, None, 0);
        for (x, y) in moves {
            story.take(&Event::Pan(x, y));
            let sent = story.send(Quality::Equal, Some(max_bytes), 33);
            prop_assert!(sent <= max_bytes, "{} bytes, at most {}", sent, max_bytes);
        }
    }
}

/// Returns the bytes of the second of two frames, between which the view moves.
fn second_frame(quality: Quality, max_bytes: Option<usize>, [x, y]: [i32; 2], shifts: Shifts) -> Vec<u8> {
    let size = Size::new(80, 24);
    let mut encoder = Encoder::new().with_order(Order::Color).with_half_blocks(HalfBlocks::Either).with_shifts(shifts);
    let mut view = View { seed: noise(7)(), at: [0; 2], grain: 3, shade: 0 };
    let mut bytes = Vec::new();
    let first = Allowance { quality, now: Duration::ZERO, max_bytes: None };
    encoder.encode_within(&view.grid(size), first, &mut bytes);
    view.at = [x, y];
    bytes.clear();
    let allowance = Allowance { quality, now: Duration::from_millis(33), max_bytes };
    encoder.encode_within(&view.grid(size), allowance, &mut bytes);
    bytes
}

/// Returns the final characters of the sequences that shift.
fn operations(bytes: &[u8]) -> Vec<u8> {
    let text = str::from_utf8(bytes).expect("UTF-8");
    let sequences =
        text.split("\x1b[").skip(1).filter_map(|rest| rest.bytes().find(|byte| !b"0123456789;".contains(byte)));
    sequences.filter(|last| b"@PLM".contains(last)).collect()
}

#[test]
fn a_pan_shifts_every_row_by_one_operation() {
    assert_eq!(operations(&second_frame(Quality::Equal, None, [3, 0], Shifts::Direct)), [b'P'; 24]);
    assert_eq!(operations(&second_frame(Quality::Equal, None, [-3, 0], Shifts::Direct)), [b'@'; 24]);
    let exact = operations(&second_frame(Quality::Exact, None, [3, 0], Shifts::Direct));
    assert!(exact.len() > 20, "{exact:?}");
}

/// Returns a view whose two sides are moved by different numbers of columns, with a strip between
/// them that stays.
fn with_moved_sides(view: View, size: Size, [left, right]: [i32; 2]) -> Grid {
    let mut grid = view.grid(size);
    for (columns, by) in [(0..36, left), (44..size.columns, right)] {
        let moved = View { at: [view.at[0] + by, view.at[1]], ..view }.grid(size);
        for row in 0..size.rows {
            for column in columns.clone() {
                *grid.cell_mut(column, row) = moved.cell(column, row);
            }
        }
    }
    grid
}

/// Two operations shift the left side, and one the right side, which reaches the last column.
#[test]
fn both_sides_of_a_row_are_shifted() {
    let size = Size::new(80, 24);
    for (sides, of_row) in [([3, -2], b"P@@"), ([-3, 2], b"P@P"), ([5, -4], b"P@@"), ([-4, 5], b"P@P")] {
        let view = View { seed: noise(7)(), at: [0; 2], grain: 3, shade: 0 };
        let mut watched = Watched::new(Order::Color, HalfBlocks::Either, size, Clusters::None)
            .with_shifts(Shifts::Direct)
            .asserting_belief();
        let allowance =
            |millis| Allowance { quality: Quality::Equal, now: Duration::from_millis(millis), max_bytes: None };
        watched.send_within(&view.grid(size), allowance(0));
        watched.send_within(&with_moved_sides(view, size, sides), allowance(33));
        assert_eq!(operations(watched.sent()), of_row.repeat(24), "{sides:?}");
    }
}

#[test]
fn frames_under_a_cap_shift() {
    for max_bytes in [1_000, 1_500, 3_000] {
        let operations = operations(&second_frame(Quality::Equal, Some(max_bytes), [3, 0], Shifts::Direct));
        assert!(operations.contains(&b'P'), "{max_bytes}: {operations:?}");
    }
}

/// A window that is shifted the wrong way would be farther from what is wanted.
#[test]
fn shifts_make_frames_under_a_cap_better() {
    for pan in [[3, 0], [-2, 0], [0, 2], [0, -4]] {
        let errors = [Shifts::Off, Shifts::Direct].map(|shifts| {
            let view = View { seed: noise(7)(), at: [0; 2], grain: 3, shade: 0 };
            let mut story = Story::new(view, Size::new(80, 24), HalfBlocks::Either, shifts);
            story.send(Quality::Equal, None, 0);
            let mut error = 0;
            for _ in 0..10 {
                story.take(&Event::Pan(pan[0], pan[1]));
                story.send(Quality::Equal, Some(1_500), 33);
                error += story.watched.error(&story.grid());
            }
            error
        });
        assert!(2 * errors[1] < errors[0], "{pan:?}: {} with shifts, {} without", errors[1], errors[0]);
    }
}

#[test]
fn a_tilt_shifts_all_rows_by_one_operation() {
    assert_eq!(operations(&second_frame(Quality::Equal, None, [0, 2], Shifts::Direct)), [b'M']);
    assert_eq!(operations(&second_frame(Quality::Equal, None, [0, -4], Shifts::Direct)), [b'L']);
}

#[test]
fn shifts_save_a_sixth_of_a_pan_or_more() {
    for (quality, pan) in [(Quality::Exact, [5, 0]), (Quality::Equal, [-5, 0]), (Quality::Equal, [0, 4])] {
        let [without, with] =
            [Shifts::Off, Shifts::Direct].map(|shifts| second_frame(quality, None, pan, shifts).len());
        assert!(6 * with < 5 * without, "{with} bytes with shifts, {without} without: {quality:?}, {pan:?}");
    }
}

#[test]
fn nothing_is_shifted_unless_it_is_asked_for() {
    for max_bytes in [None, Some(1_500)] {
        let operations = operations(&second_frame(Quality::Equal, max_bytes, [3, 0], Shifts::Off));
        assert!(operations.is_empty(), "{operations:?}");
    }
}
