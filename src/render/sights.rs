//! G-buffers: the hits of the rays through a picture's pixels, for pictures of something other than light.

use super::sampling::Runs;
use super::steps::{Buffers, Goal, Shot};
use super::tiles::Tiles;
use super::{Cost, Executor, Sampling};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::Hit;
use crate::lanes::LANES;
use crate::progress::Cancelled;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shape::{Surface, SurfacePoint};

/// The depth of tracing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// To the closest hits.
    Surfaces,
    /// To the lights as well.
    Lights,
}

/// The G-buffer sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The eye ray.
    pub ray: Ray,
    /// The closest hit.
    pub hit: Option<Hit>,
    /// Mask of the lights that reach the hit; light 32 shares its bit with light 0, and so on. Empty if shadow rays
    /// were not traced.
    pub lit_by: u32,
}

impl Sight {
    /// Returns the surface point of the hit.
    pub fn surface(&self, scene: &Scene) -> Option<SurfacePoint> {
        self.hit.map(|hit| hit.surface(scene).at_crossing(&self.ray, hit.t))
    }
}

/// The results for all pixels, and their cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Sighted<T> {
    /// One result per pixel, row by row from the top.
    pub pixels: Vec<T>,
    /// The cost.
    pub cost: Cost,
}

/// Returns the results of `see` for the G-buffer sample of each pixel: with the eye rays of [`render`](super::render),
/// one per pixel, or one for two by two pixels if the sampling is [`Coarse`](Sampling::Coarse).
///
/// # Errors
/// [`Cancelled`], if the executor's token is cancelled.
pub fn sights<T: Copy + Default + Send>(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
    reach: Reach,
    see: impl Fn(&Sight) -> T + Sync,
) -> Result<Sighted<T>, Cancelled> {
    executor.finish(all_sights(executor, scene, camera, resolution, sampling, reach, see))
}

/// Traces as [`sights`] does; after a cancel the rest is skipped.
pub(crate) fn all_sights<T: Copy + Default + Send>(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
    reach: Reach,
    see: impl Fn(&Sight) -> T + Sync,
) -> Sighted<T> {
    let scale = if sampling == Sampling::Coarse { 2 } else { 1 };
    let tiles = Tiles::new(camera, resolution, scale);
    let goal = if reach == Reach::Lights { Goal::Arriving } else { Goal::Hits };
    let runs = Runs::of(0..1);
    let mut pixels = vec![T::default(); resolution.pixel_count()];
    let cost = executor.trace(&Shot::new(scene, &tiles, goal), tiles.split(&mut pixels), |tile, mut part| {
        tile.trace(&runs, |Buffers { pixels, rays, hits, arriving, .. }, _, _| {
            for (group, pixels) in pixels.chunks(LANES).enumerate() {
                for (lane, &pixel) in pixels.iter().enumerate() {
                    let lit_by = arriving.get(group).map_or(0, |arriving| arriving.lit_by[lane]);
                    let sight = Sight { ray: rays[group].ray(lane), hit: hits[group].hit(scene, lane), lit_by };
                    tiles.put(pixel, see(&sight), &mut part);
                }
            }
        });
    });
    Sighted { pixels, cost }
}
