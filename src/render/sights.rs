//! What the rays through a picture's pixels meet, for pictures of something else than light.

use super::sampling::Run;
use super::tiles::Tiles;
use super::{Buffers, Cost, Crew, Sampling};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::{self, Hit, Kernel};
use crate::lanes::LANES;
use crate::progress::Cancelled;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade;
use crate::shape::{Surface, SurfacePoint};
use std::time::Instant;

/// How far rays are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// To the surfaces that they meet.
    Surfaces,
    /// And from there to the lights.
    Lights,
}

/// What was found through the middle of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// The eye ray.
    pub ray: Ray,
    /// What it meets first.
    pub hit: Option<Hit>,
    /// Which lights arrive there, a bit for each; the thirty-third shares its bit with the first, and so on. None where
    /// nothing was followed so far.
    pub lit_by: u32,
}

impl Sight {
    /// The surface that is met.
    pub fn surface(&self, scene: &Scene) -> Option<SurfacePoint> {
        self.hit.map(|hit| hit.surface(scene).at_crossing(&self.ray, hit.t))
    }
}

/// What was made of sights, and what that took.
#[derive(Clone, Debug, PartialEq)]
pub struct Sighted<T> {
    /// One for each pixel, row by row from the top.
    pub pixels: Vec<T>,
    /// What it took.
    pub cost: Cost,
}

/// What `see` makes of the sight through each pixel: the eye rays of [`render`](super::render), one for each pixel, or for
/// two by two where the sampling is [`Coarse`](Sampling::Coarse).
///
/// # Errors
/// [`Cancelled`], if the crew's token is.
pub fn sights<T: Copy + Default + Send>(
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
    reach: Reach,
    see: impl Fn(&Sight) -> T + Sync,
) -> Result<Sighted<T>, Cancelled> {
    crew.finish(all_sights(crew, scene, camera, resolution, sampling, reach, see))
}

/// [`sights`], the rest of which a crew that is cancelled passes over.
pub(crate) fn all_sights<T: Copy + Default + Send>(
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
    reach: Reach,
    see: impl Fn(&Sight) -> T + Sync,
) -> Sighted<T> {
    let scale = if sampling == Sampling::Coarse { 2 } else { 1 };
    let tiles = Tiles::new(camera, resolution, scale);
    let run = Run::first();
    let mut pixels = vec![T::default(); resolution.pixel_count()];
    let cost = crew.trace(tiles.split(&mut pixels), |buffers: &mut Buffers, (tile, mut part)| {
        if crew.is_cancelled() {
            return Cost::default();
        }
        tiles.inside(tile, &mut buffers.wanted);
        let show = |pixel, sight: &Sight| tiles.put(pixel, see(sight), &mut part);
        buffers.see_tile(scene, &tiles, tile, &run, reach, show)
    });
    Sighted { pixels, cost }
}

impl Buffers {
    /// Shows what is seen through each of the wanted pixels of a tile.
    fn see_tile(
        &mut self,
        scene: &Scene,
        tiles: &Tiles,
        tile: usize,
        run: &Run,
        reach: Reach,
        mut show: impl FnMut(u8, &Sight),
    ) -> Cost {
        let Self { wanted, rays, hits, points, shadows, arriving, .. } = self;
        let start = Instant::now();
        tiles.make_eye_rays(tile, wanted, run, rays);
        hit::closest_hits(Kernel::Auto, scene, rays, hits);
        let mut traced = wanted.len() as u64;
        arriving.clear();
        if reach == Reach::Lights {
            shade::surface_points(scene, rays, hits, points);
            traced += shade::arriving_light(scene, points, shadows, arriving);
        }
        for (group, pixels) in wanted.chunks(LANES).enumerate() {
            for (lane, &pixel) in pixels.iter().enumerate() {
                let lit_by = arriving.get(group).map_or(0, |arriving| arriving.lit_by[lane]);
                show(pixel, &Sight { ray: rays[group].ray(lane), hit: hits[group].hit(scene, lane), lit_by });
            }
        }
        Cost { rays: traced, work: start.elapsed() }
    }
}
