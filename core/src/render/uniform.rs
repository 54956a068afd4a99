//! Uniform sampling: the same number of samples for each pixel.

use super::sampling::{MAX_BATCH_RAYS, SampleBatch, SampleBatches};
use super::steps::{Buffers, RenderJob, Stage};
use super::tiles::{PIXELS, Tiles};
use super::{Cost, Executor, Rendered};
use crate::framebuffer::Framebuffer;
use crate::lanes::{F32x8, LANES};
use crate::scene::Scene;
use crate::shade::{self, EightLights};
use std::ops::Range;

/// Renders a picture with `samples` samples per pixel.
pub(super) fn render(executor: Executor<'_>, scene: &Scene, tiles: &Tiles, samples: u32) -> Rendered {
    let mut framebuffer = Framebuffer::new(tiles.resolution);
    let parts = tiles.split(framebuffer.pixels_mut());
    let (batches, share) = (SampleBatches::of(0..samples), 1.0 / samples as f32);
    // Sums are kept per tile, and written to the picture once. With sums for the whole picture, rendering took more
    // memory than the framebuffer, and 262 instead of 225 instructions per pixel (three_spheres at 1024x1024).
    let cost = executor.trace(&RenderJob::new(scene, tiles, Stage::Reflected), parts, |tile, mut part| {
        let mut sums = [[F32x8::ZERO; 3]; PIXELS / LANES];
        tile.trace(&batches, |buffers, batch, pixels| add_lights(&mut sums, buffers, batch, pixels));
        tiles.fill_traced_pixels(
            &tile.buffers.active,
            |at| shade::lane_light(&sums[at / LANES], at % LANES) * share,
            &mut part,
        );
    });
    Rendered { framebuffer, cost }
}

/// A flag for each square of pixels, row by row.
#[derive(Clone, Copy)]
pub(super) struct PixelFlags<'f> {
    pub(super) flags: &'f [bool],
    /// The number of flags in a row.
    pub(super) columns: u32,
    /// The side of a square in pixels.
    pub(super) side: u32,
}

impl PixelFlags<'_> {
    /// Returns the flag of a pixel.
    pub(super) fn at(&self, [x, y]: [u32; 2]) -> bool {
        self.flags[(y / self.side * self.columns + x / self.side) as usize]
    }
}

/// Traces the pixels that are flagged again, with `samples` samples per pixel.
///
/// These pixels have the same bits as if all pixels of the picture had that number of samples.
pub(super) fn retrace(
    executor: Executor<'_>,
    job: &RenderJob<'_>,
    framebuffer: &mut Framebuffer,
    samples: u32,
    wanted: PixelFlags<'_>,
) -> Cost {
    let tiles = job.tiles;
    let (batches, share) = (SampleBatches::of(0..samples), 1.0 / samples as f32);
    executor.trace(job, tiles.split(framebuffer.pixels_mut()), |tile, mut part| {
        let number = tile.number;
        let place = |at: u32| (at / wanted.side) as usize;
        if !tiles.is_flagged(number, wanted.flags, wanted.columns as usize, place) {
            return;
        }
        tile.buffers.active.retain(|&pixel| wanted.at(tiles.position(number, pixel)));
        let mut sums = [[F32x8::ZERO; 3]; PIXELS / LANES];
        tile.trace(&batches, |buffers, batch, pixels| add_lights(&mut sums, buffers, batch, pixels));
        for (at, &pixel) in tile.buffers.active.iter().enumerate() {
            tiles.fill_traced_pixel(pixel, shade::lane_light(&sums[at / LANES], at % LANES) * share, &mut part);
        }
    })
}

/// Adds the light of a batch to the sums of its pixels.
// Each pixel's samples are added in order, so that the bits of the sum do not depend on how the samples are divided
// into batches.
fn add_lights(sums: &mut [EightLights], buffers: &Buffers, batch: &SampleBatch, pixels: Range<usize>) {
    let per_pixel = batch.per_pixel();
    if per_pixel == 1 {
        const { assert!(PIXELS <= MAX_BATCH_RAYS, "one sample of each pixel is one batch") };
        for (sums, lights) in sums.iter_mut().zip(&buffers.lights) {
            for (sum, &light) in sums.iter_mut().zip(lights) {
                *sum = *sum + light;
            }
        }
        return;
    }
    for (channel, lights) in buffers.light_channels().iter().enumerate() {
        for (pixel, lights) in pixels.clone().zip(lights.chunks_exact(per_pixel)) {
            let sum = &mut sums[pixel / LANES][channel].0[pixel % LANES];
            *sum = lights.iter().fold(*sum, |sum, light| sum + light);
        }
    }
}
