//! Ray queries: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both take many rays at a time, so this module chooses how to trace them: in packets, as single rays, or first in a
//! packet and then singly. The choice never changes a result: all kernels find the same hits, to the bit.

use crate::accel::{Accelerator, PrimitiveId};
use crate::bvh::{GROUPS, PacketStack, RayStack};
use crate::lanes::{F32x8, LANES, LaneMask, Lanes, set_bits};
use crate::ray::{EightRays, Interval, Probe, Ray, Rays};
use crate::scene::Scene;
use crate::shape::{Primitive, Surface};
use crate::simd::{self, SimdKernel};
use holes::PassHoles;
use packet::PacketRays;
use single::{ANY, CLOSEST, SingleRay};

mod packet;
mod single;
mod instances;
mod holes;
mod split;
mod observer;

pub(crate) use holes::is_hole;
pub use observer::{Observer, PrimitiveTest, TestCount};

/// The closest intersection of a ray with a scene, in front of the ray's origin.
///
/// ```
/// use glam::Vec3;
/// use termtrace::{Camera, Material, Resolution, Scene, Sphere};
///
/// let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO)?;
/// let scene = Scene::builder(camera).object(Sphere::new(Vec3::ZERO, 1.0)?, Material::default()).build()?;
/// let hit = scene.hit(scene.camera(), Resolution::new(3, 3)?, [1, 1]).ok_or("the middle shows the sphere")?;
/// assert_eq!((hit.t, hit.object), (4.0, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray parameter of the crossing; for eye rays, the depth in world units.
    pub t: f32,
    /// The index of the object in [`Scene::objects`].
    pub object: u32,
    /// The index of the primitive in the object's shape: the triangle of a mesh, else 0.
    pub primitive: u32,
}

impl Hit {
    /// Returns the primitive that was hit.
    #[doc(hidden)]
    pub fn surface(self, scene: &Scene) -> Primitive<'_> {
        scene.objects()[self.object as usize].shape.primitive(self.primitive)
    }
}

/// The method of tracing rays, which changes the speed but never the hits.
// The bunny at 1024x1024: packets trace 49 million shadow rays per second and 1.5 million incoherent rays, single rays
// 9 and 1.9 million.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// Packets, which are split into single rays where that is faster.
    #[default]
    Auto,
    /// Packets of 64 rays only.
    Packet,
    /// Single rays only, each against eight boxes or primitives at once.
    Single,
    /// Single rays without SIMD instructions.
    Scalar,
}

/// The hits of eight rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightHits {
    /// The mask of rays with a hit.
    pub hit_mask: u32,
    /// The ray parameters of the hits. Lanes without a hit are unspecified.
    pub t: F32x8,
    /// The index of each ray's hit primitive, or [`NO_PRIMITIVE`](Self::NO_PRIMITIVE), as the bits
    /// of a float.
    // Stored as floats, so that a hit's t and index are selected by the same mask in the same kind of register.
    primitives: F32x8,
}

impl EightHits {
    /// The primitive index of rays without a hit.
    pub(crate) const NO_PRIMITIVE: u32 = u32::MAX;

    /// Returns the index of the primitive that the ray of `lane` hits.
    #[inline(always)]
    pub(crate) fn primitive(&self, lane: usize) -> u32 {
        self.primitives.0[lane].to_bits()
    }

    /// Returns the mask of lanes whose hit is `primitive`.
    #[inline(always)]
    pub(crate) fn mask_of<N: Lanes>(&self, primitive: u32) -> u32 {
        N::load(&self.primitives).eq_bits(primitive).bits()
    }

    /// Returns the hit primitives' lanes in their leaves: the lowest three bits of their indices.
    // The higher bits are not cleared, as `gather` ignores them.
    #[inline(always)]
    pub(crate) fn lanes_in_leaf<N: Lanes>(&self) -> N {
        N::load(&self.primitives)
    }

    /// Returns each hit primitive's index divided by eight, which identifies its leaf, as the bits
    /// of a float.
    #[inline(always)]
    pub(crate) fn leaf_indices<N: Lanes>(&self) -> N {
        let mut leaves = F32x8::ZERO;
        for (leaf, primitive) in leaves.0.iter_mut().zip(self.primitives.0) {
            *leaf = f32::from_bits(primitive.to_bits() / LANES as u32);
        }
        N::load(&leaves)
    }

