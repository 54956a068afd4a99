//! The light that arrives at surface points: shadow rays, and the sum over all lights.

use super::light_parts::PartShifts;
use super::transparent_shadows::TransparentShadows;
use super::{
    EightLights, EightPoints, IncidentLight, PART_SHARE, incident_light, incident_light_of_part, scaled, stored,
};
use crate::color::LinearRgb;
use crate::finish::{self, Finish};
use crate::hit::{self, Kernel};
use crate::lanes::{ALL, F32x8, LANES, LaneMask, Lanes, Vector};
use crate::light::{Light, PARTS};
use crate::ray::EightRays;
use crate::scene::Scene;
use crate::simd::{self, SimdKernel};

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

/// The surface points that rays meet, as arrays with an entry for each group of eight rays.
pub struct Surfaces<'a> {
    /// The rays.
    pub rays: &'a [EightRays],
    /// The surface points.
    pub points: &'a [EightPoints],
    /// The number of each ray's sample in its pixel; empty if all are 0.
    pub samples: &'a [u32],
}

/// The shadow rays to a light or a part of it, in arrays with an entry for each group of eight
/// points.
#[derive(Default)]
pub struct ShadowRays {
    pub(crate) rays: Vec<EightRays>,
    /// The light that arrives along each ray if it is not blocked.
    lights: Vec<EightLights>,
    /// The mask of blocked rays of each group, for which V = 0.
    pub(crate) blocked: Vec<u32>,
    /// The tracer of rays through transparent objects.
    through: TransparentShadows,
    /// The displacements of the parts of lights, if a light has a size.
    shifts: Vec<PartShifts>,
    /// The highlights of all lights, for a strength of 1; empty if no object has highlights.
    highlights: Vec<EightLights>,
}

/// Computes the light that arrives at each point, and returns the number of traced shadow rays.
// Loops over lights, not over points, because shadow rays that end at the same light make good packets.
pub fn arriving_light(
    scene: &Scene,
    surfaces: &Surfaces<'_>,
    shadows: &mut ShadowRays,
    arriving: &mut Vec<EightArriving>,
) -> u64 {
    let points = surfaces.points;
    let LinearRgb { r, g, b } = scene.ambient();
    let ambient = [r, g, b].map(|channel| F32x8([channel; LANES]));
    arriving.clear();
    arriving.resize(points.len(), EightArriving { light: ambient, lit_by: [0; LANES] });
    shadows.highlights.clear();
    if scene.has_highlights() {
        shadows.highlights.resize(points.len(), [F32x8::ZERO; 3]);
    }
    if scene.lights().iter().any(Light::has_size) {
        PartShifts::fill(surfaces.samples, points.len(), &mut shadows.shifts);
    }
    let mut shadow_rays = 0;
    for (number, light) in scene.lights().iter().enumerate() {
        if light.has_size() {
            for part in 0..PARTS {
                simd::dispatch(AimAtPart { light, part, points, shadows });
                shadow_rays += shadows.add(scene, surfaces, number, Some(part), arriving);
            }
        } else {
            simd::dispatch(AimShadowRays { light, points, shadows });
            shadow_rays += shadows.add(scene, surfaces, number, None, arriving);
        }
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
            let (reaches, IncidentLight { light: incident, .. }) =
                incident_light::<N>(light, points.position.load(), points.shading_normal.load());
            let direction = |origin| light.to_light(origin);
            rays.push(eight_shadow_rays::<N>(points, reaches.bits() & points.hit_mask, direction));
            lights.push(stored(incident));
        }
    }
}

/// The SIMD kernel that makes the shadow rays of points that face a part of a light.
struct AimAtPart<'w> {
    light: &'w Light,
    part: u32,
    points: &'w [EightPoints],
    shadows: &'w mut ShadowRays,
}

impl SimdKernel for AimAtPart<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { light, part, points, shadows: ShadowRays { rays, lights, shifts, .. } } = self;
        rays.clear();
        lights.clear();
        for (points, shifts) in points.iter().zip(shifts) {
            let part = shifts.position::<N>(part);
            let (position, normal) = (points.position.load(), points.shading_normal.load());
            let (reaches, IncidentLight { light: incident, .. }) =
                incident_light_of_part::<N>(light, &part, position, normal);
            let direction = |origin| {
                let whole = light.to_part(origin, &part);
                whole * light.blocking_share(whole.dot(whole).sqrt())
            };
            rays.push(eight_shadow_rays::<N>(points, reaches.bits() & points.hit_mask, direction));
            lights.push(stored(incident));
        }
    }
}

