//! Cells from pixels: a picture to a grid.
//!
//! A cell kind is one file here, with its `mod` line, and one row of the table of [`Glyphs`].

use crate::color::Srgb8;
use crate::framebuffer::{Resolution, ResolutionError};
use crate::grid::{Grid, Size};
use crate::text::{ParseError, named};
use crate::tone::Picture;
use glyph_kind::{Fill, GlyphKind};
use ink_converter::InkConverter;
use std::fmt;
use std::str::FromStr;

mod blue_noise;
mod colors;
#[cfg(test)]
mod dots;
mod glyph_kind;
mod half;
mod ink_converter;
mod pair;
mod palette;
mod ramp;
mod shape;
mod tint;

pub use colors::Colors;
pub(crate) use colors::xterm_color;
pub use ramp::RAMP;

/// The mode in which pixels become cells: glyphs and colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CellMode {
    /// The kind of glyphs.
    pub glyphs: Glyphs,
    /// The colours.
    pub colors: Colors,
}

crate::table::table! {
    /// A kind of glyphs in the cells of a picture.
    pub enum Glyphs: GlyphKind {
        /// Half blocks: two pixels, one above the other.
        Half = half::KIND;
        /// The printable ASCII character whose ink lies where the picture has its light.
        Shape = shape::KIND;
        /// A character of a fixed ramp, by lightness alone.
        Ramp = ramp::KIND;
        /// A dot or nothing; exists in tests only.
        #[cfg(test)]
        Dots = dots::KIND;
    }
}

impl Glyphs {
    /// Returns the name by which users choose the kind.
    #[doc(hidden)]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns the kind with this name.
    #[doc(hidden)]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|glyphs| glyphs.name() == name)
    }

    /// Returns a description for the help of the command line.
    #[doc(hidden)]
    pub const fn help(self) -> &'static str {
        self.row().help
    }

    /// Returns a short description for reports.
    #[doc(hidden)]
    pub const fn title(self) -> &'static str {
        self.row().title
    }

    /// Returns whether the glyphs are block characters; panels use block characters if a terminal can show them.
    #[doc(hidden)]
    pub const fn has_blocks(self) -> bool {
        self.row().has_blocks
    }
}

impl fmt::Display for Glyphs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Parses the name of a kind.
///
/// ```
/// use termtrace::Glyphs;
///
/// assert_eq!("half".parse(), Ok(Glyphs::Half));
/// let error = "halv".parse::<Glyphs>().unwrap_err();
/// assert_eq!(error.to_string(), "unknown glyphs \"halv\"; did you mean \"half\"?");
/// ```
impl FromStr for Glyphs {
    type Err = ParseError;

    fn from_str(name: &str) -> Result<Self, ParseError> {
        named("glyphs", name, Self::ALL, Self::name)
    }
}

impl CellMode {
    /// Half blocks in truecolor.
    pub const HALF_BLOCK: Self = Self { glyphs: Glyphs::Half, colors: Colors::Truecolor };
    /// The ramp in the terminal's own colours: the text of golden frames.
    pub const RAMP: Self = Self { glyphs: Glyphs::Ramp, colors: Colors::None };

    /// Returns the resolution to render for a screen of this size whose cells have this aspect (height divided by
    /// width).
    ///
    /// # Errors
    /// If the screen has more pixels than a picture may have, or the aspect is not greater than 0 and finite.
    pub fn resolution(self, size: Size, cell_aspect: f32) -> Result<Resolution, ResolutionError> {
        resolution(self, size, cell_aspect)
    }

    /// Returns the number of pixels per cell, across and down.
    #[doc(hidden)]
    pub const fn pixels_per_cell(self) -> (u32, u32) {
        self.glyphs.row().pixels_per_cell
    }

    /// Returns the mode in which text without colours shows the same pixels.
    #[doc(hidden)]
    pub fn plain(self) -> Self {
        Self { glyphs: self.glyphs.row().plain.unwrap_or(self.glyphs), colors: Colors::None }
    }
}

/// Returns the resolution to render for a screen of this size whose cells have this aspect (height divided by width).
///
/// # Errors
/// If the screen has more pixels than a picture may have, or the aspect is not greater than 0 and finite.
pub fn resolution(mode: CellMode, size: Size, cell_aspect: f32) -> Result<Resolution, ResolutionError> {
    let (across, down) = mode.pixels_per_cell();
    Resolution::new(u32::from(size.columns) * across, u32::from(size.rows) * down)?
        .with_pixel_aspect(cell_aspect * across as f32 / down as f32)
}

/// Returns the cells of a picture, as a new [`Painter`] paints them.
///
/// # Panics
/// If the picture needs more than 65,535 columns or rows.
pub fn grid_from_picture(mode: CellMode, picture: &Picture) -> Grid {
    Painter::new(mode).grid(picture)
}

