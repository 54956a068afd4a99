//! A scene that code makes, piece by piece.

use super::{Background, Checked, Draft, Object, Scene, SceneFault, ToneCurve};
use crate::camera::Camera;
use crate::checks;
use crate::color::LinearRgb;
use crate::light::Light;
use crate::material::Material;
use crate::shape::{Shape, without_coordinates};

/// A scene in the making: see [`Scene::builder`]. What stands in it has been checked, or is by [`build`](Self::build).
#[derive(Clone, Debug)]
#[must_use = "there is no scene before `build`"]
pub struct SceneBuilder {
    objects: Vec<Object>,
    /// Without objects. Its background, its ambient light and its exposure are not checked yet.
    rest: Checked,
}

impl SceneBuilder {
    pub(super) fn new(camera: Camera) -> Self {
        Self { objects: Vec::new(), rest: Checked::new(camera, Vec::new()) }
    }

    /// Adds an object of that shape and material.
    pub fn object(mut self, shape: impl Into<Shape>, material: impl Into<Material>) -> Self {
        self.objects.push(Object::new(shape, material));
        self
    }

    /// Adds these objects.
    #[doc(hidden)]
    pub fn objects(mut self, objects: impl IntoIterator<Item = Object>) -> Self {
        self.objects.extend(objects);
        self
    }

    /// Adds a light.
    pub fn light(mut self, light: impl Into<Light>) -> Self {
        self.rest.lights.push(light.into());
        self
    }

    /// Adds a view that is worth a look, besides that of the camera.
    #[doc(hidden)]
    pub fn view(mut self, camera: Camera) -> Self {
        self.rest.views.push(camera);
        self
    }

    /// Sets the light that comes along rays that meet no object; black, if none is set.
    pub fn background(self, background: impl Into<Background>) -> Self {
        Self { rest: Checked { background: background.into(), ..self.rest }, ..self }
    }

    /// Sets the light that arrives at every point from everywhere alike; none, if none is set.
    pub fn ambient(self, ambient: LinearRgb) -> Self {
        Self { rest: Checked { ambient, ..self.rest }, ..self }
    }

    /// Sets what all light is multiplied by before it is shown; 1, if nothing is set.
    pub fn exposure(self, exposure: f32) -> Self {
        Self { rest: Checked { exposure, ..self.rest }, ..self }
    }

    /// Sets how light beyond the screen's range is brought into it; not at all, if nothing is set.
    pub fn tone_curve(self, tone_curve: ToneCurve) -> Self {
        Self { rest: Checked { tone_curve, ..self.rest }, ..self }
    }

    /// Sets whether objects keep light from each other; they do, if nothing is set.
    pub fn shadows(self, shadows: bool) -> Self {
        Self { rest: Checked { shadows, ..self.rest }, ..self }
    }

    /// Returns the scene, with the trees over its objects.
    ///
    /// # Errors
    /// Unless each band of the background and of the ambient light lies within 0 and 1e12, and the exposure is greater than
    /// 0 and at most 1e6; and if an object has a pattern and is no plane.
    pub fn build(self) -> Result<Scene, SceneFault> {
        let Self { objects, rest } = self;
        for (at, Object { shape, material }) in objects.iter().enumerate() {
            if let Some(pattern) = material.pattern()
                && !shape.has_coordinates()
            {
                return Err(SceneFault::new(format!("object {}", at + 1), without_coordinates(pattern, shape.owner())));
            }
        }
        Ok(Draft::new(Checked {
            background: rest.background.checked()?,
            ambient: checks::given_color("ambient", rest.ambient, checks::light)?,
            exposure: checks::given("exposure", rest.exposure, checks::exposure)?,
            objects: objects.into(),
            ..rest
        })
        .finish())
    }
}
