//! The scene: checked values, and the trees over its primitives, in which rays are traced.
//!
//! A [`Scene`] is always valid. Its units are world units, radians, linear light and unit vectors. Except in tests and
//! benchmarks, scenes are made only by [`Scene::load`], [`Scene::from_ron`], [`Scene::of_mesh`] and
//! [`Scene::builder`]. A [`Draft`] is checked but has no trees yet.

mod builder;
#[cfg(feature = "ron")]
mod caption;
#[cfg(feature = "ron")]
mod checked;
mod draft;
#[cfg(feature = "ron")]
mod load;
mod object;
mod of_mesh;
#[cfg(feature = "ron")]
mod side_files;
mod staging;
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
pub use object::{Object, OwnPoint};
pub use of_mesh::MeshOrigin;
#[cfg(feature = "ron")]
pub use written_view::{count_views, with_view};

use crate::accel::Accelerator;
use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::checks;
pub use crate::checks::SceneFault;
use crate::color::LinearRgb;
use crate::finish::Finish;
use crate::fog::Fog;
use crate::light::Light;
use crate::shape::{Poses, Shape};
use std::collections::HashSet;
use std::fmt;
use std::sync::Arc;

/// A scene: everything that a picture depends on besides its size, and the trees for tracing rays.
///
/// The checked values and the trees are built once, never change, and are shared by clones. A scene with other lights
/// or another camera shares the trees.
///
/// ```
/// use termtrace::Scene;
///
/// let scene = Scene::from_ron("x.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))")?;
/// assert_eq!(scene.camera().pose().eye.z, 5.0);
/// assert!(scene.objects().is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Scene {
    checked: Arc<Checked>,
    accelerator: Arc<Accelerator>,
}

/// Shows the checked values, without the trees.
impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Destructured, so that a new field cannot be forgotten here.
        let Checked {
            caption,
            mesh,
            camera,
            views,
            view_names,
            background,
            ambient,
            lights,
            shadows,
            exposure,
            tone_curve,
            bounces,
            fog,
            lecture: _,
            objects,
            needs,
        } = &*self.checked;
        let mut scene = f.debug_struct("Scene");
        scene.field("caption", caption).field("mesh", mesh).field("camera", camera).field("views", views);
        if !view_names.is_empty() {
            scene.field("view_names", view_names);
        }
        // A colour takes one line even with `{:#?}`, because a line per channel would make the output hard to read.
        scene.field("background", &format_args!("{background:?}")).field("ambient", &format_args!("{ambient:?}"));
        scene.field("lights", lights).field("shadows", shadows);
        scene.field("exposure", exposure).field("tone_curve", tone_curve);
        if needs.bounces {
            scene.field("bounces", bounces);
        }
        if let Some(fog) = fog {
            scene.field("fog", fog);
        }
        scene.field("objects", objects);
        scene.finish_non_exhaustive()
    }
}

/// The checked values of a scene.
///
/// Only [`Scene::at_time`] and the `with_` methods of [`Scene`] and [`Draft`] assign its fields.
///
/// Scenes share it by an `Arc`, because a renderer on another thread keeps its scene while the viewer changes lights
/// and camera.
#[derive(Clone, Debug, PartialEq)]
struct Checked {
    /// The caption, in an `Arc` to share it with the panel that shows it.
    caption: Option<Arc<str>>,
    /// The mesh file around which the scene was made; `None` for a scene read from a scene file.
    mesh: Option<MeshOrigin>,
    camera: Camera,
    views: Vec<Camera>,
    /// The names of the views of a mesh file; empty for a scene file, whose views have none.
    view_names: Vec<String>,
    background: Background,
    ambient: LinearRgb,
    lights: Vec<Light>,
    shadows: bool,
    exposure: f32,
    tone_curve: ToneCurve,
    /// The most reflections and refractions of a ray.
    bounces: u32,
    fog: Option<Fog>,
    /// Whether surfaces only reflect diffusely and are opaque, whatever the files of meshes say.
    lecture: bool,
    /// The objects, in an `Arc` so that a scene with other lights does not copy a million of them.
    objects: Arc<[Object]>,
    /// The steps of shading that the objects need.
    needs: ShadingNeeds,
}

