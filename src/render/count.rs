//! The trace stage alone, for those who time it: eye rays -> closest hits -> a shadow ray from each.

use super::pixel::Sum;
use super::{Raster, Tile};
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::set_bits;
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::shade::{self, EightPoints, TO_THE_LIGHT};
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
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    shadow_rays: Vec<EightRays>,
    blocked: Vec<u32>,
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
            hit::closest_hits(kernel, scene, &buffers.rays, &mut buffers.hits);
            counts = counts + buffers.count(kernel, scene);
        }
        counts
    }
}

impl Buffers {
    /// The rays and their hits, and the shadow rays that begin there.
    fn count(&mut self, kernel: Kernel, scene: &Scene) -> Counts {
        let Self { rays, hits, points, shadow_rays, blocked } = self;
        let mut counts = Counts { rays: shade::count(rays), ..Counts::default() };
        for hits in hits.iter() {
            let met = hits.met();
            counts.hits += u64::from(met.count_ones());
            counts.depths += set_bits(met).map(|lane| f64::from(hits.t.0[lane])).sum::<f64>();
        }
        if scene.shadows {
            shade::surface_points(scene, rays, hits, points);
        }
        for light in scene.lights.iter().filter(|_| scene.shadows) {
            shade::shadow_rays(light, points, shadow_rays);
            hit::any_hits(kernel, scene, shadow_rays, TO_THE_LIGHT, blocked);
            let (traced, blocked) = (shade::count(shadow_rays), blocked.iter().map(|met| u64::from(met.count_ones())));
            counts.rays += traced;
            counts.lit += traced - blocked.sum::<u64>();
        }
        counts
    }
}
