//! The imports of a typical program: a scene from a file or in code, its picture, and its text.
//!
//! ```
//! use termtrace::prelude::*;
//!
//! let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 1)])";
//! let scene = Scene::from_ron("ball.ron", text)?;
//! assert_eq!(text_frame(&scene, Size::new(40, 12)).lines().count(), 12);
//! # Ok::<(), termtrace::SceneError>(())
//! ```

pub use crate::camera::{Camera, Pose, ViewRectangle};
pub use crate::color::LinearRgb;
pub use crate::export::text_frame;
pub use crate::framebuffer::Resolution;
pub use crate::grid::Size;
pub use crate::light::{Light, PointLight};
pub use crate::material::Material;
pub use crate::render::{Render, Sampling, render};
pub use crate::scene::{Background, Object, Scene, ToneCurve};
pub use crate::shape::{Plane, Sphere, Triangle};
pub use crate::tone::tone;
pub use glam::Vec3;
