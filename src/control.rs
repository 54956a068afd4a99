//! The keymap, the gestures of the mouse, and the motion of the camera by held keys.
//!
//! Pure: times are passed in, so that every motion can be tested without a clock.

mod command;
mod key;
mod keymap;
mod user_keymap;
mod camera_moves;
mod motion;
mod pointer;

// Part of the signatures of `dragged` and `Gesture`.
pub use crate::camera::Grip;
pub use camera_moves::{dragged, on_turntable, speed, wheeled};
pub use command::{Command, Direction, Side, Toward};
pub use key::Key;
pub use keymap::{Binding, KeyMode, Keymap};
pub use motion::{COAST_TIME, GLIDE_TIME, KeySpeed, Motion};
pub use pointer::{Gesture, Pointer};
