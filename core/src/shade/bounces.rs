//! Bounced rays, which mirrors and glass reflect and refract, and their light.
//!
//! The rays of a batch are traced generation by generation, so that neighbouring rays stay in one packet. Each ray has
//! a weight, the part of its light that reaches the eye; a ray ends if its weight is too small to be seen.

use super::finishes::{EightFinishes, finish_surfaces};
use super::light_parts::PartShifts;
use super::{EightArriving, EightLights, EightPoints, Generation, ShadowRays, Surfaces};
use crate::color::LinearRgb;
use crate::finish::{self, Finish};
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{F32x8, LANES, Number, Vector, set_bits};
use crate::ray::{EightRays, Ray};
use crate::scene::{Object, Scene};
use glam::Vec3;

/// The smallest weight of a ray that is followed.
// A quarter of a step of 8-bit linear light, and so invisible unless what is reflected is brighter than white.
const MIN_WEIGHT: f32 = 1.0 / 1024.0;

/// The smallest weight of the weaker of the two rays into which glass splits a ray.
// The weights of the rays that one eye ray becomes add up to at most 1, so glass makes at most 256 of it.
const MIN_SPLIT_WEIGHT: f32 = 1.0 / 256.0;

/// The number of rays that rough metal mirrors at once.
const SPREAD: u32 = 8;

/// The smallest weight of a ray that rough metal mirrors as [`SPREAD`] rays instead of one.
// The rays of a spread have at most an eighth, so that they are not spread again.
const MIN_SPREAD_WEIGHT: f32 = 0.25;

/// A ray that a surface has reflected, refracted or let through.
#[derive(Clone, Copy, Debug)]
struct BouncedRay {
    ray: Ray,
    /// The sum of t from the eye to the ray's origin.
    t: f32,
    /// The part of the ray's light that reaches the eye.
    weight: LinearRgb,
    /// The index of the eye ray in its batch.
    eye_ray: u32,
    /// The object in whose glass the ray is.
    inside: Option<u32>,
    /// The number of the eye ray's sample in its pixel.
    sample: u32,
    /// The number of the ray among those that rough metal mirrors at once.
    sibling: u32,
}

/// The bounced rays of a batch and the results of their steps, in buffers that are reused.
#[derive(Default)]
pub struct Bounces {
    current: Vec<BouncedRay>,
    next: Vec<BouncedRay>,
    rays: Vec<EightRays>,
    hits: Vec<EightHits>,
    points: Vec<EightPoints>,
    shadows: ShadowRays,
    arriving: Vec<EightArriving>,
    /// The light that the surfaces would send to the rays' origins if they were opaque.
    surface_lights: Vec<EightLights>,
    finishes: Vec<EightFinishes>,
    samples: Vec<u32>,
}

impl Bounces {
    /// Adds the light of bounced rays to that of eye rays.
    ///
    /// Light of surfaces that are not matte is replaced. Returns the number of traced rays.
    ///
    /// `lights` has the diffusely reflected light of `eye`. For `direction_steps` see
    /// [`reflected_light`](super::reflected_light).
    pub fn add(
        &mut self,
        scene: &Scene,
        direction_steps: [Vec3; 2],
        eye: &Generation<'_>,
        lights: &mut [EightLights],
    ) -> u64 {
        self.next.clear();
        finish_surfaces(scene, direction_steps, eye, lights, &mut self.finishes);
        for (group, finishes) in self.finishes.iter().enumerate() {
            for lane in set_bits(finishes.bouncing) {
                let ray = BouncedRay {
                    ray: eye.rays[group].ray(lane),
                    t: 0.0,
                    weight: LinearRgb::grey(1.0),
                    eye_ray: (group * LANES + lane) as u32,
                    inside: None,
                    sample: eye.samples.get(group * LANES + lane).copied().unwrap_or(0),
                    sibling: 0,
                };
                let surface = Surface::new(scene, &eye.points[group], finishes, lane, eye.hits[group].t.0[lane]);
                let light = surface.light(&ray, super::lane_light(&lights[group], lane), &mut self.next);
                put(&mut lights[group], lane, light);
            }
        }
        let mut traced = 0;
        for _ in 0..scene.bounces() {
            if self.next.is_empty() {
                break;
            }
            std::mem::swap(&mut self.current, &mut self.next);
            traced += self.trace(scene, direction_steps, lights);
        }
        traced
    }

