//! Panels of ratatui over the grid.

use super::rgb;
use super::screens::Screens;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use termtrace::encode::Encoder;
use termtrace::grid::{Cell, Grid, Ink, Size};
use termtrace::overlay::lay_over;
use unicode_width::UnicodeWidthStr;

/// A picture of one colour.
fn picture(size: Size) -> Grid {
    let mut grid = Grid::new(size);
    for row in 0..size.rows {
        for column in 0..size.columns {
            *grid.cell_mut(column, row) = Cell::new('▄', rgb(1, 1, 1), rgb(2, 2, 2));
        }
    }
    grid
}

/// Inside the buffer's area the grid is the buffer, outside it is what it was.
#[track_caller]
pub(crate) fn assert_lies_over(grid: &Grid, before: &Grid, buffer: &Buffer) {
    let columns = grid.size().columns;
    for row in 0..grid.size().rows {
        let mut column = 0;
        while column < columns {
            let found = grid.cell(column, row);
            if !buffer.area.contains((column, row).into()) {
                assert_eq!(found, before.cell(column, row), "beside the panel, ({column}, {row})");
                column += 1;
                continue;
            }
            let wanted = &buffer[(column, row)];
            let width = wanted.symbol().width() as u16;
            let fits = column + width <= columns;
            let glyph = if fits { wanted.symbol().chars().next() } else { Some(' ') };
            assert_eq!(Some(found.glyph), glyph, "({column}, {row})");
            assert_eq!((found.fg, found.bg), (ink(wanted.fg), ink(wanted.bg)), "({column}, {row})");
            assert_eq!(found.modifier, wanted.modifier, "({column}, {row})");
            if width == 2 && fits {
                assert_eq!(*grid.cell(column + 1, row), Cell { glyph: Cell::COVERED, ..*found }, "({column}, {row})");
            }
            column += width;
        }
    }
}

/// The named colours by ECMA-48's numbers: black, red, green, yellow, blue, magenta, cyan, white; then the bright ones.
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

/// What the terminals show of a grid; they agree.
#[track_caller]
fn assert_shown(grid: &Grid) {
    let mut bytes = Vec::new();
    Encoder::new().encode(grid, &mut bytes);
    let mut screens = Screens::disturbed(grid.size());
    screens.feed(&bytes);
    screens.assert_show(grid);
}

#[test]
fn a_line_of_text_over_a_picture() {
    let size = Size::new(6, 3);
    let mut grid = picture(size);
    let style = Style::new().fg(Color::Red).bg(Color::Rgb(9, 8, 7)).add_modifier(Modifier::BOLD);
    lay_over(&mut grid, &line("a世b", style));
    let text = |glyph| Cell { glyph, fg: Ink::Indexed(1), bg: rgb(9, 8, 7), modifier: Modifier::BOLD };
    let beside = *picture(size).cell(0, 0);
    let row: Vec<_> = (0..6).map(|column| *grid.cell(column, 1)).collect();
    assert_eq!(row, [beside, text('a'), text('世'), text(Cell::COVERED), text('b'), beside]);
    assert_lies_over(&grid, &picture(size), &line("a世b", style));
    assert_shown(&grid);
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

/// A wide character half over the edge is a space; a panel outside is nothing.
#[test]
fn what_goes_over_the_edge_is_cut() {
    let size = Size::new(3, 2);
    let mut grid = picture(size);
    lay_over(&mut grid, &line("a世b", Style::new()));
    assert_eq!([grid.cell(1, 1).glyph, grid.cell(2, 1).glyph], ['a', ' ']);
    assert_shown(&grid);
    let mut grid = picture(Size::new(1, 1));
    lay_over(&mut grid, &line("far away", Style::new()));
    assert_eq!(grid, picture(Size::new(1, 1)));
    lay_over(&mut grid, &Buffer::empty(Rect::ZERO));
    assert_eq!(grid, picture(Size::new(1, 1)));
}

/// Of a character with combining marks the grid keeps the character.
#[test]
fn combining_marks_are_left_out() {
    let mut grid = picture(Size::new(6, 3));
    lay_over(&mut grid, &line("e\u{301}x", Style::new()));
    assert_eq!([1, 2, 3].map(|column| grid.cell(column, 1).glyph), ['e', 'x', '▄']);
    assert_shown(&grid);
}

/// What takes two cells only by what stands after it is cut to its first character, which takes one: the next column
/// is a blank of the panel, and all that follows stands where it should.
#[test]
fn a_character_made_wide_by_its_companions_is_one_cell() {
    for symbol in ["❤\u{fe0f}", "1\u{fe0f}\u{20e3}", "🇫🇷"] {
        let mut grid = picture(Size::new(6, 3));
        lay_over(&mut grid, &line(&format!("{symbol}x"), Style::new()));
        assert_eq!(grid.cell(3, 1).glyph, 'x', "{symbol}");
        assert_shown(&grid);
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
        assert_eq!([1, 2, 3].map(|column| grid.cell(column, 1).glyph), ['a', ' ', 'c'], "{symbol:?}");
        assert_shown(&grid);
    }
}

/// Two panels, of which the second cuts the first one's wide characters: their other halves are blanks.
#[test]
fn a_panel_over_half_of_a_wide_character() {
    for column in 1..6 {
        let mut grid = picture(Size::new(8, 3));
        lay_over(&mut grid, &line("世界世", Style::new()));
        let mut buffer = Buffer::empty(Rect::new(column, 1, 1, 1));
        buffer.set_string(column, 1, "x", Style::new());
        lay_over(&mut grid, &buffer);
        assert_shown(&grid);
    }
}
