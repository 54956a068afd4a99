//! A checkered material: squares of two reflectances.

use super::{Reflecting, channels};
use crate::checks::{self, SceneFault};
use crate::color::{LinearRgb, Srgb8};
use crate::lanes::Number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber};

/// A pattern of squares with two alternating reflectances, in surface coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checker {
    /// The reflectance of the square that starts at the pattern's origin.
    a: LinearRgb,
    /// The reflectance of the squares that share a side with one of reflectance `a`.
    b: LinearRgb,
    /// The side length of a square in world units, greater than 0.
    size: f32,
}

/// The name of the field `size` in messages.
const SIZE: &str = "size of a square";

impl Checker {
    /// Returns a material of squares with sides of length `size` in world units.
    ///
    /// The square that starts at the pattern's origin reflects `a`, its neighbours `b`.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1, or the size not between 1e-9 and 1e9.
    #[doc(hidden)]
    pub fn new(a: LinearRgb, b: LinearRgb, size: f32) -> Result<Self, SceneFault> {
        let a = checks::checked_color("a", a, checks::reflectance)?;
        let b = checks::checked_color("b", b, checks::reflectance)?;
        let size = checks::checked_number("size", size, |size| checks::length(SIZE, size))?;
        Ok(Self { a, b, size })
    }
}

impl Reflecting for Checker {
    const PATTERN: Option<&'static str> = Some("its squares");

    #[inline(always)]
    fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3] {
        let size = N::splat(self.size);
        let balance = mean_of_square_wave(uv[0] / size, footprint[0] / size)
            * mean_of_square_wave(uv[1] / size, footprint[1] / size);
        let half = N::splat(0.5);
        let [of_a, of_b] = [half + half * balance, half - half * balance];
        let ([r0, g0, b0], [r1, g1, b1]) = (channels::<N>(self.a), channels::<N>(self.b));
        [r0 * of_a + r1 * of_b, g0 * of_a + g1 * of_b, b0 * of_a + b1 * of_b]
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        format!("{} and {} checkered", name(self.a), name(self.b))
    }

    fn check(written: &WrittenChecker, validator: &mut Validator<'_>) -> Option<Self> {
        let mut color_or = |color: Option<WrittenColor>, grey: u8| match color {
            Some(color) => validator.reflectance(color),
            None => Some(LinearRgb::from_srgb8(Srgb8::new(grey, grey, grey))),
        };
        let (a, b) = (color_or(written.a, 0xdd), color_or(written.b, 0x33));
        let size = written.size.map_or(Some(1.0), |size| validator.length(SIZE, size));
        Some(Self { a: a?, b: b?, size: size? })
    }
}

/// A checkered material as written: `Checker(a: ..., b: ..., size: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenChecker {
    /// The reflectance of one half of the squares, including the one that starts at the pattern's
    /// origin; `"#dddddd"` if not given.
    pub a: Option<WrittenColor>,
    /// The reflectance of the other half of the squares; `"#333333"` if not given.
    pub b: Option<WrittenColor>,
    /// The side length of a square in world units; 1 if not given.
    pub size: Option<WrittenNumber>,
}

impl InSceneFile for Checker {
    type Written = WrittenChecker;

    const NAME: &'static str = "Checker";
    const OWNER: &'static str = "a Checker";
    const FORM: &'static str = "Checker(a: ..., b: ..., size: ...)";
    const FIELDS: &'static [&'static str] = &["a", "b", "size"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenChecker {
        WrittenChecker {
            a: reader.optional(fields, "a", NodeReader::color),
            b: reader.optional(fields, "b", NodeReader::color),
            size: reader.optional(fields, "size", NodeReader::number),
        }
    }
}

/// Returns the mean of a square wave over an interval.
///
/// The wave is 1 from each even integer to the next integer, and -1 otherwise.
// The mean is a box filter. The checker's mean over a footprint is the product of both axes' means, so squares too
// small for their pixels turn grey. Point samples would give a moiré pattern, and supersampling would take 64 rays.
#[inline(always)]
fn mean_of_square_wave<N: Number>(middle: N, width: N) -> N {
    let (zero, one, half) = (N::splat(0.0), N::splat(1.0), N::splat(0.5) * width);
    let (start, end) = (middle - half, middle + half);
    let (first, last) = (start.floor(), end.floor());
    let sign = N::select(is_even(first), one, -one);
    // The mean over an interval with one edge of the wave: the share before the edge minus the share after it, with the
    // sign of the wave before the edge.
    let over_one = sign * ((last - start) - (end - last)) / (end - start);
    let over_more = (triangle_wave(end) - triangle_wave(start)) / (end - start);
    let over_edges = N::select((last - first).eq(one), over_one, over_more);
    let mean = N::select(first.eq(last), sign, over_edges);
    // For widths from 1e6 on, whose intervals may be infinite or NaN, the mean is below 1e-6, and taken as 0.
    N::select(width.lt(N::splat(1e6)), mean, zero)
}

/// Returns the integral of the square wave from 0: a triangle wave.
#[inline(always)]
fn triangle_wave<N: Number>(x: N) -> N {
    let (one, two) = (N::splat(1.0), N::splat(2.0));
    let in_period = x - two * (N::splat(0.5) * x).floor();
    one - (in_period - one).abs()
}

/// Returns whether an integer is even. In f32 all integers above 2^24 are.
#[inline(always)]
fn is_even<N: Number>(whole: N) -> N::Mask {
    let half = whole * N::splat(0.5);
    half.floor().eq(half)
}
