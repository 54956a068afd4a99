//! The picture as linear light: the light that arrives at the eye through each pixel.

use crate::color::LinearRgb;
use std::fmt;

/// The size of a picture in pixels, and the aspect ratio of a pixel.
///
/// A picture has between 0 and 33,554,432 pixels.
///
/// ```
/// use termtrace::Resolution;
///
/// let resolution = Resolution::new(320, 200)?.with_pixel_aspect(1.2)?;
/// assert_eq!((resolution.width(), resolution.height()), (320, 200));
/// assert!((resolution.aspect_ratio() - 4.0 / 3.0).abs() < 1e-6);
///
/// let error = Resolution::new(200_000, 200_000).unwrap_err();
/// assert_eq!(error.to_string(), "a picture of 200000x200000 pixels is too large; at most 33554432 pixels in all");
/// # Ok::<(), termtrace::ResolutionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    width: u32,
    height: u32,
    pixel_aspect: f32,
}

impl Resolution {
    /// The largest number of pixels of a picture: 33,554,432, more than an 8K picture has.
    ///
    /// Rendering such a picture takes some 900 MB at one sample per pixel.
    // The constructors check the number of pixels before anything is allocated. Without the check, a render with a
    // large resolution aborted the process when memory ran out.
    #[doc(hidden)]
    pub const MAX_PIXELS: u32 = 1 << 25;

    /// Returns the size of a picture of square pixels.
    ///
    /// # Errors
    /// [`ResolutionError::TooLarge`], if there are more than 33,554,432 pixels.
    pub const fn new(width: u32, height: u32) -> Result<Self, ResolutionError> {
        if width as u64 * height as u64 > Self::MAX_PIXELS as u64 {
            return Err(ResolutionError::TooLarge { width, height });
        }
        Ok(Self { width, height, pixel_aspect: 1.0 })
    }

    /// Returns the size of a picture of square pixels. For sizes that are known to be valid.
    ///
    /// # Panics
    /// If there are more than 33,554,432 pixels.
    #[doc(hidden)]
    pub const fn square(width: u32, height: u32) -> Self {
        match Self::new(width, height) {
            Ok(resolution) => resolution,
            Err(_) => panic!("a picture may have 33554432 pixels"),
        }
    }

    /// Returns the same size with another pixel aspect: a pixel's height divided by its width.
    ///
    /// The aspect is 1 for half cells of a terminal whose cells are twice as high as wide.
    ///
    /// # Errors
    /// [`ResolutionError::PixelAspect`], if it is not greater than 0 and finite.
    #[doc(hidden)]
    pub const fn with_pixel_aspect(self, pixel_aspect: f32) -> Result<Self, ResolutionError> {
        if pixel_aspect > 0.0 && pixel_aspect.is_finite() {
            Ok(Self { pixel_aspect, ..self })
        } else {
            Err(ResolutionError::PixelAspect(pixel_aspect))
        }
    }

    /// Returns the number of pixels in a row.
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows of pixels.
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Returns a pixel's height divided by its width.
    #[doc(hidden)]
    pub const fn pixel_aspect(&self) -> f32 {
        self.pixel_aspect
    }

    /// Returns the picture's width divided by its height on the screen, with the pixel aspect.
    #[doc(hidden)]
    pub fn aspect_ratio(&self) -> f32 {
        self.width as f32 / (self.height as f32 * self.pixel_aspect)
    }

    /// Returns the width and height in square pixels of the picture enlarged by `scale`.
    ///
    /// Each pixel becomes `scale` square pixels along its shorter side, and more along the other, so that the picture
    /// has the shape that it has on the screen.
    #[doc(hidden)]
    pub fn size_in_square_pixels(&self, scale: u32) -> [u64; 2] {
        let [width, height] = [self.width, self.height].map(|side| u64::from(side) * u64::from(scale));
        let stretched = |side: u64, by: f32| ((side as f64 * f64::from(by)).round() as u64).max(side);
        if self.pixel_aspect < 1.0 {
            [stretched(width, 1.0 / self.pixel_aspect), height]
        } else {
            [width, stretched(height, self.pixel_aspect)]
        }
    }

    /// Returns the pixels of a picture of this size, scaled to this many `columns` and `rows`.
    ///
    /// Each pixel of the result is a copy of the nearest pixel of the picture.
    #[doc(hidden)]
    pub fn scaled_pixels<T: Copy>(self, pixels: &[T], [columns, rows]: [usize; 2]) -> impl Iterator<Item = T> {
        let (width, height) = (self.width as usize, self.height as usize);
        let lines = (0..rows).map(move |y| &pixels[y * height / rows * width..][..width]);
        lines.flat_map(move |line| (0..columns).map(move |x| line[x * width / columns]))
    }