    /// Traces the current generation, adds its light to the eye rays, and makes the next one.
    fn trace(&mut self, scene: &Scene, direction_steps: [Vec3; 2], lights: &mut [EightLights]) -> u64 {
        let Self { current, next, rays, hits, points, shadows, arriving, surface_lights, finishes, samples } = self;
        rays.clear();
        rays.extend(current.chunks(LANES).map(|group| {
            let mut eight = [current[0].ray; LANES];
            eight.iter_mut().zip(group).for_each(|(ray, bounced)| *ray = bounced.ray);
            EightRays::of(&eight[..group.len()])
        }));
        hit::closest_hits(Kernel::Auto, scene, rays, hits);
        super::surface_points(scene, rays, hits, points);
        // Footprints grow with the whole way from the eye, as directions keep their length.
        for (at, ray) in current.iter().enumerate() {
            hits[at / LANES].t.0[at % LANES] += ray.t;
        }
        samples.clear();
        samples.extend(current.iter().map(|ray| ray.sample));
        let surfaces = Surfaces { rays, points, samples };
        let traced = current.len() as u64 + super::arriving_light(scene, &surfaces, shadows, arriving);
        super::reflected_light(scene, rays, direction_steps, hits, points, arriving, surface_lights);
        if scene.has_emission() {
            super::add_emission(scene, points, surface_lights);
        }
        let generation = Generation { rays, hits, points, shadows, samples };
        finish_surfaces(scene, direction_steps, &generation, surface_lights, finishes);
        next.clear();
        for (at, ray) in current.iter().enumerate() {
            let (group, lane) = (at / LANES, at % LANES);
            let mut light = super::lane_light(&surface_lights[group], lane);
            let is_hit = points[group].hit_mask >> lane & 1 == 1;
            let t = if is_hit { hits[group].t.0[lane] - ray.t } else { f32::INFINITY };
            // Glass keeps the fog out.
            let fog = scene.fog().filter(|_| ray.inside.is_none());
            let transmittance = fog.map_or(1.0, |fog| fog.transmittance(t * ray.ray.direction.length()));
            if finishes[group].bouncing >> lane & 1 == 1 {
                let surface = Surface::new(scene, &points[group], &finishes[group], lane, t);
                light = surface.light(&BouncedRay { weight: ray.weight * transmittance, ..*ray }, light, next);
            }
            if let Some(fog) = fog {
                light = fog.dimmed(light, transmittance);
            }
            let (group, lane) = (ray.eye_ray as usize / LANES, ray.eye_ray as usize % LANES);
            let sum = super::lane_light(&lights[group], lane) + light * ray.weight;
            put(&mut lights[group], lane, sum);
        }
        traced
    }
}

/// The surface that a ray has met.
struct Surface<'a> {
    object: &'a Object,
    points: &'a EightPoints,
    finishes: &'a EightFinishes,
    lane: usize,
    /// The t of the ray's hit.
    t: f32,
}

impl<'a> Surface<'a> {
    fn new(scene: &'a Scene, points: &'a EightPoints, finishes: &'a EightFinishes, lane: usize, t: f32) -> Self {
        Self { object: &scene.objects()[points.ids.id(lane).object as usize], points, finishes, lane, t }
    }

