//! Cells in an order -> bytes: which glyph shows each with the fewest changes of colour, and how the cursor gets there.
//!
//! A half-block cell can be written in two ways, the lower half on the upper one's colour or the other way round, and
//! which one is cheaper depends on the pen, which depends on how the cell before was written. So the whole sequence is
//! decided at once: for each cell the cheapest way to have written everything up to it in either form (Viterbi 1967).

use super::moves::{Place, cheapest};
use super::pen::{Pen, is_plain_space};
use crate::grid::{Cell, Grid, Ink};

/// A character and the pen that writes it.
pub(super) struct Stroke {
    place: Place,
    glyph: char,
    pen: Pen,
}

/// How the cells are written in that order.
pub(super) fn choose(wanted: &Grid, order: &[Place], upper_half: bool, mut pen: Pen) -> Vec<Stroke> {
    let forms = choose_forms(wanted, order, upper_half, pen);
    let stroke = |(&place, form): (&Place, Form)| {
        let cell = form.of(wanted.cell(place.column, place.row));
        pen = pen.wanted_by(&cell);
        Stroke { place, glyph: cell.glyph, pen }
    };
    order.iter().zip(forms).map(stroke).collect()
}

/// The colour of a plain space's character is free: let it be the one that the next cell wants, if that wants nothing
/// else changed. Where the space changes the colour behind it, one sequence then says both.
pub(super) fn look_ahead(strokes: &mut [Stroke]) {
    for at in (1..strokes.len()).rev() {
        let next = strokes[at].pen;
        let stroke = &mut strokes[at - 1];
        let only_fg = Pen { fg: next.fg, ..stroke.pen } == next;
        if stroke.glyph == ' ' && stroke.pen.modifier.is_empty() && only_fg {
            stroke.pen = next;
        }
    }
}

/// Writes them. Where the cursor is at first is not asked: whatever else has been written to the terminal since the last
/// frame may have moved it.
pub(super) fn write(wanted: &Grid, strokes: &[Stroke], pen: &mut Pen, bytes: &mut Vec<u8>) {
    let mut cursor = None;
    for stroke in strokes {
        move_to(wanted, cursor, stroke.place, pen, bytes);
        pen.become_pen(stroke.pen, bytes);
        write_char(stroke.glyph, bytes);
        cursor = after(wanted, stroke.place);
    }
}

/// How a cell is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// As it stands in the grid.
    Plain,
    /// A half block with the other half.
    Turned,
}

impl Form {
    fn of(self, cell: &Cell) -> Cell {
        match self {
            Self::Plain => *cell,
            Self::Turned => {
                Cell { glyph: other_half(cell.glyph).unwrap_or(cell.glyph), fg: cell.bg, bg: cell.fg, ..*cell }
            }
        }
    }
}

fn other_half(glyph: char) -> Option<char> {
    match glyph {
        '▄' => Some('▀'),
        '▀' => Some('▄'),
        _ => None,
    }
}

/// Whether the cell looks the same when its halves and colours are exchanged. The terminal's own colours cannot be: each
/// is known only in its own place.
fn can_be_turned(cell: &Cell) -> bool {
    other_half(cell.glyph).is_some() && cell.modifier.is_empty() && cell.fg != Ink::Default && cell.bg != Ink::Default
}

/// A cheapest way to have written everything up to a cell.
#[derive(Clone, Copy)]
struct Path {
    pen: Pen,
    cost: usize,
}

/// The form of each cell, such that the changes of the pen between them take the fewest bytes.
fn choose_forms(wanted: &Grid, order: &[Place], upper_half: bool, pen: Pen) -> Vec<Form> {
    if !upper_half {
        return vec![Form::Plain; order.len()];
    }
    let mut paths = [Path { pen, cost: 0 }; 2];
    // For each cell and each form of it, the form of the cell before.
    let mut before = Vec::with_capacity(order.len());
    for place in order {
        let cell = wanted.cell(place.column, place.row);
        let (plain, from_plain) = extend(&paths, cell);
        if can_be_turned(cell) {
            let (turned, from_turned) = extend(&paths, &Form::Turned.of(cell));
            before.push([from_plain, from_turned]);
            paths = [plain, turned];
        } else if is_plain_space(cell) {
            // The character's colour is carried on: both paths stay open.
            before.push([0, 1]);
            paths = paths.map(|path| step(&path, cell));
        } else {
            before.push([from_plain; 2]);
            paths = [plain; 2];
        }
    }
    let mut last = u8::from(paths[1].cost < paths[0].cost);
    let mut forms = vec![Form::Plain; order.len()];
    for (at, place) in order.iter().enumerate().rev() {
        if last == 1 && can_be_turned(wanted.cell(place.column, place.row)) {
            forms[at] = Form::Turned;
        }
        last = before[at][usize::from(last)];
    }
    forms
}

/// The cheaper of two paths, with the cell written, and which of them it was.
fn extend(paths: &[Path; 2], cell: &Cell) -> (Path, u8) {
    let [first, second] = [step(&paths[0], cell), step(&paths[1], cell)];
    if second.cost < first.cost { (second, 1) } else { (first, 0) }
}

fn step(path: &Path, cell: &Cell) -> Path {
    let pen = path.pen.wanted_by(cell);
    Path { pen, cost: path.cost + path.pen.cost_of(&pen) }
}

/// Brings the cursor there: by the cheapest move, or by writing again what lies on the way, where the pen happens to be
/// right for all of it and that is cheaper.
fn move_to(wanted: &Grid, cursor: Option<Place>, place: Place, pen: &Pen, bytes: &mut Vec<u8>) {
    let by_move = cheapest(cursor, place);
    let Some(between) = same_row(cursor, place) else {
        return by_move.write(bytes);
    };
    let start = bytes.len();
    for column in between {
        let again = again(wanted.cell(column, place.row), pen);
        let Some(glyph) = again.filter(|_| bytes.len() - start < by_move.len()) else {
            bytes.truncate(start);
            return by_move.write(bytes);
        };
        bytes.push(glyph);
    }
}

/// The columns from the cursor to a place further right in its row.
fn same_row(cursor: Option<Place>, place: Place) -> Option<std::ops::Range<u16>> {
    let cursor = cursor.filter(|cursor| cursor.row == place.row && cursor.column < place.column)?;
    Some(cursor.column..place.column)
}

/// The character that shows the cell with this very pen, if one byte does. (More bytes would not be cheaper than the
/// move, and a wide character is more.)
fn again(cell: &Cell, pen: &Pen) -> Option<u8> {
    let fits = pen.wanted_by(cell) == *pen && cell.glyph != Cell::COVERED;
    u8::try_from(cell.glyph).ok().filter(|glyph| fits && glyph.is_ascii())
}

/// In UTF-8.
pub(super) fn write_char(glyph: char, bytes: &mut Vec<u8>) {
    let mut utf8 = [0; 4];
    bytes.extend_from_slice(glyph.encode_utf8(&mut utf8).as_bytes());
}

/// Where the cursor is after a character: in the last column that depends on the terminal.
pub(super) fn after(wanted: &Grid, place: Place) -> Option<Place> {
    let column = place.column + super::width(wanted, place.column, place.row);
    (column < wanted.size().columns).then_some(Place { column, ..place })
}
