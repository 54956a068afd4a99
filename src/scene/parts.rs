//! The parts of all objects: those with bounds in a tree, the others apart.

use super::Object;
use crate::bvh::Bvh;
use crate::progress::{Progress, Watcher, Work};
use crate::shape::Surface;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A part of an object. They are ordered as they stand in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PartId {
    /// Which of the scene's objects.
    pub(crate) object: u32,
    /// Which of its shape's parts.
    pub(crate) part: u32,
}

/// What a ray is tested against.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Parts {
    /// Over the boxes of `bounded`.
    pub(crate) bvh: Bvh,
    /// In the order of the tree's leaves.
    pub(crate) bounded: Vec<PartId>,
    /// Those that have no end.
    pub(crate) unbounded: Vec<PartId>,
    /// All of them, as they stand in the scene, where the tree is but one leaf and leaves nothing out.
    pub(crate) few: Option<Vec<PartId>>,
}

impl Parts {
    pub(super) fn of(objects: &[Object]) -> Self {
        let built = Self::of_watched(objects, &Watcher::patient());
        built.unwrap_or_else(|| unreachable!("who is patient does not go"))
    }

    /// The same while somebody waits for it; `None` if he has gone.
    pub(super) fn of_watched(objects: &[Object], watcher: &Watcher<'_>) -> Option<Self> {
        let (mut boxes, mut bounded, mut unbounded) = (Vec::new(), Vec::new(), Vec::new());
        for (object, Object { shape, .. }) in (0..).zip(objects) {
            for part in 0..shape.part_count() {
                let id = PartId { object, part };
                if let Some(bounds) = shape.part(part).bounds() {
                    boxes.push(bounds);
                    bounded.push(id);
                } else {
                    unbounded.push(id);
                }
            }
        }
        let (done, total) = (AtomicUsize::new(0), boxes.len());
        let bvh = Bvh::new_unless(&boxes, &|more| {
            let done = done.fetch_add(more, Ordering::Relaxed) + more;
            watcher.tell(Progress { work: Work::Building, done, total })
        })?;
        let few = bvh.is_leaf().then(|| {
            let mut all = [&bounded[..], &unbounded].concat();
            all.sort_unstable();
            all
        });
        let bounded = bvh.order().iter().map(|&at| bounded[at as usize]).collect();
        Some(Self { bvh, bounded, unbounded, few })
    }

    /// How much memory it takes, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let ids = [self.few.as_deref().unwrap_or_default(), &self.bounded, &self.unbounded];
        self.bvh.bytes() + ids.map(size_of_val).iter().sum::<usize>()
    }
}
