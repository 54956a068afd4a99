//! Adaptive refinement: more samples where a picture has edges, pass by pass.

use super::pixel::{First, Watched};
use super::sampling::{PASSES, Runs};
use super::steps::{Buffers, Goal, Shot, Unit};
use super::tiles::{ALL_PIXELS, PIXELS, Tiles};
use super::{Cost, Executor};
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::lanes::LANES;
use crate::progress::{Cancellation, Cancelled};
use crate::scene::Scene;
use crate::shade;
use std::num::NonZeroU32;
use std::ops::Range;

/// A picture in progress, which gets more samples where it has edges. Its light does not depend on the steps in which
/// it is refined, to the bit.
#[derive(Clone, Debug)]
pub struct Refining {
    tiles: Tiles,
    /// The G-buffer: the first sample of each pixel, tile by tile.
    first: Vec<Vec<First>>,
    /// All samples of each pixel, once there are more than one.
    watched: Vec<Vec<Watched>>,
    /// Number of passes done.
    passes: usize,
}

impl Refining {
    /// Returns a picture without samples.
    pub fn new(camera: &Camera, resolution: Resolution) -> Self {
        let tiles = Tiles::new(camera, resolution, 1);
        Self { tiles, first: vec![Vec::new(); tiles.count()], watched: vec![Vec::new(); tiles.count()], passes: 0 }
    }

    /// Traces what is missing up to [`Sampling::UpTo`](super::Sampling::UpTo) that number of samples, and returns the
    /// cost. The scene must be the same each time.
    ///
    /// # Errors
    /// [`Cancelled`], if the token is cancelled; the picture cannot be refined any further then.
    pub fn refine_or_cancel(
        &mut self,
        token: &Cancellation,
        scene: &Scene,
        samples: NonZeroU32,
    ) -> Result<Cost, Cancelled> {
        let executor = Executor::Cancellable(token);
        executor.finish(self.refine(executor, scene, samples))
    }

    pub(super) fn refine(&mut self, executor: Executor<'_>, scene: &Scene, samples: NonZeroU32) -> Cost {
        let wanted = PASSES.iter().filter(|pass| pass.end <= samples.get()).count();
        let mut cost = Cost::default();
        // Finding edges takes the whole first pass. After it each pixel decides by itself whether it needs more
        // samples, and no tile waits for another.
        if self.passes == 0 && wanted > 0 {
            cost += self.trace_first(executor, scene);
            self.passes = 1;
        }
        if self.passes < wanted {
            cost += self.trace_more(executor, scene, self.passes..wanted);
            self.passes = wanted;
        }
        cost
    }

    fn trace_first(&mut self, executor: Executor<'_>, scene: &Scene) -> Cost {
        let runs = Runs::of(PASSES[0].clone());
        let shot = Shot::new(scene, &self.tiles, Goal::Reflected);
        executor.trace(&shot, self.first.iter_mut().collect(), |tile, first| {
            first.resize(PIXELS, First::default());
            tile.trace(&runs, |buffers, _, _| see_first(first, buffers));
        })
    }

    /// Traces the remaining passes.
    fn trace_more(&mut self, executor: Executor<'_>, scene: &Scene, passes: Range<usize>) -> Cost {
        let white = 1.0 / scene.exposure();
        let runs: Vec<_> = passes.map(|pass| (pass, Runs::of(PASSES[pass].clone()))).collect();
        let Self { tiles, first, watched, .. } = self;
        let shot = Shot { unit: Unit::Tile(UNITS_OF_MORE), ..Shot::new(scene, tiles, Goal::Reflected) };
        executor.trace(&shot, watched.iter_mut().collect(), |tile, watched| {
            if watched.is_empty() {
                watched.extend(first[tile.number].iter().map(Watched::new));
            }
            for &(pass, ref runs) in &runs {
                tile.buffers.wanted.retain(|&pixel| match (pass, &watched[usize::from(pixel)]) {
                    (1, _) => is_at_edge(tiles, first, tile.number, pixel.into(), white),
                    (2, watched) => watched.is_at_edge(),
                    (_, watched) => watched.is_rough(white),
                });
                tile.trace(runs, |buffers, run, _| add_samples(watched, buffers, run.each()));
            }
        })
    }

    /// Returns whether no pixel will get more samples.
    pub fn is_final(&self) -> bool {
        self.passes == PASSES.len()
    }

    /// Returns the mean light of each pixel's samples.
    pub fn framebuffer(&self) -> Framebuffer {
        let mut framebuffer = Framebuffer::new(self.tiles.resolution);
        let parts = self.tiles.split(framebuffer.pixels_mut());
        for ((first, watched), mut part) in self.first.iter().zip(&self.watched).zip(parts) {
            if !watched.is_empty() {
                self.tiles.show(&ALL_PIXELS, |pixel| watched[pixel].mean(), &mut part);
            } else if !first.is_empty() {
                self.tiles.show(&ALL_PIXELS, |pixel| first[pixel].light, &mut part);
            }
        }
        framebuffer
    }
}

/// The progress [units](Unit) of a tile in all passes but the first, whose number of samples is not known beforehand.
/// For the pictures of `scenes/` these passes take 8 to 25 times the instructions of the first.
const UNITS_OF_MORE: u64 = 16 * PIXELS as u64;

/// Returns the units of all passes but the first.
pub(super) fn units_of_more(resolution: Resolution, samples: NonZeroU32) -> u64 {
    let is_refined = PASSES[1].end <= samples.get();
    if is_refined { UNITS_OF_MORE * Tiles::count_of(resolution) as u64 } else { 0 }
}

/// Returns whether an edge may run beside a pixel of a tile; `white` is the light that is displayed as white.
fn is_at_edge(tiles: &Tiles, first: &[Vec<First>], tile: usize, pixel: usize, white: f32) -> bool {
    let own = &first[tile][pixel];
    let [columns, rows] = tiles.around(tile, pixel);
    rows.into_iter().any(|y| {
        columns.clone().any(|x| {
            let (tile, pixel) = tiles.at([x, y]);
            own.is_edge_to(&first[tile][pixel], white)
        })
    })
}

/// Records the hits and light of a batch with one ray per pixel.
fn see_first(first: &mut [First], buffers: &Buffers) {
    for (ray, &pixel) in buffers.pixels.iter().enumerate() {
        let (group, lane) = (ray / LANES, ray % LANES);
        // Stored as a sum of one sample, which is never -0.
        let light = LinearRgb::BLACK + shade::light_of(&buffers.lights[group], lane);
        let lit_by = buffers.arriving[group].lit_by[lane];
        first[usize::from(pixel)] = First::new(light, buffers.points[group].seen(lane), lit_by);
    }
}

/// Adds a batch's samples, `each` for every pixel, to the tile's pixels.
fn add_samples(watched: &mut [Watched], buffers: &Buffers, each: usize) {
    let bands = buffers.bands();
    for (first, &pixel) in buffers.pixels.iter().enumerate().step_by(each) {
        watched[usize::from(pixel)].add(bands.each_ref().map(|band| &band[first..first + each]));
    }
}
