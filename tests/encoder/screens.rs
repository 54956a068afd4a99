//! Screens of terminals: three emulators that are not ours, and a strict model that refuses other
//! bytes.
//!
//! Where an emulator does not keep what was sent, it is not asked, and the model alone is the judge:
//! - `vt100` knows neither blinking nor hidden nor crossed-out text, and no colour of a wide character's second half;
//! - `avt` does not know hidden text, nor two speeds of blinking;
//! - both take bold and dim for two ends of one scale, of which the last said counts;
//! - neither knows the colour of an underline;
//! - `alacritty_terminal` does not know blinking text, and it alone executes synchronized output;
//! - `vt100` keeps marks with their letter, but not a family or a flag in one place; `avt` gives every mark a cell.

use alacritty_terminal::event::VoidListener;
use alacritty_terminal::grid::Dimensions;
use alacritty_terminal::index::{Column, Line};
use alacritty_terminal::term::Config;
use alacritty_terminal::term::cell::Flags;
use alacritty_terminal::vte::ansi;
use std::num::NonZeroU16;
use termtrace::internals::grid::Attributes;
use termtrace::{Cell, Glyph, Grid, Ink, Size, Srgb8};
use unicode_segmentation::UnicodeSegmentation;
use unicode_width::UnicodeWidthStr;

const AVT_KNOWS: Attributes = Attributes::BOLD
    .union(Attributes::DIM)
    .union(Attributes::ITALIC)
    .union(Attributes::UNDERLINED)
    .union(Attributes::SLOW_BLINK)
    .union(Attributes::REVERSED)
    .union(Attributes::CROSSED_OUT);

const VT100_KNOWS: Attributes = AVT_KNOWS.difference(Attributes::SLOW_BLINK).difference(Attributes::CROSSED_OUT);

const ALACRITTY_KNOWS: Attributes = Attributes::BOLD
    .union(Attributes::DIM)
    .union(Attributes::ITALIC)
    .union(Attributes::UNDERLINED)
    .union(Attributes::REVERSED)
    .union(Attributes::HIDDEN)
    .union(Attributes::CROSSED_OUT);

/// The clusters of a frame, by the emulators that keep them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clusters {
    None,
    /// A letter with its marks.
    Marks,
    /// Characters that each have a cell of their own elsewhere.
    Joined,
}

/// The mark of a synchronized update that is lost on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Loss {
    Begin,
    /// The end: the terminal shows the frame after a while.
    End,
    /// The end, and the terminal waits until the next frame ends.
    EndUntilNextFrame,
}

/// Four terminals on one line, those of them that are asked.
pub(crate) struct Screens {
    avt: Option<avt::Terminal>,
    vt100: Option<vt100::Parser>,
    alacritty: Option<Alacritty>,
    /// Whether a terminal holds back a synchronized update whose end was lost.
    is_held: bool,
    model: Model,
    parser: vte::Parser,
}

/// An emulator that executes synchronized output.
struct Alacritty {
    terminal: alacritty_terminal::Term<VoidListener>,
    parser: ansi::Processor,
}

impl Dimensions for Lines {
    fn total_lines(&self) -> usize {
        self.0.rows.into()
    }

    fn screen_lines(&self) -> usize {
        self.0.rows.into()
    }

    fn columns(&self) -> usize {
        self.0.columns.into()
    }
}

/// The size of a terminal without scrollback.
struct Lines(Size);

impl Alacritty {
    fn new(size: Size) -> Self {
        let config = Config { scrolling_history: 0, ..Config::default() };
        let terminal = alacritty_terminal::Term::new(config, &Lines(size), VoidListener);
        Self { terminal, parser: ansi::Processor::new() }
    }

    fn feed(&mut self, bytes: &[u8]) {
        self.parser.advance(&mut self.terminal, bytes);
    }

    /// Replaces the terminal by an empty one of another size with the same pen.
    // Without scrollback, `alacritty_terminal` 0.26 takes all memory to wrap lines anew. On its alternate screen, which
    // does not wrap them, half of a wide character stays behind and clears its neighbour later.
    fn resize(&mut self, size: Size) {
        let pen = self.terminal.grid().cursor.template.clone();
        *self = Self::new(size);
        self.terminal.grid_mut().cursor.template = pen;
    }

