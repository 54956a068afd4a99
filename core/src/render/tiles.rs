//! The tiles of a picture: the order of pixels, and the eye rays through them.
//!
//! Pixels are ordered tile by tile, within a tile in squares of 8 by 8, and within a square in groups of 4 by 2. The
//! eye rays of a group are the eight lanes of a vector, and the eye rays of a square are a packet: of all shapes with
//! 64 pixels, a square's rays hit the fewest nodes. The samples of a pixel are consecutive.

use super::sampling::{SampleBatch, footprint_share};
use crate::camera::{Camera, EyeRays};
use crate::framebuffer::Resolution;
use crate::lanes::{ALL, F32x8, LANES, Lanes, Number, Vector};
use crate::ray::EightRays;
use crate::simd::{self, SimdKernel};
use glam::Vec3;
use std::ops::Range;

/// The side of a tile in pixels.
// A tile is four packets of 8x8 pixels. The arrays between the steps fit the first-level cache, the index of a pixel
// fits a byte, and a picture of 80x48 has 15 tiles for the threads to share.
const SIDE: u32 = 16;

/// The number of pixels in a tile. In tiles at the border, some of them are outside the picture.
pub(super) const PIXELS: usize = (SIDE * SIDE) as usize;

/// The tiles of a picture, at full or reduced resolution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    /// The resolution of the picture.
    pub(super) resolution: Resolution,
    /// The side of a traced pixel, in pixels of the picture: 1 or 2.
    pub(super) pixel_side: u32,
    /// The number of traced pixels in a row.
    pub(super) columns: u32,
    /// The number of rows of traced pixels.
    pub(super) rows: u32,
    eye_rays: EyeRays,
}

impl Tiles {
    pub(super) fn new(camera: &Camera, resolution: Resolution, pixel_side: u32) -> Self {
        let (columns, rows) = (resolution.width().div_ceil(pixel_side), resolution.height().div_ceil(pixel_side));
        Self { resolution, pixel_side, columns, rows, eye_rays: camera.eye_rays(resolution.aspect_ratio()) }
    }

    /// Returns the number of tiles of a picture at full resolution.
    pub(super) fn count_of(resolution: Resolution) -> usize {
        resolution.width().div_ceil(SIDE) as usize * resolution.height().div_ceil(SIDE) as usize
    }

    /// Returns the number of tiles in a row of tiles.
    fn tiles_per_row(&self) -> u32 {
        self.columns.div_ceil(SIDE)
    }

    /// Returns the number of tiles.
    pub(super) fn count(&self) -> usize {
        self.tiles_per_row() as usize * self.rows.div_ceil(SIDE) as usize
    }

    /// Returns the column and row of a tile's upper left pixel.
    fn corner(&self, tile: usize) -> [u32; 2] {
        let tile = tile as u32;
        [tile % self.tiles_per_row() * SIDE, tile / self.tiles_per_row() * SIDE]
    }

    /// Returns the column and row of a tile's pixel, counted in traced pixels of the picture.
    pub(super) fn position(&self, tile: usize, pixel: u8) -> [u32; 2] {
        let ([left, top], [x, y]) = (self.corner(tile), coordinates_in_tile(pixel.into()));
        [left + x, top + y]
    }

