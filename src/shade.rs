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
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{ALL, F32x8, LANES, LaneMask, Lanes, Number, Vector, set_bits};
use crate::light::Light;
use crate::material::Material;
use crate::ray::{EightRays, Ray};
use crate::scene::{Background, Object, Scene};
use crate::shape::SurfacePoint;
use crate::simd::{self, SimdKernel};
use glam::Vec3;

mod points;

pub use points::{EightPoints, surface_points};

/// The light that eight rays bring, channel by channel.
pub type EightLights = [F32x8; 3];

/// One of the eight.
#[inline(always)]
pub fn lane_light([r, g, b]: &EightLights, lane: usize) -> LinearRgb {
    LinearRgb::new(r.0[lane], g.0[lane], b.0[lane])
}

/// The light that arrives at eight points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightArriving {
    /// ambient + sum over lights of V * I * max(0, n.l) / d^2.
    pub light: EightLights,
    /// Which lights it comes from, a bit for each; the thirty-third shares its bit with the first, and so on.
    pub lit_by: [u32; LANES],
}

/// The arrays of one light's shadow rays.
#[derive(Default)]
pub struct ShadowRays {
    pub(crate) rays: Vec<EightRays>,
    /// The light that each brings if nothing is in its way.
    lights: Vec<EightLights>,
    /// V = 0, a bit for each.
    pub(crate) blocked: Vec<u32>,
}

/// What arrives at each point. Returns the number of shadow rays that this took.
pub fn arriving_light(
    scene: &Scene,
    points: &[EightPoints],
    shadows: &mut ShadowRays,
    arriving: &mut Vec<EightArriving>,
) -> u64 {
    let LinearRgb { r, g, b } = scene.ambient();
    let ambient = [r, g, b].map(|channel| F32x8([channel; LANES]));
    let mut shadow_rays = 0;
    arriving.clear();
    arriving.resize(points.len(), EightArriving { light: ambient, lit_by: [0; LANES] });
    for (number, light) in scene.lights().iter().enumerate() {
        simd::dispatch(AimShadowRays { light, points, shadows });
        shadow_rays += shadows.trace(scene, light);
        simd::dispatch(AddUnblocked { number, shadows, arriving });
    }
    shadow_rays
}

/// The shadow rays of points that face a light.
struct AimShadowRays<'w> {
    light: &'w Light,
    points: &'w [EightPoints],
    shadows: &'w mut ShadowRays,
}

impl SimdKernel for AimShadowRays<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { light, points, shadows: ShadowRays { rays, lights, .. } } = self;
        rays.clear();
        lights.clear();
        for points in points {
            let (faces, IncidentLight { light: [r, g, b], .. }) =
                incident_light::<N>(light, points.position.load(), points.shading_normal.load());
            rays.push(eight_shadow_rays::<N>(light, points, faces.bits() & points.hit_mask));
            lights.push([r.store(), g.store(), b.store()]);
        }
    }
}

impl ShadowRays {
    /// Finds out which rays meet an object before the light. Returns how many of them were traced.
    fn trace(&mut self, scene: &Scene, light: &Light) -> u64 {
        if scene.shadows() {
            hit::any_hits(Kernel::Auto, scene, &self.rays, light.in_the_way(), &mut self.blocked);
            count(&self.rays)
        } else {
            self.blocked.clear();
            self.blocked.resize(self.rays.len(), 0);
            0
        }
    }
}

/// How many rays are asked about.
pub fn count(rays: &[EightRays]) -> u64 {
    rays.iter().map(|rays| u64::from(rays.active.count_ones())).sum()
}

/// What the light of that number adds to what arrives.
struct AddUnblocked<'w> {
    number: usize,
    shadows: &'w ShadowRays,
    arriving: &'w mut [EightArriving],
}

