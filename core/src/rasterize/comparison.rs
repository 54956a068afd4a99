//! Comparison of image order (ray tracing) and object order (rasterization): tests and times.

use super::{DepthBuffer, Rasterizer};
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::Resolution;
use crate::hit::{TestCount, closest_hit_observed};
use crate::material::Material;
use crate::render::{Executor, GBufferSample, Sampling, TraceDepth, trace_g_buffer_partial};
use crate::scene::{Object, Scene};
use crate::shape::Sphere;
use glam::Vec3;
use std::num::NonZeroU32;
use std::time::{Duration, Instant};

/// The times that both orders take to find the visible object of each pixel on one thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrderTimes {
    /// The time of image order: tracing a ray through each pixel, without building the trees.
    pub image: Duration,
    /// The time of object order: drawing all objects.
    pub object: Duration,
}

/// The number of measurements, of which the fastest counts.
// Other processes of the machine only make a run slower, so the fastest run is the least disturbed one.
const ROUNDS: u32 = 3;

impl OrderTimes {
    /// Measures both orders.
    pub fn measure(scene: &Scene, camera: &Camera, resolution: Resolution) -> Self {
        let traced = || {
            // Traces on one thread, with one ray for each pixel and without shading, because the rasterizer draws so.
            let (one, depth) = (Sampling::Each(NonZeroU32::MIN), TraceDepth::Surfaces);
            let seen = |sample: &GBufferSample| sample.hit.map(|hit| (hit.object, hit.t));
            trace_g_buffer_partial(Executor::CurrentThread, scene, camera, resolution, one, depth, seen)
        };
        Self { image: fastest(traced), object: fastest(|| Rasterizer::drawn(scene, camera, resolution)) }
    }
}

/// Returns the shortest time that `run` takes.
fn fastest<T>(mut run: impl FnMut() -> T) -> Duration {
    let time = |_| {
        let start = Instant::now();
        // Without the black box the optimiser removes a result that is not used.
        std::hint::black_box(run());
        start.elapsed()
    };
    (0..ROUNDS).map(time).min().unwrap_or_default()
}

/// The tests and times of both orders, for an animation that builds a picture in both.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The times of both orders.
    pub times: OrderTimes,
    /// The tests of image order, summed up to and including each pixel, row by row from the top.
    pub image_tests: Vec<u64>,
    /// The tests of object order, summed up to and including each object.
    ///
    /// Each triangle of a mesh counts as an object.
    pub object_tests: Vec<u64>,
    /// The nearest object of each pixel, as an index into `object_tests`.
    pub nearest: DepthBuffer,
    /// The times for growing numbers of spheres, measured at the same picture size as `times`.
    pub growth: Vec<(u32, OrderTimes)>,
}

impl Comparison {
    /// The numbers of spheres for which both orders are measured.
    pub const NUMBERS: [u32; 4] = [10, 100, 1_000, 10_000];

    /// Compares both orders: image order in a picture of size `image`, and object order in one of
    /// size `object`.
    ///
    /// The times of both orders are measured at the size `image`.
    pub fn new(scene: &Scene, camera: &Camera, [image, object]: [Resolution; 2]) -> Self {
        let (width, height) = (image.width(), image.height());
        let rays = camera.eye_rays(image.aspect_ratio());
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x as f32 + 0.5, y as f32 + 0.5)));
        let mut count = TestCount::default();
        let image_tests = pixels.map(|(x, y)| {
            let ray = rays.through(x / width as f32, (height as f32 - y) / height as f32);
            closest_hit_observed(scene, &ray, &mut count);
            count.0
        });
        let growth = Self::NUMBERS.map(|number| {
            let scene = spheres_in_a_cube(number, scene.camera());
            (number, OrderTimes::measure(&scene, scene.camera(), image))
        });
        let image_tests = image_tests.collect();
        let (mut steps, mut object_tests) = (ObjectSteps::new(camera, object), Vec::new());
        while steps.draw_next(scene) {
            object_tests.push(steps.rasterizer.tests());
        }
        let times = OrderTimes::measure(scene, camera, image);
        Self { times, image_tests, object_tests, nearest: steps.rasterizer.buffer, growth: growth.to_vec() }
    }

    /// Returns the total number of tests of the order that needs more of them.
    pub fn max_total_tests(&self) -> u64 {
        let last = |tests: &[u64]| tests.last().copied().unwrap_or(0);
        last(&self.image_tests).max(last(&self.object_tests))
    }

    /// Returns the number of pixels that image order has drawn after this number of tests.
    pub fn built_pixels(&self, tests: u64) -> usize {
        self.image_tests.partition_point(|&until| until <= tests)
    }
}

