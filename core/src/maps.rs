//! Maps: pictures that show depths, normals, objects or other quantities instead of light.
//!
//! A map traces one ray through the centre of each pixel and has a fixed colour scale, which its legend gives: equal
//! values have equal colours in every picture. Only the scale of depths depends on the camera, by the distance to its
//! target. A *view*, in contrast, is a camera position, as in a scene's [`views`](Scene::views).

use crate::camera::{Camera, Pose};
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::Resolution;
use crate::hit::Hit;
use crate::progress::Cancelled;
use crate::render::{
    Cost, Executor, GBufferSample, Geometry, Sampling, TraceDepth, trace_g_buffer_partial, trace_geometry,
};
use crate::scene::Scene;
use crate::shade;
use crate::shape::Side;
use crate::text::{ParseError, named};
use crate::tone::Picture;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

mod colors;
mod contrast;
mod cost;
mod shaded;
mod wire;

/// The quantity that a picture shows: the scene's light, or its depths, normals, objects and so on.
///
/// ```
/// use std::num::NonZeroU32;
/// use termtrace::{Map, Resolution, Scene};
///
/// let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
/// let scene = Scene::from_ron("ball.ron", text)?;
/// let depths = Map::Depth.picture(&scene, scene.camera(), Resolution::new(9, 9)?, NonZeroU32::MIN);
/// // The sphere's nearest point is at depth 4, nearer than the target at 5: lighter than middle grey.
/// assert!(depths.pixels()[40].r > 128);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Map {
    /// The scene's light.
    #[default]
    Shaded,
    /// The sum of n.l (normal times light direction) over all lights that the surface faces,
    /// clamped to 1.
    ///
    /// Colours, distances and shadows have no influence.
    Lambert,
    /// The depth t along the normal of the view rectangle, as a grey of 1 / (1 + (t / d)^2).
    ///
    /// d is the distance from the eye to the target.
    Depth,
    /// The surface normal n on the visible side, as (n + 1) / 2 in red, green and blue.
    Normal,
    /// The object that is hit, as a distinct colour for each object index.
    Object,
    /// The number of lights that reach the surface, from dark grey for none to white for all.
    Shadow,
    /// The number of surfaces and tree nodes that the pixel's eye ray and shadow rays are tested
    /// against.
    ///
    /// Each ray is traced singly. Colours go from blue over green to red and white, one for each power of four.
    Cost,
    /// The visible side of the surface, front or back, darker where it is seen at a slant.
    ///
    /// Planes are left out.
    Facing,
    /// The light in black and white, with lines between objects of the same colour.
    ///
    /// This map is for people who see outlines better than colours.
    Contrast,
    /// The edges of triangles, over a grey that is darker where a surface is seen at a flat angle.
    Wire,
}

/// The colour of pixels without a hit, in all maps except `Shaded`, `Cost` and `Contrast`.
// A dark blue, which can be told from all greys of the maps and from the black of an unlit object.
const NO_HIT: Srgb8 = Srgb8::new(16, 20, 56);
/// The colour of front sides, the sides to which the normal points.
// Blue and orange-red, which people with red-green blindness can tell apart.
const FRONT: Srgb8 = Srgb8::new(70, 150, 230);
/// The colour of back sides, the sides from which the normal points away.
const BACK: Srgb8 = Srgb8::new(235, 80, 50);

/// The picture of a map, and the cost of tracing it.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedMap {
    /// The picture.
    pub picture: Picture,
    /// The surfaces that the picture shows, if they were asked for.
    pub geometry: Option<Arc<Geometry>>,
    /// The cost of tracing, which has no influence on the picture.
    pub cost: Cost,
}

impl TracedMap {
    /// Returns the traced map with this picture and cost, without [`geometry`](Self::geometry).
    pub fn new(picture: Picture, cost: Cost) -> Self {
        Self { picture, geometry: None, cost }
    }

    /// Returns the picture with the surfaces that it shows.
    pub fn with_geometry(self, geometry: impl Into<Arc<Geometry>>) -> Self {
        Self { geometry: Some(geometry.into()), ..self }
    }
}

impl Map {
    /// All maps, in the order in which keys of the live view select them.
    pub const ALL: [Self; 10] = [
        Self::Shaded,
        Self::Lambert,
        Self::Depth,
        Self::Normal,
        Self::Object,
        Self::Shadow,
        Self::Cost,
        Self::Facing,
        Self::Contrast,
        Self::Wire,
    ];

