//! Uniform sampling: the same number of samples for each pixel.

use super::sampling::{MOST_RAYS, Run, Runs};
use super::steps::{Buffers, Goal, Shot};
use super::tiles::{PIXELS, Tiles};
use super::{Executor, Rendered};
use crate::framebuffer::Framebuffer;
use crate::lanes::{Eight, LANES};
use crate::scene::Scene;
use crate::shade::{self, EightLights};
use std::ops::Range;

/// Renders the picture with this many samples per pixel.
pub(super) fn render(executor: Executor<'_>, scene: &Scene, tiles: &Tiles, samples: u32) -> Rendered {
    let mut framebuffer = Framebuffer::new(tiles.resolution);
    let parts = tiles.split(framebuffer.pixels_mut());
    let (runs, share) = (Runs::of(0..samples), 1.0 / samples as f32);
    let cost = executor.trace(&Shot::new(scene, tiles, Goal::Reflected), parts, |tile, mut part| {
        let mut sums = [[Eight::ZERO; 3]; PIXELS / LANES];
        tile.trace(&runs, |buffers, run, pixels| add_lights(&mut sums, buffers, run, pixels));
        tiles.show(&tile.buffers.wanted, |at| shade::light_of(&sums[at / LANES], at % LANES) * share, &mut part);
    });
    Rendered { framebuffer, cost }
}

/// Adds the light of a batch to the sums of its pixels, for each pixel in the order of its samples.
fn add_lights(sums: &mut [EightLights], buffers: &Buffers, run: &Run, pixels: Range<usize>) {
    let each = run.each();
    if each == 1 {
        const { assert!(PIXELS <= MOST_RAYS, "one sample of each pixel is one batch") };
        for (sums, lights) in sums.iter_mut().zip(&buffers.lights) {
            for (sum, &light) in sums.iter_mut().zip(lights) {
                *sum = *sum + light;
            }
        }
        return;
    }
    for (band, lights) in buffers.bands().iter().enumerate() {
        for (pixel, lights) in pixels.clone().zip(lights.chunks_exact(each)) {
            let sum = &mut sums[pixel / LANES][band].0[pixel % LANES];
            *sum = lights.iter().fold(*sum, |sum, light| sum + light);
        }
    }
}
