//! The samples of a pixel, and whether it needs more.

use crate::color::LinearRgb;
use glam::Vec3;

/// The first sample of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FirstSample {
    pub(super) light: LinearRgb,
    /// The object's number, from 1; 0 for none.
    object: u32,
    normal: Vec3,
    lit_by: u32,
}

impl FirstSample {
    /// Returns the sample with this light, from an object with its normal or from none, and the lights that reach it.
    pub(super) fn new(light: LinearRgb, surface: Option<(u32, Vec3)>, lit_by: u32) -> Self {
        let (object, normal) = surface.map_or((0, Vec3::ZERO), |(object, normal)| (object + 1, normal));
        Self { light, object, normal, lit_by }
    }

    /// Returns whether an edge may run between two pixels: of an object, a shadow, a pattern, or a surface that bends
    /// by more than 22.5 degrees. `white` is the light that is displayed as white.
    pub(super) fn is_edge_to(&self, other: &Self, white: f32) -> bool {
        const MIN_NORMAL_COSINE: f32 = 0.92;
        self.object != other.object
            || self.lit_by != other.lit_by
            || self.object != 0 && self.normal.dot(other.normal) < MIN_NORMAL_COSINE
            || differ(self.light, other.light, EDGE_CONTRAST, white)
    }
}

/// The accumulator of a pixel's samples, with the data that tell whether it needs more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Accumulator {
    /// The sum of the samples.
    light: LinearRgb,
    count: u32,
    /// The least and the greatest light of the first samples, at most [`RANGE_SAMPLES`], per channel.
    range: [LinearRgb; 2],
}

impl Accumulator {
    /// Returns an accumulator with one sample.
    pub(super) fn new(first: &FirstSample) -> Self {
        let mut range = [f32::INFINITY, f32::NEG_INFINITY].map(LinearRgb::grey);
        widen(&mut range, first.light);
        Self { light: first.light, count: 1, range }
    }

    /// Adds samples, given per channel.
    pub(super) fn add(&mut self, [r, g, b]: [&[f32]; 3]) {
        let lights = || r.iter().zip(g).zip(b).map(|((&r, &g), &b)| LinearRgb::new(r, g, b));
        lights().for_each(|light| self.light += light);
        // After that many samples the range is no longer needed.
        if self.count < RANGE_SAMPLES {
            lights().for_each(|light| widen(&mut self.range, light));
        }
        self.count += r.len() as u32;
    }

    /// Returns the mean of the samples.
    pub(super) fn mean(&self) -> LinearRgb {
        self.light * (1.0 / self.count as f32)
    }

    /// Returns whether there is more than one sample.
    pub(super) fn is_refined(&self) -> bool {
        self.count > 1
    }

    /// Returns whether the samples differ so much that their mean is uncertain.
    pub(super) fn is_noisy(&self, white: f32) -> bool {
        differ(self.range[0], self.range[1], NOISE_CONTRAST, white)
    }
}

/// Extends a range by a light.
fn widen([least, most]: &mut [LinearRgb; 2], light: LinearRgb) {
    let join = |a: LinearRgb, b: LinearRgb, is_wanted: fn(f32, f32) -> bool| {
        let one = |a: f32, b: f32| if is_wanted(a, b) { a } else { b };
        LinearRgb::new(one(a.r, b.r), one(a.g, b.g), one(a.b, b.b))
    };
    *least = join(light, *least, |a, b| a < b);
    *most = join(light, *most, |a, b| a > b);
}

/// Relative difference of neighbours that is visible as an edge.
const EDGE_CONTRAST: f32 = 0.05;

/// Number of samples that decide whether more are needed.
const RANGE_SAMPLES: u32 = 16;

/// Relative difference among that many samples at which the mean may be off by a visible amount.
const NOISE_CONTRAST: f32 = 0.2;

/// Returns whether two lights differ by this share of the greater one in a channel, and by more than is visible in the
/// dark.
fn differ(a: LinearRgb, b: LinearRgb, share: f32, white: f32) -> bool {
    const MIN_CONTRAST: f32 = 0.005;
    [(a.r, b.r), (a.g, b.g), (a.b, b.b)]
        .into_iter()
        .any(|(a, b)| (a - b).abs() > share * a.max(b) + MIN_CONTRAST * white)
}
