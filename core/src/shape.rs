//! Surfaces: their crossings with rays, and the surface point at a crossing.
//!
//! As in the lecture, a surface is given implicitly by f(x) = 0, and inserting the ray x = p + t d leaves one equation
//! in t. Each surface solves its equation in a file of its own under `shape/`. To add a surface, write that file, with
//! an implementation of [`Surface`], and add a line to the table `table` here. Rays are then tested against the surface
//! in a [`ScalarLeaf`]. If that is too slow, implement [`SoaLeaf`] for a leaf type of the surface's own.
//!
//! This module does not depend on materials and light.

use crate::bounds::Bounds;
use crate::color::LinearRgb;
use crate::lanes::{F32x8, LANES, Lanes, Number, Vector, set_bits};
use crate::ray::{EightRays, Interval, Probe, ProjectionCenter, Ray, Rays};
use glam::{Vec2, Vec3};
use std::sync::Arc;

pub mod capsule;
pub mod chart;
pub mod cone;
#[cfg(all(test, unit_tests))]
pub mod cube;
pub mod cuboid;
pub mod cylinder;
pub mod described;
pub mod disk;
pub mod ellipsoid;
pub mod equation;
mod exact;
pub mod implicit;
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have instances"))]
mod instance;
pub mod mesh;
mod moving;
pub mod scalar_leaf;
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have written placements"))]
mod placement;
pub mod plane;
pub mod quad;
mod scalar;
pub mod solid;
pub mod sphere;
pub mod torus;
pub mod triangle;
mod written;

pub use capsule::Capsule;
pub use chart::ChartPoint;
pub use cone::Cone;
#[cfg(all(test, unit_tests))]
pub use cube::Cube;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use described::Described;
pub use disk::Disk;
pub use ellipsoid::Ellipsoid;
pub use equation::{Equation, EquationStep};
pub use implicit::Implicit;
#[cfg(feature = "ron")]
pub(crate) use instance::CornerCells;
pub(crate) use instance::Passage;
pub use mesh::{Facet, Mesh, WrittenMesh};
pub(crate) use moving::{MovingParts, Poses};
pub use placement::{Placement, WrittenPlacement};
pub use plane::Plane;
pub use quad::Quad;
pub use scalar::Scalar;
pub use scalar_leaf::ScalarLeaf;
pub use solid::Solid;
pub use sphere::{Sphere, SphereN};
pub use torus::Torus;
pub use triangle::{EdgeFunctions, Triangle, TriangleN};
#[cfg(feature = "ron")]
pub(crate) use written::OBJECT_REFERENCE;
#[cfg(feature = "ron")]
pub(crate) use written::without_chart;
pub use written::{CheckedShape, Meshes, WrittenShape};
pub(crate) use written::{without_coordinates, without_inside};

/// A surface that rays can cross.
pub trait Surface {
    /// Returns the smallest box around the surface, or `None` if it is unbounded.
    fn bounds(&self) -> Option<Bounds>;

    /// Returns the least t in the interval at which the ray crosses the surface.
    ///
    /// That t is a root of f(origin + t direction) = 0.
    ///
    /// For a bounded surface, t is clamped to the [interval of the surface's box](Bounds::crossed). Rounding may have
    /// moved t out of that interval, and culling by boxes must not drop the hit (`culling.md`, 2).
    fn closest_crossing(&self, probe: &Probe, within: Interval) -> Option<f32>;

    /// Returns the mask of the active rays that cross the surface, and the t of each.
    ///
    /// The crossings are those of [`closest_crossing`](Self::closest_crossing).
    ///
    /// `inside` has the intervals of the surface's box.
    fn closest_crossings(&self, rays: &EightRays, _inside: &[F32x8; 2], [min, max]: &[F32x8; 2]) -> (u32, F32x8) {
        let (mut crosses, mut t) = (0, F32x8::ZERO);
        for lane in set_bits(rays.active) {
            let within = Interval { min: min.0[lane], max: max.0[lane] };
            // `Probe::new` recomputes the ray's shared values for each surface, which is simple but slow. Surfaces that
            // must be fast implement `SoaLeaf`.
            if let Some(crossing) = self.closest_crossing(&Probe::new(rays.ray(lane)), within) {
                crosses |= 1 << lane;
                t.0[lane] = crossing;
            }
        }
        (crosses, t)
    }

