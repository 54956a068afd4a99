//! Tone mapping: exposure, tone curve, transfer function, rounding to 8 bits.
//!
//! All stages before tone mapping compute with linear light, all stages after it with 8-bit sRGB.

use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::Framebuffer;
use crate::scene::{Scene, ToneCurve};
use crate::threads;

/// A picture of 8-bit sRGB colours, for files and terminals.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The `width * height` pixels, row by row from the top.
    pub(crate) pixels: Vec<Srgb8>,
}

impl Picture {
    /// Returns the picture with the given pixels, row by row from the top.
    ///
    /// Returns `None` unless there are `width * height` pixels.
    ///
    /// ```
    /// use termtrace::{Picture, Srgb8};
    ///
    /// let grey = Srgb8::new(128, 128, 128);
    /// let picture = Picture::from_pixels(3, 2, vec![grey; 6]).ok_or("there are six pixels")?;
    /// assert_eq!((picture.width(), picture.height()), (3, 2));
    /// assert_eq!(picture.to_bytes(), [128; 18]);
    /// assert_eq!(Picture::from_pixels(3, 2, vec![grey; 5]), None);
    /// # Ok::<(), &str>(())
    /// ```
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<Srgb8>) -> Option<Self> {
        let count = u64::from(width) * u64::from(height);
        (pixels.len() as u64 == count).then_some(Self { width, height, pixels })
    }

    /// Returns the number of pixels in a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows of pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the pixels, row by row from the top.
    pub fn pixels(&self) -> &[Srgb8] {
        &self.pixels
    }

    /// Returns the pixels, row by row from the top, to be changed.
    #[doc(hidden)]
    pub fn pixels_mut(&mut self) -> &mut [Srgb8] {
        &mut self.pixels
    }

    /// Returns the picture with each colour replaced by what `f` returns for it.
    #[doc(hidden)]
    #[must_use]
    pub fn map_colors(&self, f: impl Fn(&Srgb8) -> Srgb8) -> Self {
        Self { pixels: self.pixels.iter().map(f).collect(), ..*self }
    }

    /// Returns the red, green and blue bytes of all pixels, row by row from the top.
    ///
    /// This is the layout that the crates `image` and `png` take.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.pixels.iter().flat_map(|pixel| [pixel.r, pixel.g, pixel.b]).collect()
    }
}

/// Converts light to 8-bit colours, with the exposure and tone curve of `scene`.
///
/// ```
/// use glam::Vec3;
/// use termtrace::{Background, Camera, LinearRgb, Render, Resolution, Scene, Srgb8, tone};
///
/// let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO)?;
/// let scene = Scene::builder(camera).background(Background::Color(LinearRgb::grey(2.0))).build()?;
/// let light = Render::new(&scene).resolution(Resolution::new(1, 1)?).run()?;
/// assert_eq!(tone(&light, &scene).pixels(), [Srgb8::new(255, 255, 255)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tone(framebuffer: &Framebuffer, scene: &Scene) -> Picture {
    let [width, height] = [framebuffer.resolution().width(), framebuffer.resolution().height()];
    let (curve, exposure) = (scene.tone_curve(), scene.exposure());
    let mut pixels = vec![Srgb8::new(0, 0, 0); framebuffer.pixels().len()];
    let show = |pixels: &mut [Srgb8], lights: &[LinearRgb]| {
        let shown = Srgb8::all_from_linear(lights.iter().map(|&light| apply_curve(curve, light * exposure)));
        pixels.iter_mut().zip(shown).for_each(|(pixel, shown)| *pixel = shown);
    };
    if pixels.len() <= MIN_PARALLEL_PIXELS {
        show(&mut pixels, framebuffer.pixels());
    } else {
        threads::for_each_chunk(&mut pixels, framebuffer.pixels(), MIN_PARALLEL_PIXELS, show);
    }
    Picture { width, height, pixels }
}

/// The number of pixels up to which the calling thread works alone.
///
/// Larger pictures are split into chunks of this size.
// Waking another thread takes 16 to 80 us, more than it saves on fewer pixels.
const MIN_PARALLEL_PIXELS: usize = 1 << 16;

/// Returns light with the exposure and tone curve of `scene` applied. 1 and above is white.
pub fn tone_mapped(light: LinearRgb, scene: &Scene) -> LinearRgb {
    apply_curve(scene.tone_curve(), light * scene.exposure())
}

/// Applies a tone curve to exposed light. The result is still linear.
fn apply_curve(curve: ToneCurve, light: LinearRgb) -> LinearRgb {
    match curve {
        ToneCurve::None => light,
        // Reinhard, Stark, Shirley and Ferwerda 2002, equation 3. Applied to the luminance, it keeps hues; applied to
        // each channel, it would bleach bright colours.
        ToneCurve::Reinhard => light * (1.0 / (1.0 + light.luminance())),
        ToneCurve::Filmic => LinearRgb::new(filmic(light.r), filmic(light.g), filmic(light.b)),
    }
}

/// Applies Krzysztof Narkowicz's fit (2015) of the ACES transforms to a channel.
fn filmic(x: f32) -> f32 {
    // The value is clamped far beyond white, because the squares of much brighter light are infinite in f32, and their
    // quotient NaN, which is displayed as black.
    let x = x.min(1e6);
    (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
}
