//! Explanations of one pixel in the symbols of the lecture on ray tracing.
//!
//! All numbers come from the functions that render pictures: the ray, the tested surfaces, the hit, the lights, the
//! sum. The lecture's formulas are given with them, as [`Equation`]s.

mod text;

pub use crate::shape::{Equation, EquationStep};
pub use text::{MAX_LINE_WIDTH, SurfaceName};

use crate::camera::Camera;
use crate::color::{LinearRgb, Srgb8};
use crate::finish::Finish;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::hit::{self, Hit, Observer, PrimitiveTest};
use crate::light::Light;
use crate::ray::Ray;
use crate::render::{PixelTrace, trace_pixel};
use crate::scene::{OwnPoint, Scene, ToneCurve};
use crate::shade::{self, Incidence};
use crate::shape::{Surface, SurfacePoint};
use crate::tone::{tone, tone_mapped};
use glam::{Vec2, Vec3};
use std::collections::HashSet;

/// An explanation of a pixel's first sample, whose ray passes through the pixel's centre.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Explanation {
    /// The size of the picture.
    pub resolution: Resolution,
    /// The lecture's (i, j): the column and the row, from the top left.
    pub pixel: [u32; 2],
    /// The lecture's (qu, qv): the position from (0, 0) at the lower left corner to (1, 1).
    pub q: Vec2,
    /// The camera, with the basis u, v, w and the view rectangle.
    #[doc(hidden)]
    pub camera: Camera,
    /// The eye ray: the lecture's origin **o** and direction **d**. The point **q** of the view
    /// rectangle is o + d.
    #[doc(hidden)]
    pub ray: Ray,
    /// The number of tree nodes that the ray was tested against. A node has up to eight boxes.
    #[doc(hidden)]
    pub nodes: u32,
    /// The surfaces that the ray was tested against: first those that it crosses, by increasing t,
    /// then the others.
    #[doc(hidden)]
    pub tested: Vec<TestedSurface>,
    /// The closest hit and its shading; `None` if the pixel shows the background.
    #[doc(hidden)]
    pub hit: Option<ShadedHit>,
    /// The part of the light that fog leaves; `None` without fog.
    #[doc(hidden)]
    pub transmittance: Option<f32>,
    /// The linear light that reaches the eye.
    pub light: LinearRgb,
    /// The scene's exposure, a factor of the light.
    pub exposure: f32,
    /// The scene's tone curve.
    pub tone_curve: ToneCurve,
    /// The linear light after exposure and tone curve.
    pub shown: LinearRgb,
    /// The 8-bit colour of the pixel.
    pub bytes: Srgb8,
}

/// A surface that the ray was tested against.
#[derive(Clone, Debug, PartialEq)]
pub struct TestedSurface {
    /// The name of the surface.
    pub name: SurfaceName,
    /// The t of the first crossing in front of the eye; `None` if there is none.
    pub t: Option<f32>,
    /// Whether the ray passes the surface through a hole.
    pub is_hole: bool,
    /// The lecture's equation for crossings, with its values.
    pub equation: Equation,
}

/// A hit and its shading.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadedHit {
    /// The closest hit.
    pub hit: Hit,
    /// The name of the surface.
    pub name: SurfaceName,
    /// The surface point, with the lecture's **p** and **n**, and the visible side.
    pub point: SurfacePoint,
    /// The ambient light.
    pub ambient: LinearRgb,
    /// The contribution of each light.
    pub lights: Vec<LightContribution>,
    /// The sum of the ambient light and all contributions.
    pub arriving: LinearRgb,
    /// The reflectance of the surface, by which the arriving light is multiplied.
    pub reflectance: LinearRgb,
    /// The finish of the surface, and the part of the light that it mirrors.
    #[doc(hidden)]
    pub finish: (Finish, f32),
    /// The part of the light that does not pass straight through the surface.
    #[doc(hidden)]
    pub opacity: f32,
    /// The light that the surface sends out by the file of its mesh.
    #[doc(hidden)]
    pub emission: LinearRgb,
}

