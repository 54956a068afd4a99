//! The projection of points to pixels, and rectangles of pixels.

use crate::bounds::Bounds;
use crate::camera::{Basis, Camera, EyeRays};
use crate::framebuffer::Resolution;
use crate::lanes::{F32x8, LANES, Lanes, Number, Vector};
use crate::ray::Ray;
use glam::{BVec3, DVec2, DVec3, Vec3};
use std::array::from_fn;
use std::ops::Range;

/// The projection of points to the pixels of a picture.
pub(super) struct Projection {
    pub(super) eye: Vec3,
    /// u, v and -w of the view rectangle.
    basis: [Vec3; 3],
    /// The pixels per unit, to the right and down, on the picture's plane at distance 1 from the
    /// eye.
    pub(super) scale: DVec2,
    /// The principal point in pixels: the foot of the perpendicular from the eye to the picture's
    /// plane.
    pub(super) principal_point: DVec2,
    pub(super) size: [u32; 2],
    rays: EyeRays,
}

/// A rectangle of pixels: half-open ranges of columns and rows.
#[derive(Clone, Copy)]
pub(super) struct Rectangle {
    pub(super) x: [u32; 2],
    pub(super) y: [u32; 2],
}

impl Rectangle {
    pub(super) fn columns(self) -> Range<u32> {
        self.x[0]..self.x[1]
    }

    pub(super) fn rows(self) -> Range<u32> {
        self.y[0]..self.y[1]
    }

    /// Returns the groups of eight pixels that a row of the rectangle touches.
    #[inline(always)]
    pub(super) fn groups(self) -> Range<u32> {
        self.x[0] / LANES as u32..self.x[1].div_ceil(LANES as u32)
    }

    /// Returns the number of tests of a primitive with this rectangle: one plus the number of
    /// pixels.
    #[inline(always)]
    pub(super) fn primitive_and_pixel_tests(self) -> u64 {
        let [columns, rows] = [self.x, self.y].map(|[first, end]| u64::from(end.saturating_sub(first)));
        1 + columns * rows
    }
}

impl Projection {
    pub(super) fn new(camera: &Camera, resolution: Resolution) -> Self {
        let Basis { u, v, w } = camera.rectangle_basis();
        let aspect_ratio = resolution.aspect_ratio();
        let (width, height, middle) = camera.rectangle().width_height_middle(aspect_ratio);
        let size = [resolution.width(), resolution.height()];
        let [columns, rows] = size.map(f64::from);
        // v points up, but rows are counted downwards.
        let scale = DVec2::new(columns / f64::from(width), -rows / f64::from(height));
        let principal_point = 0.5 * DVec2::new(columns, rows) - middle.as_dvec2() * scale;
        Self {
            eye: camera.pose().eye,
            basis: [u, v, -w],
            scale,
            principal_point,
            size,
            rays: camera.eye_rays(aspect_ratio),
        }
    }

    /// Returns the ray through the middle of a pixel.
    pub(super) fn ray(&self, x: u32, y: u32) -> Ray {
        let [width, height] = self.size.map(|size| size as f32);
        self.rays.through((x as f32 + 0.5) / width, (height - (y as f32 + 0.5)) / height)
    }

    /// Returns the directions of the rays through the middles of a group of pixels.
    #[inline(always)]
    pub(super) fn directions<N: Lanes>(&self, group: u32, y: u32) -> Vector<N> {
        let [width, height] = self.size.map(|size| size as f32);
        let qv = (height - (y as f32 + 0.5)) / height;
        self.rays.direction(middles::<N>(group) / N::splat(width), N::splat(qv))
    }

    /// Returns points in camera space: their coordinates along u and v, and their depths.
    #[inline(always)]
    pub(super) fn in_camera_space<N: Number>(&self, points: Vector<N>) -> Vector<N> {
        let away = points - Vector::splat(self.eye);
        let [x, y, z] = self.basis.map(|axis| Vector::splat(axis).dot(away));
        Vector { x, y, z }
    }

    /// Returns a point in camera space, computed in f64.
    pub(super) fn in_camera_space_f64(&self, point: Vec3) -> DVec3 {
        let away = point.as_dvec3() - self.eye.as_dvec3();
        DVec3::from(self.basis.map(|axis| axis.as_dvec3().dot(away)))
    }

    /// Returns the position in pixels, from the upper left, of a point in front of the eye.
    pub(super) fn project(&self, from_eye: DVec3) -> DVec2 {
        from_eye.truncate() / from_eye.z * self.scale + self.principal_point
    }

    /// Returns the rectangle of all pixels of the picture.
    pub(super) fn whole(&self) -> Rectangle {
        let [width, height] = self.size;
        Rectangle { x: [0, width], y: [0, height] }
    }

    /// Returns the rectangle of the pixels whose centres lie between `min` and `max`, in pixels.
    pub(super) fn rectangle(&self, min: DVec2, max: DVec2) -> Rectangle {
        let range = |min: f64, max: f64, size: u32| {
            let last = f64::from(size);
            [(min - 0.5).ceil().clamp(0.0, last) as u32, ((max - 0.5).floor() + 1.0).clamp(0.0, last) as u32]
        };
        Rectangle { x: range(min.x, max.x, self.size[0]), y: range(min.y, max.y, self.size[1]) }
    }

    /// Returns, for each lane, the half-open range of columns or rows whose centres lie from `min`
    /// to `max`.
    #[inline(always)]
    pub(super) fn pixel_range<N: Lanes>(min: N, max: N, size: u32) -> [N; 2] {
        let (zero, half, last) = (N::splat(0.0), N::splat(0.5), N::splat(size as f32));
        // `Lanes` has no `ceil`, so it is computed as `-floor(-x)`.
        let first = -(half - min).floor();
        let end = (max + half).floor();
        [first, end].map(|edge| edge.max(zero).min(last))
    }

    /// Returns the pixels that a surface with these bounds may cover; `None` if it is behind the
    /// eye.
    pub(super) fn of_bounds(&self, bounds: Option<Bounds>) -> Option<Rectangle> {
        let Some(bounds) = bounds else { return Some(self.whole()) };
        let corners: [DVec3; 8] = from_fn(|corner| {
            let is_max = |axis: u32| corner >> axis & 1 == 1;
            let mask = BVec3::new(is_max(0), is_max(1), is_max(2));
            self.in_camera_space_f64(Vec3::select(mask, bounds.max, bounds.min))
        });
        if corners.iter().all(|corner| corner.z <= 0.0) {
            return None;
        }
        // The projection of a box that reaches behind the eye is unbounded.
        if corners.iter().any(|corner| corner.z <= 0.0) {
            return Some(self.whole());
        }
        let places = corners.map(|corner| self.project(corner));
        let (min, max) = places.iter().fold((places[0], places[0]), |(min, max), at| (min.min(*at), max.max(*at)));
        // Widened by a pixel on each side, because the directions of rays are rounded.
        Some(self.rectangle(min - 1.0, max + 1.0))
    }
}

/// Returns the x coordinates, in pixels, of the centres of a group of eight pixels.
#[inline(always)]
pub(super) fn middles<N: Lanes>(group: u32) -> N {
    const FIRST: F32x8 = F32x8([0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5]);
    N::splat((group * LANES as u32) as f32) + N::load(&FIRST)
}
