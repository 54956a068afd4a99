//! Grid or picture -> a file's contents: plain text, ANSI, SVG, HTML, PNG.
//!
//! A format is one file here, with its `mod` line, and one row of the table of [`Format`]s.

mod ansi;
mod difference;
mod html;
mod format_row;
mod paint;
#[cfg(feature = "png")]
mod png;
mod sgr;
mod snapshot;
mod svg;
#[cfg(test)]
mod tally;
mod text;

pub use ansi::ansi;
#[doc(hidden)]
pub use ansi::ansi_or_text;
pub use difference::{Difference, compare};
#[doc(hidden)]
pub use format_row::Contents;
pub use html::html;
#[cfg(feature = "png")]
pub use png::{ExportError, png};
pub use snapshot::{framed, styled};
pub use svg::svg;
pub use text::text;

use crate::capabilities::{CellMode, USUAL_CELL_ASPECT};
use crate::cell;
use crate::grid::{Grid, Size};
use crate::render::render;
use crate::scene::Scene;
use crate::text::{ParseError, named};
use crate::tone::tone;
use format_row::FormatRow;
use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;

crate::table::table! {
    /// The formats of files with a picture, in the order of the keys that ask for them.
    #[doc(hidden)]
    pub enum Format: FormatRow {
        /// Its pixels: [`png()`].
        #[cfg(feature = "png")]
        Png = png::KIND;
        /// Cells in colour, for terminals: [`ansi()`].
        Ansi = ansi::KIND;
        /// Characters without colour: [`text()`].
        Text = text::KIND;
        /// Cells as a drawing: [`svg()`].
        Svg = svg::KIND;
        /// Cells as a web page: [`html()`].
        Html = html::KIND;
        /// Numbers of characters: a format that only tests have.
        #[cfg(test)]
        Tally = tally::KIND;
    }
}

impl Format {
    /// The word by which the command line asks for it.
    #[doc(hidden)]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// The format of that name.
    #[doc(hidden)]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.name() == name)
    }

    /// What it is, for the help of the command line.
    #[doc(hidden)]
    pub const fn help(self) -> &'static str {
        self.row().help
    }

    /// How the names of such files end, without the dot.
    #[doc(hidden)]
    pub const fn extension(self) -> &'static str {
        self.row().extensions[0]
    }

    /// The format of files whose names end so, without the dot, in lower case.
    #[doc(hidden)]
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.row().extensions.contains(&extension))
    }

    /// The letter that asks for it in the live view.
    #[doc(hidden)]
    pub const fn key(self) -> char {
        self.row().key
    }

    /// The name of the command that asks for it. Names stay: people's files have them.
    #[doc(hidden)]
    pub const fn command(self) -> &'static str {
        self.row().command
    }

    /// What the live view calls it, in a few words.
    #[doc(hidden)]
    pub const fn title(self) -> &'static str {
        self.row().title
    }

    /// What it is made of, and by what.
    #[doc(hidden)]
    pub const fn contents(self) -> Contents {
        self.row().contents
    }

    /// Whether it has pixels, not cells.
    #[doc(hidden)]
    pub const fn has_pixels(self) -> bool {
        matches!(self.contents(), Contents::Pixels(_))
    }

    /// Returns how a file of it differs from the golden one, in lines for a person.
    #[doc(hidden)]
    pub fn difference(self, golden: &[u8], file: &[u8]) -> String {
        (self.row().difference)(golden, file)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The value of that name.
///
/// ```
/// use termtrace::export::Format;
///
/// assert_eq!("html".parse(), Ok(Format::Html));
/// let error = "htm".parse::<Format>().unwrap_err();
/// assert_eq!(error.to_string(), "unknown format \"htm\"; did you mean \"html\"?");
/// ```
impl FromStr for Format {
    type Err = ParseError;

    fn from_str(name: &str) -> Result<Self, ParseError> {
        named("format", name, Self::ALL, Self::name)
    }
}

/// The scene at that size as plain text, for snapshot tests: one ray through each pixel's centre, cells of the usual
/// aspect of 2, one line for each row, each with all its characters and a line feed.
///
/// ```
/// use termtrace::{Scene, Size, text_frame};
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
///
/// # Panics
/// If the screen has more pixels than [a picture may have](crate::framebuffer::Resolution::MAX_PIXELS): two for each
/// cell.
pub fn text_frame(scene: &Scene, size: Size) -> String {
    text(&frame_grid(scene, CellMode::RAMP, size, USUAL_CELL_ASPECT))
}

/// Returns the scene's own view as the cells of a screen of that size and cell aspect, one ray through each pixel's
/// centre.
///
/// # Panics
/// If [`cell::resolution`] is an error: for a screen with more pixels than a picture may have, or an aspect that is not
/// greater than 0 and finite.
pub fn frame_grid(scene: &Scene, cell_mode: CellMode, size: Size, cell_aspect: f32) -> Grid {
    let resolution =
        cell::resolution(cell_mode, size, cell_aspect).expect("a size and an aspect that pictures can have");
    let picture = tone(&render(scene, scene.camera(), resolution, NonZeroU32::MIN), scene);
    cell::grid_from_picture(cell_mode, &picture)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capabilities::Colors;
    use std::collections::HashSet;

    /// That file, its `mod` line and its row are all that it took.
    #[test]
    fn a_format_for_tests_is_found_and_written() {
        let format = Format::from_name("tally").expect("by its name");
        assert_eq!(Format::from_extension("tal"), Some(format));
        let grid = Grid::new(Size::new(3, 2));
        let Contents::Cells { has_colors: false, write } = format.contents() else { panic!("{format:?}") };
        let file = write(&grid, Colors::None, USUAL_CELL_ASPECT);
        assert_eq!(String::from_utf8_lossy(&file), "  6\n");
        assert!(format.difference(b"  5\n", &file).ends_with("- 1 |  5|\n+ 1 |  6|\n       ^\n"));
    }

    #[test]
    fn formats_share_no_name_extension_or_key() {
        let mut seen = HashSet::new();
        for format in Format::ALL {
            assert!(seen.insert(format.name().to_owned() + " by name"), "{format:?}");
            assert!(seen.insert(format.command().to_owned() + " by command"), "{format:?}");
            assert!(seen.insert(format.key().to_string() + " by key"), "{format:?}");
            for extension in format.row().extensions {
                assert!(seen.insert((*extension).to_owned() + " by extension"), "{format:?}");
                assert_eq!(Format::from_extension(extension), Some(*format));
            }
        }
    }
}
