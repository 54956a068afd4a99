//! What a ray meets: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both are asked for many rays at a time, so that the way in which they are traced together is this stage's choice. None
//! of the ways shows in what is found.

use crate::accel::{Accelerator, PartId};
use crate::bvh::{GROUPS, Queue, Stack};
use crate::lanes::{Answers, Eight, LANES, Lanes, set_bits};
use crate::ray::{EightRays, Interval, Probe, Ray, Rays};
use crate::scene::Scene;
use crate::shape::{Part, Surface};
use crate::simd::{self, Work};
use packet::PacketRays;
use single::SingleRay;

mod packet;
mod single;
mod split;
mod witness;

pub use witness::{Test, Witness};

/// The closest crossing in front of a ray's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where on the ray.
    pub t: f32,
    /// Which of the scene's objects, by its place in [`Scene::objects`].
    pub object: u32,
    /// Which of its shape's [parts](crate::shape::Shape::part).
    pub part: u32,
}

impl Hit {
    /// What was hit.
    #[doc(hidden)]
    pub fn surface(self, scene: &Scene) -> Part<'_> {
        scene.objects()[self.object as usize].shape.part(self.part)
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
    pub met: u32,
    /// Where on the ray, of those that have.
    pub t: Eight,
    /// The place of the part that was met, or [`NOTHING`](Self::NOTHING): its bits.
    places: Eight,
}

impl EightHits {
    /// No part's place.
    pub(crate) const NOTHING: u32 = u32::MAX;

    /// The place of the part that one of them has met.
    #[inline(always)]
    pub(crate) fn place(&self, lane: usize) -> u32 {
        self.places.0[lane].to_bits()
    }

    /// Who has met what has that place: a bit for each.
    #[inline(always)]
    pub(crate) fn at<N: Lanes>(&self, place: u32) -> u32 {
        N::load(&self.places).has_bits(place).bits()
    }

    /// Where in its leaf each of them has met something: its place, of which the lowest three bits count.
    #[inline(always)]
    pub(crate) fn in_leaf<N: Lanes>(&self) -> N {
        N::load(&self.places)
    }

    /// In which leaf, of all that there are: the bits of these numbers.
    #[inline(always)]
    pub(crate) fn leaves<N: Lanes>(&self) -> N {
        let mut leaves = Eight::ZERO;
        for (leaf, place) in leaves.0.iter_mut().zip(self.places.0) {
            *leaf = f32::from_bits(place.to_bits() / LANES as u32);
        }
        N::load(&leaves)
    }

    /// Who has met what has one of the places from the first up to the second.
    #[inline(always)]
    pub(crate) fn between(&self, start: u32, end: u32) -> u32 {
        (0..LANES).fold(0, |lanes, lane| lanes | u32::from((start..end).contains(&self.place(lane))) << lane)
    }

    /// What one of them has met.
    ///
    /// # Panics
    /// In another scene than that it was found in; or if there are not so many.
    pub fn hit(&self, scene: &Scene, lane: usize) -> Option<Hit> {
        (self.met >> lane & 1 == 1).then(|| {
            let PartId { object, part } = scene.accelerator().id(self.place(lane));
            Hit { t: self.t.0[lane], object, part }
        })
    }
}

/// The closest hit of each ray that is asked about, on its half line; of two at the same t, what comes first in the scene.
pub fn closest_hits(kernel: Kernel, scene: &Scene, rays: &[EightRays], hits: &mut Vec<EightHits>) {
    hits.clear();
    let accel = scene.accelerator();
    match kernel {
        Kernel::Scalar => closest_single::<Eight>(accel, rays, &mut Queue::default(), hits),
        _ => simd::run(ClosestHits { kernel, accel, rays, hits }),
    }
}

