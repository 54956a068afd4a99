//! The pictures of scenes as they are first seen, which are traced once for all viewers.
//!
//! A new viewer sees the scene's own camera, at rest, refined to the final picture. Pictures of other cameras are not
//! kept, because each viewer moves a camera of their own.

use crate::viewer::{Frame, Job};
use std::collections::VecDeque;
use std::sync::Arc;

/// The largest number of pictures that are kept; each scene has one for each window size.
const MAX_PICTURES: usize = 32;

/// The most pixels of a picture that is kept, about those of 200x60 cells.
const MAX_PIXELS: usize = 30_000;

/// The pictures that were last asked for, the latest one at the end.
#[derive(Default)]
pub(super) struct Pictures(VecDeque<Arc<Frame>>);

impl Pictures {
    /// Returns the picture that a job asks for, if it has been traced before.
    pub(super) fn get(&mut self, job: &Job) -> Option<Arc<Frame>> {
        let at = self.0.iter().position(|frame| is_of(frame, job))?;
        let frame = self.0.remove(at)?;
        self.0.push_back(Arc::clone(&frame));
        Some(frame)
    }

    /// Keeps a picture. If there are too many, the least recently used one is dropped.
    pub(super) fn keep(&mut self, frame: Arc<Frame>) {
        if self.0.len() >= MAX_PICTURES {
            self.0.pop_front();
        }
        self.0.push_back(frame);
    }
}

/// Returns whether other viewers will probably ask for the picture of this job.
pub(super) fn is_worth_sharing(job: &Job) -> bool {
    let Job { scene, shot, .. } = job;
    // The pictures of a moving scene are not shared, because each of its times is a separate copy of the scene.
    shot.camera == *scene.camera()
        && shot.resolution.pixel_count() <= MAX_PIXELS
        && !(shot.geometry || shot.orders || scene.depends_on_time())
}

fn is_of(frame: &Frame, job: &Job) -> bool {
    let Job { scene, shot, sampling, .. } = job;
    // The scene's serial number and the number of light moves are not compared, because each viewer counts its own.
    let (scene_number, lights) = (frame.shot.scene, frame.shot.lights);
    frame.sampling == *sampling
        && frame.shot == crate::viewer::Shot { scene: scene_number, lights, ..*shot }
        && frame.scene.is_copy_of(scene)
}
