//! Shading: the light from surfaces to the eye (lecture, "Shading").
//!
//! Direct light, reflected diffusely:
//!
//! ```text
//! L = reflectance * (ambient + sum over lights of V * I * max(0, n.l) / d^2)
//! ```
//!
//! The visibility V is 0 if an object is between the point and the light, else 1; n is the shading normal on the
//! visible side, l the unit vector to the light, d the distance to the light. The intensity I includes the 1/pi of
//! diffuse reflection, and of a spot the share of its light in that direction. The position of the eye only decides
//! which side of the surface is visible.
//!
//! All steps work on groups of eight rays. Lanes without a hit are computed as well, because branches would cost more
//! than they save; no later step reads these lanes.

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

mod bounces;
mod points;

pub use bounces::{Bounces, Generation};
pub use points::{EightPoints, surface_points};

/// The light along eight rays, per channel.
pub type EightLights = [F32x8; 3];

/// Returns the light along one of eight rays.
#[inline(always)]
pub fn lane_light([r, g, b]: &EightLights, lane: usize) -> LinearRgb {
    LinearRgb::new(r.0[lane], g.0[lane], b.0[lane])
}

/// The light that arrives at eight surface points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightArriving {
    /// The sum ambient + sum over lights of V * I * max(0, n.l) / d^2.
    pub light: EightLights,
    /// The mask of lights that reach each point; light 32 shares its bit with light 0, and so on.
    // Adaptive sampling compares the masks to find edges of shadows. For that, 32 bits are enough in all but contrived
    // scenes.
    pub lit_by: [u32; LANES],
}

/// The shadow rays to one light, as arrays with an entry for each group of eight points.
#[derive(Default)]
pub struct ShadowRays {
    pub(crate) rays: Vec<EightRays>,
    /// The light that arrives along each ray if it is not blocked.
    lights: Vec<EightLights>,
    /// The mask of blocked rays of each group, for which V = 0.
    pub(crate) blocked: Vec<u32>,
}

/// Computes the light that arrives at each point, and returns the number of traced shadow rays.
// Loops over lights, not over points, because shadow rays that end at the same light make good packets.
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

/// The SIMD kernel that makes the shadow rays of points that face a light.
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
            let (reaches, IncidentLight { light: [r, g, b], .. }) =
                incident_light::<N>(light, points.position.load(), points.shading_normal.load());
            rays.push(eight_shadow_rays::<N>(light, points, reaches.bits() & points.hit_mask));
            lights.push([r.store(), g.store(), b.store()]);
        }
    }
}

impl ShadowRays {
    /// Finds the blocked rays, and returns the number of traced rays.
    fn trace(&mut self, scene: &Scene, light: &Light) -> u64 {
        if scene.shadows() {
            hit::any_hits(Kernel::Auto, scene, &self.rays, light.blocking_interval(), &mut self.blocked);
            count(&self.rays)
        } else {
            self.blocked.clear();
            self.blocked.resize(self.rays.len(), 0);
            0
        }
    }
}

/// Returns the number of active rays in groups of eight.
pub fn count(rays: &[EightRays]) -> u64 {
    rays.iter().map(|rays| u64::from(rays.active.count_ones())).sum()
}

/// The SIMD kernel that adds a light's unblocked contributions to the arriving light.
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

/// Makes a shadow ray from each point to a light, even from points that face away from it.
pub fn shadow_rays(light: &Light, points: &[EightPoints], rays: &mut Vec<EightRays>) {
    rays.clear();
    simd::dispatch(Shadows { light, points, rays });
}

/// The SIMD kernel of [`shadow_rays`].
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

/// Returns the shadow rays of the points in the mask `active`, as [`shadow_ray`] makes them.
#[inline(always)]
fn eight_shadow_rays<N: Lanes>(light: &Light, points: &EightPoints, active: u32) -> EightRays {
    let origin = points.position.load() + points.geometric_normal.load() * N::load(&points.clearance);
    let direction = light.to_light(origin);
    let rays = EightRays { origin: origin.store(), direction: direction.store(), active };
    if active == ALL || active == 0 {
        return rays;
    }
    // Inactive lanes repeat an active ray, so that they do not widen the bounds of the group.
    let (one, is_active) = (rays.ray(active.trailing_zeros() as usize % LANES), N::mask_from_bits(active));
    EightRays {
        origin: Vector::select(is_active, origin, Vector::splat(one.origin)).store(),
        direction: Vector::select(is_active, direction, Vector::splat(one.direction)).store(),
        active,
    }
}

/// Computes the light that each ray carries to the eye: reflected light, or the background's
/// without a hit.
///
/// `direction_steps` are the differences in direction to the neighbouring eye rays, to the right and upwards.
/// Footprints are computed from them.
pub fn reflected_light(
    scene: &Scene,
    rays: &[EightRays],
    direction_steps: [Vec3; 2],
    hits: &[EightHits],
    points: &[EightPoints],
    arriving: &[EightArriving],
    lights: &mut Vec<EightLights>,
) {
    lights.clear();
    simd::dispatch(Reflect { scene, rays, direction_steps, hits, points, arriving, lights });
}

