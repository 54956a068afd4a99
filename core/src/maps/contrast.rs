//! The high-contrast map: black and white, with lines between objects.
//!
//! An object and one behind it may both be lighter or both be darker than the threshold, so a line of the other colour
//! separates them.

use super::{TracedMap, shaded};
use crate::camera::Camera;
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::Resolution;
use crate::render::{Executor, Sampling, TraceDepth, trace_g_buffer_partial};
use crate::scene::Scene;
use crate::tone::Picture;
use std::num::NonZeroU32;

const BLACK: Srgb8 = Srgb8::new(0, 0, 0);
const WHITE: Srgb8 = Srgb8::new(255, 255, 255);

/// The luminance from which a pixel becomes white.
// A luminance of 0.184 has a lightness L* (CIE 1976) of 50, half that of white. With half the luminance of white
// instead, most pictures would become black.
const WHITE_THRESHOLD: f32 = 0.184;

/// Traces the light and the objects, and returns the high-contrast picture.
pub(super) fn trace(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> TracedMap {
    // One sample per pixel for the light, as for the objects: with more, edges of the light would move relative to
    // those of the objects.
    let sampling = if sampling == Sampling::Coarse { sampling } else { Sampling::Each(NonZeroU32::MIN) };
    let light = shaded::trace(executor, scene, camera, resolution, sampling);
    // For each pixel, the object's index plus 1, or 0 without a hit.
    let objects =
        trace_g_buffer_partial(executor, scene, camera, resolution, sampling, TraceDepth::Surfaces, |sample| {
            sample.hit.map_or(0, |hit| hit.object + 1)
        });
    let mut cost = light.cost;
    cost += objects.cost;
    TracedMap::new(bilevel_with_outlines(&light.picture, &objects.pixels), cost)
}

/// Returns the picture in black and white, with lines between pixels whose elements of `objects`
/// differ.
fn bilevel_with_outlines(picture: &Picture, objects: &[u32]) -> Picture {
    let width = picture.width() as usize;
    let is_white: Vec<_> =
        picture.pixels().iter().map(|&pixel| LinearRgb::from_srgb8(pixel).luminance() >= WHITE_THRESHOLD).collect();
    let ink = |at: usize| {
        let blends = |other: usize| {
            objects.get(other).is_some_and(|&object| object != objects[at]) && is_white[other] == is_white[at]
        };
        // Only the neighbours on the right and below are compared, so that lines are one pixel wide.
        let is_line = !(at + 1).is_multiple_of(width) && blends(at + 1) || blends(at + width);
        if is_white[at] == is_line { BLACK } else { WHITE }
    };
    Picture { pixels: (0..picture.pixels().len()).map(ink).collect(), ..*picture }
}

#[cfg(all(test, unit_tests))]
mod tests;