    /// Shows what a synchronized update holds back, as a terminal does if its end does not come.
    fn end_wait(&mut self) {
        if self.parser.sync_bytes_count() > 0 {
            self.parser.stop_sync(&mut self.terminal);
        }
    }

    fn seen(&self, column: u16, row: u16) -> Cell {
        let cell = &self.terminal.grid()[Line(row.into())][Column(column.into())];
        let attributes = attributes_of([
            (cell.flags.contains(Flags::BOLD), Attributes::BOLD),
            (cell.flags.contains(Flags::DIM), Attributes::DIM),
            (cell.flags.contains(Flags::ITALIC), Attributes::ITALIC),
            (cell.flags.intersects(Flags::ALL_UNDERLINES), Attributes::UNDERLINED),
            (cell.flags.contains(Flags::INVERSE), Attributes::REVERSED),
            (cell.flags.contains(Flags::HIDDEN), Attributes::HIDDEN),
            (cell.flags.contains(Flags::STRIKEOUT), Attributes::CROSSED_OUT),
        ]);
        let glyph = if cell.flags.contains(Flags::WIDE_CHAR_SPACER) { Glyph::Covered } else { cell.c.into() };
        let underline = cell.underline_color().map_or(Ink::Default, seen_by_alacritty);
        let (fg, bg) = (seen_by_alacritty(cell.fg), seen_by_alacritty(cell.bg));
        seen_of(Cell { glyph, fg, bg, underline, attributes })
    }
}

fn seen_by_alacritty(color: ansi::Color) -> Ink {
    match color {
        ansi::Color::Spec(ansi::Rgb { r, g, b }) => Ink::Rgb(Srgb8::new(r, g, b)),
        ansi::Color::Indexed(index) => Ink::Indexed(index),
        // The first sixteen are the palette's, and the others are the terminal's own.
        ansi::Color::Named(name) => {
            u8::try_from(name as usize).ok().filter(|&index| index < 16).map_or(Ink::Default, Ink::Indexed)
        }
    }
}

fn side(length: u16) -> NonZeroU16 {
    NonZeroU16::new(length).expect("a screen has cells")
}

impl Screens {
    /// Full of what another program has left behind, its colours still on and its cursor anywhere.
    pub(crate) fn disturbed(size: Size, clusters: Clusters) -> Self {
        let Size { columns, rows } = size;
        let avt = || avt::Terminal::new(columns.into(), rows.into()).expect("a screen has cells");
        let vt100 = || vt100::Parser::new(side(rows), side(columns), 0);
        let mut screens = Self {
            avt: matches!(clusters, Clusters::None).then(avt),
            vt100: matches!(clusters, Clusters::None | Clusters::Marks).then(vt100),
            alacritty: matches!(clusters, Clusters::None).then(|| Alacritty::new(size)),
            is_held: false,
            model: Model::new(size),
            parser: vte::Parser::new(),
        };
        let line = |row: u16| format!("\x1b[{};1H\x1b[1;4;31;42m{}", row + 1, "?".repeat(columns.into()));
        let rubbish: String = (0..rows).map(line).collect();
        screens.feed(format!("{rubbish}\x1b[1;1H").as_bytes());
        screens
    }

    /// Resizes the screens as a window does. Each terminal arranges its contents in its own way.
    pub(crate) fn resize(&mut self, size: Size) {
        if size == self.model.size {
            return;
        }
        if let Some(avt) = &mut self.avt {
            avt.resize(size.columns.into(), size.rows.into());
        }
        if let Some(vt100) = &mut self.vt100 {
            vt100.screen_mut().set_size(side(size.rows), side(size.columns));
        }
        if let Some(alacritty) = &mut self.alacritty {
            alacritty.resize(size);
        }
        let pen = self.model.pen.clone();
        self.model = Model { pen, ..Model::new(size) };
    }

    /// Shows one frame's bytes, which are whole characters and whole sequences.
    #[track_caller]
    pub(crate) fn feed(&mut self, bytes: &[u8]) {
        self.feed_in(&[usize::MAX], bytes);
    }

