//! Planes, which are intersected with all eye rays.

use super::depth_buffer::DepthBuffer;
use super::projection::Projection;
use crate::lanes::{Lanes, Vector};
use crate::shape::Plane;
use crate::simd::SimdKernel;

/// The SIMD kernel that draws a plane and returns the number of tests.
pub(super) struct DrawPlane<'b> {
    pub(super) projection: &'b Projection,
    pub(super) plane: &'b Plane,
    pub(super) object: u32,
    pub(super) buffer: &'b mut DepthBuffer,
}

impl SimdKernel for DrawPlane<'_> {
    type Output = u64;

    #[inline(always)]
    fn run<N: Lanes>(self) -> u64 {
        let Self { projection, plane, object, buffer } = self;
        let (rectangle, normal) = (projection.whole(), Vector::<N>::splat(plane.normal()));
        let above = N::splat((plane.point() - projection.eye).dot(plane.normal()));
        let object = N::splat(f32::from_bits(object));
        for y in rectangle.rows() {
            for group in rectangle.groups() {
                let t = above / projection.directions::<N>(group, y).dot(normal);
                // For a ray parallel to the plane, t is NaN or infinite, so one of the comparisons is false.
                let mask = N::splat(0.0).le(t) & t.le(N::splat(f32::MAX));
                buffer.draw_group(buffer.group(group, y), mask, t, object);
            }
        }
        rectangle.primitive_and_pixel_tests()
    }
}
