//! The trace stage alone, for those who time it: eye rays -> closest hits -> a shadow ray from each.

use super::pixel::Sum;
use super::{Raster, Tile};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::{self, Hit, Kernel};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade::{self, TO_THE_LIGHT, shadow_ray};
use crate::shape::SurfacePoint;
use glam::Vec3;
use rayon::prelude::*;
use std::num::NonZeroU32;
use std::ops::{Add, Range};

/// What a picture's rays met.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// How many rays were traced: eye rays and shadow rays.
    pub rays: u64,
    /// How many eye rays met an object.
    pub hits: u64,
    /// How many of the points that they met nothing keeps from a light, counted for each light. Light that comes from
    /// behind the surface counts: nothing but the tracing is looked at here.
    pub lit: u64,
    /// The sum of the depths of all hits: t, as an eye ray's direction has the length 1 along the view.
    pub depths: f64,
}

impl Add for Counts {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            hits: self.hits + other.hits,
            lit: self.lit + other.lit,
            depths: self.depths + other.depths,
        }
    }
}

/// Traces the eye rays of [`render`](super::render) in that way with so many samples of each pixel, and, if the scene has
/// shadows, one ray from each hit to each light, also where the surface faces away from it; on the threads of the current
/// rayon pool.
pub fn count(kernel: Kernel, scene: &Scene, camera: &Camera, resolution: Resolution, samples: NonZeroU32) -> Counts {
    let raster = Raster::<Sum>::new(camera, resolution, 1);
    let tiles = raster.tiles();
    let tile = |buffers: &mut Buffers, tile: &Tile| raster.count_tile(kernel, scene, 0..samples.get(), tile, buffers);
    let counts: Vec<_> = match rayon::current_num_threads() {
        1 => {
            let mut buffers = Buffers::default();
            tiles.iter().map(|at| tile(&mut buffers, at)).collect()
        }
        _ => tiles.par_iter().map_init(Buffers::default, tile).collect(),
    };
    // In the tiles' order: a sum of floats depends on it.
    counts.into_iter().fold(Counts::default(), Add::add)
}

/// The arrays between the steps, kept from tile to tile.
#[derive(Default)]
struct Buffers {
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    points: Vec<Option<SurfacePoint>>,
    shadow_rays: Vec<Ray>,
    blocked: Vec<bool>,
}

impl Raster<Sum> {
    fn count_tile(
        &self,
        kernel: Kernel,
        scene: &Scene,
        samples: Range<u32>,
        tile: &Tile,
        buffers: &mut Buffers,
    ) -> Counts {
        let places: Vec<_> = tile.places().collect();
        let mut counts = Counts::default();
        for sample in samples {
            self.make_eye_rays(&places, sample, &mut buffers.rays);
            hit::closest_hits_by(kernel, scene, &buffers.rays, &mut buffers.hits);
            counts = counts + buffers.count(kernel, scene);
        }
        counts
    }
}

impl Buffers {
    /// The rays and their hits, and the shadow rays that begin there.
    fn count(&mut self, kernel: Kernel, scene: &Scene) -> Counts {
        let Self { rays, hits, points, shadow_rays, blocked } = self;
        let mut counts = Counts {
            rays: rays.len() as u64,
            hits: hits.iter().flatten().count() as u64,
            lit: 0,
            depths: hits.iter().flatten().map(|hit| f64::from(hit.t)).sum(),
        };
        if scene.shadows {
            shade::surface_points(scene, rays, [Vec3::ZERO; 2], hits, points);
        }
        for light in scene.lights.iter().filter(|_| scene.shadows) {
            shadow_rays.clear();
            shadow_rays.extend(points.iter().flatten().map(|point| shadow_ray(light, point)));
            hit::any_hits_by(kernel, scene, shadow_rays, TO_THE_LIGHT, blocked);
            counts.rays += shadow_rays.len() as u64;
            counts.lit += blocked.iter().filter(|&&blocked| !blocked).count() as u64;
        }
        counts
    }
}
