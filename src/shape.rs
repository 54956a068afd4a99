//! Surfaces: where a ray crosses them, and what they are like at that point.
//!
//! The lecture's way: a surface is given implicitly by f(x) = 0, and putting the ray's x = p + t d into it leaves one
//! equation in t. Each surface solves its own in a file of its own under `shape/`. To add one, write that file, with an
//! implementation of [`Surface`], and give it a line in the table `surfaces` here. It is then tested [`ScalarLeaf`]; where
//! that is too slow, a type that is [`SoaLeaf`] takes the place of that.
//!
//! This module knows nothing of materials and light.

use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::lanes::{Lanes, Number, Vector};
use crate::ray::{CommonOrigin, Interval, Probe, Ray, Rays};
use glam::{Vec2, Vec3};
use std::sync::Arc;

#[cfg(test)]
pub mod cube;
pub mod described;
pub mod equation;
pub mod mesh;
pub mod scalar_leaf;
pub mod plane;
pub mod sphere;
pub mod triangle;
mod written;

#[cfg(test)]
pub use cube::Cube;
pub use described::Described;
pub use equation::{Equation, Step};
pub use mesh::{Facet, Mesh};
pub use plane::Plane;
pub use scalar_leaf::ScalarLeaf;
pub use sphere::{Sphere, SphereN};
pub use triangle::{EdgeFunctions, Triangle, TriangleN};
pub(crate) use written::without_coordinates;
pub use written::{CheckedShape, Meshes, WrittenShape};

/// What every surface can answer.
pub trait Surface {
    /// The smallest box around it; nothing where it has no end.
    fn bounds(&self) -> Option<Bounds>;

    /// The least t inside the interval at which the ray crosses the surface: a root of f(origin + t direction) = 0.
    ///
    /// A surface with bounds is only met [inside them](Bounds::crossed): however rounding has moved a crossing, it is not
    /// before the box or behind it, so that leaving out what a box cannot contain leaves out nothing.
    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32>;

    /// The surface at the crossing `t` that [`closest_crossing`](Self::closest_crossing) found for this ray.
    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint;

    /// How far [`uv`](SurfacePoint::uv) reaches in a pixel: from the crossing at `t` of a ray in that direction to those of
    /// its neighbours, whose directions differ by these steps. Zero where the surface has no coordinates.
    #[inline(always)]
    fn footprint<N: Number>(&self, _direction: Vector<N>, _t: N, _steps: [Vec3; 2]) -> [N; 2] {
        [N::splat(0.0); 2]
    }
}

/// A surface's formula for one ray and one of its kind, for several rays, or for several of its kind: a number stands for
/// each pair.
pub trait Crossable<N: Number> {
    /// Of each pair, the first crossing from `min` on and whether there is one, as
    /// [`closest_crossing`](Surface::closest_crossing) has it; nothing where there is none at all.
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)>;

    /// The same of rays of a pencil, with what is known of all of them ([`EdgeFunctions::packet_error_bound`]); infinite: nothing.
    #[inline(always)]
    fn first_crossing_with_bound(&self, rays: &Rays<N>, min: N, _error_bound: N) -> Option<(N::Mask, N)> {
        self.first_crossing(rays, min)
    }

    /// The smallest boxes around them: from where to where.
    fn boxes(&self) -> [Vector<N>; 2];
}

/// A surface's [`at_crossing`](Surface::at_crossing) for one ray or several.
pub trait AtCrossing<N: Number> {
    /// The surfaces at crossings that were found.
    fn points_at(&self, rays: &Rays<N>, t: N) -> Points<N>;
}

/// The surfaces at crossings, a number for each: what [`SurfacePoint`] has of all surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Points<N: Number> {
    /// [`SurfacePoint::position`].
    pub position: Vector<N>,
    /// [`SurfacePoint::geometric_normal`].
    pub geometric_normal: Vector<N>,
    /// [`SurfacePoint::side`]: whether the front is seen.
    is_front: N::Mask,
    /// [`SurfacePoint::clearance`].
    pub clearance: N,
    /// [`SurfacePoint::uv`].
    pub uv: [N; 2],
}

impl<N: Number> Points<N> {
    /// At `position`, where the front has this normal.
    #[inline(always)]
    fn seen_by(rays: &Rays<N>, position: Vector<N>, front: Vector<N>, size: N, uv: [N; 2]) -> Self {
        let is_front = rays.direction.dot(front).lt(N::splat(0.0));
        let back = Vector { x: -front.x, y: -front.y, z: -front.z };
        let geometric_normal = Vector::select(is_front, front, back);
        Self { position, geometric_normal, is_front, clearance: N::splat(CLEARANCE) * size, uv }
    }