/// A picture that is drawn one object at a time. Each triangle of a mesh counts as an object.
pub struct ObjectSteps {
    rasterizer: Rasterizer,
    /// The indices of the next object in the scene, and of the next primitive of its shape.
    next: (usize, u32),
    drawn: u32,
}

impl ObjectSteps {
    /// Returns an empty picture.
    pub fn new(camera: &Camera, resolution: Resolution) -> Self {
        Self { rasterizer: Rasterizer::new(camera, resolution), next: (0, 0), drawn: 0 }
    }

    /// Draws the next object; returns false after the last one.
    pub fn draw_next(&mut self, scene: &Scene) -> bool {
        let Some(shape) = scene.objects().get(self.next.0).map(|object| &object.shape) else { return false };
        if self.next.1 == shape.primitive_count() {
            self.next = (self.next.0 + 1, 0);
            return self.draw_next(scene);
        }
        self.rasterizer.draw(&shape.primitive(self.next.1), self.drawn);
        // Without this call, a sphere or triangle would not be drawn before seven others have been added.
        self.rasterizer.finish();
        self.next.1 += 1;
        self.drawn += 1;
        true
    }

    /// Returns the number of objects that were drawn.
    pub fn drawn(&self) -> u32 {
        self.drawn
    }

    /// Returns the nearest object drawn so far at a pixel, as its number from 0, and its depth.
    pub fn nearest(&self, x: u32, y: u32) -> Option<(u32, f32)> {
        self.rasterizer.buffer.at(x, y)
    }
}

/// Returns a scene of spheres at random positions, with about the same total volume for any number.
pub fn spheres_in_a_cube(number: u32, otherwise: &Camera) -> Scene {
    let radius = 0.6 / libm::cbrtf(number as f32);
    let grey = Material::diffuse(LinearRgb::grey(0.5)).unwrap_or_default();
    let object = |(center, factor): (Vec3, f32)| Object::new(Sphere::unchecked(center, radius * factor), grey);
    let camera = Camera::look_at(Vec3::new(0.0, 1.2, 5.0), Vec3::new(0.0, 0.4, 0.0));
    let camera = camera.and_then(|camera| camera.with_fov_degrees(40.0)).unwrap_or(*otherwise);
    Scene::new(camera, random_centers_and_scales(number).map(object).collect())
}

/// Returns random centres in a cube of side 2.4, and random factors of radii from 0.5 to 1.5.
pub fn random_centers_and_scales(number: u32) -> impl Iterator<Item = (Vec3, f32)> {
    // The seed is fixed, so that results of different days and programs are about the same scene.
    let mut random = Xorshift(0x9E37_79B9_7F4A_7C15);
    (0..number).map(move |_| {
        let [x, y, z] = [(); 3].map(|()| random.next() * 2.4 - 1.2);
        (Vec3::new(x, y + 0.4, z), 0.5 + random.next())
    })
}

/// Marsaglia's xorshift generator (Xorshift RNGs, 2003) with 64 bits and the shifts 13, 7 and 17.
// Not a crate's generator, which may change its sequence with a release: a program in another language must get the
// same numbers.
struct Xorshift(u64);

impl Xorshift {
    /// Returns the next random number, uniform in 0..1, from the upper 24 bits of the state: as
    /// many as an f32 represents exactly.
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / 16_777_216.0
    }
}
