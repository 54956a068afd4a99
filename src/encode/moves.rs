//! The cheapest move of the cursor from one cell to another.
//!
//! CUP sets row and column; CUF goes right, CHA to a column, CR to the first column, BS one column left, LF one row
//! down. In raw mode a line feed keeps the column, and it is only used above the last row, so that nothing scrolls.
//! REP, ECH and tabs are not used: they save little, and each of them fails in some multiplexer.

use super::numbers::{digit_count, write_number};

/// The column and row of a cell or the cursor, counted from 0 at the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CellPosition {
    pub(super) column: u16,
    pub(super) row: u16,
}

/// The known part of the cursor's position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum KnownCursor {
    /// The cursor may be anywhere.
    #[default]
    Unknown,
    /// The cursor is in a row, in a column that depends on the terminal.
    InRow(u16),
    /// The cursor is at a cell.
    At(CellPosition),
}

impl KnownCursor {
    /// Returns the cursor's position, if it is known.
    pub(super) fn position(self) -> Option<CellPosition> {
        if let Self::At(position) = self { Some(position) } else { None }
    }

    /// Returns the cursor's row, if it is known.
    pub(super) fn row(self) -> Option<u16> {
        self.row_and_column().map(|(row, _)| row)
    }

    /// Returns the cursor's row and column, as far as they are known.
    #[inline]
    fn row_and_column(self) -> Option<(u16, Option<u16>)> {
        match self {
            Self::Unknown => None,
            Self::InRow(row) => Some((row, None)),
            Self::At(CellPosition { column, row }) => Some((row, Some(column))),
        }
    }
}

/// A sequence that moves the cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Move {
    /// Moves to a cell by its column and row (CUP).
    To(CellPosition),
    /// Moves along the row, then down by a number of rows (an LF each).
    Down(u16, AlongRow),
}

/// A move along a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AlongRow {
    /// Stays in the column.
    Stay,
    /// Moves right by a number of columns (CUF).
    Right(u16),
    /// Moves left by a number of columns (a BS each).
    Left(u16),
    /// Moves to the first column (CR).
    Start,
    /// Moves to a column by its number (CHA).
    Column(u16),
}

/// Returns the move with the fewest bytes.
pub(super) fn cheapest_move(from: KnownCursor, to: CellPosition) -> Move {
    if from == KnownCursor::At(to) {
        return Move::Down(0, AlongRow::Stay);
    }
    // From an unknown position, only CUP is certain. Upwards, CUU would save at most a byte.
    let absolute = Move::To(to);
    let Some((row, column)) = from.row_and_column().filter(|&(row, _)| row <= to.row) else { return absolute };
    let relative = Move::Down(to.row - row, cheapest_along_row(column, to.column));
    if relative.len() <= absolute.len() { relative } else { absolute }
}

/// Returns the number of bytes of the cheapest move, given those of an absolute one.
#[inline]
pub(super) fn cheapest_len(from: KnownCursor, to: CellPosition, absolute: usize) -> usize {
    let Some((row, column)) = from.row_and_column() else { return absolute };
    // For rows upwards, which only an absolute move reaches, the difference wraps around to a large number.
    let rows = usize::from(to.row.wrapping_sub(row));
    if rows >= absolute {
        return absolute;
    }
    absolute.min(rows + cheapest_along_row(column, to.column).len())
}

#[inline]
fn cheapest_along_row(from: Option<u16>, to: u16) -> AlongRow {
    // CR and CHA are certain in any column.
    let Some(from) = from else { return if to == 0 { AlongRow::Start } else { AlongRow::Column(to) } };
    if to == from {
        AlongRow::Stay
    } else if to > from {
        AlongRow::Right(to - from)
    } else if to == 0 {
        AlongRow::Start
    } else if usize::from(from - to) <= AlongRow::Column(to).len() {
        AlongRow::Left(from - to)
    } else {
        AlongRow::Column(to)
    }
}

impl Move {
    /// Returns the length of the move's sequence in bytes.
    #[inline]
    pub(super) fn len(self) -> usize {
        match self {
            Self::To(CellPosition { column: 0, row: 0 }) => 3,
            Self::To(CellPosition { column: 0, row }) => 3 + digit_count(row + 1),
            Self::To(CellPosition { column, row }) => 4 + digit_count(row + 1) + digit_count(column + 1),
            Self::Down(rows, along) => usize::from(rows) + along.len(),
        }
    }

    /// Appends to `bytes` the escape sequence or line feeds that move the cursor.
    pub(super) fn write(self, bytes: &mut Vec<u8>) {
        match self {
            Self::To(CellPosition { column: 0, row: 0 }) => bytes.extend_from_slice(b"\x1b[H"),
            Self::To(CellPosition { column: 0, row }) => write_sequence(bytes, row + 1, b'H'),
            Self::To(CellPosition { column, row }) => {
                bytes.extend_from_slice(b"\x1b[");
                write_number(row + 1, bytes);
                bytes.push(b';');
                write_number(column + 1, bytes);
                bytes.push(b'H');
            }
            Self::Down(rows, along) => {
                // The column first: from beyond the last one only CR and CHA are certain, not LF.
                along.write(bytes);
                // Few rows: filling a slice takes longer.
                (0..rows).for_each(|_| bytes.push(b'\n'));
            }
        }
    }
}

impl AlongRow {
    #[inline]
    fn len(self) -> usize {
        match self {
            Self::Stay => 0,
            Self::Start | Self::Left(1) => 1,
            Self::Right(1) => 3,
            Self::Left(columns) => columns.into(),
            Self::Right(columns) => 3 + digit_count(columns),
            Self::Column(column) => 3 + digit_count(column + 1),
        }
    }

    fn write(self, bytes: &mut Vec<u8>) {
        match self {
            Self::Stay => {}
            Self::Start => bytes.push(b'\r'),
            Self::Left(columns) => (0..columns).for_each(|_| bytes.push(b'\x08')),
            Self::Right(1) => bytes.extend_from_slice(b"\x1b[C"),
            Self::Right(columns) => write_sequence(bytes, columns, b'C'),
            Self::Column(column) => write_sequence(bytes, column + 1, b'G'),
        }
    }
}

/// Appends a CSI sequence with the parameter `number` and the final byte `last`.
pub(super) fn write_sequence(bytes: &mut Vec<u8>, number: u16, last: u8) {
    bytes.extend_from_slice(b"\x1b[");
    write_number(number, bytes);
    bytes.push(last);
}

#[cfg(all(test, unit_tests))]
mod tests;
