//! What a ray meets: the closest hit for eye rays, any hit for shadow rays.
//!
//! Both are asked for many rays at a time, so that the way in which they are traced together is this stage's choice. None
//! of the ways shows in what is found.

use crate::bvh::{GROUPS, Stack};
use crate::lanes::{LANES, Lanes};
use crate::ray::{Interval, Ray};
use crate::scene::{PartId, Parts, Scene};
use crate::shape::Part;
use crate::simd::{self, Instructions, Work};
use alone::Alone;
use together::Together;

mod alone;
mod together;

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

/// The closest hit of each ray, on its half line; of two at the same t, what comes first in the scene.
pub fn closest_hits(scene: &Scene, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
    closest_hits_by(Kernel::Auto, scene, rays, hits);
}

/// [`closest_hits`] in that way.
pub fn closest_hits_by(kernel: Kernel, scene: &Scene, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
    hits.clear();
    kernel.run(ClosestHits { kernel, parts: scene.parts(), rays, hits });
}

/// Whether each ray meets anything inside the interval.
pub fn any_hits(scene: &Scene, rays: &[Ray], within: Interval, found: &mut Vec<bool>) {
    any_hits_by(Kernel::Auto, scene, rays, within, found);
}

/// [`any_hits`] in that way.
pub fn any_hits_by(kernel: Kernel, scene: &Scene, rays: &[Ray], within: Interval, found: &mut Vec<bool>) {
    found.clear();
    kernel.run(AnyHits { kernel, parts: scene.parts(), rays, within, found });
}

/// The closest hit of one ray.
pub fn closest_hit(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let mut hits = Vec::with_capacity(1);
    closest_hits_by(Kernel::Single, scene, std::slice::from_ref(ray), &mut hits);
    hits.pop().flatten()
}

/// Whether one ray meets anything inside the interval.
pub fn any_hit(scene: &Scene, ray: &Ray, within: Interval) -> bool {
    let mut found = Vec::with_capacity(1);
    any_hits_by(Kernel::Single, scene, std::slice::from_ref(ray), within, &mut found);
    found == [true]
}

impl Kernel {
    fn run<W: Work>(self, work: W) -> W::Output {
        let instructions = if self == Self::Scalar { Instructions::Baseline } else { Instructions::best() };
        simd::run_with(instructions, work)
    }

    /// Whether so many rays go together.
    fn is_together(self, rays: usize) -> bool {
        match self {
            Self::Auto => rays > LANES,
            Self::Packet => true,
            Self::Single | Self::Scalar => false,
        }
    }
}

const CLOSEST: bool = false;
const ANY: bool = true;

/// How many rays are a packet.
const PACKET: usize = GROUPS * LANES;

struct ClosestHits<'w> {
    kernel: Kernel,
    parts: &'w Parts,
    rays: &'w [Ray],
    hits: &'w mut Vec<Option<Hit>>,
}

impl Work for ClosestHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, parts, rays, hits } = self;
        let mut stacks = Stacks::default();
        let hit = |(t, place): (f32, Option<u32>)| {
            let PartId { object, part } = parts.id(place?);
            Some(Hit { t, object, part })
        };
        for rays in rays.chunks(PACKET) {
            if kernel.is_together(rays.len()) {
                let mut packet = Together::<N, CLOSEST>::new(kernel, parts, rays, Interval::IN_FRONT);
                packet.trace(&mut stacks);
                hits.extend(packet.found().map(hit));
            } else {
                for ray in rays {
                    let mut ray = Alone::<N, CLOSEST>::new(parts, ray, Interval::IN_FRONT);
                    ray.trace(&mut stacks.alone);
                    hits.push(hit(ray.found()));
                }
            }
        }
    }
}

struct AnyHits<'w> {
    kernel: Kernel,
    parts: &'w Parts,
    rays: &'w [Ray],
    within: Interval,
    found: &'w mut Vec<bool>,
}

impl Work for AnyHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { kernel, parts, rays, within, found } = self;
        let mut stacks = Stacks::default();
        for rays in rays.chunks(PACKET) {
            // A packet knows of nothing behind the origins.
            if kernel.is_together(rays.len()) && within.min >= 0.0 {
                let mut packet = Together::<N, ANY>::new(kernel, parts, rays, within);
                packet.trace(&mut stacks);
                found.extend(packet.found().map(|(_, place)| place.is_some()));
            } else {
                for ray in rays {
                    let mut ray = Alone::<N, ANY>::new(parts, ray, within);
                    ray.trace(&mut stacks.alone);
                    found.push(ray.found().1.is_some());
                }
            }
        }
    }
}

/// Space for what is still to be visited.
#[derive(Default)]
struct Stacks {
    together: Stack,
    alone: Stack,
}