    /// Returns the number of pixels.
    #[doc(hidden)]
    pub const fn pixel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Returns the size of the picture cropped to at most `width` columns and `height` rows.
    #[doc(hidden)]
    pub fn part(self, width: u32, height: u32) -> Self {
        Self { width: width.min(self.width), height: height.min(self.height), ..self }
    }
}

/// The error of an invalid resolution, or of a grid with too many cells.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ResolutionError {
    /// The picture has more than 33,554,432 pixels.
    TooLarge {
        /// The number of pixels in a row.
        width: u32,
        /// The number of rows.
        height: u32,
    },
    /// The grid has more than 16,777,216 cells.
    TooManyCells {
        /// The number of cells in a row.
        columns: u16,
        /// The number of rows.
        rows: u16,
    },
    /// The pixel aspect, given here, is not greater than 0 and finite.
    PixelAspect(f32),
}

/// The largest number of cells of a grid: 16,777,216, which take 268 MB.
// A 4K screen has 100,000 cells of 8 by 10 pixels. Without a limit, a grid of 65,535 columns and rows aborts the
// process because memory runs out.
pub const MAX_CELLS: usize = 1 << 24;

impl fmt::Display for ResolutionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge { width, height } => {
                let most = Resolution::MAX_PIXELS;
                write!(f, "a picture of {width}x{height} pixels is too large; at most {most} pixels in all")
            }
            Self::TooManyCells { columns, rows } => {
                write!(f, "a grid of {columns}x{rows} cells is too large; at most {MAX_CELLS} cells in all")
            }
            Self::PixelAspect(aspect) => {
                write!(f, "a pixel's height over its width must be greater than 0 and finite, and is {aspect}")
            }
        }
    }
}

impl std::error::Error for ResolutionError {}

/// A picture as linear light: one [`LinearRgb`] per pixel, row by row from the top left.
///
/// The light is unbounded and not yet exposed; [`tone`](crate::tone::tone) converts it to 8-bit colours.
///
/// ```
/// use glam::Vec3;
/// use termtrace::{Background, Camera, LinearRgb, Render, Resolution, Scene};
///
/// let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO)?;
/// let grey = LinearRgb::grey(0.5);
/// let scene = Scene::builder(camera).background(Background::Color(grey)).build()?;
/// let light = Render::new(&scene).resolution(Resolution::new(3, 2)?).run()?;
/// assert_eq!(light.pixels(), [grey; 6]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Framebuffer {
    resolution: Resolution,
    pixels: Vec<LinearRgb>,
}

impl Framebuffer {
    /// Returns a black picture.
    #[doc(hidden)]
    pub fn new(resolution: Resolution) -> Self {
        Self { resolution, pixels: vec![LinearRgb::BLACK; resolution.pixel_count()] }
    }

    /// Returns the size of the picture.
    #[doc(hidden)]
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Returns all pixels, row by row from the top.
    pub fn pixels(&self) -> &[LinearRgb] {
        &self.pixels
    }

    /// Returns all pixels for writing, row by row from the top.
    #[doc(hidden)]
    pub fn pixels_mut(&mut self) -> &mut [LinearRgb] {
        &mut self.pixels
    }

    /// Returns the light of a pixel.
    ///
    /// # Panics
    /// If the pixel is outside the picture.
    #[doc(hidden)]
    pub fn pixel(&self, x: u32, y: u32) -> LinearRgb {
        assert!(x < self.resolution.width && y < self.resolution.height, "pixel ({x}, {y}) is outside the picture");
        self.pixels[y as usize * self.resolution.width as usize + x as usize]
    }

    /// Returns a 64-bit FNV-1a hash of the size and of the bits of all pixels.
    ///
    /// Equal pictures have the same hash on every machine.
    // Tests compare it, and the benchmark prints it beside each result. FNV-1a is implemented here, because the result
    // of std's default hasher may differ between versions of Rust.
    #[doc(hidden)]
    pub fn hash(&self) -> u64 {
        let size = [self.resolution.width, self.resolution.height];
        let channels = self.pixels.iter().flat_map(|p| [p.r, p.g, p.b]).map(f32::to_bits);
        size.into_iter()
            .chain(channels)
            .flat_map(u32::to_le_bytes)
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
    }
}
