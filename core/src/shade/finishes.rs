//! The finishes of surface points, eight at a time: highlights, glows and mirrored rays.
//!
//! Glass, rough metal and transparent surfaces also need the weight, the sample and the medium of each ray, so
//! [`bounces`](super::bounces) makes their rays one by one.

use super::{EightLights, Generation, MaterialsAtPoints, loaded, scaled, stored};
use crate::finish::{self, Finish};
use crate::lanes::{F32x8, LANES, Lanes, Vector};
use crate::scene::{Object, Scene};
use crate::simd::{self, SimdKernel};
use glam::Vec3;

/// The mirrored rays of eight surface points, and the values that their finishes need for others.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightFinishes {
    /// The mask of points from which rays go on: mirrored, refracted or straight through.
    pub(super) bouncing: u32,
    /// The origins of rays that leave the points on the side from which they were met.
    pub(super) origin: Vector<F32x8>,
    /// The directions of the mirrored rays; unused for rough metal.
    pub(super) direction: Vector<F32x8>,
    /// The mirrored part of the light, per channel; on glass and metal the reflectance.
    pub(super) part: EightLights,
}

/// Applies the finishes of all points, and writes their mirrored rays to `finishes`.
///
/// `lights` has the diffusely reflected light of each point. It is replaced by the light that the surface would send
/// to the ray's origin if it were opaque, without that of bounced rays.
pub(super) fn finish_surfaces(
    scene: &Scene,
    direction_steps: [Vec3; 2],
    of: &Generation<'_>,
    lights: &mut [EightLights],
    finishes: &mut Vec<EightFinishes>,
) {
    finishes.clear();
    let &Generation { rays, hits, points, .. } = of;
    let materials = MaterialsAtPoints { rays, direction_steps, hits, points };
    simd::dispatch(FinishSurfaces { scene, of, materials, lights, finishes });
}

/// The SIMD kernel of [`finish_surfaces`].
struct FinishSurfaces<'w> {
    scene: &'w Scene,
    of: &'w Generation<'w>,
    materials: MaterialsAtPoints<'w>,
    lights: &'w mut [EightLights],
    finishes: &'w mut Vec<EightFinishes>,
}

impl SimdKernel for FinishSurfaces<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { scene, of, materials, lights, finishes } = self;
        for (group, (points, lights)) in of.points.iter().zip(lights).enumerate() {
            let mut finished = Finished {
                light: loaded(lights),
                part: [N::splat(0.0); 3],
                direction: Vector::splat(Vec3::ZERO),
                bouncing: 0,
            };
            let mut remaining = points.hit_mask;
            // Object by object, as in the kernel of reflected light.
            while remaining != 0 {
                let object = points.ids.id(remaining.trailing_zeros() as usize % LANES).object;
                let same = remaining & points.ids.mask_of_object::<N>(object);
                let object = &scene.objects()[object as usize];
                if !object.is_matte() {
                    finished.apply(object, of, &materials, group, same);
                }
                remaining &= !same;
            }
            *lights = stored(finished.light);
            finishes.push(EightFinishes {
                bouncing: finished.bouncing,
                origin: points.ray_origins::<N>().store(),
                direction: finished.direction.store(),
                part: stored(finished.part),
            });
        }
    }
}

/// The light and the mirrored rays of eight surface points, collected object by object.
struct Finished<N> {
    light: [N; 3],
    part: [N; 3],
    direction: Vector<N>,
    bouncing: u32,
}

impl<N: Lanes> Finished<N> {
    /// Applies the finish of `object` to the points in the mask `own`.
    #[inline(always)]
    fn apply(
        &mut self,
        object: &Object,
        of: &Generation<'_>,
        materials: &MaterialsAtPoints<'_>,
        group: usize,
        own: u32,
    ) {
        let (light, part) = match object.finish {
            Finish::Matte => (self.light, None),
            Finish::Shiny { strength, .. } => {
                let [r, g, b] = scaled(loaded(of.shadows.highlights(group)), N::splat(strength));
                ([self.light[0] + r, self.light[1] + g, self.light[2] + b], None)
            }
            Finish::Glowing { strength } => {
                (scaled(materials.reflectances(object, group, own), N::splat(strength)), None)
            }
            Finish::Metal { .. } | Finish::Glass { .. } => {
                ([N::splat(0.0); 3], Some(materials.reflectances(object, group, own)))
            }
            Finish::Polished { index } => {
                let (direction, normal) = (of.rays[group].direction.load(), of.points[group].shading_normal.load());
                let mirrored = finish::mirrored_part(direction, normal, N::splat(1.0 / index));
                (scaled(self.light, N::splat(1.0) - mirrored), Some([mirrored; 3]))
            }
        };
        let mask = N::mask_from_bits(own);
        self.light = selected(mask, light, self.light);
        if let Some(part) = part {
            self.part = selected(mask, part, self.part);
            self.direction = Vector::select(mask, mirrored_directions(of, group), self.direction);
        }
        if part.is_some() || !object.is_opaque() {
            self.bouncing |= own;
        }
    }
}

/// Returns the channels of `yes` where the mask is set, else those of `no`.
#[inline(always)]
fn selected<N: Lanes>(mask: N::Mask, yes: [N; 3], no: [N; 3]) -> [N; 3] {
    [N::select(mask, yes[0], no[0]), N::select(mask, yes[1], no[1]), N::select(mask, yes[2], no[2])]
}

/// Returns the directions of the rays that the points of a group mirror.
#[inline(always)]
fn mirrored_directions<N: Lanes>(of: &Generation<'_>, group: usize) -> Vector<N> {
    let (direction, points) = (of.rays[group].direction.load(), &of.points[group]);
    let geometric_normal = points.geometric_normal.load::<N>();
    let mirrored = finish::reflect(direction, points.shading_normal.load());
    // Near the outline of a smooth mesh, the mirror image about an interpolated normal may point into the surface.
    let is_inwards = mirrored.dot(geometric_normal).le(N::splat(0.0));
    Vector::select(is_inwards, finish::reflect(direction, geometric_normal), mirrored)
}
