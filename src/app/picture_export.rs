//! Export of the shown picture into a new file.

use crate::capabilities::{Capabilities, CellMode, Colors};
use crate::cell;
use crate::export::{Contents, Format};
use crate::grid::Size;
use crate::output_file::OutputFile;
use crate::tone::Picture;
use std::io::{self, Write};
use std::path::Path;

/// Number of PNG pixels per pixel of the picture, along each axis.
// 80 columns become 640 pixels, which image viewers show without scaling them up and blurring them.
const PNG_SCALE: u32 = 8;

/// Greatest number that is tried in a file name, so that a full folder does not keep the event loop
/// busy.
const MAX_NUMBERED_NAMES: u32 = 9999;

/// Returns the contents of a file with the picture, without panels.
///
/// The cells have the glyphs that the terminal shows; they are in truecolor if the format has colours.
pub(super) fn contents(format: Format, picture: &Picture, capabilities: &Capabilities) -> io::Result<Vec<u8>> {
    let Capabilities { cell_mode, cell_aspect, .. } = *capabilities;
    match format.contents() {
        Contents::Pixels(write) => {
            let one = cell::resolution(cell_mode, Size::new(1, 1), cell_aspect).map_err(io::Error::other)?;
            write(picture, one.pixel_aspect(), PNG_SCALE)
        }
        Contents::Cells { has_colors, write } => {
            // Truecolor even if the terminal has 16 colours, because the file may be viewed elsewhere.
            let mode = if has_colors { CellMode { colors: Colors::Truecolor, ..cell_mode } } else { cell_mode.plain() };
            Ok(write(&cell::grid_from_picture(mode, picture), mode.colors, cell_aspect))
        }
    }
}

/// Writes a new file named after `stem` and `format`, with a number if that name exists. Returns
/// its name.
pub(super) fn write_new(folder: &Path, stem: &str, format: Format, contents: &[u8]) -> io::Result<String> {
    for number in 1..=MAX_NUMBERED_NAMES {
        let number = if number == 1 { String::new() } else { format!("-{number}") };
        let name = format!("{stem}{number}.{}", format.extension());
        match write_unused(&folder.join(&name), contents) {
            Ok(()) => return Ok(name),
            // Creating the file fails if it exists, so that two programs never write the same file. The next number is
            // tried.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "there are too many of that name"))
}

fn write_unused(path: &Path, contents: &[u8]) -> io::Result<()> {
    let mut file = OutputFile::create_new(path)?;
    file.remove_stale();
    file.write_all(contents)?;
    file.finish()
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
