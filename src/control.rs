//! Keys, mouse + camera -> camera, pure: what each key does, what the mouse does, and how the eye moves.
//!
//! Time is a number that is handed in, so that every movement can be tested without a clock.

mod command;
mod key;
mod keymap;
mod user_keymap;
mod camera_moves;
mod motion;
mod pointer;

// Drags are said in the words of what they move.
pub use crate::camera::Grip;
pub use camera_moves::{dragged, on_turntable, speed, wheeled};
pub use command::{Command, Direction, Side, Toward};
pub use key::Key;
pub use keymap::{Binding, KeyMode, Keymap};
pub use motion::{COAST_TIME, GLIDE_TIME, KeySpeed, Motion};
pub use pointer::{Gesture, Pointer};
