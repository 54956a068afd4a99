//! Cells in an order -> bytes: which glyph shows each with the fewest changes of colour, and how the cursor gets there.
//!
//! A half-block cell can be written in two ways, the lower half on the upper one's colour or the other way round, and
//! which one is cheaper depends on the pen, which depends on how the cell before was written. So the whole sequence is
//! decided at once: for each cell the cheapest way to have written everything up to it in either form (Viterbi 1967).

use super::columns;
use super::moves::{Move, Place, cheapest};
use super::pen::{Pen, is_plain_space, write_char, write_glyph};
use crate::grid::{Cell, Glyph, Grid, Ink};
use std::ops::Range;

/// A cell, the form in which it is written, and the pen.
pub(super) struct Stroke {
    place: Place,
    form: Form,
    pen: Pen,
}

/// How the cells are written in that order.
pub(super) fn choose(wanted: &Grid, order: &[Place], upper_half: bool, mut pen: Pen) -> Vec<Stroke> {
    let forms = choose_forms(wanted, order, upper_half, pen);
    let stroke = |(&place, form): (&Place, Form)| {
        pen = form.pen(wanted.cell(place.column, place.row), &pen);
        Stroke { place, form, pen }
    };
    order.iter().zip(forms).map(stroke).collect()
}

/// The colour of a plain space's character is free: let it be the one that the next cell wants, if that wants nothing
/// else changed. Where the space changes the colour behind it, one sequence then says both. (Not with the two colours
/// exchanged: the character's is the one that is seen then.)
pub(super) fn look_ahead(wanted: &Grid, strokes: &mut [Stroke]) {
    for at in (1..strokes.len()).rev() {
        let next = strokes[at].pen;
        let stroke = &mut strokes[at - 1];
        let only_fg = stroke.pen.attributes.is_empty() && Pen { fg: next.fg, ..stroke.pen } == next;
        if only_fg && is_plain_space(wanted.cell(stroke.place.column, stroke.place.row)) {
            stroke.pen = next;
        }
    }
}

/// Writes them. Where the cursor is at first is not asked: whatever else has been written to the terminal since the last
/// frame may have moved it. Where it is at last is the answer, if that is sure.
pub(super) fn write(
    wanted: &Grid,
    strokes: &[Stroke],
    upper_half: bool,
    pen: &mut Pen,
    bytes: &mut Vec<u8>,
) -> Option<Place> {
    let mut cursor = None;
    for stroke in strokes {
        move_to(wanted, cursor, stroke.place, upper_half, pen, bytes);
        pen.become_pen(stroke.pen, bytes);
        write_cell(wanted, stroke, bytes);
        cursor = after(wanted, stroke.place);
    }
    cursor
}

