//! The screen of a terminal after some bytes, by two emulators that are not ours.

use std::num::NonZeroU16;

/// A colour of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Colour {
    /// The terminal's default colour.
    Default,
    /// One of the 256 indexed colours.
    Indexed(u8),
    /// Red, green and blue.
    Rgb(u8, u8, u8),
}

impl From<Option<avt::Color>> for Colour {
    fn from(color: Option<avt::Color>) -> Self {
        match color {
            None => Self::Default,
            Some(avt::Color::Indexed(index)) => Self::Indexed(index),
            Some(avt::Color::RGB(rgb)) => Self::Rgb(rgb.r, rgb.g, rgb.b),
        }
    }
}

/// A cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    /// The character.
    pub(crate) glyph: char,
    /// The colour of the character.
    pub(crate) foreground: Colour,
    /// The colour behind the character.
    pub(crate) background: Colour,
}

/// A screen of `avt`, and one of `vt100` for a second opinion.
pub(crate) struct Screen {
    terminal: avt::Terminal,
    second: vt100::Parser,
    /// The beginning of a character whose other bytes have not come: `avt` takes characters.
    partial: Vec<u8>,
}

impl Screen {
    /// An empty screen of at least one cell.
    pub(crate) fn new(columns: u16, rows: u16) -> Self {
        let (columns, rows) = (columns.max(1), rows.max(1));
        Self {
            terminal: avt::Terminal::new(columns.into(), rows.into()).expect("neither is zero"),
            second: vt100::Parser::new(at_least_one(rows), at_least_one(columns), 0),
            partial: Vec::new(),
        }
    }

    /// Shows these bytes.
    pub(crate) fn feed(&mut self, bytes: &[u8]) {
        self.second.process(bytes);
        self.partial.extend_from_slice(bytes);
        let whole = whole_characters(&self.partial);
        self.terminal.feed(String::from_utf8_lossy(&self.partial[..whole]).as_ref());
        self.partial.drain(..whole);
    }

    /// Resizes the screen.
    pub(crate) fn resize(&mut self, columns: u16, rows: u16) {
        self.terminal.resize(columns.into(), rows.into());
        self.second.set_size(at_least_one(rows), at_least_one(columns));
    }

    /// Returns the lines, from the top, without the blanks at their ends.
    pub(crate) fn text(&self) -> Vec<String> {
        let lines = self.terminal.screen().visible_lines();
        lines.map(|line| line.text().trim_end().to_owned()).collect()
    }

    /// Returns the cell in this column and row, both from 0.
    pub(crate) fn cell(&self, column: usize, row: usize) -> Cell {
        let line = self.terminal.screen().line(row).expect("the row is on the screen");
        let cell = &line.cells()[column];
        let pen = cell.pen();
        let (fg, bg) = (pen.foreground().into(), pen.background().into());
        let (foreground, background) = if pen.is_inverse() { (bg, fg) } else { (fg, bg) };
        Cell { glyph: cell.char(), foreground, background }
    }

    /// Returns the column and row of the cursor, both from 0, if it is shown.
    pub(crate) fn cursor(&self) -> Option<(usize, usize)> {
        self.terminal.cursor().position()
    }

    /// Returns whether the alternate screen is shown.
    pub(crate) fn is_alternate(&self) -> bool {
        self.second.screen().alternate_screen()
    }

    /// Returns the second emulator's screen.
    pub(crate) fn second_opinion(&self) -> &vt100::Screen {
        self.second.screen()
    }
}

fn at_least_one(count: u16) -> NonZeroU16 {
    NonZeroU16::new(count).unwrap_or(NonZeroU16::MIN)
}

/// Returns the number of bytes before a character that is cut off at the end.
fn whole_characters(bytes: &[u8]) -> usize {
    let tail = bytes.len().saturating_sub(3);
    let start = bytes[tail..].iter().rposition(|&byte| byte >= 0xc0).map(|at| tail + at);
    match start {
        Some(start) => match std::str::from_utf8(&bytes[start..]) {
            Err(error) if error.error_len().is_none() => start,
            _ => bytes.len(),
        },
        None => bytes.len(),
    }
}

/// Returns the text of these bytes without SGR sequences.
///
/// An error message may have no other sequences.
pub(crate) fn without_colors(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let mut parts = text.split("\x1b[");
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once('m') {
            Some((codes, rest)) if codes.bytes().all(|code| code.is_ascii_digit() || code == b';') => plain += rest,
            _ => plain = plain + "\x1b[" + part,
        }
    }
    plain
}