    /// Returns the light towards the ray's origin, without that of bounced rays.
    ///
    /// Bounced rays are added to `next`.
    ///
    /// `light` is that of an opaque surface.
    fn light(&self, ray: &BouncedRay, light: LinearRgb, next: &mut Vec<BouncedRay>) -> LinearRgb {
        let index = self.points.ids.id(self.lane).index;
        let opacity = self.object.opacity_at(index, &self.points.own_point(self.lane));
        if opacity < 1.0 {
            self.add_passing(ray, 1.0 - opacity, next);
        }
        let ray = &BouncedRay { weight: ray.weight * opacity, ..*ray };
        let part = super::lane_light(&self.finishes.part, self.lane);
        match self.object.finish {
            Finish::Matte | Finish::Shiny { .. } | Finish::Glowing { .. } => {}
            Finish::Metal { roughness: 0.0 } | Finish::Polished { .. } => {
                self.add_mirrored(self.mirrored_direction(), ray, part, next);
            }
            Finish::Metal { roughness } => self.add_rough_reflections(ray, roughness, part, next),
            Finish::Glass { index } => self.add_split(ray, index, part, next),
        }
        light * opacity
    }

    fn shading_normal(&self) -> Vec3 {
        self.points.shading_normal.of_lane(self.lane)
    }

    fn geometric_normal(&self) -> Vec3 {
        self.points.geometric_normal.of_lane(self.lane)
    }

    fn mirrored_direction(&self) -> Vec3 {
        self.finishes.direction.of_lane(self.lane)
    }

    /// Returns the index of the object in the scene.
    fn object_index(&self) -> u32 {
        self.points.ids.id(self.lane).object
    }

    /// Adds the ray that passes straight through the surface; `part` is its part of the light.
    fn add_passing(&self, ray: &BouncedRay, part: f32, next: &mut Vec<BouncedRay>) {
        let passing = Ray { origin: self.origin_behind(ray), direction: ray.ray.direction };
        let weight = LinearRgb::grey(part);
        // A ray that passes the surface of glass is inside it, or outside again.
        let inside = match self.object.finish {
            Finish::Glass { .. } if ray.inside == Some(self.object_index()) => None,
            Finish::Glass { .. } => Some(self.object_index()),
            _ => ray.inside,
        };
        add(next, BouncedRay { ray: passing, t: ray.t + self.t, weight, inside, ..*ray }, ray);
    }

    /// Returns the origin of a ray that leaves the surface on the side away from the ray that met
    /// it.
    fn origin_behind(&self, ray: &BouncedRay) -> Vec3 {
        let (position, clearance) = (self.points.position.of_lane(self.lane), self.points.clearance.0[self.lane]);
        super::origin_behind(position, self.geometric_normal(), clearance, ray.ray.at(self.t))
    }

    /// Adds the rays that glass mirrors and refracts.
    fn add_split(&self, ray: &BouncedRay, index: f32, reflectance: LinearRgb, next: &mut Vec<BouncedRay>) {
        let is_leaving = ray.inside == Some(self.object_index());
        let ratio = if is_leaving { index } else { 1.0 / index };
        let [direction, normal] = [ray.ray.direction, self.shading_normal()].map(Vector::<f32>::splat);
        let mirrored = followed_part(finish::mirrored_part(direction, normal, ratio), ray.weight);
        self.add_mirrored(self.mirrored_direction(), ray, LinearRgb::grey(mirrored), next);
        if mirrored < 1.0 {
            // Light is coloured once on its way through, where it enters.
            let color = if is_leaving { LinearRgb::grey(1.0) } else { reflectance };
            self.add_refraction(ray, ratio, is_leaving, color * (1.0 - mirrored), next);
        }
    }

