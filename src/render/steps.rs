//! The five steps for a batch of rays and the arrays between them: eye rays, closest hits, surface points, arriving
//! light, reflected light.

use super::sampling::{MAX_BATCH_RAYS, SampleBatch};
use super::tiles::Tiles;
use crate::hit::{self, EightHits, Kernel};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, EightArriving, EightLights, EightPoints, ShadowRays};
use std::ops::Range;

/// The last step of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stage {
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
pub(super) enum ProgressUnit {
    /// Each eye ray.
    Ray,
    /// Each tile, as this many units.
    Tile(u64),
}

/// A scene, the tiles of a picture of it, and the way of tracing.
#[derive(Clone, Copy)]
pub(super) struct RenderJob<'a> {
    pub(super) scene: &'a Scene,
    pub(super) tiles: &'a Tiles,
    /// The kernel for closest hits.
    pub(super) kernel: Kernel,
    pub(super) last_stage: Stage,
    pub(super) unit: ProgressUnit,
}

impl<'a> RenderJob<'a> {
    pub(super) fn new(scene: &'a Scene, tiles: &'a Tiles, last_stage: Stage) -> Self {
        Self { scene, tiles, kernel: Kernel::Auto, last_stage, unit: ProgressUnit::Ray }
    }
}

/// The arrays between the steps, reused from tile to tile. Those after the job's last step stay empty.
#[derive(Default)]
pub(super) struct Buffers {
    /// The active pixels of the tile.
    pub(super) active: Vec<u8>,
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
    /// Takes the samples of a batch for some of the active pixels through the steps, up to the job's last one. Returns
    /// the number of rays traced.
    pub(super) fn trace(&mut self, job: &RenderJob<'_>, tile: usize, batch: &SampleBatch, range: Range<usize>) -> u64 {
        let &RenderJob { scene, tiles, kernel, last_stage, .. } = job;
        let Self { active, pixels, rays, hits, points, shadows, arriving, .. } = self;
        batch.assign_pixels(&active[range], pixels);
        tiles.make_eye_rays(tile, pixels, batch, rays);
        hit::closest_hits(kernel, scene, rays, hits);
        let mut traced = pixels.len() as u64;
        if last_stage >= Stage::Points {
            shade::surface_points(scene, rays, hits, points);
        }
        if last_stage >= Stage::Arriving {
            traced += shade::arriving_light(scene, points, shadows, arriving);
        }
        if last_stage >= Stage::Reflected {
            self.reflect(job, batch);
        }
        traced
    }

    /// The last step, for any arriving light.
    pub(super) fn reflect(&mut self, &RenderJob { scene, tiles, .. }: &RenderJob<'_>, batch: &SampleBatch) {
        let Self { rays, hits, points, arriving, lights, .. } = self;
        shade::reflect(scene, rays, tiles.steps(batch.samples.start), hits, points, arriving, lights);
    }

    /// Returns the reflected light of all rays, per channel.
    pub(super) fn channels(&self) -> [[f32; MAX_BATCH_RAYS]; 3] {
        let mut channels = [[0.0; MAX_BATCH_RAYS]; 3];
        for (number, channel) in channels.iter_mut().enumerate() {
            for (eight, light) in channel.as_chunks_mut().0.iter_mut().zip(&self.lights) {
                *eight = light[number].0;
            }
        }
        channels
    }
}