/// A converter of pictures into cells, which caches mixes of few colours from frame to frame.
pub struct Painter {
    mode: CellMode,
    light_background: bool,
    inks: InkConverter,
}

impl fmt::Debug for Painter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, light_background, .. } = self;
        let mut painter = f.debug_struct("Painter");
        painter.field("mode", mode).field("light_background", light_background).finish_non_exhaustive()
    }
}

impl Painter {
    /// Returns a painter for a terminal that writes light on dark, which matters where its own colours are used.
    pub fn new(mode: CellMode) -> Self {
        Self { mode, light_background: false, inks: InkConverter::of(mode.colors) }
    }

    /// Sets whether the terminal writes dark on light: light pixels then are left blank.
    #[doc(hidden)]
    pub fn with_light_background(self, light_background: bool) -> Self {
        Self { light_background, ..self }
    }

    /// Returns the mode.
    #[doc(hidden)]
    pub fn mode(&self) -> CellMode {
        self.mode
    }

    /// Returns the cells of a picture, a function of nothing else. Cells at the right and lower edge may be filled in
    /// part only.
    ///
    /// # Panics
    /// If the picture needs more than 65,535 columns or rows.
    pub fn grid(&mut self, picture: &Picture) -> Grid {
        let mut grid = Grid::new(Size::new(0, 0));
        self.paint(picture, &mut grid);
        grid
    }

    /// Fills a grid as [`grid`](Self::grid) does, reusing its memory.
    ///
    /// # Panics
    /// If the picture needs more than 65,535 columns or rows.
    #[doc(hidden)]
    pub fn paint(&mut self, picture: &Picture, grid: &mut Grid) {
        let pixels_per_cell = self.mode.pixels_per_cell();
        grid.clear(size_in_cells(picture, pixels_per_cell));
        let has_colors = self.mode.colors != Colors::None;
        let negative = (self.light_background && !has_colors).then(|| negative(picture));
        let picture = negative.as_ref().unwrap_or(picture);
        match self.mode.glyphs.row().fill {
            Fill::Colored(fill) => fill(grid, picture, &mut self.inks),
            Fill::Lightness(fill) if !has_colors => fill(grid, picture),
            Fill::Lightness(fill) => {
                fill(grid, &tint::brightness(picture));
                tint::fill(grid, picture, pixels_per_cell, &mut self.inks);
            }
        }
    }
}

fn size_in_cells(picture: &Picture, (across, down): (u32, u32)) -> Size {
    let cells = |pixels: u32, per_cell| {
        u16::try_from(pixels.div_ceil(per_cell)).expect("a grid has at most 65,535 columns and rows")
    };
    Size::new(cells(picture.width, across), cells(picture.height, down))
}

/// Returns an inverted picture: dark where the picture is light.
fn negative(picture: &Picture) -> Picture {
    let inverted = |pixel: &Srgb8| Srgb8::new(255 - pixel.r, 255 - pixel.g, 255 - pixel.b);
    Picture { pixels: picture.pixels.iter().map(inverted).collect(), ..*picture }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Cell, Ink};
    use std::collections::HashSet;

    const BLACK: Srgb8 = Srgb8::new(0, 0, 0);
    const BLUE: Srgb8 = Srgb8::new(0, 0, 255);

    /// The file, its `mod` line and its row are all that this kind takes.
    #[test]
    fn a_kind_that_only_tests_have_is_found_and_painted() {
        let glyphs = Glyphs::from_name("dots").expect("by its name");
        let picture = Picture { width: 2, height: 1, pixels: vec![BLUE, BLACK] };
        let mode = CellMode { glyphs, colors: Colors::Truecolor };
        let resolution = resolution(mode, Size::new(2, 1), 2.0).expect("a small screen");
        assert_eq!((resolution.width(), resolution.height()), (picture.width, picture.height));
        let grid = grid_from_picture(mode, &picture);
        assert_eq!(*grid.cell(0, 0), Cell::new('o', Ink::Rgb(BLUE), Ink::Rgb(BLACK)));
        assert_eq!(*grid.cell(1, 0), Cell::new(' ', Ink::Default, Ink::Rgb(BLACK)));
        let on_light = Painter::new(mode.plain()).with_light_background(true).grid(&picture);
        assert_eq!(on_light.cells().iter().map(|cell| cell.glyph.to_string()).collect::<String>(), "oo");
    }

    #[test]
    fn kinds_have_names_of_their_own_and_plain_ones_of_as_many_pixels() {
        let mut names = HashSet::new();
        for &glyphs in Glyphs::ALL {
            assert!(names.insert(glyphs.name()), "{glyphs:?}");
            let mode = CellMode { glyphs, colors: Colors::Truecolor };
            assert_eq!(mode.plain().pixels_per_cell(), mode.pixels_per_cell(), "{glyphs:?}");
            assert_eq!(mode.plain().plain(), mode.plain(), "{glyphs:?}");
        }
    }
}
