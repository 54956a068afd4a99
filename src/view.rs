//! Scene -> pictures of what the light is made of: what there is to see besides light, from the same eye.
//!
//! All views but [`Shaded`](View::Shaded) are made of the rays through the middles of the pixels, one for each, and paint
//! each pixel by a fixed map: the same thing has the same colour in every picture, and the legend says which. Only the
//! map of depths knows of the camera: it is fixed to the distance of the target.

use crate::camera::{Camera, Pose};
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::Resolution;
use crate::progress::Cancelled;
use crate::render::{Cost, Crew, Reach, Sampling, Sight, all_sights};
use crate::scene::Scene;
use crate::shade;
use crate::shape::Side;
use crate::tone::Picture;

mod contrast;
mod cost;
mod maps;
mod shaded;

/// What of a scene is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum View {
    /// Its light.
    #[default]
    Shaded,
    /// The sum of n.l over all lights that the surface faces, at most 1, as light off white surfaces: no colours, no
    /// distances, no shadows.
    Lambert,
    /// How far away surfaces are along the view, t: the lightness 1 / (1 + (t / d)^2), where d is the distance from the
    /// eye to the target.
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

/// Where a ray meets nothing, in every view but those of light, of costs, and of high contrast.
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

impl View {
    /// All views, in the order in which they are gone through.
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

    /// Its name, one word.
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

    /// The view of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|view| view.name() == name)
    }

    /// The next one; the first after the last.
    pub fn next(self) -> Self {
        self.after(1)
    }

    /// The one before; the last before the first.
    pub fn back(self) -> Self {
        self.after(Self::ALL.len() - 1)
    }

    fn after(self, steps: usize) -> Self {
        let at = Self::ALL.iter().position(|&view| view == self).unwrap_or(0);
        Self::ALL[(at + steps) % Self::ALL.len()]
    }

    /// Whether more samples make it better: the others have one ray for each pixel.
    pub const fn refines(self) -> bool {
        matches!(self, Self::Shaded)
    }

    /// Its name and what its colours mean there, in at most 38 characters of ASCII.
    pub fn legend(self, scene: &Scene, camera: &Camera) -> String {
        let meaning = match self {
            Self::Shaded => return self.name().to_owned(),
            Self::Lambert => "n.l, no shadows".to_owned(),
            Self::Depth => format!("white 0, grey {}, black far", maps::short(distance(camera))),
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

/// What `camera` sees of `scene`. The sampling is the shaded view's; of the others only [`Sampling::Coarse`] means
/// something. Each is a function of nothing else.
pub fn picture(
    view: View,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: impl Into<Sampling>,
) -> Picture {
    all_seen(view, Crew::Pool, scene, camera, resolution, sampling.into()).picture
}

/// [`picture`], traced by that crew.
///
/// # Errors
/// [`Cancelled`], if the crew's token is.
pub fn seen(
    view: View,
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Result<Seen, Cancelled> {
    crew.finish(all_seen(view, crew, scene, camera, resolution, sampling))
}

fn all_seen(
    view: View,
    crew: Crew<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> Seen {
    let painted = |reach, paint: &(dyn Fn(&Sight) -> Srgb8 + Sync)| {
        let sighted = all_sights(crew, scene, camera, resolution, sampling, reach, paint);
        let Resolution { width, height, .. } = resolution;
        Seen { picture: Picture { width, height, pixels: sighted.pixels }, cost: sighted.cost }
    };
    let of_surfaces = |paint: &(dyn Fn(&Sight) -> Srgb8 + Sync)| painted(Reach::Surfaces, paint);
    match view {
        View::Shaded => shaded::seen(crew, scene, camera, resolution, sampling),
        View::Lambert => of_surfaces(&|sight| lambert(scene, sight)),
        View::Depth => {
            let middle = distance(camera);
            of_surfaces(&|sight| sight.hit.map_or(NOTHING, |hit| maps::depth(hit.t, middle)))
        }
        View::Normal => {
            of_surfaces(&|sight| sight.surface(scene).map_or(NOTHING, |surface| maps::normal(surface.normal)))
        }
        View::Object => of_surfaces(&|sight| sight.hit.map_or(NOTHING, |hit| maps::object(hit.object))),
        View::Shadow => painted(Reach::Lights, &|sight| match sight.hit {
            Some(_) => maps::share(sight.lit_by.count_ones(), scene.lights().len().min(32) as u32),
            None => NOTHING,
        }),
        View::Cost => of_surfaces(&|sight| maps::heat(cost::tests(scene, sight))),
        View::Facing => of_surfaces(&|sight| match sight.surface(scene).map(|surface| surface.side) {
            None => NOTHING,
            Some(Side::Front) => FRONT,
            Some(Side::Back) => BACK,
        }),
        View::Contrast => contrast::seen(crew, scene, camera, resolution, sampling),
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
