//! The five steps of rendering for a batch of rays, and the arrays between them.
//!
//! The steps are eye rays, closest hits, surface points, arriving light, and reflected light.

use super::sampling::{MAX_BATCH_RAYS, SampleBatch};
use super::tiles::Tiles;
use crate::hit::{self, EightHits, Kernel};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, Bounces, EightArriving, EightLights, EightPoints, Generation, ShadowRays, Surfaces};
use std::ops::Range;

/// A stage of rendering, named by its result.
///
/// The stages are in order, and each includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stage {
    /// The closest hits of the eye rays.
    Hits,
    /// The surface points of the hits.
    Points,
    /// The light that arrives at the surface points.
    Arriving,
    /// The light reflected towards the eye.
    Reflected,
}

/// The unit in which the progress of a picture is counted.
#[derive(Clone, Copy, Debug)]
pub(super) enum ProgressUnit {
    /// One unit of progress for each eye ray.
    Ray,
    /// A fixed number of units per tile, if the number of rays is not known in advance.
    Tile(u64),
}

/// A picture to be traced: its scene and tiles, the kernel, the last stage, and the unit of
/// progress.
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

/// The arrays between the steps, reused from tile to tile.
// An element is a group of eight in SoA layout. With arrays of single rays, hits and points, each step spent half of
// its time on loading and storing lanes (three_spheres: 2.0 instead of 4.5 times as many rays per second as Embree).
#[derive(Default)]
pub(super) struct Buffers {
    /// The indices in the tile of the pixels to be traced.
    pub(super) active: Vec<u8>,
    /// The index in the tile of each ray's pixel.
    pub(super) pixels: Vec<u8>,
    /// The number of each ray's sample in its pixel; empty if no light depends on it.
    pub(super) samples: Vec<u32>,
    // The remaining arrays have an element for each group of eight rays. Those after the job's last stage stay empty.
    pub(super) rays: Vec<EightRays>,
    pub(super) hits: Vec<EightHits>,
    pub(super) points: Vec<EightPoints>,
    pub(super) shadows: ShadowRays,
    pub(super) arriving: Vec<EightArriving>,
    pub(super) lights: Vec<EightLights>,
    pub(super) bounces: Bounces,
}

impl Buffers {
    /// Traces the samples of a batch for a range of the active pixels, and returns the number of
    /// traced rays.
    ///
    /// Runs the steps up to the job's last stage.
    pub(super) fn trace(&mut self, job: &RenderJob<'_>, tile: usize, batch: &SampleBatch, range: Range<usize>) -> u64 {
        let &RenderJob { scene, tiles, kernel, last_stage, .. } = job;
        let Self { active, pixels, samples, rays, hits, points, shadows, arriving, .. } = self;
        batch.assign_pixels(&active[range], pixels);
        tiles.make_eye_rays(tile, pixels, batch, rays);
        hit::closest_hits(kernel, scene, rays, hits);
        let mut traced = pixels.len() as u64;
        if last_stage >= Stage::Points {
            shade::surface_points(scene, rays, hits, points);
        }
        if last_stage >= Stage::Arriving {
            samples.clear();
            if scene.is_sampled() {
                batch.assign_samples(pixels.len(), samples);
            }
            traced += shade::arriving_light(scene, &Surfaces { rays, points, samples }, shadows, arriving);
        }
        if last_stage >= Stage::Reflected {
            self.compute_reflected_light(job, batch);
            if scene.has_emission() {
                shade::add_emission(scene, &self.points, &mut self.lights);
            }
            if !scene.is_all_matte() {
                traced += self.add_bounced_light(job, batch);
            }
            if let Some(fog) = scene.fog() {
                shade::add_fog(&fog, &self.rays, &self.hits, &mut self.lights);
            }
        }
        traced
    }

    /// Computes the reflected light from the arriving light.
    pub(super) fn compute_reflected_light(
        &mut self,
        &RenderJob { scene, tiles, .. }: &RenderJob<'_>,
        batch: &SampleBatch,
    ) {
        let Self { rays, hits, points, arriving, lights, .. } = self;
        shade::reflected_light(
            scene,
            rays,
            tiles.sample_direction_steps(batch.samples.start),
            hits,
            points,
            arriving,
            lights,
        );
    }

    /// Adds the light of bounced rays.
    ///
    /// Returns the number of traced rays.
    fn add_bounced_light(&mut self, &RenderJob { scene, tiles, .. }: &RenderJob<'_>, batch: &SampleBatch) -> u64 {
        let Self { samples, rays, hits, points, shadows, lights, bounces, .. } = self;
        let steps = tiles.sample_direction_steps(batch.samples.start);
        bounces.add(scene, steps, &Generation { rays, hits, points, shadows, samples }, lights)
    }

    /// Returns the reflected light of all rays as one array per channel.
    pub(super) fn light_channels(&self) -> [[f32; MAX_BATCH_RAYS]; 3] {
        let mut channels = [[0.0; MAX_BATCH_RAYS]; 3];
        for (number, channel) in channels.iter_mut().enumerate() {
            for (eight, light) in channel.as_chunks_mut().0.iter_mut().zip(&self.lights) {
                *eight = light[number].0;
            }
        }
        channels
    }
}
