//! Cells in an order -> bytes: which glyph shows each with the fewest changes of colour, and how the cursor gets there.
//!
//! A half-block cell can be written in two ways, the lower half on the upper one's colour or the other way round, and
//! which one is cheaper depends on the pen, which depends on how the cell before was written. So the whole sequence is
//! decided at once: for each cell the cheapest way to have written everything up to it in either form (Viterbi 1967).

use super::moves::{CellPosition, Move, cheapest_move};
use super::pen::{Pen, is_plain_space, write_char, write_glyph};
use super::widths;
use crate::grid::{Cell, Glyph, Grid, HalfBlocks, Ink};
use std::ops::Range;

/// A cell, the form in which it is written, and the pen.
pub(super) struct Stroke {
    position: CellPosition,
    form: BlockForm,
    pen: Pen,
}

/// How the cells are written in that order.
pub(super) fn choose(wanted: &Grid, order: &[CellPosition], half_blocks: HalfBlocks, mut pen: Pen) -> Vec<Stroke> {
    let forms = choose_forms(wanted, order, half_blocks, pen);
    let stroke = |(&position, form): (&CellPosition, BlockForm)| {
        pen = form.pen(wanted.cell(position.column, position.row), &pen);
        Stroke { position, form, pen }
    };
    order.iter().zip(forms).map(stroke).collect()
}

/// The colour of a plain space's character is free: let it be the one that the next cell wants, if that wants nothing
/// else changed. Where the space changes the colour behind it, one sequence then says both. (Not with the two colours
/// exchanged: the character's is the one that is seen then.)
pub(super) fn share_next_fg(wanted: &Grid, strokes: &mut [Stroke]) {
    for at in (1..strokes.len()).rev() {
        let next = strokes[at].pen;
        let stroke = &mut strokes[at - 1];
        let only_fg = stroke.pen.attributes.is_empty() && Pen { fg: next.fg, ..stroke.pen } == next;
        if only_fg && is_plain_space(wanted.cell(stroke.position.column, stroke.position.row)) {
            stroke.pen = next;
        }
    }
}

/// Writes them. Where the cursor is at first is not asked: whatever else has been written to the terminal since the last
/// frame may have moved it. Where it is at last is the answer, if that is sure.
pub(super) fn write(
    wanted: &Grid,
    strokes: &[Stroke],
    half_blocks: HalfBlocks,
    pen: &mut Pen,
    bytes: &mut Vec<u8>,
) -> Option<CellPosition> {
    let mut cursor = None;
    for stroke in strokes {
        move_to(wanted, cursor, stroke.position, half_blocks, pen, bytes);
        pen.switch_to(stroke.pen, bytes);
        write_cell(wanted, stroke, bytes);
        cursor = cursor_after(wanted, stroke.position);
    }
    cursor
}

/// A wide cluster takes one cell in some terminals: what stood in the others is wiped out before it.
fn write_cell(wanted: &Grid, stroke: &Stroke, bytes: &mut Vec<u8>) {
    let CellPosition { column, row } = stroke.position;
    let glyph = &wanted.cell(column, row).glyph;
    if matches!(glyph, Glyph::Cluster(_)) && widths::width_at(wanted, column, row) > 1 {
        bytes.extend(std::iter::repeat_n(b' ', widths::width_at(wanted, column, row).into()));
        Move::To(stroke.position).write(bytes);
    }
    match stroke.form {
        BlockForm::AsWanted => write_glyph(glyph, bytes),
        BlockForm::Flipped => write_char(other_half_block(glyph).unwrap_or(' '), bytes),
    }
}

/// How a cell is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BlockForm {
    /// As it stands in the grid.
    AsWanted,
    /// A half block with the other half.
    Flipped,
}

impl BlockForm {
    /// The pen that writes the cell in this form, after that one.
    fn pen(self, cell: &Cell, before: &Pen) -> Pen {
        let plain = before.pen_for(cell);
        match self {
            Self::AsWanted => plain,
            Self::Flipped => swapped_colors(plain),
        }
    }
}

/// The pen for the other half.
fn swapped_colors(pen: Pen) -> Pen {
    Pen { fg: pen.bg, bg: pen.fg, ..pen }
}

fn other_half_block(glyph: &Glyph) -> Option<char> {
    match glyph {
        Glyph::Char('▄') => Some('▀'),
        Glyph::Char('▀') => Some('▄'),
        _ => None,
    }
}

/// Whether the cell looks the same when its halves and colours are exchanged. The terminal's own colours cannot be: each
/// is known only in its own position.
fn can_be_flipped(cell: &Cell) -> bool {
    other_half_block(&cell.glyph).is_some()
        && cell.attributes.is_empty()
        && cell.fg != Ink::Default
        && cell.bg != Ink::Default
}

/// A cheapest way to have written everything up to a cell.
#[derive(Clone, Copy)]
struct SurvivorPath {
    pen: Pen,
    cost: PathCost,
}

/// Bytes ([`COST_PER_BYTE`] each); of as many, how often the lower half is written. Which half it is hardly matters, but it has to
/// be the same wherever both cost the same, or a compressor does not know the frame before again. With the upper one, the
/// colours are said in the order in which the pixels lie.
type PathCost = u64;

/// More than there are cells.
const COST_PER_BYTE: PathCost = 1 << 32;