    /// Returns the surface point at the crossing `t` that
    /// [`closest_crossing`](Self::closest_crossing) found for `ray`.
    fn at_crossing(&self, ray: &Ray, t: f32) -> SurfacePoint;

    /// Returns the footprint of a pixel: its extent in each coordinate of [`uv`](SurfacePoint::uv).
    ///
    /// It is measured from the crossing at `t`, where `normal` returns the normal of the surface, to the crossings of
    /// the neighbouring rays, whose directions differ by `direction_steps`. Zero if the surface has no coordinates.
    // `normal` is a function, because most surfaces do not need the normal, and loading it would take 2 % of the
    // instructions of three_spheres.
    #[inline(always)]
    fn footprint<N: Number>(
        &self,
        _direction: Vector<N>,
        _t: N,
        _normal: impl Fn() -> Vector<N>,
        _direction_steps: [Vec3; 2],
    ) -> [N; 2] {
        [N::splat(0.0); 2]
    }

    /// Returns the coordinates of a picture at a point of the surface, as [`chart`] describes them.
    ///
    /// `None` if no picture can be laid on the surface.
    fn chart(&self, _point: &ChartPoint) -> Option<Vec2> {
        None
    }
}

/// Returns the [footprint](Surface::footprint) on a plane with the axes `u` and `v`.
///
/// It is computed to first order: a ray with direction d + e crosses the plane at t - t e.n / d.n.
///
/// Here d is `direction`, and e is one of `direction_steps` (Igehy, Tracing Ray Differentials, 1999).
#[inline(always)]
fn flat_footprint<N: Number>(
    direction: Vector<N>,
    t: N,
    normal: Vector<N>,
    [u, v]: [Vector<N>; 2],
    direction_steps: [Vec3; 2],
) -> [N; 2] {
    let [mut along_u, mut along_v] = [N::splat(0.0); 2];
    for step in direction_steps {
        let e = Vector::splat(step);
        let moved = (e - direction * (e.dot(normal) / direction.dot(normal))) * t;
        along_u = along_u + moved.dot(u).abs();
        along_v = along_v + moved.dot(v).abs();
    }
    [along_u, along_v]
}

/// The crossing formula of a surface, with a lane for each pair of a ray and a surface.
///
/// The pairs are one ray and one surface, eight rays and one surface, or one ray and eight surfaces.
pub trait Crossable<N: Number> {
    /// Returns the hit mask, and the t of each pair's first crossing at `min` or later.
    ///
    /// The crossings are those of [`closest_crossing`](Surface::closest_crossing); `None` only if no lane hits.
    fn first_crossing(&self, rays: &Rays<N>, min: N) -> Option<(N::Mask, N)>;

    /// Computes [`first_crossing`](Self::first_crossing), with or without crossings beyond a limit.
    ///
    /// The limit is the second number. By default, crossings beyond it are returned.
    #[inline(always)]
    fn first_crossing_with_hint(&self, rays: &Rays<N>, [min, _max_hint]: [N; 2]) -> Option<(N::Mask, N)> {
        self.first_crossing(rays, min)
    }

    /// Computes [`first_crossing_with_hint`](Self::first_crossing_with_hint) for a packet.
    ///
    /// Its rays share an error bound.
    ///
    /// The error bound is [`EdgeFunctions::packet_error_bound`], or infinity if the packet has none.
    #[inline(always)]
    fn first_crossing_in_packet(&self, rays: &Rays<N>, range: [N; 2], _packet_error_bound: N) -> Option<(N::Mask, N)> {
        self.first_crossing_with_hint(rays, range)
    }

    /// Returns the minima and maxima of the smallest boxes around the surfaces.
    fn boxes(&self) -> [Vector<N>; 2];
}

/// A surface's [`at_crossing`](Surface::at_crossing) for one ray or several.
pub trait AtCrossing<N: Number> {
    /// Returns the surface points at crossings that [`Crossable::first_crossing`] found.
    fn points_at(&self, rays: &Rays<N>, t: N) -> Points<N>;
}

