//! What terminals show after some bytes: two emulators of other hands, and a strict model that refuses what the encoder
//! has no business to send.
//!
//! Where an emulator does not keep what was sent, it is not asked, and the model alone is the judge:
//! - `vt100` knows neither blinking nor hidden nor crossed-out text, and no colour of a wide character's second half;
//! - `avt` does not know hidden text, nor two speeds of blinking;
//! - both take bold and dim for two ends of one scale, of which the last said counts.

use ratatui::style::Modifier;
use std::num::NonZeroU16;
use termtrace::color::Srgb8;
use termtrace::grid::{Cell, Grid, Ink, Size};
use unicode_width::UnicodeWidthChar;

const AVT_KNOWS: Modifier = Modifier::BOLD
    .union(Modifier::DIM)
    .union(Modifier::ITALIC)
    .union(Modifier::UNDERLINED)
    .union(Modifier::SLOW_BLINK)
    .union(Modifier::REVERSED)
    .union(Modifier::CROSSED_OUT);

const VT100_KNOWS: Modifier = AVT_KNOWS.difference(Modifier::SLOW_BLINK).difference(Modifier::CROSSED_OUT);

/// Three terminals on one line.
pub(crate) struct Screens {
    avt: avt::Terminal,
    vt100: vt100::Parser,
    model: Model,
    parser: vte::Parser,
}

fn side(length: u16) -> NonZeroU16 {
    NonZeroU16::new(length).expect("a screen has cells")
}

impl Screens {
    /// Full of what another program has left behind, its colours still on and its cursor anywhere.
    pub(crate) fn disturbed(size: Size) -> Self {
        let Size { columns, rows } = size;
        let mut screens = Self {
            avt: avt::Terminal::new(columns.into(), rows.into()).expect("a screen has cells"),
            vt100: vt100::Parser::new(side(rows), side(columns), 0),
            model: Model::new(size),
            parser: vte::Parser::new(),
        };
        let line = |row: u16| format!("\x1b[{};1H\x1b[1;4;31;42m{}", row + 1, "?".repeat(columns.into()));
        let rubbish: String = (0..rows).map(line).collect();
        screens.feed(format!("{rubbish}\x1b[1;1H").as_bytes());
        screens
    }

    /// As a window does it: what stands where in one of another size is the terminal's affair.
    pub(crate) fn resize(&mut self, size: Size) {
        if size == self.model.size {
            return;
        }
        self.avt.resize(size.columns.into(), size.rows.into());
        self.vt100.screen_mut().set_size(side(size.rows), side(size.columns));
        let pen = self.model.pen;
        self.model = Model { pen, ..Model::new(size) };
    }

    /// Shows one frame's bytes, which are whole characters and whole sequences.
    #[track_caller]
    pub(crate) fn feed(&mut self, bytes: &[u8]) {
        let text = std::str::from_utf8(bytes).expect("a frame ends in no character's middle");
        if let Some((_, last)) = text.rsplit_once('\x1b') {
            assert!(last.contains(|c: char| c.is_ascii_alphabetic()), "a frame ends in a sequence's middle: {last:?}");
        }
        // Since the last frame something else may have moved the cursor.
        self.model.cursor = None;
        self.avt.feed(text);
        self.vt100.process(bytes);
        self.parser.advance(&mut self.model, bytes);
    }

    /// Each of them shows exactly this grid.
    #[track_caller]
    pub(crate) fn assert_show(&self, grid: &Grid) {
        self.assert_show_as(grid, |cell| cell);
    }

    /// Each of them shows this grid in the same colours, half cell by half cell: with whichever half they were written.
    #[track_caller]
    pub(crate) fn assert_show_halves(&self, grid: &Grid) {
        self.assert_show_as(grid, lower_half);
    }

    #[track_caller]
    fn assert_show_as(&self, grid: &Grid, look: fn(Cell) -> Cell) {
        for row in 0..grid.size().rows {
            for column in 0..grid.size().columns {
                let wanted = seen_of(*grid.cell(column, row));
                let place = format!("column {column}, row {row}");
                assert_eq!(look(self.model.cells[self.model.index(column, row)]), look(wanted), "the model, {place}");
                assert_eq!(look(self.seen_by_avt(column, row)), look(wanted.as_known(AVT_KNOWS)), "avt, {place}");
                let mut by_vt100 = wanted.as_known(VT100_KNOWS);
                let seen = self.seen_by_vt100(column, row);
                if seen.glyph == Cell::COVERED {
                    by_vt100 = Cell { glyph: by_vt100.glyph, ..seen };
                }
                assert_eq!(look(seen), look(by_vt100), "vt100, {place}");
            }
        }
    }

