//! The appearance of a grid in SVG and HTML: areas of one colour, and the text over them.

use crate::cell::{BlockParts, block_parts, xterm_color};
use crate::color::Srgb8;
use crate::grid::{Attributes, Cell, Glyph, Grid, Ink};
use std::collections::HashMap;
use std::fmt::{self, Write};

/// The default glyph colour in exports, which assume light text on a dark background.
pub(super) const DEFAULT_TEXT: Srgb8 = Srgb8::new(255, 255, 255);
const DEFAULT_BACKGROUND: Srgb8 = Srgb8::new(0, 0, 0);

/// A rectangle of one colour, in columns from the left and half cells from the top.
struct ColorArea {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    color: Srgb8,
}

/// A run of text of one style in a row.
pub(super) struct TextRun {
    pub(super) column: usize,
    /// The width of the run in columns.
    pub(super) columns: usize,
    pub(super) text: String,
    color: Srgb8,
    attributes: Attributes,
}

impl TextRun {
    /// Returns the CSS of the run's style; `fill` is the property of the text's colour.
    pub(super) fn css(&self, fill: &str) -> String {
        let mut css = Vec::new();
        if self.color != DEFAULT_TEXT {
            css.push(format!("{fill}:{}", hex(self.color)));
        }
        let rules = [
            (Attributes::BOLD, "font-weight:bold"),
            (Attributes::ITALIC, "font-style:italic"),
            (Attributes::UNDERLINED, "text-decoration:underline"),
        ];
        css.extend(rules.iter().filter(|(one, _)| self.attributes.contains(*one)).map(|&(_, rule)| rule.to_owned()));
        css.join(";")
    }

    /// Returns the run's text with the special characters of SVG and HTML escaped.
    pub(super) fn escaped(&self) -> String {
        escaped(&self.text)
    }
}

/// Returns the text with the special characters of SVG and HTML escaped.
pub(super) fn escaped(text: &str) -> String {
    // Quotes stay, because the text is always the content of an element and never in an attribute.
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns the backgrounds and block characters as SVG paths, one per colour.
///
/// A unit is a column in width and half a cell in height.
pub(super) fn svg_paths(grid: &Grid) -> String {
    let mut halves = Paths::default();
    for ColorArea { x, y, width, height, color } in areas(grid) {
        let _ = write!(halves.outline(color), "M{x} {y}h{width}v{height}h-{width}");
    }
    // Block characters that fill parts of a cell lie over its background, so their paths come later.
    let mut parts = Paths::default();
    for (row, cells) in grid.rows().enumerate() {
        for (column, cell) in cells.enumerate() {
            if let Some(block) = fine_block(&cell) {
                write_block(parts.outline(cell_colors(&cell)[0]), column, row, block);
            }
        }
    }
    format!("{halves}{parts}")
}

/// The outlines of areas, by colour.
// One path per colour, because an element per area would repeat the colour in each.
#[derive(Default)]
struct Paths {
    indices: HashMap<Srgb8, usize>,
    outlines: Vec<(Srgb8, String)>,
}

impl Paths {
    /// Returns the outline of the areas of a colour, to append to.
    fn outline(&mut self, color: Srgb8) -> &mut String {
        let index = *self.indices.entry(color).or_insert_with(|| {
            self.outlines.push((color, String::new()));
            self.outlines.len() - 1
        });
        &mut self.outlines[index].1
    }
}

impl fmt::Display for Paths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.outlines.iter().try_for_each(|(color, outline)| {
            let color = hex(*color);
            writeln!(f, r#"<path fill="{color}" d="{outline}"/>"#)
        })
    }
}

/// Returns the parts that a block character other than a half or full block fills.
fn fine_block(cell: &Cell) -> Option<BlockParts> {
    match cell.glyph {
        Glyph::Char(' '..='~' | '▀' | '▄' | '█') => None,
        Glyph::Char(glyph) => block_parts(glyph),
        _ => None,
    }
}

/// Appends a rectangle for each run of filled parts in a row of parts.
fn write_block(
    outline: &mut String,
    column: usize,
    row: usize,
    BlockParts { parts: [across, down], mask }: BlockParts,
) {
    let unit = |at: usize, parts: usize, scale: f64| {
        let length = scale * at as f64 / parts as f64;
        // A third has infinitely many decimals. Three decimals of a column are finer than a pixel of the screen.
        (1000.0 * length).round() / 1000.0
    };
    for y in 0..down {
        let is_filled = |x: &usize| mask >> (y * across + x) & 1 == 1;
        let mut x = 0;
        while let Some(start) = (x..across).find(is_filled) {
            x = (start..across).find(|x| !is_filled(x)).unwrap_or(across);
            let [left, top] = [unit(across * column + start, across, 1.0), unit(down * row + y, down, 2.0)];
            let [width, height] = [unit(x - start, across, 1.0), unit(1, down, 2.0)];
            let _ = write!(outline, "M{left} {top}h{width}v{height}h-{width}");
        }
    }
}

