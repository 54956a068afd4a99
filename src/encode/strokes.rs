//! Encoding of cells in a given order: the choice of half blocks, and the moves of the cursor.
//!
//! A half-block cell can be written in two forms: with the lower half block, or with the upper one and the colours
//! exchanged. Which one is cheaper depends on the pen, and so on the form of the cell before. The forms of all cells
//! are chosen together, by the cheapest path to each form of each cell (Viterbi 1967).

use super::moves::{CellPosition, KnownCursor, Move, cheapest_move};
use super::pen::{Pen, is_plain_space, write_char, write_glyph};
use super::widths;
use crate::grid::{Grid, HalfBlocks, PackedCell, PackedInk};
use std::ops::Range;

/// A cell, the form in which it is written, and the pen that writes it.
pub(super) struct Stroke {
    position: CellPosition,
    form: BlockForm,
    pen: Pen,
}

/// The strokes of a frame, in memory that is kept from frame to frame.
#[derive(Default)]
pub(super) struct Strokes {
    /// The cells in the order of writing.
    cells: Vec<PackedCell>,
    chosen: Vec<Stroke>,
    forms: Vec<BlockForm>,
    /// For each cell and each of its two forms, the form of the previous cell on the cheapest path.
    predecessors: Vec<[u8; 2]>,
}

impl Strokes {
    /// Chooses strokes that write the cells in `order` with the fewest bytes for changes of the
    /// pen.
    pub(super) fn choose(&mut self, wanted: &Grid, order: &[CellPosition], half_blocks: HalfBlocks, mut pen: Pen) {
        self.cells.clear();
        self.cells.extend(order.iter().map(|&CellPosition { column, row }| wanted.packed_cell(column, row)));
        self.choose_forms(half_blocks, pen);
        self.chosen.clear();
        let cells = self.cells.iter().zip(order).zip(&self.forms);
        self.chosen.extend(cells.map(|((&cell, &position), &form)| {
            pen = form.pen(cell, &pen);
            Stroke { position, form, pen }
        }));
    }

    /// Gives plain spaces the pen of the next stroke if it differs in the glyph colour only.
    // A space's glyph colour is invisible, so the space's sequence can set it for the next stroke. Not in reverse
    // video, where the glyph colour fills the cell.
    pub(super) fn share_next_fg(&mut self) {
        for at in (1..self.chosen.len()).rev() {
            let next = self.chosen[at].pen;
            let stroke = &mut self.chosen[at - 1];
            let only_fg = stroke.pen.attributes.is_empty() && Pen { fg: next.fg, ..stroke.pen } == next;
            if only_fg && is_plain_space(self.cells[at - 1]) {
                stroke.pen = next;
            }
        }
    }

    /// Appends the strokes, and returns the cursor after them.
    // The cursor's position is assumed unknown at first, because other output since the last frame may have moved it.
    pub(super) fn write(
        &self,
        wanted: &Grid,
        half_blocks: HalfBlocks,
        pen: &mut Pen,
        bytes: &mut Vec<u8>,
    ) -> KnownCursor {
        let mut cursor = KnownCursor::Unknown;
        for (stroke, &cell) in self.chosen.iter().zip(&self.cells) {
            move_to(wanted, cursor, stroke.position, half_blocks, pen, bytes);
            pen.switch_to(stroke.pen, bytes);
            write_cell(wanted, stroke, cell, bytes);
            cursor = cursor_after(wanted, stroke.position);
        }
        cursor
    }

