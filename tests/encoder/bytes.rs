//! The bytes themselves, worked out by hand.

use super::rgb;
use alacritty_terminal::event::VoidListener;
use alacritty_terminal::grid::Dimensions;
use alacritty_terminal::term::Config;
use alacritty_terminal::vte::ansi;
use std::io::{self, Write};
use std::time::Duration;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::{Attributes, HalfBlocks};
use termtrace::{Cell, Encoder, Glyph, Grid, Ink, Order, Quality, Size};

const A: Ink = rgb(10, 20, 30);
const B: Ink = rgb(200, 100, 0);
const C: Ink = rgb(1, 2, 3);

fn flat(cell: &Cell) -> Grid {
    let mut grid = Grid::new(Size::new(5, 3));
    for row in 0..3 {
        for column in 0..5 {
            grid.cell_mut(column, row).clone_from(cell);
        }
    }
    grid
}

fn encoded(encoder: &mut Encoder, grid: &Grid) -> String {
    let mut bytes = Vec::new();
    encoder.encode(grid, &mut bytes);
    String::from_utf8(bytes).expect("UTF-8")
}

#[test]
fn a_first_frame_sets_each_colour_once() {
    let grid = flat(&Cell::new('▄', A, B));
    assert_eq!(
        encoded(&mut Encoder::new(), &grid),
        "\x1b[0m\x1b[H\x1b[38;2;10;20;30;48;2;200;100;0m▄▄▄▄▄\r\n▄▄▄▄▄\r\n▄▄▄▄▄"
    );
}

/// The first eight colours take two digits, but not with bold: many terminals would brighten them.
#[test]
fn the_first_colours_are_short() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::BLANK);
    encoded(&mut encoder, &grid);
    let cell = |index, attributes| Cell { attributes, ..Cell::new('x', Ink::Indexed(index), Ink::Indexed(index)) };
    for (index, attributes, expected) in [
        (3, Attributes::empty(), "\x1b[33;43mx"),
        // This colour is set again: the earlier one would be brightened.
        (3, Attributes::BOLD, "\x1b[0;1;38;5;3;43mx"),
        (4, Attributes::BOLD, "\x1b[38;5;4;44mx"),
        (7, Attributes::empty(), "\x1b[0;37;47mx"),
        (8, Attributes::empty(), "\x1b[38;5;8;48;5;8mx"),
        (8, Attributes::BOLD, "\x1b[1mx"),
        (8, Attributes::BOLD | Attributes::DIM, "\x1b[2mx"),
        // In the other order some terminals would end bold.
        (9, Attributes::DIM, "\x1b[0;2;38;5;9;48;5;9mx"),
        (9, Attributes::DIM | Attributes::BOLD, "\x1b[0;1;2;38;5;9;48;5;9mx"),
    ] {
        *grid.cell_mut(0, 0) = cell(index, attributes);
        assert_eq!(encoded(&mut encoder, &grid), format!("\x1b[H{expected}"), "{index} {attributes:?}");
    }
    *grid.cell_mut(0, 0) = Cell::new('y', Ink::Default, Ink::Default);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[H\x1b[my");
}

/// A sequence has sixteen numbers at most.
#[test]
fn long_sequences_are_split() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell { attributes: Attributes::BOLD, ..Cell::new('x', A, A) });
    encoded(&mut encoder, &grid);
    let many = Attributes::all().difference(Attributes::BOLD | Attributes::DIM);
    for (attributes, expected) in [
        (many, "\x1b[0;3;4;5;6;7;8;9m\x1b[38;2;1;2;3;48;2;200;100;0mx"),
        (Attributes::REVERSED, "\x1b[0;7;38;2;1;2;3;48;2;200;100;0mx"),
    ] {
        *grid.cell_mut(0, 0) = Cell { attributes, ..Cell::new('x', C, B) };
        assert_eq!(encoded(&mut encoder, &grid), format!("\x1b[H{expected}"), "{attributes:?}");
    }
}

