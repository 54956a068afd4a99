//! The cameras and lights of a mesh file.

use crate::color::LinearRgb;
use glam::{Mat3, Vec3};

/// The cameras and lights of a mesh file, in its coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Staging {
    /// The cameras, in the order of the file.
    pub cameras: Vec<FileCamera>,
    /// The lights, in the order of the file.
    pub lights: Vec<FileLight>,
}

/// The position and the orientation of a camera or light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilePlace {
    /// The position, within ±1e9.
    pub position: Vec3,
    /// The direction in which the camera looks or the light shines. Unit length.
    pub forward: Vec3,
    /// The direction that is up in the picture, perpendicular to `forward`. Unit length.
    pub up: Vec3,
}

/// A perspective camera of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileCamera {
    /// The name; empty if the file gives none.
    pub name: String,
    /// The position and the orientation.
    pub place: FilePlace,
    /// The vertical field of view in radians.
    pub vertical_fov: f32,
    /// Width over height of the picture, if the file states it.
    pub aspect_ratio: Option<f32>,
}

/// A light of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileLight {
    /// The position and the orientation.
    pub place: FilePlace,
    /// The colour times the intensity: luminous intensity in candela, or illuminance in lux of a
    /// directional light. Not negative.
    pub intensity: LinearRgb,
    /// The kind of light.
    pub kind: FileLightKind,
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FileLightKind {
    /// Parallel light from infinitely far.
    Directional,
    /// A point source.
    Point,
    /// A point source that shines in a cone.
    Spot {
        /// The angles from the axis, in radians, at which the light begins to fade and ends.
        angles: [f64; 2],
    },
}

impl Staging {
    /// Returns whether there are neither cameras nor lights.
    pub fn is_empty(&self) -> bool {
        self.cameras.is_empty() && self.lights.is_empty()
    }

    /// Returns the cameras and lights rotated about the origin.
    #[must_use]
    pub(super) fn turned(mut self, turn: Mat3) -> Self {
        let cameras = self.cameras.iter_mut().map(|camera| &mut camera.place);
        for place in cameras.chain(self.lights.iter_mut().map(|light| &mut light.place)) {
            let FilePlace { position, forward, up } = *place;
            *place = FilePlace { position: turn * position, forward: turn * forward, up: turn * up };
        }
        self
    }
}
