//! The test card: a circle, a gradient, stripes of half cells, and a disc for each kind of glyphs.
//!
//! Below it is advice on which flag to set if a part of the card looks wrong.

use std::fmt::Write;
use termtrace::internals::capabilities::{Capabilities, HalfBlocks, Hints};
use termtrace::internals::cell;
use termtrace::{Cell, CellMode, Colors, Glyphs, Grid, LinearRgb, Painter, Picture, Size, Srgb8, export};

/// Height of the card in cells. Card, advice and the report above them fit on a screen of 24 rows.
const ROWS: u16 = 5;
/// Height in cells of the discs that show the kinds of glyphs.
const SAMPLE_ROWS: u16 = 2;
/// The columns at which the gradient and the stripes start, and the width of the card. The circle
/// starts at column 0.
const GRADIENT: u16 = 24;
const STRIPES: u16 = 50;
const COLUMNS: u16 = 70;
/// Number of black columns between two parts of the card, which separate the circle's edge from the
/// gradient.
const GAP: u16 = 2;

/// Returns the bytes that draw the card, and the advice below it.
pub(super) fn bytes(capabilities: &Capabilities, hints: &Hints) -> Vec<u8> {
    let colors = capabilities.cell_mode.colors;
    let mut bytes = export::ansi_or_text(&grid(capabilities), colors);
    // Kinds that the locale cannot encode are left out, because they would be shown as other characters.
    let kinds: Vec<Glyphs> = Glyphs::ALL.iter().copied().filter(|&glyphs| hints.can_encode(glyphs)).collect();
    bytes.extend(export::ansi_or_text(&samples(&kinds, capabilities), colors));
    let mut names = String::new();
    for &kind in &kinds {
        let _ = write!(names, "{kind:width$}", width = usize::from(sample_width(kind)) + 1);
    }
    bytes.extend_from_slice(format!("{}\n", names.trim_end()).as_bytes());
    bytes.extend_from_slice(advice(capabilities).as_bytes());
    bytes
}

fn advice(capabilities: &Capabilities) -> String {
    let stripes = if capabilities.cell_mode.glyphs.has_blocks() {
        "Stripes uneven or crooked?       Set --glyphs=shape"
    } else {
        "No half blocks are used here.    To use them, set --glyphs=half"
    };
    let gradient = match capabilities.cell_mode.colors {
        Colors::Truecolor => "Gradient not smooth?             Set --color=256, 16 or never",
        _ => "The gradient has few colours.    To use all, set --color=truecolor",
    };
    format!(
        "Circle not round?                Set --cell-aspect (now {:.2})\n\
         {gradient}\n\
         {stripes}\n",
        capabilities.cell_aspect
    )
}

/// Returns the width in cells of the disc of a kind: at least that of its name below.
fn sample_width(glyphs: Glyphs) -> u16 {
    glyphs.name().len().max(6) as u16
}

/// Returns a row of discs, one drawn with each kind of glyphs, and an empty column after each.
fn samples(kinds: &[Glyphs], capabilities: &Capabilities) -> Grid {
    let &Capabilities { cell_aspect, cell_mode: CellMode { colors, .. }, light_background, .. } = capabilities;
    let mut samples = Grid::new(Size::new(kinds.iter().map(|&kind| sample_width(kind) + 1).sum(), SAMPLE_ROWS));
    let mut left = 0;
    for &glyphs in kinds {
        let (mode, size) = (CellMode { glyphs, colors }, Size::new(sample_width(glyphs), SAMPLE_ROWS));
        let disc = picture(mode, size, cell_aspect, |at| at.disc_color(size, cell_aspect));
        let sample = Painter::new(mode).with_light_background(light_background).grid(&disc);
        for (row, cells) in (0..).zip(sample.rows()) {
            for (column, cell) in (left..).zip(cells) {
                *samples.cell_mut(column, row) = cell;
            }
        }
        left += size.columns + 1;
    }
    samples
}

