//! Picture -> cell grid.

use crate::capabilities::{CellMode, Colors, Glyphs};
use crate::color::Srgb8;
use crate::framebuffer::Resolution;
use crate::grid::{Grid, Size};
use crate::tone::Picture;
use inks::Inks;

mod blue_noise;
mod half;
mod inks;
mod pair;
mod palette;
mod ramp;
mod shape;
mod tint;

pub use ramp::RAMP;

/// The resolution at which to render for a screen of that size whose cells have that aspect (height / width).
pub fn resolution(mode: CellMode, size: Size, cell_aspect: f32) -> Resolution {
    let (across, down) = mode.pixels_per_cell();
    Resolution {
        width: u32::from(size.columns) * across,
        height: u32::from(size.rows) * down,
        pixel_aspect: cell_aspect * across as f32 / down as f32,
    }
}

/// The cells that show the picture, as a new [`Painter`] paints them.
///
/// # Panics
/// If the picture needs more than 65,535 columns or rows.
pub fn grid_from_picture(mode: CellMode, picture: &Picture) -> Grid {
    Painter::new(mode).grid(picture)
}

/// Turns pictures into cells, and keeps what it has found out about few colours from frame to frame.
pub struct Painter {
    mode: CellMode,
    light_background: bool,
    inks: Inks,
}

impl Painter {
    /// For a terminal that writes light on dark, where it is asked to write in its own colours.
    pub fn new(mode: CellMode) -> Self {
        Self { mode, light_background: false, inks: Inks::of(mode.colors) }
    }

    /// Whether it writes dark on light instead: what is light is then left blank.
    pub fn with_light_background(self, light_background: bool) -> Self {
        Self { light_background, ..self }
    }

    /// How it turns pixels into cells.
    pub fn mode(&self) -> CellMode {
        self.mode
    }

    /// The cells that show the picture: a function of nothing else. At its right and lower edge a cell may be filled
    /// only in part.
    ///
    /// # Panics
    /// If the picture needs more than 65,535 columns or rows.
    pub fn grid(&mut self, picture: &Picture) -> Grid {
        let mut grid = Grid::new(Size::new(0, 0));
        self.paint(picture, &mut grid);
        grid
    }

    /// Makes a grid the one that [`grid`](Self::grid) returns, in the memory that it has.
    ///
    /// # Panics
    /// If the picture needs more than 65,535 columns or rows.
    pub fn paint(&mut self, picture: &Picture, grid: &mut Grid) {
        let pixels_per_cell = self.mode.pixels_per_cell();
        grid.clear(size_in_cells(picture, pixels_per_cell));
        if self.mode.colors == Colors::None {
            let negative = self.light_background.then(|| negative(picture));
            self.fill(grid, negative.as_ref().unwrap_or(picture));
        } else if self.mode.glyphs == Glyphs::Half {
            self.fill(grid, picture);
        } else {
            self.fill(grid, &tint::brightness(picture));
            tint::fill(grid, picture, pixels_per_cell, &mut self.inks);
        }
    }

    fn fill(&mut self, grid: &mut Grid, picture: &Picture) {
        match self.mode.glyphs {
            Glyphs::Half => half::fill(grid, picture, &mut self.inks),
            Glyphs::Shape => shape::fill(grid, picture),
            Glyphs::Ramp => ramp::fill(grid, picture),
        }
    }
}

fn size_in_cells(picture: &Picture, (across, down): (u32, u32)) -> Size {
    let cells = |pixels: u32, per_cell| {
        u16::try_from(pixels.div_ceil(per_cell)).expect("a grid has at most 65,535 columns and rows")
    };
    Size::new(cells(picture.width, across), cells(picture.height, down))
}

/// Dark where the picture is light.
fn negative(picture: &Picture) -> Picture {
    let turned = |pixel: &Srgb8| Srgb8::new(255 - pixel.r, 255 - pixel.g, 255 - pixel.b);
    Picture { pixels: picture.pixels.iter().map(turned).collect(), ..*picture }
}
