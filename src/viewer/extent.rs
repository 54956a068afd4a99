//! The part of a window that the picture covers: all of it, up to a limit on memory.

use crate::capabilities::CellMode;
use crate::grid::Size;
use crate::memory::{self, OutOfMemory};

/// Greatest number of pixels of a live picture.
///
/// This is 1,048,576 cells of half blocks or of the ramp, or 262,144 cells of shapes. Windows of real terminals have
/// less than a tenth of it: a 4K screen has 100,000 cells of 8 by 10 pixels. In a larger window the picture covers the
/// upper left part, in the window's shape, and the rest stays empty.
// The number is chosen to stay below 600 MB of memory: a picture of this size takes 490 MB at the peak, one of twice
// the size 770 MB (in truecolor, with a wipe or on a slow link). Without a limit, a window that claimed 65535x65535
// cells took 4.6 GB.
pub const MAX_PIXELS: u32 = 1 << 21;

/// Returns the size in cells of the part of the window that the picture covers, at the upper left.
pub(super) fn covered_size(window: Size, mode: CellMode) -> Size {
    let (across, down) = mode.pixels_per_cell();
    let (most, cells) = ((MAX_PIXELS / (across * down)) as usize, window.cell_count());
    if cells <= most {
        return window;
    }
    let scale = (most as f64 / cells as f64).sqrt();
    let scaled = |side: u16| (f64::from(side) * scale) as u16;
    Size::new(scaled(window.columns), scaled(window.rows))
}

/// Peak memory for a picture, its cells and its encoded bytes, in bytes per pixel.
// 232 bytes were measured and rounded up, to leave a margin.
const BYTES_PER_PIXEL: usize = 256;

/// Checks that there is memory to show pictures of this size.
///
/// # Errors
/// If there is not enough.
pub(super) fn check_memory(size: Size, mode: CellMode) -> Result<(), OutOfMemory> {
    let (across, down) = mode.pixels_per_cell();
    let pixels = size.cell_count() * (across * down) as usize;
    let Size { columns, rows } = size;
    memory::check(pixels * BYTES_PER_PIXEL)
        .map_err(|error| error.with_purpose(format!("for a picture of {columns}x{rows} cells")))
}

#[cfg(all(test, unit_tests))]
mod tests;