    /// Splits a picture's pixels by tiles: each tile gets its parts of the rows that it covers.
    // With disjoint slices, several threads can write to the picture at the same time without a copy or unsafe code.
    pub(super) fn split<'p, T>(&self, pixels: &'p mut [T]) -> Vec<Vec<&'p mut [T]>> {
        let side = (SIDE * self.pixel_side) as usize;
        let mut tiles: Vec<_> = (0..self.count()).map(|_| Vec::with_capacity(side)).collect();
        for (y, row) in pixels.chunks_mut(self.resolution.width().max(1) as usize).enumerate() {
            let first = y / side * self.tiles_per_row() as usize;
            for (tile, part) in tiles[first..].iter_mut().zip(row.chunks_mut(side)) {
                tile.push(part);
            }
        }
        tiles
    }

    /// Writes the values of a tile's pixels to the picture, and skips pixels outside it.
    ///
    /// `value` returns the value of the pixel at an index of `pixels`.
    pub(super) fn fill_traced_pixels<T: Copy>(&self, pixels: &[u8], value: impl Fn(usize) -> T, part: &mut [&mut [T]]) {
        if pixels.len() == PIXELS && self.pixel_side == 1 {
            // A whole tile is written row by row, in runs of four neighbours, which are consecutive in the tile. Pixel
            // by pixel it took 4.9 instead of 3.1 % of the total time.
            for (row, pixels) in part.iter_mut().zip(&PIXELS_BY_ROW) {
                let (fours, rest) = row.as_chunks_mut::<4>();
                let left = &pixels[4 * fours.len()..];
                for (four, &[first, ..]) in fours.iter_mut().zip(pixels.as_chunks::<4>().0) {
                    // `first` is a multiple of 4; `& !3` tells the compiler.
                    *four = std::array::from_fn(|at| value(usize::from(first) & !3 | at));
                }
                rest.iter_mut().zip(left).for_each(|(pixel, &index)| *pixel = value(index.into()));
            }
            return;
        }
        for (at, &pixel) in pixels.iter().enumerate() {
            self.fill_traced_pixel(pixel, value(at), part);
        }
    }

    /// Writes the value of one traced pixel to all pixels of the picture that it covers.
    pub(super) fn fill_traced_pixel<T: Copy>(&self, traced_pixel: u8, value: T, part: &mut [&mut [T]]) {
        let side = self.pixel_side as usize;
        let [x, y] = coordinates_in_tile(traced_pixel.into()).map(|at| at as usize * side);
        for row in part.iter_mut().skip(y).take(side) {
            row.iter_mut().skip(x).take(side).for_each(|pixel| *pixel = value);
        }
    }

    /// Returns the columns and rows of a pixel and its eight neighbours, clipped to the picture.
    pub(super) fn neighbourhood(&self, tile: usize, pixel: usize) -> [Range<u32>; 2] {
        let ([left, top], [x, y]) = (self.corner(tile), coordinates_in_tile(pixel));
        let beside = |at: u32, end: u32| at.saturating_sub(1)..(at + 2).min(end);
        [beside(left + x, self.columns), beside(top + y, self.rows)]
    }

    /// Returns the index of the tile of a pixel, and the pixel's index in the tile.
    pub(super) fn tile_and_index(&self, [x, y]: [u32; 2]) -> (usize, usize) {
        let tile = y / SIDE * self.tiles_per_row() + x / SIDE;
        (tile as usize, PIXELS_BY_ROW[(y % SIDE) as usize][(x % SIDE) as usize].into())
    }

    /// Returns whether a flag is set in a tile, in rows of `columns` flags.
    ///
    /// `place` returns the column or row of a pixel's flag for the pixel's column or row.
    pub(super) fn is_flagged(&self, tile: usize, flags: &[bool], columns: usize, place: impl Fn(u32) -> usize) -> bool {
        let [left, top] = self.corner(tile);
        let [right, bottom] = [(left + SIDE).min(self.columns) - 1, (top + SIDE).min(self.rows) - 1];
        let rows = &flags[place(top) * columns..(place(bottom) + 1) * columns];
        rows.chunks_exact(columns).any(|row| row[place(left)..=place(right)].contains(&true))
    }

    /// Writes the indices of a tile's pixels that are in the picture to `pixels`.
    pub(super) fn pixels_in_picture(&self, tile: usize, pixels: &mut Vec<u8>) {
        pixels.clear();
        pixels.extend_from_slice(&ALL_PIXELS);
        let [left, top] = self.corner(tile);
        let [right, bottom] = [self.columns - left, self.rows - top];
        if right < SIDE || bottom < SIDE {
            pixels.retain(|&pixel| {
                let [x, y] = coordinates_in_tile(pixel.into());
                x < right && y < bottom
            });
        }
    }

    /// Computes the eye rays of a batch, one for each element of `pixels`.
    pub(super) fn make_eye_rays(&self, tile: usize, pixels: &[u8], batch: &SampleBatch, rays: &mut Vec<EightRays>) {
        rays.clear();
        simd::dispatch(MakeEyeRays { tiles: self, tile, pixels, batch, rays });
    }

    /// Returns the lecture's (qu, qv) of samples: their positions in the picture.
    ///
    /// The origin is the lower left corner.
    ///
    /// `x` and `y` are the pixels' columns and rows, `sx` and `sy` the samples' positions in their pixels.
    #[inline(always)]
    pub(super) fn picture_position<N: Number>(&self, [x, y]: [N; 2], [sx, sy]: [N; 2]) -> [N; 2] {
        let (width, height) = (N::splat(self.resolution.width() as f32), N::splat(self.resolution.height() as f32));
        let side = N::splat(self.pixel_side as f32);
        // `y` is counted from the top of the picture, the lecture's qv from the bottom.
        [(x + sx) * side / width, (height - (y + sy) * side) / height]
    }

    /// Returns the change of an eye ray's direction over the footprint of a sample, to the right
    /// and upwards.
    pub(super) fn sample_direction_steps(&self, sample: u32) -> [Vec3; 2] {
        let share = self.pixel_side as f32 * footprint_share(sample);
        self.eye_rays.steps(self.resolution.width(), self.resolution.height()).map(|step| step * share)
    }
}

