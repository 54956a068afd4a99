//! A frame to trace (`Job`), a traced frame (`Frame`), and what both show (`Shot`).

use super::view_layout::ViewLayout;
use crate::camera::Camera;
use crate::framebuffer::Resolution;
use crate::maps::Map;
use crate::rasterize::Comparison;
use crate::render::{Cost, Geometry, Sampling};
use crate::scene::Scene;
use crate::tone::Picture;
use std::sync::Arc;
use std::time::Duration;

/// Everything that determines what a frame shows. Equal shots have equal pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shot {
    /// Serial number of the scene: a scene that is loaded again gets another one.
    pub(crate) scene: u32,
    /// Number of times that the scene's lights have been moved.
    pub(crate) lights: u32,
    /// The time of a scene that moves, else 0.
    pub(crate) time: Duration,
    pub(crate) camera: Camera,
    /// The camera of the right picture, which shows the first camera and its rays from outside, if
    /// there is one.
    pub(crate) outside: Option<Camera>,
    pub(crate) resolution: Resolution,
    pub(crate) layout: ViewLayout,
    /// Whether image order and object order build the picture side by side.
    pub(crate) orders: bool,
    /// Whether the glyphs of the cells show the geometry, which is then traced besides the picture.
    pub(crate) geometry: bool,
}

impl Shot {
    /// Returns the maps to trace, each with its own size in pixels and its camera.
    pub(crate) fn parts(&self) -> Vec<(Map, Resolution, Camera)> {
        let cameras = [self.camera, self.outside.unwrap_or(self.camera)];
        let sizes = self.layout.map_sizes(self.resolution);
        sizes.into_iter().zip(cameras).map(|((map, size), camera)| (map, size, camera)).collect()
    }

    /// Returns whether tracing this shot probably takes about as long as tracing `other`.
    ///
    /// This holds if the shots differ only in the camera, the lights or the time.
    pub(super) fn takes_as_long_as(&self, other: &Self) -> bool {
        // The cost changes gradually with the camera, but abruptly with the scene, the size or the maps.
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
    /// Whether to add samples to the last frame if it has the same shot. Only such a job may be
    /// cancelled.
    pub(crate) refines: bool,
}

/// A traced frame, with the shot that it shows.
#[derive(Clone)]
pub(crate) struct Frame {
    pub(crate) scene: Scene,
    pub(crate) shot: Shot,
    pub(crate) picture: Picture,
    /// The geometry that the glyphs of the cells show; `None` for other glyphs and for two views
    /// side by side.
    pub(crate) geometry: Option<Arc<Geometry>>,
    /// The two maps that `picture` is combined from in a wipe, so that moving the line traces
    /// nothing.
    // The list is empty for one map and for two side by side, to save memory.
    pub(crate) parts: Vec<Picture>,
    pub(crate) sampling: Sampling,
    /// The legends of the maps, from left to right; empty for the shaded picture alone.
    pub(crate) legends: Vec<String>,
    /// The comparison of image order with object order; `None` for a refinement, and unless
    /// `Shot::orders` is set.
    pub(crate) orders: Option<Arc<Comparison>>,
    /// Whether this frame shows the view of the frame before, with more samples or finer glyphs.
    pub(crate) refines: bool,
    /// The cost of tracing, without the cost of the frame that this frame refines.
    pub(crate) cost: Cost,
    /// The wall-clock time that tracing took.
    pub(crate) trace: Duration,
    /// The time from which the sampling of the next frames is chosen: that of tracing or, on a
    /// server, the same share of the expected time between two frames of this viewer.
    pub(crate) interval: Duration,
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

    /// Returns the size of the map that contains pixel `[x, y]` of the picture, and the pixel's
    /// coordinates in it.
    ///
    /// Two maps side by side have a size each. (A pixel of the line between them counts as the last one in its row of
    /// the left map.)
    pub(super) fn part_at(&self, [x, y]: [u32; 2]) -> (Resolution, [u32; 2]) {
        let resolution = self.resolution();
        match *self.shot.layout.map_sizes(resolution) {
            [(_, left), (_, right)] if left.width() < resolution.width() => {
                // A pixel in the rows that a panel covers counts as the lowest pixel of the map in its column.
                let y = y.min(left.height().saturating_sub(1));
                match x.checked_sub(left.width() + 1) {
                    Some(x) if x < right.width() => (right, [x, y]),
                    _ => (left, [x.min(left.width() - 1), y]),
                }
            }
            _ => (resolution, [x, y]),
        }
    }

    /// Moves the line between two maps of a wipe, if there is one, to this share of the width.
    pub(crate) fn wipe_to(&mut self, share: f32) {
        // The picture is combined from the kept maps again, and nothing is traced.
        if let Some(picture) = self.shot.layout.combined(&self.parts, share) {
            self.picture = picture;
        }
    }
}