/// Which of the rays that are asked about meet anything inside the interval: a bit for each.
pub fn any_hits(kernel: Kernel, scene: &Scene, rays: &[EightRays], within: Interval, met: &mut Vec<u32>) {
    met.clear();
    let accel = scene.accelerator();
    match kernel {
        Kernel::Scalar => any_single::<Eight>(accel, rays, within, &mut Queue::default(), met),
        _ => simd::run(AnyHits { kernel, accel, rays, within, met }),
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
    let mut met = Vec::with_capacity(1);
    any_hits(Kernel::Single, scene, &[EightRays::of(std::slice::from_ref(ray))], within, &mut met);
    met == [1]
}

/// [`closest_hit`], with a witness of what the ray is tested against.
pub fn closest_hit_witnessed(scene: &Scene, ray: &Ray, witness: &mut impl Witness) -> Option<Hit> {
    let (t, place) = simd::run(Watched::<_, CLOSEST> { scene, ray, within: Interval::IN_FRONT, witness });
    let PartId { object, part } = scene.accelerator().id(place?);
    Some(Hit { t, object, part })
}

/// [`any_hit`], with a witness of what the ray is tested against. Returns what it met, which need not be the closest.
pub fn any_hit_witnessed(scene: &Scene, ray: &Ray, within: Interval, witness: &mut impl Witness) -> Option<Hit> {
    let (_, place) = simd::run(Watched::<_, ANY> { scene, ray, within, witness });
    let PartId { object, part } = scene.accelerator().id(place?);
    let t = scene.objects()[object as usize].shape.part(part).closest_crossing(&Probe::new(*ray), within)?;
    Some(Hit { t, object, part })
}

/// A ray by itself that somebody watches.
struct Watched<'w, W, const ANY: bool> {
    scene: &'w Scene,
    ray: &'w Ray,
    within: Interval,
    witness: &'w mut W,
}

impl<W: Witness, const ANY: bool> Work for Watched<'_, W, ANY> {
    type Output = (f32, Option<u32>);

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let Self { scene, ray, within, witness } = self;
        let rays = Rays::load(&EightRays::of(std::slice::from_ref(ray)), scene.accelerator().needs_shear());
        let mut ray = SingleRay::<N, ANY, _>::watched(scene.accelerator(), &rays, 0, within, witness);
        ray.trace(&mut Queue::default());
        ray.found()
    }
}

impl Kernel {
    /// Whether so many groups of rays go together.
    fn is_together(self, groups: usize) -> bool {
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

impl Work for ClosestHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, accel, rays, hits } = self;
        let mut stacks = Stacks::default();
        let mut packet = PacketRays::<N, CLOSEST>::new(kernel, accel, Interval::IN_FRONT);
        let mut together = true;
        for rays in rays.chunks(GROUPS) {
            if together && kernel.is_together(rays.len()) {
                packet.trace(rays, &mut stacks);
                packet.tell_hits(hits);
                together = !packet.was_useless();
                continue;
            }
            closest_single::<N>(accel, rays, &mut stacks.single, hits);
        }
    }
}

/// The same one by one.
#[inline(always)]
fn closest_single<N: Lanes>(accel: &Accelerator, rays: &[EightRays], queue: &mut Queue, hits: &mut Vec<EightHits>) {
    for rays in rays {
        let nothing = Eight([f32::from_bits(EightHits::NOTHING); LANES]);
        let mut hit = EightHits { met: 0, t: Eight::ZERO, places: nothing };
        // What tests have in common is reckoned for all eight at once.
        let eight = Rays::load(rays, accel.needs_shear());
        for lane in set_bits(rays.asked) {
            let mut ray = SingleRay::<N, CLOSEST>::new(accel, &eight, lane, Interval::IN_FRONT);
            ray.trace(queue);
            if let (t, Some(place)) = ray.found() {
                hit.met |= 1 << lane;
                (hit.t.0[lane], hit.places.0[lane]) = (t, f32::from_bits(place));
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
    met: &'w mut Vec<u32>,
}

impl Work for AnyHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, accel, rays, within, met } = self;
        let mut stacks = Stacks::default();
        let mut packet = PacketRays::<N, ANY>::new(kernel, accel, within);
        // A packet knows of nothing behind the origins.
        let mut together = within.min >= 0.0;
        for rays in rays.chunks(GROUPS) {
            if together && kernel.is_together(rays.len()) {
                packet.trace(rays, &mut stacks);
                packet.tell_met(met);
                together = !packet.was_useless();
                continue;
            }
            any_single::<N>(accel, rays, within, &mut stacks.single, met);
        }
    }
}

/// The same one by one.
#[inline(always)]
fn any_single<N: Lanes>(
    accel: &Accelerator,
    rays: &[EightRays],
    within: Interval,
    queue: &mut Queue,
    met: &mut Vec<u32>,
) {
    for rays in rays {
        let mut of_group = 0;
        let eight = Rays::load(rays, accel.needs_shear());
        for lane in set_bits(rays.asked) {
            let mut ray = SingleRay::<N, ANY>::new(accel, &eight, lane, within);
            ray.trace(queue);
            of_group |= u32::from(ray.found().1.is_some()) << lane;
        }
        met.push(of_group);
    }
}

/// Space for what is still to be visited.
#[derive(Default)]
struct Stacks {
    packet: Stack,
    single: Queue,
}
