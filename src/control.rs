//! Keys + camera -> camera, pure: what each key does, and how held keys move the eye.
//!
//! Time is a number that is handed in, so that every movement can be tested without a clock.

mod bindings;
mod motion;

pub use bindings::{BINDINGS, Binding, Command, Direction, Key, Side, Turn, command};
pub use motion::{COAST, GLIDE, Motion, speed};