/// The indices of all pixels in a tile.
// A table, because `pixels_in_picture` copies it and `write_all` takes a slice; `PIXEL_COORDINATES` and `PIXELS_BY_ROW`
// are tables, so that making eye rays and writing whole tiles do not compute positions from the bits of an index.
pub(super) static ALL_PIXELS: [u8; PIXELS] = {
    let mut all = [0; PIXELS];
    let mut pixel = 0;
    while pixel < PIXELS {
        all[pixel] = pixel as u8;
        pixel += 1;
    }
    all
};

/// Returns the column and row of a pixel in its tile.
// The bits of the index are, from the lowest: x, x, y (in a group of 4x2), x, y, y (in a square of 8x8), x, y (in the
// tile of 16x16).
pub(super) const fn coordinates_in_tile(pixel: usize) -> [u32; 2] {
    let at = pixel as u32;
    [at & 3 | (at >> 3 & 1) << 2 | (at >> 6 & 1) << 3, at >> 2 & 1 | (at >> 4 & 3) << 1 | (at >> 7 & 1) << 3]
}

/// The columns and rows of all pixels in a tile, as floats.
static PIXEL_COORDINATES: [[f32; PIXELS]; 2] = {
    let mut all = [[0.0; PIXELS]; 2];
    let mut pixel = 0;
    while pixel < PIXELS {
        let [x, y] = coordinates_in_tile(pixel);
        (all[0][pixel], all[1][pixel]) = (x as f32, y as f32);
        pixel += 1;
    }
    all
};

/// The indices of a tile's pixels, row by row.
static PIXELS_BY_ROW: [[u8; SIDE as usize]; SIDE as usize] = {
    let mut rows = [[0; SIDE as usize]; SIDE as usize];
    let mut pixel = 0;
    while pixel < PIXELS {
        let [x, y] = coordinates_in_tile(pixel);
        rows[y as usize][x as usize] = pixel as u8;
        pixel += 1;
    }
    rows
};

struct MakeEyeRays<'w> {
    tiles: &'w Tiles,
    tile: usize,
    pixels: &'w [u8],
    batch: &'w SampleBatch,
    rays: &'w mut Vec<EightRays>,
}

impl SimdKernel for MakeEyeRays<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { tiles, tile, pixels, batch, rays } = self;
        let eye_rays = &tiles.eye_rays;
        let [left, top] = tiles.corner(tile).map(|at| N::splat(at as f32));
        let origin = Vector::splat(eye_rays.eye());
        for (pixels, &[mut sx, mut sy]) in pixels.chunks(LANES).zip(&batch.positions) {
            let [mut x, mut y] = [F32x8::ZERO; 2];
            let last = pixels.len() - 1;
            for lane in 0..LANES {
                let pixel = usize::from(pixels[lane.min(last)]);
                (x.0[lane], y.0[lane]) = (PIXEL_COORDINATES[0][pixel], PIXEL_COORDINATES[1][pixel]);
            }
            // Inactive lanes repeat the last ray's pixel and sample, so that they do not widen the bounds of the group.
            for lane in pixels.len()..LANES {
                (sx.0[lane], sy.0[lane]) = (sx.0[last], sy.0[last]);
            }
            let [qu, qv] =
                tiles.picture_position([left + N::load(&x), top + N::load(&y)], [N::load(&sx), N::load(&sy)]);
            let direction = eye_rays.direction(qu, qv).store();
            rays.push(EightRays { origin, direction, active: ALL >> (LANES - pixels.len()) });
        }
    }
}