/// The steps of shading that the objects of a scene need besides diffuse reflection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each stands for a step of its own")]
struct ShadingNeeds {
    /// Whether an object is not [matte](Object::is_matte), so that rays bounce.
    bounces: bool,
    /// Whether an object lets light through to other objects, by its opacity.
    transparency: bool,
    /// Whether an object has highlights.
    highlights: bool,
    /// Whether an object has holes that its picture or its mesh's file makes.
    holes: bool,
    /// Whether an object sends out light by the file of its mesh.
    emission: bool,
}

impl ShadingNeeds {
    fn of(objects: &[Object]) -> Self {
        Self {
            bounces: !objects.iter().all(Object::is_matte),
            transparency: !objects.iter().all(Object::is_opaque),
            highlights: objects.iter().any(|object| matches!(object.finish, Finish::Shiny { .. })),
            holes: objects.iter().any(Object::has_holes),
            emission: objects.iter().any(Object::has_emission),
        }
    }
}

impl Checked {
    /// The default of [`Scene::bounces`].
    // Six show a ball through a glass ball in a mirror: two surfaces of each way through glass, and the mirror.
    const DEFAULT_BOUNCES: u32 = 6;

    /// Returns the checked values with this camera and these objects; all others are the defaults
    /// of [`Scene::builder`].
    fn new(camera: Camera, objects: Vec<Object>) -> Self {
        Self {
            caption: None,
            mesh: None,
            camera,
            views: Vec::new(),
            view_names: Vec::new(),
            background: Background::Color(LinearRgb::BLACK),
            ambient: LinearRgb::BLACK,
            lights: Vec::new(),
            shadows: true,
            exposure: 1.0,
            tone_curve: ToneCurve::None,
            bounces: Self::DEFAULT_BOUNCES,
            fog: None,
            lecture: false,
            objects: objects.into(),
            needs: ShadingNeeds::default(),
        }
    }

    /// Returns the values without what the lecture's model of light does not have.
    fn in_lecture(mut self) -> Self {
        (self.fog, self.lecture) = (None, true);
        self.lights.iter_mut().for_each(|light| *light = light.as_in_lecture());
        let plain = |object: &Object| Object { finish: Finish::Matte, opacity: 1.0, ..object.clone() };
        if !self.objects.iter().all(Object::is_matte) {
            self.objects = self.objects.iter().map(plain).collect();
        }
        self
    }

    fn shapes(&self) -> impl Iterator<Item = &Shape> {
        self.objects.iter().map(|object| &object.shape)
    }
}

impl Scene {
    /// Returns a builder of a scene that is seen by `camera`.
    ///
    /// It starts with no objects and no lights, a black background, shadows, exposure 1 and no tone curve.
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

    /// Returns a scene with the given camera and objects; all else is as in
    /// [`builder`](Self::builder).
    ///
    /// Does not check that each material is allowed for its shape.
    #[doc(hidden)]
    pub fn new(camera: Camera, objects: Vec<Object>) -> Self {
        Draft::new(Checked::new(camera, objects)).finish()
    }

    /// Returns the caption: what the scene shows, one paragraph a line.
    ///
    /// It is the field `caption` of the scene file, or else the comment that the file begins with.
    #[doc(hidden)]
    pub fn caption(&self) -> Option<&Arc<str>> {
        self.checked.caption.as_ref()
    }

    /// Returns the mesh file around which the scene was made; `None` for a scene with its own file.
    #[doc(hidden)]
    pub fn mesh(&self) -> Option<MeshOrigin> {
        self.checked.mesh
    }