fn grid(capabilities: &Capabilities) -> Grid {
    let &Capabilities { cell_mode, cell_aspect, light_background, .. } = capabilities;
    let mut painter = Painter::new(cell_mode).with_light_background(light_background);
    let card = picture(cell_mode, Size::new(COLUMNS, ROWS), cell_aspect, |at| at.color(cell_aspect));
    let mut grid = painter.grid(&card);
    // The live view uses the upper half block too if the terminal's half blocks join without a seam. Every second
    // column of the stripes does the same here, so that a seam would show.
    if capabilities.half_blocks == HalfBlocks::Either {
        let is_upper = |column: usize| column >= usize::from(STRIPES) && column % 2 == 1;
        for at in (0..grid.cells().len()).filter(|at| is_upper(at % usize::from(COLUMNS))) {
            let cell = grid.at(at);
            grid.set_at(at, &with_upper_half(cell));
        }
    }
    grid
}

/// Returns a cell with an upper instead of a lower half block, and its colours exchanged.
///
/// It shows the same two halves.
fn with_upper_half(cell: Cell) -> Cell {
    if cell.glyph == '▄' { Cell::new('▀', cell.bg, cell.fg) } else { cell }
}

/// Returns a picture of `size` cells, whose pixels have the colours that `color` returns.
fn picture(mode: CellMode, size: Size, cell_aspect: f32, color: impl Fn(CardPoint) -> Srgb8) -> Picture {
    let resolution = cell::resolution(mode, size, cell_aspect).expect("the card is small, and the aspect was checked");
    let (across, down) = mode.pixels_per_cell();
    let pixels = (0..resolution.height()).flat_map(|y| (0..resolution.width()).map(move |x| (x, y)));
    let color = |(x, y): (u32, u32)| {
        color(CardPoint {
            column: (x as f32 + 0.5) / across as f32,
            row: (y as f32 + 0.5) / down as f32,
            pixel: (1.0 / across as f32, 1.0 / down as f32),
        })
    };
    let pixels = pixels.map(color).collect();
    Picture::from_pixels(resolution.width(), resolution.height(), pixels).expect("a pixel for each place")
}

/// A pixel of the card: the column and row of its centre and its size, all in cells.
struct CardPoint {
    column: f32,
    row: f32,
    pixel: (f32, f32),
}

impl CardPoint {
    fn color(&self, cell_aspect: f32) -> Srgb8 {
        let [gradient, stripes, end] = [GRADIENT, STRIPES, COLUMNS].map(f32::from);
        let gap = f32::from(GAP);
        if self.column < gradient - gap {
            self.disc_color(Size::new(GRADIENT - GAP, ROWS), cell_aspect)
        } else if (gradient..stripes - gap).contains(&self.column) {
            self.gradient_color((self.column - gradient) / (stripes - gap - gradient))
        } else if (stripes..end).contains(&self.column) {
            self.stripe_color()
        } else {
            Srgb8::new(0, 0, 0)
        }
    }

    /// Returns the colour of the pixel in a part of `size` cells with a disc.
    fn disc_color(&self, size: Size, cell_aspect: f32) -> Srgb8 {
        // All lengths here are in cell widths, as the disc must be round on the screen.
        let (width, height) = (f32::from(size.columns), f32::from(size.rows) * cell_aspect);
        // The edge is smoothed by 4 x 4 samples per pixel: jagged, it would not show whether the disc is round.
        let radius = 0.46 * width.min(height);
        let samples = (0..16).filter(|sample| {
            let within = |sample: u32| (sample as f32 + 0.5) / 4.0 - 0.5;
            let x = self.column + within(sample % 4) * self.pixel.0 - width / 2.0;
            let y = (self.row + within(sample / 4) * self.pixel.1) * cell_aspect - height / 2.0;
            x * x + y * y < radius * radius
        });
        let light = LinearRgb::grey(samples.count() as f32 / 16.0);
        Srgb8::from_linear(LinearRgb { g: light.g * 0.7, b: light.b * 0.3, ..light })
    }

    /// Returns the gradient's colour; `along` is 0 at its left end and 1 at the right. Its steps
    /// are so small that a terminal with few colours shows bands.
    fn gradient_color(&self, along: f32) -> Srgb8 {
        let down = self.row / f32::from(ROWS);
        Srgb8::new((50.0 + 110.0 * along) as u8, (70.0 + 80.0 * down) as u8, (150.0 - 90.0 * along) as u8)
    }

    /// Returns the colour of the stripes: each is half a cell high, alternately dark and light.
    fn stripe_color(&self) -> Srgb8 {
        let level = if ((self.row * 2.0) as u32).is_multiple_of(2) { 40 } else { 230 };
        Srgb8::new(level, level, level)
    }
}