    /// Shows the bytes of a frame, read in pieces of these lengths, which repeat.
    #[track_caller]
    pub(crate) fn feed_in(&mut self, lengths: &[usize], bytes: &[u8]) {
        let text = std::str::from_utf8(bytes).expect("a frame ends in no character's middle");
        if let Some((_, last)) = text.rsplit_once('\x1b') {
            assert!(last.contains(|c: char| c.is_ascii_alphabetic()), "a frame ends in a sequence's middle: {last:?}");
        }
        // Since the last frame something else may have moved the cursor.
        self.model.cursor = None;
        self.model.last = None;
        self.model.row = None;
        if let Some(avt) = &mut self.avt {
            for piece in whole_characters(text, lengths) {
                avt.feed(piece);
            }
        }
        for piece in pieces(text, lengths) {
            if let Some(vt100) = &mut self.vt100 {
                vt100.process(piece);
            }
            if let Some(alacritty) = &mut self.alacritty {
                alacritty.feed(piece);
            }
            self.parser.advance(&mut self.model, piece);
        }
        // The end of a synchronized update shows it. Without one, the emulator still shows the frame before.
        self.is_held = self.alacritty.as_ref().is_some_and(|alacritty| alacritty.parser.sync_bytes_count() > 0);
    }

    /// Shows the bytes of a frame of which a mark of its synchronized update is lost.
    #[track_caller]
    pub(crate) fn feed_losing(&mut self, loss: Loss, lengths: &[usize], bytes: &[u8]) {
        let text = std::str::from_utf8(bytes).expect("a frame ends in no character's middle");
        let rest = match loss {
            Loss::Begin => text.replacen("\x1b[?2026h", "", 1),
            Loss::End | Loss::EndUntilNextFrame => text.replacen("\x1b[?2026l", "", 1),
        };
        assert!(rest != text, "the frame is not a synchronized update: {text:?}");
        self.feed_in(lengths, rest.as_bytes());
        if let Some(alacritty) = self.alacritty.as_mut().filter(|_| loss == Loss::End) {
            alacritty.end_wait();
            self.is_held = false;
        }
    }

    /// Returns whether a terminal holds back a synchronized update that has not ended.
    pub(crate) fn is_held(&self) -> bool {
        self.is_held
    }

    /// Returns the model's screen, row by row from the top.
    pub(crate) fn shown(&self) -> &[Cell] {
        &self.model.cells
    }

    /// Returns the cells of the two emulators.
    pub(crate) fn emulated(&self) -> impl Fn(u16, u16) -> [Cell; 2] {
        let (avt, vt100) = (self.avt.as_ref().expect("avt is asked"), self.vt100.as_ref().expect("vt100 is asked"));
        |column, row| [seen_by_avt(avt, column, row), seen_by_vt100(vt100, column, row)]
    }

    /// Each of them shows exactly this grid.
    #[track_caller]
    pub(crate) fn assert_show(&self, grid: &Grid) {
        self.assert_show_as(grid, |cell| cell);
    }

    /// Asserts that all screens show this grid's colours, half cell by half cell, with either half
    /// block.
    #[track_caller]
    pub(crate) fn assert_show_halves(&self, grid: &Grid) {
        self.assert_show_as(grid, lower_half);
    }

