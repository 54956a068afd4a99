//! The picture as light: what arrives at the eye through each pixel.

use crate::color::LinearRgb;

/// A picture's size in pixels, and their shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Pixels in a row.
    pub width: u32,
    /// Rows of pixels.
    pub height: u32,
    /// A pixel's height over its width, greater than 0. A half cell of the usual terminal is square: 1.
    pub pixel_aspect: f32,
}

impl Resolution {
    /// Square pixels.
    pub const fn square(width: u32, height: u32) -> Self {
        Self { width, height, pixel_aspect: 1.0 }
    }

    /// The picture's aspect ratio as it is seen: width over height.
    #[doc(hidden)]
    pub fn aspect_ratio(&self) -> f32 {
        self.width as f32 / (self.height as f32 * self.pixel_aspect)
    }

    /// How many pixels there are.
    pub(crate) fn pixel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// Linear light per pixel, row by row from the top; pixel (0, 0) is top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Framebuffer {
    /// Its size.
    pub resolution: Resolution,
    /// `width * height` pixels.
    pub pixels: Vec<LinearRgb>,
}

impl Framebuffer {
    /// A black picture.
    #[doc(hidden)]
    pub fn new(resolution: Resolution) -> Self {
        Self { resolution, pixels: vec![LinearRgb::BLACK; resolution.pixel_count()] }
    }

    /// The light at a pixel.
    ///
    /// # Panics
    /// Outside the picture.
    #[doc(hidden)]
    pub fn pixel(&self, x: u32, y: u32) -> LinearRgb {
        assert!(x < self.resolution.width && y < self.resolution.height, "pixel ({x}, {y}) is outside the picture");
        self.pixels[y as usize * self.resolution.width as usize + x as usize]
    }

    /// A 64-bit hash of the exact bits of all pixels and of the size (FNV-1a over 32-bit words, little end first):
    /// equal pictures, and as good as only those, have equal hashes, on every machine.
    #[doc(hidden)]
    pub fn hash(&self) -> u64 {
        let size = [self.resolution.width, self.resolution.height];
        let bands = self.pixels.iter().flat_map(|p| [p.r, p.g, p.b]).map(f32::to_bits);
        size.into_iter()
            .chain(bands)
            .flat_map(u32::to_le_bytes)
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
    }
}
