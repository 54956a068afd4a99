//! Rendering of a single pixel, with the values between the steps.

use super::sampling::{SampleBatch, sample_position};
use super::steps::{Buffers, RenderJob, Stage};
use super::tiles::Tiles;
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::Resolution;
use crate::hit::Hit;
use crate::lanes::{F32x8, LANES};
use crate::ray::Ray;
use crate::scene::Scene;
use crate::shade;
use glam::Vec2;

/// The values between the steps of [`render`](super::render) for the first sample of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelTrace {
    /// The lecture's (qu, qv): the position in the picture, from (0, 0) at the lower left corner to
    /// (1, 1).
    pub q: Vec2,
    /// The eye ray.
    pub ray: Ray,
    /// The closest hit.
    pub hit: Option<Hit>,
    /// The light that arrives at the hit: the ambient light and the light of all sources.
    pub arriving: LinearRgb,
    /// The reflectance, each channel in 0..=1.
    pub reflectance: LinearRgb,
    /// The light towards the eye, from the hit or from the background.
    pub light: LinearRgb,
}

impl Scene {
    /// Returns the hit of the eye ray through the centre of a pixel.
    ///
    /// The pixel is given as column and row from the top left.
    ///
    /// Returns `None` if the ray hits nothing, or the pixel is outside the picture.
    ///
    /// ```
    /// use termtrace::{Resolution, Scene};
    ///
    /// let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
    /// let scene = Scene::from_ron("ball.ron", text)?;
    /// let resolution = Resolution::new(81, 81)?;
    /// let hit = scene.hit(scene.camera(), resolution, [40, 40]);
    /// assert!(hit.is_some_and(|hit| hit.object == 0 && (hit.t - 4.0).abs() < 1e-3));
    /// assert_eq!(scene.hit(scene.camera(), resolution, [0, 0]), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn hit(&self, camera: &Camera, resolution: Resolution, pixel: [u32; 2]) -> Option<Hit> {
        let is_inside = pixel[0] < resolution.width() && pixel[1] < resolution.height();
        is_inside.then(|| trace_pixel(self, camera, resolution, pixel).hit).flatten()
    }
}

/// Runs the steps of [`render`](super::render) for one pixel.
///
/// The pixel is given as column and row from the top left.
///
/// The same functions render pictures, so the values are those of the picture, bit for bit.
///
/// # Panics
/// Outside the picture.
pub fn trace_pixel(scene: &Scene, camera: &Camera, resolution: Resolution, [x, y]: [u32; 2]) -> PixelTrace {
    assert!(x < resolution.width() && y < resolution.height(), "pixel ({x}, {y}) is outside the picture");
    let tiles = Tiles::new(camera, resolution, 1);
    let (tile, pixel) = tiles.tile_and_index([x, y]);
    let (job, batch) = (RenderJob::new(scene, &tiles, Stage::Reflected), SampleBatch::of(0..1));
    let mut buffers = Buffers { active: vec![pixel as u8], ..Buffers::default() };
    buffers.trace(&job, tile, &batch, 0..1);
    let [arriving, light] = [&buffers.arriving[0].light, &buffers.lights[0]].map(|lights| shade::lane_light(lights, 0));
    // Reflects a light of 1 to get the reflectance, which the last step does not return separately.
    buffers.arriving[0].light = [F32x8([1.0; LANES]); 3];
    buffers.compute_reflected_light(&job, &batch);
    PixelTrace {
        q: tiles.picture_position([x as f32, y as f32], sample_position(0).into()).into(),
        ray: buffers.rays[0].ray(0),
        hit: buffers.hits[0].hit(scene, 0),
        arriving,
        reflectance: shade::lane_light(&buffers.lights[0], 0),
        light,
    }
}