    /// Returns a warning if there are no lights and no ambient light; black ones count as none.
    ///
    /// Returns `None` for a scene without objects whose background is not black.
    #[doc(hidden)]
    pub fn darkness_warning(&self) -> Option<&'static str> {
        let Checked { ambient, lights, objects, background, .. } = &*self.checked;
        let is_black = *background == Background::Color(LinearRgb::BLACK);
        let is_unlit = *ambient == LinearRgb::BLACK && lights.iter().all(|light| light.color() == LinearRgb::BLACK);
        match (is_unlit, is_black) {
            (true, true) => Some("no lights and no ambient light: the picture is black"),
            (true, false) if !objects.is_empty() => Some("no lights and no ambient light: every object is black"),
            _ => None,
        }
    }

    /// Returns a warning for each mesh with triangles that have no area.
    #[doc(hidden)]
    pub fn flat_mesh_warnings(&self) -> Vec<String> {
        let mut shared = HashSet::new();
        let warning = |(at, object): (usize, &Object)| {
            let Shape::Mesh(mesh) = &object.shape else { return None };
            // Of the instances that share a mesh file, only the first is examined.
            if mesh.is_instance() && !shared.insert(Arc::as_ptr(mesh.shared_file())) {
                return None;
            }
            let (flat, all) = (mesh.file().flat_triangle_count(), mesh.file().triangles().len());
            let have = if flat == 1 { "has" } else { "have" };
            (flat > 0).then(|| format!("object {at}: {flat} of its {all} triangles {have} no area"))
        };
        (1..).zip(self.objects()).filter_map(warning).collect()
    }

    /// Returns a warning for each formula that certainly has no surface within its bounds.
    #[doc(hidden)]
    pub fn invisible_formula_warnings(&self) -> Vec<String> {
        let warning = |(at, object): (usize, &Object)| match &object.shape {
            Shape::Implicit(implicit) => {
                implicit.invisibility_warning().map(|warning| format!("object {at}: {warning}"))
            }
            _ => None,
        };
        (1..).zip(self.objects()).filter_map(warning).collect()
    }

    /// Returns whether any surface or its colours depend on the time.
    #[doc(hidden)]
    pub fn depends_on_time(&self) -> bool {
        self.accelerator.depends_on_time()
    }

    /// Returns the length in seconds of the longest animation of a mesh; `None` if no mesh moves.
    #[doc(hidden)]
    pub fn animation_length(&self) -> Option<f64> {
        let length = |object: &Object| match &object.shape {
            Shape::Mesh(mesh) => mesh.motion_length(),
            _ => None,
        };
        self.objects().iter().filter_map(length).reduce(f64::max)
    }

    /// Returns the scene at a time in seconds; a scene that is loaded or built is at time 0.
    #[doc(hidden)]
    pub fn at_time(mut self, seconds: f64) -> Self {
        if !self.depends_on_time() {
            return self;
        }
        let mut poses = Poses::at(seconds);
        let at_time = |object: &Object| Object { shape: object.shape.at_time(&mut poses), ..object.clone() };
        let objects: Arc<[Object]> = self.checked.objects.iter().map(at_time).collect();
        self.accelerator = Arc::new(self.accelerator.at_time(seconds, |object| &objects[object as usize].shape));
        self.with(|checked| checked.objects = objects)
    }

    /// Returns the scene's own camera.
    pub fn camera(&self) -> &Camera {
        &self.checked.camera
    }

    /// Returns further views of the scene, in the order of the scene file.
    pub fn views(&self) -> &[Camera] {
        &self.checked.views
    }

    /// Returns the names of the views of a mesh file, some of them empty; none for a scene file.
    #[doc(hidden)]
    pub fn view_names(&self) -> &[String] {
        &self.checked.view_names
    }

    /// Returns the light along rays that hit no object.
    #[doc(hidden)]
    pub fn background(&self) -> Background {
        self.checked.background
    }

    /// Returns the ambient light, which arrives at every point equally from all directions.
    #[doc(hidden)]
    pub fn ambient(&self) -> LinearRgb {
        self.checked.ambient
    }

    /// Returns the lights, in the order of the scene file.
    pub fn lights(&self) -> &[Light] {
        &self.checked.lights
    }

    /// Returns whether objects cast shadows. The lecture's first version has none.
    #[doc(hidden)]
    pub fn shadows(&self) -> bool {
        self.checked.shadows
    }

    /// Returns the exposure: the factor of all light before the tone curve, greater than 0.
    #[doc(hidden)]
    pub fn exposure(&self) -> f32 {
        self.checked.exposure
    }

    /// Returns the tone curve.
    #[doc(hidden)]
    pub fn tone_curve(&self) -> ToneCurve {
        self.checked.tone_curve
    }

    /// Returns the most reflections and refractions of a ray by mirrors and glass.
    #[doc(hidden)]
    pub fn bounces(&self) -> u32 {
        self.checked.bounces
    }

    /// Returns the fog, if there is any.
    #[doc(hidden)]
    pub fn fog(&self) -> Option<Fog> {
        self.checked.fog
    }

    /// Returns whether every object is matte, so that no ray bounces.
    pub(crate) fn is_all_matte(&self) -> bool {
        !self.checked.needs.bounces
    }

    /// Returns whether an object lets a part of the light through.
    pub(crate) fn has_transparent(&self) -> bool {
        self.checked.needs.transparency
    }

    /// Returns whether an object has highlights.
    pub(crate) fn has_highlights(&self) -> bool {
        self.checked.needs.highlights
    }

    /// Returns whether an object has holes, which rays pass.
    pub(crate) fn has_holes(&self) -> bool {
        self.checked.needs.holes
    }

    /// Returns whether an object sends out light by the file of its mesh.
    pub(crate) fn has_emission(&self) -> bool {
        self.checked.needs.emission
    }

    /// Returns whether the light of a sample depends on its number in the pixel, and not only on
    /// its ray.
    pub(crate) fn is_sampled(&self) -> bool {
        self.checked.lights.iter().any(Light::has_size) || self.checked.needs.bounces
    }

    /// Returns the objects, in the order of the scene file.
    pub fn objects(&self) -> &[Object] {
        &self.checked.objects
    }

    /// Returns the smallest box around all bounded objects; `None` if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        self.accelerator.finite_bounds()
    }

    /// Returns the size of the trees over the primitives of all objects, in bytes.
    #[doc(hidden)]
    pub fn tree_bytes(&self) -> usize {
        self.accelerator.bytes()
    }

    /// Returns the acceleration structure.
    pub(crate) fn accelerator(&self) -> &Accelerator {
        &self.accelerator
    }

    /// Returns the scene with another camera.
    #[doc(hidden)]
    pub fn with_camera(self, camera: Camera) -> Self {
        self.with(|checked| checked.camera = camera)
    }

    /// Returns the scene with other [views](Self::views).
    #[doc(hidden)]
    pub fn with_views(self, views: Vec<Camera>) -> Self {
        self.with(|checked| checked.views = views)
    }

    /// Returns the scene with another [background](Self::background).
    ///
    /// # Errors
    /// Unless each channel of its light is within 0 and 1e12.
    #[doc(hidden)]
    pub fn with_background(self, background: impl Into<Background>) -> Result<Self, SceneFault> {
        let background = background.into().checked()?;
        Ok(self.with(|checked| checked.background = background))
    }

    /// Returns the scene with another [ambient light](Self::ambient).
    ///
    /// # Errors
    /// Unless each channel is within 0 and 1e12.
    #[doc(hidden)]
    pub fn with_ambient(self, ambient: LinearRgb) -> Result<Self, SceneFault> {
        let ambient = checks::checked_color("ambient", ambient, checks::light)?;
        Ok(self.with(|checked| checked.ambient = ambient))
    }

    /// Returns the scene without ambient light.
    pub(crate) fn without_ambient(self) -> Self {
        self.with(|checked| checked.ambient = LinearRgb::BLACK)
    }

    /// Returns the scene with other [lights](Self::lights).
    #[doc(hidden)]
    pub fn with_lights(self, lights: impl IntoIterator<Item: Into<Light>>) -> Self {
        self.with(|checked| checked.lights = lights.into_iter().map(Into::into).collect())
    }

    /// Returns the scene with or without [shadows](Self::shadows).
    #[doc(hidden)]
    pub fn with_shadows(self, shadows: bool) -> Self {
        self.with(|checked| checked.shadows = shadows)
    }

    /// Returns the scene with another [exposure](Self::exposure).
    ///
    /// # Errors
    /// Unless it is greater than 0 and at most 1e6.
    #[doc(hidden)]
    pub fn with_exposure(self, exposure: f32) -> Result<Self, SceneFault> {
        let exposure = checks::checked_number("exposure", exposure, checks::exposure)?;
        Ok(self.with(|checked| checked.exposure = exposure))
    }

    /// Returns the scene with another [tone curve](Self::tone_curve).
    #[doc(hidden)]
    pub fn with_tone_curve(self, tone_curve: ToneCurve) -> Self {
        self.with(|checked| checked.tone_curve = tone_curve)
    }

    /// Returns the scene with or without [fog](Self::fog).
    #[doc(hidden)]
    pub fn with_fog(self, fog: Option<Fog>) -> Self {
        self.with(|checked| checked.fog = fog)
    }

    /// Returns whether both scenes are clones of the same scene, and neither was changed since.
    #[doc(hidden)]
    pub fn is_copy_of(&self, other: &Self) -> bool {
        // Compares pointers, because comparing the values of a million objects would take longer than drawing a frame.
        Arc::ptr_eq(&self.checked, &other.checked) && Arc::ptr_eq(&self.accelerator, &other.accelerator)
    }

    /// Returns the scene with changed values; its clones do not change.
    fn with(mut self, change: impl FnOnce(&mut Checked)) -> Self {
        // Copies the values only if a clone shares them.
        change(Arc::make_mut(&mut self.checked));
        self
    }
}

