//! The builder of a scene in code.

use super::{Background, Checked, Draft, Object, Scene, SceneFault, ToneCurve};
use crate::camera::Camera;
use crate::checks;
use crate::color::LinearRgb;
use crate::finish::Finish;
use crate::light::Light;
use crate::material::Material;
use crate::shape::{Shape, without_coordinates, without_inside};

/// A builder of a scene, made by [`Scene::builder`].
///
/// ```
/// use termtrace::glam::Vec3;
/// use termtrace::{Camera, LinearRgb, Material, Scene, Sphere};
///
/// let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO)?;
/// let ball = Sphere::new(Vec3::ZERO, 1.0)?;
/// let scene = Scene::builder(camera).object(ball, Material::default()).ambient(LinearRgb::grey(1.0)).build()?;
/// assert_eq!(scene.objects().len(), 1);
///
/// let error = Scene::builder(camera).exposure(0.0).build().unwrap_err();
/// assert_eq!(error.to_string(), "exposure is 0: the exposure must be greater than 0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "there is no scene before `build`"]
pub struct SceneBuilder {
    objects: Vec<Object>,
    /// The values of the scene except its objects.
    ///
    /// [`build`](Self::build) checks background, ambient light and exposure, so that the other methods return no
    /// `Result`.
    rest: Checked,
}

impl SceneBuilder {
    pub(super) fn new(camera: Camera) -> Self {
        Self { objects: Vec::new(), rest: Checked::new(camera, Vec::new()) }
    }

    /// Adds an object with the given shape and material.
    pub fn object(mut self, shape: impl Into<Shape>, material: impl Into<Material>) -> Self {
        self.objects.push(Object::new(shape, material));
        self
    }

    /// Adds several objects.
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

    /// Adds a view, a camera besides the scene's own.
    #[doc(hidden)]
    pub fn view(mut self, camera: Camera) -> Self {
        self.rest.views.push(camera);
        self
    }

    /// Sets the light along rays that hit no object; black by default.
    pub fn background(self, background: impl Into<Background>) -> Self {
        Self { rest: Checked { background: background.into(), ..self.rest }, ..self }
    }

    /// Sets the ambient light; none by default.
    pub fn ambient(self, ambient: LinearRgb) -> Self {
        Self { rest: Checked { ambient, ..self.rest }, ..self }
    }

    /// Sets the exposure: the factor of all light before the tone curve; 1 by default.
    pub fn exposure(self, exposure: f32) -> Self {
        Self { rest: Checked { exposure, ..self.rest }, ..self }
    }

    /// Sets the tone curve; none by default.
    pub fn tone_curve(self, tone_curve: ToneCurve) -> Self {
        Self { rest: Checked { tone_curve, ..self.rest }, ..self }
    }

    /// Sets whether objects cast shadows; `true` by default.
    pub fn shadows(self, shadows: bool) -> Self {
        Self { rest: Checked { shadows, ..self.rest }, ..self }
    }

    /// Builds the scene and the trees over its objects.
    ///
    /// # Errors
    /// Unless each channel of the background and of the ambient light is within 0 and 1e12, and the exposure is greater
    /// than 0 and at most 1e6; or if an object has a pattern, and its shape has no surface coordinates.
    pub fn build(self) -> Result<Scene, SceneFault> {
        let Self { objects, rest } = self;
        for (at, Object { shape, material, finish, .. }) in objects.iter().enumerate() {
            if let Some(pattern) = material.material_and_pattern_names()
                && !shape.has_coordinates()
            {
                // Objects are counted from 1, as in descriptions and explanations.
                return Err(SceneFault::new(format!("object {}", at + 1), without_coordinates(pattern, shape.owner())));
            }
            if matches!(finish, Finish::Glass { .. }) && !shape.has_inside() {
                return Err(SceneFault::new(format!("object {}", at + 1), without_inside(shape.owner())));
            }
        }
        Ok(Draft::new(Checked {
            background: rest.background.checked()?,
            ambient: checks::checked_color("ambient", rest.ambient, checks::light)?,
            exposure: checks::checked_number("exposure", rest.exposure, checks::exposure)?,
            objects: objects.into(),
            ..rest
        })
        .finish())
    }
}
