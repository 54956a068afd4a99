//! A checkered material: squares of two reflectances.

use super::waves::mean_of_square_wave;
use super::{Reflecting, check_two, mixed};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
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

    /// Returns the side length of a square in world units.
    #[cfg(feature = "ron")]
    pub(crate) fn size(&self) -> f32 {
        self.size
    }
}

impl Reflecting for Checker {
    const PATTERN: Option<&'static str> = Some("its squares");

    #[inline(always)]
    fn reflectance<N: Number>(&self, uv: [N; 2], footprint: [N; 2]) -> [N; 3] {
        let size = N::splat(self.size);
        // The mean over a footprint is the product of both axes' means, so squares too small for their pixels turn
        // grey. Point samples would give a moiré pattern, and supersampling would take 64 rays.
        let balance = mean_of_square_wave(uv[0] / size, footprint[0] / size)
            * mean_of_square_wave(uv[1] / size, footprint[1] / size);
        let half = N::splat(0.5);
        mixed([self.a, self.b], [half + half * balance, half - half * balance])
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        format!("{} and {} checkered", name(self.a), name(self.b))
    }

    fn check(written: &WrittenChecker, validator: &mut Validator<'_>) -> Option<Self> {
        let colors = check_two([written.a, written.b], validator);
        let size = written.size.map_or(Some(1.0), |size| validator.length(SIZE, size));
        let ([a, b], size) = (colors?, size?);
        Some(Self { a, b, size })
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
    const SUMMARY: &'static str = "Squares of two colours.";
    const MEANINGS: &'static [&'static str] = &[
        "the colour of every other square; #dddddd",
        "the colour of the squares between; #333333",
        "the side of a square; 1",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenChecker {
        WrittenChecker {
            a: reader.optional(fields, "a", NodeReader::color),
            b: reader.optional(fields, "b", NodeReader::color),
            size: reader.optional(fields, "size", NodeReader::number),
        }
    }
}
