//! Sampling of blocks of two by two pixels, and of their pixels where the blocks differ most.
//!
//! Rays that no block needs go to the pixels that differ most.

use super::steps::{ProgressUnit, RenderJob, Stage};
use super::tiles::Tiles;
use super::uniform::{self, PixelFlags};
use super::{Executor, Rendered};
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
    let splits = PixelFlags { flags: &splits, columns: blocks.columns, side: 2 };
    let stage = |unit| RenderJob { unit: ProgressUnit::Tile(unit), ..RenderJob::new(scene, &tiles, Stage::Reflected) };
    rendered.cost += uniform::retrace(executor, &stage(SPLIT_UNITS), &mut rendered.framebuffer, 1, splits);
    if executor.is_cancelled() {
        return rendered;
    }
    let split_count = splits.flags.iter().filter(|&&is_split| is_split).count();
    let left = 4 * (most_blocks(splits.flags.len()) - split_count) / FINEST_SAMPLES as usize;
    let finest = finest_pixels(&rendered.framebuffer, splits, white, left.min(4 * split_count));
    let finest = PixelFlags { flags: &finest, columns: resolution.width(), side: 1 };
    rendered.cost +=
        uniform::retrace(executor, &stage(FINEST_UNITS), &mut rendered.framebuffer, FINEST_SAMPLES, finest);
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
    let contrasts = (0..).zip(contrasts(&roots, columns)).collect();
    highest(roots.len(), contrasts, most_blocks(roots.len()))
}

/// Returns for each pixel whether it is one of the finest, which are at most `most`.
///
/// These are the pixels of split blocks that differ most from a neighbour.
fn finest_pixels(framebuffer: &Framebuffer, splits: PixelFlags<'_>, white: f32, most: usize) -> Vec<bool> {
    let resolution = framebuffer.resolution();
    let (width, height) = (resolution.width() as usize, resolution.height() as usize);
    if most == 0 {
        return vec![false; width * height];
    }
    let mut contrasts = Vec::new();
    let root = |x: usize, y: usize| roots(framebuffer.pixels()[y * width + x], white);
    for block in (0..splits.flags.len()).filter(|&block| splits.flags[block]) {
        let [left, top] = [2 * (block % splits.columns as usize), 2 * (block / splits.columns as usize)];
        // The block and the pixels beside it; beyond the picture's edge its last pixels are repeated, whose contrast
        // to themselves is 0.
        let near: [[[f32; 3]; 4]; 4] = std::array::from_fn(|y| {
            let y = (top + y).saturating_sub(1).min(height - 1);
            std::array::from_fn(|x| root((left + x).saturating_sub(1).min(width - 1), y))
        });
        for (x, y) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
            let at = [left + x - 1, top + y - 1];
            if at[0] < width && at[1] < height {
                let others = [near[y][x - 1], near[y][x + 1], near[y - 1][x], near[y + 1][x]];
                let contrast = others.iter().fold(0.0, |most: f32, other| most.max(difference(&near[y][x], other)));
                contrasts.push(((at[1] * width + at[0]) as u32, contrast));
            }
        }
    }
    highest(width * height, contrasts, most)
}

/// Returns the square roots of a light's channels, limited to those of displayed light.
fn roots(LinearRgb { r, g, b }: LinearRgb, white: f32) -> [f32; 3] {
    [r, g, b].map(|light| (light / white).clamp(0.0, 1.0).sqrt())
}

/// Returns for each of `count` places whether its contrast is one of the `most` highest.
///
/// Contrasts below [`MIN_CONTRAST`], and those of places without one, never are.
fn highest(count: usize, mut contrasts: Vec<(u32, f32)>, most: usize) -> Vec<bool> {
    // The key's lower bits are a hash of the index, so that of blocks with equal contrast those that are split are
    // scattered over the picture.
    let key = |&(at, contrast): &(u32, f32)| {
        let scattered = at.wrapping_mul(0x9e37_79b1);
        u64::from(contrast.to_bits()) << 32 | u64::from(scattered)
    };
    contrasts.retain(|&(_, contrast)| contrast >= MIN_CONTRAST);
    if contrasts.len() > most {
        let at = contrasts.len() - most;
        contrasts.select_nth_unstable_by_key(at.saturating_sub(1), key);
        contrasts.drain(..at);
    }
    let mut highest = vec![false; count];
    for (at, _) in contrasts {
        highest[at as usize] = true;
    }
    highest
}

/// Returns the greatest difference of a channel.
fn difference(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    let [r, g, b] = [(a[0] - b[0]).abs(), (a[1] - b[1]).abs(), (a[2] - b[2]).abs()];
    r.max(g).max(b)
}

/// Returns for each place the greatest difference of a channel from its four direct neighbours.
// Each pair is compared once. With the diagonal neighbours too, a frame took a third longer, and quadrants of
// many_spheres lost 0.1 dB.
fn contrasts(roots: &[[f32; 3]], columns: usize) -> Vec<f32> {
    let mut most = vec![0.0_f32; roots.len()];
    let compare = |(a, b): (&[f32; 3], &[f32; 3]), of_a: &mut f32, of_b: &mut f32| {
        let difference = difference(a, b);
        (*of_a, *of_b) = (of_a.max(difference), of_b.max(difference));
    };
    for start in (0..roots.len()).step_by(columns.max(1)) {
        let (of_row, of_others) = most[start..].split_at_mut(columns);
        let (row, others) = roots[start..].split_at(columns);
        for x in 1..columns {
            let [left, right] = &mut of_row[x - 1..=x] else { unreachable!("these are two") };
            compare((&row[x - 1], &row[x]), left, right);
        }
        for (at, (of_this, of_below)) in of_row.iter_mut().zip(of_others).enumerate() {
            compare((&row[at], &others[at]), of_this, of_below);
        }
    }
    most
}

#[cfg(all(test, unit_tests))]
mod tests;