    /// Returns the mask of lanes whose hit primitive lies in `start..end`.
    #[inline(always)]
    pub(crate) fn mask_of_range(&self, start: u32, end: u32) -> u32 {
        (0..LANES).fold(0, |lanes, lane| lanes | u32::from((start..end).contains(&self.primitive(lane))) << lane)
    }

    /// Replaces the hit of `lane` by a t and the index of a primitive, or by none.
    fn put(&mut self, lane: usize, (t, primitive): (f32, Option<u32>)) {
        self.hit_mask = self.hit_mask & !(1 << lane) | u32::from(primitive.is_some()) << lane;
        self.t.0[lane] = t;
        self.primitives.0[lane] = f32::from_bits(primitive.unwrap_or(Self::NO_PRIMITIVE));
    }

    /// Returns the hit of the ray of `lane`.
    ///
    /// # Panics
    /// If `lane` is not below 8. May panic if `scene` is not the scene that was traced.
    pub fn hit(&self, scene: &Scene, lane: usize) -> Option<Hit> {
        (self.hit_mask >> lane & 1 == 1).then(|| {
            let PrimitiveId { object, index } = scene.accelerator().id(self.primitive(lane));
            Hit { t: self.t.0[lane], object, primitive: index }
        })
    }
}

/// Finds the closest hit of each active ray in front of its origin.
///
/// Of hits at the same t, the primitive that comes first in the scene wins.
// If any of the hits at the same t could win, the picture would depend on the order of traversal, and so on the kernel.
pub fn closest_hits(kernel: Kernel, scene: &Scene, rays: &[EightRays], hits: &mut Vec<EightHits>) {
    closest_hits_within(kernel, scene, rays, Interval::IN_FRONT, hits);
}

/// Finds the closest hit of each active ray in an interval.
fn closest_hits_within(kernel: Kernel, scene: &Scene, rays: &[EightRays], within: Interval, hits: &mut Vec<EightHits>) {
    hits.clear();
    let accel = scene.accelerator();
    match kernel {
        Kernel::Scalar => closest_single::<F32x8>(accel, rays, within, &mut RayStack::default(), hits),
        _ => simd::dispatch(ClosestHits { kernel, accel, rays, within, hits }),
    }
    if scene.has_holes() {
        simd::dispatch(PassHoles { scene, rays, within, hits });
    }
}

/// Finds, for each group of rays, the mask of active rays with a hit in the interval.
///
/// # Panics
/// If the interval starts below 0: bounds of boxes are valid for t >= 0 only (`culling.md`, 4).
pub fn any_hits(kernel: Kernel, scene: &Scene, rays: &[EightRays], within: Interval, hit_masks: &mut Vec<u32>) {
    assert!(within.min >= 0.0, "{within:?} starts behind the rays' origins");
    hit_masks.clear();
    if scene.has_holes() {
        // Any hit could be in a hole with a whole surface before or behind it.
        let mut hits = Vec::with_capacity(rays.len());
        closest_hits_within(kernel, scene, rays, within, &mut hits);
        hit_masks.extend(hits.iter().map(|hits| hits.hit_mask));
        return;
    }
    let accel = scene.accelerator();
    match kernel {
        Kernel::Scalar => any_single::<F32x8>(accel, rays, within, &mut RayStack::default(), hit_masks),
        _ => simd::dispatch(AnyHits { kernel, accel, rays, within, hit_masks }),
    }
}

/// Returns the closest hit of a single ray.
pub fn closest_hit(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let mut hits = Vec::with_capacity(1);
    closest_hits(Kernel::Single, scene, &[EightRays::of(std::slice::from_ref(ray))], &mut hits);
    hits.first()?.hit(scene, 0)
}

/// Returns whether a single ray has a hit in the interval.
pub fn any_hit(scene: &Scene, ray: &Ray, within: Interval) -> bool {
    let mut hit_masks = Vec::with_capacity(1);
    any_hits(Kernel::Single, scene, &[EightRays::of(std::slice::from_ref(ray))], within, &mut hit_masks);
    hit_masks == [1]
}

/// Returns the [`closest_hit`] of a ray, and reports all tests to `observer`.
pub fn closest_hit_observed(scene: &Scene, ray: &Ray, observer: &mut dyn Observer) -> Option<Hit> {
    let closest = |within| simd::dispatch(Observed::<CLOSEST> { scene, ray, within, observer: &mut *observer });
    holes::first_whole(scene, ray, Interval::IN_FRONT, closest)
}

