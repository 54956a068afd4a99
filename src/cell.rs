//! Conversion of a picture's pixels to the cells of a grid.
//!
//! A glyph kind is one file of this folder, with its `mod` line, and one row of the table of [`Glyphs`].

use crate::camera::Camera;
use crate::color::Srgb8;
use crate::framebuffer::{Resolution, ResolutionError};
use crate::grid::{Grid, Size};
use crate::maps::{self, Map, TracedMap};
use crate::progress::Cancelled;
use crate::render::{Executor, Geometry, Sampling};
use crate::scene::Scene;
use crate::text::{ParseError, named};
use crate::tone::Picture;
use glyph_kind::{Background, Fill, GlyphKind};
use ink_converter::InkConverter;
use last_frame::LastFrame;
use std::borrow::Cow;
use std::fmt;
use std::num::NonZeroU32;
use std::str::FromStr;

mod ascii;
mod block_parts;
mod blocks;
mod blue_noise;
mod braille;
mod colors;
#[cfg(all(test, unit_tests))]
mod dots;
mod glyph_kind;
mod half;
mod ink_converter;
mod last_frame;
mod lit;
mod mixes;
mod mosaic;
mod octants;
mod pair;
mod palette;
mod ramp;
mod sextants;
mod shape;
mod spaces;
mod tint;

pub(crate) use block_parts::{BlockParts, block_parts};
pub use colors::Colors;
pub(crate) use colors::xterm_color;
pub use ramp::RAMP;

/// The mode in which pixels are drawn as cells: a glyph kind and a set of colours.
///
/// ```
/// use termtrace::{CellMode, Size};
///
/// let resolution = CellMode::HALF_BLOCK.resolution(Size { columns: 80, rows: 24 }, 2.0)?;
/// assert_eq!((resolution.width(), resolution.height()), (80, 48));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CellMode {
    /// The glyph kind.
    pub glyphs: Glyphs,
    /// The set of colours.
    pub colors: Colors,
}

crate::table::table! {
    /// A glyph kind: the glyphs by which the cells of a picture show its pixels.
    pub enum Glyphs: GlyphKind {
        /// Half blocks: two pixels per cell, one above the other.
        Half = half::KIND;
        /// The printable ASCII character whose ink is distributed most like the light of a cell's
        /// eight pixels.
        Shape = shape::KIND;
        /// ASCII characters that draw outlines, and fill each object with tones that span the range
        /// of the object's light.
        Ascii = ascii::KIND;
        /// One of ten ASCII characters, by the mean lightness of a cell's two pixels.
        Ramp = ramp::KIND;
        /// A space on the mean colour of a cell's two pixels.
        Spaces = spaces::KIND;
        /// Quadrants and eighths: the glyph and the two colours with the least squared error.
        Blocks = blocks::KIND;
        /// Octants and eighths, for terminals with Unicode 16.
        Octants = octants::KIND;
        /// Sextants, for terminals with Unicode 13.
        Sextants = sextants::KIND;
        /// Two by four Braille dots on a background.
        Braille = braille::KIND;
        /// A dot for each light pixel. This kind exists in tests only.
        #[cfg(all(test, unit_tests))]
        Dots = dots::KIND;
    }
}

impl Glyphs {
    /// Returns the name of the kind on the command line and in files.
    #[doc(hidden)]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns the kind with this name, if there is one.
    #[doc(hidden)]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|glyphs| glyphs.name() == name)
    }

    /// Returns the description in the command line's help.
    #[doc(hidden)]
    pub const fn help(self) -> &'static str {
        self.row().help
    }

    /// Returns the description in reports such as `termtrace doctor`.
    #[doc(hidden)]
    pub const fn title(self) -> &'static str {
        self.row().title
    }

    /// Returns whether the glyphs are block characters, so that panels may use them too.
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