/// The contribution of one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightContribution {
    /// The light.
    pub light: Light,
    /// The lecture's direction **l** to the light and n.l, the distance, and the light that arrives
    /// if nothing blocks it.
    pub incidence: Incidence,
    /// A surface that blocks the light, with the t of the crossing: 0 at the hit, 1 at the light.
    // Any surface in the way, as for the shadow rays of pictures; not necessarily the one closest to the hit.
    pub blocker: Option<(SurfaceName, f32)>,
    /// The light that arrives, and its part of the light without shadows, if it may be blocked in
    /// part: that of a light with a size, or in a scene with transparent objects.
    partial: Option<(LinearRgb, f32)>,
}

impl LightContribution {
    /// Returns whether the surface faces the light.
    pub fn faces(&self) -> bool {
        0.0 < self.incidence.cosine
    }

    /// Returns whether the light reaches the surface.
    pub fn is_lit(&self) -> bool {
        if let Some((_, visibility)) = self.partial {
            return visibility > 0.0;
        }
        self.faces() && self.blocker.is_none() && self.light.cone_share(self.incidence.l) != Some(0.0)
    }

    /// Returns the part of the light that arrives: the lecture's V, if a light has no size.
    pub(crate) fn visibility(&self) -> f32 {
        match self.partial {
            Some((_, visibility)) => visibility,
            None => {
                if self.is_lit() {
                    1.0
                } else {
                    0.0
                }
            }
        }
    }

    /// Returns the arriving light, or black if it is blocked or the surface faces away from it.
    pub fn arriving(&self) -> LinearRgb {
        if let Some((light, _)) = self.partial {
            return light;
        }
        if self.faces() && self.blocker.is_none() { self.incidence.light } else { LinearRgb::BLACK }
    }
}

/// Explains a pixel of a picture of `scene`, given as column and row from the top left.
///
/// The light and the colour of the pixel are those of a picture with one sample per pixel.
///
/// ```
/// use termtrace::{Resolution, Scene, explain};
///
/// let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
/// let scene = Scene::from_ron("ball.ron", text)?;
/// let explanation = explain(&scene, scene.camera(), Resolution::new(81, 81)?, [40, 40]);
/// assert!(explanation.lines().iter().any(|line| line == "closest hit: sphere #1"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Panics
/// If the pixel is outside the picture.
pub fn explain(scene: &Scene, camera: &Camera, resolution: Resolution, pixel: [u32; 2]) -> Explanation {
    let trace = trace_pixel(scene, camera, resolution, pixel);
    let mut recorder = TestRecorder::default();
    // The ray is traced again, with the same hit, to record the surfaces that are tested, which the kernels of pictures
    // do not report.
    hit::closest_hit_observed(scene, &trace.ray, &mut recorder);
    // A picture of one pixel, because `tone` is the function that gives pictures their bytes.
    let mut one = Framebuffer::new(Resolution::square(1, 1));
    one.pixels_mut()[0] = trace.light;
    Explanation {
        resolution,
        pixel,
        q: trace.q,
        camera: *camera,
        ray: trace.ray,
        nodes: recorder.nodes,
        tested: recorder.tested_surfaces(scene, &trace.ray),
        hit: trace.hit.map(|hit| {
            let arriving = |scene: &Scene| trace_pixel(scene, camera, resolution, pixel).arriving;
            shaded_hit(scene, &trace, hit, &arriving)
        }),
        transmittance: scene.fog().map(|fog| {
            let t = trace.hit.map_or(f32::INFINITY, |hit| hit.t);
            fog.transmittance(t * trace.ray.direction.length())
        }),
        light: trace.light,
        exposure: scene.exposure(),
        tone_curve: scene.tone_curve(),
        shown: tone_mapped(trace.light, scene),
        bytes: tone(&one, scene).pixels()[0],
    }
}