/// CUP, SGR of only the colour that differs from the pen, and the character.
#[test]
fn one_changed_cell_is_a_position_a_colour_and_a_character() {
    let mut encoder = Encoder::new();
    let start = Cell::new('▄', A, B);
    let mut grid = flat(&start);
    encoded(&mut encoder, &grid);
    for (cell, expected) in [
        (start.clone(), ""),
        (Cell::new('▄', C, B), "\x1b[2;4H\x1b[38;2;1;2;3m▄"),
        // The pen still has that colour.
        (Cell::new('x', C, B), "\x1b[2;4Hx"),
        (Cell::new('x', C, A), "\x1b[2;4H\x1b[48;2;10;20;30mx"),
        (Cell::new('x', B, C), "\x1b[2;4H\x1b[38;2;200;100;0;48;2;1;2;3mx"),
        // The colour of a space is not seen, and the pen's stays.
        (Cell::new(' ', A, A), "\x1b[2;4H\x1b[48;2;10;20;30m "),
        (Cell::new('▄', B, A), "\x1b[2;4H▄"),
        (Cell::new('▄', B, B), "\x1b[2;4H\x1b[48;2;200;100;0m▄"),
        (Cell::new('x', Ink::Default, B), "\x1b[2;4H\x1b[39mx"),
        (Cell::new('x', Ink::Indexed(7), Ink::Indexed(255)), "\x1b[2;4H\x1b[37;48;5;255mx"),
        (Cell::BLANK, "\x1b[2;4H\x1b[49m "),
    ] {
        grid.cell_mut(3, 1).clone_from(&cell);
        assert_eq!(encoded(&mut encoder, &grid), expected, "{cell:?}");
        assert_eq!(encoded(&mut encoder, &grid), "", "{cell:?} again");
    }
}