/// Parses the name of a glyph kind.
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
    /// The ramp in the terminal's default colours.
    pub const RAMP: Self = Self { glyphs: Glyphs::Ramp, colors: Colors::None };
    /// ASCII with outlines in the terminal's default colours: the mode of golden text frames.
    pub(crate) const TEXT: Self = Self { glyphs: Glyphs::Ascii, colors: Colors::None };

    /// Returns a picture's resolution for a screen of this size and cell aspect (height / width).
    ///
    /// ```
    /// use termtrace::{CellMode, Size};
    ///
    /// let resolution = CellMode::HALF_BLOCK.resolution(Size::new(80, 24), 2.0)?;
    /// assert_eq!((resolution.width(), resolution.height()), (80, 48));
    /// # Ok::<(), termtrace::ResolutionError>(())
    /// ```
    ///
    /// # Errors
    /// If the screen has more cells than a grid or more pixels than a picture may have, or the aspect is not greater
    /// than 0 and finite.
    pub fn resolution(self, size: Size, cell_aspect: f32) -> Result<Resolution, ResolutionError> {
        resolution(self, size, cell_aspect)
    }

    /// Returns the number of pixels per cell, across and down.
    #[doc(hidden)]
    pub const fn pixels_per_cell(self) -> (u32, u32) {
        self.glyphs.row().pixels_per_cell
    }

    /// Returns whether the glyphs show [`Geometry`], which is then traced with the picture.
    pub(crate) const fn needs_geometry(self) -> bool {
        matches!(self.glyphs.row().fill, Fill::Geometry(_))
    }

    /// Traces the picture of a map, and the geometry if the glyphs show it.
    pub(crate) fn trace_for_glyphs(
        self,
        map: Map,
        executor: Executor<'_>,
        scene: &Scene,
        camera: &Camera,
        resolution: Resolution,
        sampling: Sampling,
    ) -> Result<TracedMap, Cancelled> {
        let trace = if self.needs_geometry() { maps::trace_with_geometry } else { maps::trace };
        trace(map, executor, scene, camera, resolution, sampling)
    }

    /// Returns the default sampling of a frame: at most 17 rays per cell on average.
    #[doc(hidden)]
    pub const fn default_sampling(self) -> Sampling {
        // With one ray for 2 by 2 pixels, and four where these differ, quadrants and eighths have a PSNR of 30.60 dB,
        // instead of 30.72 dB with all 32 rays.
        let (across, down) = self.pixels_per_cell();
        if across * down > 17 { Sampling::Split } else { Sampling::Each(NonZeroU32::MIN) }
    }

    /// Returns the mode without colours that has the same number of pixels per cell.
    #[doc(hidden)]
    pub fn without_colors(self) -> Self {
        Self { glyphs: self.glyphs.row().colorless_glyphs.unwrap_or(self.glyphs), colors: Colors::None }
    }
}

/// Returns the resolution of a picture for a screen of this size and cell aspect (height / width).
///
/// # Errors
/// If the screen has more cells than a grid or more pixels than a picture may have, or the aspect is not greater than 0
/// and finite.
pub fn resolution(mode: CellMode, size: Size, cell_aspect: f32) -> Result<Resolution, ResolutionError> {
    size.checked_cell_count()?;
    let (across, down) = mode.pixels_per_cell();
    Resolution::new(u32::from(size.columns) * across, u32::from(size.rows) * down)?
        .with_pixel_aspect(cell_aspect * across as f32 / down as f32) // 1 for half blocks in cells of aspect 2
}

/// Describes the terminal cell that shows a pixel, and the pixel's position in the cell.
pub fn cell_of_pixel([x, y]: [u32; 2], mode: CellMode) -> String {
    let (across, down) = mode.pixels_per_cell();
    let place = match (across, down) {
        (1, 2) => ["upper half", "lower half"][(y % 2) as usize].to_owned(),
        _ => format!("part ({}, {}) of it", x % across, y % down),
    };
    format!("cell ({}, {}), {place}", x / across, y / down)
}

/// Returns the cells of a picture, painted by a new [`Painter`].
///
/// # Panics
/// If the picture needs more than 65,535 columns or rows.
pub fn grid_from_picture(mode: CellMode, picture: &Picture) -> Grid {
    Painter::new(mode).grid(picture)
}

/// A converter of pictures to cells, which caches mixes of palette colours from frame to frame.
///
/// ```
/// use termtrace::{CellMode, Painter, Picture, Size, Srgb8};
///
/// let picture = Picture::from_pixels(3, 2, vec![Srgb8::new(90, 160, 40); 6]).ok_or("3 by 2 pixels")?;
/// let grid = Painter::new(CellMode::HALF_BLOCK).grid(&picture);
/// assert_eq!(grid.size(), Size::new(3, 1));
/// # Ok::<(), &str>(())
/// ```
pub struct Painter {
    mode: CellMode,
    light_background: bool,
    inks: InkConverter,
    /// The last frame of the live view, from which glyphs that show geometry are kept in motion.
    last_frame: LastFrame,
}

impl fmt::Debug for Painter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, light_background, .. } = self;
        let mut painter = f.debug_struct("Painter");
        painter.field("mode", mode).field("light_background", light_background).finish_non_exhaustive()
    }
}

impl Painter {
    /// Returns a painter for a terminal with light text on a dark background.
    pub fn new(mode: CellMode) -> Self {
        Self {
            mode,
            light_background: false,
            inks: InkConverter::for_colors(mode.colors),
            last_frame: LastFrame::default(),
        }
    }

    /// Sets whether the terminal's background is light.
    ///
    /// If it is, and only default colours are used, light pixels are left blank instead of dark ones.
    #[doc(hidden)]
    pub fn with_light_background(self, light_background: bool) -> Self {
        Self { light_background, ..self }
    }

    /// Returns the cell mode.
    #[doc(hidden)]
    pub fn mode(&self) -> CellMode {
        self.mode
    }

    /// Returns the cells of a picture, independently of pictures painted before.
    ///
    /// Cells at the right and the lower edge may extend beyond the picture.
    ///
    /// # Panics
    /// If the picture needs more than 65,535 columns or rows.
    pub fn grid(&mut self, picture: &Picture) -> Grid {
        self.grid_with(picture, None)
    }

