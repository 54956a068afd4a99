//! Sampling of blocks of two by two pixels, and of single pixels where the blocks differ most.

use super::sampling::SampleBatches;
use super::steps::{ProgressUnit, RenderJob, Stage};
use super::tiles::Tiles;
use super::{Executor, Rendered, uniform};
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::lanes::LANES;
use crate::scene::Scene;
use crate::shade;

/// The greatest share of blocks that are split, as a fraction.
// A glyph kind with 4 by 8 pixels then has at most 8 + 32 * 9 / 32 = 17 rays per cell on average.
const MAX_SHARE: (usize, usize) = (9, 32);

/// The least difference of the square roots of light between two blocks at which both may be split.
// The square root of the light is about the lightness on the screen. With 0.12 instead, pictures of quadrant glyphs
// lose up to 0.15 dB and save two of 14 rays per cell.
const MIN_CONTRAST: f32 = 0.06;

/// The progress [units](ProgressUnit) of a tile of 16x16 pixels for the rays of its split blocks.
const SPLIT_UNITS: u64 = 72;

/// Returns the progress units of a picture.
pub(super) fn units(resolution: Resolution) -> u64 {
    let blocks = u64::from(resolution.width().div_ceil(2)) * u64::from(resolution.height().div_ceil(2));
    blocks + SPLIT_UNITS * Tiles::count_of(resolution) as u64
}

/// Renders a picture with [`Sampling::Split`](super::Sampling::Split).
// The pixels of a split block get one ray each, as with one sample per pixel. The block's first ray goes through the
// corner that its pixels share, and its light is dropped.
pub(super) fn render(executor: Executor<'_>, scene: &Scene, camera: &Camera, resolution: Resolution) -> Rendered {
    let blocks = Tiles::new(camera, resolution, 2);
    let mut rendered = uniform::render(executor, scene, &blocks, 1);
    let splits = blocks_to_split(&rendered.framebuffer, &blocks, 1.0 / scene.exposure());
    let tiles = Tiles::new(camera, resolution, 1);
    let job = RenderJob { unit: ProgressUnit::Tile(SPLIT_UNITS), ..RenderJob::new(scene, &tiles, Stage::Reflected) };
    let batches = SampleBatches::of(0..1);
    let parts = tiles.split(rendered.framebuffer.pixels_mut());
    rendered.cost += executor.trace(&job, parts, |tile, mut part| {
        let number = tile.number;
        tile.buffers.active.retain(|&pixel| {
            let [x, y] = tiles.position(number, pixel);
            splits[(y / 2 * blocks.columns + x / 2) as usize]
        });
        tile.trace(&batches, |buffers, _, _| {
            for (ray, &pixel) in buffers.pixels.iter().enumerate() {
                let light = LinearRgb::BLACK + shade::lane_light(&buffers.lights[ray / LANES], ray % LANES);
                tiles.fill_traced_pixel(pixel, light, &mut part);
            }
        });
    });
    rendered
}

/// Returns for each block whether it is split.
///
/// `white` is the light that is displayed as white.
fn blocks_to_split(framebuffer: &Framebuffer, blocks: &Tiles, white: f32) -> Vec<bool> {
    let [columns, rows] = [blocks.columns as usize, blocks.rows as usize];
    let width = blocks.resolution.width() as usize;
    let root = |light: f32| (light / white).clamp(0.0, 1.0).sqrt();
    let roots: Vec<[f32; 3]> = (0..columns * rows)
        .map(|block| framebuffer.pixels()[2 * (block / columns) * width + 2 * (block % columns)])
        .map(|LinearRgb { r, g, b }| [root(r), root(g), root(b)])
        .collect();
    // The key's lower bits are a hash of the index, so that of blocks with equal contrast those that are split are
    // scattered over the picture.
    let key = |(block, contrast): (u32, f32)| {
        let scattered = block.wrapping_mul(0x9e37_79b1);
        if contrast < MIN_CONTRAST { 0 } else { u64::from(contrast.to_bits()) << 32 | u64::from(scattered) }
    };
    let keys: Vec<u64> = (0..).zip(contrasts(&roots, columns)).map(key).collect();
    let most = keys.len() * MAX_SHARE.0 / MAX_SHARE.1;
    let mut wanted: Vec<u64> = keys.iter().copied().filter(|&key| key > 0).collect();
    let least = if wanted.len() > most {
        // Blocks with keys above this one are split; there are at most `most` of them.
        let at = wanted.len() - most - 1;
        *wanted.select_nth_unstable(at).1
    } else {
        0
    };
    keys.into_iter().map(|key| key > least).collect()
}

/// Returns for each block the greatest difference of a channel from its four direct neighbours.
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
