//! What is drawn, checked: a [`Scene`] cannot be wrong.
//!
//! All units are fixed here: world units, radians, linear light, unit vectors. [`Scene::load`] and [`Scene::from_ron`]
//! are the only way from what was written to what is drawn.

mod checked;
mod draft;
mod load;
mod of_mesh;
mod parts;
mod written_camera;
mod written_view;

pub use draft::Draft;
pub use load::LoadError;
pub use written_view::with_view;

use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::light::PointLight;
use crate::material::Material;
use crate::shape::Shape;
pub(crate) use parts::{Grove, PartId, PartIds, Parts};
use std::sync::Arc;

/// Everything that a picture depends on, besides its size. A copy costs little, however large it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Where the scene wants to be looked at from.
    pub camera: Camera,
    /// Other views of it that are worth a look, in the order of the scene file.
    pub views: Vec<Camera>,
    /// The light that comes from where nothing is.
    pub background: Background,
    /// Light that arrives at every point from everywhere alike, besides that of the lights.
    pub ambient: LinearRgb,
    /// The point sources.
    pub lights: Vec<PointLight>,
    /// Whether objects keep light from each other; without, this is the lecture's bare version.
    pub shadows: bool,
    /// What all light is multiplied by before it is shown; greater than 0.
    pub exposure: f32,
    /// How light beyond the screen's range is brought into it.
    pub tone_curve: ToneCurve,
    // Shared by copies, so that one with other lights costs little.
    objects: Arc<[Object]>,
    parts: Arc<Parts>,
}

impl Scene {
    /// These objects seen by that camera: no light and no other views yet, a black background, shadows, exposure 1 and no tone curve.
    pub fn new(camera: Camera, objects: Vec<Object>) -> Self {
        Draft::new(Self::unbuilt(camera, objects)).finish()
    }

    /// The same without its parts.
    fn unbuilt(camera: Camera, objects: Vec<Object>) -> Self {
        Self {
            camera,
            views: Vec::new(),
            background: Background::Color(LinearRgb::BLACK),
            ambient: LinearRgb::BLACK,
            lights: Vec::new(),
            shadows: true,
            exposure: 1.0,
            tone_curve: ToneCurve::None,
            objects: objects.into(),
            parts: Arc::default(),
        }
    }

    /// The objects, in the order of the scene file.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The smallest box around all objects that have an end; nothing if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        self.parts.bounds
    }

    /// How much memory the tree over the parts of all objects takes, in bytes.
    pub fn tree_bytes(&self) -> usize {
        self.parts.bytes()
    }

    /// The parts of all objects, in a tree.
    pub(crate) fn parts(&self) -> &Parts {
        &self.parts
    }
}

/// A surface and what it is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// The surface.
    pub shape: Shape,
    /// Its reflectance.
    pub material: Material,
}

impl Object {
    /// That surface of that material.
    pub fn new(shape: impl Into<Shape>, material: Material) -> Self {
        Self { shape: shape.into(), material }
    }
}

/// The light that arrives along rays that meet no object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// The same from everywhere.
    Color(LinearRgb),
    /// From `bottom`, straight down, to `top`, straight up, linear in the direction's y.
    Gradient {
        /// What is seen when looking along -y.
        bottom: LinearRgb,
        /// What is seen when looking along +y.
        top: LinearRgb,
    },
}

/// How light is fitted to the screen's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// As it is; what is brighter than white is white.
    #[default]
    None,
    /// Reinhard's: x / (1 + x), of the luminance; never quite white.
    Reinhard,
    /// A film's shoulder and toe, band by band (Narkowicz's fit to ACES).
    Filmic,
}
