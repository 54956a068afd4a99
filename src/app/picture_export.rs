//! Export of the shown picture into a new file.

use crate::capabilities::{Capabilities, CellMode, Colors};
use crate::cell::{self, Painter};
use crate::export::{FileEncoder, Format};
use crate::grid::{Grid, Size};
use crate::output_file::OutputFile;
use crate::render::Geometry;
use crate::tone::Picture;
use std::io::{self, Write};
use std::path::Path;

/// Number of PNG pixels per pixel of the picture, along each axis.
// 80 columns become 640 pixels, which image viewers show without scaling them up and blurring them.
const PNG_SCALE: u32 = 8;

/// Greatest number that is tried in a file name, so that a full folder does not keep the event loop
/// busy.
const MAX_NUMBERED_NAMES: u32 = 9999;

/// Returns the contents of a file with the picture, without panels. Formats with a title get
/// `name`.
///
/// The cells have the glyphs that the terminal shows; they are in truecolor if the format has colours. Default colours
/// are those of the terminal, dark on light or light on dark, except in formats that always draw them light on black.
pub(super) fn contents(
    format: Format,
    name: &str,
    picture: &Picture,
    geometry: Option<&Geometry>,
    capabilities: &Capabilities,
) -> io::Result<Vec<u8>> {
    let Capabilities { cell_mode, cell_aspect, light_background, .. } = *capabilities;
    match format.file_encoder() {
        FileEncoder::Pixels(write) => {
            let one = cell::resolution(cell_mode, Size::new(1, 1), cell_aspect).map_err(io::Error::other)?;
            write(picture, one.pixel_aspect(), PNG_SCALE)
        }
        FileEncoder::Cells { has_colors, is_on_black, write } => {
            // Truecolor even if the terminal has 16 colours, because the file may be viewed elsewhere.
            let mode = if has_colors {
                CellMode { colors: Colors::Truecolor, ..cell_mode }
            } else {
                cell_mode.without_colors()
            };
            let mut grid = Grid::new(Size::new(0, 0));
            let light_background = light_background && !is_on_black;
            Painter::new(mode).with_light_background(light_background).paint(picture, geometry, &mut grid);
            Ok(write(&grid, mode.colors, cell_aspect, name))
        }
    }
}

/// Writes a new file named after `stem` and `format`, with the first unused number if that name
/// exists. Returns its name.
pub(super) fn write_new(folder: &Path, stem: &str, format: Format, contents: &[u8]) -> io::Result<String> {
    let mut file = OutputFile::create_in(folder)?;
    file.remove_stale();
    file.write_all(contents)?;
    finish_new(file, folder, stem, format.extension())
}

/// Gives a complete file a name after `stem`, with the first unused number if that name exists.
/// Returns the name.
// Each name is created exclusively. If a free name were only looked up first, two programs could write the same file.
pub(super) fn finish_new(file: OutputFile, folder: &Path, stem: &str, extension: &str) -> io::Result<String> {
    let name = |number: u32| {
        let number = if number == 1 { String::new() } else { format!("-{number}") };
        folder.join(format!("{stem}{number}.{extension}"))
    };
    let path = file.finish_unused((1..=MAX_NUMBERED_NAMES).map(name))?;
    Ok(path.file_name().unwrap_or_default().to_string_lossy().into_owned())
}

/// Returns the stem of an export's file name.
///
/// This is the scene's name without folders, extension and special characters.
pub(super) fn file_stem(name: &str) -> String {
    let stem = Path::new(name).file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    let plain: String = stem.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    let plain = plain.trim_start_matches(['.', '-']);
    if plain.is_empty() { "scene".to_owned() } else { plain.to_owned() }
}

#[cfg(all(test, unit_tests))]
mod tests;