/// A wide cluster takes one cell in some terminals: what stood in the others is wiped out before it.
fn write_cell(wanted: &Grid, stroke: &Stroke, bytes: &mut Vec<u8>) {
    let Place { column, row } = stroke.place;
    let glyph = &wanted.cell(column, row).glyph;
    if matches!(glyph, Glyph::Cluster(_)) && columns::at(wanted, column, row) > 1 {
        bytes.extend(std::iter::repeat_n(b' ', columns::at(wanted, column, row).into()));
        Move::To(stroke.place).write(bytes);
    }
    match stroke.form {
        Form::Plain => write_glyph(glyph, bytes),
        Form::Turned => write_char(other_half(glyph).unwrap_or(' '), bytes),
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
    /// The pen that writes the cell in this form, after that one.
    fn pen(self, cell: &Cell, before: &Pen) -> Pen {
        let plain = before.wanted_by(cell);
        match self {
            Self::Plain => plain,
            Self::Turned => turned(plain),
        }
    }
}

/// The pen for the other half.
fn turned(pen: Pen) -> Pen {
    Pen { fg: pen.bg, bg: pen.fg, ..pen }
}

fn other_half(glyph: &Glyph) -> Option<char> {
    match glyph {
        Glyph::Char('▄') => Some('▀'),
        Glyph::Char('▀') => Some('▄'),
        _ => None,
    }
}

/// Whether the cell looks the same when its halves and colours are exchanged. The terminal's own colours cannot be: each
/// is known only in its own place.
fn can_be_turned(cell: &Cell) -> bool {
    other_half(&cell.glyph).is_some()
        && cell.attributes.is_empty()
        && cell.fg != Ink::Default
        && cell.bg != Ink::Default
}

/// A cheapest way to have written everything up to a cell.
#[derive(Clone, Copy)]
struct Path {
    pen: Pen,
    cost: Cost,
}

/// Bytes ([`BYTE`] each); of as many, how often the lower half is written. Which half it is hardly matters, but it has to
/// be the same wherever both cost the same, or a compressor does not know the frame before again. With the upper one, the
/// colours are said in the order in which the pixels lie.
type Cost = u64;

/// More than there are cells.
const BYTE: Cost = 1 << 32;

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
        // (One by one: `map` over arrays of pens copies them about, which took a third of an encoder's time.)
        let pens = [paths[0].pen.wanted_by(cell), paths[1].pen.wanted_by(cell)];
        let is_lower = cell.glyph == '▄';
        if is_plain_space(cell) {
            // The character's colour is carried on: both paths stay open.
            before.push([0, 1]);
            paths =
                [paths[0].step(pens[0], pens[0].ink_lens(), false), paths[1].step(pens[1], pens[1].ink_lens(), false)];
        } else if can_be_turned(cell) {
            let lens = pens[0].ink_lens();
            let (plain, from_plain) = cheaper(&paths, pens, lens, is_lower);
            let turned_pens = [turned(pens[0]), turned(pens[1])];
            let (turned, from_turned) = cheaper(&paths, turned_pens, [lens[1], lens[0]], !is_lower);
            before.push([from_plain, from_turned]);
            paths = [plain, turned];
        } else {
            let (plain, from_plain) = cheaper(&paths, pens, pens[0].ink_lens(), is_lower);
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

/// The cheaper of two paths, with a cell written by these pens of the same colours, and which of them it was.
fn cheaper(paths: &[Path; 2], pens: [Pen; 2], lens: [usize; 2], is_lower: bool) -> (Path, u8) {
    let [first, second] = [paths[0].step(pens[0], lens, is_lower), paths[1].step(pens[1], lens, is_lower)];
    if second.cost < first.cost { (second, 1) } else { (first, 0) }
}

impl Path {
    #[inline(always)]
    fn step(&self, pen: Pen, lens: [usize; 2], is_lower: bool) -> Self {
        Self { pen, cost: self.cost + self.pen.cost_of_inks(&pen, lens) as Cost * BYTE + Cost::from(is_lower) }
    }
}

/// Brings the cursor there: by the cheapest move, or by writing again what lies on the way, where the pen happens to be
/// right for all of it and that takes no more bytes. (As many are fewer to a compressor: a run of one glyph goes on.)
fn move_to(wanted: &Grid, cursor: Option<Place>, place: Place, upper_half: bool, pen: &Pen, bytes: &mut Vec<u8>) {
    if cursor == Some(place) {
        return;
    }
    let by_move = cheapest(cursor, place);
    let start = bytes.len();
    let is_there = same_row(cursor, place).is_some_and(|mut between| {
        between.all(|column| {
            let again = again(wanted.cell(column, place.row), upper_half, pen);
            again.is_some_and(|glyph| {
                write_char(glyph, bytes);
                bytes.len() - start <= by_move.len()
            })
        })
    });
    if !is_there {
        bytes.truncate(start);
        by_move.write(bytes);
    }
}

/// The columns from the cursor to a place further right in its row.
fn same_row(cursor: Option<Place>, place: Place) -> Option<Range<u16>> {
    let cursor = cursor.filter(|cursor| cursor.row == place.row && cursor.column < place.column)?;
    Some(cursor.column..place.column)
}

/// The character that shows the cell with this very pen. (Only ASCII and half blocks: anything else takes more bytes than
/// a move, or more cells than one.)
fn again(cell: &Cell, upper_half: bool, pen: &Pen) -> Option<char> {
    let shows = |form: Form| form.pen(cell, pen) == *pen;
    match (&cell.glyph, other_half(&cell.glyph)) {
        (_, Some(other)) if upper_half && can_be_turned(cell) && shows(Form::Turned) => Some(other),
        (Glyph::Char(own), other) if (other.is_some() || own.is_ascii()) && shows(Form::Plain) => Some(*own),
        _ => None,
    }
}

/// Where the cursor is after a cell, if that is sure. In the last column it depends on the terminal. After a cluster too:
/// terminals disagree on how many cells a flag, a family or a letter with marks takes, so the next move has to say its
/// place.
pub(super) fn after(wanted: &Grid, place: Place) -> Option<Place> {
    if matches!(wanted.cell(place.column, place.row).glyph, Glyph::Cluster(_)) {
        return None;
    }
    let column = place.column + columns::at(wanted, place.column, place.row);
    (column < wanted.size().columns).then_some(Place { column, ..place })
}
