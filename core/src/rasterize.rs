//! Rasterization, to compare it with ray tracing: a loop over objects that finds the pixels of each
//! (lecture, "Looking ahead").
//!
//! Each primitive is projected to a rectangle of pixels, and skipped if the rectangle contains no pixel's centre.
//! Triangles are filled by their edge functions. All other primitives are intersected with the eye rays of the pixels
//! in their rectangle. A depth buffer keeps the nearest object of each pixel. Spheres and triangles are projected eight
//! at a time, and drawn eight pixels at a time. Nothing is shaded: as with eye rays, only the visible objects are
//! found. Holes, which a picture or a mesh's file makes, are drawn as if the surface were whole.

use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::lanes::{LANES, set_bits};
use crate::ray::{Interval, Probe};
use crate::scene::Scene;
use crate::shape::{Plane, Primitive, Sphere, Surface};
use crate::simd;
use glam::Vec3;
use plane::DrawPlane;
use projection::Projection;
use sphere::DrawSpheres;
use triangle::DrawTriangles;

mod depth_buffer;
mod projection;
mod clipped;
mod comparison;
mod plane;
mod sphere;
mod triangle;

pub use comparison::{Comparison, ObjectSteps, OrderTimes, random_centers_and_scales, spheres_in_a_cube};
pub use depth_buffer::DepthBuffer;

/// Draws all objects of a scene, one after the other, on the calling thread.
pub fn rasterize(scene: &Scene, camera: &Camera, resolution: Resolution) -> DepthBuffer {
    Rasterizer::drawn(scene, camera, resolution).buffer
}

/// A picture that is drawn object by object.
pub struct Rasterizer {
    projection: Projection,
    buffer: DepthBuffer,
    /// Spheres that are not drawn yet, with the indices of their objects; `triangles` likewise.
    spheres: Vec<(Sphere, u32)>,
    triangles: Vec<([Vec3; 3], u32)>,
    tests: u64,
}

impl Rasterizer {
    /// Returns an empty picture.
    pub fn new(camera: &Camera, resolution: Resolution) -> Self {
        let projection = Projection::new(camera, resolution);
        let buffer = DepthBuffer::new(resolution);
        let (spheres, triangles) = (Vec::with_capacity(LANES), Vec::with_capacity(LANES));
        Self { projection, buffer, spheres, triangles, tests: 0 }
    }

    /// Returns a rasterizer that has drawn all objects of a scene.
    fn drawn(scene: &Scene, camera: &Camera, resolution: Resolution) -> Self {
        let mut rasterizer = Self::new(camera, resolution);
        for (object, index) in scene.objects().iter().zip(0..) {
            for primitive in 0..object.shape.primitive_count() {
                rasterizer.draw(&object.shape.primitive(primitive), index);
            }
        }
        rasterizer.finish();
        rasterizer
    }

    /// Draws a primitive of an object, now or in a later call, at the latest in
    /// [`finish`](Self::finish).
    #[inline]
    pub fn draw(&mut self, primitive: &Primitive<'_>, object: u32) {
        match primitive {
            // Spheres and triangles wait until there are eight of a kind, one for each lane of a kernel.
            Primitive::Sphere(sphere) => {
                self.spheres.push((**sphere, object));
                if self.spheres.len() == LANES {
                    self.draw_spheres();
                }
            }
            Primitive::Triangle(triangle) => self.queue_triangle(triangle.corners(), object),
            Primitive::Facet(facet) => self.queue_triangle(facet.triangle().corners(), object),
            Primitive::Plane(plane) => self.draw_plane(plane, object),
            primitive => self.draw_by_eye_rays(primitive, object),
        }
    }

    /// Draws the spheres and triangles that are not drawn yet.
    pub fn finish(&mut self) {
        self.draw_spheres();
        self.draw_triangles();
    }

    /// Returns the nearest object drawn so far at each pixel.
    pub fn buffer(&self) -> &DepthBuffer {
        &self.buffer
    }

    /// Returns the number of tests so far: one for each primitive, and one for each pixel in its
    /// rectangle.
    pub fn tests(&self) -> u64 {
        self.tests
    }

    #[inline]
    fn queue_triangle(&mut self, corners: [Vec3; 3], object: u32) {
        self.triangles.push((corners, object));
        if self.triangles.len() == LANES {
            self.draw_triangles();
        }
    }

    fn draw_spheres(&mut self) {
        let Self { projection, buffer, spheres, .. } = self;
        self.tests += simd::dispatch(DrawSpheres { projection, spheres, buffer });
        self.spheres.clear();
    }

    fn draw_triangles(&mut self) {
        let Self { projection, buffer, triangles, .. } = self;
        let (tests, clipped) = simd::dispatch(DrawTriangles { projection, triangles, buffer });
        self.tests += tests;
        for lane in set_bits(clipped) {
            let (corners, object) = self.triangles[lane];
            self.tests += clipped::draw(&self.projection, corners, object, &mut self.buffer);
        }
        self.triangles.clear();
    }

    fn draw_plane(&mut self, plane: &Plane, object: u32) {
        let Self { projection, buffer, .. } = self;
        self.tests += simd::dispatch(DrawPlane { projection, plane, object, buffer });
    }

    /// Draws any surface but a sphere, triangle or plane, by the eye rays of the pixels in its
    /// rectangle.
    fn draw_by_eye_rays(&mut self, primitive: &Primitive<'_>, object: u32) {
        let Some(rectangle) = self.projection.of_bounds(primitive.bounds()) else { return };
        self.tests += rectangle.primitive_and_pixel_tests();
        for y in rectangle.rows() {
            for x in rectangle.columns() {
                let probe = Probe::new(self.projection.ray(x, y));
                // Crossings behind the nearest surface drawn so far at this pixel are not searched for.
                let within = Interval { max: self.buffer.t(x, y).min(f32::MAX), ..Interval::IN_FRONT };
                if let Some(t) = primitive.closest_crossing(&probe, within) {
                    self.buffer.draw([x, y], t, object);
                }
            }
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
