//! Export of a grid as SVG.

use super::difference;
use super::format_row::{FileEncoder, FormatRow};
use super::paint::{DEFAULT_TEXT, hex, svg_paths, text_runs};
use crate::grid::{Grid, Size};
use std::fmt::Write;

pub(super) const KIND: FormatRow = FormatRow {
    name: "svg",
    help: "Cells as a drawing, one rectangle per half cell",
    extensions: &["svg"],
    key: 's',
    command: "WriteSvg",
    title: "SVG drawing",
    file_encoder: FileEncoder::Cells {
        has_colors: true,
        is_on_black: true,
        write: |grid, _, aspect, _| svg(grid, aspect).into_bytes(),
    },
    difference: difference::by_rows,
};

/// The width of a cell in units of the SVG drawing.
const CELL_WIDTH: f64 = 10.0;

/// The width of a character divided by the font size, in most monospace fonts.
const FONT_ADVANCE: f64 = 0.6;

/// Returns the grid as an SVG drawing without scripts, fonts or references.
///
/// Cells are 10 units wide and `cell_aspect` times as high. Block characters are rectangles, half blocks merged where
/// they are equal; characters are text. Default colours are light on dark, palette colours those of xterm.
///
/// ```
/// use termtrace::export::svg;
/// use termtrace::{Cell, Grid, Ink, Size};
///
/// let mut grid = Grid::new(Size::new(2, 1));
/// *grid.get_mut(0, 0).ok_or("inside the grid")? = Cell::new('▀', Ink::Indexed(196), Ink::Indexed(21));
/// assert!(svg(&grid, 2.0).contains(r##"<path fill="#ff0000" d="M0 0h1v1h-1"/>"##));
/// # Ok::<(), &str>(())
/// ```
pub fn svg(grid: &Grid, cell_aspect: f32) -> String {
    let Size { columns, rows } = grid.size();
    let cell_height = CELL_WIDTH * f64::from(cell_aspect);
    let (width, height) = (rounded(CELL_WIDTH * f64::from(columns)), rounded(cell_height * f64::from(rows)));
    // The unit of the paths is a column by half a row, in which half blocks have whole coordinates.
    let half = rounded(0.5 * cell_height);
    let mut svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">
<g transform="scale({CELL_WIDTH} {half})" shape-rendering="crispEdges">
{}</g>
"#,
        svg_paths(grid)
    );
    svg.push_str(&text_elements(grid, cell_height));
    svg.push_str("</svg>\n");
    svg
}

/// Returns the SVG elements of the grid's text; empty if there is no text.
fn text_elements(grid: &Grid, cell_height: f64) -> String {
    // If cells are low, the font size is limited by their height, so that lines do not overlap.
    let font_size = (CELL_WIDTH / FONT_ADVANCE).min(0.85 * cell_height);
    let mut lines = String::new();
    for (row, cells) in grid.rows().enumerate() {
        // The baseline is a third of the font size below the cell's middle, because capital letters are about two
        // thirds of the font size high.
        let y = rounded((row as f64 + 0.5) * cell_height + font_size / 3.0);
        // `textLength` makes each run as wide as its cells, whatever font the viewer uses.
        for run in text_runs(cells) {
            let (x, length) = (CELL_WIDTH * run.column as f64, CELL_WIDTH * run.columns as f64);
            let style = Some(run.css("fill")).filter(|css| !css.is_empty());
            let style = style.map(|css| format!(r#" style="{css}""#)).unwrap_or_default();
            let _ = writeln!(lines, r#"<text x="{x}" y="{y}" textLength="{length}"{style}>{}</text>"#, run.escaped());
        }
    }
    if lines.is_empty() {
        return lines;
    }
    let (font_size, fill) = (rounded(font_size), hex(DEFAULT_TEXT));
    format!(
        "<g font-family=\"monospace\" font-size=\"{font_size}\" fill=\"{fill}\" xml:space=\"preserve\">\n{lines}</g>\n"
    )
}

/// Rounds a length to a thousandth of a unit.
// Differences below a thousandth are invisible. Rounding keeps the numbers short, and the same on every machine.
fn rounded(value: f64) -> f64 {
    (1000.0 * value).round() / 1000.0
}
