//! Panels of ratatui over the grid.

use super::rgb;
use super::screens::{Clusters, Screens};
use ratatui::buffer::{Buffer, CellDiffOption};
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use std::num::NonZeroU16;
use termtrace::internals::grid::Attributes;
use termtrace::{Cell, Encoder, Glyph, Grid, Ink, Size, lay_over};
use unicode_width::UnicodeWidthStr;

/// Returns a picture of one colour.
fn picture(size: Size) -> Grid {
    let mut grid = Grid::new(size);
    for row in 0..size.rows {
        for column in 0..size.columns {
            *grid.cell_mut(column, row) = Cell::new('▄', rgb(1, 1, 1), rgb(2, 2, 2));
        }
    }
    grid
}

/// Returns the cell that was there, or a blank if the area cuts its wide character.
fn uncut(before: &Grid, column: u16, row: u16, area: Rect) -> Cell {
    let is_covered = |column: &u16| before.cell(*column, row).glyph == Glyph::Covered;
    let start = (0..=column).rev().find(|column| !is_covered(column)).unwrap_or(0);
    let end = (column + 1..before.size().columns).find(|column| !is_covered(column)).unwrap_or(before.size().columns);
    let cell = before.cell(column, row).clone();
    let is_cut = (start..end).any(|column| area.contains((column, row).into()));
    if is_cut { Cell { glyph: Glyph::Char(' '), ..cell } } else { cell }
}

/// Asserts that the grid is the buffer inside its area, and unchanged outside.
#[track_caller]
pub(crate) fn assert_lies_over(grid: &Grid, before: &Grid, buffer: &Buffer) {
    let columns = grid.size().columns;
    for row in 0..grid.size().rows {
        let mut column = 0;
        while column < columns {
            let found = grid.cell(column, row);
            if !buffer.area.contains((column, row).into()) {
                assert_eq!(found, uncut(before, column, row, buffer.area), "beside the panel, ({column}, {row})");
                column += 1;
                continue;
            }
            let wanted = &buffer[(column, row)];
            let width = wanted.symbol().width() as u16;
            let fits = column + width <= columns;
            let text = if fits { wanted.symbol() } else { " " };
            assert_eq!(found.glyph.to_string(), text, "({column}, {row})");
            assert_eq!((found.fg, found.bg), (ink(wanted.fg), ink(wanted.bg)), "({column}, {row})");
            assert_eq!(found.underline, ink(wanted.underline_color), "({column}, {row})");
            assert_eq!(found.attributes, Attributes::from_bits_truncate(wanted.modifier.bits()), "({column}, {row})");
            if width == 2 && fits {
                let second = Cell { glyph: Glyph::Covered, ..found.clone() };
                assert_eq!(grid.cell(column + 1, row), second, "({column}, {row})");
            }
            column += width;
        }
    }
}

/// Returns a named colour by its number in ECMA-48.
///
/// Black, red, green, yellow, blue, magenta, cyan, white; then the bright ones.
fn ink(color: Color) -> Ink {
    const NAMED: [Color; 16] = [
        Color::Black,
        Color::Red,
        Color::Green,
        Color::Yellow,
        Color::Blue,
        Color::Magenta,
        Color::Cyan,
        Color::Gray,
        Color::DarkGray,
        Color::LightRed,
        Color::LightGreen,
        Color::LightYellow,
        Color::LightBlue,
        Color::LightMagenta,
        Color::LightCyan,
        Color::White,
    ];
    match color {
        Color::Reset => Ink::Default,
        Color::Rgb(r, g, b) => rgb(r, g, b),
        Color::Indexed(index) => Ink::Indexed(index),
        named => Ink::Indexed(NAMED.iter().position(|&color| color == named).expect("16 have names") as u8),
    }
}

fn line(text: &str, style: Style) -> Buffer {
    let mut buffer = Buffer::empty(Rect::new(1, 1, text.width() as u16, 1));
    buffer.set_string(1, 1, text, style);
    buffer
}

