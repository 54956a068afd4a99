//! How much light goes from a surface to the eye (lecture, "Shading").
//!
//! Direct light from point sources, reflected diffusely:
//!
//! ```text
//! L = reflectance * (ambient + sum over lights of V * I * max(0, n.l) / d^2)
//! ```
//!
//! V is 0 where something stands between the point and the light, else 1; n is the normal on the seen side, l the
//! unit vector to the light, d the distance to it; the 1/pi of diffuse reflection is folded into the intensity I.
//! Nothing in it depends on where the eye is, but for the side of the surface that it sees.

use crate::color::LinearRgb;
use crate::hit::{self, Hit};
use crate::lanes::{Eight, LANES, Lanes};
use crate::light::{Falloff, PointLight};
use crate::ray::{Interval, Ray};
use crate::scene::{Background, Scene};
use crate::shape::{Balls, Corners, Part, SideBySide, Surface, SurfacePoint, eight_points};
use crate::simd::{self, Work};
use glam::Vec3;

/// The surface at each hit. The rays' neighbours in the picture differ from them by these steps.
pub fn surface_points(
    scene: &Scene,
    rays: &[Ray],
    steps: [Vec3; 2],
    hits: &[Option<Hit>],
    points: &mut Vec<Option<SurfacePoint>>,
) {
    points.clear();
    points.resize(hits.len(), None);
    simd::run(SurfacePoints { scene, rays, steps, hits, points });
}

struct SurfacePoints<'w> {
    scene: &'w Scene,
    rays: &'w [Ray],
    steps: [Vec3; 2],
    hits: &'w [Option<Hit>],
    points: &'w mut [Option<SurfacePoint>],
}

impl Work for SurfacePoints<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { scene, rays, steps, hits, points } = self;
        let (mut spheres, mut triangles) = (Queue::<Balls<Eight>>::default(), Queue::<Corners<Eight>>::default());
        for (at, (ray, hit)) in rays.iter().zip(hits).enumerate() {
            let Some(hit) = *hit else { continue };
            match hit.surface(scene) {
                Part::Sphere(sphere) => spheres.push(at, ray, hit, *sphere),
                Part::Triangle(triangle) => triangles.push(at, ray, hit, *triangle),
                Part::Facet(facet) => triangles.push(at, ray, hit, *facet.triangle()),
                Part::Plane(plane) => {
                    let footprint = plane.footprint(ray, hit.t, steps);
                    points[at] = Some(SurfacePoint { footprint, ..plane.at_crossing(ray, hit.t) });
                }
            }
            if spheres.is_full() {
                spheres.answer::<N>(scene, points);
            }
            if triangles.is_full() {
                triangles.answer::<N>(scene, points);
            }
        }
        spheres.answer::<N>(scene, points);
        triangles.answer::<N>(scene, points);
    }
}

/// Up to eight hits of one kind of surface.
struct Queue<S: SideBySide> {
    places: Vec<usize>,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    shapes: Vec<S::Shape>,
}

impl<S: SideBySide> Default for Queue<S> {
    fn default() -> Self {
        Self { places: Vec::new(), rays: Vec::new(), hits: Vec::new(), shapes: Vec::new() }
    }
}

impl<S: SideBySide> Queue<S> {
    #[inline(always)]
    fn push(&mut self, place: usize, ray: &Ray, hit: Hit, shape: S::Shape) {
        self.places.push(place);
        self.rays.push(*ray);
        self.hits.push(hit);
        self.shapes.push(shape);
    }

    #[inline(always)]
    fn is_full(&self) -> bool {
        self.places.len() == LANES
    }

    #[inline(always)]
    fn answer<N: Lanes>(&mut self, scene: &Scene, points: &mut [Option<SurfacePoint>]) {
        if self.places.is_empty() {
            return;
        }
        let mut t = Eight([0.0; LANES]);
        for (t, hit) in t.0.iter_mut().zip(&self.hits) {
            *t = hit.t;
        }
        eight_points::<N, S>(&self.shapes, &self.rays, &t, |lane, point| {
            points[self.places[lane]] = Some(self.hits[lane].surface(scene).finished(point));
        });
        self.places.clear();
        self.rays.clear();
        self.hits.clear();
        self.shapes.clear();
    }
}

/// The arrays of one light's shadow rays.
#[derive(Default)]
pub struct ShadowRays {
    /// Which point each ray belongs to, and the light that it brings if nothing is in its way.
    arriving: Vec<(usize, LinearRgb)>,
    rays: Vec<Ray>,
    blocked: Vec<bool>,
}

/// The light that arrives at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arriving {
    /// ambient + sum over lights of V * I * max(0, n.l) / d^2.
    pub light: LinearRgb,
    /// Which lights it comes from, a bit for each; the thirty-third shares its bit with the first, and so on.
    pub lit_by: u32,
}

