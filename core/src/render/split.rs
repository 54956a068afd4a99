//! Sampling of blocks of two by two pixels, and of their pixels where the blocks differ most.
//!
//! Rays that no block needs go to the pixels that differ most.

use super::steps::{ProgressUnit, RenderJob, Stage};
use super::tiles::Tiles;
use super::{Executor, Rendered, uniform};
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::scene::Scene;

/// The greatest share of blocks that are split, as a fraction.
// A glyph kind with 4 by 8 pixels then has at most 8 + 32 * 9 / 32 = 17 rays per cell on average.
const MAX_SHARE: (usize, usize) = (9, 32);

/// The least difference of the square roots of light between two blocks at which both may be split.
// The square root of the light is about the lightness on the screen. With 0.12 instead, pictures of quadrant glyphs
// lose up to 0.15 dB and save two of 14 rays per cell.
const MIN_CONTRAST: f32 = 0.06;

/// The number of rays through a pixel that differs most from its neighbours.
// With the rays that are left, quadrants of three_spheres at 200x60 gain 0.8 dB; with four rays for each of more pixels
// they gain 0.7 dB, and those of the corridor lose 0.1 dB.
const FINEST_SAMPLES: u32 = 16;

/// The progress [units](ProgressUnit) of a tile of 16x16 pixels for the rays of its split blocks.
const SPLIT_UNITS: u64 = 60;

/// The progress units of a tile for the rays of its finest pixels.
const FINEST_UNITS: u64 = 12;

/// Returns the progress units of a picture.
pub(super) fn units(resolution: Resolution) -> u64 {
    let blocks = u64::from(resolution.width().div_ceil(2)) * u64::from(resolution.height().div_ceil(2));
    blocks + (SPLIT_UNITS + FINEST_UNITS) * Tiles::count_of(resolution) as u64
}

/// Renders a picture with [`Sampling::Split`](super::Sampling::Split).
// The pixels of a split block get one ray each, as with one sample per pixel. The block's first ray goes through the
// corner that its pixels share, and its light is dropped. The finest pixels are traced as with 16 samples per pixel.
pub(super) fn render(executor: Executor<'_>, scene: &Scene, camera: &Camera, resolution: Resolution) -> Rendered {
    let blocks = Tiles::new(camera, resolution, 2);
    let white = 1.0 / scene.exposure();
    let mut rendered = uniform::render(executor, scene, &blocks, 1);
    // A cancelled picture is not shown: choosing its blocks and pixels would only delay the next one.
    if executor.is_cancelled() {
        return rendered;
    }
    let splits = blocks_to_split(&rendered.framebuffer, &blocks, white);
    let tiles = Tiles::new(camera, resolution, 1);
    let is_split = |[x, y]: [u32; 2]| splits[(y / 2 * blocks.columns + x / 2) as usize];
    let stage = |unit| RenderJob { unit: ProgressUnit::Tile(unit), ..RenderJob::new(scene, &tiles, Stage::Reflected) };
    rendered.cost += uniform::retrace(executor, &stage(SPLIT_UNITS), &mut rendered.framebuffer, 1, is_split);
    if executor.is_cancelled() {
        return rendered;
    }
    let split_count = splits.iter().filter(|&&is_split| is_split).count();
    let left = 4 * (most_blocks(splits.len()) - split_count) / FINEST_SAMPLES as usize;
    let most = left.min(4 * split_count);
    let finest = finest_pixels(&rendered.framebuffer, is_split, white, most);
    let is_finest = |[x, y]: [u32; 2]| finest[(y * resolution.width() + x) as usize];
    rendered.cost +=
        uniform::retrace(executor, &stage(FINEST_UNITS), &mut rendered.framebuffer, FINEST_SAMPLES, is_finest);
    rendered
}

/// Returns the largest number of blocks that may be split.
fn most_blocks(blocks: usize) -> usize {
    blocks * MAX_SHARE.0 / MAX_SHARE.1
}