/// Returns rectangles of equal colour: runs in each half row, merged with equal runs directly
/// above.
fn areas(grid: &Grid) -> Vec<ColorArea> {
    let mut areas: Vec<ColorArea> = Vec::new();
    // Only runs with the same columns and colour are merged, in one pass. Other merges would find few more rectangles
    // in pictures.
    let mut above: HashMap<(usize, usize, Srgb8), usize> = HashMap::new();
    let half_rows = grid.rows().flat_map(|row| {
        let colors: Vec<_> = row.map(|cell| half_colors(&cell)).collect();
        [0, 1].map(|half| colors.iter().map(|halves| halves[half]).collect::<Vec<_>>())
    });
    for (y, colors) in half_rows.enumerate() {
        let mut here = HashMap::new();
        let mut x = 0;
        for run in colors.chunk_by(|a, b| a == b) {
            let key = (x, run.len(), run[0]);
            let area = above.get(&key).copied().unwrap_or_else(|| {
                areas.push(ColorArea { x, y, width: run.len(), height: 0, color: run[0] });
                areas.len() - 1
            });
            areas[area].height += 1;
            here.insert(key, area);
            x += run.len();
        }
        above = here;
    }
    areas
}

/// Returns the colours of a cell's upper and lower half, with text left out.
fn half_colors(cell: &Cell) -> [Srgb8; 2] {
    let [fg, bg] = cell_colors(cell);
    match cell.glyph {
        Glyph::Char('▀') => [fg, bg],
        Glyph::Char('▄') => [bg, fg],
        // Block characters are drawn as areas, not as text, because fonts leave hairlines between them.
        Glyph::Char('█') => [fg, fg],
        _ => [bg, bg],
    }
}

/// Returns the colours of a cell's glyph and background.
fn cell_colors(cell: &Cell) -> [Srgb8; 2] {
    let (fg, bg) = (ink_color(cell.fg, DEFAULT_TEXT), ink_color(cell.bg, DEFAULT_BACKGROUND));
    if cell.attributes.contains(Attributes::REVERSED) { [bg, fg] } else { [fg, bg] }
}

fn ink_color(ink: Ink, default: Srgb8) -> Srgb8 {
    match ink {
        Ink::Default => default,
        Ink::Indexed(index) => xterm_color(index),
        Ink::Rgb(color) => color,
    }
}

/// Returns the text runs of a row. Blanks between texts of equal style belong to one run; other
/// blanks to none.
pub(super) fn text_runs(row: impl Iterator<Item = Cell>) -> Vec<TextRun> {
    let mut runs: Vec<TextRun> = Vec::new();
    for (column, cell) in row.enumerate() {
        let (color, attributes) = (cell_colors(&cell)[0], cell.attributes);
        // The cells that a wide character covers belong to its run.
        let Some(text) = text_of(&cell) else {
            if let Some(run) = runs.last_mut().filter(|run| cell.glyph == Glyph::Covered && run.end() == column) {
                run.columns += 1;
            }
            continue;
        };
        match runs.last_mut().filter(|run| (run.color, run.attributes) == (color, attributes)) {
            Some(run) => {
                run.text.extend(std::iter::repeat_n(' ', column - run.end()));
                run.text.push_str(&text);
                run.columns = column + 1 - run.column;
            }
            None => runs.push(TextRun { column, columns: 1, text, color, attributes }),
        }
    }
    runs
}

impl TextRun {
    fn end(&self) -> usize {
        self.column + self.columns
    }
}

/// Returns a cell's text; `None` for blanks and block characters, which are drawn as areas.
fn text_of(cell: &Cell) -> Option<String> {
    let underlined = cell.attributes.contains(Attributes::UNDERLINED);
    match cell.glyph {
        Glyph::Covered | Glyph::Foreign | Glyph::Char('▀' | '▄' | '█') => None,
        _ if fine_block(cell).is_some() => None,
        // An underlined blank is text, because its underline is visible.
        Glyph::Char(' ') if !underlined => None,
        _ => Some(cell.glyph.to_string()),
    }
}

pub(super) fn hex(Srgb8 { r, g, b }: Srgb8) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