#[test]
fn attributes_are_added_and_all_switched_off_together() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::new('x', A, B));
    encoded(&mut encoder, &grid);
    let bold = Cell { attributes: Attributes::BOLD | Attributes::UNDERLINED, ..Cell::new('x', A, B) };
    *grid.cell_mut(0, 0) = bold.clone();
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[H\x1b[1;4mx");
    *grid.cell_mut(1, 0) = Cell { attributes: Attributes::BOLD | Attributes::UNDERLINED, ..Cell::new(' ', C, B) };
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[1;2H\x1b[38;2;1;2;3m ", "the line under a space is seen");
    *grid.cell_mut(0, 0) = Cell::new('x', A, B);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[H\x1b[0;38;2;10;20;30;48;2;200;100;0mx");
    *grid.cell_mut(0, 0) = bold;
    encoded(&mut encoder, &grid);
    *grid.cell_mut(0, 0) = Cell::new(' ', A, B);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[H\x1b[0;48;2;200;100;0m ", "a plain space's colour is not seen");
}

/// A run of changes has one position.
///
/// A gap of one is written again, if the pen is right for it: a byte instead of three. A line feed goes
/// down, after the last column behind a carriage return: only the row is known there.
#[test]
fn a_run_of_changes_has_one_position() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::BLANK);
    encoded(&mut encoder, &grid);
    for (column, row) in [(0, 0), (1, 0), (3, 0), (4, 0), (0, 1), (4, 2)] {
        grid.cell_mut(column, row).glyph = 'x'.into();
    }
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[Hxx xx\r\nx\x1b[3C\nx");
}

#[test]
fn moves_are_the_cheapest() {
    let mut encoder = Encoder::new();
    let mut grid = Grid::new(Size::new(30, 4));
    encoded(&mut encoder, &grid);
    let mut change = |cells: &[(u16, u16)]| {
        for &(column, row) in cells {
            let mut cell = grid.cell_mut(column, row);
            cell.glyph = if cell.glyph == 'x' { 'y' } else { 'x' }.into();
        }
        encoded(&mut encoder, &grid)
    };
    assert_eq!(change(&[(2, 0), (2, 1)]), "\x1b[1;3Hx\x08\nx", "one down, one back");
    assert_eq!(change(&[(4, 0), (0, 1)]), "\x1b[1;5Hx\r\nx", "one down, to the first column");
    assert_eq!(change(&[(3, 0), (9, 0)]), "\x1b[1;4Hx\x1b[5Cx", "five cells written again would be a byte more");
    assert_eq!(change(&[(3, 2), (3, 3)]), "\x1b[3;4Hx\x08\nx", "down to the last row");
    assert_eq!(change(&[(25, 1), (8, 2)]), "\x1b[2;26Hx\x1b[9G\nx", "one down, to a column");
    assert_eq!(change(&[(2, 0), (2, 3)]), "\x1b[1;3Hy\x08\n\n\nx", "three down");
}

/// In the order of colours, all cells of two colours come before those of the next two.
///
/// They may be anywhere on the screen; the next pair starts from the last cell.
#[test]
fn cells_of_the_same_colours_follow_each_other() {
    let mut grid = Grid::new(Size::new(5, 1));
    for (column, cell) in [Cell::new('▄', A, B), Cell::new(' ', A, C)].into_iter().cycle().take(4).enumerate() {
        *grid.cell_mut(column as u16, 0) = cell;
    }
    grid.cell_mut(4, 0).glyph = 'x'.into();
    assert_eq!(
        encoded(&mut Encoder::new().with_order(Order::Color), &grid),
        // Text first, in the terminal's own colours.
        "\x1b[0m\x1b[1;5Hx\r\x1b[38;2;10;20;30;48;2;200;100;0m▄\x1b[C▄\x08\x08\x1b[48;2;1;2;3m \x1b[C "
    );
}

/// Either half block shows the same cell; the other one may need only one new colour.
///
/// Never with the terminal's own colours: its foreground is not its background.
#[test]
fn the_other_half_block_saves_a_colour() {
    let mut grid = Grid::new(Size::new(2, 1));
    *grid.cell_mut(0, 0) = Cell::new('▄', A, B);
    *grid.cell_mut(1, 0) = Cell::new('▄', B, C);
    let mut encoder = Encoder::new().with_half_blocks(HalfBlocks::Either);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[0m\x1b[H\x1b[38;2;200;100;0;48;2;10;20;30m▀\x1b[48;2;1;2;3m▄");
    *grid.cell_mut(0, 0) = Cell::new('▄', C, Ink::Default);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[H\x1b[38;2;1;2;3;49m▄");
    *grid.cell_mut(0, 0) = Cell::new('▄', Ink::Indexed(9), Ink::Indexed(200));
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[H\x1b[38;5;200;48;5;9m▀", "the upper one, where both cost the same");
}

/// A space uses the pen's foreground as its background, inverted, for as long as that saves bytes.
///
/// Never with the terminal's own colours: its foreground is not its background.
#[test]
fn a_space_uses_the_foreground_inverted() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::new('▄', A, B));
    encoded(&mut encoder, &grid);
    let mut cells = |cells: [Cell; 4]| {
        for (column, cell) in (0..).zip(cells) {
            *grid.cell_mut(column, 0) = cell;
        }
        encoded(&mut encoder, &grid)
    };
    let space = |color| Cell::new(' ', Ink::Default, color);
    let x = |fg, bg| Cell::new('x', fg, bg);
    assert_eq!(cells([space(A), space(A), x(A, B), x(A, C)]), "\x1b[H\x1b[7m  \x1b[27mx\x1b[48;2;1;2;3mx");
    assert_eq!(cells([space(A), space(C), x(C, C), space(B)]), "\x1b[1;2H \x1b[38;2;1;2;3mx\x1b[48;2;200;100;0m ");
    let reversed = Cell { attributes: Attributes::REVERSED, ..x(C, B) };
    assert_eq!(cells([space(C), space(C), reversed.clone(), space(C)]), "\x1b[H\x1b[7m  x ");
    let bold = Cell { attributes: Attributes::BOLD, ..x(C, B) };
    let anew = "\x1b[1;3H\x1b[27;1mx\x1b[0;7;38;2;1;2;3;48;2;200;100;0mx";
    assert_eq!(cells([space(C), space(C), bold, reversed]), anew);
    let default = "\x1b[H\x1b[27;39;48;2;1;2;3mx\x1b[m \x1b[48;2;1;2;3m  ";
    assert_eq!(cells([x(Ink::Default, C), space(Ink::Default), space(C), space(C)]), default);
}

/// In the order of colours, too, where a space looks ahead to the colour of the next glyph.
#[test]
fn an_inverted_space_keeps_its_colour() {
    let (one, two) = (Ink::Indexed(1), Ink::Indexed(200));
    let mut grid = Grid::new(Size::new(3, 1));
    *grid.cell_mut(0, 0) = Cell::new('x', one, two);
    *grid.cell_mut(1, 0) = Cell::new(' ', Ink::Default, one);
    *grid.cell_mut(2, 0) = Cell { attributes: Attributes::REVERSED, ..Cell::new('x', Ink::Indexed(9), two) };
    assert_eq!(
        encoded(&mut Encoder::new().with_order(Order::Color), &grid),
        "\x1b[0m\x1b[H\x1b[31;48;5;200mx\x1b[7m \x1b[38;5;9mx"
    );
}

/// A gap of one half block takes three bytes either way.
///
/// It is written again, with the half for which the pen is right.
#[test]
fn a_half_block_in_a_gap_is_written_again() {
    for (turned, expected) in [(false, "\x1b[1;2Hx▄x"), (true, "\x1b[1;2Hx▀x")] {
        let mut encoder = Encoder::new().with_half_blocks(HalfBlocks::Either);
        let mut grid = flat(&Cell::new('y', A, B));
        *grid.cell_mut(2, 0) = if turned { Cell::new('▄', B, A) } else { Cell::new('▄', A, B) };
        encoded(&mut encoder, &grid);
        grid.cell_mut(1, 0).glyph = 'x'.into();
        grid.cell_mut(3, 0).glyph = 'x'.into();
        assert_eq!(encoded(&mut encoder, &grid), expected);
    }
}

/// Colours that are not visible are not sent.
#[test]
fn the_colour_of_a_plain_space_is_not_sent() {
    for order in [Order::Raster, Order::Color] {
        let mut encoder = Encoder::new().with_order(order);
        encoded(&mut encoder, &flat(&Cell::new(' ', A, B)));
        assert_eq!(encoded(&mut encoder, &flat(&Cell::new(' ', C, B))), "");
    }
}

#[test]
fn wide_characters_are_two_cells() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::BLANK);
    encoded(&mut encoder, &grid);
    grid.put(1, 0, &Cell::new('世', Ink::Default, Ink::Default), 2);
    grid.cell_mut(3, 0).glyph = 'x'.into();
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[1;2H世x");
    grid.cell_mut(1, 0).glyph = 'a'.into();
    grid.cell_mut(2, 0).glyph = ' '.into();
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[1;2Ha ");
}

fn cluster(text: &str) -> Cell {
    Cell { glyph: Glyph::Cluster(text.into()), ..Cell::BLANK }
}

/// After a cluster the cursor's position is unknown: the next cell has a position of its own.
///
/// Cells that a terminal writes over when it splits the cluster are written again, and no others.
#[test]
fn clusters_are_followed_by_a_position() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::new('x', Ink::Default, Ink::Default));
    encoded(&mut encoder, &grid);
    grid.put(0, 0, &cluster("e\u{301}"), 1);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[He\u{301}\x1b[1;2Hx");
    assert_eq!(encoded(&mut encoder, &grid), "");
    grid.put(3, 2, &cluster("e\u{301}"), 1);
    grid.put(4, 2, &cluster("o\u{308}"), 1);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[3;4He\u{301}\x1b[3;5Ho\u{308}");
    grid.put(3, 2, &Cell::new('y', Ink::Default, Ink::Default), 1);
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[3;4Hy", "what stands before a cluster is not");
}

/// In some terminals a wide cluster takes one cell: both are erased first.
#[test]
fn wide_clusters_are_written_on_blanks() {
    let mut encoder = Encoder::new();
    let mut grid = flat(&Cell::new('x', A, B));
    encoded(&mut encoder, &grid);
    grid.put(1, 0, &Cell { fg: A, bg: C, ..cluster("🇫🇷") }, 2);
    let colour = "\x1b[48;2;1;2;3m";
    assert_eq!(encoded(&mut encoder, &grid), format!("\x1b[1;2H{colour}  \x1b[1;2H🇫🇷"));
    grid.put(1, 1, &Cell { fg: A, bg: C, ..cluster("👨\u{200d}👩") }, 2);
    assert_eq!(
        encoded(&mut encoder, &grid),
        "\x1b[2;2H  \x1b[2;2H👨\u{200d}👩\x1b[2;4H\x1b[48;2;200;100;0mxx",
        "five columns where each character has its own"
    );
}

/// An underline's colour has a sequence of its own, with colons; without an underline none is sent.
#[test]
fn underlines_have_a_colour() {
    let mut encoder = Encoder::new();
    let underlined = |underline, attributes| Cell { underline, attributes, ..Cell::new('x', A, B) };
    let mut grid = flat(&underlined(Ink::Default, Attributes::UNDERLINED));
    encoded(&mut encoder, &grid);
    for (underline, attributes, expected) in [
        (A, Attributes::UNDERLINED, "\x1b[58:2::10:20:30mx"),
        (Ink::Indexed(7), Attributes::UNDERLINED, "\x1b[58:5:7mx"),
        (Ink::Default, Attributes::UNDERLINED, "\x1b[59mx"),
        (C, Attributes::UNDERLINED, "\x1b[58:2::1:2:3mx"),
        (C, Attributes::empty(), "\x1b[0;38;2;10;20;30;48;2;200;100;0mx"),
        (A, Attributes::empty(), ""),
        (A, Attributes::ITALIC | Attributes::UNDERLINED, "\x1b[3;4m\x1b[58:2::10:20:30mx"),
    ] {
        *grid.cell_mut(0, 0) = underlined(underline, attributes);
        let place = if expected.is_empty() { "" } else { "\x1b[H" };
        assert_eq!(encoded(&mut encoder, &grid), format!("{place}{expected}"), "{underline:?} {attributes:?}");
    }
}

/// After `forget` and after a resize all cells are sent, as for the first time. Nothing is ever
/// cleared.
#[test]
fn forgetting_draws_everything_again() {
    let grid = flat(&Cell::new('▄', A, B));
    let mut encoder = Encoder::new();
    let first = encoded(&mut encoder, &grid);
    assert_eq!(encoded(&mut encoder, &grid), "");
    encoder.forget();
    assert_eq!(encoded(&mut encoder, &grid), first);
    let mut small = Grid::new(Size::new(2, 1));
    small.cell_mut(0, 0).glyph = 'x'.into();
    assert_eq!(encoded(&mut encoder, &small), "\x1b[0m\x1b[Hx ");
    assert_eq!(encoded(&mut encoder, &grid), first);
}

/// Bytes are appended to the buffer, whose contents are sent first.
#[test]
fn bytes_are_appended() {
    let mut bytes = b"before".to_vec();
    Encoder::new().encode(&Grid::new(Size::new(1, 1)), &mut bytes);
    assert_eq!(bytes, b"before\x1b[0m\x1b[H ");
}

/// The largest screen and the furthest cell.
#[test]
fn positions_have_up_to_five_digits() {
    let mut encoder = Encoder::new();
    let mut grid = Grid::new(Size::new(65_535, 1));
    encoded(&mut encoder, &grid);
    grid.cell_mut(65_534, 0).glyph = 'x'.into();
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[1;65535Hx");
    let mut grid = Grid::new(Size::new(1, 65_535));
    encoded(&mut encoder, &grid);
    grid.cell_mut(0, 65_534).glyph = 'x'.into();
    assert_eq!(encoded(&mut encoder, &grid), "\x1b[65535Hx");
    for empty in [Size::new(0, 0), Size::new(0, 5), Size::new(5, 0)] {
        assert!(encoded(&mut encoder, &Grid::new(empty)).len() <= "\x1b[0m".len());
    }
}

const BRACKETS: [&str; 2] = ["\x1b[?2026h", "\x1b[?2026l"];

fn bracketed(frame: &str) -> String {
    let [begin, end] = BRACKETS;
    if frame.is_empty() { String::new() } else { format!("{begin}{frame}{end}") }
}

/// Brackets are around a frame that is not empty.
#[test]
fn synchronized_frames_are_bracketed() {
    let mut plain = Encoder::new();
    let mut synchronized = Encoder::new().with_synchronized_output(true);
    for cell in [Cell::BLANK, Cell::BLANK, Cell::new('▄', A, B)] {
        let grid = flat(&cell);
        assert_eq!(encoded(&mut synchronized, &grid), bracketed(&encoded(&mut plain, &grid)));
    }
    let mut bytes = b"before".to_vec();
    synchronized.encode(&flat(&Cell::BLANK), &mut bytes);
    assert!(bytes.starts_with(b"before\x1b[?2026h") && bytes.ends_with(b" \x1b[?2026l"));
}

/// Frames of any quality are bracketed; the brackets count against the limit of a frame.
#[test]
fn lossy_frames_are_bracketed_too() {
    let sent = |encoder: &mut Encoder, cell, quality, max_bytes, now| {
        let mut bytes = Vec::new();
        encoder.encode_within(&flat(cell), Allowance { quality, now: Duration::from_secs(now), max_bytes }, &mut bytes);
        String::from_utf8(bytes).expect("UTF-8")
    };
    let [light, dark] = [Cell::new('▄', A, B), Cell::new('▄', C, A)];
    for quality in [Quality::Exact, Quality::Equal, Quality::Fast] {
        let mut plain = Encoder::new();
        let mut synchronized = Encoder::new().with_synchronized_output(true);
        for (now, cell) in (0..).zip([&light, &light, &dark, &dark]) {
            let expected = sent(&mut plain, cell, quality, None, now);
            assert_eq!(sent(&mut synchronized, cell, quality, None, now), bracketed(&expected), "{quality:?}, {now}");
        }
        if quality != Quality::Exact {
            let most = 2 + BRACKETS.concat().len() + "\x1b[H\x1b[38;2;1;2;3;48;2;10;20;30m▄▄".len();
            let frame = sent(&mut synchronized, &light, quality, Some(most), 9);
            assert!(!frame.is_empty() && frame.len() <= most, "{} of {most} bytes", frame.len());
        }
    }
}

/// A terminal that knows synchronized output.
struct Synchronizing {
    terminal: alacritty_terminal::Term<VoidListener>,
    parser: ansi::Processor,
}

struct Lines(usize, usize);

impl Dimensions for Lines {
    fn total_lines(&self) -> usize {
        self.1
    }

    fn screen_lines(&self) -> usize {
        self.1
    }

    fn columns(&self) -> usize {
        self.0
    }
}

impl Synchronizing {
    fn new(size: Size) -> Self {
        let lines = Lines(size.columns.into(), size.rows.into());
        Self {
            terminal: alacritty_terminal::Term::new(Config::default(), &lines, VoidListener),
            parser: ansi::Processor::new(),
        }
    }

    /// Returns the cells that are shown after these bytes: glyphs and both colours.
    fn shows(&mut self, bytes: &[u8]) -> Vec<(char, ansi::Color, ansi::Color)> {
        self.parser.advance(&mut self.terminal, bytes);
        self.terminal.grid().display_iter().map(|cell| (cell.c, cell.fg, cell.bg)).collect()
    }
}

/// Wherever the bytes are cut, the screen shows the frame before or this one.
#[test]
fn a_synchronized_frame_is_never_shown_by_half() {
    let size = Size::new(9, 4);
    let mut encoder = Encoder::new().with_synchronized_output(true);
    let mut terminal = Synchronizing::new(size);
    for seed in 0..20_u8 {
        let mut grid = Grid::new(size);
        for at in 0..36_u8 {
            let color = |n: u8| rgb(n.wrapping_mul(37), at.wrapping_mul(seed), n);
            let glyph = if (at + seed).is_multiple_of(5) { 'x' } else { '▄' };
            *grid.cell_mut((at % 9).into(), (at / 9).into()) = Cell::new(glyph, color(seed), color(at));
        }
        let frame = encoded(&mut encoder, &grid);
        let before = terminal.shows(b"");
        let shown: Vec<_> = frame.bytes().map(|byte| terminal.shows(&[byte])).collect();
        let (after, halves) = shown.split_last().expect("a frame");
        assert!(*after != before, "frame {seed} is shown");
        assert!(halves.iter().all(|half| *half == before), "frame {seed} is shown by half");
    }
}

/// A writer that accepts this number of bytes, and then fails once.
struct Line(Vec<u8>, usize);

impl Write for Line {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.1 == 0 {
            self.1 = usize::MAX;
            return Err(io::Error::other("cut"));
        }
        let taken = bytes.len().min(self.1);
        self.0.extend_from_slice(&bytes[..taken]);
        self.1 -= taken;
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A writer gets the bytes that `encode` would append.
///
/// After a failed write it gets all of them again, because the state of the terminal is unknown.
#[test]
fn a_writer_gets_the_bytes_of_encode() {
    let grid = flat(&Cell::new('▄', A, B));
    let expected = encoded(&mut Encoder::new(), &grid);
    let mut encoder = Encoder::new();
    let mut line = Line(Vec::new(), 20);
    encoder.encode_to(&mut line, &grid).expect_err("the line is cut");
    assert_eq!(line.0, expected.as_bytes()[..20]);
    line.0.clear();
    for _ in 0..2 {
        encoder.encode_to(&mut line, &grid).expect("the line is whole again");
        assert_eq!(line.0, expected.as_bytes());
    }
}
