//! What the rays through a picture's pixels meet, for pictures of something else than light.

use super::sampling::Runs;
use super::steps::{Buffers, Goal, Shot};
use super::tiles::Tiles;
use super::{Cost, Crew, Sampling};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::Hit;
use crate::lanes::LANES;
use crate::progress::Cancelled;
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shape::{Surface, SurfacePoint};

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
    let goal = if reach == Reach::Lights { Goal::Arriving } else { Goal::Hits };
    let runs = Runs::of(0..1);
    let mut pixels = vec![T::default(); resolution.pixel_count()];
    let cost = crew.trace(&Shot::new(scene, &tiles, goal), tiles.split(&mut pixels), |tile, mut part| {
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
