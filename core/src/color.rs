//! Colours: linear RGB, 8-bit sRGB and the transfer function between them; OKLab for differences.
//!
//! Colours have two types, because a picture that confuses them is wrong but looks plausible. [`LinearRgb`] is an
//! amount of light, which may be added and scaled. [`Srgb8`] is a code for a file or a terminal, with which that is not
//! allowed. The conversion to it is the last step of a picture (see [`tone`](crate::tone)).
//!
//! The primaries are those of sRGB (IEC 61966-2-1), the white is D65.

mod names;

use std::ops::{Add, AddAssign, Mul};

/// Linear light in the three channels of sRGB's primaries.
///
/// 1 is the screen's white at exposure 1; larger values are valid light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearRgb {
    /// Red, linear.
    pub r: f32,
    /// Green, linear.
    pub g: f32,
    /// Blue, linear.
    pub b: f32,
}

impl LinearRgb {
    /// No light.
    #[doc(hidden)]
    pub const BLACK: Self = Self::new(0.0, 0.0, 0.0);

    /// Returns light with the given linear channels.
    ///
    /// ```
    /// use termtrace::LinearRgb;
    ///
    /// assert_eq!(LinearRgb::new(0.5, 0.5, 0.5), LinearRgb::grey(0.5));
    /// ```
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// Returns light with the same amount in each channel.
    pub const fn grey(amount: f32) -> Self {
        Self::new(amount, amount, amount)
    }

    /// Returns the light of an 8-bit sRGB colour, each channel in 0..=1.
    #[doc(hidden)]
    pub fn from_srgb8(color: Srgb8) -> Self {
        // A table is faster than `powf`, which would be called three times for each pixel of a texture.
        Self::new(Self::of_code(color.r), Self::of_code(color.g), Self::of_code(color.b))
    }

    /// Returns the light of an 8-bit sRGB code, in 0..=1.
    #[inline]
    #[doc(hidden)]
    pub fn of_code(code: u8) -> f32 {
        TRANSFER.linear_from_srgb8[usize::from(code)]
    }

    /// Returns the relative luminance Y of CIE 1931.
    ///
    /// The weights are the second row of sRGB's matrix (IEC 61966-2-1).
    #[doc(hidden)]
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// Interpolates linearly from `self` (at `t` = 0) to `other` (at `t` = 1).
    #[doc(hidden)]
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self * (1.0 - t) + other * t
    }

    /// Returns whether no channel is infinite or NaN.
    #[doc(hidden)]
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }
}

/// Converts from red, green and blue, all linear.
impl From<[f32; 3]> for LinearRgb {
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self::new(r, g, b)
    }
}

/// Returns the light of an 8-bit sRGB colour, each channel in 0..=1.
impl From<Srgb8> for LinearRgb {
    fn from(color: Srgb8) -> Self {
        Self::from_srgb8(color)
    }
}

impl Add for LinearRgb {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.r + other.r, self.g + other.g, self.b + other.b)
    }
}

impl AddAssign for LinearRgb {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Multiplies per channel, as for light through a filter or reflected by a surface.
impl Mul for LinearRgb {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(self.r * other.r, self.g * other.g, self.b * other.b)
    }
}

impl Mul<f32> for LinearRgb {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        Self::new(self.r * factor, self.g * factor, self.b * factor)
    }
}

/// A colour for files and terminals: sRGB with 8 bits per channel, encoded by the transfer
/// function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Srgb8 {
    /// Red, 0..=255.
    pub r: u8,
    /// Green, 0..=255.
    pub g: u8,
    /// Blue, 0..=255.
    pub b: u8,
}

impl Srgb8 {
    /// Returns a colour with the given channels.
    ///
    /// ```
    /// use termtrace::{LinearRgb, Srgb8};
    ///
    /// assert_eq!(Srgb8::from(LinearRgb::grey(0.5)), Srgb8::new(188, 188, 188));
    /// ```
    pub const fn new(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b }
    }

    /// Returns the nearest 8-bit colour.
    ///
    /// Each channel is clamped to 0..=1, encoded by the transfer function, and rounded. NaN counts as no light.
    #[inline]
    #[doc(hidden)]
    pub fn from_linear(light: LinearRgb) -> Self {
        TRANSFER.color(light)
    }

    /// Converts a sequence of colours as [`from_linear`](Self::from_linear) does.
    pub(crate) fn all_from_linear(lights: impl Iterator<Item = LinearRgb>) -> impl Iterator<Item = Self> {
        lights.map(|light| TRANSFER.color(light))
    }
}

