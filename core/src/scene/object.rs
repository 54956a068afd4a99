//! Objects: surfaces and what they look like.

use super::SceneFault;
use crate::checks;
use crate::color::LinearRgb;
use crate::finish::Finish;
use crate::material::{Image, Material};
use crate::mesh_file::MeshMaterial;
use crate::shape::{ChartPoint, Mesh, Shape, Surface, SurfacePoint};
use glam::{Vec2, Vec3};
use std::fmt;
use std::sync::Arc;

/// A surface and its material.
///
/// ```
/// use termtrace::Scene;
///
/// let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
/// let scene = Scene::from_ron("ball.ron", text)?;
/// assert!(scene.objects().iter().all(|object| object.material == termtrace::Material::default()));
/// # Ok::<(), termtrace::SceneError>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Object {
    /// The surface of the object.
    pub shape: Shape,
    /// The material of the object.
    pub material: Material,
    /// The finish of the object: mirrors, glass and the like.
    #[doc(hidden)]
    pub finish: Finish,
    /// The part of the light that does not pass straight through the surface, from 0 to 1.
    #[doc(hidden)]
    pub opacity: f32,
    /// The picture on the surface, if its material is [`Material::Own`].
    #[doc(hidden)]
    pub image: Option<Arc<Image>>,
}

/// Shows the finish unless it is matte, as most are, the opacity unless it is 1, and the picture if
/// there is one.
impl fmt::Debug for Object {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shape, material, finish, opacity, image } = self;
        let mut object = f.debug_struct("Object");
        object.field("shape", shape).field("material", material);
        if !finish.is_matte() {
            object.field("finish", finish);
        }
        if *opacity < 1.0 {
            object.field("opacity", opacity);
        }
        if let Some(image) = image {
            object.field("image", image);
        }
        object.finish()
    }
}

impl Object {
    /// Returns an object with the given shape and material.
    #[doc(hidden)]
    pub fn new(shape: impl Into<Shape>, material: impl Into<Material>) -> Self {
        Self { shape: shape.into(), material: material.into(), finish: Finish::Matte, opacity: 1.0, image: None }
    }

    /// Returns the object with another finish.
    #[doc(hidden)]
    pub fn with_finish(self, finish: Finish) -> Self {
        Self { finish, ..self }
    }

    /// Returns the object with another opacity.
    ///
    /// # Errors
    /// If the opacity is not within 0 and 1.
    #[doc(hidden)]
    pub fn with_opacity(self, opacity: f32) -> Result<Self, SceneFault> {
        Ok(Self { opacity: checks::checked_number("opacity", opacity, checks::opacity)?, ..self })
    }

    /// Returns the reflectance of [`Material::Own`] at a point of a primitive: that of the picture,
    /// or the [shape's own](crate::shape::Primitive::own_reflectance).
    ///
    /// `None` if there is neither.
    #[doc(hidden)]
    pub fn own_reflectance(&self, primitive: u32, point: &OwnPoint) -> Option<LinearRgb> {
        let surface = self.shape.primitive(primitive);
        match &self.image {
            Some(image) => Some(image.reflectance(surface.chart(&point.on_chart(image))?)),
            None => surface.own_reflectance(point.position, point.uv),
        }
    }

    /// Returns whether the surface may have holes.
    pub(crate) fn has_holes(&self) -> bool {
        match &self.image {
            Some(image) => image.has_holes(),
            None => self.mesh_in_own_colors().is_some_and(|mesh| mesh.file().has_holes()),
        }
    }

    /// Returns whether the surface has a hole at a point of a primitive.
    pub(crate) fn has_hole(&self, primitive: u32, point: &OwnPoint) -> bool {
        match &self.image {
            Some(image) => {
                self.shape.primitive(primitive).chart(&point.on_chart(image)).is_some_and(|at| image.has_hole(at))
            }
            None => self.in_mesh_material(primitive, point, MeshMaterial::has_hole).unwrap_or(false),
        }
    }

    /// Returns whether the file of the mesh makes the surface transparent.
    pub(crate) fn is_blended(&self) -> bool {
        self.mesh_in_own_colors().is_some_and(|mesh| mesh.file().is_blended())
    }

    /// Returns the part of the light that does not pass straight through the surface at a point.
    pub(crate) fn opacity_at(&self, primitive: u32, point: &OwnPoint) -> f32 {
        if !self.is_blended() {
            return self.opacity;
        }
        self.opacity * self.in_mesh_material(primitive, point, MeshMaterial::opacity).unwrap_or(1.0)
    }

    /// Returns whether the surface sends out light by the file of its mesh.
    pub(crate) fn has_emission(&self) -> bool {
        self.mesh_in_own_colors().is_some_and(|mesh| mesh.file().has_emission())
    }

    /// Returns the light that the surface sends out at a point by the file of its mesh.
    pub(crate) fn emission_at(&self, primitive: u32, point: &OwnPoint) -> LinearRgb {
        self.in_mesh_material(primitive, point, MeshMaterial::emitted).unwrap_or(LinearRgb::BLACK)
    }

    /// Returns the mesh, if its colours are those of its file.
    fn mesh_in_own_colors(&self) -> Option<&Mesh> {
        match (&self.shape, self.material, &self.image) {
            (Shape::Mesh(mesh), Material::Own, None) => Some(mesh),
            _ => None,
        }
    }

    /// Returns a value of the material of a triangle at a point, by the texture coordinates there.
    fn in_mesh_material<T>(
        &self,
        triangle: u32,
        point: &OwnPoint,
        value: fn(&MeshMaterial, Option<Vec2>) -> T,
    ) -> Option<T> {
        let facet = self.mesh_in_own_colors()?.facet(triangle);
        Some(value(facet.file_material()?, facet.texture_coordinates(point.uv)))
    }

    /// Returns whether the surface is opaque and only reflects diffusely, so that it needs no step
    /// but the lecture's.
    pub(crate) fn is_matte(&self) -> bool {
        self.finish.is_matte() && self.is_opaque()
    }

    /// Returns whether no light passes straight through the surface.
    pub(crate) fn is_opaque(&self) -> bool {
        self.opacity == 1.0 && !self.is_blended()
    }
}

/// A point whose colours are those of [`Material::Own`].
#[derive(Clone, Copy, Debug)]
pub struct OwnPoint {
    /// The position, see [`SurfacePoint::position`].
    pub position: Vec3,
    /// The geometric normal, see [`SurfacePoint::geometric_normal`].
    pub normal: Vec3,
    /// The coordinates on the surface, see [`SurfacePoint::uv`].
    pub uv: Vec2,
}

impl OwnPoint {
    fn on_chart(&self, image: &Image) -> ChartPoint {
        let &Self { position, normal, uv } = self;
        ChartPoint { position, normal, uv, turn: image.turn() }
    }
}

impl From<&SurfacePoint> for OwnPoint {
    fn from(point: &SurfacePoint) -> Self {
        Self { position: point.position, normal: point.geometric_normal, uv: point.uv }
    }
}
