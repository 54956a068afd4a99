//! The number and positions of a pixel's samples.

use crate::lanes::{F32x8, LANES};
use std::borrow::Cow;
use std::num::NonZeroU32;
use std::ops::Range;

/// The number of rays through the pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Sampling {
    /// One ray for every two by two pixels.
    Coarse,
    /// This many rays through each pixel, at most [`MAX_SAMPLES`](Self::MAX_SAMPLES).
    Each(NonZeroU32),
    /// One ray through each pixel; in total 4, 16 or 64 where there are edges: of objects, shadows and patterns, or
    /// where normals differ; at most this many.
    UpTo(NonZeroU32),
}

impl Sampling {
    /// The largest number of samples at edges: 64.
    pub const BEST: Self = Self::UpTo(NonZeroU32::new(64).expect("64 is not 0"));

    /// Limit on the rays through a pixel: 65,536. More would not change any 8-bit colour, and take very long.
    #[doc(hidden)]
    pub const MAX_SAMPLES: NonZeroU32 = NonZeroU32::new(1 << 16).expect("65,536 is not 0");

    /// Returns the sampling with at most [`MAX_SAMPLES`](Self::MAX_SAMPLES).
    pub(super) fn bounded(self) -> Self {
        match self {
            Self::Each(samples) => Self::Each(samples.min(Self::MAX_SAMPLES)),
            Self::Coarse | Self::UpTo(_) => self,
        }
    }
}

impl From<NonZeroU32> for Sampling {
    fn from(samples: NonZeroU32) -> Self {
        Self::Each(samples)
    }
}

/// The total number of samples after each pass over a picture: four times that of the pass before.
pub(super) const PASSES: [Range<u32>; 4] = [0..1, 1..4, 4..16, 16..64];

/// A batch of samples that are traced together, pixel by pixel: rays through one pixel hit the same things more often
/// than rays through neighbours. All have the same [`footprint_share`].
#[derive(Clone, Debug)]
pub(super) struct SampleBatch {
    pub(super) samples: Range<u32>,
    /// Positions of the batch's samples in their pixels, in groups of eight.
    pub(super) positions: [[F32x8; 2]; MAX_BATCH_RAYS / LANES],
}

/// Limit on the rays in a batch: their arrays fit the first-level cache.
pub(super) const MAX_BATCH_RAYS: usize = 256;

/// Limit on the samples of one pixel in a batch.
const MAX_BATCH_SAMPLES: u32 = 64;

/// A range of samples, divided into batches.
pub(super) struct SampleBatches {
    samples: Range<u32>,
    /// The first batch. The others are computed again for each tile, which is cheap compared with tracing them.
    kept: Vec<SampleBatch>,
}

impl SampleBatches {
    pub(super) fn of(samples: Range<u32>) -> Self {
        let kept = split(samples.clone()).take(PASSES.len()).map(SampleBatch::of).collect();
        Self { samples, kept }
    }

    /// Returns the batches in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = Cow<'_, SampleBatch>> {
        split(self.samples.clone()).enumerate().map(|(at, samples)| match self.kept.get(at) {
            Some(batch) => Cow::Borrowed(batch),
            None => Cow::Owned(SampleBatch::of(samples)),
        })
    }
}

/// Divides a range of samples at the ends of passes and by the limit on a batch.
fn split(mut samples: Range<u32>) -> impl Iterator<Item = Range<u32>> {
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

    /// Divides this many pixels into chunks, each of which makes one batch of rays.
    pub(super) fn pixel_ranges(&self, pixels: usize) -> impl Iterator<Item = Range<usize>> {
        let pixels_at_once = MAX_BATCH_RAYS / self.per_pixel();
        (0..pixels).step_by(pixels_at_once).map(move |first| first..pixels.min(first + pixels_at_once))
    }

    /// Writes the pixel of each ray of a batch.
    pub(super) fn assign_pixels(&self, pixels: &[u8], of_rays: &mut Vec<u8>) {
        of_rays.clear();
        if self.per_pixel() == 1 {
            of_rays.extend_from_slice(pixels);
        } else {
            of_rays.extend(pixels.iter().flat_map(|&pixel| std::iter::repeat_n(pixel, self.per_pixel())));
        }
    }
}

/// Returns the position of a sample in its pixel, as parts of the width and height from the top left corner: first the
/// centre, then Roberts' R2 sequence (multiples of the inverses of the plastic number and its square, modulo 1), every
/// prefix of which covers the pixel evenly. Computed in integers, so that it is exact.
pub(super) fn sample_position(sample: u32) -> (f32, f32) {
    let part = |step: u32| {
        let position = 0x8000_0000_u32.wrapping_add(sample.wrapping_mul(step));
        (position >> 8) as f32 / 16_777_216.0
    };
    (part(3_242_174_889), part(2_447_445_414))
}

/// Returns the side of the area that a sample stands for, as a share of the pixel's: the whole for a single sample,
/// half for one of four.
pub(super) fn footprint_share(sample: u32) -> f32 {
    match sample {
        0 => 1.0,
        1..4 => 0.5,
        4..16 => 0.25,
        _ => 0.125,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For any range each sample of each pixel is traced exactly once, in order, at its position, and the samples of a
    /// batch stand for the same share of a pixel.
    #[test]
    fn batches_leave_nothing_out() {
        for samples in [0..1, 0..3, 0..16, 1..4, 4..16, 16..64, 0..64, 0..65, 0..300, 5..7] {
            for pixels in [0, 1, 5, 21, 22, 255, 256] {
                let mut traced = vec![Vec::new(); pixels];
                for batch in SampleBatches::of(samples.clone()).iter() {
                    let shares = [batch.samples.start, batch.samples.end - 1].map(footprint_share);
                    assert_eq!(shares[0], shares[1], "{:?}", batch.samples);
                    for range in batch.pixel_ranges(pixels) {
                        let numbers: Vec<_> = (0..=u8::MAX).take(pixels).collect();
                        let mut of_rays = Vec::new();
                        batch.assign_pixels(&numbers[range], &mut of_rays);
                        assert!(of_rays.len() <= MAX_BATCH_RAYS, "{samples:?} of {pixels} pixels");
                        for (ray, &pixel) in of_rays.iter().enumerate() {
                            let [x, y] = &batch.positions[ray / LANES];
                            traced[usize::from(pixel)].push((x.0[ray % LANES], y.0[ray % LANES]));
                        }
                    }
                }
                let wanted: Vec<_> = samples.clone().map(sample_position).collect();
                assert!(traced.iter().all(|traced| *traced == wanted), "{samples:?} of {pixels} pixels");
            }
        }
    }
}
