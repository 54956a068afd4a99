//! The cells to write so that one grid becomes another.

use super::moves::CellPosition;
use super::{pen, widths};
use crate::grid::{Grid, PackedCell};

/// Makes `shown` equal to `wanted`, and lists the cells to write, row by row.
///
/// Cells that a wide glyph covers, and foreign cells, are never written.
// The grid is updated in place, which saves copying it for each frame.
pub(super) fn update_grid(shown: &mut Grid, wanted: &Grid, changed: &mut Vec<CellPosition>) {
    changed.clear();
    let columns = usize::from(wanted.size().columns);
    for row in 0..wanted.size().rows {
        let start = usize::from(row) * columns;
        let of_wanted = &wanted.packed()[start..start + columns];
        // Packed cells refer to clusters by number, and each grid has its own numbers: equal cells may have different
        // texts.
        if shown.packed()[start..start + columns] != *of_wanted || of_wanted.iter().any(|cell| cell.is_cluster()) {
            update_row(shown, wanted, start, columns, |column| changed.push(CellPosition { column, row }));
        }
    }
}

/// Makes the row from the index `start` equal in both grids, and calls `write` with the column of
/// each glyph to write.
// The cells after a grapheme cluster are written again with it, because a terminal that shows the cluster's characters
// one by one overwrites them.
fn update_row(shown: &mut Grid, wanted: &Grid, start: usize, columns: usize, mut write: impl FnMut(u16)) {
    let mut safe_from = 0;
    let mut column = 0;
    let row = &wanted.packed()[start..start + columns];
    while column < columns {
        let (own, other) = (shown.packed()[start + column], row[column]);
        let is_ours = !other.is_covered() && !other.is_foreign();
        // The common case first: characters of one column, as in pictures.
        if row.get(column + 1).is_none_or(|next| !next.is_covered()) && !own.is_cluster() && !other.is_cluster() {
            let is_overwritten = column < safe_from;
            if is_ours && (is_overwritten || own != other) {
                shown.set_packed(start + column, other);
                if is_overwritten || !pen::look_alike(own, other) {
                    write(column as u16);
                }
            }
            column += 1;
            continue;
        }
        let end = column + widths::leading_width(&row[column..]);
        let cells = || (column..end).map(|column| (start + column, shown.packed()[start + column], row[column]));
        let is_same = cells().all(|(_, own, other)| shown.is_same(own, wanted, other));
        if is_ours && (column < safe_from || !is_same) {
            let looks_alike = cells().all(|(_, own, other)| look_alike(shown, own, wanted, other));
            // Updated even if both look alike, because cells also record whether they are text, as a panel's blank is,
            // or picture.
            (column..end).for_each(|column| shown.copy_cell(start + column, wanted, row[column]));
            if !looks_alike || column < safe_from {
                write(column as u16);
                if let Some(text) = wanted.cluster(other) {
                    safe_from = safe_from.max(column + widths::max_cluster_width(text));
                }
            }
        }
        column = end;
    }
}

/// Returns whether the cells of two grids look the same in every terminal.
fn look_alike(shown: &Grid, own: PackedCell, wanted: &Grid, other: PackedCell) -> bool {
    if own.is_cluster() || other.is_cluster() {
        return shown.cluster(own) == wanted.cluster(other) && pen::look_alike(own, other.with_glyph_of(own));
    }
    pen::look_alike(own, other)
}