    #[track_caller]
    fn assert_show_as(&self, grid: &Grid, look: fn(Cell) -> Cell) {
        for row in 0..grid.size().rows {
            for column in 0..grid.size().columns {
                let wanted = seen_of(grid.cell(column, row).clone());
                let look = |cell: &Cell| look(cell.clone());
                let place = format!("column {column}, row {row}");
                assert_eq!(look(&self.model.cells[self.model.index(column, row)]), look(&wanted), "the model, {place}");
                if let Some(avt) = &self.avt {
                    assert_eq!(look(&seen_by_avt(avt, column, row)), look(&wanted.as_known(AVT_KNOWS)), "avt, {place}");
                }
                if let Some(alacritty) = self.alacritty.as_ref().filter(|_| !self.is_held) {
                    // A space has no glyph, and so no colour but that of its line.
                    let by_alacritty =
                        seen_of(Cell { attributes: wanted.attributes & ALACRITTY_KNOWS, ..wanted.clone() });
                    assert_eq!(look(&alacritty.seen(column, row)), look(&by_alacritty), "alacritty, {place}");
                }
                if let Some(vt100) = &self.vt100 {
                    let mut by_vt100 = wanted.as_known(VT100_KNOWS);
                    let seen = seen_by_vt100(vt100, column, row);
                    if seen.glyph == Glyph::Covered {
                        by_vt100 = Cell { glyph: by_vt100.glyph, ..seen.clone() };
                    }
                    assert_eq!(look(&seen), look(&by_vt100), "vt100, {place}");
                }
            }
        }
    }
}

/// Splits bytes into pieces of these lengths.
///
/// The rest of a character that is cut is a piece of its own: `vte` 0.15 loses what follows it in one (as `a` in C3, A9
/// 61 C3, A9).
fn pieces<'a>(text: &'a str, lengths: &'a [usize]) -> impl Iterator<Item = &'a [u8]> {
    let (mut lengths, mut start) = (lengths.iter().cycle(), 0);
    std::iter::from_fn(move || {
        let length = if text.is_char_boundary(start) { *lengths.next()? } else { next_boundary(text, start) - start };
        let piece = &text.as_bytes()[start..][..length.min(text.len() - start)];
        start += piece.len();
        (!piece.is_empty()).then_some(piece)
    })
}

/// Splits text into pieces of these lengths or somewhat longer, as `avt` takes whole characters.
fn whole_characters<'a>(text: &'a str, lengths: &'a [usize]) -> impl Iterator<Item = &'a str> {
    let (mut lengths, mut rest) = (lengths.iter().cycle(), text);
    std::iter::from_fn(move || {
        let (piece, after) = rest.split_at(next_boundary(rest, *lengths.next()?));
        rest = after;
        (!piece.is_empty()).then_some(piece)
    })
}

/// The first end of a character at that byte or after it.
fn next_boundary(text: &str, at: usize) -> usize {
    (at..text.len()).find(|&at| text.is_char_boundary(at)).unwrap_or(text.len())
}

/// Returns whether an emulator's upper left corner of a size shows these cells, by half cells.
pub(crate) fn avt_shows(avt: &avt::Terminal, shown: &[Cell], size: Size) -> bool {
    first_difference(avt, shown, size).is_none()
}

/// Asserts that an emulator's upper left corner shows these cells, by half cells.
#[track_caller]
pub(crate) fn assert_avt_shows(avt: &avt::Terminal, shown: &[Cell], size: Size) {
    assert_eq!(first_difference(avt, shown, size), None, "a cell as seen, and as it should be");
}

/// Returns the first cell that differs from what an emulator shows.
///
/// The cell is given by its column and row, as seen and as it should be.
fn first_difference(avt: &avt::Terminal, shown: &[Cell], size: Size) -> Option<(u16, u16, [Cell; 2])> {
    let places = (0..size.rows).flat_map(|row| (0..size.columns).map(move |column| (column, row)));
    places.zip(shown).find_map(|((column, row), cell)| {
        let both = [seen_by_avt(avt, column, row), seen_of(cell.clone()).as_known(AVT_KNOWS)].map(lower_half);
        (both[0] != both[1]).then_some((column, row, both))
    })
}

pub(crate) fn seen_by_avt(avt: &avt::Terminal, column: u16, row: u16) -> Cell {
    let line = avt.screen().line(row.into()).expect("the row is on the screen");
    let cell = line.cells()[usize::from(column)];
    let ink = |color: Option<avt::Color>| match color {
        None => Ink::Default,
        Some(avt::Color::Indexed(index)) => Ink::Indexed(index),
        Some(avt::Color::RGB(c)) => Ink::Rgb(Srgb8::new(c.r, c.g, c.b)),
    };
    let pen = cell.pen();
    let attributes = attributes_of([
        (pen.is_bold(), Attributes::BOLD),
        (pen.is_faint(), Attributes::DIM),
        (pen.is_italic(), Attributes::ITALIC),
        (pen.is_underline(), Attributes::UNDERLINED),
        (pen.is_blink(), Attributes::SLOW_BLINK),
        (pen.is_inverse(), Attributes::REVERSED),
        (pen.is_strikethrough(), Attributes::CROSSED_OUT),
    ]);
    let glyph = if cell.width() == 0 { Glyph::Covered } else { cell.char().into() };
    seen_of(Cell { glyph, fg: ink(pen.foreground()), bg: ink(pen.background()), underline: Ink::Default, attributes })
}