/// Asserts that all terminals show a grid.
#[track_caller]
fn assert_shown(grid: &Grid, clusters: Clusters) {
    let mut bytes = Vec::new();
    Encoder::new().encode(grid, &mut bytes);
    let mut screens = Screens::disturbed(grid.size(), clusters);
    screens.feed(&bytes);
    screens.assert_show(grid);
}

#[test]
fn a_line_of_text_over_a_picture() {
    let size = Size::new(6, 3);
    let mut grid = picture(size);
    let style =
        Style::new().fg(Color::Red).bg(Color::Rgb(9, 8, 7)).underline_color(Color::Indexed(99)).bold().underlined();
    lay_over(&mut grid, &line("a世b", style));
    let text = |glyph| Cell {
        glyph,
        fg: Ink::Indexed(1),
        bg: rgb(9, 8, 7),
        underline: Ink::Indexed(99),
        attributes: Attributes::BOLD | Attributes::UNDERLINED,
    };
    let beside = picture(size).cell(0, 0).clone();
    let row = [text('a'.into()), text('世'.into()), text(Glyph::Covered), text('b'.into())];
    assert!(grid.row_from(1, 1).take(4).eq(row));
    assert_eq!([grid.cell(0, 1), grid.cell(5, 1)], [beside.clone(), beside]);
    assert_lies_over(&grid, &picture(size), &line("a世b", style));
    assert_shown(&grid, Clusters::None);
}

#[test]
fn all_named_colours() {
    let named = [Color::Black, Color::Green, Color::Yellow, Color::Blue, Color::Magenta, Color::Cyan, Color::Gray];
    let bright = [Color::DarkGray, Color::LightRed, Color::LightGreen, Color::LightYellow, Color::LightBlue];
    let brighter = [Color::LightMagenta, Color::LightCyan, Color::White, Color::Red, Color::Reset];
    for color in named.into_iter().chain(bright).chain(brighter) {
        let mut grid = picture(Size::new(4, 3));
        let buffer = line("x", Style::new().fg(color).bg(color));
        lay_over(&mut grid, &buffer);
        assert_lies_over(&grid, &picture(Size::new(4, 3)), &buffer);
    }
}

/// A wide character half over the edge is a space; a panel outside has no effect.
#[test]
fn text_is_cut_at_the_edge() {
    let size = Size::new(3, 2);
    let mut grid = picture(size);
    lay_over(&mut grid, &line("a世b", Style::new()));
    assert_eq!([1, 2].map(|column| grid.cell(column, 1).glyph.to_string()), ["a", " "]);
    assert_shown(&grid, Clusters::None);
    let mut grid = picture(Size::new(1, 1));
    lay_over(&mut grid, &line("far away", Style::new()));
    assert_eq!(grid, picture(Size::new(1, 1)));
    lay_over(&mut grid, &Buffer::empty(Rect::ZERO));
    assert_eq!(grid, picture(Size::new(1, 1)));
}

/// A character keeps its marks, and a family its members, in as many cells as in ratatui.
#[test]
fn clusters_are_kept_whole() {
    for (symbol, clusters) in [
        ("e\u{301}", Clusters::Marks),
        ("世\u{301}", Clusters::Marks),
        ("❤\u{fe0f}", Clusters::Marks),
        ("1\u{fe0f}\u{20e3}", Clusters::Joined),
        ("👨\u{200d}👩\u{200d}👧", Clusters::Joined),
        ("🇫🇷", Clusters::Joined),
    ] {
        let mut grid = picture(Size::new(6, 3));
        let buffer = line(&format!("{symbol}x"), Style::new());
        lay_over(&mut grid, &buffer);
        assert_lies_over(&grid, &picture(Size::new(6, 3)), &buffer);
        assert_eq!(grid.cell(1, 1).glyph, Glyph::Cluster(symbol.into()));
        assert_shown(&grid, clusters);
    }
}

