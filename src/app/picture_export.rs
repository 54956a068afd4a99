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
mod tests {
    use super::*;
    use crate::capabilities::{Glyphs, HalfBlocks};

    #[test]
    fn names_are_plain_words() {
        for (name, expected) in [
            ("scenes/three_spheres.ron", "three_spheres"),
            ("built-in scene", "built-in_scene"),
            ("a\u{1b}[2J b.ply", "a__2J_b"),
            ("-o.ron", "o"),
            ("/", "scene"),
            ("été.ron", "été"),
        ] {
            assert_eq!(stem(name), expected, "{name}");
        }
    }

    #[test]
    fn what_is_shown_is_written_in_each_format() {
        let pixels = vec![crate::color::Srgb8::new(255, 255, 255); 4];
        let picture = Picture { width: 2, height: 2, pixels };
        let capabilities = Capabilities {
            cell_mode: CellMode::HALF_BLOCK,
            cell_aspect: 2.0,
            half_blocks: HalfBlocks::Lower,
            light_background: false,
            synchronized_output: false,
        };
        let written = |format| contents(format, &picture, &capabilities).expect("written");
        assert_eq!(String::from_utf8_lossy(&written(Format::Text)), "@@\n");
        assert_eq!(String::from_utf8_lossy(&written(Format::Tally)), "@ 2\n");
        let dots = CellMode { glyphs: Glyphs::Dots, ..CellMode::HALF_BLOCK };
        let in_dots = contents(Format::Text, &picture, &Capabilities { cell_mode: dots, ..capabilities });
        assert_eq!(String::from_utf8_lossy(&in_dots.expect("written")), "oo\noo\n");
        for &format in Format::ALL {
            assert!(!written(format).is_empty(), "{format:?}");
        }
    }

    #[test]
    fn nothing_is_written_over() {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let write = |contents: &[u8]| write_new(folder.path(), "ball", Format::Svg, contents);
        assert_eq!(write(b"1").expect("written"), "ball.svg");
        std::fs::create_dir(folder.path().join("ball-2.svg")).expect("a folder can be made");
        assert_eq!(write(b"3").expect("written"), "ball-3.svg");
        assert_eq!(std::fs::read(folder.path().join("ball.svg")).expect("it is there"), b"1");
        std::fs::remove_file(folder.path().join("ball.svg")).expect("it can be removed");
        assert_eq!(write(b"again").expect("written"), "ball.svg");
        assert!(write_new(&folder.path().join("missing"), "ball", Format::Png, b"").is_err());
    }
}