    /// Returns the picture of `scene` from `camera`, as a pure function of the arguments.
    ///
    /// The sampling applies to the shaded picture; maps have one sample per pixel, or per two by two pixels with
    /// [`Sampling::Coarse`].
    pub fn picture(
        self,
        scene: &Scene,
        camera: &Camera,
        resolution: Resolution,
        sampling: impl Into<Sampling>,
    ) -> Picture {
        picture(self, scene, camera, resolution, sampling)
    }

    /// Returns the map's name, a single word in lower case.
    #[doc(hidden)]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Lambert => "lambert",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Object => "object",
            Self::Shadow => "shadow",
            Self::Cost => "cost",
            Self::Facing => "facing",
            Self::Contrast => "contrast",
            Self::Wire => "wire",
        }
    }

    /// Returns the map with this name.
    #[doc(hidden)]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|map| map.name() == name)
    }

    /// Returns the next map; after the last, the first.
    #[doc(hidden)]
    pub fn next(self) -> Self {
        self.after(1)
    }

    /// Returns the previous map; before the first, the last.
    #[doc(hidden)]
    pub fn previous(self) -> Self {
        self.after(Self::ALL.len() - 1)
    }

    /// Returns the map `steps` positions later in [`ALL`](Self::ALL), cyclically.
    fn after(self, steps: usize) -> Self {
        let at = Self::ALL.iter().position(|&map| map == self).unwrap_or(0);
        Self::ALL[(at + steps) % Self::ALL.len()]
    }

    /// Returns whether more than one sample per pixel improves the picture.
    // In other maps the mean of the depths, normals or counts at an edge would be a value that no surface has.
    #[doc(hidden)]
    pub const fn refines(self) -> bool {
        matches!(self, Self::Shaded)
    }

    /// Returns the map's name and the meaning of its colours, in at most 38 ASCII characters.
    // 38 characters and a border on either side fit into a terminal of 40 columns.
    #[doc(hidden)]
    pub fn legend(self, scene: &Scene, camera: &Camera) -> String {
        let meaning = match self {
            Self::Shaded => return self.name().to_owned(),
            Self::Lambert => "n.l, no shadows".to_owned(),
            Self::Depth => format!("white 0, grey {}, black far", colors::length_text(target_distance(camera))),
            Self::Normal => "red x, green y, blue z".to_owned(),
            Self::Object => format!("{} colours", scene.objects().len()),
            Self::Shadow => format!("white lit by {}, dark by 0", scene.lights().len()),
            Self::Cost => "blue 1, green 16, red 256 tests".to_owned(),
            Self::Facing => "blue front, red back".to_owned(),
            Self::Contrast => "lines between objects".to_owned(),
            Self::Wire => "edges of triangles".to_owned(),
        };
        format!("{}: {meaning}", self.name())
    }
}

impl fmt::Display for Map {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Parses the name of a map.
///
/// ```
/// use termtrace::Map;
///
/// assert_eq!("depth".parse(), Ok(Map::Depth));
/// let error = "dept".parse::<Map>().unwrap_err();
/// assert_eq!(error.to_string(), "unknown map \"dept\"; did you mean \"depth\"?");
/// ```
impl FromStr for Map {
    type Err = ParseError;