/// Converts from red, green and blue.
impl From<[u8; 3]> for Srgb8 {
    fn from([r, g, b]: [u8; 3]) -> Self {
        Self::new(r, g, b)
    }
}

/// Returns red, green and blue.
impl From<Srgb8> for [u8; 3] {
    fn from(Srgb8 { r, g, b }: Srgb8) -> Self {
        [r, g, b]
    }
}

/// Returns the nearest 8-bit colour.
///
/// Each channel is clamped to 0..=1, encoded by the transfer function, and rounded. NaN counts as no light.
impl From<LinearRgb> for Srgb8 {
    fn from(light: LinearRgb) -> Self {
        Self::from_linear(light)
    }
}

/// A colour in OKLab, in which equal distances look about equally different.
///
/// Source: Björn Ottosson, "A perceptual color space for image processing", 2020. OKLab only serves to compare colours,
/// never to mix them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Oklab {
    /// Lightness: 0 is black, 1 the screen's white.
    pub l: f32,
    /// From green (negative) to red, about -0.24..=0.28 on a screen.
    pub a: f32,
    /// From blue (negative) to yellow, about -0.32..=0.20 on a screen.
    pub b: f32,
}

impl Oklab {
    /// Converts an sRGB colour to OKLab.
    pub fn from_srgb8(color: Srgb8) -> Self {
        Self::from_linear(LinearRgb::from_srgb8(color))
    }

    /// The matrix from linear light to the responses of the eye's cones, whose cube roots OKLab
    /// mixes.
    pub const CONES: [[f32; 3]; 3] = [
        [0.412_221_46, 0.536_332_55, 0.051_445_995],
        [0.211_903_5, 0.680_699_5, 0.107_396_96],
        [0.088_302_46, 0.281_718_85, 0.629_978_7],
    ];

    /// The matrix from the cube roots of the cones' responses to OKLab.
    pub const FROM_ROOTS: [[f32; 3]; 3] = [
        [0.210_454_26, 0.793_617_8, -0.004_072_047],
        [1.977_998_5, -2.428_592_2, 0.450_593_7],
        [0.025_904_037, 0.782_771_77, -0.808_675_77],
    ];

    /// Converts linear light to OKLab, with Ottosson's matrices.
    pub fn from_linear(LinearRgb { r, g, b }: LinearRgb) -> Self {
        let times = |matrix: [[f32; 3]; 3], [x, y, z]: [f32; 3]| matrix.map(|row| row[0] * x + row[1] * y + row[2] * z);
        // `libm` instead of the platform's `cbrt`, so that the choices that depend on it are the same on every machine.
        let [l, a, b] = times(Self::FROM_ROOTS, times(Self::CONES, [r, g, b]).map(libm::cbrtf));
        Self { l, a, b }
    }

    /// Returns the perceived difference of two colours: their distance, which is 1 between black
    /// and white.
    pub fn distance(self, other: Self) -> f32 {
        let (l, a, b) = (self.l - other.l, self.a - other.a, self.b - other.b);
        (l * l + a * a + b * b).sqrt()
    }
}

/// Encodes by sRGB's transfer function: linear to encoded (IEC 61966-2-1), both in 0..=1.
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// Decodes by sRGB's transfer function: encoded to linear (IEC 61966-2-1), both in 0..=1.
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The number of consecutive floats in a bucket of the table of the transfer function.
///
/// The floats of a bucket share the upper half of their bits: the sign, the exponent and the first 7 bits of the
/// mantissa.
// If buckets were longer, some would contain several of the 255 steps between codes, and would need several
// comparisons.
const BUCKET_LEN: u32 = 1 << 16;
/// The number of buckets: one for each upper half of a float's bits.
const BUCKET_COUNT: usize = 1 << 16;

