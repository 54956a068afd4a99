//! Rays that go on from mirrors and glass, and the light that they bring.
//!
//! The rays of a batch are followed together, one generation of reflections and refractions after the other, so that
//! neighbouring rays stay packets. Each ray has a weight, the part of its light that reaches the eye, and a ray whose
//! weight is too small to be seen ends.

use super::{EightArriving, EightLights, EightPoints, ShadowRays};
use crate::color::LinearRgb;
use crate::finish::{self, Finish};
use crate::hit::{self, EightHits, Kernel};
use crate::lanes::{F32x8, LANES};
use crate::ray::{EightRays, Ray};
use crate::scene::Scene;
use glam::Vec3;

/// The smallest weight of a ray that is followed.
// A quarter of a step of 8-bit linear light, and so invisible unless what is reflected is brighter than white.
const MIN_WEIGHT: f32 = 1.0 / 1024.0;

/// A ray that goes on from a surface.
#[derive(Clone, Copy, Debug)]
struct BouncedRay {
    ray: Ray,
    /// The part of the ray's light that reaches the eye.
    weight: LinearRgb,
    /// The index of the eye ray in its batch.
    eye_ray: u32,
    /// The object in whose glass the ray is.
    inside: Option<u32>,
}

/// The arrays of the rays that go on, reused from batch to batch.
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
}

impl Bounces {
    /// Replaces the light of eye rays that hit a surface with a [`Finish`].
    ///
    /// Returns the number of rays that were traced for it.
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
                    weight: LinearRgb::grey(1.0),
                    eye_ray: (group * LANES + lane) as u32,
                    inside: None,
                };
                let reflectance = super::lane_light(&self.reflectances.found[group], lane);
                let surface = Surface::of(scene, points, lane, reflectance);
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

    /// Traces the current generation, adds its light to that of the eye rays, and makes the next.
    fn trace(&mut self, scene: &Scene, direction_steps: [Vec3; 2], lights: &mut [EightLights]) -> u64 {
        let Self { current, next, rays, hits, points, shadows, arriving, diffuse, reflectances } = self;
        rays.clear();
        rays.extend(current.chunks(LANES).map(|group| {
            let mut eight = [current[0].ray; LANES];
            eight.iter_mut().zip(group).for_each(|(ray, bounced)| *ray = bounced.ray);
            EightRays::of(&eight[..group.len()])
        }));
        hit::closest_hits(Kernel::Auto, scene, rays, hits);
        super::surface_points(scene, rays, hits, points);
        let traced = current.len() as u64 + super::arriving_light(scene, points, shadows, arriving);
        super::reflected_light(scene, rays, direction_steps, hits, points, arriving, diffuse);
        reflectances.find(scene, direction_steps, &Generation { rays, hits, points, arriving });
        next.clear();
        for (at, ray) in current.iter().enumerate() {
            let (group, lane) = (at / LANES, at % LANES);
            let mut light = super::lane_light(&diffuse[group], lane);
            if finish_at(scene, &points[group], lane).is_some_and(|finish| !finish.is_matte()) {
                let reflectance = super::lane_light(&reflectances.found[group], lane);
                light = Surface::of(scene, &points[group], lane, reflectance).light(ray, light, next);
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
    object: u32,
    position: Vec3,
    shading_normal: Vec3,
    geometric_normal: Vec3,
    clearance: f32,
    reflectance: LinearRgb,
}

impl Surface {
    fn of(scene: &Scene, points: &EightPoints, lane: usize, reflectance: LinearRgb) -> Self {
        let object = points.ids.id(lane).object;
        Self {
            finish: scene.objects()[object as usize].finish,
            object,
            position: points.position.of_lane(lane),
            shading_normal: points.shading_normal.of_lane(lane),
            geometric_normal: points.geometric_normal.of_lane(lane),
            clearance: points.clearance.0[lane],
            reflectance,
        }
    }

    /// Returns the light towards the ray's origin, without that of further rays.
    ///
    /// Further rays are added to `next`.
    ///
    /// `diffuse` is the light that a matte surface would reflect.
    fn light(&self, ray: &BouncedRay, diffuse: LinearRgb, next: &mut Vec<BouncedRay>) -> LinearRgb {
        let direction = ray.ray.direction;
        let cosine = finish::cosine_of_incidence(direction, self.shading_normal);
        match self.finish {
            Finish::Matte => diffuse,
            Finish::Glowing { strength } => self.reflectance * strength,
            Finish::Metal => {
                self.add_reflection(ray, self.reflectance, next);
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
                let mirrored = finish::fresnel(cosine, ratio);
                self.add_reflection(ray, LinearRgb::grey(mirrored), next);
                if let Some(refracted) = finish::refract(direction, self.shading_normal, ratio) {
                    // Light is coloured once on its way through, where it enters.
                    let color = if is_leaving { LinearRgb::grey(1.0) } else { self.reflectance };
                    let inside = if is_leaving { None } else { Some(self.object) };
                    let origin = self.position - self.geometric_normal * self.clearance;
                    let weight = color * (1.0 - mirrored);
                    add(next, BouncedRay { ray: Ray { origin, direction: refracted }, weight, inside, ..*ray }, ray);
                }
                LinearRgb::BLACK
            }
        }
    }

    /// Adds the ray that is mirrored, with this part of the light.
    fn add_reflection(&self, ray: &BouncedRay, weight: LinearRgb, next: &mut Vec<BouncedRay>) {
        let mut direction = finish::reflect(ray.ray.direction, self.shading_normal);
        // Near the outline of a smooth mesh, the mirror image about an interpolated normal may point into the surface.
        if direction.dot(self.geometric_normal) <= 0.0 {
            direction = finish::reflect(ray.ray.direction, self.geometric_normal);
        }
        let origin = self.position + self.geometric_normal * self.clearance;
        add(next, BouncedRay { ray: Ray { origin, direction }, weight, ..*ray }, ray);
    }
}

/// Adds a ray whose weight is a part of that of the ray before it.
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

/// Returns the finish of the object at a point, or `None` without a hit.
fn finish_at(scene: &Scene, points: &EightPoints, lane: usize) -> Option<Finish> {
    (points.hit_mask >> lane & 1 == 1).then(|| scene.objects()[points.ids.id(lane).object as usize].finish)
}

/// Returns the lanes whose point is on an object that is not matte.
fn finished_lanes(scene: &Scene, points: &EightPoints) -> impl Iterator<Item = usize> {
    (0..LANES).filter(|&lane| finish_at(scene, points, lane).is_some_and(|finish| !finish.is_matte()))
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