/// The form of each cell, such that the changes of the pen between them take the fewest bytes.
fn choose_forms(wanted: &Grid, order: &[CellPosition], half_blocks: HalfBlocks, pen: Pen) -> Vec<BlockForm> {
    if half_blocks == HalfBlocks::Lower {
        return vec![BlockForm::AsWanted; order.len()];
    }
    let mut paths = [SurvivorPath { pen, cost: 0 }; 2];
    // For each cell and each form of it, the form of the cell before.
    let mut predecessors = Vec::with_capacity(order.len());
    for position in order {
        let cell = wanted.cell(position.column, position.row);
        // (One by one: `map` over arrays of pens copies them about, which took a third of an encoder's time.)
        let pens = [paths[0].pen.pen_for(cell), paths[1].pen.pen_for(cell)];
        let is_lower = cell.glyph == '▄';
        if is_plain_space(cell) {
            // The character's colour is carried on: both paths stay open.
            predecessors.push([0, 1]);
            paths =
                [paths[0].step(pens[0], pens[0].ink_lens(), false), paths[1].step(pens[1], pens[1].ink_lens(), false)];
        } else if can_be_flipped(cell) {
            let lens = pens[0].ink_lens();
            let (plain, from_plain) = cheaper(&paths, pens, lens, is_lower);
            let flipped_pens = [swapped_colors(pens[0]), swapped_colors(pens[1])];
            let (flipped, from_flipped) = cheaper(&paths, flipped_pens, [lens[1], lens[0]], !is_lower);
            predecessors.push([from_plain, from_flipped]);
            paths = [plain, flipped];
        } else {
            let (plain, from_plain) = cheaper(&paths, pens, pens[0].ink_lens(), is_lower);
            predecessors.push([from_plain; 2]);
            paths = [plain; 2];
        }
    }
    let mut last = u8::from(paths[1].cost < paths[0].cost);
    let mut forms = vec![BlockForm::AsWanted; order.len()];
    for (at, position) in order.iter().enumerate().rev() {
        if last == 1 && can_be_flipped(wanted.cell(position.column, position.row)) {
            forms[at] = BlockForm::Flipped;
        }
        last = predecessors[at][usize::from(last)];
    }
    forms
}

/// The cheaper of two paths, with a cell written by these pens of the same colours, and which of them it was.
fn cheaper(paths: &[SurvivorPath; 2], pens: [Pen; 2], lens: [usize; 2], is_lower: bool) -> (SurvivorPath, u8) {
    let [first, second] = [paths[0].step(pens[0], lens, is_lower), paths[1].step(pens[1], lens, is_lower)];
    if second.cost < first.cost { (second, 1) } else { (first, 0) }
}

impl SurvivorPath {
    #[inline(always)]
    fn step(&self, pen: Pen, lens: [usize; 2], is_lower: bool) -> Self {
        Self {
            pen,
            cost: self.cost
                + self.pen.switch_cost_with_lens(&pen, lens) as PathCost * COST_PER_BYTE
                + PathCost::from(is_lower),
        }
    }
}

/// Brings the cursor there: by the cheapest move, or by writing again what lies on the way, where the pen happens to be
/// right for all of it and that takes no more bytes. (As many are fewer to a compressor: a run of one glyph goes on.)
fn move_to(
    wanted: &Grid,
    cursor: Option<CellPosition>,
    position: CellPosition,
    half_blocks: HalfBlocks,
    pen: &Pen,
    bytes: &mut Vec<u8>,
) {
    if cursor == Some(position) {
        return;
    }
    let by_move = cheapest_move(cursor, position);
    let start = bytes.len();
    let is_there = columns_between(cursor, position).is_some_and(|mut between| {
        between.all(|column| {
            let character = char_shown_by_pen(wanted.cell(column, position.row), half_blocks, pen);
            character.is_some_and(|glyph| {
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

/// The columns from the cursor to a position further right in its row.
fn columns_between(cursor: Option<CellPosition>, position: CellPosition) -> Option<Range<u16>> {
    let cursor = cursor.filter(|cursor| cursor.row == position.row && cursor.column < position.column)?;
    Some(cursor.column..position.column)
}

/// The character that shows the cell with this very pen. (Only ASCII and half blocks: anything else takes more bytes than
/// a move, or more cells than one.)
fn char_shown_by_pen(cell: &Cell, half_blocks: HalfBlocks, pen: &Pen) -> Option<char> {
    let shows = |form: BlockForm| form.pen(cell, pen) == *pen;
    match (&cell.glyph, other_half_block(&cell.glyph)) {
        (_, Some(other)) if half_blocks == HalfBlocks::Either && can_be_flipped(cell) && shows(BlockForm::Flipped) => {
            Some(other)
        }
        (Glyph::Char(own), other) if (other.is_some() || own.is_ascii()) && shows(BlockForm::AsWanted) => Some(*own),
        _ => None,
    }
}

/// Where the cursor is after a cell, if that is sure. In the last column it depends on the terminal. After a cluster too:
/// terminals disagree on how many cells a flag, a family or a letter with marks takes, so the next move has to say its
/// position.
pub(super) fn cursor_after(wanted: &Grid, position: CellPosition) -> Option<CellPosition> {
    if matches!(wanted.cell(position.column, position.row).glyph, Glyph::Cluster(_)) {
        return None;
    }
    let column = position.column + widths::width_at(wanted, position.column, position.row);
    (column < wanted.size().columns).then_some(CellPosition { column, ..position })
}