    /// Where nothing is.
    #[inline(always)]
    pub fn nowhere() -> Self {
        let (zero, zeros) = (N::splat(0.0), Vector::splat(Vec3::ZERO));
        Self { position: zeros, geometric_normal: zeros, is_front: zero.lt(zero), clearance: zero, uv: [zero; 2] }
    }

    /// `yes` where the answer was yes, else `no`.
    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let of_two = |yes: N, no: N| N::select(mask, yes, no);
        Self {
            position: Vector::select(mask, yes.position, no.position),
            geometric_normal: Vector::select(mask, yes.geometric_normal, no.geometric_normal),
            is_front: mask & yes.is_front | !mask & no.is_front,
            clearance: of_two(yes.clearance, no.clearance),
            uv: [of_two(yes.uv[0], no.uv[0]), of_two(yes.uv[1], no.uv[1])],
        }
    }
}

impl Points<f32> {
    fn point(self) -> SurfacePoint {
        let geometric_normal = self.geometric_normal.into();
        SurfacePoint {
            position: self.position.into(),
            shading_normal: geometric_normal,
            geometric_normal,
            side: if self.is_front { Side::Front } else { Side::Back },
            clearance: self.clearance,
            uv: self.uv.into(),
        }
    }
}

/// A surface without an end: it stands in no tree.
pub trait Endless: Surface + Copy {
    /// What has its formula.
    type Of<N: Lanes>: Crossable<N> + AtCrossing<N>;

    /// The same in every place, for several rays.
    fn splat<N: Lanes>(&self) -> Self::Of<N>;
}

/// Eight surfaces of one kind, side by side in memory.
pub trait SoaLeaf: Copy {
    /// One of them.
    type Shape: Surface + Copy + Sync;

    /// What has their formula.
    type Of<N: Lanes>: Crossable<N> + AtCrossing<N>;

    /// Whether their formula asks for the [shear](Rays::shear) of rays.
    const NEED_SHEAR: bool = false;

    /// Of eight or fewer.
    fn of(shapes: &[Self::Shape]) -> Self;

    /// All of them, for one ray that is the same in every place.
    fn load<N: Lanes>(&self) -> Self::Of<N>;

    /// One of them, the same in every place, for several rays.
    fn splat<N: Lanes>(&self, lane: usize) -> Self::Of<N>;

    /// One of them in each place, for several rays, as [`Lanes::gather`] has it.
    fn gather<N: Lanes>(&self, lanes: N) -> Self::Of<N>;

    /// `yes` where the answer was yes, else `no`.
    fn select<N: Lanes>(mask: N::Mask, yes: Self::Of<N>, no: Self::Of<N>) -> Self::Of<N>;

    /// Whether they have [`edge_functions`](Self::edge_functions).
    const HAVE_EDGE_FUNCTIONS: bool = false;

    /// What tells beforehand that rays pass by one of them, where that takes less than the test itself.
    #[inline(always)]
    fn edge_functions<N: Lanes>(&self, _: &CommonOrigin<N>) -> Option<EdgeFunctions> {
        None
    }
}

/// A point on a surface, as seen from where the ray came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The lecture's **p**, moved onto the surface as exactly as f32 can say.
    pub position: Vec3,
    /// The normal **n** on the side that the ray came from. Unit length.
    pub shading_normal: Vec3,
    /// The same of the surface as it is, where `normal` is that of a smooth one that it stands for. Unit length.
    pub geometric_normal: Vec3,
    /// Which side of the surface is seen.
    pub side: Side,
    /// How far, along `geometric_normal`, the true surface may lie from `position`, and as far again as a ray that starts
    /// there needs to be clear of it. In proportion to the coordinates involved; no constant of the scene's size.
    pub clearance: f32,
    /// Coordinates on the surface for a pattern: on a plane in world units, in a triangle the shares of its second and
    /// third corner; zero where the surface has none.
    pub uv: Vec2,
}

impl SurfacePoint {
    /// Where a ray that leaves the surface starts: off it by the clearance, so that the surface does not shadow
    /// itself (after Waechter and Binder, Ray Tracing Gems, chapter 6, and pbrt's `OffsetRayOrigin`: the hit's error
    /// box is left behind, whatever the scale; a fixed epsilon fails in small and in large scenes).
    pub fn ray_origin(&self) -> Vec3 {
        self.position + self.geometric_normal * self.clearance
    }
}