    fn seen_by_avt(&self, column: u16, row: u16) -> Cell {
        let line = self.avt.screen().line(row.into()).expect("the row is on the screen");
        let cell = line.cells()[usize::from(column)];
        let ink = |color: Option<avt::Color>| match color {
            None => Ink::Default,
            Some(avt::Color::Indexed(index)) => Ink::Indexed(index),
            Some(avt::Color::RGB(c)) => Ink::Rgb(Srgb8::new(c.r, c.g, c.b)),
        };
        let pen = cell.pen();
        let modifier = modifier_of([
            (pen.is_bold(), Modifier::BOLD),
            (pen.is_faint(), Modifier::DIM),
            (pen.is_italic(), Modifier::ITALIC),
            (pen.is_underline(), Modifier::UNDERLINED),
            (pen.is_blink(), Modifier::SLOW_BLINK),
            (pen.is_inverse(), Modifier::REVERSED),
            (pen.is_strikethrough(), Modifier::CROSSED_OUT),
        ]);
        let glyph = if cell.width() == 0 { Cell::COVERED } else { cell.char() };
        seen_of(Cell { glyph, fg: ink(pen.foreground()), bg: ink(pen.background()), modifier })
    }

    fn seen_by_vt100(&self, column: u16, row: u16) -> Cell {
        let cell = self.vt100.screen().cell(row, column).expect("the cell is on the screen");
        let ink = |color: vt100::Color| match color {
            vt100::Color::Default => Ink::Default,
            vt100::Color::Idx(index) => Ink::Indexed(index),
            vt100::Color::Rgb(r, g, b) => Ink::Rgb(Srgb8::new(r, g, b)),
        };
        let modifier = modifier_of([
            (cell.bold(), Modifier::BOLD),
            (cell.dim(), Modifier::DIM),
            (cell.italic(), Modifier::ITALIC),
            (cell.underline(), Modifier::UNDERLINED),
            (cell.inverse(), Modifier::REVERSED),
        ]);
        let mut characters = cell.contents().chars();
        let glyph = if cell.is_wide_continuation() { Cell::COVERED } else { characters.next().unwrap_or('?') };
        assert_eq!(characters.next(), None, "one character in a cell");
        seen_of(Cell { glyph, fg: ink(cell.fgcolor()), bg: ink(cell.bgcolor()), modifier })
    }
}

fn modifier_of<const N: usize>(flags: [(bool, Modifier); N]) -> Modifier {
    flags.into_iter().filter_map(|(is_on, flag)| is_on.then_some(flag)).collect()
}

/// What can be seen of a cell: a plain space has no colour of its own.
fn seen_of(cell: Cell) -> Cell {
    let unseen = cell.glyph == ' ' && cell.modifier.is_empty();
    Cell { fg: if unseen { Ink::Default } else { cell.fg }, ..cell }
}

/// A cell of two colours as its lower half on its upper one's colour. The terminal's own colours stay where they are:
/// that of characters is not that behind them.
fn lower_half(cell: Cell) -> Cell {
    if !cell.modifier.is_empty() || cell.bg == Ink::Default {
        return cell;
    }
    match cell.glyph {
        '▀' if cell.fg != Ink::Default => Cell::new('▄', cell.bg, cell.fg),
        ' ' => Cell::new('▄', cell.bg, cell.bg),
        _ => cell,
    }
}

trait Known {
    /// The cell as a terminal keeps it that knows these modifiers, and bold and dim as one scale.
    fn as_known(&self, known: Modifier) -> Cell;
}

impl Known for Cell {
    fn as_known(&self, known: Modifier) -> Cell {
        let mut modifier = self.modifier & known;
        // The encoder says dim after bold.
        if modifier.contains(Modifier::DIM) {
            modifier.remove(Modifier::BOLD);
        }
        // Rapid blinking is blinking, or nothing: either way the model has looked at it.
        seen_of(Cell { modifier, ..*self })
    }
}

/// A terminal in raw mode that knows CUP, CUF, CHA, CR, BS, LF, SGR and characters. At anything else it panics: erasing,
/// scrolling, going over an edge, going anywhere from beyond the last column (where terminals disagree), other control
/// characters. What the encoder learns to say, this has to learn to read.
struct Model {
    size: Size,
    cells: Vec<Cell>,
    pen: Cell,
    /// Where the next character goes; none until something says so. Beyond the last column only CUP is allowed.
    cursor: Option<(u16, u16)>,
}

impl Model {
    fn new(size: Size) -> Self {
        let cells = vec![Cell { glyph: '?', ..Cell::BLANK }; size.cell_count()];
        Self { size, cells, pen: Cell::BLANK, cursor: None }
    }

    fn index(&self, column: u16, row: u16) -> usize {
        usize::from(row) * usize::from(self.size.columns) + usize::from(column)
    }

