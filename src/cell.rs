//! Picture -> cell grid.

use crate::capabilities::CellMode;
use crate::framebuffer::Resolution;
use crate::grid::{Grid, Size};
use crate::tone::Picture;

mod half;
mod ramp;

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

/// The cells that show the picture; at its lower edge a cell may be filled only in part.
///
/// # Panics
/// If the picture needs more than 65,535 columns or rows.
pub fn grid_from_picture(mode: CellMode, picture: &Picture) -> Grid {
    let (across, down) = mode.pixels_per_cell();
    let cells = |pixels: u32, per_cell| {
        u16::try_from(pixels.div_ceil(per_cell)).expect("a grid has at most 65,535 columns and rows")
    };
    let mut grid = Grid::new(Size::new(cells(picture.width, across), cells(picture.height, down)));
    match mode {
        CellMode::HalfBlock => half::fill(&mut grid, picture),
        CellMode::Ramp => ramp::fill(&mut grid, picture),
    }
    grid
}

/// The two pixels of a cell, upper and lower; there is no lower one below the picture's edge.
fn pixel_pair(picture: &Picture, column: u16, row: u16) -> (crate::color::Srgb8, Option<crate::color::Srgb8>) {
    let width = picture.width as usize;
    let upper = usize::from(row) * 2 * width + usize::from(column);
    (picture.pixels[upper], picture.pixels.get(upper + width).copied())
}