    /// Returns the cells for a picture, drawn with its geometry if given.
    pub(crate) fn grid_with(&mut self, picture: &Picture, geometry: Option<&Geometry>) -> Grid {
        let mut grid = Grid::new(Size::new(0, 0));
        self.paint(picture, geometry, &mut grid);
        grid
    }

    /// Returns the cells of a traced map.
    pub(crate) fn grid_of(&mut self, traced: &TracedMap) -> Grid {
        self.grid_with(&traced.picture, traced.geometry.as_deref())
    }

    /// Traces a map on the current rayon pool, and returns its cells.
    #[doc(hidden)]
    pub fn trace(
        &mut self,
        map: Map,
        scene: &Scene,
        camera: &Camera,
        resolution: Resolution,
        sampling: impl Into<Sampling>,
    ) -> Grid {
        let traced = self.mode.trace_for_glyphs(map, Executor::Pool, scene, camera, resolution, sampling.into());
        self.grid_of(&traced.expect("only a token cancels, and the pool has none"))
    }

    /// Traces a view as [`trace`](Self::trace) does, until a token is cancelled.
    ///
    /// # Errors
    /// If it was cancelled.
    #[cfg(feature = "serve")]
    pub(crate) fn trace_until(
        &mut self,
        token: &crate::progress::Cancellation,
        (map, scene, camera): (Map, &Scene, &Camera),
        resolution: Resolution,
        sampling: Sampling,
    ) -> Result<Grid, Cancelled> {
        let executor = Executor::Cancellable(token);
        let traced = self.mode.trace_for_glyphs(map, executor, scene, camera, resolution, sampling)?;
        Ok(self.grid_of(&traced))
    }

    /// Fills a grid as [`grid`](Self::grid) does, reusing its memory.
    ///
    /// If the kind of glyphs shows geometry and `geometry` is `None`, the picture is drawn as a single surface.
    ///
    /// # Panics
    /// If the picture needs more than 65,535 columns or rows.
    #[doc(hidden)]
    pub fn paint(&mut self, picture: &Picture, geometry: Option<&Geometry>, grid: &mut Grid) {
        self.paint_with(picture, geometry, false, grid);
    }

    /// Fills a grid as [`paint`](Self::paint) does, with less flicker while the view moves.
    ///
    /// If the kind of glyphs shows geometry, a cell keeps its glyph from the frame painted before if the cell's samples
    /// are the same, or if another glyph is hardly better. At rest the glyphs depend on the picture alone.
    #[doc(hidden)]
    pub fn paint_view(&mut self, picture: &Picture, geometry: Option<&Geometry>, is_moving: bool, grid: &mut Grid) {
        self.last_frame.is_moving = is_moving;
        self.paint_with(picture, geometry, true, grid);
    }

    fn paint_with(&mut self, picture: &Picture, geometry: Option<&Geometry>, is_view: bool, grid: &mut Grid) {
        let pixels_per_cell = self.mode.pixels_per_cell();
        grid.clear(size_in_cells(picture, pixels_per_cell));
        let has_colors = self.mode.colors != Colors::None;
        // Only default colours are inverted for a light background: with other colours, glyphs are drawn on black.
        let negative = || (self.light_background && !has_colors).then(|| negative(picture));
        // One call by function pointer per frame. The loop over the cells is inside the function, so that it is
        // compiled for the glyph kind.
        match self.mode.glyphs.row().fill {
            Fill::Colored(fill) => fill(grid, negative().as_ref().unwrap_or(picture), &mut self.inks),
            Fill::Lightness(fill) if !has_colors => fill(grid, negative().as_ref().unwrap_or(picture)),
            Fill::Lightness(fill) => {
                fill(grid, &tint::grey_by_brightest_channel(picture));
                tint::color_glyphs(grid, picture, pixels_per_cell, &mut self.inks);
            }
            Fill::Geometry(fill) => {
                let unknown = || Geometry::of_one_surface(picture.width(), picture.height());
                let geometry = geometry.filter(|geometry| geometry.fits(picture.width(), picture.height()));
                let geometry = geometry.map_or_else(|| Cow::Owned(unknown()), Cow::Borrowed);
                let background = if self.light_background { Background::Light } else { Background::Dark };
                let last_frame = is_view.then_some(&mut self.last_frame);
                fill(grid, picture, &geometry, (background, self.mode.colors), last_frame);
            }
        }
    }
}

/// Returns the size of a picture in cells, rounded up.
fn size_in_cells(picture: &Picture, (across, down): (u32, u32)) -> Size {
    let cells = |pixels: u32, per_cell| {
        u16::try_from(pixels.div_ceil(per_cell)).expect("a grid has at most 65,535 columns and rows")
    };
    Size::new(cells(picture.width(), across), cells(picture.height(), down))
}

/// Returns the negative of a picture: each channel is inverted, so that light becomes dark.
fn negative(picture: &Picture) -> Picture {
    let inverted = |pixel: &Srgb8| Srgb8::new(255 - pixel.r, 255 - pixel.g, 255 - pixel.b);
    picture.map_colors(inverted)
}

#[cfg(all(test, unit_tests))]
mod tests;
