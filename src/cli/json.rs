//! `--json`: the results of commands as JSON.
//!
//! Later versions may add fields, but keep the names of all others.

use super::outcome::{CommandResult, write_stdout};
use glam::Vec3;
use serde_json::{Value, json};
use termtrace::{Camera, LinearRgb};

/// Prints a value as indented JSON.
pub(super) fn print(value: &Value) -> CommandResult {
    write_stdout(format!("{value:#}\n").as_bytes())
}

/// Returns a JSON number with the shortest digits that identify the `f32`: 0.1, not 0.10000000149.
pub(super) fn number(value: f32) -> Value {
    value.to_string().parse::<f64>().map_or(Value::Null, Value::from)
}

pub(super) fn vector(value: Vec3) -> Value {
    value.to_array().map(number).to_vec().into()
}

/// Returns linear light as an array of red, green and blue.
pub(super) fn light(value: LinearRgb) -> Value {
    [value.r, value.g, value.b].map(number).to_vec().into()
}

/// Returns the camera as an object with the fields that a scene file has: eye, target and up.
pub(super) fn camera(camera: &Camera) -> Value {
    let pose = camera.pose();
    json!({ "eye": vector(pose.eye), "target": vector(pose.target), "up": vector(pose.up) })
}
