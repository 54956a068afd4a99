//! The error of shapes that code cannot make.

use crate::checks::SceneFault;
use std::fmt;

/// The reason why there is no such shape: what is wrong with which value, in the words of a scene file's error.
///
/// ```
/// use glam::Vec3;
/// use termtrace::Sphere;
///
/// let error = Sphere::new(Vec3::ZERO, -1.0).unwrap_err();
/// assert_eq!(error.to_string(), "radius is -1: the radius must be greater than 0");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShapeError(SceneFault);

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for ShapeError {}

impl From<SceneFault> for ShapeError {
    fn from(fault: SceneFault) -> Self {
        Self(fault)
    }
}

impl From<ShapeError> for SceneFault {
    fn from(error: ShapeError) -> Self {
        error.0
    }
}