pub(crate) fn seen_by_vt100(vt100: &vt100::Parser, column: u16, row: u16) -> Cell {
    let cell = vt100.screen().cell(row, column).expect("the cell is on the screen");
    let ink = |color: vt100::Color| match color {
        vt100::Color::Default => Ink::Default,
        vt100::Color::Idx(index) => Ink::Indexed(index),
        vt100::Color::Rgb(r, g, b) => Ink::Rgb(Srgb8::new(r, g, b)),
    };
    let attributes = attributes_of([
        (cell.bold(), Attributes::BOLD),
        (cell.dim(), Attributes::DIM),
        (cell.italic(), Attributes::ITALIC),
        (cell.underline(), Attributes::UNDERLINED),
        (cell.inverse(), Attributes::REVERSED),
    ]);
    let glyph = if cell.is_wide_continuation() { Glyph::Covered } else { glyph_of(cell.contents()) };
    seen_of(Cell { glyph, fg: ink(cell.fgcolor()), bg: ink(cell.bgcolor()), underline: Ink::Default, attributes })
}

fn attributes_of<const N: usize>(flags: [(bool, Attributes); N]) -> Attributes {
    flags.into_iter().filter_map(|(is_on, flag)| is_on.then_some(flag)).collect()
}

/// A text as the grid holds it: one character, or several that belong together.
pub(crate) fn glyph_of(text: &str) -> Glyph {
    let mut characters = text.chars();
    match (characters.next(), characters.next()) {
        (Some(c), None) => c.into(),
        _ => Glyph::Cluster(text.into()),
    }
}

/// Returns a cell with only its visible attributes.
///
/// A plain space has no foreground, nor has an underline that is not drawn a colour. An inverted space is one of the
/// other colour, but the terminal's own foreground is no background.
fn seen_of(cell: Cell) -> Cell {
    if cell.glyph == ' ' && cell.attributes == Attributes::REVERSED && cell.fg != Ink::Default {
        return Cell::new(' ', Ink::Default, cell.fg);
    }
    let no_glyph = cell.glyph == ' ' && cell.attributes.is_empty();
    let no_line = !cell.attributes.contains(Attributes::UNDERLINED);
    Cell {
        fg: if no_glyph { Ink::Default } else { cell.fg },
        underline: if no_line { Ink::Default } else { cell.underline },
        ..cell
    }
}

/// Returns a cell of two colours as a lower half block.
///
/// The terminal's own colours stay: its foreground is not its background.
fn lower_half(cell: Cell) -> Cell {
    if !cell.attributes.is_empty() || cell.bg == Ink::Default {
        return cell;
    }
    match cell.glyph {
        Glyph::Char('▀') if cell.fg != Ink::Default => Cell::new('▄', cell.bg, cell.fg),
        Glyph::Char(' ') => Cell::new('▄', cell.bg, cell.bg),
        _ => cell,
    }
}

trait Known {
    /// The cell as a terminal keeps it that knows these modifiers, and bold and dim as one scale.
    fn as_known(&self, known: Attributes) -> Cell;
}

impl Known for Cell {
    fn as_known(&self, known: Attributes) -> Cell {
        let mut attributes = self.attributes & known;
        // The encoder says dim after bold.
        if attributes.contains(Attributes::DIM) {
            attributes.remove(Attributes::BOLD);
        }
        // Rapid blinking is blinking, or nothing: either way the model has looked at it.
        seen_of(Cell { attributes, underline: Ink::Default, ..self.clone() })
    }
}

