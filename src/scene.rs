//! What is drawn, checked, with the trees over it: a [`Scene`] cannot be wrong, and rays can be sent into it.
//!
//! All units are fixed here: world units, radians, linear light, unit vectors. [`Scene::load`] and [`Scene::from_ron`]
//! are the only way from what was written to what is drawn. A [`Draft`] is checked and has no trees yet.

mod builder;
#[cfg(feature = "ron")]
mod checked;
mod draft;
#[cfg(feature = "ron")]
mod load;
mod of_mesh;
#[cfg(feature = "mesh")]
mod sketch;
#[cfg(feature = "ron")]
mod written_camera;
#[cfg(feature = "ron")]
mod written_view;

pub use builder::SceneBuilder;
pub use draft::Draft;
#[cfg(feature = "ron")]
pub use load::LoadError;
#[cfg(feature = "ron")]
pub use written_view::with_view;

use crate::accel::Accelerator;
use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::checks;
pub use crate::checks::SceneFault;
use crate::color::LinearRgb;
use crate::light::Light;
use crate::material::Material;
use crate::shape::Shape;
use std::fmt;
use std::sync::Arc;

/// Everything that a picture depends on, besides its size: what was checked, and the trees that rays go through.
///
/// Both are built once and never change; copies share them. A scene with other lights, or another camera, shares the trees.
///
/// ```
/// use termtrace::Scene;
///
/// let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")?;
/// let brighter = scene.clone().with_exposure(2.0)?;
/// assert_eq!((scene.exposure(), brighter.exposure()), (1.0, 2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Scene {
    checked: Arc<Checked>,
    accelerator: Arc<Accelerator>,
}

/// What was checked, without the trees over it.
impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Checked { camera, views, background, ambient, lights, shadows, exposure, tone_curve, objects } =
            &*self.checked;
        let mut scene = f.debug_struct("Scene");
        scene.field("camera", camera).field("views", views);
        // Each colour in one line.
        scene.field("background", &format_args!("{background:?}")).field("ambient", &format_args!("{ambient:?}"));
        scene.field("lights", lights).field("shadows", shadows);
        scene.field("exposure", exposure).field("tone_curve", tone_curve).field("objects", objects);
        scene.finish_non_exhaustive()
    }
}

/// What was checked. Its fields are assigned by the `with_` methods of [`Scene`] and [`Draft`] only.
#[derive(Clone, Debug, PartialEq)]
struct Checked {
    camera: Camera,
    views: Vec<Camera>,
    background: Background,
    ambient: LinearRgb,
    lights: Vec<Light>,
    shadows: bool,
    exposure: f32,
    tone_curve: ToneCurve,
    /// Shared, so that a copy with other lights costs little.
    objects: Arc<[Object]>,
}

impl Checked {
    /// These objects seen by that camera, as [`Scene::new`] has them.
    fn new(camera: Camera, objects: Vec<Object>) -> Self {
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
        }
    }

    fn shapes(&self) -> impl Iterator<Item = &Shape> {
        self.objects.iter().map(|object| &object.shape)
    }
}