/// Returns any hit of a ray in the interval, and reports all tests to `observer`.
pub fn any_hit_observed(scene: &Scene, ray: &Ray, within: Interval, observer: &mut dyn Observer) -> Option<Hit> {
    if scene.has_holes() {
        let closest = |within| simd::dispatch(Observed::<CLOSEST> { scene, ray, within, observer: &mut *observer });
        return holes::first_whole(scene, ray, within, closest);
    }
    let (_, primitive) = simd::dispatch(Observed::<ANY> { scene, ray, within, observer });
    let PrimitiveId { object, index } = scene.accelerator().id(primitive?);
    // Traversal for any hit does not keep t, so the crossing is computed again.
    let t = scene.objects()[object as usize].shape.primitive(index).closest_crossing(&Probe::new(*ray), within)?;
    Some(Hit { t, object, primitive: index })
}

/// The SIMD kernel of [`closest_hit_observed`] and [`any_hit_observed`].
struct Observed<'w, const ANY: bool> {
    scene: &'w Scene,
    ray: &'w Ray,
    within: Interval,
    observer: &'w mut dyn Observer,
}

impl<const ANY: bool> SimdKernel for Observed<'_, ANY> {
    type Output = (f32, Option<u32>);

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let Self { scene, ray, within, observer } = self;
        let rays = Rays::load(&EightRays::of(std::slice::from_ref(ray)), scene.accelerator().needs_shear());
        let mut ray = SingleRay::<N, ANY, _>::observed(scene.accelerator(), &rays, 0, within, observer);
        ray.trace(&mut RayStack::default());
        ray.t_and_primitive()
    }
}

impl Kernel {
    /// Returns whether a packet traces this many groups of rays.
    fn uses_packet(self, groups: usize) -> bool {
        match self {
            // A single group has too few rays to pay for a packet's bounds.
            Self::Auto => groups > 1,
            Self::Packet => true,
            Self::Single | Self::Scalar => false,
        }
    }
}

/// The SIMD kernel of [`closest_hits`].
struct ClosestHits<'w> {
    kernel: Kernel,
    accel: &'w Accelerator,
    rays: &'w [EightRays],
    within: Interval,
    hits: &'w mut Vec<EightHits>,
}

impl SimdKernel for ClosestHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, accel, rays, within, hits } = self;
        let mut stacks = Stacks::default();
        let mut packet = PacketRays::<N, CLOSEST>::new(kernel, accel, within);
        // After an inefficient packet the rest of the tile is traced singly, as the packets beside it are likely to be
        // inefficient too: dragon 871k at 100x60 takes 0.91 instead of 1.10 ms; the bunny at 200x120 2.80 instead of
        // 2.70.
        let mut uses_packets = true;
        for rays in rays.chunks(GROUPS) {
            if uses_packets && kernel.uses_packet(rays.len()) {
                packet.trace(rays, &mut stacks);
                packet.write_hits(hits);
                uses_packets = !packet.was_inefficient();
                continue;
            }
            closest_single::<N>(accel, rays, within, &mut stacks.single, hits);
        }
    }
}

/// Finds the closest hits by single rays.
#[inline(always)]
fn closest_single<N: Lanes>(
    accel: &Accelerator,
    rays: &[EightRays],
    within: Interval,
    stack: &mut RayStack,
    hits: &mut Vec<EightHits>,
) {
    for rays in rays {
        let nothing = F32x8([f32::from_bits(EightHits::NO_PRIMITIVE); LANES]);
        let mut hit = EightHits { hit_mask: 0, t: F32x8::ZERO, primitives: nothing };
        // Inverse directions and shears are computed for all eight rays at once, seven divisions in registers: 5 to 6 %
        // faster than ray by ray for incoherent rays of the bunny.
        let eight = Rays::load(rays, accel.needs_shear());
        for lane in set_bits(rays.active) {
            let mut ray = SingleRay::<N, CLOSEST>::new(accel, &eight, lane, within);
            ray.trace(stack);
            if let (t, Some(primitive)) = ray.t_and_primitive() {
                hit.hit_mask |= 1 << lane;
                (hit.t.0[lane], hit.primitives.0[lane]) = (t, f32::from_bits(primitive));
            }
        }
        hits.push(hit);
    }
}

/// The SIMD kernel of [`any_hits`].
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
        let mut uses_packets = true;
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

/// Finds the masks of rays that hit anything, by single rays.
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
            hit_mask |= u32::from(ray.t_and_primitive().1.is_some()) << lane;
        }
        hit_masks.push(hit_mask);
    }
}

/// The stacks of traversal, reused for all rays of a call.
#[derive(Default)]
struct Stacks {
    packet: PacketStack,
    single: RayStack,
}
