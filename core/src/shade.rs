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

use crate::accel::PrimitiveId;
use crate::color::LinearRgb;
use crate::fog::Fog;
use crate::hit::EightHits;
use crate::lanes::{ALL, F32x8, LANES, Lanes, Number, Vector, set_bits};
use crate::light::{Light, PARTS, PartPosition};
use crate::material::Material;
use crate::ray::{EightRays, Ray};
use crate::scene::{Background, Object, Scene};
use crate::shape::SurfacePoint;
use crate::simd::{self, SimdKernel};
use glam::Vec3;

mod arriving;
mod bounces;
mod finishes;
mod light_parts;
mod points;
mod transparent_shadows;

pub use arriving::{EightArriving, ShadowRays, Surfaces, arriving_light, count, shadow_rays};
pub use bounces::Bounces;
pub use points::{EightPoints, surface_points};

/// The light along eight rays, per channel.
pub type EightLights = [F32x8; 3];

/// The results of the steps for one generation of rays, from the rays to the shadow rays of their
/// surface points.
pub struct Generation<'a> {
    /// The rays.
    pub rays: &'a [EightRays],
    /// The closest hits.
    pub hits: &'a [EightHits],
    /// The surface points of the hits.
    pub points: &'a [EightPoints],
    /// The shadow rays of the points, with the highlights that they found.
    pub shadows: &'a ShadowRays,
    /// The number of each ray's sample in its pixel; empty if all are 0.
    pub samples: &'a [u32],
}

/// Returns the light along one of eight rays.
#[inline(always)]
pub fn lane_light([r, g, b]: &EightLights, lane: usize) -> LinearRgb {
    LinearRgb::new(r.0[lane], g.0[lane], b.0[lane])
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
    let materials = MaterialsAtPoints { rays, direction_steps, hits, points };
    simd::dispatch(Reflect { scene, materials, arriving, lights });
}

/// Adds the light that surfaces send out by the files of their meshes to the light along the rays.
pub fn add_emission(scene: &Scene, points: &[EightPoints], lights: &mut [EightLights]) {
    for (points, lights) in points.iter().zip(lights) {
        for lane in set_bits(points.hit_mask) {
            let PrimitiveId { object, index } = points.ids.id(lane);
            let object = &scene.objects()[object as usize];
            if object.has_emission() {
                let light = object.emission_at(index, &points.own_point(lane));
                for (sum, more) in lights.iter_mut().zip([light.r, light.g, light.b]) {
                    sum.0[lane] += more;
                }
            }
        }
    }
}

/// The SIMD kernel of [`reflected_light`].
struct Reflect<'w> {
    scene: &'w Scene,
    materials: MaterialsAtPoints<'w>,
    arriving: &'w [EightArriving],
    lights: &'w mut Vec<EightLights>,
}

impl SimdKernel for Reflect<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        for (at, points) in self.materials.points.iter().enumerate() {
            let mut light = [N::splat(0.0); 3];
            if points.hit_mask != ALL {
                light = backgrounds(self.scene, self.materials.rays[at].direction.load());
            }
            // The loop is over the objects that were hit: most groups of eight rays hit a single object, whose material
            // is then evaluated for all lanes at once.
            let mut remaining = points.hit_mask;
            while remaining != 0 {
                let object = points.ids.id(remaining.trailing_zeros() as usize % LANES).object;
                let same = remaining & points.ids.mask_of_object::<N>(object);
                let reflectance = self.materials.reflectances::<N>(&self.scene.objects()[object as usize], at, same);
                for (channel, light) in light.iter_mut().enumerate() {
                    let reflected = reflectance[channel] * N::load(&self.arriving[at].light[channel]);
                    *light = N::select(N::mask_from_bits(same), reflected, *light);
                }
                remaining &= !same;
            }
            self.lights.push(stored(light));
        }
    }
}

/// The materials at surface points, in arrays with an entry for each group of eight rays.
struct MaterialsAtPoints<'w> {
    rays: &'w [EightRays],
    /// The differences in direction to the neighbouring eye rays, for footprints.
    direction_steps: [Vec3; 2],
    hits: &'w [EightHits],
    points: &'w [EightPoints],
}