/// Returns the hit of a traced pixel with its shading.
///
/// `arriving` returns the light that arrives there in another scene.
fn shaded_hit(scene: &Scene, trace: &PixelTrace, hit: Hit, arriving: &dyn Fn(&Scene) -> LinearRgb) -> ShadedHit {
    let point = hit.surface(scene).at_crossing(&trace.ray, hit.t);
    let object = &scene.objects()[hit.object as usize];
    let (finish, own_point) = (object.finish, OwnPoint::from(&point));
    ShadedHit {
        hit,
        name: SurfaceName::of_primitive(scene, hit.object, hit.primitive),
        point,
        ambient: scene.ambient(),
        lights: scene.lights().iter().map(|light| light_contribution(scene, light, &point, arriving)).collect(),
        arriving: trace.arriving,
        reflectance: trace.reflectance,
        finish: (finish, finish.mirrored_part(&trace.ray, point.shading_normal)),
        opacity: if scene.has_transparent() { object.opacity_at(hit.primitive, &own_point) } else { 1.0 },
        emission: if scene.has_emission() { object.emission_at(hit.primitive, &own_point) } else { LinearRgb::BLACK },
    }
}

/// Returns the contribution of a light at a surface point.
// The shadow ray is traced singly, with an observer, because packets do not return which surface blocks a ray.
fn light_contribution(
    scene: &Scene,
    light: &Light,
    point: &SurfacePoint,
    arriving: &dyn Fn(&Scene) -> LinearRgb,
) -> LightContribution {
    let incidence = shade::incidence_with_signed_cosine(light, point);
    let ray = shade::shadow_ray(light, point);
    let blocker = (scene.shadows() && 0.0 < incidence.cosine)
        .then(|| hit::any_hit_observed(scene, &ray, light.blocking_interval(), &mut TestRecorder::default()))
        .flatten();
    let partial = (light.has_size() || scene.has_transparent()).then(|| {
        let alone = scene.clone().with_lights([*light]).without_ambient();
        let lit = arriving(&alone);
        let without_shadows = arriving(&alone.with_shadows(false)).luminance();
        (lit, if without_shadows > 0.0 { lit.luminance() / without_shadows } else { 0.0 })
    });
    LightContribution {
        light: *light,
        incidence,
        partial,
        blocker: blocker.map(|hit| (SurfaceName::of_primitive(scene, hit.object, hit.primitive), hit.t)),
    }
}

/// An observer that records the surfaces that a ray is tested against, and counts the nodes.
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
    /// Returns the tested surfaces, in the order of [`Explanation::tested`].
    fn tested_surfaces(self, scene: &Scene, ray: &Ray) -> Vec<TestedSurface> {
        let (mut tests, mut holes) = (self.tests, HashSet::new());
        let order = |test: &PrimitiveTest| (test.object, test.primitive);
        let t = |test: &PrimitiveTest| test.t.unwrap_or(f32::INFINITY);
        if scene.has_holes() {
            for test in &mut tests {
                let &mut PrimitiveTest { object, primitive, t } = test;
                if t.is_some_and(|t| hit::is_hole(scene, ray, Hit { t, object, primitive })) {
                    test.t = None;
                    holes.insert(order(test));
                }
            }
            // Behind a hole, surfaces are tested again, of which the first crossing counts.
            tests.sort_by(|a, b| order(a).cmp(&order(b)).then(t(a).total_cmp(&t(b))));
            tests.dedup_by_key(|test| order(test));
        }
        // Surfaces that the ray misses come last, in the order of the scene.
        tests.sort_by(|a, b| t(a).total_cmp(&t(b)).then(order(a).cmp(&order(b))));
        let tested = |PrimitiveTest { object, primitive, t }| {
            let equation = scene.objects()[object as usize].shape.primitive(primitive).equation(ray);
            let is_hole = t.is_none() && holes.contains(&(object, primitive));
            TestedSurface { name: SurfaceName::of_primitive(scene, object, primitive), t, is_hole, equation }
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
