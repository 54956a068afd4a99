//! Export of grids and pictures to files: plain text, ANSI, SVG, HTML, PNG.
//!
//! A format is one file of this folder, with its `mod` line, and one row of the table of [`Format`]s.

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
#[cfg(all(test, unit_tests))]
mod tally;
mod text;

pub use ansi::ansi;
#[doc(hidden)]
pub use ansi::ansi_or_text;
pub use difference::{Difference, compare};
#[doc(hidden)]
pub use format_row::{FileEncoder, GoldenDifference};
pub use html::html;
#[cfg(feature = "png")]
pub use png::{ExportError, png};
pub use snapshot::{framed, styled};
pub use svg::svg;
pub use text::text;

use crate::capabilities::{CellMode, USUAL_CELL_ASPECT};
use crate::cell::{self, Painter};
use crate::grid::{Grid, Size};
use crate::maps::Map;
use crate::scene::Scene;
use crate::text::{ParseError, named};
use format_row::FormatRow;
use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;

crate::table::table! {
    /// The file formats that a picture can be exported to, in the order of their keys in the live
    /// view.
    #[doc(hidden)]
    pub enum Format: FormatRow {
        /// The picture's pixels: [`png()`].
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
        /// The number of occurrences of each character. This format exists in tests only.
        #[cfg(all(test, unit_tests))]
        Tally = tally::KIND;
    }
}

impl Format {
    /// Returns the name of the format on the command line.
    #[doc(hidden)]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns the format with this name, if there is one.
    #[doc(hidden)]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.name() == name)
    }

    /// Returns the description of the format in the command line's help.
    #[doc(hidden)]
    pub const fn help(self) -> &'static str {
        self.row().help
    }

    /// Returns the extension of new files, without the dot.
    #[doc(hidden)]
    pub const fn extension(self) -> &'static str {
        self.row().extensions[0]
    }

    /// Returns the format with this file name extension, given in lower case without the dot.
    #[doc(hidden)]
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|format| format.row().extensions.contains(&extension))
    }

    /// Returns the key of the format in the live view.
    #[doc(hidden)]
    pub const fn key(self) -> char {
        self.row().key
    }

    /// Returns the name of the live view's command that writes this format.
    // Users' keymaps contain the names, so they must not change.
    #[doc(hidden)]
    pub const fn command(self) -> &'static str {
        self.row().command
    }

    /// Returns the description of the format in the live view.
    #[doc(hidden)]
    pub const fn title(self) -> &'static str {
        self.row().title
    }

    /// Returns the function that makes a file of the format, from a grid or from a picture.
    #[doc(hidden)]
    pub const fn file_encoder(self) -> FileEncoder {
        self.row().file_encoder
    }

    /// Returns whether the format contains pixels instead of cells.
    #[doc(hidden)]
    pub const fn has_pixels(self) -> bool {
        matches!(self.file_encoder(), FileEncoder::Pixels(_))
    }

    /// Returns a readable report of how a file differs from the golden file.
    #[doc(hidden)]
    pub fn difference(self, golden: &[u8], file: &[u8]) -> GoldenDifference {
        (self.row().difference)(golden, file)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Parses the name of a format.
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

/// Returns a scene, seen by its own camera, as plain text for snapshot tests.
///
/// One ray is traced through each pixel's centre, and cells have the usual aspect of 2. Each row is a line with all its
/// characters and a line feed.
///
/// ```
/// use termtrace::{Scene, Size, text_frame};
///
/// let scene = Scene::from_ron("ball.ron", r##"(
///     camera: (eye: (0, 0, 4), target: (0, 0, 0)),
///     lights: [Point(position: (0, 0, 4), intensity: 10)],
///     objects: [Sphere(center: (0, 0, 0), radius: 1)],
/// )"##)?;
/// let rows = [
///     "            ",
///     r#"  _/"``"\   "#,
///     r#"  /o#@@#o\  "#,
///     r#"  \o#@@#o/  "#,
///     r#"  `\,,,,/   "#,
///     "            ",
/// ];
/// assert_eq!(text_frame(&scene, Size::new(12, 6)), rows.map(|row| format!("{row}\n")).concat());
/// # Ok::<(), termtrace::SceneError>(())
/// ```
///
/// # Panics
/// If the screen has more than 16,777,216 cells.
pub fn text_frame(scene: &Scene, size: Size) -> String {
    text(&frame_grid(scene, CellMode::TEXT, size, USUAL_CELL_ASPECT))
}

/// Returns a scene, seen by its own camera, as the cells of a screen of this size and cell aspect.
///
/// One ray is traced through each pixel's centre.
///
/// ```
/// use termtrace::{CellMode, Scene, Size, frame_grid};
///
/// let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
/// let grid = frame_grid(&scene, CellMode::HALF_BLOCK, Size::new(80, 24), 2.0);
/// assert_eq!(grid.size(), Size::new(80, 24));
/// # Ok::<(), termtrace::LoadError>(())
/// ```
///
/// # Panics
/// If [`cell::resolution`] is an error: for a screen with more pixels than a picture may have, or an aspect that is not
/// greater than 0 and finite.
pub fn frame_grid(scene: &Scene, cell_mode: CellMode, size: Size, cell_aspect: f32) -> Grid {
    // The steps are those of the live view and of `termtrace frame`, so that a snapshot shows what users see.
    let resolution =
        cell::resolution(cell_mode, size, cell_aspect).expect("a size and an aspect that pictures can have");
    Painter::new(cell_mode).trace(Map::Shaded, scene, scene.camera(), resolution, NonZeroU32::MIN)
}

#[cfg(all(test, unit_tests))]
mod tests;