/// A strict model of a terminal in raw mode. It knows CUP, CUF, CHA, CR, BS, LF, SGR, ICH, DCH, IL,
/// DL, the marks of synchronized output and characters.
///
/// It panics at anything else: erasing, scrolling, going over an edge, other control characters, anything but CUP after
/// a cluster and after rows are inserted or deleted (where terminals disagree on the cursor), and anything but CUP, CHA
/// and CR beyond the last column and after cells are inserted or deleted (where they disagree on its column). Cells
/// that come in are marked, and what is pushed over the edge of the screen is lost. A sequence that the encoder begins to
/// use must be added here.
struct Model {
    size: Size,
    cells: Vec<Cell>,
    pen: Cell,
    /// The position of the next character; `None` if unknown.
    cursor: Option<(u16, u16)>,
    /// The position of the last character. The next one may be part of the same cluster.
    last: Option<(u16, u16)>,
    /// The row of a cursor that may be anywhere in it.
    row: Option<u16>,
}

/// A mark that no frame has, where cells have come in.
const COME_IN: char = '\u{fffd}';

impl Model {
    fn new(size: Size) -> Self {
        let cells = vec![Cell { glyph: '?'.into(), ..Cell::BLANK }; size.cell_count()];
        Self { size, cells, pen: Cell::BLANK, cursor: None, last: None, row: None }
    }

    fn index(&self, column: u16, row: u16) -> usize {
        usize::from(row) * usize::from(self.size.columns) + usize::from(column)
    }

    /// Replaces the other half of a wide character by a blank.
    fn break_up(&mut self, column: u16, row: u16) {
        let at = self.index(column, row);
        if self.cells[at].glyph == Glyph::Covered {
            self.cells[at - 1].glyph = ' '.into();
        }
        if column + 1 < self.size.columns && self.cells[at + 1].glyph == Glyph::Covered {
            self.cells[at + 1].glyph = ' '.into();
        }
    }

    /// The cursor, where it is sure to be on the screen.
    fn cursor(&self) -> (u16, u16) {
        self.cursor.expect("the place is said before a relative move")
    }

    fn place(&mut self, column: u16, row: u16) {
        assert!(column < self.size.columns && row < self.size.rows, "({column}, {row}) is not on the screen");
        self.cursor = Some((column, row));
        self.last = None;
        self.row = None;
    }

    /// Inserts cells at the start of a range, whose end is an edge of the screen, or deletes them
    /// there.
    fn shift(&mut self, cells: std::ops::Range<usize>, count: usize, is_inserted: bool) {
        assert!(count <= cells.len(), "{count} of {} cells", cells.len());
        let come_in = Cell { glyph: COME_IN.into(), ..Cell::BLANK };
        let cells = &mut self.cells[cells];
        if is_inserted {
            cells.rotate_right(count);
            cells[..count].fill(come_in);
        } else {
            cells.rotate_left(count);
            let kept = cells.len() - count;
            cells[kept..].fill(come_in);
        }
        self.last = None;
    }

    /// Inserts or deletes cells at the cursor.
    fn shift_columns(&mut self, count: u16, is_inserted: bool) {
        let (column, row) = self.cursor();
        let (start, end) = (self.index(column, row), self.index(0, row + 1));
        let is_split = |at: usize| at < end && self.cells[at].glyph == Glyph::Covered;
        assert!(!is_split(start) && (is_inserted || !is_split(start + usize::from(count))), "a wide character is cut");
        self.shift(start..end, count.into(), is_inserted);
        self.cursor = None;
        self.row = Some(row);
    }

    /// Inserts or deletes rows at the cursor.
    fn shift_rows(&mut self, count: u16, is_inserted: bool) {
        let (_, row) = self.cursor();
        let cells_of_rows = usize::from(count) * usize::from(self.size.columns);
        self.shift(self.index(0, row)..self.cells.len(), cells_of_rows, is_inserted);
        self.cursor = None;
    }

    /// Returns the cluster that a character continues, with its position, if it continues one.
    fn cluster_with(&self, c: char) -> Option<(u16, u16, String)> {
        let (column, row) = self.last?;
        let text = format!("{}{c}", self.cells[self.index(column, row)].glyph);
        (text.graphemes(true).count() == 1).then_some((column, row, text))
    }

