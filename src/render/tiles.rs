//! A picture in tiles: where each pixel is, and the eye rays through it.
//!
//! Tile by tile, and in a tile square by square of 8 by 8 and group by group of 4 by 2, pixels that lie side by side are
//! neighbours in memory: a group's eye rays are eight that go together, a square's are a packet. Of several samples those of
//! one pixel are neighbours.

use super::sampling::{Run, footprint_share};
use crate::camera::{Camera, EyeRays};
use crate::framebuffer::Resolution;
use crate::lanes::{ALL, Eight, LANES, Lanes, Number, Vector};
use crate::ray::EightRays;
use crate::simd::{self, Work};
use glam::Vec3;
use std::ops::Range;

/// A tile's side in pixels.
const SIDE: u32 = 16;

/// How many pixels a tile has; those of the last ones lie outside the picture.
pub(super) const PIXELS: usize = (SIDE * SIDE) as usize;

/// The tiles of a picture, or of one of larger pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    /// Of the picture.
    pub(super) resolution: Resolution,
    /// How many pixels of the picture each of these covers in either direction.
    pub(super) scale: u32,
    pub(super) columns: u32,
    pub(super) rows: u32,
    eye_rays: EyeRays,
}

impl Tiles {
    pub(super) fn new(camera: &Camera, resolution: Resolution, scale: u32) -> Self {
        let (columns, rows) = (resolution.width().div_ceil(scale), resolution.height().div_ceil(scale));
        Self { resolution, scale, columns, rows, eye_rays: camera.eye_rays(resolution.aspect_ratio()) }
    }

    /// Returns how many tiles a picture of that resolution has at full scale.
    pub(super) fn count_of(resolution: Resolution) -> usize {
        resolution.width().div_ceil(SIDE) as usize * resolution.height().div_ceil(SIDE) as usize
    }

    fn across(&self) -> u32 {
        self.columns.div_ceil(SIDE)
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.across() as usize * self.rows.div_ceil(SIDE) as usize
    }

    /// The upper left pixel of a tile.
    fn corner(&self, tile: usize) -> [u32; 2] {
        let tile = tile as u32;
        [tile % self.across() * SIDE, tile / self.across() * SIDE]
    }

    /// A picture's pixels by tiles: each gets its part of every row that it covers.
    pub(super) fn split<'p, T>(&self, pixels: &'p mut [T]) -> Vec<Vec<&'p mut [T]>> {
        let side = (SIDE * self.scale) as usize;
        let mut tiles: Vec<_> = (0..self.count()).map(|_| Vec::with_capacity(side)).collect();
        for (y, row) in pixels.chunks_mut(self.resolution.width().max(1) as usize).enumerate() {
            let first = y / side * self.across() as usize;
            for (tile, part) in tiles[first..].iter_mut().zip(row.chunks_mut(side)) {
                tile.push(part);
            }
        }
        tiles
    }

    /// Puts what these pixels of a tile show, by their place in the list, into the tile's part of a picture; what is outside
    /// is left out.
    pub(super) fn show<T: Copy>(&self, pixels: &[u8], shown: impl Fn(usize) -> T, part: &mut [&mut [T]]) {
        if pixels.len() == PIXELS && self.scale == 1 {
            // The same as what follows, row by row: four neighbours at a time.
            for (row, pixels) in part.iter_mut().zip(&IN_ROW) {
                let (fours, rest) = row.as_chunks_mut::<4>();
                let left = &pixels[4 * fours.len()..];
                for (four, &[first, ..]) in fours.iter_mut().zip(pixels.as_chunks::<4>().0) {
                    // It is a multiple of 4, which the compiler is told so.
                    *four = std::array::from_fn(|at| shown(usize::from(first) & !3 | at));
                }
                rest.iter_mut().zip(left).for_each(|(place, &pixel)| *place = shown(pixel.into()));
            }
            return;
        }
        for (at, &pixel) in pixels.iter().enumerate() {
            self.put(pixel, shown(at), part);
        }
    }

    /// Puts what one pixel shows there.
    pub(super) fn put<T: Copy>(&self, pixel: u8, shown: T, part: &mut [&mut [T]]) {
        let scale = self.scale as usize;
        let [x, y] = in_tile(pixel.into()).map(|at| at as usize * scale);
        for row in part.iter_mut().skip(y).take(scale) {
            row.iter_mut().skip(x).take(scale).for_each(|place| *place = shown);
        }
    }

    /// A pixel's column and those beside it, and the same of its row; none outside the picture.
    pub(super) fn around(&self, tile: usize, pixel: usize) -> [Range<u32>; 2] {
        let ([left, top], [x, y]) = (self.corner(tile), in_tile(pixel));
        let beside = |at: u32, end: u32| at.saturating_sub(1)..(at + 2).min(end);
        [beside(left + x, self.columns), beside(top + y, self.rows)]
    }

    /// In which tile a pixel of the picture is, and its number in it.
    pub(super) fn at(&self, [x, y]: [u32; 2]) -> (usize, usize) {
        let tile = y / SIDE * self.across() + x / SIDE;
        (tile as usize, IN_ROW[(y % SIDE) as usize][(x % SIDE) as usize].into())
    }

    /// Which pixels of a tile are in the picture, by their number in it.
    pub(super) fn inside(&self, tile: usize, pixels: &mut Vec<u8>) {
        pixels.clear();
        pixels.extend_from_slice(&ALL_PIXELS);
        let [left, top] = self.corner(tile);
        let [right, bottom] = [self.columns - left, self.rows - top];
        if right < SIDE || bottom < SIDE {
            pixels.retain(|&pixel| {
                let [x, y] = in_tile(pixel.into());
                x < right && y < bottom
            });
        }
    }

    /// Makes the eye rays of a batch, one for each of these pixels of the tile.
    pub(super) fn make_eye_rays(&self, tile: usize, pixels: &[u8], run: &Run, rays: &mut Vec<EightRays>) {
        rays.clear();
        simd::run(MakeEyeRays { tiles: self, tile, pixels, run, rays });
    }

    /// Where a pixel's sample, which has that place in the pixel, lies in the picture: the lecture's (qu, qv), (0, 0) being
    /// the lower left corner.
    #[inline(always)]
    pub(super) fn q<N: Number>(&self, [x, y]: [N; 2], [sx, sy]: [N; 2]) -> [N; 2] {
        let (width, height) = (N::splat(self.resolution.width() as f32), N::splat(self.resolution.height() as f32));
        let scale = N::splat(self.scale as f32);
        // Rows are counted from the top, the lecture's q_v from the bottom.
        [(x + sx) * scale / width, (height - (y + sy) * scale) / height]
    }

    /// By how much the direction changes from an eye ray to those beside it.
    pub(super) fn steps(&self, sample: u32) -> [Vec3; 2] {
        let share = self.scale as f32 * footprint_share(sample);
        self.eye_rays.steps(self.resolution.width(), self.resolution.height()).map(|step| step * share)
    }
}