    fn from_str(name: &str) -> Result<Self, ParseError> {
        named("map", name, &Self::ALL, Self::name)
    }
}

/// Returns the colour of the map `Cost` for this number of tests.
pub fn cost_color(tests: u32) -> Srgb8 {
    colors::heat(tests)
}

/// Returns the [picture](Map::picture) of a map, traced on the current rayon pool.
pub fn picture(
    map: Map,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Picture {
    trace_partial(map, Executor::Pool, scene, camera, resolution, sampling.into()).picture
}

/// Traces the picture of a map on the threads of `executor`.
///
/// # Errors
/// [`Cancelled`], if the executor's token is cancelled.
pub fn trace(
    map: Map,
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Result<TracedMap, Cancelled> {
    executor.unless_cancelled(trace_partial(map, executor, scene, camera, resolution, sampling))
}

/// Traces the picture of a map with two by four pixels per cell, and the surfaces that it shows.
///
/// # Errors
/// [`Cancelled`], if the executor's token is cancelled.
pub fn trace_with_geometry(
    map: Map,
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Result<TracedMap, Cancelled> {
    let traced = if map == Map::Shaded {
        shaded::trace_with_geometry(executor, scene, camera, resolution, sampling)
    } else {
        let (geometry, cost) = trace_geometry(executor, scene, camera, resolution, sampling);
        let mut traced = trace_partial(map, executor, scene, camera, resolution, sampling);
        traced.cost += cost;
        traced.with_geometry(geometry)
    };
    executor.unless_cancelled(traced)
}

/// Traces the picture of a map; if the executor's token is cancelled, returns an incomplete
/// picture.
fn trace_partial(
    map: Map,
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> TracedMap {
    let traced_to = |depth, paint: &(dyn Fn(&GBufferSample) -> Srgb8 + Sync)| {
        let traced = trace_g_buffer_partial(executor, scene, camera, resolution, sampling, depth, paint);
        let [width, height] = [resolution.width(), resolution.height()];
        TracedMap::new(Picture { width, height, pixels: traced.pixels }, traced.cost)
    };
    let of_surfaces = |paint: &(dyn Fn(&GBufferSample) -> Srgb8 + Sync)| traced_to(TraceDepth::Surfaces, paint);
    match map {
        Map::Shaded => shaded::trace(executor, scene, camera, resolution, sampling),
        Map::Lambert => of_surfaces(&|sample| lambert_color(scene, sample)),
        Map::Depth => {
            let middle = target_distance(camera);
            of_surfaces(&|sample| sample.hit.map_or(NO_HIT, |hit| colors::depth(hit.t, middle)))
        }
        Map::Normal => of_surfaces(&|sample| {
            sample.surface(scene).map_or(NO_HIT, |surface| colors::normal(surface.shading_normal))
        }),
        Map::Object => of_surfaces(&|sample| sample.hit.map_or(NO_HIT, |hit| colors::object(hit.object))),
        Map::Shadow => traced_to(TraceDepth::Lights, &|sample| match sample.hit {
            // The mask `lit_by` has 32 bits, which further lights share with the first 32.
            Some(_) => colors::share_grey(sample.lit_by.count_ones(), scene.lights().len().min(32) as u32),
            None => NO_HIT,
        }),
        Map::Cost => of_surfaces(&|sample| colors::heat(cost::eye_and_shadow_tests(scene, sample))),
        Map::Facing => of_surfaces(&|sample| facing_color(scene, sample)),
        Map::Wire => of_surfaces(&|sample| wire::color(scene, camera, resolution, sample).unwrap_or(NO_HIT)),
        Map::Contrast => contrast::trace(executor, scene, camera, resolution, sampling),
    }
}

/// Returns the colour of a sample in the map `Lambert`: the sum of n.l over all lights, as a grey.
fn lambert_color(scene: &Scene, sample: &GBufferSample) -> Srgb8 {
    let Some(surface) = sample.surface(scene) else { return NO_HIT };
    let cosine = |light| shade::incidence(light, &surface).map_or(0.0, |incidence| incidence.cosine);
    Srgb8::from_linear(LinearRgb::grey(scene.lights().iter().map(cosine).sum()))
}

/// Returns the colour of the visible side, times the cosine of the angle between normal and ray.
///
/// A plane, which has no end, is left out: it would fill the picture with one colour.
fn facing_color(scene: &Scene, sample: &GBufferSample) -> Srgb8 {
    let is_bounded = |hit: Hit| scene.objects()[hit.object as usize].shape.bounds().is_some();
    let Some(surface) = sample.surface(scene).filter(|_| sample.hit.is_some_and(is_bounded)) else { return NO_HIT };
    let side = match surface.side {
        Side::Front => FRONT,
        Side::Back => BACK,
    };
    let cosine = surface.shading_normal.dot(sample.ray.direction).abs() / sample.ray.direction.length();
    Srgb8::from_linear(LinearRgb::from_srgb8(side) * cosine)
}

/// Returns the distance from the eye to the target.
fn target_distance(camera: &Camera) -> f32 {
    let Pose { eye, target, .. } = camera.pose();
    eye.distance(target)
}
