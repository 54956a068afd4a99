//! How many samples a pixel gets, and where they lie.

use std::num::NonZeroU32;
use std::ops::Range;

/// How many rays go through the pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// One through the middle of each two by two pixels.
    Coarse,
    /// So many through each.
    Each(NonZeroU32),
    /// One through each; 4, 16 and 64 in all where there are edges: of objects, shadows and patterns, or where normals
    /// differ; but never more than so many.
    UpTo(NonZeroU32),
}

impl Sampling {
    /// As many as are ever taken where there are edges.
    pub const BEST: Self = Self::UpTo(NonZeroU32::new(64).expect("64 is not 0"));
}

impl From<NonZeroU32> for Sampling {
    fn from(samples: NonZeroU32) -> Self {
        Self::Each(samples)
    }
}

/// The samples of each pass over a picture: each makes four out of one.
pub(super) const PASSES: [Range<u32>; 4] = [0..1, 1..4, 4..16, 16..64];

/// Where in the pixel a sample lies, as parts of its width and height from the top left corner: the centre first, then
/// on through Roberts' R2 sequence (multiples of the inverses of the plastic number and its square, modulo 1), whose
/// every beginning covers the pixel evenly. Counted in integers, so that it is exact.
pub(super) fn sample_position(sample: u32) -> (f32, f32) {
    let part = |step: u32| {
        let position = 0x8000_0000_u32.wrapping_add(sample.wrapping_mul(step));
        (position >> 8) as f32 / 16_777_216.0
    };
    (part(3_242_174_889), part(2_447_445_414))
}

/// How much of the pixel a sample stands for, along each side: all of it if it is the only one, half if it is one of
/// four.
pub(super) fn footprint_share(sample: u32) -> f32 {
    match sample {
        0 => 1.0,
        1..4 => 0.5,
        4..16 => 0.25,
        _ => 0.125,
    }
}
