//! The pictures between two refinements, in a pool that all viewers of a process share.
//!
//! A picture with its samples takes 280 kB at 80x24 cells, more than all else that a viewer keeps. It is kept only from
//! one refinement to the next, not at rest, and only one for each thread that traces.

use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Geometry, ProgressiveRender};
use crate::scene::Scene;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The number of a viewer among those that share a pool.
pub(crate) type ViewerId = u64;

/// A picture with its samples, which the next job of its viewer may refine if it has the same
/// scene, camera and size.
pub(super) struct RefinablePicture {
    scene: Scene,
    view: (Camera, Resolution),
    pub(super) picture: ProgressiveRender,
    pub(super) geometry: Option<Arc<Geometry>>,
}

impl RefinablePicture {
    pub(super) fn new(scene: &Scene, camera: Camera, resolution: Resolution) -> Self {
        let picture = ProgressiveRender::new(&camera, resolution);
        Self { scene: scene.clone(), view: (camera, resolution), picture, geometry: None }
    }

    pub(super) fn has_view_of(&self, scene: &Scene, camera: Camera, resolution: Resolution) -> bool {
        self.scene.is_copy_of(scene) && self.view == (camera, resolution)
    }

    pub(super) fn view(&self) -> (Camera, Resolution) {
        self.view
    }
}

/// The pool of the pictures between two refinements.
///
/// Pictures that are being traced have places, too. If all places are taken, the picture that has waited longest makes
/// room, and its viewer's next refinement begins anew: it takes longer, and gives the same picture.
// A thread traces one picture at a time: with a place for each thread, the pictures that are traced always have one.
pub(super) struct Refinements {
    places: usize,
    occupancy: Mutex<Occupancy>,
}

#[derive(Default)]
struct Occupancy {
    /// The number of pictures that are being traced.
    traced: usize,
    /// The pictures that wait for their next refinement, in the order of their arrival.
    ///
    /// A viewer has at most one.
    waiting: VecDeque<(ViewerId, RefinablePicture)>,
}

impl Occupancy {
    /// Removes the picture of a viewer, if there is one.
    fn take(&mut self, viewer: ViewerId) -> Option<RefinablePicture> {
        let at = self.waiting.iter().position(|&(owner, _)| owner == viewer)?;
        self.waiting.remove(at).map(|(_, picture)| picture)
    }
}

impl Refinements {
    /// Returns a pool with this number of places.
    pub(super) fn new(places: usize) -> Self {
        Self { places, occupancy: Mutex::default() }
    }

    /// Drops the picture of a viewer, if there is one.
    pub(super) fn release(&self, viewer: ViewerId) {
        let released = self.occupancy().take(viewer);
        // Freed after the lock is released.
        drop(released);
    }

    /// Takes a place for a picture that is to be traced.
    ///
    /// Returns the picture that the viewer has kept, too, if there is one.
    pub(super) fn take_place(&self, viewer: ViewerId) -> (Place<'_>, Option<RefinablePicture>) {
        let mut occupancy = self.occupancy();
        let kept = occupancy.take(viewer);
        occupancy.traced += 1;
        let room = self.places.saturating_sub(occupancy.traced);
        let excess = occupancy.waiting.len().saturating_sub(room);
        let evicted: Vec<_> = occupancy.waiting.drain(..excess).collect();
        drop(occupancy);
        drop(evicted);
        (Place { pool: self, viewer, kept: None }, kept)
    }

    // A panic leaves no invalid value behind: a picture that is being traced is not in the pool.
    fn occupancy(&self) -> MutexGuard<'_, Occupancy> {
        self.occupancy.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A place in the pool for a picture that is being traced.
///
/// When this is dropped, the place is that of the kept picture, or free.
pub(super) struct Place<'a> {
    pool: &'a Refinements,
    viewer: ViewerId,
    kept: Option<RefinablePicture>,
}

impl Place<'_> {
    /// Keeps a picture until the viewer's next refinement.
    pub(super) fn keep(mut self, picture: RefinablePicture) {
        self.kept = Some(picture);
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        let mut occupancy = self.pool.occupancy();
        occupancy.traced -= 1;
        occupancy.waiting.extend(self.kept.take().map(|picture| (self.viewer, picture)));
    }
}