/// All cells behind a cluster are right in a terminal that splits it.
#[test]
fn split_clusters_disturb_no_cell() {
    for symbol in ["e\u{301}", "👨\u{200d}👩\u{200d}👧", "🇫🇷", "👍🏽"] {
        let mut grid = picture(Size::new(12, 3));
        let mut screens = Screens::disturbed(grid.size(), Clusters::None);
        let mut encoder = Encoder::new();
        for text in ["", symbol] {
            lay_over(&mut grid, &line(text, Style::new()));
            let mut bytes = Vec::new();
            encoder.encode(&grid, &mut bytes);
            screens.feed(&bytes);
        }
        // The model keeps the cluster; of the others only what is not its own is asked.
        let shown = screens.emulated();
        let own = 1..1 + symbol.width() as u16;
        for (column, row) in (0..3).flat_map(|row| (0..12).map(move |column| (column, row))) {
            if row != 1 || !own.contains(&column) {
                let wanted = grid.cell(column, row);
                assert_eq!(shown(column, row), [wanted.clone(), wanted.clone()], "{symbol}, ({column}, {row})");
            }
        }
    }
}

/// A skipped cell is left alone, and a cell that claims more columns than its text takes them.
#[test]
#[expect(deprecated, reason = "the older one of the two ways to skip a cell still counts")]
fn ratatuis_options_are_respected() {
    let mut buffer = line("abcdef", Style::new());
    buffer[(2, 1)].set_diff_option(CellDiffOption::Skip);
    buffer[(3, 1)].set_skip(true);
    buffer[(4, 1)].set_diff_option(CellDiffOption::ForcedWidth(NonZeroU16::new(2).expect("not 0")));
    let mut grid = picture(Size::new(8, 3));
    lay_over(&mut grid, &buffer);
    let texts: Vec<_> = grid.row_from(0, 1).map(|cell| cell.glyph.to_string()).collect();
    assert_eq!(texts, ["▄", "a", "▄", "▄", "d", "", "f", "▄"]);
    assert_eq!(grid.cell(5, 1).glyph, Glyph::Covered);
}

/// A control character is a blank.
#[test]
fn control_characters_are_blanks() {
    for symbol in ["\n", "\x1b[2J", "a\u{7}", "\u{9b}2J"] {
        let mut buffer = line("abc", Style::new());
        buffer[(2, 1)].set_symbol(symbol);
        let mut grid = picture(Size::new(6, 3));
        lay_over(&mut grid, &buffer);
        assert_eq!([1, 2, 3].map(|column| grid.cell(column, 1).glyph.to_string()), ["a", " ", "c"], "{symbol:?}");
        assert_shown(&grid, Clusters::None);
    }
}

/// A symbol that takes no cell at all is a blank.
#[test]
fn a_character_without_width_is_a_blank() {
    for symbol in ["\u{200b}", "\u{301}", ""] {
        let mut buffer = line("abc", Style::new());
        buffer[(2, 1)].set_symbol(symbol);
        let mut grid = picture(Size::new(6, 3));
        lay_over(&mut grid, &buffer);
        assert_eq!([1, 2, 3].map(|column| grid.cell(column, 1).glyph.to_string()), ["a", " ", "c"], "{symbol:?}");
        assert_shown(&grid, Clusters::None);
    }
}

/// A panel may cut the wide characters of another: the remaining halves are blanks.
#[test]
fn a_panel_over_half_of_a_wide_character() {
    for column in 1..6 {
        let mut grid = picture(Size::new(8, 3));
        lay_over(&mut grid, &line("世界世", Style::new()));
        let mut buffer = Buffer::empty(Rect::new(column, 1, 1, 1));
        buffer.set_string(column, 1, "x", Style::new());
        lay_over(&mut grid, &buffer);
        assert_shown(&grid, Clusters::None);
    }
}