/// A surface's two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side that the surface's own normal points to: the outside of a sphere.
    Front,
    /// The other one: the inside of a sphere.
    Back,
}

/// The relative clearance. The coordinates of a point are off by a few units of 2^-24, and so is what a second ray
/// computes from them; 32 of these units are clear of both (the property tests count false shadows at all scales).
const CLEARANCE: f32 = 32.0 / 16_777_216.0;

/// Hands the table of all surfaces to a macro, one line each: whether they stand in a `tree` or, as they have no end, in a
/// `list`; what the accelerator calls that; the type; what is kept of eight of them, or of one without an end; what they are.
macro_rules! surfaces {
    ($with:ident) => {
        $with! {
            tree spheres: Sphere as $crate::shape::SphereN<$crate::lanes::F32x8>, "All points at one distance from a centre.";
            list planes: Plane as $crate::shape::Plane, "All points whose difference to a given one is perpendicular to the normal.";
            tree triangles: Triangle as $crate::shape::TriangleN<$crate::lanes::F32x8>, "What lies between three points.";
            #[cfg(test)]
            tree cubes: Cube as $crate::shape::ScalarLeaf<$crate::shape::Cube>, "All points at one distance from a centre, along the axis along which they are farthest.";
        }
    };
}

pub(crate) use surfaces;

/// Makes [`Shape`] and [`Primitive`] from the table of surfaces.
macro_rules! shapes {
    ($($(#[$on:meta])* $group:ident $name:ident: $surface:ident as $kept:ty, $of:literal;)*) => {
        /// Any of the surfaces, or a mesh.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Shape {
            $(#[doc = $of] $(#[$on])* $surface($surface),)*
            /// Many triangles.
            Mesh(Arc<Mesh>),
        }

        impl Shape {
            /// How many parts it has, each of which is a surface: one, but for meshes.
            #[doc(hidden)]
            pub fn primitive_count(&self) -> u32 {
                match self {
                    Self::Mesh(mesh) => mesh.triangle_count(),
                    _ => 1,
                }
            }

            /// One of its parts.
            ///
            /// # Panics
            /// If a mesh has fewer.
            #[doc(hidden)]
            #[inline]
            pub fn primitive(&self, index: u32) -> Primitive<'_> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => Primitive::$surface(surface),)*
                    Self::Mesh(mesh) => Primitive::Facet(mesh.facet(index)),
                }
            }

            /// [`Surface::footprint`]; that of a mesh is zero.
            #[doc(hidden)]
            #[inline(always)]
            pub fn footprint<N: Number>(&self, direction: Vector<N>, t: N, steps: [Vec3; 2]) -> [N; 2] {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.footprint(direction, t, steps),)*
                    Self::Mesh(_) => [N::splat(0.0); 2],
                }
            }
        }

        $($(#[$on])* impl From<$surface> for Shape {
            fn from(surface: $surface) -> Self {
                Self::$surface(surface)
            }
        })*

        /// What a ray is tested against: a surface, or a triangle of a mesh. It hands every question on.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Primitive<'s> {
            $(#[doc = $of] $(#[$on])* $surface(&'s $surface),)*
            /// A triangle of a mesh.
            Facet(Facet<'s>),
        }

        impl Surface for Primitive<'_> {
            fn bounds(&self) -> Option<Bounds> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.bounds(),)*
                    Self::Facet(facet) => facet.bounds(),
                }
            }

            #[inline]
            fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.closest_crossing(probe, within),)*
                    Self::Facet(facet) => facet.closest_crossing(probe, within),
                }
            }

            fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.at_crossing(ray, t),)*
                    Self::Facet(facet) => facet.at_crossing(ray, t),
                }
            }
        }
    };
}

surfaces! { shapes }

impl From<Mesh> for Shape {
    fn from(mesh: Mesh) -> Self {
        Self::Mesh(Arc::new(mesh))
    }
}

impl Primitive<'_> {
    /// The diffuse reflectance that the surface brings itself where it has these [coordinates](SurfacePoint::uv): that of
    /// a mesh whose file has colours.
    pub fn own_reflectance(&self, uv: Vec2) -> Option<LinearRgb> {
        match self {
            Self::Facet(facet) => facet.reflectance(uv),
            _ => None,
        }
    }
}
