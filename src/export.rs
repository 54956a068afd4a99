//! Grid or picture -> a file's contents: plain text, ANSI, SVG, HTML, PNG.

mod html;
mod paint;
mod svg;

pub use html::html;
pub use svg::svg;

use crate::capabilities::{CellMode, USUAL_CELL_ASPECT};
use crate::cell;
use crate::encode::Pen;
use crate::grid::{Glyph, Grid, Size};
use crate::render::render;
use crate::scene::Scene;
use crate::tone::{Picture, tone};
use std::num::NonZeroU32;

/// What a file with a picture can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Its pixels: [`png()`].
    Png,
    /// Cells in colour, for terminals: [`ansi`].
    Ansi,
    /// Characters without colour: [`text`].
    Text,
    /// Cells as a drawing: [`svg()`].
    Svg,
    /// Cells as a web page: [`html()`].
    Html,
}

impl Format {
    /// How the names of such files end, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Ansi => "ansi",
            Self::Text => "txt",
            Self::Svg => "svg",
            Self::Html => "html",
        }
    }
}

/// The scene at that size as plain text, for snapshot tests: one ray through each pixel's centre, cells of the usual
/// aspect of 2, one line for each row, each with all its characters and a line feed.
///
/// ```
/// use termtrace::{export::text_frame, grid::Size, scene::Scene};
///
/// let scene = Scene::from_ron("ball.ron", r##"(
///     camera: (eye: (0, 0, 4), target: (0, 0, 0)),
///     lights: [Point(position: (0, 0, 4), intensity: 10)],
///     objects: [Sphere(center: (0, 0, 0), radius: 1)],
/// )"##).unwrap();
/// let rows = [
///     "            ",
///     "   -+**+-   ",
///     "  -#%@@%#-  ",
///     "  -#%@@%#-  ",
///     "   -+**+-   ",
///     "            ",
/// ];
/// assert_eq!(text_frame(&scene, Size::new(12, 6)), rows.map(|row| format!("{row}\n")).concat());
/// ```
pub fn text_frame(scene: &Scene, size: Size) -> String {
    text(&frame_grid(scene, CellMode::RAMP, size, USUAL_CELL_ASPECT))
}

/// The scene's own view as the cells of a screen of that size and cell aspect, one ray through each pixel's centre.
pub fn frame_grid(scene: &Scene, cell_mode: CellMode, size: Size, cell_aspect: f32) -> Grid {
    let resolution = cell::resolution(cell_mode, size, cell_aspect);
    let picture = tone(&render(scene, scene.camera(), resolution, NonZeroU32::MIN), scene);
    cell::grid_from_picture(cell_mode, &picture)
}

/// The grid's characters without colours: one line for each row, with all its trailing spaces.
pub fn text(grid: &Grid) -> String {
    let mut text = String::with_capacity(grid.cells().len() + usize::from(grid.size().rows));
    for row in grid.rows() {
        text.extend(row.iter().map(|cell| cell.glyph.to_string()));
        text.push('\n');
    }
    text
}

/// The grid in colour, as lines that any program may print: no movement, and the terminal's own colours restored
/// at the end of each line.
pub fn ansi(grid: &Grid) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut pen = Pen::default();
    for row in grid.rows() {
        for cell in row.iter().filter(|cell| cell.glyph != Glyph::Covered) {
            pen.write_cell(cell, &mut bytes);
        }
        pen.reset(&mut bytes);
        bytes.push(b'\n');
    }
    bytes
}

/// Each pixel a square of `scale` by `scale`, marked as sRGB; pixels of another shape than square are marked too.
///
/// # Errors
/// If the picture has no pixels, or too many for the format.
pub fn png(picture: &Picture, pixel_aspect: f32, scale: u32) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder =
        png::Encoder::new(&mut bytes, picture.width.saturating_mul(scale), picture.height.saturating_mul(scale));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_pixel_dims(pixel_dimensions(pixel_aspect));
    encoder.write_header()?.write_image_data(&scaled(picture, scale as usize))?;
    Ok(bytes)
}

/// The shape of a pixel as the format says it: how many of them make up one unit each way.
fn pixel_dimensions(pixel_aspect: f32) -> Option<png::PixelDimensions> {
    let per_unit = 1000.0;
    (pixel_aspect != 1.0).then(|| png::PixelDimensions {
        xppu: (per_unit * pixel_aspect).round() as u32,
        yppu: per_unit as u32,
        unit: png::Unit::Unspecified,
    })
}

fn scaled(picture: &Picture, scale: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(picture.pixels.len() * scale * scale * 3);
    for row in picture.pixels.chunks_exact(picture.width.max(1) as usize) {
        let line: Vec<u8> = row.iter().flat_map(|p| [p.r, p.g, p.b].repeat(scale)).collect();
        for _ in 0..scale {
            bytes.extend_from_slice(&line);
        }
    }
    bytes
}
