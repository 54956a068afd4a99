//! The test card: a circle, a gradient, and stripes of half cells; and what to set where one is wrong.

use termtrace::internals::capabilities::{Capabilities, HalfBlocks};
use termtrace::internals::cell;
use termtrace::{Cell, Colors, Grid, LinearRgb, Painter, Picture, Size, Srgb8, export};

/// With the report, all of it is on a screen of 24 rows.
const ROWS: u16 = 8;
/// Where the parts begin, in columns, and where the last ends. What lies between them stays black.
const GRADIENT: u16 = 24;
const STRIPES: u16 = 50;
const COLUMNS: u16 = 70;
/// Between parts.
const GAP: u16 = 2;

pub(super) fn bytes(capabilities: &Capabilities) -> Vec<u8> {
    let grid = grid(capabilities);
    let mut bytes = export::ansi_or_text(&grid, capabilities.cell_mode.colors);
    bytes.extend_from_slice(advice(capabilities).as_bytes());
    bytes
}

fn advice(capabilities: &Capabilities) -> String {
    let stripes = if capabilities.cell_mode.glyphs.has_blocks() {
        "The stripes must be even and straight; else set --glyphs=shape"
    } else {
        "No half blocks are used here;          for them set --glyphs=half"
    };
    let gradient = match capabilities.cell_mode.colors {
        Colors::Truecolor => "The gradient must be smooth;           else set --color=256, 16 or never",
        _ => "The gradient is of few colours here;   for all set --color=truecolor",
    };
    format!(
        "The circle must be round;              else set --cell-aspect (it is {:.2} here)\n\
         {gradient}\n\
         {stripes}\n",
        capabilities.cell_aspect
    )
}

fn grid(capabilities: &Capabilities) -> Grid {
    let mut painter = Painter::new(capabilities.cell_mode).with_light_background(capabilities.light_background);
    let mut grid = painter.grid(&picture(capabilities));
    // As in the live view, where the halves are said to meet.
    if capabilities.half_blocks == HalfBlocks::Either {
        let is_upper = |column: usize| column >= usize::from(STRIPES) && column % 2 == 1;
        for row in grid.rows_mut() {
            row.iter_mut()
                .enumerate()
                .filter(|(column, _)| is_upper(*column))
                .for_each(|(_, cell)| use_upper_half(cell));
        }
    }
    grid
}

/// The same halves by the other block.
fn use_upper_half(cell: &mut Cell) {
    if cell.glyph == '▄' {
        *cell = Cell::new('▀', cell.bg, cell.fg);
    }
}

fn picture(capabilities: &Capabilities) -> Picture {
    let mode = capabilities.cell_mode;
    let resolution = cell::resolution(mode, Size::new(COLUMNS, ROWS), capabilities.cell_aspect)
        .expect("the card is small, and the aspect was checked");
    let (across, down) = mode.pixels_per_cell();
    let pixels = (0..resolution.height()).flat_map(|y| (0..resolution.width()).map(move |x| (x, y)));
    let color = |(x, y): (u32, u32)| {
        let at = CardPoint {
            column: (x as f32 + 0.5) / across as f32,
            row: (y as f32 + 0.5) / down as f32,
            pixel: (1.0 / across as f32, 1.0 / down as f32),
        };
        at.color(capabilities.cell_aspect)
    };
    let pixels = pixels.map(color).collect();
    Picture::from_pixels(resolution.width(), resolution.height(), pixels).expect("a pixel for each place")
}

/// A place on the card, in cells, and the size of a pixel.
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
            self.disc(cell_aspect)
        } else if (gradient..stripes - gap).contains(&self.column) {
            self.shade((self.column - gradient) / (stripes - gap - gradient))
        } else if (stripes..end).contains(&self.column) {
            self.stripe()
        } else {
            Srgb8::new(0, 0, 0)
        }
    }

    /// A disc as large as its part, with its edge smoothed.
    fn disc(&self, cell_aspect: f32) -> Srgb8 {
        let (width, height) = (f32::from(GRADIENT - GAP), f32::from(ROWS) * cell_aspect);
        // All lengths are in widths of a cell.
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

    /// Small steps from one pixel to the next: few colours show as bands.
    fn shade(&self, along: f32) -> Srgb8 {
        let down = self.row / f32::from(ROWS);
        Srgb8::new((50.0 + 110.0 * along) as u8, (70.0 + 80.0 * down) as u8, (150.0 - 90.0 * along) as u8)
    }

    /// Half cells, light and dark in turns.
    fn stripe(&self) -> Srgb8 {
        let level = if ((self.row * 2.0) as u32).is_multiple_of(2) { 40 } else { 230 };
        Srgb8::new(level, level, level)
    }
}