/// Returns for each block whether it is split.
///
/// `white` is the light that is displayed as white.
fn blocks_to_split(framebuffer: &Framebuffer, blocks: &Tiles, white: f32) -> Vec<bool> {
    let [columns, rows] = [blocks.columns as usize, blocks.rows as usize];
    let width = blocks.resolution.width() as usize;
    let light = |block: usize| framebuffer.pixels()[2 * (block / columns) * width + 2 * (block % columns)];
    let roots: Vec<[f32; 3]> = (0..columns * rows).map(|block| roots(light(block), white)).collect();
    highest(&contrasts(&roots, columns), most_blocks(roots.len()))
}

/// Returns for each pixel whether it is one of the finest, which are at most `most`.
///
/// These are the pixels of split blocks that differ most from a neighbour.
fn finest_pixels(framebuffer: &Framebuffer, is_split: impl Fn([u32; 2]) -> bool, white: f32, most: usize) -> Vec<bool> {
    if most == 0 {
        return vec![false; framebuffer.pixels().len()];
    }
    let width = framebuffer.resolution().width();
    let roots: Vec<[f32; 3]> = framebuffer.pixels().iter().map(|&light| roots(light, white)).collect();
    let mut contrasts = contrasts(&roots, width as usize);
    for (pixel, contrast) in (0..).zip(&mut contrasts) {
        if !is_split([pixel % width, pixel / width]) {
            *contrast = 0.0;
        }
    }
    highest(&contrasts, most)
}

/// Returns the square roots of a light's channels, limited to those of displayed light.
fn roots(LinearRgb { r, g, b }: LinearRgb, white: f32) -> [f32; 3] {
    [r, g, b].map(|light| (light / white).clamp(0.0, 1.0).sqrt())
}

/// Returns for each contrast whether it is one of the `most` highest.
///
/// Contrasts below [`MIN_CONTRAST`] never are.
fn highest(contrasts: &[f32], most: usize) -> Vec<bool> {
    // The key's lower bits are a hash of the index, so that of blocks with equal contrast those that are split are
    // scattered over the picture.
    let key = |(at, &contrast): (u32, &f32)| {
        let scattered = at.wrapping_mul(0x9e37_79b1);
        if contrast < MIN_CONTRAST { 0 } else { u64::from(contrast.to_bits()) << 32 | u64::from(scattered) }
    };
    let keys: Vec<u64> = (0..).zip(contrasts).map(key).collect();
    let mut wanted: Vec<u64> = keys.iter().copied().filter(|&key| key > 0).collect();
    let least = if wanted.len() > most {
        // Keys above this one are taken; there are at most `most` of them.
        let at = wanted.len() - most - 1;
        *wanted.select_nth_unstable(at).1
    } else {
        0
    };
    keys.into_iter().map(|key| key > least).collect()
}

/// Returns for each place the greatest difference of a channel from its four direct neighbours.
// Each pair is compared once. With the diagonal neighbours too, a frame took a third longer, and quadrants of
// many_spheres lost 0.1 dB.
fn contrasts(roots: &[[f32; 3]], columns: usize) -> Vec<f32> {
    let difference = |a: &[f32; 3], b: &[f32; 3]| {
        let [r, g, b] = [(a[0] - b[0]).abs(), (a[1] - b[1]).abs(), (a[2] - b[2]).abs()];
        r.max(g).max(b)
    };
    let mut most = vec![0.0_f32; roots.len()];
    let mut compare = |a: usize, b: usize| {
        let difference = difference(&roots[a], &roots[b]);
        most[a] = most[a].max(difference);
        most[b] = most[b].max(difference);
    };
    for block in 0..roots.len() {
        if (block + 1) % columns != 0 {
            compare(block, block + 1);
        }
        if block + columns < roots.len() {
            compare(block, block + columns);
        }
    }
    most
}

#[cfg(all(test, unit_tests))]
mod tests;
