//! Grid -> ANSI: text with the escape sequences of its colours.

use super::kind::{Contents, Kind};
use super::text::text;
use crate::capabilities::Colors;
use crate::encode::Pen;
use crate::grid::{Glyph, Grid};
use std::fmt::Write;

pub(super) const KIND: Kind = Kind {
    name: "ansi",
    help: "Cells in colour",
    endings: &["ansi", "ans"],
    key: 'a',
    command: "WriteAnsi",
    title: "ANSI text in colour",
    contents: Contents::Cells { has_colors: true, write: |grid, colors, _| printed(grid, colors) },
    difference: |golden, file, _| difference(golden, file),
};

/// The grid as a terminal with those colours is to be sent it: without any, no escape sequence says anything of them.
pub fn printed(grid: &Grid, colors: Colors) -> Vec<u8> {
    match colors {
        Colors::None => text(grid).into_bytes(),
        _ => ansi(grid),
    }
}

/// The grid in colour, as lines that any program may print: no movement, and the terminal's own colours restored
/// at the end of each line.
pub fn ansi(grid: &Grid) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut pen = Pen::default();
    for row in grid.rows() {
        for cell in row.iter().filter(|cell| cell.glyph != Glyph::Covered) {
            pen.write_cell(cell, &mut bytes);
        }
        pen.reset(&mut bytes);
        bytes.push(b'\n');
    }
    bytes
}

/// The rows that differ, and where each begins to.
fn difference(golden: &[u8], frame: &[u8]) -> String {
    let rows = |bytes: &[u8]| -> Vec<Vec<u8>> { bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect() };
    let (golden, frame) = (rows(golden), rows(frame));
    let mut difference = String::new();
    for row in 0..golden.len().max(frame.len()) {
        let line = match (golden.get(row), frame.get(row)) {
            (Some(a), Some(b)) if a == b => continue,
            (Some(a), Some(b)) => format!("row {row}: differs from column {} on", column_of_difference(a, b)),
            (Some(_), None) => format!("row {row}: only in the golden frame"),
            _ => format!("row {row}: only in this frame"),
        };
        let _ = writeln!(difference, "{line}");
    }
    difference
}

/// How many characters, escape sequences not counted, stand before the first difference.
fn column_of_difference(a: &[u8], b: &[u8]) -> usize {
    let same = a.iter().zip(b).take_while(|(a, b)| a == b).count();
    // Characters may have their first bytes in common.
    let same = (0..=same).rfind(|&at| a.get(at).is_none_or(|byte| byte & 0xc0 != 0x80)).unwrap_or(0);
    let mut columns = 0;
    let mut in_escape = false;
    for &byte in &a[..same] {
        match byte {
            0x1b => in_escape = true,
            b'm' if in_escape => in_escape = false,
            // Only the first byte of each character counts.
            _ if !in_escape && byte & 0xc0 != 0x80 => columns += 1,
            _ => {}
        }
    }
    columns
}
