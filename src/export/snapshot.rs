//! Export of a grid as text for snapshot tests.

use super::text::text;
use crate::grid::{Attributes, Cell, Glyph, Grid, Ink};
use std::collections::HashMap;
use std::fmt::Write;

/// Returns the grid's characters in a frame, for snapshot tools that trim their input.
///
/// [insta](https://docs.rs/insta) is such a tool: a snapshot of [`text`](super::text()) loses the blank rows at its
/// end, and so its height.
///
/// ```
/// use termtrace::{CellMode, Scene, Size, export::framed, frame_grid};
///
/// let scene = Scene::from_ron("ball.ron", r##"(
///     camera: (eye: (0, 0, 4), target: (0, 0, 0)),
///     lights: [Point(position: (0, 0, 4), intensity: 10)],
///     objects: [Sphere(center: (0, 0, 0), radius: 1)],
/// )"##)?;
/// let grid = frame_grid(&scene, CellMode::RAMP, Size::new(12, 6), 2.0);
/// insta::assert_snapshot!(framed(&grid), @r"
/// 12x6
/// +------------+
/// |            |
/// |   :+==+:   |
/// |  :%#@@#%:  |
/// |  :%#@@#%:  |
/// |   :+==+:   |
/// |            |
/// +------------+
/// ");
/// # Ok::<(), termtrace::SceneError>(())
/// ```
pub fn framed(grid: &Grid) -> String {
    let mut out = size_line(grid);
    let border = border(usize::from(grid.size().columns));
    out.push_str(&border);
    for line in text(grid).lines() {
        let _ = writeln!(out, "|{line}|");
    }
    out.push_str(&border);
    out
}

/// Returns the grid's characters in a frame, the codes of their styles in another, and a legend.
///
/// All colours and attributes are contained, in a form that a person can review. A dot is the code of the default
/// style. Other codes are letters and digits in the order in which the styles first occur; with more than 62 styles,
/// codes have two or more characters.
///
/// ```
/// use ratatui::{buffer::Buffer, layout::Rect, style::Stylize, text::Line, widgets::Widget};
/// use termtrace::{Grid, Size, export::styled, lay_over};
///
/// let mut buffer = Buffer::empty(Rect::new(0, 0, 10, 2));
/// Line::from(vec!["ok".green().bold(), " or ".into(), "not".white().on_red()]).render(buffer.area, &mut buffer);
/// let mut grid = Grid::new(Size::new(10, 2));
/// lay_over(&mut grid, &buffer);
/// insta::assert_snapshot!(styled(&grid), @r"
/// 10x2
/// +----------+
/// |ok or not |
/// |          |
/// +----------+
/// |aa....bbb.|
/// |..........|
/// +----------+
/// a: color 2, bold
/// b: color 15 on color 1
/// ");
/// ```
pub fn styled(grid: &Grid) -> String {
    let mut out = framed(grid);
    let legend = Legend::of_grid(grid);
    for row in grid.rows() {
        let codes: String = row.map(|cell| legend.code(&cell)).collect();
        let _ = writeln!(out, "|{codes}|");
    }
    out.push_str(&border(usize::from(grid.size().columns) * legend.code_len));
    for (number, style) in legend.styles.iter().enumerate() {
        let _ = writeln!(out, "{}: {}", legend.style_code(number), style.description());
    }
    out
}

fn size_line(grid: &Grid) -> String {
    format!("{}x{}\n", grid.size().columns, grid.size().rows)
}

fn border(columns: usize) -> String {
    format!("+{}+\n", "-".repeat(columns))
}

/// The style of a cell: everything but its glyph, and whether that is [`Glyph::Foreign`].
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct CellStyle {
    fg: Ink,
    bg: Ink,
    underline: Ink,
    attributes: Attributes,
    is_foreign: bool,
}

impl CellStyle {
    fn of_cell(cell: &Cell) -> Self {
        let &Cell { fg, bg, underline, attributes, .. } = cell;
        Self { fg, bg, underline, attributes, is_foreign: cell.glyph == Glyph::Foreign }
    }

    fn is_plain(self) -> bool {
        self == Self::of_cell(&Cell::BLANK)
    }

    fn description(self) -> String {
        let mut words = match (self.fg, self.bg) {
            (fg, Ink::Default) => ink_name(fg),
            (fg, bg) => format!("{} on {}", ink_name(fg), ink_name(bg)),
        };
        for (attributes, name) in ATTRIBUTES {
            if self.attributes.contains(attributes) {
                let _ = write!(words, ", {name}");
            }
        }
        if self.underline != Ink::Default {
            let _ = write!(words, ", line in {}", ink_name(self.underline));
        }
        if self.is_foreign { words + ", left as it is" } else { words }
    }
}

/// The attributes and their names in a legend.
const ATTRIBUTES: [(Attributes, &str); 9] = [
    (Attributes::BOLD, "bold"),
    (Attributes::DIM, "dim"),
    (Attributes::ITALIC, "italic"),
    (Attributes::UNDERLINED, "underlined"),
    (Attributes::SLOW_BLINK, "slow blink"),
    (Attributes::RAPID_BLINK, "rapid blink"),
    (Attributes::REVERSED, "reversed"),
    (Attributes::HIDDEN, "hidden"),
    (Attributes::CROSSED_OUT, "crossed out"),
];

fn ink_name(ink: Ink) -> String {
    match ink {
        Ink::Default => "default".to_owned(),
        Ink::Indexed(index) => format!("color {index}"),
        Ink::Rgb(color) => format!("#{:02x}{:02x}{:02x}", color.r, color.g, color.b),
    }
}

/// The characters of style codes: letters and digits, which no snapshot tool escapes.
const CODE_LETTERS: &[u8; 62] = b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

/// The distinct styles of a grid, and their codes.
struct Legend {
    styles: Vec<CellStyle>,
    numbers: HashMap<CellStyle, usize>,
    /// The number of characters of each code.
    code_len: usize,
}

impl Legend {
    fn of_grid(grid: &Grid) -> Self {
        let (mut styles, mut numbers) = (Vec::new(), HashMap::new());
        for style in grid.cells().map(|cell| CellStyle::of_cell(&cell)).filter(|style| !style.is_plain()) {
            numbers.entry(style).or_insert_with(|| {
                styles.push(style);
                styles.len() - 1
            });
        }
        // All codes have the same length, so that columns stay aligned. Six characters suffice: a grid has fewer than
        // 62^6 cells.
        let code_len = (1..=6).find(|&code_len| CODE_LETTERS.len().pow(code_len) >= styles.len()).unwrap_or(6);
        Self { styles, numbers, code_len: code_len as usize }
    }

    fn code(&self, cell: &Cell) -> String {
        self.numbers
            .get(&CellStyle::of_cell(cell))
            .map_or_else(|| ".".repeat(self.code_len), |&number| self.style_code(number))
    }

    fn style_code(&self, style_number: usize) -> String {
        let digit = |digit_index: usize| {
            CODE_LETTERS[style_number / CODE_LETTERS.len().pow(digit_index as u32) % CODE_LETTERS.len()]
        };
        (0..self.code_len).rev().map(|digit_index| char::from(digit(digit_index))).collect()
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
