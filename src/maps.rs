//! Scene -> the shaded picture, or a map: what there is to see besides light, from the same camera.
//!
//! A map is made of one ray through the middle of each pixel and has a fixed colour scale: equal values have equal colours
//! in every picture, and the legend says which. Only the scale of depths depends on the camera, on the distance of its
//! target. A *view* is something else: a camera position, as in a scene's [`views`](Scene::views).

use crate::camera::{Camera, Pose};
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::Resolution;
use crate::progress::Cancelled;
use crate::render::{Cost, Crew, Reach, Sampling, Sight, all_sights};
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

/// What a picture shows of a scene: its light, or one of the maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Map {
    /// Its light.
    #[default]
    Shaded,
    /// The sum of n.l over all lights that the surface faces, at most 1, as light off white surfaces: no colours, no
    /// distances, no shadows.
    Lambert,
    /// How far away surfaces are along the direction of view, t: the lightness 1 / (1 + (t / d)^2), where d is the distance
    /// from the eye to the target.
    Depth,
    /// The normal on the seen side, (n + 1) / 2 as red, green and blue.
    Normal,
    /// Which object it is: a colour for each number.
    Object,
    /// How many lights arrive: none is dark grey, all are white.
    Shadow,
    /// What the pixel's rays are tested against, each by itself: surfaces and nodes of the tree, counted for the eye ray
    /// and its shadow rays; from blue over green to red and white, a colour for each power of four.
    Cost,
    /// Which side of the surface is seen.
    Facing,
    /// The light as black and white, cut in the middle, with a line where two objects of the same ink meet: for those who
    /// see outlines better than colours.
    Contrast,
}

/// Where a ray meets nothing, in every picture but those of light, of costs, and of high contrast.
const NOTHING: Srgb8 = Srgb8::new(16, 20, 56);
/// The side of a surface to which its normal points,
const FRONT: Srgb8 = Srgb8::new(70, 150, 230);
/// and the other one.
const BACK: Srgb8 = Srgb8::new(235, 80, 50);

/// A picture, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// The picture.
    pub picture: Picture,
    /// What it took. Nothing in the picture depends on it.
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

    /// Returns the picture that `camera` takes of `scene`: a function of these arguments alone. Samples refine the shaded
    /// picture; of the maps only [`Sampling::Coarse`] changes anything.
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

    /// Returns the map of that name.
    #[doc(hidden)]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|map| map.name() == name)
    }

    /// Returns the next map; after the last, the first.
    #[doc(hidden)]
    pub fn next(self) -> Self {
        self.after(1)
    }

    /// Returns the map before; before the first, the last.
    #[doc(hidden)]
    pub fn back(self) -> Self {
        self.after(Self::ALL.len() - 1)
    }

    fn after(self, steps: usize) -> Self {
        let at = Self::ALL.iter().position(|&map| map == self).unwrap_or(0);
        Self::ALL[(at + steps) % Self::ALL.len()]
    }

    /// Returns whether more samples make it better: the others have one ray for each pixel.
    #[doc(hidden)]
    pub const fn refines(self) -> bool {
        matches!(self, Self::Shaded)
    }

    /// Returns the name and what the colours mean in that picture, in at most 38 characters of ASCII.
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

/// The value of that name.
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

/// Returns the [picture](Map::picture) of that map.
pub fn picture(
    map: Map,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Picture {
    all_seen(map, Crew::Pool, scene, camera, resolution, sampling.into()).picture
}

/// [`picture`], traced by that crew.
///
/// # Errors
/// [`Cancelled`], if the crew's token is.
pub fn seen(
    map: Map,
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Result<Seen, Cancelled> {
    crew.finish(all_seen(map, crew, scene, camera, resolution, sampling))
}

fn all_seen(
    map: Map,
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Seen {
    let painted = |reach, paint: &(dyn Fn(&Sight) -> Srgb8 + Sync)| {
        let sighted = all_sights(crew, scene, camera, resolution, sampling, reach, paint);
        let [width, height] = [resolution.width(), resolution.height()];
        Seen { picture: Picture { width, height, pixels: sighted.pixels }, cost: sighted.cost }
    };
    let of_surfaces = |paint: &(dyn Fn(&Sight) -> Srgb8 + Sync)| painted(Reach::Surfaces, paint);
    match map {
        Map::Shaded => shaded::seen(crew, scene, camera, resolution, sampling),
        Map::Lambert => of_surfaces(&|sight| lambert(scene, sight)),
        Map::Depth => {
            let middle = distance(camera);
            of_surfaces(&|sight| sight.hit.map_or(NOTHING, |hit| colors::depth(hit.t, middle)))
        }
        Map::Normal => {
            of_surfaces(&|sight| sight.surface(scene).map_or(NOTHING, |surface| colors::normal(surface.normal)))
        }
        Map::Object => of_surfaces(&|sight| sight.hit.map_or(NOTHING, |hit| colors::object(hit.object))),
        Map::Shadow => painted(Reach::Lights, &|sight| match sight.hit {
            Some(_) => colors::share(sight.lit_by.count_ones(), scene.lights().len().min(32) as u32),
            None => NOTHING,
        }),
        Map::Cost => of_surfaces(&|sight| colors::heat(cost::tests(scene, sight))),
        Map::Facing => of_surfaces(&|sight| match sight.surface(scene).map(|surface| surface.side) {
            None => NOTHING,
            Some(Side::Front) => FRONT,
            Some(Side::Back) => BACK,
        }),
        Map::Contrast => contrast::seen(crew, scene, camera, resolution, sampling),
    }
}

/// The lecture's n.l of all lights, as light.
fn lambert(scene: &Scene, sight: &Sight) -> Srgb8 {
    let Some(surface) = sight.surface(scene) else { return NOTHING };
    let cosine = |light| shade::incidence(light, &surface).map_or(0.0, |incidence| incidence.cosine);
    Srgb8::from_linear(LinearRgb::grey(scene.lights().iter().map(cosine).sum()))
}

/// From the eye to the target.
fn distance(camera: &Camera) -> f32 {
    let Pose { eye, target, .. } = camera.pose();
    eye.distance(target)
}
