//! Guides, whose views others follow.

use super::run_queue::SessionId;
use crate::camera::Camera;
use crate::maps::Map;
use crate::scene::Scene;
use std::sync::Arc;

/// The one whose view others follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guide {
    /// The tour: its leader, or else its path.
    Tour,
    /// A viewer.
    Viewer(SessionId),
}

/// The view that a guide shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GuideView {
    /// The name of the scene on the server.
    pub(super) name: Arc<str>,
    /// The scene at its current time, with its lights as moved.
    pub(super) scene: Scene,
    pub(super) camera: Camera,
    pub(super) map: Map,
}