impl ShadowRays {
    /// Adds the light of rays that are not blocked.
    ///
    /// The rays are aimed at a light, of the index `number`, or at a part of it. Returns the number of traced rays.
    fn add(
        &mut self,
        scene: &Scene,
        surfaces: &Surfaces<'_>,
        number: usize,
        part: Option<u32>,
        arriving: &mut [EightArriving],
    ) -> u64 {
        let light = &scene.lights()[number];
        let traced = self.trace(scene, light);
        simd::dispatch(AddUnblocked { number, shadows: self, arriving });
        if scene.has_highlights() {
            simd::dispatch(AddHighlights { scene, surfaces, light, part, shadows: self });
        }
        traced
    }

    /// Returns the light of the highlights at the points of a group, for a strength of 1.
    pub(super) fn highlights(&self, group: usize) -> &EightLights {
        self.highlights.get(group).unwrap_or(&[F32x8::ZERO; 3])
    }

    /// Finds the blocked rays, and returns the number of traced rays.
    ///
    /// Weakens the light of rays that pass through transparent objects.
    fn trace(&mut self, scene: &Scene, light: &Light) -> u64 {
        if scene.shadows() && scene.has_transparent() {
            self.through.trace(scene, light, &self.rays, &mut self.lights, &mut self.blocked)
        } else if scene.shadows() {
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
        let Self { number, shadows: ShadowRays { rays, lights, blocked, .. }, arriving } = self;
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

/// The SIMD kernel that adds the highlights of a light, or of a part of it, at points that it
/// reaches.
struct AddHighlights<'w> {
    scene: &'w Scene,
    surfaces: &'w Surfaces<'w>,
    light: &'w Light,
    part: Option<u32>,
    shadows: &'w mut ShadowRays,
}

impl SimdKernel for AddHighlights<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        for (group, points) in self.surfaces.points.iter().enumerate() {
            let mut remaining = self.shadows.rays[group].active & !self.shadows.blocked[group];
            // Object by object, as in the kernel of reflected light: the exponents differ.
            while remaining != 0 {
                let object = points.ids.id(remaining.trailing_zeros() as usize % LANES).object;
                let same = remaining & points.ids.mask_of_object::<N>(object);
                remaining &= !same;
                let Finish::Shiny { exponent, .. } = self.scene.objects()[object as usize].finish else { continue };
                let lights = self.eight_highlights::<N>(group, exponent);
                for (sum, more) in self.shadows.highlights[group].iter_mut().zip(lights) {
                    let before = N::load(sum);
                    *sum = N::select(N::mask_from_bits(same), before + more, before).store();
                }
            }
        }
    }
}

impl AddHighlights<'_> {
    /// Returns the highlights at the points of a group.
    #[inline(always)]
    fn eight_highlights<N: Lanes>(&self, group: usize, exponent: u32) -> [N; 3] {
        let Self { scene, surfaces, light, part, shadows } = self;
        let position = surfaces.points[group].position.load();
        let (to_light, mut share) = match *part {
            None => (light.to_light(position), N::splat(1.0)),
            Some(part) => (light.to_part(position, &shadows.shifts[group].position::<N>(part)), N::splat(PART_SHARE)),
        };
        if scene.shadows() && scene.has_transparent() {
            share = share * N::load(shadows.through.parts(group));
        }
        let (direction, normal) = (surfaces.rays[group].direction.load(), surfaces.points[group].shading_normal.load());
        scaled(finish::highlight(light, to_light, direction, normal, exponent), share)
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
            let direction = |origin| self.light.to_light(origin);
            self.rays.push(eight_shadow_rays::<N>(points, points.hit_mask, direction));
        }
    }
}

/// Returns the shadow rays of the points in the mask `active`, as [`shadow_ray`](super::shadow_ray)
/// makes them.
///
/// `direction` returns the direction from an origin.
#[inline(always)]
fn eight_shadow_rays<N: Lanes>(
    points: &EightPoints,
    active: u32,
    direction: impl Fn(Vector<N>) -> Vector<N>,
) -> EightRays {
    let origin = points.ray_origins::<N>();
    let direction = direction(origin);
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
