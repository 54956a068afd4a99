//! What a ray meets: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both are asked for many rays at a time, so that the way in which they are traced together is this stage's choice. None
//! of the ways shows in what is found.

use crate::accel::{Accelerator, PrimitiveId};
use crate::bvh::{GROUPS, PacketStack, RayStack};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, set_bits};
use crate::ray::{EightRays, Interval, Probe, Ray, Rays};
use crate::scene::Scene;
use crate::shape::{Primitive, Surface};
use crate::simd::{self, SimdKernel};
use packet::PacketRays;
use single::SingleRay;

mod packet;
mod single;
mod split;
mod observer;

pub use observer::{Observer, PrimitiveTest};

/// The closest crossing in front of a ray's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where on the ray.
    pub t: f32,
    /// Which of the scene's objects, by its place in [`Scene::objects`].
    pub object: u32,
    /// Which of its shape's [parts](crate::shape::Shape::primitive).
    pub primitive: u32,
}

impl Hit {
    /// What was hit.
    #[doc(hidden)]
    pub fn surface(self, scene: &Scene) -> Primitive<'_> {
        scene.objects()[self.object as usize].shape.primitive(self.primitive)
    }
}

/// How rays are traced. It changes how long that takes, and nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// Together as long as that is cheaper.
    #[default]
    Auto,
    /// Always together: packets of 64.
    Packet,
    /// One ray at a time, against eight boxes or parts.
    Single,
    /// The same without the CPU's own instructions.
    Scalar,
}

/// What eight rays have met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightHits {
    /// Which of them have met anything, a bit for each.
    pub hit_mask: u32,
    /// Where on the ray, of those that have.
    pub t: F32x8,
    /// The place of the part that was met, or [`NO_PRIMITIVE`](Self::NO_PRIMITIVE): its bits.
    primitives: F32x8,
}

impl EightHits {
    /// No part's place.
    pub(crate) const NO_PRIMITIVE: u32 = u32::MAX;

    /// The place of the part that one of them has met.
    #[inline(always)]
    pub(crate) fn primitive(&self, lane: usize) -> u32 {
        self.primitives.0[lane].to_bits()
    }

    /// Who has met what has that place: a bit for each.
    #[inline(always)]
    pub(crate) fn mask_of<N: Lanes>(&self, primitive: u32) -> u32 {
        N::load(&self.primitives).has_bits(primitive).bits()
    }

    /// Where in its leaf each of them has met something: its place, of which the lowest three bits count.
    #[inline(always)]
    pub(crate) fn lanes_in_leaf<N: Lanes>(&self) -> N {
        N::load(&self.primitives)
    }

    /// In which leaf, of all that there are: the bits of these numbers.
    #[inline(always)]
    pub(crate) fn leaf_indices<N: Lanes>(&self) -> N {
        let mut leaves = F32x8::ZERO;
        for (leaf, primitive) in leaves.0.iter_mut().zip(self.primitives.0) {
            *leaf = f32::from_bits(primitive.to_bits() / LANES as u32);
        }
        N::load(&leaves)
    }

    /// Who has met what has one of the primitives from the first up to the second.
    #[inline(always)]
    pub(crate) fn mask_of_range(&self, start: u32, end: u32) -> u32 {
        (0..LANES).fold(0, |lanes, lane| lanes | u32::from((start..end).contains(&self.primitive(lane))) << lane)
    }

    /// What one of them has met.
    ///
    /// # Panics
    /// In another scene than that it was found in; or if there are not so many.
    pub fn hit(&self, scene: &Scene, lane: usize) -> Option<Hit> {
        (self.hit_mask >> lane & 1 == 1).then(|| {
            let PrimitiveId { object, index } = scene.accelerator().id(self.primitive(lane));
            Hit { t: self.t.0[lane], object, primitive: index }
        })
    }
}

/// The closest hit of each ray that is asked about, on its half line; of two at the same t, what comes first in the scene.
pub fn closest_hits(kernel: Kernel, scene: &Scene, rays: &[EightRays], hits: &mut Vec<EightHits>) {
    hits.clear();
    let accel = scene.accelerator();
    match kernel {
        Kernel::Scalar => closest_single::<F32x8>(accel, rays, &mut RayStack::default(), hits),
        _ => simd::dispatch(ClosestHits { kernel, accel, rays, hits }),
    }
}

/// Which of the rays that are asked about meet anything inside the interval: a bit for each.
pub fn any_hits(kernel: Kernel, scene: &Scene, rays: &[EightRays], within: Interval, hit_masks: &mut Vec<u32>) {
    hit_masks.clear();
    let accel = scene.accelerator();
    match kernel {
        Kernel::Scalar => any_single::<F32x8>(accel, rays, within, &mut RayStack::default(), hit_masks),
        _ => simd::dispatch(AnyHits { kernel, accel, rays, within, hit_masks }),
    }
}

/// The closest hit of one ray.
pub fn closest_hit(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let mut hits = Vec::with_capacity(1);
    closest_hits(Kernel::Single, scene, &[EightRays::of(std::slice::from_ref(ray))], &mut hits);
    hits.first()?.hit(scene, 0)
}

/// Whether one ray meets anything inside the interval.
pub fn any_hit(scene: &Scene, ray: &Ray, within: Interval) -> bool {
    let mut hit_masks = Vec::with_capacity(1);
    any_hits(Kernel::Single, scene, &[EightRays::of(std::slice::from_ref(ray))], within, &mut hit_masks);
    hit_masks == [1]
}

