//! The number and positions of a pixel's samples.

use crate::lanes::{F32x8, LANES};
use std::borrow::Cow;
use std::num::NonZeroU32;
use std::ops::Range;

/// How many samples each pixel of a picture gets. A sample is an eye ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Sampling {
    /// One ray for each block of two by two pixels.
    Coarse,
    /// One ray for each block of two by two pixels, and one for each pixel in blocks that differ
    /// most.
    ///
    /// Blocks that differ most from a neighbour get one ray for each pixel, but at most nine of 32 blocks: a picture
    /// has at most 2.125 rays per block. If fewer blocks differ, the rays that are left go to the pixels of these
    /// blocks that differ most, 16 to each.
    Split,
    /// The same number of rays through each pixel, at most 65,536.
    Each(NonZeroU32),
    /// One ray through each pixel, and 4, 16 or 64 rays at edges, limited to the given number.
    ///
    /// Edges are those of objects, shadows and patterns, and places where normals differ.
    UpTo(NonZeroU32),
}

impl Sampling {
    /// Adaptive sampling with up to 64 samples at edges.
    pub const BEST: Self = Self::UpTo(NonZeroU32::new(64).expect("64 is not 0"));

    /// Returns the samples per pixel as text, or their maximum: `1/4 sample`, `64 samples`.
    #[doc(hidden)]
    pub fn samples_per_pixel(self) -> String {
        match self {
            // Coarse sampling traces one ray for 2x2 pixels.
            Self::Coarse => "1/4 sample".to_owned(),
            Self::Split => "1/4 to 16 samples".to_owned(),
            Self::Each(samples) | Self::UpTo(samples) if samples.get() == 1 => "1 sample".to_owned(),
            Self::Each(samples) | Self::UpTo(samples) => format!("{samples} samples"),
        }
    }

    /// The largest number of rays through a pixel: 65,536.
    ///
    /// More rays would not change any 8-bit colour, and 2^32 - 1 would take minutes for a single pixel.
    #[doc(hidden)]
    pub const MAX_SAMPLES: NonZeroU32 = NonZeroU32::new(1 << 16).expect("65,536 is not 0");

    /// Returns the sampling with at most [`MAX_SAMPLES`](Self::MAX_SAMPLES) samples per pixel.
    pub(super) fn capped_at_max_samples(self) -> Self {
        match self {
            Self::Each(samples) => Self::Each(samples.min(Self::MAX_SAMPLES)),
            Self::Coarse | Self::Split | Self::UpTo(_) => self,
        }
    }
}

impl From<NonZeroU32> for Sampling {
    fn from(samples: NonZeroU32) -> Self {
        Self::Each(samples)
    }
}

/// The samples of each pass of adaptive sampling.
///
/// After each pass, a refined pixel has four times as many samples as before.
// Four times as many samples about halve the error of the mean; a smaller gain would not be worth a pass.
pub(super) const PASSES: [Range<u32>; 4] = [0..1, 1..4, 4..16, 16..64];

/// A range of sample numbers that are traced together and have the same [`footprint_share`].
// Rays are ordered pixel by pixel, because rays through one pixel hit the same primitives more often than rays through
// neighbouring pixels. Ordered sample by sample, the bunny at 200x120 took 53.1 instead of 27.0 ms with best samples,
// and 42.0 instead of 28.5 ms with 16; only scenes of a few spheres were faster (10.9 instead of 11.3 ms).
#[derive(Clone, Debug)]
pub(super) struct SampleBatch {
    pub(super) samples: Range<u32>,
    /// The position of each ray's sample in its pixel, in groups of eight rays.
    pub(super) positions: [[F32x8; 2]; MAX_BATCH_RAYS / LANES],
}

/// The largest number of rays in a batch.
// With 256 rays the arrays between the steps take 43 kB, about the size of a first-level cache.
pub(super) const MAX_BATCH_RAYS: usize = 256;

/// The largest number of samples per pixel in a batch: as many as a packet has rays.
const MAX_BATCH_SAMPLES: u32 = 64;

/// A range of samples, divided into batches.
pub(super) struct SampleBatches {
    samples: Range<u32>,
    /// The first batches of the range, computed once; at most as many as there are [`PASSES`].
    // All further batches are computed again for each tile, which is cheap compared with tracing them. Storing all
    // batches of MAX_SAMPLES would take 2 MB.
    kept: Vec<SampleBatch>,
}