/// The light along rays that hit no object.
///
/// ```
/// use termtrace::glam::Vec3;
/// use termtrace::{Background, Camera, LinearRgb, Scene};
///
/// let sky = Background::Gradient { bottom: LinearRgb::grey(0.8), top: "#87a6cc".parse()? };
/// let scene = Scene::builder(Camera::look_at(Vec3::Z, Vec3::ZERO)?).background(sky).build()?;
/// # let _ = scene;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Background {
    /// The same light from every direction.
    Color(LinearRgb),
    /// A gradient from `bottom`, straight down, to `top`, straight up, linear in the direction's y.
    Gradient {
        /// The light when looking along -y.
        bottom: LinearRgb,
        /// The light when looking along +y.
        top: LinearRgb,
    },
}

impl Background {
    /// Returns the background if each channel of its light is within range.
    fn checked(self) -> Result<Self, SceneFault> {
        match self {
            Self::Color(color) => checks::checked_color("background", color, checks::light).map(Self::Color),
            Self::Gradient { bottom, top } => {
                let bottom = checks::checked_color("bottom", bottom, checks::light)?;
                Ok(Self::Gradient { bottom, top: checks::checked_color("top", top, checks::light)? })
            }
        }
    }
}

impl From<LinearRgb> for Background {
    fn from(color: LinearRgb) -> Self {
        Self::Color(color)
    }
}

/// A mapping of light that is brighter than white into the range of the screen.
///
/// ```
/// use termtrace::glam::Vec3;
/// use termtrace::{Camera, Scene, ToneCurve};
///
/// let camera = Camera::look_at(Vec3::new(0.0, 1.0, 5.0), Vec3::ZERO)?;
/// let scene = Scene::builder(camera).exposure(2.0).tone_curve(ToneCurve::Filmic).build()?;
/// # let _ = scene;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ToneCurve {
    /// No curve: light brighter than white is clipped.
    #[default]
    None,
    /// Reinhard's curve x / (1 + x), applied to the luminance; it never reaches white.
    Reinhard,
    /// A film-like curve with shoulder and toe, per channel (Narkowicz's fit to ACES).
    Filmic,
}
