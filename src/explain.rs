//! One pixel explained: all that its light came from, in the lecture's symbols.
//!
//! What is said of the pixel was done for it by the functions that make the picture: its ray, what that was tested
//! against, the point that it met, the lights, the sum. Beside it stand the lecture's formulas, as [`Equation`]s.

mod text;

pub use crate::shape::{Equation, Step};
pub use text::{Name, WIDTH, cell};

use crate::camera::Camera;
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{self, Hit, Test, Witness};
use crate::light::Light;
use crate::ray::Ray;
use crate::render::{Steps, trace_pixel};
use crate::scene::{Scene, ToneCurve};
use crate::shade::{self, Incidence};
use crate::shape::{Surface, SurfacePoint};
use crate::tone::{shown, tone};
use glam::{Vec2, Vec3};

/// What a picture's pixel comes from: the first of its samples, which goes through its centre.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Explanation {
    /// The picture's size.
    pub resolution: Resolution,
    /// The lecture's (i, j): the column and the row, from the top left.
    pub pixel: [u32; 2],
    /// The lecture's (qu, qv): where in the picture that is, from the lower left corner (0, 0) to the upper right (1, 1).
    pub q: Vec2,
    /// The eye ray: **o** and **d**. As d reaches from the eye to the view rectangle, **q** is o + d.
    #[doc(hidden)]
    pub ray: Ray,
    /// How many nodes of trees, of up to eight boxes each, it was tested against.
    #[doc(hidden)]
    pub nodes: u32,
    /// What surfaces it was tested against: those that it crosses by rising t, then the others.
    #[doc(hidden)]
    pub tested: Vec<Tested>,
    /// What it met; nothing: its light is the background's.
    #[doc(hidden)]
    pub seen: Option<Seen>,
    /// What goes to the eye.
    pub light: LinearRgb,
    /// What the scene multiplies that by,
    pub exposure: f32,
    /// and how it fits it to the screen's range.
    pub tone_curve: ToneCurve,
    /// The light after both.
    pub shown: LinearRgb,
    /// What files and terminals are told.
    pub bytes: Srgb8,
}

/// A surface that the ray was tested against.
#[derive(Clone, Debug, PartialEq)]
pub struct Tested {
    /// What it is called.
    pub name: Name,
    /// Where the ray crosses it first, in front of the eye.
    pub t: Option<f32>,
    /// How the lecture puts it.
    pub equation: Equation,
}

/// The point that the ray met, and its light.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// The closest crossing in front of the eye.
    pub hit: Hit,
    /// What it was called.
    pub name: Name,
    /// The lecture's **p** and **n**, and which side is seen.
    pub point: SurfacePoint,
    /// The light that arrives from everywhere alike.
    pub ambient: LinearRgb,
    /// What each light does there.
    pub lights: Vec<Lit>,
    /// All that arrives.
    pub arriving: LinearRgb,
    /// How much of it is reflected.
    pub reflectance: LinearRgb,
}

/// What one light does at the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lit {
    /// **l**, the distance, n.l, and what arrives if nothing is in the way.
    pub incidence: Incidence,
    /// What is in the way, if a surface is, and where on the way: 0 is the point, 1 the light. There may be more.
    pub blocker: Option<(Name, f32)>,
}

impl Lit {
    /// Whether the surface faces the light.
    pub fn faces(&self) -> bool {
        0.0 < self.incidence.cosine
    }

    /// What it adds to the light that arrives.
    pub fn contribution(&self) -> LinearRgb {
        if self.faces() && self.blocker.is_none() { self.incidence.light } else { LinearRgb::BLACK }
    }
}

/// Explains a pixel of the picture of `scene` that `camera` sees; (0, 0) is top left. Its light and its bytes are those of
/// a picture with one sample of each pixel. Of more samples, this is the first.
///
/// # Panics
/// Outside the picture.
pub fn explain(scene: &Scene, camera: &Camera, resolution: Resolution, pixel: [u32; 2]) -> Explanation {
    let steps = trace_pixel(scene, camera, resolution, pixel);
    let mut listener = Listener::default();
    hit::closest_hit_witnessed(scene, &steps.ray, &mut listener);
    let mut one = Framebuffer::new(Resolution::square(1, 1));
    one.pixels_mut()[0] = steps.light;
    Explanation {
        resolution,
        pixel,
        q: steps.q,
        ray: steps.ray,
        nodes: listener.nodes,
        tested: listener.tested(scene, &steps.ray),
        seen: steps.hit.map(|hit| seen(scene, &steps, hit)),
        light: steps.light,
        exposure: scene.exposure(),
        tone_curve: scene.tone_curve(),
        shown: shown(steps.light, scene),
        bytes: tone(&one, scene).pixels[0],
    }
}

fn seen(scene: &Scene, steps: &Steps, hit: Hit) -> Seen {
    let point = hit.surface(scene).at_crossing(&steps.ray, hit.t);
    Seen {
        hit,
        name: Name::of(scene, hit.object, hit.part),
        point,
        ambient: scene.ambient(),
        lights: scene.lights().iter().map(|light| lit(scene, light, &point)).collect(),
        arriving: steps.arriving,
        reflectance: steps.reflectance,
    }
}

fn lit(scene: &Scene, light: &Light, point: &SurfacePoint) -> Lit {
    let incidence = shade::incidence_on_either_side(light, point);
    let ray = shade::shadow_ray(light, point);
    let blocker = (scene.shadows() && 0.0 < incidence.cosine)
        .then(|| hit::any_hit_witnessed(scene, &ray, light.in_the_way(), &mut Listener::default()))
        .flatten();
    Lit { incidence, blocker: blocker.map(|hit| (Name::of(scene, hit.object, hit.part), hit.t)) }
}

/// Keeps what a ray is tested against.
#[derive(Default)]
struct Listener {
    nodes: u32,
    tests: Vec<Test>,
}

impl Witness for Listener {
    fn boxes(&mut self) {
        self.nodes += 1;
    }

    fn part(&mut self, test: Test) {
        self.tests.push(test);
    }
}

impl Listener {
    fn tested(self, scene: &Scene, ray: &Ray) -> Vec<Tested> {
        let mut tests = self.tests;
        let order = |test: &Test| (test.object, test.part);
        let t = |test: &Test| test.t.unwrap_or(f32::INFINITY);
        tests.sort_by(|a, b| t(a).total_cmp(&t(b)).then(order(a).cmp(&order(b))));
        let tested = |Test { object, part, t }| {
            let equation = scene.objects()[object as usize].shape.part(part).equation(ray);
            Tested { name: Name::of(scene, object, part), t, equation }
        };
        tests.into_iter().map(tested).collect()
    }
}

impl Explanation {
    /// The lecture's **q**: where the ray goes through the view rectangle.
    pub(crate) fn q_in_space(&self) -> Vec3 {
        self.ray.at(1.0)
    }
}