    /// Chooses forms of the cells with the fewest bytes for changes of the pen.
    fn choose_forms(&mut self, half_blocks: HalfBlocks, pen: Pen) {
        let Self { cells, forms, predecessors, .. } = self;
        forms.clear();
        forms.resize(cells.len(), BlockForm::AsWanted);
        if half_blocks == HalfBlocks::Lower {
            return;
        }
        let mut paths = [SurvivorPath { pen, cost: 0 }; 2];
        predecessors.clear();
        for &cell in &*cells {
            // Written out for each element, because `map` over arrays of pens copies them in pieces, which took a third
            // of the encoder's time.
            let pens = [paths[0].pen.pen_for(cell), paths[1].pen.pen_for(cell)];
            let is_lower = cell.has_char('▄');
            if is_plain_space(cell) {
                // A space has one form only, but keeps the pen's glyph colour: both paths go on, as their pens differ.
                predecessors.push([0, 1]);
                paths = [
                    paths[0].extended(pens[0], pens[0].ink_lens(), false),
                    paths[1].extended(pens[1], pens[1].ink_lens(), false),
                ];
            } else if can_be_flipped(cell) {
                let lens = pens[0].ink_lens();
                let (plain, flipped) = if paths[1].pen == swapped_colors(paths[0].pen) {
                    // After a cell that can be flipped, each path's pen is that of the other with exchanged colours: a
                    // change from one to a form takes as many bytes as one from the other to the other form.
                    let same = paths[0].pen.switch_cost_with_lens(&pens[0], lens);
                    let other = paths[1].pen.switch_cost_with_lens(&pens[1], lens);
                    (
                        cheaper_path(&paths, [same, other], pens[0], is_lower),
                        cheaper_path(&paths, [other, same], swapped_colors(pens[0]), !is_lower),
                    )
                } else {
                    let flipped_pens = [swapped_colors(pens[0]), swapped_colors(pens[1])];
                    (
                        cheaper_extension(&paths, pens, lens, is_lower),
                        cheaper_extension(&paths, flipped_pens, [lens[1], lens[0]], !is_lower),
                    )
                };
                predecessors.push([plain.1, flipped.1]);
                paths = [plain.0, flipped.0];
            } else {
                let (plain, from_plain) = cheaper_extension(&paths, pens, pens[0].ink_lens(), is_lower);
                predecessors.push([from_plain; 2]);
                paths = [plain; 2];
            }
        }
        let mut last = u8::from(paths[1].cost < paths[0].cost);
        for (at, &cell) in cells.iter().enumerate().rev() {
            if last == 1 && can_be_flipped(cell) {
                forms[at] = BlockForm::Flipped;
            }
            last = predecessors[at][usize::from(last)];
        }
    }
}

/// Appends the glyph of a stroke.
// Before a wide cluster, blanks clear its cells, because some terminals draw the cluster in its first cell only.
fn write_cell(wanted: &Grid, stroke: &Stroke, cell: PackedCell, bytes: &mut Vec<u8>) {
    let CellPosition { column, row } = stroke.position;
    if cell.is_cluster() && widths::width_at(wanted, column, row) > 1 {
        bytes.extend(std::iter::repeat_n(b' ', widths::width_at(wanted, column, row).into()));
        Move::To(stroke.position).write(bytes);
    }
    match stroke.form {
        BlockForm::AsWanted => write_glyph(wanted, cell, bytes),
        BlockForm::Flipped => write_char(other_half_block(cell).unwrap_or(' '), bytes),
    }
}

/// The form in which a half-block cell is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BlockForm {
    /// The cell is written with the glyph of the wanted grid.
    AsWanted,
    /// The cell is written with the other half block and exchanged colours, and looks the same.
    Flipped,
}

impl BlockForm {
    /// Returns the pen that writes `cell` in this form, given the pen `before` it.
    fn pen(self, cell: PackedCell, before: &Pen) -> Pen {
        let plain = before.pen_for(cell);
        match self {
            Self::AsWanted => plain,
            Self::Flipped => swapped_colors(plain),
        }
    }
}

/// Returns the pen with glyph and background colours exchanged, for the other half block.
fn swapped_colors(pen: Pen) -> Pen {
    Pen { fg: pen.bg, bg: pen.fg, ..pen }
}

fn other_half_block(cell: PackedCell) -> Option<char> {
    match cell.character()? {
        '▄' => Some('▀'),
        '▀' => Some('▄'),
        _ => None,
    }
}

/// Returns whether a cell looks the same with the other half block and exchanged colours.
// Default colours cannot be exchanged: no sequence sets the default background as a glyph colour, or the default glyph
// colour as a background.
fn can_be_flipped(cell: PackedCell) -> bool {
    other_half_block(cell).is_some()
        && cell.attributes().is_empty()
        && cell.fg != PackedInk::DEFAULT
        && cell.bg != PackedInk::DEFAULT
}

/// The cheapest path to one form of a cell: the pen after it, and the cost so far.
#[derive(Clone, Copy)]
struct SurvivorPath {
    pen: Pen,
    cost: PathCost,
}

/// The cost of a path: [`COST_PER_BYTE`] for each byte, plus one for each lower half block.
// Of two paths with equally many bytes, the one with more upper half blocks is taken. Any fixed rule makes consecutive
// frames compress well; this one sends the two colours of a cell in the order of its pixels.
type PathCost = u64;

