//! Bounced rays, which mirrors and glass reflect and refract, and their light.
//!
//! The rays of a batch are traced generation by generation, so that neighbouring rays stay in one packet. Each ray has
//! a weight, the part of its light that reaches the eye; a ray ends if its weight is too small to be seen.

use super::light_parts::PartShifts;
use super::{EightArriving, EightLights, EightPoints, ShadowRays, Surfaces};
use crate::accel::PrimitiveId;
use crate::color::LinearRgb;
use crate::finish::{self, Finish};
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{F32x8, LANES, Number};
use crate::ray::{EightRays, Ray};
use crate::scene::Scene;
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
    /// The diffusely reflected light.
    diffuse: Vec<EightLights>,
    reflectances: Reflectances,
    samples: Vec<u32>,
}

/// The results of the steps for one generation of rays, from eye rays to diffusely reflected light.
pub struct Generation<'a> {
    /// The rays.
    pub rays: &'a [EightRays],
    /// The closest hits.
    pub hits: &'a [EightHits],
    /// The surface points of the hits.
    pub points: &'a [EightPoints],
    /// The light that arrives at the points.
    pub arriving: &'a [EightArriving],
    /// The shadow rays of the points, with the highlights that they found.
    pub shadows: &'a ShadowRays,
    /// The number of each ray's sample in its pixel; empty if all are 0.
    pub samples: &'a [u32],
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
        if eye.points.iter().all(|points| finished_lanes(scene, points).next().is_none()) {
            return 0;
        }
        self.next.clear();
        self.reflectances.find(scene, direction_steps, eye);
        for (group, points) in eye.points.iter().enumerate() {
            for lane in finished_lanes(scene, points) {
                let ray = BouncedRay {
                    ray: eye.rays[group].ray(lane),
                    t: 0.0,
                    weight: LinearRgb::grey(1.0),
                    eye_ray: (group * LANES + lane) as u32,
                    inside: None,
                    sample: eye.samples.get(group * LANES + lane).copied().unwrap_or(0),
                    sibling: 0,
                };
                let reflectance = super::lane_light(&self.reflectances.found[group], lane);
                let surface = Surface::of(scene, points, lane, eye.hits[group].t.0[lane], reflectance);
                let diffuse = super::lane_light(&lights[group], lane);
                let light = surface.light(&ray, diffuse, eye.shadows.highlight(group, lane), &mut self.next);
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
        let Self { current, next, rays, hits, points, shadows, arriving, diffuse, reflectances, samples } = self;
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
        super::reflected_light(scene, rays, direction_steps, hits, points, arriving, diffuse);
        if scene.has_emission() {
            super::add_emission(scene, points, diffuse);
        }
        reflectances.find(scene, direction_steps, &Generation { rays, hits, points, arriving, shadows, samples });
        next.clear();
        for (at, ray) in current.iter().enumerate() {
            let (group, lane) = (at / LANES, at % LANES);
            let mut light = super::lane_light(&diffuse[group], lane);
            let is_hit = points[group].hit_mask >> lane & 1 == 1;
            let t = if is_hit { hits[group].t.0[lane] - ray.t } else { f32::INFINITY };
            // Glass keeps the fog out.
            let fog = scene.fog().filter(|_| ray.inside.is_none());
            let transmittance = fog.map_or(1.0, |fog| fog.transmittance(t * ray.ray.direction.length()));
            if is_finished(scene, &points[group], lane) {
                let reflectance = super::lane_light(&reflectances.found[group], lane);
                let surface = Surface::of(scene, &points[group], lane, t, reflectance);
                let dimmed = BouncedRay { weight: ray.weight * transmittance, ..*ray };
                light = surface.light(&dimmed, light, shadows.highlight(group, lane), next);
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

/// A surface that a ray meets, with its finish.
struct Surface {
    finish: Finish,
    opacity: f32,
    object: u32,
    position: Vec3,
    shading_normal: Vec3,
    geometric_normal: Vec3,
    clearance: f32,
    /// The t of the ray's hit.
    t: f32,
    reflectance: LinearRgb,
}

impl Surface {
    fn of(scene: &Scene, points: &EightPoints, lane: usize, t: f32, reflectance: LinearRgb) -> Self {
        let PrimitiveId { object, index } = points.ids.id(lane);
        let of_scene = &scene.objects()[object as usize];
        Self {
            finish: of_scene.finish,
            opacity: of_scene.opacity_at(index, &points.own_point(lane)),
            object,
            position: points.position.of_lane(lane),
            shading_normal: points.shading_normal.of_lane(lane),
            geometric_normal: points.geometric_normal.of_lane(lane),
            clearance: points.clearance.0[lane],
            t,
            reflectance,
        }
    }

    /// Returns the light towards the ray's origin, without that of bounced rays.
    ///
    /// Bounced rays are added to `next`.
    ///
    /// `diffuse` is the light that a matte surface would reflect, and `highlight` that of a highlight of strength 1.
    fn light(
        &self,
        ray: &BouncedRay,
        diffuse: LinearRgb,
        highlight: LinearRgb,
        next: &mut Vec<BouncedRay>,
    ) -> LinearRgb {
        if self.opacity < 1.0 {
            self.add_passing(ray, next);
        }
        let ray = &BouncedRay { weight: ray.weight * self.opacity, ..*ray };
        self.finished_light(ray, diffuse, highlight, next) * self.opacity
    }

    /// Returns the light of the part of the surface that is not transparent; `ray` has its weight.
    fn finished_light(
        &self,
        ray: &BouncedRay,
        diffuse: LinearRgb,
        highlight: LinearRgb,
        next: &mut Vec<BouncedRay>,
    ) -> LinearRgb {
        let direction = ray.ray.direction;
        let cosine = finish::cosine_of_incidence(direction, self.shading_normal);
        match self.finish {
            Finish::Matte => diffuse,
            Finish::Glowing { strength } => self.reflectance * strength,
            Finish::Shiny { strength, .. } => diffuse + highlight * strength,
            Finish::Metal { roughness: 0.0 } => {
                self.add_reflection(ray, self.reflectance, next);
                LinearRgb::BLACK
            }
            Finish::Metal { roughness } => {
                self.add_rough_reflections(ray, roughness, next);
                LinearRgb::BLACK
            }
            Finish::Polished { index } => {
                let mirrored = finish::fresnel(cosine, 1.0 / index);
                self.add_reflection(ray, LinearRgb::grey(mirrored), next);
                diffuse * (1.0 - mirrored)
            }
            Finish::Glass { index } => {
                let is_leaving = ray.inside == Some(self.object);
                let ratio = if is_leaving { index } else { 1.0 / index };
                let mirrored = followed_part(finish::fresnel(cosine, ratio), ray.weight);
                self.add_reflection(ray, LinearRgb::grey(mirrored), next);
                if mirrored < 1.0 {
                    self.add_refraction(ray, ratio, is_leaving, 1.0 - mirrored, next);
                }
                LinearRgb::BLACK
            }
        }
    }

    /// Adds the ray that passes straight through the surface.
    fn add_passing(&self, ray: &BouncedRay, next: &mut Vec<BouncedRay>) {
        let passing = Ray { origin: self.origin_behind(ray), direction: ray.ray.direction };
        let weight = LinearRgb::grey(1.0 - self.opacity);
        // A ray that passes the surface of glass is inside it, or outside again.
        let inside = match self.finish {
            Finish::Glass { .. } if ray.inside == Some(self.object) => None,
            Finish::Glass { .. } => Some(self.object),
            _ => ray.inside,
        };
        add(next, BouncedRay { ray: passing, t: ray.t + self.t, weight, inside, ..*ray }, ray);
    }

    /// Returns the origin of a ray that leaves the surface on the side away from the ray that met
    /// it.
    fn origin_behind(&self, ray: &BouncedRay) -> Vec3 {
        super::origin_behind(self.position, self.geometric_normal, self.clearance, ray.ray.at(self.t))
    }

    /// Adds the refracted ray; `part` is its part of the light.
    fn add_refraction(&self, ray: &BouncedRay, ratio: f32, is_leaving: bool, part: f32, next: &mut Vec<BouncedRay>) {
        let direction = ray.ray.direction;
        // As with reflections, an interpolated normal may refract the ray back out of the surface.
        let refracted = finish::refract(direction, self.shading_normal, ratio)
            .filter(|refracted| refracted.dot(self.geometric_normal) < 0.0)
            .or_else(|| finish::refract(direction, self.geometric_normal, ratio));
        let Some(refracted) = refracted else { return };
        let origin = self.origin_behind(ray);
        // Light is coloured once on its way through, where it enters.
        let color = if is_leaving { LinearRgb::grey(1.0) } else { self.reflectance };
        let inside = if is_leaving { None } else { Some(self.object) };
        let (ray_inside, t) = (Ray { origin, direction: refracted }, ray.t + self.t);
        add(next, BouncedRay { ray: ray_inside, t, weight: color * part, inside, ..*ray }, ray);
    }

    /// Adds the mirrored ray; `weight` is its part of the light.
    fn add_reflection(&self, ray: &BouncedRay, weight: LinearRgb, next: &mut Vec<BouncedRay>) {
        let mut direction = finish::reflect(ray.ray.direction, self.shading_normal);
        // Near the outline of a smooth mesh, the mirror image about an interpolated normal may point into the surface.
        if direction.dot(self.geometric_normal) <= 0.0 {
            direction = finish::reflect(ray.ray.direction, self.geometric_normal);
        }
        self.add_mirrored(direction, ray, weight, next);
    }

    /// Adds the rays that facets of rough metal mirror.
    fn add_rough_reflections(&self, ray: &BouncedRay, roughness: f32, next: &mut Vec<BouncedRay>) {
        let shifts = PartShifts::of(&[ray.sample]);
        let mut add = |part: u32, sibling: u32, weight: LinearRgb| {
            let part = shifts.position::<F32x8>(part).of_lane(0);
            let normal = finish::facet_normal(self.shading_normal, roughness, &part);
            let mut direction = finish::reflect(ray.ray.direction, normal);
            // A ray that a facet mirrors into the surface is mirrored by another facet.
            if direction.dot(self.geometric_normal) <= 0.0 {
                direction = finish::reflect(direction, self.geometric_normal);
            }
            self.add_mirrored(direction, &BouncedRay { sibling, ..*ray }, weight, next);
        };
        let LinearRgb { r, g, b } = ray.weight;
        if r.max(g).max(b) < MIN_SPREAD_WEIGHT {
            // Each of the rays that were mirrored at once takes another facet.
            add(ray.sibling, ray.sibling, self.reflectance);
        } else {
            (0..SPREAD).for_each(|part| add(part, part, self.reflectance * (1.0 / SPREAD as f32)));
        }
    }

    /// Adds the mirrored ray with this direction; `weight` is its part of the light.
    fn add_mirrored(&self, direction: Vec3, ray: &BouncedRay, weight: LinearRgb, next: &mut Vec<BouncedRay>) {
        let origin = self.position + self.geometric_normal * self.clearance;
        add(next, BouncedRay { ray: Ray { origin, direction }, t: ray.t + self.t, weight, ..*ray }, ray);
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

/// Returns whether a point is on an object that is not matte.
fn is_finished(scene: &Scene, points: &EightPoints, lane: usize) -> bool {
    points.hit_mask >> lane & 1 == 1 && !scene.objects()[points.ids.id(lane).object as usize].is_matte()
}

/// Returns the lanes whose point is on an object that is not matte.
fn finished_lanes(scene: &Scene, points: &EightPoints) -> impl Iterator<Item = usize> {
    (0..LANES).filter(|&lane| is_finished(scene, points, lane))
}

/// The reflectances of materials at surface points.
#[derive(Default)]
struct Reflectances {
    found: Vec<EightLights>,
    /// Light of 1 at each point.
    ones: Vec<EightArriving>,
}

impl Reflectances {
    /// Computes the reflectance of the material at each point.
    // The kernel of diffuse reflection returns it if the arriving light is 1.
    fn find(&mut self, scene: &Scene, direction_steps: [Vec3; 2], of: &Generation<'_>) {
        let one = EightArriving { light: [F32x8([1.0; LANES]); 3], lit_by: [0; LANES] };
        self.ones.resize(of.points.len(), one);
        let Self { found, ones } = self;
        super::reflected_light(scene, of.rays, direction_steps, of.hits, of.points, ones, found);
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
