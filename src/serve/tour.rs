//! The tour: a camera path through a scene, on which all followers see the same at the same time.
//!
//! Pure: the time is a parameter.

use super::guide::{Guide, GuideView};
use super::{HostedScene, Settings};
use crate::camera::Camera;
use crate::camera_path::{CameraPath, PathError};
use crate::capabilities::Capabilities;
use crate::grid::Size;
use crate::maps::Map;
use crate::scene::Scene;
use std::sync::Arc;
use std::time::Duration;

/// The number of pictures per second.
const FRAMES_PER_SECOND: u32 = 10;

/// The time between two ticks, in milliseconds.
const TICK_MILLIS: u64 = 1000 / FRAMES_PER_SECOND as u64;

/// The longest duration of a path in seconds: an hour.
// All cameras are computed when the server starts, so that none of them is found to be invalid during the tour.
const MAX_SECONDS: f64 = 3600.0;

/// The guide of viewers who get the same bytes, and the window and capabilities of their terminals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AudienceClass {
    pub(super) guide: Guide,
    /// The size of the picture in cells.
    pub(super) size: Size,
    pub(super) capabilities: Capabilities,
}

/// A tour through the first scene of the server.
#[derive(Debug)]
pub(super) struct Tour {
    /// The name of the scene.
    name: Arc<str>,
    scene: Scene,
    /// The camera at each tick. There is at least one.
    cameras: Vec<Camera>,
}

/// The limits on the frames of an audience.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AudienceLimits {
    /// The most bytes per second for one follower.
    max_rate: Option<u32>,
    /// The shortest time between two frames.
    interval: Duration,
}

impl AudienceLimits {
    /// Returns the limits of a server with these settings.
    pub(super) fn new(settings: &Settings) -> Self {
        // A tenth less, so that a limit of as many frames as there are ticks skips none of them.
        Self { max_rate: settings.max_rate, interval: Duration::from_secs_f64(0.9 / f64::from(settings.max_frames)) }
    }

    /// Returns the time of the frame after one at `now` that takes `bytes`.
    pub(super) fn next_frame_at(self, now: Duration, bytes: usize) -> Duration {
        let next_tick = Duration::from_millis((Tour::tick_at(now) + 1).saturating_mul(TICK_MILLIS));
        let seconds = self.max_rate.map_or(0.0, |rate| bytes as f64 / f64::from(rate));
        next_tick.max(now + self.interval).max(now + Duration::from_secs_f64(seconds))
    }
}

impl Tour {
    /// Returns the tour along a path through a scene.
    ///
    /// # Errors
    /// If a camera of the path is invalid.
    pub(super) fn new(path: &CameraPath, HostedScene { name, scene, .. }: &HostedScene) -> Result<Self, PathError> {
        let seconds = path.seconds().min(MAX_SECONDS);
        let frames = ((seconds * f64::from(FRAMES_PER_SECOND)).round() as usize).max(1);
        let cameras = path.cameras(frames, FRAMES_PER_SECOND)?;
        Ok(Self { name: name.as_str().into(), scene: scene.clone(), cameras })
    }

    /// Returns the number of the tick that contains a time.
    pub(super) fn tick_at(now: Duration) -> u64 {
        u64::try_from(now.as_millis()).unwrap_or(u64::MAX) / TICK_MILLIS
    }

    /// Returns the view at a tick.
    pub(super) fn view(&self, tick: u64) -> GuideView {
        GuideView { name: Arc::clone(&self.name), scene: self.scene(tick), camera: self.camera(tick), map: Map::Shaded }
    }

    /// Returns the camera at a tick. After the end of the path, the tour starts again.
    fn camera(&self, tick: u64) -> Camera {
        self.cameras[(tick % self.cameras.len() as u64) as usize]
    }

    /// Returns the scene at a tick.
    fn scene(&self, tick: u64) -> Scene {
        self.scene.clone().at_time(tick as f64 / f64::from(FRAMES_PER_SECOND))
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