/// One surface point, or eight in SoA layout: the fields that all surfaces have.
#[derive(Clone, Copy, Debug)]
pub struct Points<N: Number> {
    /// The positions, see [`SurfacePoint::position`].
    pub position: Vector<N>,
    /// The normals on the visible side, see [`SurfacePoint::geometric_normal`].
    pub geometric_normal: Vector<N>,
    /// The mask of points seen from the [front](SurfacePoint::side).
    is_front: N::Mask,
    /// The clearances, see [`SurfacePoint::clearance`].
    pub clearance: N,
    /// The coordinates on the surface, see [`SurfacePoint::uv`].
    pub uv: [N; 2],
}

impl<N: Number> Points<N> {
    /// Returns the points at `position`, with the geometric normals on the side that the rays come
    /// from.
    ///
    /// `front` is the normal on the front side, and `size` the largest coordinate from which `position` was computed.
    #[inline(always)]
    fn seen_by(rays: &Rays<N>, position: Vector<N>, front: Vector<N>, size: N, uv: [N; 2]) -> Self {
        let is_front = rays.direction.dot(front).lt(N::splat(0.0));
        let back = Vector { x: -front.x, y: -front.y, z: -front.z };
        let geometric_normal = Vector::select(is_front, front, back);
        Self { position, geometric_normal, is_front, clearance: N::splat(CLEARANCE) * size, uv }
    }

    /// Returns a placeholder for rays without a hit.
    #[inline(always)]
    pub fn nowhere() -> Self {
        let (zero, zeros) = (N::splat(0.0), Vector::splat(Vec3::ZERO));
        Self { position: zeros, geometric_normal: zeros, is_front: zero.lt(zero), clearance: zero, uv: [zero; 2] }
    }

