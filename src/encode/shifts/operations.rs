//! The operations of a shift: ICH and DCH for cells of a row, IL and DL for rows.

use super::windows::Window;
use crate::encode::moves::{CellPosition, KnownCursor, Move, cheapest_move, write_sequence};
use crate::grid::Size;

/// Appends the operations of a window of a row: DCH and ICH, or one if it has the last column.
// A terminal that moves the cursor by an operation leaves it in the row, where CR or CHA finds any column.
pub(super) fn write_column_shift(row: usize, window: Window, size: Size, cursor: KnownCursor, bytes: &mut Vec<u8>) {
    let distance = window.by.unsigned_abs();
    let (delete, insert) = places(window);
    let (is_cut, is_last) = (window.by > 0, window.end == usize::from(size.columns));
    let row = row as u16;
    let position = |column: usize| CellPosition { column: column as u16, row };
    // An insertion in a window that ends with the row pushes cells off the screen: none has to be deleted first.
    if is_cut || !is_last {
        cheapest_move(cursor, position(delete)).write(bytes);
        write_operation(distance, b'P', bytes);
        if is_cut && is_last {
            return;
        }
        cheapest_move(KnownCursor::InRow(row), position(insert)).write(bytes);
    } else {
        cheapest_move(cursor, position(insert)).write(bytes);
    }
    write_operation(distance, b'@', bytes);
}

/// Appends the operations of a window of rows: DL and IL, or one if the window has the last row.
pub(super) fn write_row_shift(window: Window, size: Size, bytes: &mut Vec<u8>) {
    let distance = window.by.unsigned_abs();
    let (delete, insert) = places(window);
    let is_last = window.end == usize::from(size.rows);
    let to = |row: usize| Move::To(CellPosition { column: 0, row: row as u16 });
    if window.by > 0 || !is_last {
        to(delete).write(bytes);
        write_operation(distance, b'M', bytes);
    }
    if window.by < 0 || !is_last {
        to(insert).write(bytes);
        write_operation(distance, b'L', bytes);
    }
}

/// Returns the places at which a shift deletes, and then inserts.
fn places(Window { start, end, by, .. }: Window) -> (usize, usize) {
    let other = end - by.unsigned_abs();
    if by > 0 { (start, other) } else { (other, start) }
}

/// Appends the sequence that deletes or inserts a number of cells or rows.
fn write_operation(count: usize, last: u8, bytes: &mut Vec<u8>) {
    if count == 1 {
        bytes.extend_from_slice(&[b'\x1b', b'[', last]);
    } else {
        write_sequence(bytes, count as u16, last);
    }
}
