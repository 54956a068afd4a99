//! The bodies that solids are made of.

use super::Solid;
use super::closed_mesh::ClosedMesh;
use crate::bounds::Bounds;
use crate::checks;
use crate::ray::Ray;
use crate::shape::{Placement, Shape, Surface, SurfacePoint};
use glam::Vec3;

/// A closed shape, a half space, another solid, or what a formula or a mesh encloses.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Body {
    Shape(Shape),
    Mesh(ClosedMesh),
}

impl Body {
    /// Returns a shape as a part of a solid; `None` if it encloses nothing.
    ///
    /// A formula encloses all points at which it is negative; another part has to cap it.
    pub(super) fn of_shape(shape: Shape) -> Option<Self> {
        let is_closed = match &shape {
            Shape::Cylinder(cylinder) => !cylinder.is_open(),
            Shape::Cone(cone) => !cone.is_open(),
            Shape::Plane(_)
            | Shape::Sphere(_)
            | Shape::Cuboid(_)
            | Shape::Capsule(_)
            | Shape::Ellipsoid(_)
            | Shape::Torus(_)
            | Shape::Solid(_)
            | Shape::Implicit(_) => true,
            _ => false,
        };
        is_closed.then_some(Self::Shape(shape))
    }

    /// Returns the number of shapes that it is made of.
    pub(super) fn shape_count(&self) -> usize {
        match self {
            Self::Shape(Shape::Solid(solid)) => solid.shape_count(),
            _ => 1,
        }
    }

    /// Returns a box around it; `None` for half spaces.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Shape(shape) => shape.bounds(),
            Self::Mesh(mesh) => Some(mesh.bounds()),
        }
    }

    /// Returns it scaled, rotated and moved; `None` if a number exceeds the range of f32.
    pub(super) fn placed(&self, placement: &Placement) -> Option<Self> {
        match self {
            Self::Shape(shape) => shape.clone().placed_anywhere(placement).map(Self::Shape),
            Self::Mesh(mesh) => Some(Self::Mesh(mesh.placed(placement))),
        }
    }

    /// Returns it as it is at a time in seconds.
    pub(super) fn at_time(&self, seconds: f64) -> Self {
        match self {
            Self::Shape(Shape::Implicit(implicit)) => Self::Shape(implicit.at_time(seconds).into()),
            Self::Shape(Shape::Solid(solid)) => Self::Shape(solid.at_time(seconds).into()),
            other => other.clone(),
        }
    }

    /// Returns whether it depends on the time.
    pub(super) fn moves(&self) -> bool {
        matches!(self, Self::Shape(shape) if shape.moves())
    }

    /// Returns whether a point is inside.
    pub(super) fn encloses(&self, point: Vec3) -> bool {
        match self {
            Self::Shape(Shape::Plane(plane)) => {
                (point.as_dvec3() - plane.point().as_dvec3()).dot(plane.normal().as_dvec3()) < 0.0
            }
            Self::Shape(shape) => shape.encloses(point),
            Self::Mesh(mesh) => mesh.encloses(point),
        }
    }

    /// Returns the point of a boundary: on this triangle of a mesh, or on the shape.
    pub(super) fn at_crossing(&self, triangle: u32, ray: &Ray, t: f32) -> SurfacePoint {
        match self {
            Self::Shape(shape) => shape.primitive(0).at_crossing(ray, t),
            Self::Mesh(mesh) => mesh.at_crossing(triangle, ray, t),
        }
    }

    /// Returns whether it lies where rays can be traced to it, and is large enough for them.
    pub(super) fn is_within_reach(&self) -> bool {
        let is_near =
            |Bounds { min, max }: Bounds| checks::are_within_range(&[min, max]) && checks::is_long_enough(max - min);
        match self {
            Self::Shape(Shape::Plane(plane)) => checks::are_within_range(&[plane.point()]),
            body => body.bounds().is_none_or(is_near),
        }
    }

    /// Returns whether it has interpolated normals.
    pub(super) fn is_smooth(&self) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.is_smooth(),
            Self::Shape(Shape::Solid(solid)) => solid.is_smooth(),
            Self::Shape(_) => false,
        }
    }

    /// Returns whether any shape is a formula.
    pub(super) fn has_formulas(&self) -> bool {
        match self {
            Self::Shape(Shape::Implicit(_)) => true,
            Self::Shape(Shape::Solid(solid)) => solid.has_formulas,
            _ => false,
        }
    }

    /// Returns whether any shape is a mesh.
    pub(super) fn has_meshes(&self) -> bool {
        match self {
            Self::Mesh(_) => true,
            Self::Shape(Shape::Solid(solid)) => solid.parts.iter().any(|part| part.body.has_meshes()),
            Self::Shape(_) => false,
        }
    }
}

impl From<Solid> for Body {
    fn from(solid: Solid) -> Self {
        Self::Shape(solid.into())
    }
}
