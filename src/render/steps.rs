//! The five steps for a batch of rays and the arrays between them: eye rays, closest hits, surface points, arriving
//! light, reflected light.

use super::sampling::{MOST_RAYS, Run};
use super::tiles::Tiles;
use crate::hit::{self, EightHits, Kernel};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, EightArriving, EightLights, EightPoints, ShadowRays};
use std::ops::Range;

/// The last step of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Goal {
    /// The closest hits.
    Hits,
    /// The surface points there.
    Points,
    /// The light that arrives at these.
    Arriving,
    /// The light towards the eye.
    Reflected,
}

/// The unit in which progress of a picture is counted.
#[derive(Clone, Copy, Debug)]
pub(super) enum Unit {
    /// Each eye ray.
    Ray,
    /// Each tile, as this many units.
    Tile(u64),
}

/// A scene, the tiles of a picture of it, and the way of tracing.
#[derive(Clone, Copy)]
pub(super) struct Shot<'a> {
    pub(super) scene: &'a Scene,
    pub(super) tiles: &'a Tiles,
    /// The kernel for closest hits.
    pub(super) kernel: Kernel,
    pub(super) goal: Goal,
    pub(super) unit: Unit,
}

impl<'a> Shot<'a> {
    pub(super) fn new(scene: &'a Scene, tiles: &'a Tiles, goal: Goal) -> Self {
        Self { scene, tiles, kernel: Kernel::Auto, goal, unit: Unit::Ray }
    }
}

/// The arrays between the steps, reused from tile to tile. Those after the shot's last step stay empty.
#[derive(Default)]
pub(super) struct Buffers {
    /// The active pixels of the tile.
    pub(super) wanted: Vec<u8>,
    /// The pixel of each ray.
    pub(super) pixels: Vec<u8>,
    pub(super) rays: Vec<EightRays>,
    pub(super) hits: Vec<EightHits>,
    pub(super) points: Vec<EightPoints>,
    pub(super) shadows: ShadowRays,
    pub(super) arriving: Vec<EightArriving>,
    pub(super) lights: Vec<EightLights>,
}

impl Buffers {
    /// Takes the samples of a batch for some of the active pixels through the steps, up to the shot's last one. Returns
    /// the number of rays traced.
    pub(super) fn trace(&mut self, shot: &Shot<'_>, tile: usize, run: &Run, batch: Range<usize>) -> u64 {
        let &Shot { scene, tiles, kernel, goal, .. } = shot;
        let Self { wanted, pixels, rays, hits, points, shadows, arriving, .. } = self;
        run.spread(&wanted[batch], pixels);
        tiles.make_eye_rays(tile, pixels, run, rays);
        hit::closest_hits(kernel, scene, rays, hits);
        let mut traced = pixels.len() as u64;
        if goal >= Goal::Points {
            shade::surface_points(scene, rays, hits, points);
        }
        if goal >= Goal::Arriving {
            traced += shade::arriving_light(scene, points, shadows, arriving);
        }
        if goal >= Goal::Reflected {
            self.reflect(shot, run);
        }
        traced
    }

    /// The last step, for any arriving light.
    pub(super) fn reflect(&mut self, &Shot { scene, tiles, .. }: &Shot<'_>, run: &Run) {
        let Self { rays, hits, points, arriving, lights, .. } = self;
        shade::reflect(scene, rays, tiles.steps(run.samples.start), hits, points, arriving, lights);
    }

    /// Returns the reflected light of all rays, per channel.
    pub(super) fn bands(&self) -> [[f32; MOST_RAYS]; 3] {
        let mut bands = [[0.0; MOST_RAYS]; 3];
        for (number, band) in bands.iter_mut().enumerate() {
            for (eight, light) in band.as_chunks_mut().0.iter_mut().zip(&self.lights) {
                *eight = light[number].0;
            }
        }
        bands
    }
}
