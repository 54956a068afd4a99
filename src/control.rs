//! The keymap, the gestures of the mouse, and the motion of the camera by held keys.
//!
//! Functions take the time as a parameter, so that every motion can be tested without a clock.

mod command;
mod key;
mod keymap;
mod user_keymap;
mod camera_moves;
mod motion;
mod pointer;

// `Grip` is exported with `dragged` and `Gesture`, because their signatures contain it.
pub use crate::camera::Grip;
pub use camera_moves::{dragged, on_turntable, speed, wheeled};
pub use command::{Command, Direction, ScreenSide, Toward};
pub use key::Key;
pub use keymap::{Binding, KeyMode, Keymap};
pub use motion::{AGAIN_TIME, COAST_TIME, KeySpeed, Motion, TAP_TIME};
pub use pointer::{Gesture, Pointer};
