//! The explanation of one pixel in the lecture's symbols.
//!
//! Its numbers come from the functions that make the picture: the ray, the surfaces that it was tested against, the
//! hit, the lights, the sum. Beside them are the lecture's formulas, as [`Equation`]s.

mod text;

pub use crate::shape::{Equation, Step};
pub use text::{MAX_LINE_WIDTH, SurfaceName, cell_of_pixel};

use crate::camera::Camera;
use crate::color::{LinearRgb, Srgb8};
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{self, Hit, Observer, PrimitiveTest};
use crate::light::Light;
use crate::ray::Ray;
use crate::render::{PixelTrace, trace_pixel};
use crate::scene::{Scene, ToneCurve};
use crate::shade::{self, Incidence};
use crate::shape::{Surface, SurfacePoint};
use crate::tone::{tone, tone_mapped};
use glam::{Vec2, Vec3};

/// The explanation of a pixel: of its first sample, through its centre.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Explanation {
    /// The size of the picture.
    pub resolution: Resolution,
    /// The lecture's (i, j): the column and the row, from the top left.
    pub pixel: [u32; 2],
    /// The lecture's (qu, qv): the position in the picture, from (0, 0) at the lower left corner to (1, 1) at the upper
    /// right.
    pub q: Vec2,
    /// The eye ray: **o** and **d**. As d reaches from the eye to the view rectangle, **q** is o + d.
    #[doc(hidden)]
    pub ray: Ray,
    /// Number of tree nodes, with up to eight boxes each, that the ray was tested against.
    #[doc(hidden)]
    pub nodes: u32,
    /// The surfaces that the ray was tested against: those that it crosses by increasing t, then the others.
    #[doc(hidden)]
    pub tested: Vec<TestedSurface>,
    /// The hit; `None` if the light is the background's.
    #[doc(hidden)]
    pub hit: Option<ShadedHit>,
    /// The light towards the eye.
    pub light: LinearRgb,
    /// The scene's factor for that light,
    pub exposure: f32,
    /// and its tone curve.
    pub tone_curve: ToneCurve,
    /// The light after both.
    pub shown: LinearRgb,
    /// The colour as files and terminals get it.
    pub bytes: Srgb8,
}

/// A surface that the ray was tested against.
#[derive(Clone, Debug, PartialEq)]
pub struct TestedSurface {
    /// Its name.
    pub name: SurfaceName,
    /// The t of the first crossing in front of the eye.
    pub t: Option<f32>,
    /// The lecture's equation.
    pub equation: Equation,
}

/// The hit and its light.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadedHit {
    /// The t of the closest crossing in front of the eye.
    pub hit: Hit,
    /// The name of the surface.
    pub name: SurfaceName,
    /// The lecture's **p** and **n**, and the visible side.
    pub point: SurfacePoint,
    /// The ambient light.
    pub ambient: LinearRgb,
    /// The contribution of each light.
    pub lights: Vec<LightContribution>,
    /// The sum of the arriving light.
    pub arriving: LinearRgb,
    /// The reflectance.
    pub reflectance: LinearRgb,
}

/// The contribution of one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightContribution {
    /// **l**, the distance, n.l, and the arriving light if nothing is in the way.
    pub incidence: Incidence,
    /// A surface in the way, if any, and its position on the way: 0 is the hit, 1 the light. There may be more.
    pub blocker: Option<(SurfaceName, f32)>,
}

impl LightContribution {
    /// Returns whether the surface faces the light.
    pub fn faces(&self) -> bool {
        0.0 < self.incidence.cosine
    }

    /// Returns the light that it contributes.
    pub fn light(&self) -> LinearRgb {
        if self.faces() && self.blocker.is_none() { self.incidence.light } else { LinearRgb::BLACK }
    }
}

/// Explains a pixel of the picture of `scene` seen by `camera`, counted from the top left. Its light and its colour are
/// those of a picture with one sample per pixel; with more samples, this is the first.
///
/// # Panics
/// Outside the picture.
pub fn explain(scene: &Scene, camera: &Camera, resolution: Resolution, pixel: [u32; 2]) -> Explanation {
    let trace = trace_pixel(scene, camera, resolution, pixel);
    let mut recorder = TestRecorder::default();
    hit::closest_hit_observed(scene, &trace.ray, &mut recorder);
    let mut one = Framebuffer::new(Resolution::square(1, 1));
    one.pixels_mut()[0] = trace.light;
    Explanation {
        resolution,
        pixel,
        q: trace.q,
        ray: trace.ray,
        nodes: recorder.nodes,
        tested: recorder.tested(scene, &trace.ray),
        hit: trace.hit.map(|hit| shaded_hit(scene, &trace, hit)),
        light: trace.light,
        exposure: scene.exposure(),
        tone_curve: scene.tone_curve(),
        shown: tone_mapped(trace.light, scene),
        bytes: tone(&one, scene).pixels[0],
    }
}

fn shaded_hit(scene: &Scene, trace: &PixelTrace, hit: Hit) -> ShadedHit {
    let point = hit.surface(scene).at_crossing(&trace.ray, hit.t);
    ShadedHit {
        hit,
        name: SurfaceName::of(scene, hit.object, hit.primitive),
        point,
        ambient: scene.ambient(),
        lights: scene.lights().iter().map(|light| light_contribution(scene, light, &point)).collect(),
        arriving: trace.arriving,
        reflectance: trace.reflectance,
    }
}

fn light_contribution(scene: &Scene, light: &Light, point: &SurfacePoint) -> LightContribution {
    let incidence = shade::incidence_on_either_side(light, point);
    let ray = shade::shadow_ray(light, point);
    let blocker = (scene.shadows() && 0.0 < incidence.cosine)
        .then(|| hit::any_hit_observed(scene, &ray, light.in_the_way(), &mut TestRecorder::default()))
        .flatten();
    LightContribution {
        incidence,
        blocker: blocker.map(|hit| (SurfaceName::of(scene, hit.object, hit.primitive), hit.t)),
    }
}

/// The observer that records what a ray is tested against.
#[derive(Default)]
struct TestRecorder {
    nodes: u32,
    tests: Vec<PrimitiveTest>,
}

impl Observer for TestRecorder {
    fn node_tested(&mut self) {
        self.nodes += 1;
    }

    fn primitive_tested(&mut self, test: PrimitiveTest) {
        self.tests.push(test);
    }
}

impl TestRecorder {
    fn tested(self, scene: &Scene, ray: &Ray) -> Vec<TestedSurface> {
        let mut tests = self.tests;
        let order = |test: &PrimitiveTest| (test.object, test.primitive);
        let t = |test: &PrimitiveTest| test.t.unwrap_or(f32::INFINITY);
        tests.sort_by(|a, b| t(a).total_cmp(&t(b)).then(order(a).cmp(&order(b))));
        let tested = |PrimitiveTest { object, primitive, t }| {
            let equation = scene.objects()[object as usize].shape.primitive(primitive).equation(ray);
            TestedSurface { name: SurfaceName::of(scene, object, primitive), t, equation }
        };
        tests.into_iter().map(tested).collect()
    }
}

impl Explanation {
    /// Returns the lecture's **q**: the point where the ray passes through the view rectangle.
    pub(crate) fn q_in_space(&self) -> Vec3 {
        self.ray.at(1.0)
    }
}