/// [`closest_hit`], with a observer of what the ray is tested against.
pub fn closest_hit_observed(scene: &Scene, ray: &Ray, observer: &mut impl Observer) -> Option<Hit> {
    let (t, primitive) = simd::dispatch(Observed::<_, CLOSEST> { scene, ray, within: Interval::IN_FRONT, observer });
    let PrimitiveId { object, index } = scene.accelerator().id(primitive?);
    Some(Hit { t, object, primitive: index })
}

/// [`any_hit`], with a observer of what the ray is tested against. Returns what it met, which need not be the closest.
pub fn any_hit_observed(scene: &Scene, ray: &Ray, within: Interval, observer: &mut impl Observer) -> Option<Hit> {
    let (_, primitive) = simd::dispatch(Observed::<_, ANY> { scene, ray, within, observer });
    let PrimitiveId { object, index } = scene.accelerator().id(primitive?);
    let t = scene.objects()[object as usize].shape.primitive(index).closest_crossing(&Probe::new(*ray), within)?;
    Some(Hit { t, object, primitive: index })
}

/// A ray by itself that somebody watches.
struct Observed<'w, W, const ANY: bool> {
    scene: &'w Scene,
    ray: &'w Ray,
    within: Interval,
    observer: &'w mut W,
}

impl<W: Observer, const ANY: bool> SimdKernel for Observed<'_, W, ANY> {
    type Output = (f32, Option<u32>);

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let Self { scene, ray, within, observer } = self;
        let rays = Rays::load(&EightRays::of(std::slice::from_ref(ray)), scene.accelerator().needs_shear());
        let mut ray = SingleRay::<N, ANY, _>::observed(scene.accelerator(), &rays, 0, within, observer);
        ray.trace(&mut RayStack::default());
        ray.found()
    }
}

impl Kernel {
    /// Whether so many groups of rays go together.
    fn uses_packet(self, groups: usize) -> bool {
        match self {
            Self::Auto => groups > 1,
            Self::Packet => true,
            Self::Single | Self::Scalar => false,
        }
    }
}

const CLOSEST: bool = false;
const ANY: bool = true;

struct ClosestHits<'w> {
    kernel: Kernel,
    accel: &'w Accelerator,
    rays: &'w [EightRays],
    hits: &'w mut Vec<EightHits>,
}

impl SimdKernel for ClosestHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, accel, rays, hits } = self;
        let mut stacks = Stacks::default();
        let mut packet = PacketRays::<N, CLOSEST>::new(kernel, accel, Interval::IN_FRONT);
        let mut uses_packets = true;
        for rays in rays.chunks(GROUPS) {
            if uses_packets && kernel.uses_packet(rays.len()) {
                packet.trace(rays, &mut stacks);
                packet.write_hits(hits);
                uses_packets = !packet.was_inefficient();
                continue;
            }
            closest_single::<N>(accel, rays, &mut stacks.single, hits);
        }
    }
}

/// The same one by one.
#[inline(always)]
fn closest_single<N: Lanes>(accel: &Accelerator, rays: &[EightRays], stack: &mut RayStack, hits: &mut Vec<EightHits>) {
    for rays in rays {
        let nothing = F32x8([f32::from_bits(EightHits::NO_PRIMITIVE); LANES]);
        let mut hit = EightHits { hit_mask: 0, t: F32x8::ZERO, primitives: nothing };
        // What tests have in common is reckoned for all eight at once.
        let eight = Rays::load(rays, accel.needs_shear());
        for lane in set_bits(rays.active) {
            let mut ray = SingleRay::<N, CLOSEST>::new(accel, &eight, lane, Interval::IN_FRONT);
            ray.trace(stack);
            if let (t, Some(primitive)) = ray.found() {
                hit.hit_mask |= 1 << lane;
                (hit.t.0[lane], hit.primitives.0[lane]) = (t, f32::from_bits(primitive));
            }
        }
        hits.push(hit);
    }
}

struct AnyHits<'w> {
    kernel: Kernel,
    accel: &'w Accelerator,
    rays: &'w [EightRays],
    within: Interval,
    hit_masks: &'w mut Vec<u32>,
}

impl SimdKernel for AnyHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, accel, rays, within, hit_masks } = self;
        let mut stacks = Stacks::default();
        let mut packet = PacketRays::<N, ANY>::new(kernel, accel, within);
        // A packet knows of nothing behind the origins.
        let mut uses_packets = within.min >= 0.0;
        for rays in rays.chunks(GROUPS) {
            if uses_packets && kernel.uses_packet(rays.len()) {
                packet.trace(rays, &mut stacks);
                packet.write_hit_masks(hit_masks);
                uses_packets = !packet.was_inefficient();
                continue;
            }
            any_single::<N>(accel, rays, within, &mut stacks.single, hit_masks);
        }
    }
}

/// The same one by one.
#[inline(always)]
fn any_single<N: Lanes>(
    accel: &Accelerator,
    rays: &[EightRays],
    within: Interval,
    stack: &mut RayStack,
    hit_masks: &mut Vec<u32>,
) {
    for rays in rays {
        let mut hit_mask = 0;
        let eight = Rays::load(rays, accel.needs_shear());
        for lane in set_bits(rays.active) {
            let mut ray = SingleRay::<N, ANY>::new(accel, &eight, lane, within);
            ray.trace(stack);
            hit_mask |= u32::from(ray.found().1.is_some()) << lane;
        }
        hit_masks.push(hit_mask);
    }
}

/// Space for what is still to be visited.
#[derive(Default)]
struct Stacks {
    packet: PacketStack,
    single: RayStack,
}
