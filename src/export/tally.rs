//! Export of the number of occurrences of each character: a format that exists in tests only.
//!
//! It shows that a file and a row of the table suffice to add a format.

use super::difference;
use super::format_row::{FileEncoder, FormatRow};
use crate::grid::Grid;
use std::collections::BTreeMap;
use std::fmt::Write;

pub(super) const KIND: FormatRow = FormatRow {
    name: "tally",
    help: "How often each character is there",
    extensions: &["tally", "tal"],
    key: 'x',
    command: "WriteTally",
    title: "tally",
    file_encoder: FileEncoder::Cells {
        has_colors: false,
        is_on_black: false,
        write: |grid, _, _, _| tally(grid).into_bytes(),
    },
    difference: difference::by_rows,
};

fn tally(grid: &Grid) -> String {
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    grid.cells().for_each(|cell| *counts.entry(cell.glyph.to_string()).or_default() += 1);
    counts.iter().fold(String::new(), |mut text, (glyph, count)| {
        let _ = writeln!(text, "{glyph} {count}");
        text
    })
}