    /// Puts a text into the cells that it takes; the cursor is behind it.
    fn put(&mut self, column: u16, row: u16, text: &str) {
        let width = text.width() as u16;
        assert!(width > 0, "{text:?} takes no cell");
        assert!(column + width <= self.size.columns, "{text:?} at column {column} goes over the edge");
        for column in column..column + width {
            self.break_up(column, row);
        }
        let at = self.index(column, row);
        self.cells[at] = seen_of(Cell { glyph: glyph_of(text), ..self.pen.clone() });
        if width == 2 {
            self.cells[at + 1] = seen_of(Cell { glyph: Glyph::Covered, ..self.pen.clone() });
        }
        self.last = Some((column, row));
        let is_last = column + width == self.size.columns;
        self.cursor = (!is_last).then_some((column + width, row));
        self.row = is_last.then_some(row);
    }

    /// The colour of the line below: with colons, in a sequence of its own.
    fn select_underline(&mut self, numbers: &[u16]) {
        let byte = |number: u16| u8::try_from(number).expect("a colour's number is a byte");
        self.pen.underline = match *numbers {
            [58, 5, index] => Ink::Indexed(byte(index)),
            [58, 2, 0, r, g, b] => Ink::Rgb(Srgb8::new(byte(r), byte(g), byte(b))),
            [59] => Ink::Default,
            _ => panic!("SGR {numbers:?}"),
        };
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
                self.pen.attributes.insert(Attributes::from_bits_truncate(1 << (code - 1)));
                rest
            }
            [27, ref rest @ ..] => {
                self.pen.attributes.remove(Attributes::REVERSED);
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
        if let Some((column, row, text)) = self.cluster_with(c) {
            self.put(column, row, &text);
            (self.cursor, self.row) = (None, None);
        } else {
            let (column, row) = self.cursor.expect("the place is said before a character");
            self.put(column, row, c.encode_utf8(&mut [0; 4]));
        }
    }

    fn csi_dispatch(&mut self, params: &vte::Params, intermediates: &[u8], ignore: bool, action: char) {
        let numbers: Vec<u16> = params.iter().flatten().copied().collect();
        if intermediates == b"?" && numbers == [2026] && matches!(action, 'h' | 'l') {
            return;
        }
        assert!(intermediates.is_empty() && !ignore, "{intermediates:?} {numbers:?} {action:?}");
        let alone = params.iter().count() == 1;
        let colons = params.iter().any(|group| group.len() > 1);
        assert!(!colons || alone && numbers[0] == 58, "colons in {numbers:?}");
        match (action, &numbers[..]) {
            ('m', numbers @ [58 | 59, ..]) if alone => self.select_underline(numbers),
            ('m', numbers) => self.select(numbers),
            // A number that is not said is read as 0, which means 1.
            ('H', &[row]) => self.place(0, row.max(1) - 1),
            ('H', &[row, column]) => self.place(column.checked_sub(1).expect("from 1"), row.max(1) - 1),
            ('C', &[columns]) => {
                let (column, row) = self.cursor();
                self.place(column + columns.max(1), row);
            }
            ('@' | 'P', &[count]) => self.shift_columns(count.max(1), action == '@'),
            ('L' | 'M', &[count]) => self.shift_rows(count.max(1), action == 'L'),
            ('G', &[number]) => {
                let row = self.row.unwrap_or_else(|| self.cursor().1);
                self.place(number.max(1) - 1, row);
            }
            other => panic!("not of the safe core: {other:?}"),
        }
    }

    fn execute(&mut self, byte: u8) {
        match (byte, self.row) {
            (b'\r', Some(row)) => self.place(0, row),
            (b'\r', None) => self.place(0, self.cursor().1),
            (b'\n', None) => self.place(self.cursor().0, self.cursor().1 + 1),
            (b'\x08', None) => {
                let (column, row) = self.cursor();
                self.place(column.checked_sub(1).expect("not left of the first column"), row);
            }
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