    /// Where half of a wide character goes, the other half is a blank.
    fn break_up(&mut self, column: u16, row: u16) {
        let at = self.index(column, row);
        if self.cells[at].glyph == Cell::COVERED {
            self.cells[at - 1].glyph = ' ';
        }
        if column + 1 < self.size.columns && self.cells[at + 1].glyph == Cell::COVERED {
            self.cells[at + 1].glyph = ' ';
        }
    }

    /// The cursor, where it is sure to be on the screen.
    fn cursor(&self) -> (u16, u16) {
        let (column, row) = self.cursor.expect("the place is said before a relative move");
        assert!(column < self.size.columns, "beyond the last column, in row {row}, the cursor may be anywhere");
        (column, row)
    }

    fn place(&mut self, column: u16, row: u16) {
        assert!(column < self.size.columns && row < self.size.rows, "({column}, {row}) is not on the screen");
        self.cursor = Some((column, row));
    }

    /// One SGR sequence.
    fn select(&mut self, numbers: &[u16]) {
        let byte = |number: u16| u8::try_from(number).expect("a colour's number is a byte");
        let rest = match *numbers {
            [] => return,
            [0, ref rest @ ..] => {
                self.pen = Cell::BLANK;
                rest
            }
            [code @ 1..=9, ref rest @ ..] => {
                self.pen.modifier.insert(Modifier::from_bits_truncate(1 << (code - 1)));
                rest
            }
            [code @ (30..=37 | 39), ref rest @ ..] => {
                self.pen.fg = if code == 39 { Ink::Default } else { Ink::Indexed(byte(code - 30)) };
                rest
            }
            [code @ (40..=47 | 49), ref rest @ ..] => {
                self.pen.bg = if code == 49 { Ink::Default } else { Ink::Indexed(byte(code - 40)) };
                rest
            }
            [code @ (38 | 48), 5, index, ref rest @ ..] => {
                *self.ink(code) = Ink::Indexed(byte(index));
                rest
            }
            [code @ (38 | 48), 2, r, g, b, ref rest @ ..] => {
                *self.ink(code) = Ink::Rgb(Srgb8::new(byte(r), byte(g), byte(b)));
                rest
            }
            _ => panic!("SGR {numbers:?}"),
        };
        self.select(rest);
    }

    fn ink(&mut self, code: u16) -> &mut Ink {
        if code == 38 { &mut self.pen.fg } else { &mut self.pen.bg }
    }
}

impl vte::Perform for Model {
    fn print(&mut self, c: char) {
        let (column, row) = self.cursor.expect("the place is said before a character");
        let width = c.width().unwrap_or(0) as u16;
        assert!(width > 0, "{c:?} takes no cell");
        assert!(column + width <= self.size.columns, "{c:?} at column {column} goes over the edge");
        for column in column..column + width {
            self.break_up(column, row);
        }
        let at = self.index(column, row);
        self.cells[at] = seen_of(Cell { glyph: c, ..self.pen });
        if width == 2 {
            self.cells[at + 1] = Cell { glyph: Cell::COVERED, ..self.pen };
        }
        self.cursor = Some((column + width, row));
    }

    fn csi_dispatch(&mut self, params: &vte::Params, intermediates: &[u8], ignore: bool, action: char) {
        let numbers: Vec<u16> = params.iter().flatten().copied().collect();
        assert!(intermediates.is_empty() && !ignore, "{intermediates:?} {numbers:?} {action:?}");
        match (action, &numbers[..]) {
            ('m', numbers) => self.select(numbers),
            // A number that is not said is read as 0, which means 1.
            ('H', &[row]) => self.place(0, row.max(1) - 1),
            ('H', &[row, column]) => self.place(column.checked_sub(1).expect("from 1"), row.max(1) - 1),
            ('C', &[columns]) => {
                let (column, row) = self.cursor();
                self.place(column + columns.max(1), row);
            }
            ('G', &[number]) => {
                let (_, row) = self.cursor();
                self.place(number.max(1) - 1, row);
            }
            other => panic!("not of the safe core: {other:?}"),
        }
    }

    fn execute(&mut self, byte: u8) {
        let (column, row) = self.cursor();
        match byte {
            b'\r' => self.place(0, row),
            b'\n' => self.place(column, row + 1),
            b'\x08' => self.place(column.checked_sub(1).expect("not left of the first column"), row),
            _ => panic!("control character {byte:#04x}"),
        }
    }

    fn esc_dispatch(&mut self, _: &[u8], _: bool, byte: u8) {
        panic!("ESC {:?}", char::from(byte));
    }

    fn osc_dispatch(&mut self, _: &[&[u8]], _: bool) {
        panic!("an operating system command");
    }

    fn hook(&mut self, _: &vte::Params, _: &[u8], _: bool, _: char) {
        panic!("a device control string");
    }
}