    /// Returns the points of `yes` where the mask is set, else those of `no`.
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

impl<N: Lanes> Points<N> {
    /// Packs one point per lane into SoA layout, without the shading normals.
    ///
    /// Lanes without a point are unspecified.
    #[inline(always)]
    pub fn of_lanes(points: &[Option<SurfacePoint>; LANES]) -> Self {
        let (mut position, mut geometric_normal) = (Vector::ZERO, Vector::ZERO);
        let (mut is_front, mut clearance, mut uv) = (0, F32x8::ZERO, [F32x8::ZERO; 2]);
        for (lane, point) in points.iter().enumerate() {
            let Some(point) = point else { continue };
            position.put(lane, point.position);
            geometric_normal.put(lane, point.geometric_normal);
            is_front |= u32::from(point.side == Side::Front) << lane;
            clearance.0[lane] = point.clearance;
            (uv[0].0[lane], uv[1].0[lane]) = (point.uv.x, point.uv.y);
        }
        Self {
            position: position.load(),
            geometric_normal: geometric_normal.load(),
            is_front: N::mask_from_bits(is_front),
            clearance: N::load(&clearance),
            uv: [N::load(&uv[0]), N::load(&uv[1])],
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

/// An unbounded surface, which is in a list instead of a tree.
pub trait Endless: Surface + Copy {
    /// The type that implements the crossing formula.
    type Of<N: Lanes>: Crossable<N> + AtCrossing<N>;

    /// Returns the surface in all lanes, for tests against eight rays.
    fn splat<N: Lanes>(&self) -> Self::Of<N>;
}

/// A leaf: up to eight surfaces of one kind in SoA layout.
pub trait SoaLeaf: Clone {
    /// The type of one surface.
    type Shape: Surface + Clone + Sync;

    /// The type that implements the crossing formula, for surfaces of the leaf.
    type Of<'l, N: Lanes>: Crossable<N> + AtCrossing<N>
    where
        Self: 'l;

    /// Whether the formula needs the [shear](Rays::shear) of rays.
    const NEED_SHEAR: bool = false;

    /// Packs up to eight surfaces into a leaf.
    fn of(shapes: &[Self::Shape]) -> Self;

    /// Returns the up to eight surfaces, one per lane, for tests against one ray in all lanes.
    fn one_per_lane<N: Lanes>(&self) -> Self::Of<'_, N>;

    /// Returns the surface of `lane` in all lanes, for tests against eight rays.
    fn splat<N: Lanes>(&self, lane: usize) -> Self::Of<'_, N>;

    /// Returns in each lane the surface selected by the lowest three bits of `lanes`, as
    /// [`Lanes::gather`] does.
    fn gather<N: Lanes>(&self, lanes: N) -> Self::Of<'_, N>;

    /// Returns `yes` where the mask is set, else `no`.
    fn select<'l, N: Lanes>(mask: N::Mask, yes: Self::Of<'l, N>, no: Self::Of<'l, N>) -> Self::Of<'l, N>
    where
        Self: 'l;

    /// Whether [`edge_functions`](Self::edge_functions) may return `Some`.
    const HAVE_EDGE_FUNCTIONS: bool = false;

    /// Returns edge functions for culling groups of rays; `None` if they cost more than the exact
    /// test.
    #[inline(always)]
    fn edge_functions<N: Lanes>(&self, _: &ProjectionCenter<N>) -> Option<EdgeFunctions> {
        None
    }
}

/// A point on a surface, as seen from where the ray came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The hit point, **p** in the lecture, moved onto the surface up to the precision of f32.
    pub position: Vec3,
    /// The shading normal **n** on the side that the ray came from; interpolated on smooth meshes.
    ///
    /// Unit length.
    pub shading_normal: Vec3,
    /// The geometric normal, on the side that the ray came from. Unit length.
    pub geometric_normal: Vec3,
    /// The visible side of the surface.
    pub side: Side,
    /// The distance from the surface, along `geometric_normal`, at which a new ray may start
    /// without hitting it again.
    ///
    /// The distance is proportional to the coordinates from which the point was computed, not to the size of the scene.
    pub clearance: f32,
    /// Coordinates on the surface for patterns.
    ///
    /// In a triangle, the barycentric weights of its second and third corner; on other flat surfaces, lengths in world
    /// units; on all other surfaces, zero.
    pub uv: Vec2,
}

impl SurfacePoint {
    /// Returns the origin of a ray that leaves the surface without hitting it again.
    ///
    /// It is `position`, moved along the normal by the clearance (after Waechter and Binder, Ray Tracing Gems, chapter
    /// 6, and pbrt's `OffsetRayOrigin`). A fixed epsilon would fail in small or in large scenes.
    pub fn ray_origin(&self) -> Vec3 {
        self.position + self.geometric_normal * self.clearance
    }
}

/// A surface's two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side to which the surface's own normal points: the outside of a sphere.
    Front,
    /// The opposite side: the inside of a sphere.
    Back,
}

/// The [clearance](SurfacePoint::clearance) relative to the coordinates: 32 units of 2^-24.
///
/// A computed point is off by a few of these units, and so is the crossing of a second ray.
// The value is measured, not proved: it gives at most 10 false shadows in 100,000 at each scale (`culling.md`, 15).
const CLEARANCE: f32 = 32.0 / 16_777_216.0;

/// Passes the table of all surfaces, in two parts, to the macro `$through`, with the name `$with`.
///
/// A line of `own` is for a surface with a list or tree of its own. Its parts are: `list` for unbounded surfaces or
/// `tree` for all others; the name of the accelerator's field; the surface's type; the type of a leaf, or of an entry
/// of the list; the attribute of the enum variants, which is their documentation.
///
/// A line of `shared` is for a bounded surface that is in the tree of all such surfaces, whose leaves are
/// [`ScalarLeaf`]s: the type, and the attribute of its variants.
// These surfaces share one tree. With a tree for each kind, every ray would have to pass an empty tree for each kind
// that the scene does not use.
macro_rules! table {
    ($through:ident $with:ident) => {
        $through! {
            $with
            own {
                tree spheres: Sphere as $crate::shape::SphereN<$crate::lanes::F32x8>,
                    doc = "All points at one distance from a centre.";
                list planes: Plane as $crate::shape::Plane,
                    doc = "All points whose difference from a given point is perpendicular to the normal.";
                tree triangles: Triangle as $crate::shape::TriangleN<$crate::lanes::F32x8>,
                    doc = "The part of a plane between three points.";
            }
            // The surfaces in `shared` are hidden from the documentation, as their Rust interface may still change.
            shared {
                Cuboid, doc(hidden);
                Disk, doc(hidden);
                Quad, doc(hidden);
                Cylinder, doc(hidden);
                Cone, doc(hidden);
                Capsule, doc(hidden);
                Ellipsoid, doc(hidden);
                Torus, doc(hidden);
                Solid, doc(hidden);
                Implicit, doc(hidden);
                #[cfg(all(test, unit_tests))]
                Cube, doc(hidden);
            }
        }
    };
}

/// Passes all surfaces of the table to a macro: each one's type and the attribute of its variants.
macro_rules! surfaces {
    ($with:ident) => {
        $crate::shape::table! { surfaces $with }
    };
    ($with:ident
        own {$($(#[$on:meta])* $group:ident $name:ident: $surface:ident as $kept:ty, $of:meta;)*}
        shared {$($(#[$also_on:meta])* $shared:ident, $also_of:meta;)*}
    ) => {
        $with! { $($(#[$on])* $surface, $of;)* $($(#[$also_on])* $shared, $also_of;)* }
    };
}

/// Passes the table of all surfaces to a macro, in its two parts `own` and `shared`.
macro_rules! surfaces_in_parts {
    ($with:ident) => {
        $crate::shape::table! { surfaces_in_parts $with }
    };
    ($with:ident $($parts:tt)*) => {
        $with! { $($parts)* }
    };
}

pub(crate) use {surfaces, surfaces_in_parts, table};

/// Defines [`Shape`] and [`Primitive`] from the table of surfaces.
macro_rules! shapes {
    ($($(#[$on:meta])* $surface:ident, $of:meta;)*) => {
        /// Any of the surfaces, or a mesh.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Shape {
            $(#[$of] $(#[$on])* $surface($surface),)*
            /// A mesh of triangles.
            Mesh(Arc<Mesh>),
        }

        impl Shape {
            /// Returns the number of primitives: the triangles of a mesh, one for other shapes.
            #[doc(hidden)]
            pub fn primitive_count(&self) -> u32 {
                match self {
                    Self::Mesh(mesh) => mesh.triangle_count(),
                    _ => 1,
                }
            }

            /// Returns a primitive by its index.
            ///
            /// # Panics
            /// If a mesh has no such triangle.
            #[doc(hidden)]
            #[inline]
            pub fn primitive(&self, index: u32) -> Primitive<'_> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => Primitive::$surface(surface),)*
                    Self::Mesh(mesh) => Primitive::Facet(mesh.facet(index)),
                }
            }

            /// Returns a pixel's [footprint](Surface::footprint) on the surface; zero for a mesh.
            #[doc(hidden)]
            #[inline(always)]
            pub fn footprint<N: Number>(
                &self,
                direction: Vector<N>,
                t: N,
                normal: impl Fn() -> Vector<N>,
                direction_steps: [Vec3; 2],
            ) -> [N; 2] {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.footprint(direction, t, normal, direction_steps),)*
                    Self::Mesh(_) => [N::splat(0.0); 2],
                }
            }
        }

        $($(#[$on])* impl From<$surface> for Shape {
            fn from(surface: $surface) -> Self {
                Self::$surface(surface)
            }
        })*

        /// A primitive, which rays are tested against: a surface, or a triangle of a mesh.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Primitive<'s> {
            $(#[$of] $(#[$on])* $surface(&'s $surface),)*
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

            fn chart(&self, point: &ChartPoint) -> Option<Vec2> {
                match self {
                    $($(#[$on])* Self::$surface(surface) => surface.chart(point),)*
                    Self::Facet(facet) => facet.chart(point),
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

impl Shape {
    /// Returns whether the shape or its colours depend on the time.
    pub(crate) fn moves(&self) -> bool {
        match self {
            Self::Implicit(implicit) => implicit.moves(),
            Self::Solid(solid) => solid.moves(),
            Self::Mesh(mesh) => mesh.moves(),
            _ => false,
        }
    }

    /// Returns the shape at the time of the poses.
    pub(crate) fn at_time(&self, poses: &mut Poses) -> Self {
        match self {
            Self::Implicit(implicit) => Self::Implicit(implicit.at_time(poses.seconds)),
            Self::Solid(solid) => Self::Solid(solid.at_time(poses.seconds)),
            Self::Mesh(mesh) if mesh.moves() => mesh.at_time(poses).into(),
            other => other.clone(),
        }
    }
}

impl Primitive<'_> {
    /// Returns the shape's own diffuse reflectance: a mesh file's colours at
    /// [`uv`](SurfacePoint::uv), or an implicit surface's colour formulas at `position`.
    ///
    /// `None` if the shape has no colours of its own.
    pub fn own_reflectance(&self, position: Vec3, uv: Vec2) -> Option<LinearRgb> {
        match self {
            Self::Facet(facet) => facet.file_reflectance(uv),
            Self::Implicit(implicit) => implicit.own_reflectance(position),
            _ => None,
        }
    }
}