/// The numbers of all of them.
pub(super) static ALL_PIXELS: [u8; PIXELS] = {
    let mut all = [0; PIXELS];
    let mut pixel = 0;
    while pixel < PIXELS {
        all[pixel] = pixel as u8;
        pixel += 1;
    }
    all
};

/// How far to the right and down a pixel is in its tile.
pub(super) const fn in_tile(pixel: usize) -> [u32; 2] {
    let at = pixel as u32;
    [at & 3 | (at >> 3 & 1) << 2 | (at >> 6 & 1) << 3, at >> 2 & 1 | (at >> 4 & 3) << 1 | (at >> 7 & 1) << 3]
}

/// The same of all, as numbers to reckon with.
static IN_TILE: [[f32; PIXELS]; 2] = {
    let mut all = [[0.0; PIXELS]; 2];
    let mut pixel = 0;
    while pixel < PIXELS {
        let [x, y] = in_tile(pixel);
        (all[0][pixel], all[1][pixel]) = (x as f32, y as f32);
        pixel += 1;
    }
    all
};

/// The pixels of a tile, row by row.
static IN_ROW: [[u8; SIDE as usize]; SIDE as usize] = {
    let mut rows = [[0; SIDE as usize]; SIDE as usize];
    let mut pixel = 0;
    while pixel < PIXELS {
        let [x, y] = in_tile(pixel);
        rows[y as usize][x as usize] = pixel as u8;
        pixel += 1;
    }
    rows
};

struct MakeEyeRays<'w> {
    tiles: &'w Tiles,
    tile: usize,
    pixels: &'w [u8],
    run: &'w Run,
    rays: &'w mut Vec<EightRays>,
}

impl Work for MakeEyeRays<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { tiles, tile, pixels, run, rays } = self;
        let eye_rays = &tiles.eye_rays;
        let [left, top] = tiles.corner(tile).map(|at| N::splat(at as f32));
        let origin = Vector::splat(eye_rays.eye());
        for (pixels, &[mut sx, mut sy]) in pixels.chunks(LANES).zip(&run.positions) {
            let [mut x, mut y] = [Eight::ZERO; 2];
            let last = pixels.len() - 1;
            for lane in 0..LANES {
                let pixel = usize::from(pixels[lane.min(last)]);
                (x.0[lane], y.0[lane]) = (IN_TILE[0][pixel], IN_TILE[1][pixel]);
            }
            for lane in pixels.len()..LANES {
                (sx.0[lane], sy.0[lane]) = (sx.0[last], sy.0[last]);
            }
            let [qu, qv] = tiles.q([left + N::load(&x), top + N::load(&y)], [N::load(&sx), N::load(&sy)]);
            let direction = eye_rays.direction(qu, qv).store();
            rays.push(EightRays { origin, direction, asked: ALL >> (LANES - pixels.len()) });
        }
    }
}