/// The SIMD kernel of [`reflected_light`].
struct Reflect<'w> {
    scene: &'w Scene,
    rays: &'w [EightRays],
    direction_steps: [Vec3; 2],
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
            // The loop is over the objects that were hit: most groups of eight rays hit a single object, whose material
            // is then evaluated for all lanes at once.
            let mut remaining = points.hit_mask;
            while remaining != 0 {
                let object = points.ids.id(remaining.trailing_zeros() as usize % LANES).object;
                let same = remaining & points.ids.mask_of_object::<N>(object);
                let reflectance = self.reflectances::<N>(&self.scene.objects()[object as usize], at, same);
                for (channel, light) in light.iter_mut().enumerate() {
                    let reflected = reflectance[channel] * N::load(&self.arriving[at].light[channel]);
                    *light = N::select(N::mask_from_bits(same), reflected, *light);
                }
                remaining &= !same;
            }
            let [r, g, b] = light;
            self.lights.push([r.store(), g.store(), b.store()]);
        }
    }
}

impl Reflect<'_> {
    /// Returns the reflectances of an object at the points of group `at`; lanes outside the mask
    /// `own` are unspecified.
    #[inline(always)]
    fn reflectances<N: Lanes>(&self, object: &Object, at: usize, own: u32) -> [N; 3] {
        let points = &self.points[at];
        match (&object.material, &object.shape) {
            // The colours of a mesh differ by triangle and come from textures, those of an implicit surface come from
            // formulas, so both are computed lane by lane.
            (Material::Own, shape) => {
                let mut channels = [F32x8::ZERO; 3];
                for lane in set_bits(own) {
                    let (index, position) = (points.ids.id(lane).index, points.position.of_lane(lane));
                    let reflectance = shape.primitive(index).own_reflectance(position, points.uv(lane));
                    let LinearRgb { r, g, b } = reflectance.unwrap_or(Material::DEFAULT_REFLECTANCE);
                    [channels[0].0[lane], channels[1].0[lane], channels[2].0[lane]] = [r, g, b];
                }
                [N::load(&channels[0]), N::load(&channels[1]), N::load(&channels[2])]
            }
            (material, shape) => {
                let uv = [N::load(&points.uv[0]), N::load(&points.uv[1])];
                let (direction, t) = (self.rays[at].direction.load(), N::load(&self.hits[at].t));
                let normal = || points.geometric_normal.load();
                material.reflectance(uv, shape.footprint(direction, t, normal, self.direction_steps))
            }
        }
    }
}

/// The light that arrives at a point from one light source, if it is not blocked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// The direction to the light, **l** in the lecture. Unit length.
    pub l: Vec3,
    /// The distance to the light in world units, possibly infinite.
    pub distance: f32,
    /// The cosine n.l; at most 0 if the surface faces away from the light.
    pub cosine: f32,
    /// The arriving light I * n.l / d^2, or I * n.l for a light without falloff.
    pub light: LinearRgb,
}

/// Returns the incidence of a light at a point, or `None` if the surface faces away or is outside
/// the light's cone.
pub fn incidence(light: &Light, point: &SurfacePoint) -> Option<Incidence> {
    let (reaches, incidence) = incidence_anywhere(light, point);
    reaches.then_some(incidence)
}

/// Returns the incidence of a light at a point, also if the surface faces away.
pub fn incidence_with_signed_cosine(light: &Light, point: &SurfacePoint) -> Incidence {
    incidence_anywhere(light, point).1
}

/// Returns whether a light reaches a point that nothing hides, and its incidence there.
fn incidence_anywhere(light: &Light, point: &SurfacePoint) -> (bool, Incidence) {
    let (position, normal) = (Vector::<f32>::splat(point.position), Vector::splat(point.shading_normal));
    let (reaches, IncidentLight { l, distance, cosine, light: [r, g, b] }) = incident_light(light, position, normal);
    let distance = if light.position().is_some() { distance } else { f32::INFINITY };
    (reaches, Incidence { l: l.into(), distance, cosine, light: LinearRgb::new(r, g, b) })
}

/// The values of [`Incidence`] at one point, or at one point per lane.
struct IncidentLight<N> {
    l: Vector<N>,
    distance: N,
    cosine: N,
    light: [N; 3],
}

/// Returns the mask of points that face a light and are inside its cone, and the light that arrives
/// there.
#[inline(always)]
fn incident_light<N: Number>(light: &Light, position: Vector<N>, normal: Vector<N>) -> (N::Mask, IncidentLight<N>) {
    let to_light = light.to_light(position);
    let distance_squared = to_light.dot(to_light);
    let distance = distance_squared.sqrt();
    let l = Vector { x: to_light.x / distance, y: to_light.y / distance, z: to_light.z / distance };
    let cosine = normal.dot(l);
    // The comparison is also false for NaN, the cosine if the light is at the point itself.
    let faces = N::splat(0.0).lt(cosine);
    let reaches = match light.shines_along(l) {
        Some(shines) => faces & shines,
        None => faces,
    };
    let light =
        light.irradiance_over_pi(l, distance_squared, cosine).map(|channel| channel.min(N::splat(MAX_IRRADIANCE)));
    (reaches, IncidentLight { l, distance, cosine, light })
}

/// The largest arriving light per channel and light source.
// The light of a source very near the surface would overflow f32 to infinity. Infinity times 0 is NaN, whose bits
// differ between CPUs. With this limit all later sums and products are finite; `min` of NaN and the limit is the limit.
const MAX_IRRADIANCE: f32 = 1e30;

/// Returns the shadow ray from a point to a light. The light is at t = 1, or infinitely far away.
pub fn shadow_ray(light: &Light, point: &SurfacePoint) -> Ray {
    let origin = point.ray_origin();
    Ray { origin, direction: light.to_light(Vector::<f32>::splat(origin)).into() }
}

/// Returns the background's light along rays without a hit.
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
