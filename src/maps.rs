//! The shaded picture of a scene, and maps: pictures of other things than light, from the same camera.
//!
//! A map is made of one ray through the centre of each pixel and has a fixed colour scale, which its legend gives:
//! equal values have equal colours in every picture. Only the scale of depths depends on the camera, by the distance of
//! its target. A *view* is something else: a camera position, as in a scene's [`views`](Scene::views).

use crate::camera::{Camera, Pose};
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::Resolution;
use crate::progress::Cancelled;
use crate::render::{Cost, Executor, GBufferSample, Sampling, TraceDepth, trace_g_buffer_partial};
use crate::scene::Scene;
use crate::shade;
use crate::shape::Side;
use crate::text::{ParseError, named};
use crate::tone::Picture;
use std::fmt;
use std::str::FromStr;

mod colors;
mod contrast;
mod cost;
mod shaded;

/// The content of a picture: the scene's light, or one of the maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Map {
    /// The light.
    #[default]
    Shaded,
    /// The sum of n.l over all lights that the surface faces, at most 1, as light off white surfaces: without colours,
    /// distances and shadows.
    Lambert,
    /// The depth t along the direction of view, as the lightness 1 / (1 + (t / d)^2), where d is the distance from the
    /// eye to the target.
    Depth,
    /// The normal on the visible side, as (n + 1) / 2 in red, green and blue.
    Normal,
    /// The object, by a colour for each number.
    Object,
    /// The number of lights that reach the surface, from dark grey for none to white for all.
    Shadow,
    /// The number of tests of the pixel's eye ray and shadow rays, each traced singly: surfaces, and nodes of the tree;
    /// from blue over green to red and white, with a colour for each power of four.
    Cost,
    /// The visible side of the surface.
    Facing,
    /// The light in black and white, thresholded in the middle, with a line where two objects of the same colour meet:
    /// for people who see outlines better than colours.
    Contrast,
}

/// The colour of rays without a hit, in all maps except costs and high contrast.
const NO_HIT: Srgb8 = Srgb8::new(16, 20, 56);
/// The colour of the side of a surface to which its normal points,
const FRONT: Srgb8 = Srgb8::new(70, 150, 230);
/// and of the other side.
const BACK: Srgb8 = Srgb8::new(235, 80, 50);

/// A picture and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedMap {
    /// The picture.
    pub picture: Picture,
    /// The cost, which has no influence on the picture.
    pub cost: Cost,
}

impl Map {
    /// The shaded picture and all maps, in the order in which the keys go through them.
    pub const ALL: [Self; 9] = [
        Self::Shaded,
        Self::Lambert,
        Self::Depth,
        Self::Normal,
        Self::Object,
        Self::Shadow,
        Self::Cost,
        Self::Facing,
        Self::Contrast,
    ];

    /// Returns the picture of `scene` from `camera`, a function of these arguments alone. Samples refine the shaded
    /// picture; of maps only [`Sampling::Coarse`] changes anything.
    pub fn picture(
        self,
        scene: &Scene,
        camera: &Camera,
        resolution: Resolution,
        sampling: impl Into<Sampling>,
    ) -> Picture {
        picture(self, scene, camera, resolution, sampling)
    }

    /// Returns the name, one word.
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
    pub fn back(self) -> Self {
        self.after(Self::ALL.len() - 1)
    }

    fn after(self, steps: usize) -> Self {
        let at = Self::ALL.iter().position(|&map| map == self).unwrap_or(0);
        Self::ALL[(at + steps) % Self::ALL.len()]
    }

    /// Returns whether more samples improve the picture: maps have one ray per pixel.
    #[doc(hidden)]
    pub const fn refines(self) -> bool {
        matches!(self, Self::Shaded)
    }

    /// Returns the name and the meaning of the colours in this picture, in at most 38 ASCII characters.
    #[doc(hidden)]
    pub fn legend(self, scene: &Scene, camera: &Camera) -> String {
        let meaning = match self {
            Self::Shaded => return self.name().to_owned(),
            Self::Lambert => "n.l, no shadows".to_owned(),
            Self::Depth => format!("white 0, grey {}, black far", colors::short(distance(camera))),
            Self::Normal => "red x, green y, blue z".to_owned(),
            Self::Object => format!("{} colours", scene.objects().len()),
            Self::Shadow => format!("white lit by {}, dark by 0", scene.lights().len()),
            Self::Cost => "blue 1, green 16, red 256 tests".to_owned(),
            Self::Facing => "blue front, red back".to_owned(),
            Self::Contrast => "lines between objects".to_owned(),
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

/// Returns the [picture](Map::picture) of a map.
pub fn picture(
    map: Map,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Picture {
    trace_partial(map, Executor::Pool, scene, camera, resolution, sampling.into()).picture
}

/// Traces as [`picture`] does on the threads of `executor`.
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
    executor.finish(trace_partial(map, executor, scene, camera, resolution, sampling))
}

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
        TracedMap { picture: Picture { width, height, pixels: traced.pixels }, cost: traced.cost }
    };
    let of_surfaces = |paint: &(dyn Fn(&GBufferSample) -> Srgb8 + Sync)| traced_to(TraceDepth::Surfaces, paint);
    match map {
        Map::Shaded => shaded::trace(executor, scene, camera, resolution, sampling),
        Map::Lambert => of_surfaces(&|sample| lambert(scene, sample)),
        Map::Depth => {
            let middle = distance(camera);
            of_surfaces(&|sample| sample.hit.map_or(NO_HIT, |hit| colors::depth(hit.t, middle)))
        }
        Map::Normal => of_surfaces(&|sample| {
            sample.surface(scene).map_or(NO_HIT, |surface| colors::normal(surface.shading_normal))
        }),
        Map::Object => of_surfaces(&|sample| sample.hit.map_or(NO_HIT, |hit| colors::object(hit.object))),
        Map::Shadow => traced_to(TraceDepth::Lights, &|sample| match sample.hit {
            Some(_) => colors::share(sample.lit_by.count_ones(), scene.lights().len().min(32) as u32),
            None => NO_HIT,
        }),
        Map::Cost => of_surfaces(&|sample| colors::heat(cost::tests(scene, sample))),
        Map::Facing => of_surfaces(&|sample| match sample.surface(scene).map(|surface| surface.side) {
            None => NO_HIT,
            Some(Side::Front) => FRONT,
            Some(Side::Back) => BACK,
        }),
        Map::Contrast => contrast::trace(executor, scene, camera, resolution, sampling),
    }
}

/// Returns the sum of the lecture's n.l over all lights, as light.
fn lambert(scene: &Scene, sample: &GBufferSample) -> Srgb8 {
    let Some(surface) = sample.surface(scene) else { return NO_HIT };
    let cosine = |light| shade::incidence(light, &surface).map_or(0.0, |incidence| incidence.cosine);
    Srgb8::from_linear(LinearRgb::grey(scene.lights().iter().map(cosine).sum()))
}

/// Returns the distance from the eye to the target.
fn distance(camera: &Camera) -> f32 {
    let Pose { eye, target, .. } = camera.pose();
    eye.distance(target)
}