/// The cost of a byte. It exceeds the number of cells in a grid, so that lower half blocks only
/// break ties.
const COST_PER_BYTE: PathCost = 1 << 32;

/// Extends both paths by a cell that is written with `pen`.
///
/// `bytes` are those of the change of the pen from each path. Returns the cheaper path and its index, 0 or 1.
#[inline]
fn cheaper_path(paths: &[SurvivorPath; 2], bytes: [usize; 2], pen: Pen, is_lower: bool) -> (SurvivorPath, u8) {
    let cost = |path: usize| paths[path].cost + bytes[path] as PathCost * COST_PER_BYTE + PathCost::from(is_lower);
    let (first, second) = (cost(0), cost(1));
    let is_second = second < first;
    (SurvivorPath { pen, cost: if is_second { second } else { first } }, is_second.into())
}

/// Extends both paths by a cell, written with `pens`. Returns the cheaper one and its index, 0 or
/// 1.
fn cheaper_extension(
    paths: &[SurvivorPath; 2],
    pens: [Pen; 2],
    lens: [usize; 2],
    is_lower: bool,
) -> (SurvivorPath, u8) {
    let [first, second] = [paths[0].extended(pens[0], lens, is_lower), paths[1].extended(pens[1], lens, is_lower)];
    if second.cost < first.cost { (second, 1) } else { (first, 0) }
}

impl SurvivorPath {
    /// Returns the path extended by a cell that is written with `pen`.
    // Always inlined, as `cost_of_colors` is: a call would copy pens through memory.
    #[inline(always)]
    fn extended(&self, pen: Pen, lens: [usize; 2], is_lower: bool) -> Self {
        Self {
            pen,
            cost: self.cost
                + self.pen.switch_cost_with_lens(&pen, lens) as PathCost * COST_PER_BYTE
                + PathCost::from(is_lower),
        }
    }
}

/// Moves the cursor to a cell: by the cheapest sequence, or by writing the cells between again.
// Writing the cells again is possible if the pen fits all of them, and chosen if it takes no more bytes than the
// sequence. At equal length it compresses better, as a longer run of one glyph.
fn move_to(
    wanted: &Grid,
    cursor: KnownCursor,
    position: CellPosition,
    half_blocks: HalfBlocks,
    pen: &Pen,
    bytes: &mut Vec<u8>,
) {
    if cursor == KnownCursor::At(position) {
        return;
    }
    let by_move = cheapest_move(cursor, position);
    let start = bytes.len();
    let is_there = columns_between(cursor, position).is_some_and(|mut between| {
        between.all(|column| {
            let character = char_shown_by_pen(wanted.packed_cell(column, position.row), half_blocks, pen);
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

/// Returns the columns from the cursor up to a cell further right in the same row; `None` for other
/// cells.
fn columns_between(cursor: KnownCursor, position: CellPosition) -> Option<Range<u16>> {
    let cursor = cursor.position().filter(|cursor| cursor.row == position.row && cursor.column < position.column)?;
    Some(cursor.column..position.column)
}

/// Returns the character that shows a cell if it is written with `pen` unchanged; `None` if there
/// is none.
// Only ASCII and half blocks are considered: other glyphs take more bytes than a move, or more than one column.
fn char_shown_by_pen(cell: PackedCell, half_blocks: HalfBlocks, pen: &Pen) -> Option<char> {
    let shows = |form: BlockForm| form.pen(cell, pen) == *pen;
    match (cell.character(), other_half_block(cell)) {
        (_, Some(other)) if half_blocks == HalfBlocks::Either && can_be_flipped(cell) && shows(BlockForm::Flipped) => {
            Some(other)
        }
        (Some(own), other) if (other.is_some() || own.is_ascii()) && shows(BlockForm::AsWanted) => Some(own),
        _ => None,
    }
}

/// Returns the cursor after writing a cell.
// After a cluster it may be anywhere: terminals disagree on the width of flags, families and letters with marks. After
// the last column some terminals have it in that column, others behind it.
pub(super) fn cursor_after(wanted: &Grid, position: CellPosition) -> KnownCursor {
    if wanted.packed_cell(position.column, position.row).is_cluster() {
        return KnownCursor::Unknown;
    }
    let column = position.column + widths::width_at(wanted, position.column, position.row);
    if column < wanted.size().columns {
        KnownCursor::At(CellPosition { column, ..position })
    } else {
        KnownCursor::InRow(position.row)
    }
}
