//! A mottled material: irregular spots of two reflectances.

use super::{Reflecting, check_two, mixed};
use crate::checks::{self, SceneFault};
use crate::color::LinearRgb;
use crate::lanes::Number;
use crate::written::{Fields, InSceneFile, NodeReader, Validator, WrittenColor, WrittenNumber};

/// A pattern of smooth random spots between two reflectances, the same in every picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    a: LinearRgb,
    b: LinearRgb,
    /// The size of the largest spots in world units, greater than 0.
    size: f32,
}

/// The name of the field `size` in messages.
const SIZE: &str = "size of a spot";

/// The octaves of the noise: each has cells of half the size and half the weight of the one before.
// The shifts keep the octaves from having equal random numbers or cell edges, where the noise is flat, at the same
// places.
const OCTAVES: [Octave; 3] = [
    Octave { cells: 1.0, weight: 4.0 / 7.0, shift: 0.0 },
    Octave { cells: 2.0, weight: 2.0 / 7.0, shift: 37.37 },
    Octave { cells: 4.0, weight: 1.0 / 7.0, shift: 71.71 },
];

/// A layer of the noise.
struct Octave {
    /// The number of cells in a length of 1.
    cells: f32,
    /// The weight in the sum; the weights of all octaves add up to 1.
    weight: f32,
    /// The distance by which the cells are moved along both axes, in cells.
    shift: f32,
}

impl Noise {
    /// Returns a material of spots of about the size `size` in world units.
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

impl Reflecting for Noise {
    const PATTERN: Option<&'static str> = Some("its spots");

    #[inline(always)]
    fn reflectance<N: Number>(&self, [u, v]: [N; 2], footprint: [N; 2]) -> [N; 3] {
        let size = N::splat(self.size);
        let share = noise([u / size, v / size], [footprint[0] / size, footprint[1] / size]);
        mixed([self.a, self.b], [N::splat(1.0) - share, share])
    }

    fn described(&self, name: fn(LinearRgb) -> &'static str) -> String {
        format!("{} and {} mottled", name(self.a), name(self.b))
    }

    fn check(written: &WrittenNoise, validator: &mut Validator<'_>) -> Option<Self> {
        let colors = check_two([written.a, written.b], validator);
        let size = written.size.map_or(Some(1.0), |size| validator.length(SIZE, size));
        let ([a, b], size) = (colors?, size?);
        Some(Self { a, b, size })
    }
}

/// Returns the noise at a place, from 0 to 1.
///
/// An octave fades to its mean as the footprint grows to four of its cells along an axis.
#[inline(always)]
fn noise<N: Number>([x, y]: [N; 2], footprint: [N; 2]) -> N {
    let (half, two, three) = (N::splat(0.5), N::splat(2.0), N::splat(3.0));
    let mut sum = half;
    for Octave { cells, weight, shift } in OCTAVES {
        let (cells, shift) = (N::splat(cells), N::splat(shift));
        let share = remaining(footprint[0] * cells) * remaining(footprint[1] * cells);
        let difference = cell_noise([x * cells + shift, y * cells + shift]) - half;
        sum = sum + N::splat(weight) * share * difference;
    }
    // The sum is seldom near 0 or 1. The smooth step makes both reflectances visible, and keeps the mean.
    sum * sum * (three - two * sum)
}

/// Returns the share of the noise that remains in its mean over a number of cells along one axis.
// The mean is estimated from the value in the middle, by their correlation: 1 - cells / 4 up to two cells, and near 0
// for more.
#[inline(always)]
fn remaining<N: Number>(cells: N) -> N {
    // For NaN `max` returns 0.
    (N::splat(1.0) - N::splat(0.25) * cells).max(N::splat(0.0))
}

/// Returns noise of one octave, from 0 to 1, with cells of size 1.
///
/// Each corner of a cell has a random number. Between corners the noise is a smooth mean of them.
#[inline(always)]
fn cell_noise<N: Number>([x, y]: [N; 2]) -> N {
    let (one, two, three) = (N::splat(1.0), N::splat(2.0), N::splat(3.0));
    let (left, bottom) = (x.floor(), y.floor());
    // For an infinite place the difference is NaN, for which `max` returns 0.
    let zero = N::splat(0.0);
    let (x, y) = ((x - left).max(zero), (y - bottom).max(zero));
    let (of_right, of_top) = (x * x * (three - two * x), y * y * (three - two * y));
    let (of_left, of_bottom) = (one - of_right, one - of_top);
    let [bottom_left, bottom_right, top_left, top_right] = N::map_lanes([left, bottom], corners);
    (bottom_left * of_left + bottom_right * of_right) * of_bottom + (top_left * of_left + top_right * of_right) * of_top
}

/// Returns the random numbers at the four corners of a cell, whose lower left corner is at
/// integers.
fn corners([left, bottom]: [f32; 2]) -> [f32; 4] {
    // The conversion saturates, but so far away neighbouring f32 are more than a cell apart.
    let (left, bottom) = (left as i32 as u32, bottom as i32 as u32);
    let (right, top) = (left.wrapping_add(1), bottom.wrapping_add(1));
    let [bottom, top] = [bottom, top].map(scrambled);
    [(left, bottom), (right, bottom), (left, top), (right, top)].map(|(column, row)| {
        let bits = scrambled(column.wrapping_add(row));
        // 24 bits are exact in f32.
        (bits >> 8) as f32 / 16_777_216.0
    })
}

/// Returns a hash of `number`, by C. Wellons's `lowbias32`.
#[inline(always)]
fn scrambled(number: u32) -> u32 {
    // Without the sum, the hash of 0 would be 0.
    let mut bits = number.wrapping_add(0x9e37_79b9);
    bits = (bits ^ bits >> 16).wrapping_mul(0x7feb_352d);
    bits = (bits ^ bits >> 15).wrapping_mul(0x846c_a68b);
    bits ^ bits >> 16
}

/// A mottled material as written: `Noise(a: ..., b: ..., size: ...)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenNoise {
    /// The first reflectance; `"#dddddd"` if not given.
    pub a: Option<WrittenColor>,
    /// The second reflectance; `"#333333"` if not given.
    pub b: Option<WrittenColor>,
    /// The size of the largest spots in world units; 1 if not given.
    pub size: Option<WrittenNumber>,
}

impl InSceneFile for Noise {
    type Written = WrittenNoise;

    const NAME: &'static str = "Noise";
    const OWNER: &'static str = "Noise";
    const FORM: &'static str = "Noise(a: ..., b: ..., size: ...)";
    const FIELDS: &'static [&'static str] = &["a", "b", "size"];
    const SUMMARY: &'static str = "Irregular spots between two colours.";
    const MEANINGS: &'static [&'static str] =
        &["one of the colours; #dddddd", "the other colour; #333333", "the size of the spots; 1"];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenNoise {
        WrittenNoise {
            a: reader.optional(fields, "a", NodeReader::color),
            b: reader.optional(fields, "b", NodeReader::color),
            size: reader.optional(fields, "size", NodeReader::number),
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