impl MaterialsAtPoints<'_> {
    /// Returns the reflectances of an object at the points of group `at`; lanes outside the mask
    /// `own` are unspecified.
    #[inline(always)]
    fn reflectances<N: Lanes>(&self, object: &Object, at: usize, own: u32) -> [N; 3] {
        let points = &self.points[at];
        match (&object.material, &object.shape) {
            // The colours of a mesh differ by triangle and come from textures, those of an implicit surface come from
            // formulas, those of a picture from its texels, so all are computed lane by lane.
            (Material::Own, _) => {
                let mut channels = [F32x8::ZERO; 3];
                for lane in set_bits(own) {
                    let reflectance = object.own_reflectance(points.ids.id(lane).index, &points.own_point(lane));
                    let LinearRgb { r, g, b } = reflectance.unwrap_or(Material::DEFAULT_REFLECTANCE);
                    [channels[0].0[lane], channels[1].0[lane], channels[2].0[lane]] = [r, g, b];
                }
                loaded(&channels)
            }
            (material, shape) => {
                let uv = [N::load(&points.uv[0]), N::load(&points.uv[1])];
                let mut footprint = [N::splat(0.0); 2];
                // The footprint on a placed box or torus takes longer than the rest of shading.
                if material.is_patterned() {
                    let (direction, t) = (self.rays[at].direction.load(), N::load(&self.hits[at].t));
                    let normal = || points.geometric_normal.load();
                    footprint = shape.footprint(direction, t, normal, self.direction_steps);
                }
                material.reflectance(uv, footprint)
            }
        }
    }
}

// Written out: closures of `map` that are not inlined have no target features, so that their vectors pass through
// memory.
#[inline(always)]
fn loaded<N: Lanes>([r, g, b]: &EightLights) -> [N; 3] {
    [N::load(r), N::load(g), N::load(b)]
}

#[inline(always)]
fn stored<N: Lanes>([r, g, b]: [N; 3]) -> EightLights {
    [r.store(), g.store(), b.store()]
}

#[inline(always)]
fn scaled<N: Number>([r, g, b]: [N; 3], factor: N) -> [N; 3] {
    [r * factor, g * factor, b * factor]
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
    light_from(light, light.to_light(position), normal)
}

/// The share of a part in the light of the whole.
const PART_SHARE: f32 = 1.0 / PARTS as f32;

/// Returns the mask of points that face a part of a light, and the light of the part that arrives
/// there.
#[inline(always)]
fn incident_light_of_part<N: Number>(
    light: &Light,
    part: &PartPosition<N>,
    position: Vector<N>,
    normal: Vector<N>,
) -> (N::Mask, IncidentLight<N>) {
    let (reaches, incident) = light_from(light, light.to_part(position, part), normal);
    (reaches, IncidentLight { light: scaled(incident.light, N::splat(PART_SHARE)), ..incident })
}

/// Returns the mask of points that face a light, and the light that arrives there along `to_light`.
#[inline(always)]
fn light_from<N: Number>(light: &Light, to_light: Vector<N>, normal: Vector<N>) -> (N::Mask, IncidentLight<N>) {
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
    // Without `map`, as in `scaled`: its closures took 3 % of a frame.
    let ([r, g, b], most) = (light.irradiance_over_pi(l, distance_squared, cosine), N::splat(MAX_IRRADIANCE));
    (reaches, IncidentLight { l, distance, cosine, light: [r.min(most), g.min(most), b.min(most)] })
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

/// Returns the origin of a ray that goes on behind a surface.
///
/// `position`, `normal` and `clearance` are those of the surface point, and `met` is the point of the ray that met it.
fn origin_behind(position: Vec3, normal: Vec3, clearance: f32, met: Vec3) -> Vec3 {
    // The position may be that of a smooth surface, above the triangle; the new ray starts below the triangle.
    let lift = (position - met).dot(normal).max(0.0);
    position - normal * (clearance + lift)
}

/// Adds fog between the eye and what each ray hits to the light along the rays.
pub fn add_fog(fog: &Fog, rays: &[EightRays], hits: &[EightHits], lights: &mut [EightLights]) {
    for ((rays, hits), lights) in rays.iter().zip(hits).zip(lights) {
        for lane in 0..LANES {
            let is_hit = hits.hit_mask >> lane & 1 == 1;
            let t = if is_hit { hits.t.0[lane] } else { f32::INFINITY };
            let way = t * rays.direction.of_lane(lane).length();
            let LinearRgb { r, g, b } = fog.dimmed(lane_light(lights, lane), fog.transmittance(way));
            [lights[0].0[lane], lights[1].0[lane], lights[2].0[lane]] = [r, g, b];
        }
    }
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

#[cfg(all(test, unit_tests))]
pub mod tests;