    /// Adds the refracted ray; `weight` is its part of the light.
    fn add_refraction(
        &self,
        ray: &BouncedRay,
        ratio: f32,
        is_leaving: bool,
        weight: LinearRgb,
        next: &mut Vec<BouncedRay>,
    ) {
        let direction = ray.ray.direction;
        // As with mirrored rays, an interpolated normal may refract the ray back out of the surface.
        let refracted = finish::refract(direction, self.shading_normal(), ratio)
            .filter(|refracted| refracted.dot(self.geometric_normal()) < 0.0)
            .or_else(|| finish::refract(direction, self.geometric_normal(), ratio));
        let Some(direction) = refracted else { return };
        let refracted = Ray { origin: self.origin_behind(ray), direction };
        let inside = if is_leaving { None } else { Some(self.object_index()) };
        add(next, BouncedRay { ray: refracted, t: ray.t + self.t, weight, inside, ..*ray }, ray);
    }

    /// Adds the rays that facets of rough metal mirror.
    fn add_rough_reflections(
        &self,
        ray: &BouncedRay,
        roughness: f32,
        reflectance: LinearRgb,
        next: &mut Vec<BouncedRay>,
    ) {
        let shifts = PartShifts::of(&[ray.sample]);
        let geometric_normal = Vector::<f32>::splat(self.geometric_normal());
        let mut add = |part: u32, sibling: u32, weight: LinearRgb| {
            let part = shifts.position::<F32x8>(part).of_lane(0);
            let normal = Vector::splat(finish::facet_normal(self.shading_normal(), roughness, &part));
            let mut direction = finish::reflect(Vector::splat(ray.ray.direction), normal);
            // A ray that a facet mirrors into the surface is mirrored by another facet.
            if direction.dot(geometric_normal) <= 0.0 {
                direction = finish::reflect(direction, geometric_normal);
            }
            self.add_mirrored(direction.into(), &BouncedRay { sibling, ..*ray }, weight, next);
        };
        let LinearRgb { r, g, b } = ray.weight;
        if r.max(g).max(b) < MIN_SPREAD_WEIGHT {
            // Each of the rays that were mirrored at once takes another facet.
            add(ray.sibling, ray.sibling, reflectance);
        } else {
            (0..SPREAD).for_each(|part| add(part, part, reflectance * (1.0 / SPREAD as f32)));
        }
    }

    /// Adds the mirrored ray with this direction; `weight` is its part of the light.
    fn add_mirrored(&self, direction: Vec3, ray: &BouncedRay, weight: LinearRgb, next: &mut Vec<BouncedRay>) {
        let mirrored = Ray { origin: self.finishes.origin.of_lane(self.lane), direction };
        add(next, BouncedRay { ray: mirrored, t: ray.t + self.t, weight, ..*ray }, ray);
    }
}

/// Returns the mirrored part, or 0 or 1 if the weaker of both rays is too weak to be followed.
///
/// The other ray then has all of the light. `weight` is that of the ray before both.
fn followed_part(mirrored: f32, LinearRgb { r, g, b }: LinearRgb) -> f32 {
    let weight = <f32 as Number>::max(r, <f32 as Number>::max(g, b));
    if mirrored * weight < MIN_SPLIT_WEIGHT {
        0.0
    } else if (1.0 - mirrored) * weight < MIN_SPLIT_WEIGHT {
        1.0
    } else {
        mirrored
    }
}

/// Adds a ray whose weight is still relative to that of the ray `before`.
///
/// It is not added if the weight is too small or the ray has no direction.
fn add(next: &mut Vec<BouncedRay>, mut ray: BouncedRay, before: &BouncedRay) {
    ray.weight = ray.weight * before.weight;
    let LinearRgb { r, g, b } = ray.weight;
    // A weight or direction that is NaN ends the ray, too.
    if (r >= MIN_WEIGHT || g >= MIN_WEIGHT || b >= MIN_WEIGHT) && ray.ray.direction.length_squared() > 0.0 {
        next.push(ray);
    }
}

/// Stores the light of one lane.
fn put(lights: &mut EightLights, lane: usize, LinearRgb { r, g, b }: LinearRgb) {
    for (channel, value) in lights.iter_mut().zip([r, g, b]) {
        channel.0[lane] = value;
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
