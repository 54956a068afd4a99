//! A requested frame and a finished one.

use super::view_layout::ViewLayout;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Cost, Sampling};
use crate::scene::Scene;
use crate::tone::Picture;
use std::time::Duration;

/// The content of a frame. Equal shots have equal pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shot {
    /// Serial number of the scene: a scene that is loaded again gets another one.
    pub(crate) scene: u32,
    /// Number of times that its lights have been moved.
    pub(crate) lights: u32,
    pub(crate) camera: Camera,
    pub(crate) resolution: Resolution,
    pub(crate) layout: ViewLayout,
}

impl Shot {
    /// Returns whether tracing takes about as long as for `other`.
    ///
    /// Only the camera or the lights may differ.
    pub(super) fn takes_as_long_as(&self, other: &Self) -> bool {
        // The cost of a view changes gradually with the camera, that of another scene or size at once.
        let about = |shot: &Self| (shot.scene, shot.resolution, shot.layout);
        about(self) == about(other)
    }
}

/// A frame to trace.
#[derive(Clone)]
pub(crate) struct Job {
    pub(crate) scene: Scene,
    pub(crate) shot: Shot,
    pub(crate) sampling: Sampling,
    /// Whether to refine the last frame, which has the same shot, if that is possible.
    ///
    /// Such a job may be cancelled.
    pub(crate) refines: bool,
}

/// A finished frame.
pub(crate) struct Frame {
    pub(crate) scene: Scene,
    pub(crate) shot: Shot,
    pub(crate) picture: Picture,
    /// The pictures that it was combined from, if they can be combined in another way.
    // Empty for one map and for two side by side, to save their memory.
    pub(crate) parts: Vec<Picture>,
    pub(crate) sampling: Sampling,
    /// The legends of the maps, from left to right; empty where the picture shows light.
    pub(crate) legends: Vec<String>,
    /// Whether it shows the same as the frame before, with more samples.
    pub(crate) refines: bool,
    /// The cost of tracing, without that of the frame that it refines.
    pub(crate) cost: Cost,
    /// The time that tracing took on the clock.
    pub(crate) trace: Duration,
}

impl Frame {
    /// Returns the camera.
    pub(super) fn camera(&self) -> &Camera {
        &self.shot.camera
    }

    /// Returns the size of the picture in pixels.
    pub(super) fn resolution(&self) -> Resolution {
        self.shot.resolution
    }

    /// Returns the size of the picture that contains a pixel, and the pixel's coordinates there.
    ///
    /// Of two maps side by side, each is a picture of its own. (A pixel of the line between them counts as the last one
    /// of the left map.)
    pub(super) fn part_at(&self, [x, y]: [u32; 2]) -> (Resolution, [u32; 2]) {
        let resolution = self.resolution();
        match *self.shot.layout.parts(resolution) {
            [(_, left), (_, right)] if left.width() < resolution.width() => match x.checked_sub(left.width() + 1) {
                Some(x) if x < right.width() => (right, [x, y]),
                _ => (left, [x.min(left.width() - 1), y]),
            },
            _ => (resolution, [x, y]),
        }
    }

    /// Moves the line between two maps, if there is one, to this share of the width.
    pub(super) fn wipe(&mut self, share: f32) {
        // From the parts, which are kept for this: nothing is traced.
        if let Some(picture) = self.shot.layout.combined(&self.parts, share) {
            self.picture = picture;
        }
    }
}
