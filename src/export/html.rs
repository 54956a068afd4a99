//! Export of a grid as an HTML page.

use super::difference;
use super::format_row::{FileEncoder, FormatRow};
use super::paint::{escaped, svg_paths, text_runs};
use crate::grid::{Grid, Size};
use std::fmt::Write;

pub(super) const KIND: FormatRow = FormatRow {
    name: "html",
    help: "Cells as a web page",
    extensions: &["html", "htm"],
    key: 'h',
    command: "WriteHtml",
    title: "HTML page",
    file_encoder: FileEncoder::Cells {
        has_colors: true,
        is_on_black: true,
        write: |grid, _, aspect, name| page(grid, aspect, name).into_bytes(),
    },
    difference: difference::by_rows,
};

/// Returns the grid as an HTML page without scripts that loads no other files.
///
/// The page has the right shape in any font: cells are as wide as the font's characters, and `cell_aspect` times as
/// high. Characters are selectable text over an SVG of the backgrounds and half blocks, as in [`svg`](super::svg()).
///
/// ```
/// use termtrace::export::html;
/// use termtrace::{Cell, Grid, Ink, Size};
///
/// let mut grid = Grid::new(Size::new(2, 1));
/// *grid.get_mut(1, 0).ok_or("inside the grid")? = Cell::new('<', Ink::Default, Ink::Default);
/// assert!(html(&grid, 2.0).contains("<pre> &lt;\n</pre>"));
/// # Ok::<(), &str>(())
/// ```
pub fn html(grid: &Grid, cell_aspect: f32) -> String {
    page(grid, cell_aspect, "termtrace")
}

/// Returns the grid as an HTML page, in the middle of the window, with this title.
fn page(grid: &Grid, cell_aspect: f32, title: &str) -> String {
    let Size { columns, rows } = grid.size();
    // All lengths are multiples of the font's `ch`, so that the shape is right with any font and zoom.
    // A half block is the smallest area, so two units per row make all coordinates integers.
    let half_rows = 2 * u32::from(rows);
    // `pre` would ignore a line feed at its start, but the text starts with a grid's first row, which is never empty.
    let text = text(grid);
    let text = if text.trim().is_empty() { String::new() } else { format!("<pre>{text}</pre>\n") };
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<title>{}</title>
<style>
body{{margin:0;background:#000;color:#fff;font:16px monospace;display:grid;min-height:100vh;place-content:safe center}}
div{{position:relative;width:{columns}ch;height:calc({rows}ch*{cell_aspect})}}
svg,pre{{position:absolute;width:100%;height:100%;margin:0;font:inherit;line-height:calc(1ch*{cell_aspect})}}
</style>
<div>
<svg viewBox="0 0 {columns} {half_rows}" preserveAspectRatio="none" shape-rendering="crispEdges">
{}</svg>
{text}</div>
</html>
"#,
        escaped(title),
        svg_paths(grid)
    )
}

/// Returns the grid's text as HTML, row by row, without blanks at the ends of rows.
fn text(grid: &Grid) -> String {
    let mut text = String::new();
    for row in grid.rows() {
        let mut end = 0;
        for run in text_runs(row) {
            text.extend(std::iter::repeat_n(' ', run.column - end));
            let (css, escaped) = (run.css("color"), run.escaped());
            if css.is_empty() {
                text.push_str(&escaped);
            } else {
                let _ = write!(text, r#"<span style="{css}">{escaped}</span>"#);
            }
            end = run.column + run.columns;
        }
        text.push('\n');
    }
    text
}
