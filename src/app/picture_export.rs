//! Export of the shown picture into a new file.

use crate::capabilities::{Capabilities, CellMode, Colors};
use crate::cell;
use crate::export::{Contents, Format};
use crate::grid::Size;
use crate::output_file::OutputFile;
use crate::tone::Picture;
use std::io::{self, Write};
use std::path::Path;

/// Pixels of a PNG per pixel of the screen, in both directions.
// A picture of 80x24 cells becomes 640 pixels wide, which viewers show without blurring it.
const PNG_SCALE: u32 = 8;

/// Limit on the numbered names that are tried, so that a full or hostile folder does not keep the
/// loop busy.
const MAX_NUMBERED_NAMES: u32 = 9999;

/// Returns the contents of an export without panels.
///
/// The cells as the terminal shows them, in truecolor if the format has colours.
pub(super) fn contents(format: Format, picture: &Picture, capabilities: &Capabilities) -> io::Result<Vec<u8>> {
    let Capabilities { cell_mode, cell_aspect, .. } = *capabilities;
    match format.contents() {
        Contents::Pixels(write) => {
            let one = cell::resolution(cell_mode, Size::new(1, 1), cell_aspect).map_err(io::Error::other)?;
            write(picture, one.pixel_aspect(), PNG_SCALE)
        }
        Contents::Cells { has_colors, write } => {
            // Truecolor even on a terminal of 16 colours: a file outlives the terminal.
            let mode = if has_colors { CellMode { colors: Colors::Truecolor, ..cell_mode } } else { cell_mode.plain() };
            Ok(write(&cell::grid_from_picture(mode, picture), mode.colors, cell_aspect))
        }
    }
}

/// Writes a new file named after `stem` and `format`, with the first unused number if that name
/// exists. Returns its name.
pub(super) fn write_new(folder: &Path, stem: &str, format: Format, contents: &[u8]) -> io::Result<String> {
    for number in 1..=MAX_NUMBERED_NAMES {
        let number = if number == 1 { String::new() } else { format!("-{number}") };
        let name = format!("{stem}{number}.{}", format.extension());
        match write_unused(&folder.join(&name), contents) {
            Ok(()) => return Ok(name),
            // Created exclusively instead of looked for first, so that two programs never write one file.
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
pub(super) fn stem(name: &str) -> String {
    let stem = Path::new(name).file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    let plain: String = stem.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    let plain = plain.trim_start_matches(['.', '-']);
    if plain.is_empty() { "scene".to_owned() } else { plain.to_owned() }
}

#[cfg(all(test, unit_tests))]
mod tests;
