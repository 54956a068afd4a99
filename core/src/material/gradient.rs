//! A graded material, whose reflectance changes from one to another and back.

use super::waves::mean_of_triangle_wave;
use super::{Reflecting, mixed};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber};

/// A linear change between two reflectances along the second surface coordinate.
///
/// It repeats mirrored, so that there is no jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// The reflectance at the pattern's origin.
    from: LinearRgb,
    /// The reflectance at the distance `length` from the origin.
    to: LinearRgb,
    /// The distance between the two reflectances in world units, greater than 0.
    length: f32,
}

/// The name of the field `length` in messages.
const LENGTH: &str = "length of a gradient";

impl Gradient {
    /// Returns a material that changes from `from` to `to` over `length` in world units.
    ///
    /// # Errors
    /// If a channel is not within 0 and 1, or the length not between 1e-9 and 1e9.
    #[doc(hidden)]
    pub fn new(from: LinearRgb, to: LinearRgb, length: f32) -> Result<Self, SceneFault> {
        let from = checks::checked_color("from", from, checks::reflectance)?;
        let to = checks::checked_color("to", to, checks::reflectance)?;
        let length = checks::checked_number("length", length, |length| checks::length(LENGTH, length))?;
        Ok(Self { from, to, length })
    }
}

impl Reflecting for Gradient {
    const PATTERN: Option<&'static str> = Some("its colours");

    #[inline(always)]
    fn reflectance<N: Number>(&self, [_, v]: [N; 2], [_, footprint]: [N; 2]) -> [N; 3] {
        let length = N::splat(self.length);
        let share = mean_of_triangle_wave(v / length, footprint / length);
        mixed([self.from, self.to], [N::splat(1.0) - share, share])
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        format!("{} to {}", name(self.from), name(self.to))
    }

    fn check(written: &WrittenGradient, validator: &mut Validator<'_>) -> Option<Self> {
        let [from, to] = [written.from, written.to].map(|color| color.and_then(|color| validator.reflectance(color)));
        let length = written.length.map_or(Some(1.0), |length| validator.length(LENGTH, length));
        Some(Self { from: from?, to: to?, length: length? })
    }
}

/// A graded material as written: `Gradient(from: ..., to: ..., length: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenGradient {
    /// The reflectance at the pattern's origin.
    pub from: Option<WrittenColor>,
    /// The reflectance at the distance `length` from the origin.
    pub to: Option<WrittenColor>,
    /// The distance between the two reflectances in world units; 1 if not given.
    pub length: Option<WrittenNumber>,
}

impl InSceneFile for Gradient {
    type Written = WrittenGradient;

    const NAME: &'static str = "Gradient";
    const OWNER: &'static str = "a Gradient";
    const FORM: &'static str = "Gradient(from: ..., to: ..., length: ...)";
    const FIELDS: &'static [&'static str] = &["from", "to", "length"];
    const SUMMARY: &'static str = "Colours from one to another and back, over and over.";
    const MEANINGS: &'static [&'static str] =
        &["the first colour", "the second colour", "the way from one to the other; 1"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenGradient {
        WrittenGradient {
            from: reader.required(fields, "from", NodeReader::color),
            to: reader.required(fields, "to", NodeReader::color),
            length: reader.optional(fields, "length", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