/// What arrives at each point. Returns the number of shadow rays that this took.
pub fn arriving_light(
    scene: &Scene,
    points: &[Option<SurfacePoint>],
    shadows: &mut ShadowRays,
    arriving: &mut Vec<Arriving>,
) -> usize {
    let mut shadow_rays = 0;
    arriving.clear();
    arriving.resize(points.len(), Arriving { light: scene.ambient, lit_by: 0 });
    for (number, light) in scene.lights.iter().enumerate() {
        shadows.aim(light, points);
        shadow_rays += shadows.trace(scene);
        for (&(point, light), &blocked) in shadows.arriving.iter().zip(&shadows.blocked) {
            if !blocked {
                arriving[point].light += light;
                arriving[point].lit_by |= 1 << (number % 32);
            }
        }
    }
    shadow_rays
}

impl ShadowRays {
    /// A ray from each point that faces the light.
    fn aim(&mut self, light: &PointLight, points: &[Option<SurfacePoint>]) {
        self.arriving.clear();
        self.rays.clear();
        for (at, point) in points.iter().enumerate() {
            let Some(point) = point else { continue };
            let Some(incidence) = incidence(light, point) else { continue };
            self.arriving.push((at, incidence.light));
            self.rays.push(shadow_ray(light, point));
        }
    }

    /// V = 0 for each ray that meets an object before the light. Returns how many of them were traced.
    fn trace(&mut self, scene: &Scene) -> usize {
        if scene.shadows {
            hit::any_hits(scene, &self.rays, TO_THE_LIGHT, &mut self.blocked);
            self.rays.len()
        } else {
            self.blocked.clear();
            self.blocked.resize(self.rays.len(), false);
            0
        }
    }
}

/// What goes to the eye: the reflected part of the light that arrives, or the background where nothing was hit.
pub fn reflect(
    scene: &Scene,
    rays: &[Ray],
    hits: &[Option<Hit>],
    points: &[Option<SurfacePoint>],
    arriving: &[Arriving],
    light: &mut Vec<LinearRgb>,
) {
    light.clear();
    light.extend(arriving.iter().enumerate().map(|(at, arriving)| match (hits[at], &points[at]) {
        (Some(hit), Some(point)) => scene.objects()[hit.object as usize].material.reflectance(point) * arriving.light,
        _ => background(scene, &rays[at]),
    }));
}

/// What one light does at a point that it faces, if nothing is in its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// The lecture's **l**: the direction to the light. Unit length.
    pub l: Vec3,
    /// The distance to the light.
    pub distance: f32,
    /// n.l, greater than 0.
    pub cosine: f32,
    /// I * n.l / d^2, or without the division where the light has no falloff.
    pub light: LinearRgb,
}

/// What the light does at the point, or nothing where the surface faces away from it.
pub fn incidence(light: &PointLight, point: &SurfacePoint) -> Option<Incidence> {
    let to_light = light.position - point.position;
    let distance_squared = to_light.dot(to_light);
    let distance = distance_squared.sqrt();
    let l = to_light / distance;
    let cosine = point.normal.dot(l);
    // False also for NaN: a light that lies in the surface.
    if !(cosine > 0.0) {
        return None;
    }
    let weakening = match light.falloff {
        Falloff::InverseSquare => cosine / distance_squared,
        Falloff::None => cosine,
    };
    Some(Incidence { l, distance, cosine, light: bounded(light.intensity * weakening) })
}

/// A light nearly in its surface may be brighter than f32 can say. Bounded here, all sums and products that follow are
/// numbers: NaN has other bits on other CPUs. (`min` of NaN and a number is the number.)
fn bounded(light: LinearRgb) -> LinearRgb {
    const BRIGHTEST: f32 = 1e30;
    LinearRgb::new(light.r.min(BRIGHTEST), light.g.min(BRIGHTEST), light.b.min(BRIGHTEST))
}

/// The ray from a point to a light. The light is at t = 1.
pub fn shadow_ray(light: &PointLight, point: &SurfacePoint) -> Ray {
    let origin = point.ray_origin();
    Ray { origin, direction: light.position - origin }
}

/// Where on a [`shadow_ray`] an object is in the light's way. Not at t = 0: at the origin of the coordinates a clearance
/// in proportion to them is nothing, and the point lies in its surface exactly.
pub const TO_THE_LIGHT: Interval = Interval { min: f32::MIN_POSITIVE, max: 1.0 };

/// The light that comes along a ray that meets nothing.
pub fn background(scene: &Scene, ray: &Ray) -> LinearRgb {
    match scene.background {
        Background::Color(color) => color,
        Background::Gradient { bottom, top } => {
            let up = ray.direction.normalize().y;
            bottom.lerp(top, 0.5 * (up + 1.0))
        }
    }
}