impl Scene {
    /// Returns a scene in the making, seen by that camera: no objects and no lights yet, a black background, shadows,
    /// exposure 1 and no tone curve.
    ///
    /// ```
    /// use glam::Vec3;
    /// use termtrace::{Camera, LinearRgb, Material, Plane, PointLight, Scene, Sphere};
    ///
    /// let camera = Camera::look_at(Vec3::new(0.0, 1.5, 6.0), Vec3::new(0.0, 0.7, 0.0))?;
    /// let red = Material::diffuse(LinearRgb::new(0.8, 0.1, 0.1))?;
    /// let scene = Scene::builder(camera)
    ///     .object(Sphere::new(Vec3::Y, 1.0)?, red)
    ///     .object(Plane::new(Vec3::ZERO, Vec3::Y)?, Material::default())
    ///     .light(PointLight::new(Vec3::new(3.0, 5.0, 4.0), LinearRgb::grey(45.0))?)
    ///     .ambient(LinearRgb::grey(0.05))
    ///     .build()?;
    /// assert_eq!(scene.objects().len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn builder(camera: Camera) -> SceneBuilder {
        SceneBuilder::new(camera)
    }

    /// [`builder`](Self::builder) with these objects, which are not checked for materials that their shapes cannot have.
    #[doc(hidden)]
    pub fn new(camera: Camera, objects: Vec<Object>) -> Self {
        Draft::new(Checked::new(camera, objects)).finish()
    }

    /// Returns where the scene wants to be looked at from.
    pub fn camera(&self) -> &Camera {
        &self.checked.camera
    }

    /// Returns other views of the scene that are worth a look, in the order of the scene file.
    pub fn views(&self) -> &[Camera] {
        &self.checked.views
    }

    /// Returns the light that comes along rays that meet no object.
    #[doc(hidden)]
    pub fn background(&self) -> Background {
        self.checked.background
    }

    /// Returns the light that arrives at every point from everywhere alike, besides that of the lights.
    #[doc(hidden)]
    pub fn ambient(&self) -> LinearRgb {
        self.checked.ambient
    }

    /// Returns the lights, in the order of the scene file.
    pub fn lights(&self) -> &[Light] {
        &self.checked.lights
    }

    /// Returns whether objects keep light from each other; without, this is the lecture's bare version.
    #[doc(hidden)]
    pub fn shadows(&self) -> bool {
        self.checked.shadows
    }

    /// Returns what all light is multiplied by before it is shown; greater than 0.
    pub fn exposure(&self) -> f32 {
        self.checked.exposure
    }

    /// Returns how light beyond the screen's range is brought into it.
    #[doc(hidden)]
    pub fn tone_curve(&self) -> ToneCurve {
        self.checked.tone_curve
    }

    /// Returns the objects, in the order of the scene file.
    pub fn objects(&self) -> &[Object] {
        &self.checked.objects
    }

    /// Returns the smallest box around all objects that have an end; nothing if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        self.accelerator.bounds()
    }

    /// Returns how much memory the trees over the parts of all objects take, in bytes.
    #[doc(hidden)]
    pub fn tree_bytes(&self) -> usize {
        self.accelerator.bytes()
    }

    /// Returns what the scene's rays are tested against.
    pub(crate) fn accelerator(&self) -> &Accelerator {
        &self.accelerator
    }

    /// Returns the scene looked at from somewhere else.
    pub fn with_camera(self, camera: Camera) -> Self {
        self.with(|checked| checked.camera = camera)
    }

    /// Returns the scene with other [views](Self::views).
    #[doc(hidden)]
    pub fn with_views(self, views: Vec<Camera>) -> Self {
        self.with(|checked| checked.views = views)
    }

    /// Returns the scene before another [background](Self::background).
    ///
    /// # Errors
    /// Unless each band of its light lies within 0 and 1e12.
    #[doc(hidden)]
    pub fn with_background(self, background: impl Into<Background>) -> Result<Self, SceneFault> {
        let background = background.into().checked()?;
        Ok(self.with(|checked| checked.background = background))
    }

    /// Returns the scene in other [ambient light](Self::ambient).
    ///
    /// # Errors
    /// Unless each band lies within 0 and 1e12.
    #[doc(hidden)]
    pub fn with_ambient(self, ambient: LinearRgb) -> Result<Self, SceneFault> {
        let ambient = checks::given_color("ambient", ambient, checks::light)?;
        Ok(self.with(|checked| checked.ambient = ambient))
    }

    /// Returns the scene under other [lights](Self::lights).
    pub fn with_lights(self, lights: impl IntoIterator<Item: Into<Light>>) -> Self {
        self.with(|checked| checked.lights = lights.into_iter().map(Into::into).collect())
    }

    /// Returns the scene with or without [shadows](Self::shadows).
    #[doc(hidden)]
    pub fn with_shadows(self, shadows: bool) -> Self {
        self.with(|checked| checked.shadows = shadows)
    }

    /// Returns the scene at another [exposure](Self::exposure).
    ///
    /// # Errors
    /// Unless it is greater than 0 and at most 1e6.
    pub fn with_exposure(self, exposure: f32) -> Result<Self, SceneFault> {
        let exposure = checks::given("exposure", exposure, checks::exposure)?;
        Ok(self.with(|checked| checked.exposure = exposure))
    }

    /// Returns the scene with another [tone curve](Self::tone_curve).
    #[doc(hidden)]
    pub fn with_tone_curve(self, tone_curve: ToneCurve) -> Self {
        self.with(|checked| checked.tone_curve = tone_curve)
    }

    /// Returns whether both are copies of one scene, which nothing has changed since.
    #[cfg(feature = "live")]
    pub(crate) fn is_copy_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.checked, &other.checked) && Arc::ptr_eq(&self.accelerator, &other.accelerator)
    }

    fn with(mut self, change: impl FnOnce(&mut Checked)) -> Self {
        change(Arc::make_mut(&mut self.checked));
        self
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
    #[doc(hidden)]
    pub fn new(shape: impl Into<Shape>, material: impl Into<Material>) -> Self {
        Self { shape: shape.into(), material: material.into() }
    }
}

/// The light that arrives along rays that meet no object.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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

impl Background {
    /// Returns the background, if its light is some that can be.
    fn checked(self) -> Result<Self, SceneFault> {
        match self {
            Self::Color(color) => checks::given_color("background", color, checks::light).map(Self::Color),
            Self::Gradient { bottom, top } => {
                let bottom = checks::given_color("bottom", bottom, checks::light)?;
                Ok(Self::Gradient { bottom, top: checks::given_color("top", top, checks::light)? })
            }
        }
    }
}

impl From<LinearRgb> for Background {
    fn from(color: LinearRgb) -> Self {
        Self::Color(color)
    }
}

/// How light is fitted to the screen's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ToneCurve {
    /// As it is; what is brighter than white is white.
    #[default]
    None,
    /// Reinhard's: x / (1 + x), of the luminance; never quite white.
    Reinhard,
    /// A film's shoulder and toe, band by band (Narkowicz's fit to ACES).
    Filmic,
}