impl SimdKernel for AddUnblocked<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { number, shadows: ShadowRays { rays, lights, blocked }, arriving } = self;
        for (at, arriving) in arriving.iter_mut().enumerate() {
            let lit = rays[at].active & !blocked[at];
            for (sum, more) in arriving.light.iter_mut().zip(&lights[at]) {
                let dark = N::load(sum);
                *sum = N::select(N::mask_from_bits(lit), dark + N::load(more), dark).store();
            }
            for (lane, lit_by) in arriving.lit_by.iter_mut().enumerate() {
                *lit_by |= (lit >> lane & 1) << (number % 32);
            }
        }
    }
}

/// A ray to the light from each point.
pub fn shadow_rays(light: &Light, points: &[EightPoints], rays: &mut Vec<EightRays>) {
    rays.clear();
    simd::dispatch(Shadows { light, points, rays });
}

struct Shadows<'w> {
    light: &'w Light,
    points: &'w [EightPoints],
    rays: &'w mut Vec<EightRays>,
}

impl SimdKernel for Shadows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        for points in self.points {
            self.rays.push(eight_shadow_rays::<N>(self.light, points, points.hit_mask));
        }
    }
}

/// [`shadow_ray`] from those of the points that are asked about.
#[inline(always)]
fn eight_shadow_rays<N: Lanes>(light: &Light, points: &EightPoints, active: u32) -> EightRays {
    let origin = points.position.load() + points.geometric_normal.load() * N::load(&points.clearance);
    let direction = light.to_light(origin);
    let rays = EightRays { origin: origin.store(), direction: direction.store(), active };
    if active == ALL || active == 0 {
        return rays;
    }
    let (one, is_active) = (rays.ray(active.trailing_zeros() as usize % LANES), N::mask_from_bits(active));
    EightRays {
        origin: Vector::select(is_active, origin, Vector::splat(one.origin)).store(),
        direction: Vector::select(is_active, direction, Vector::splat(one.direction)).store(),
        active,
    }
}

/// What goes to the eye: the reflected part of the light that arrives, or the background where nothing was hit. The rays'
/// neighbours in the picture differ from them by these steps.
pub fn reflect(
    scene: &Scene,
    rays: &[EightRays],
    steps: [Vec3; 2],
    hits: &[EightHits],
    points: &[EightPoints],
    arriving: &[EightArriving],
    lights: &mut Vec<EightLights>,
) {
    lights.clear();
    simd::dispatch(Reflect { scene, rays, steps, hits, points, arriving, lights });
}

struct Reflect<'w> {
    scene: &'w Scene,
    rays: &'w [EightRays],
    steps: [Vec3; 2],
    hits: &'w [EightHits],
    points: &'w [EightPoints],
    arriving: &'w [EightArriving],
    lights: &'w mut Vec<EightLights>,
}

impl SimdKernel for Reflect<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        for (at, points) in self.points.iter().enumerate() {
            let mut light = [N::splat(0.0); 3];
            if points.hit_mask != ALL {
                light = backgrounds(self.scene, self.rays[at].direction.load());
            }
            let mut left = points.hit_mask;
            while left != 0 {
                let object = points.ids.id(left.trailing_zeros() as usize % LANES).object;
                let same = left & points.ids.mask_of_object::<N>(object);
                let reflectance = self.reflectances::<N>(&self.scene.objects()[object as usize], at, same);
                for (channel, light) in light.iter_mut().enumerate() {
                    let reflected = reflectance[channel] * N::load(&self.arriving[at].light[channel]);
                    *light = N::select(N::mask_from_bits(same), reflected, *light);
                }
                left &= !same;
            }
            let [r, g, b] = light;
            self.lights.push([r.store(), g.store(), b.store()]);
        }
    }
}

impl Reflect<'_> {
    /// The reflectances of an object at those of eight points that are its own.
    #[inline(always)]
    fn reflectances<N: Lanes>(&self, object: &Object, at: usize, own: u32) -> [N; 3] {
        let points = &self.points[at];
        match (&object.material, &object.shape) {
            (Material::Own, shape) => {
                let mut channels = [F32x8::ZERO; 3];
                for lane in set_bits(own) {
                    let reflectance = shape.primitive(points.ids.id(lane).index).own_reflectance(points.uv(lane));
                    let LinearRgb { r, g, b } = reflectance.unwrap_or(Material::DEFAULT_REFLECTANCE);
                    [channels[0].0[lane], channels[1].0[lane], channels[2].0[lane]] = [r, g, b];
                }
                [N::load(&channels[0]), N::load(&channels[1]), N::load(&channels[2])]
            }
            (material, shape) => {
                let uv = [N::load(&points.uv[0]), N::load(&points.uv[1])];
                let direction = self.rays[at].direction.load();
                material.reflectance(uv, shape.footprint(direction, N::load(&self.hits[at].t), self.steps))
            }
        }
    }
}

