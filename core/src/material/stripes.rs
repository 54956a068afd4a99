//! A striped material: stripes of two reflectances.

use super::waves::mean_of_square_wave;
use super::{Reflecting, check_two, mixed};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber};

/// A pattern of stripes with two alternating reflectances, across the first surface coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripes {
    /// The reflectance of the stripe that starts at the pattern's origin.
    a: LinearRgb,
    /// The reflectance of the stripes next to one of reflectance `a`.
    b: LinearRgb,
    /// The width of a stripe in world units, greater than 0.
    width: f32,
}

/// The name of the field `width` in messages.
const WIDTH: &str = "width of a stripe";

impl Stripes {
    /// Returns a material of stripes of the width `width` in world units.
    ///
    /// The stripe that starts at the pattern's origin reflects `a`, its neighbours `b`.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1, or the width not between 1e-9 and 1e9.
    #[doc(hidden)]
    pub fn new(a: LinearRgb, b: LinearRgb, width: f32) -> Result<Self, SceneFault> {
        let a = checks::checked_color("a", a, checks::reflectance)?;
        let b = checks::checked_color("b", b, checks::reflectance)?;
        let width = checks::checked_number("width", width, |width| checks::length(WIDTH, width))?;
        Ok(Self { a, b, width })
    }
}

impl Reflecting for Stripes {
    const PATTERN: Option<&'static str> = Some("its stripes");

    #[inline(always)]
    fn reflectance<N: Number>(&self, [u, _]: [N; 2], [footprint, _]: [N; 2]) -> [N; 3] {
        let (half, width) = (N::splat(0.5), N::splat(self.width));
        let balance = mean_of_square_wave(u / width, footprint / width);
        mixed([self.a, self.b], [half + half * balance, half - half * balance])
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        format!("{} and {} striped", name(self.a), name(self.b))
    }

    fn check(written: &WrittenStripes, validator: &mut Validator<'_>) -> Option<Self> {
        let colors = check_two([written.a, written.b], validator);
        let width = written.width.map_or(Some(1.0), |width| validator.length(WIDTH, width));
        let ([a, b], width) = (colors?, width?);
        Some(Self { a, b, width })
    }
}

/// A striped material as written: `Stripes(a: ..., b: ..., width: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenStripes {
    /// The reflectance of every other stripe, including the one that starts at the pattern's
    /// origin; `"#dddddd"` if not given.
    pub a: Option<WrittenColor>,
    /// The reflectance of the stripes between those; `"#333333"` if not given.
    pub b: Option<WrittenColor>,
    /// The width of a stripe in world units; 1 if not given.
    pub width: Option<WrittenNumber>,
}

impl InSceneFile for Stripes {
    type Written = WrittenStripes;

    const NAME: &'static str = "Stripes";
    const OWNER: &'static str = "Stripes";
    const FORM: &'static str = "Stripes(a: ..., b: ..., width: ...)";
    const FIELDS: &'static [&'static str] = &["a", "b", "width"];
    const SUMMARY: &'static str = "Stripes of two colours.";
    const MEANINGS: &'static [&'static str] = &[
        "the colour of every other stripe; #dddddd",
        "the colour of the stripes between; #333333",
        "the width of a stripe; 1",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenStripes {
        WrittenStripes {
            a: reader.optional(fields, "a", NodeReader::color),
            b: reader.optional(fields, "b", NodeReader::color),
            width: reader.optional(fields, "width", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
