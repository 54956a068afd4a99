//! A frame that is wanted, and one that is done.

use super::shown::Shown;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::render::{Cost, Sampling};
use crate::scene::Scene;
use crate::tone::Picture;
use std::time::Duration;

/// What a frame is to show: of two that are equal, the pictures are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shot {
    /// Which of the scenes that were shown one after the other.
    pub(crate) scene: u32,
    /// How many times lights of it have been moved.
    pub(crate) lights: u32,
    pub(crate) camera: Camera,
    pub(crate) resolution: Resolution,
    pub(crate) shown: Shown,
}

impl Shot {
    /// Whether a frame of this takes about as long as one of the other: only the camera or the light may differ.
    pub(super) fn takes_as_long_as(&self, other: &Self) -> bool {
        let about = |shot: &Self| (shot.scene, shot.resolution, shot.shown);
        about(self) == about(other)
    }
}

/// A frame that is to be traced.
#[derive(Clone)]
pub(crate) struct Job {
    pub(crate) scene: Scene,
    pub(crate) shot: Shot,
    pub(crate) sampling: Sampling,
    /// The shot is that of the last frame, which is gone on with if it can be. The job may be given up.
    pub(crate) refines: bool,
}

/// A frame that is done.
pub(crate) struct Frame {
    pub(crate) scene: Scene,
    pub(crate) shot: Shot,
    pub(crate) picture: Picture,
    /// The pictures that it is made of, as far as they can be put together in another way.
    pub(crate) parts: Vec<Picture>,
    pub(crate) sampling: Sampling,
    /// What the colours mean, from left to right; nothing where they are light.
    pub(crate) legends: Vec<String>,
    /// Whether it shows the same as the one before, only better.
    pub(crate) refines: bool,
    /// What it took, beside the frame that it refines.
    pub(crate) cost: Cost,
    /// How long that took on the clock.
    pub(crate) trace: Duration,
}

impl Frame {
    /// From where it is seen.
    pub(super) fn camera(&self) -> &Camera {
        &self.shot.camera
    }

    /// How many pixels there are.
    pub(super) fn resolution(&self) -> Resolution {
        self.shot.resolution
    }

    /// Of two maps side by side, each is a picture of its own: how large the one is that has this pixel, and which of its
    /// pixels it is. (That of the line between them is the last of the left one.)
    pub(super) fn part_at(&self, [x, y]: [u32; 2]) -> (Resolution, [u32; 2]) {
        let resolution = self.resolution();
        match *self.shot.shown.parts(resolution) {
            [(_, left), (_, right)] if left.width() < resolution.width() => match x.checked_sub(left.width() + 1) {
                Some(x) if x < right.width() => (right, [x, y]),
                _ => (left, [x.min(left.width() - 1), y]),
            },
            _ => (resolution, [x, y]),
        }
    }

    /// Moves the line between two maps, if there is one, to that share of the width.
    pub(super) fn wipe(&mut self, share: f32) {
        if let Some(picture) = self.shot.shown.joined(&self.parts, share) {
            self.picture = picture;
        }
    }
}