impl SampleBatches {
    pub(super) fn of(samples: Range<u32>) -> Self {
        let kept = batch_ranges(samples.clone()).take(PASSES.len()).map(SampleBatch::of).collect();
        Self { samples, kept }
    }

    /// Returns the batches in the order of their samples.
    pub(super) fn iter(&self) -> impl Iterator<Item = Cow<'_, SampleBatch>> {
        batch_ranges(self.samples.clone()).enumerate().map(|(at, samples)| match self.kept.get(at) {
            Some(batch) => Cow::Borrowed(batch),
            None => Cow::Owned(SampleBatch::of(samples)),
        })
    }
}

/// Divides a range of samples at the ends of passes, into ranges of at most [`MAX_BATCH_SAMPLES`].
fn batch_ranges(mut samples: Range<u32>) -> impl Iterator<Item = Range<u32>> {
    std::iter::from_fn(move || {
        let Range { start, end } = samples;
        let of_pass = PASSES.iter().map(|pass| pass.end).find(|&end| start < end);
        samples.start = end.min(of_pass.unwrap_or(end)).min(start.saturating_add(MAX_BATCH_SAMPLES));
        (start < end).then_some(start..samples.start)
    })
}

impl SampleBatch {
    pub(super) fn of(samples: Range<u32>) -> Self {
        let mut batch = Self { samples, positions: [[F32x8::ZERO; 2]; MAX_BATCH_RAYS / LANES] };
        for ray in 0..MAX_BATCH_RAYS {
            let (x, y) = sample_position(batch.samples.start + (ray % batch.per_pixel()) as u32);
            let [all_x, all_y] = &mut batch.positions[ray / LANES];
            (all_x.0[ray % LANES], all_y.0[ray % LANES]) = (x, y);
        }
        batch
    }

    /// Returns the number of samples per pixel.
    pub(super) fn per_pixel(&self) -> usize {
        self.samples.len()
    }

    /// Divides `0..pixels` into ranges of pixels with at most [`MAX_BATCH_RAYS`] rays each.
    pub(super) fn pixel_ranges(&self, pixels: usize) -> impl Iterator<Item = Range<usize>> {
        let pixels_at_once = MAX_BATCH_RAYS / self.per_pixel();
        (0..pixels).step_by(pixels_at_once).map(move |first| first..pixels.min(first + pixels_at_once))
    }

    /// Writes the number in its pixel of the sample of each of `rays` rays to `of_rays`.
    pub(super) fn assign_samples(&self, rays: usize, of_rays: &mut Vec<u32>) {
        of_rays.clear();
        of_rays.extend(self.samples.clone().cycle().take(rays));
    }

    /// Writes the index of each ray's pixel to `of_rays`.
    pub(super) fn assign_pixels(&self, pixels: &[u8], of_rays: &mut Vec<u8>) {
        of_rays.clear();
        if self.per_pixel() == 1 {
            of_rays.extend_from_slice(pixels);
        } else {
            of_rays.extend(pixels.iter().flat_map(|&pixel| std::iter::repeat_n(pixel, self.per_pixel())));
        }
    }
}

/// Returns the position of a sample in its pixel, from (0, 0) at the top left corner to (1, 1).
///
/// The first sample is at the centre; the others follow Roberts' R2 sequence (multiples of the inverses of the plastic
/// number and its square, modulo 1), every prefix of which covers the pixel evenly.
// A low-discrepancy sequence instead of random or jittered positions, because the picture must be the same every time,
// and any pass may be the last. It is computed in integers modulo 2^32, to be exact on every CPU.
pub(super) fn sample_position(sample: u32) -> (f32, f32) {
    let part = |step: u32| {
        let position = 0x8000_0000_u32.wrapping_add(sample.wrapping_mul(step));
        (position >> 8) as f32 / 16_777_216.0
    };
    (part(3_242_174_889), part(2_447_445_414))
}

/// Returns the side of a sample's footprint as a fraction of the pixel's side.
///
/// It is 1 for the first sample, 1/2 for the second to the fourth, 1/4 up to the 16th, and 1/8 for all others.
// The footprint of a sample does not depend on the final number of samples, because adding samples must not change
// earlier ones.
pub(super) fn footprint_share(sample: u32) -> f32 {
    match sample {
        0 => 1.0,
        1..4 => 0.5,
        4..16 => 0.25,
        _ => 0.125,
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