/// What one light does at a point, if nothing is in its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// The lecture's **l**: the direction to the light. Unit length.
    pub l: Vec3,
    /// The distance to the light; infinite if the light is infinitely far.
    pub distance: f32,
    /// n.l; not greater than 0 where the surface faces away from the light, which then does nothing.
    pub cosine: f32,
    /// I * n.l / d^2, or without the division where the light has no falloff.
    pub light: LinearRgb,
}

/// What the light does at the point, or nothing where the surface faces away from it.
pub fn incidence(light: &Light, point: &SurfacePoint) -> Option<Incidence> {
    Some(incidence_on_either_side(light, point)).filter(|incidence| 0.0 < incidence.cosine)
}

/// The same also where the surface faces away from the light.
pub fn incidence_on_either_side(light: &Light, point: &SurfacePoint) -> Incidence {
    let (position, normal) = (Vector::<f32>::splat(point.position), Vector::splat(point.shading_normal));
    let (_, IncidentLight { l, distance, cosine, light: [r, g, b] }) = incident_light(light, position, normal);
    let distance = if light.position().is_some() { distance } else { f32::INFINITY };
    Incidence { l: l.into(), distance, cosine, light: LinearRgb::new(r, g, b) }
}

/// [`Incidence`] at one point or several.
struct IncidentLight<N> {
    l: Vector<N>,
    distance: N,
    cosine: N,
    light: [N; 3],
}

/// What the light does at points, and whether the surface there faces it.
#[inline(always)]
fn incident_light<N: Number>(light: &Light, position: Vector<N>, normal: Vector<N>) -> (N::Mask, IncidentLight<N>) {
    let to_light = light.to_light(position);
    let distance_squared = to_light.dot(to_light);
    let distance = distance_squared.sqrt();
    let l = Vector { x: to_light.x / distance, y: to_light.y / distance, z: to_light.z / distance };
    let cosine = normal.dot(l);
    let light = light.irradiance(l, distance_squared, cosine).map(|channel| channel.min(N::splat(MAX_IRRADIANCE)));
    // No also for NaN: a light that lies in the surface.
    (N::splat(0.0).lt(cosine), IncidentLight { l, distance, cosine, light })
}

/// A light nearly in its surface may be brighter than f32 can say. Bounded by this, all sums and products that follow are
/// numbers: NaN has other bits on other CPUs. (`min` of NaN and a number is the number.)
const MAX_IRRADIANCE: f32 = 1e30;

/// The ray from a point to a light. The light is at t = 1, or infinitely far.
pub fn shadow_ray(light: &Light, point: &SurfacePoint) -> Ray {
    let origin = point.ray_origin();
    Ray { origin, direction: light.to_light(Vector::<f32>::splat(origin)).into() }
}

/// The light that comes along rays that meet nothing.
#[inline(always)]
fn backgrounds<N: Number>(scene: &Scene, direction: Vector<N>) -> [N; 3] {
    let channels = |LinearRgb { r, g, b }: LinearRgb| [N::splat(r), N::splat(g), N::splat(b)];
    match scene.background() {
        Background::Color(color) => channels(color),
        Background::Gradient { bottom, top } => {
            let up = direction.y * (N::splat(1.0) / direction.dot(direction).sqrt());
            let share = N::splat(0.5) * (up + N::splat(1.0));
            let ([r0, g0, b0], [r1, g1, b1]) = (channels(bottom), channels(top));
            let rest = N::splat(1.0) - share;
            [r0 * rest + r1 * share, g0 * rest + g1 * share, b0 * rest + b1 * share]
        }
    }
}