/// Tables of the transfer function.
struct Transfer {
    /// The linear light of each 8-bit sRGB code.
    linear_from_srgb8: [f32; 256],
    /// The bits of the least light that rounds to code `k + 1`, at index `k`; `u32::MAX` at 255.
    // Bits instead of floats: those of positive floats have the same order, and the bucket is computed from bits
    // anyway.
    bits_at_step: [u32; 256],
    /// The 8-bit code of the least light in each bucket.
    // There are also buckets above 1, so that light need not be clamped to 1 first. Without that clamp a frame of three
    // spheres takes 16.9 instead of 18.5 ms (1,024 x 1,024 pixels, one thread). The buckets below 0 are never read,
    // because `srgb8` replaces negative light by 0.
    first_code: [u8; BUCKET_COUNT],
}

impl Transfer {
    #[inline]
    fn color(&self, light: LinearRgb) -> Srgb8 {
        Srgb8::new(self.srgb8(light.r), self.srgb8(light.g), self.srgb8(light.b))
    }

    /// Clamps, encodes and rounds a channel.
    ///
    /// The result is the code of the least light in the bucket, or the next code if `linear` is at or above the step to
    /// it.
    // `pow` for each channel of each pixel would take longer than tracing the pixel.
    #[inline]
    fn srgb8(&self, linear: f32) -> u8 {
        // Negative floats become 0 first, because the order of their bits is reversed. NaN becomes 0 as well, as it
        // fails the comparison.
        let bits = if linear > 0.0 { linear } else { 0.0 }.to_bits();
        let code = self.first_code[(bits / BUCKET_LEN) as usize];
        code + u8::from(bits >= self.bits_at_step[usize::from(code)])
    }
}

/// The tables of the transfer function.
// Computed at compile time: at run time, 512 powers and three passes over 64 kB took 0.1 ms of each start. `LazyLock`
// was rejected for that reason, and because each access would test whether the tables exist.
static TRANSFER: Transfer = Transfer::new();

impl Transfer {
    #[expect(clippy::large_stack_arrays, reason = "it is on no stack but the compiler's")]
    const fn new() -> Self {
        let mut transfer =
            Self { linear_from_srgb8: [0.0; 256], bits_at_step: [u32::MAX; 256], first_code: [0; BUCKET_COUNT] };
        let mut code = 0;
        while code < 256 {
            transfer.linear_from_srgb8[code] = const_linear_from_srgb(code as f64 / 255.0) as f32;
            if code < 255 {
                let step = least_f32_at_or_above(const_linear_from_srgb((code as f64 + 0.5) / 255.0));
                transfer.bits_at_step[code] = step.to_bits();
            }
            code += 1;
        }
        let mut code = 0;
        let mut bucket = 0;
        while bucket < BUCKET_COUNT {
            while transfer.bits_at_step[code].div_ceil(BUCKET_LEN) as usize <= bucket {
                code += 1;
            }
            transfer.first_code[bucket] = code as u8;
            bucket += 1;
        }
        transfer
    }
}

/// Computes [`linear_from_srgb`] at compile time.
const fn const_linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { pow_2_4((encoded + 0.055) / 1.055) }
}

/// Returns x^2.4 for x in (0, 1]: x squared times the fifth root of x squared.
// `libm::pow` is not const. Newton's method for the root decreases from 1, and ends at the first step that does not
// decrease; a test compares the results with `libm::pow` bit by bit.
const fn pow_2_4(number: f64) -> f64 {
    let square = number * number;
    let mut root = 1.0;
    loop {
        let fourth = root * root * root * root;
        let next = (4.0 * root + square / fourth) / 5.0;
        if next >= root {
            return square * root;
        }
        root = next;
    }
}

/// Returns the least f32 that is not below `value`.
// A cast rounds to the nearest f32, which may be below.
const fn least_f32_at_or_above(value: f64) -> f32 {
    let nearest = value as f32;
    if (nearest as f64) < value { nearest.next_up() } else { nearest }
}

#[cfg(all(test, unit_tests))]
mod tests;
