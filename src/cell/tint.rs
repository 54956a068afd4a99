//! Colours of characters: a cell's glyph shows its brightness, and the glyph's colour its hue and
//! saturation.

use super::ink_converter::InkConverter;
use crate::color::{LinearRgb, Srgb8};
use crate::grid::Grid;
use crate::tone::Picture;

/// Returns the picture with each pixel replaced by the grey of its brightest channel.
// The glyph's colour has its brightest channel at 255, so the glyph's ink has to supply that channel's brightness.
// Chosen by luminance, glyphs for saturated blue would have hardly any ink.
pub(super) fn grey_by_brightest_channel(picture: &Picture) -> Picture {
    let grey = |pixel: &Srgb8| {
        let brightest = pixel.r.max(pixel.g).max(pixel.b);
        Srgb8::new(brightest, brightest, brightest)
    };
    picture.map_colors(grey)
}

/// Colours each cell's character by its pixels' mean light at full brightness, on black.
pub(super) fn color_glyphs(grid: &mut Grid, picture: &Picture, pixels_per_cell: (u32, u32), inks: &mut InkConverter) {
    for row in 0..grid.size().rows {
        for column in 0..grid.size().columns {
            let color = scaled_to_brightness(cell_mean(picture, pixels_per_cell, column, row), 255);
            let mut cell = grid.cell_mut(column, row);
            cell.bg = inks.background();
            // Blanks keep their colour, because it is invisible and each change of colour takes bytes.
            if cell.glyph != ' ' {
                cell.fg = inks.flat_ink(color);
            }
        }
    }
}

/// Returns the mean of a cell's pixels, taken in linear light.
pub(super) fn cell_mean(picture: &Picture, (across, down): (u32, u32), column: u16, row: u16) -> Srgb8 {
    let (left, top) = (u32::from(column) * across, u32::from(row) * down);
    let (right, bottom) = ((left + across).min(picture.width()), (top + down).min(picture.height()));
    let mut light = LinearRgb::BLACK;
    for y in top..bottom {
        for x in left..right {
            light += LinearRgb::from_srgb8(picture.pixels()[y as usize * picture.width() as usize + x as usize]);
        }
    }
    Srgb8::from_linear(light * (1.0 / ((right - left) * (bottom - top)) as f32))
}

/// Scales a colour so that its brightest channel is `brightness`; black stays black.
pub(super) fn scaled_to_brightness(color: Srgb8, brightness: u8) -> Srgb8 {
    // At least 1, because black has no channel to divide by.
    let max = u32::from(color.r.max(color.g).max(color.b).max(1));
    let scaled = |channel: u8| (u32::from(channel) * u32::from(brightness) / max) as u8; // no channel exceeds `max`
    Srgb8::new(scaled(color.r), scaled(color.g), scaled(color.b))
}
