//! The samples of a pixel, and the criteria by which the pixel gets more samples.

use crate::color::LinearRgb;
use glam::Vec3;

/// The first sample of a pixel, with the data of its hit by which edges between pixels are found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FirstSample {
    pub(super) light: LinearRgb,
    /// The index of the object hit, plus 1; 0 without a hit.
    object: u32,
    /// The shading normal. Unit length, or zero without a hit.
    normal: Vec3,
    /// The mask of lights that reach the hit.
    lit_by: u32,
}

impl FirstSample {
    /// Returns a sample of a surface, or of the background if `surface` is `None`.
    ///
    /// `surface` is the object's index and the shading normal, `lit_by` the mask of lights that reach the hit.
    pub(super) fn new(light: LinearRgb, surface: Option<(u32, Vec3)>, lit_by: u32) -> Self {
        let (object, normal) = surface.map_or((0, Vec3::ZERO), |(object, normal)| (object + 1, normal));
        Self { light, object, normal, lit_by }
    }

    /// Returns whether an edge of an object, shadow, pattern or curved surface may run between two
    /// pixels.
    ///
    /// `white` is the light that is displayed as white.
    pub(super) fn is_edge_to(&self, other: &Self, white: f32) -> bool {
        // The cosine of 23 degrees. Comparing normals finds creases and strong curves even if both pixels have the same
        // light.
        const MIN_NORMAL_COSINE: f32 = 0.92;
        self.object != other.object
            || self.lit_by != other.lit_by
            || self.object != 0 && self.normal.dot(other.normal) < MIN_NORMAL_COSINE
            || differ(self.light, other.light, EDGE_CONTRAST, white)
    }
}

/// The sum of a pixel's samples, and their range as a measure of noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Accumulator {
    /// The sum of the samples.
    light: LinearRgb,
    count: u32,
    /// The minimum and maximum light of the first [`RANGE_SAMPLES`] samples, per channel.
    // A range instead of a variance, because it is exact, and does not depend on the order of the samples.
    range: [LinearRgb; 2],
}

impl Accumulator {
    /// Returns an accumulator with one sample.
    pub(super) fn new(first: &FirstSample) -> Self {
        let mut range = [f32::INFINITY, f32::NEG_INFINITY].map(LinearRgb::grey);
        widen(&mut range, first.light);
        Self { light: first.light, count: 1, range }
    }

    /// Adds samples; each channel of their light is a slice.
    pub(super) fn add_samples(&mut self, [r, g, b]: [&[f32]; 3]) {
        let lights = || r.iter().zip(g).zip(b).map(|((&r, &g), &b)| LinearRgb::new(r, g, b));
        lights().for_each(|light| self.light += light);
        // The samples of the last pass are not included, because the range is only read before that pass.
        if self.count < RANGE_SAMPLES {
            lights().for_each(|light| widen(&mut self.range, light));
        }
        self.count += r.len() as u32;
    }

    /// Returns the mean of the samples.
    pub(super) fn mean(&self) -> LinearRgb {
        self.light * (1.0 / self.count as f32)
    }

    /// Returns whether the pixel has more than one sample.
    pub(super) fn is_refined(&self) -> bool {
        self.count > 1
    }

    /// Returns whether the samples differ enough to make their mean uncertain.
    pub(super) fn is_noisy(&self, white: f32) -> bool {
        differ(self.range[0], self.range[1], NOISE_CONTRAST, white)
    }
}

/// Widens the range between `least` and `most` so that it includes a light, per channel.
// `f32::min` and `max` would take twice the comparisons, because they also handle NaN, which light never is.
fn widen([least, most]: &mut [LinearRgb; 2], light: LinearRgb) {
    let join = |a: LinearRgb, b: LinearRgb, is_wanted: fn(f32, f32) -> bool| {
        let one = |a: f32, b: f32| if is_wanted(a, b) { a } else { b };
        LinearRgb::new(one(a.r, b.r), one(a.g, b.g), one(a.b, b.b))
    };
    *least = join(light, *least, |a, b| a < b);
    *most = join(light, *most, |a, b| a > b);
}

/// The relative difference of light from which on two neighbouring pixels show a visible edge.
// 5 % of linear light are three steps of 8-bit sRGB at middle grey, and six near white.
const EDGE_CONTRAST: f32 = 0.05;

/// The number of samples whose range decides whether the last pass adds more.
const RANGE_SAMPLES: u32 = 16;

/// The relative difference among [`RANGE_SAMPLES`] samples above which their mean may be visibly
/// wrong.
// This is a difference between single samples. The error of the mean of 16 samples is a quarter of the error of a
// single sample. So at four times `EDGE_CONTRAST`, the error of the mean is about as large as the contrast of a visible
// edge.
const NOISE_CONTRAST: f32 = 0.2;

/// Returns whether two lights differ in a channel by more than the fraction `share` of the greater
/// one.
fn differ(a: LinearRgb, b: LinearRgb, share: f32, white: f32) -> bool {
    // Half a percent of white is added to the relative limit, because relative differences are invisible where the
    // light is dark.
    const MIN_CONTRAST: f32 = 0.005;
    [(a.r, b.r), (a.g, b.g), (a.b, b.b)]
        .into_iter()
        .any(|(a, b)| (a - b).abs() > share * a.max(b) + MIN_CONTRAST * white)
}
