//! `--json`: the results of commands as JSON, whose field names stay. Fields may be added.

use super::outcome::{CommandResult, write_stdout};
use glam::Vec3;
use serde_json::{Value, json};
use termtrace::{Camera, LinearRgb};

/// Prints a value, indented.
pub(super) fn print(value: &Value) -> CommandResult {
    write_stdout(format!("{value:#}\n").as_bytes())
}

/// Returns a number with the digits that tell it from other `f32`s, and not those of an `f64`.
pub(super) fn number(value: f32) -> Value {
    value.to_string().parse::<f64>().map_or(Value::Null, Value::from)
}

pub(super) fn vector(value: Vec3) -> Value {
    value.to_array().map(number).to_vec().into()
}

/// Returns linear light as red, green and blue.
pub(super) fn light(value: LinearRgb) -> Value {
    [value.r, value.g, value.b].map(number).to_vec().into()
}

/// Returns the camera in the terms of a scene file.
pub(super) fn camera(camera: &Camera) -> Value {
    let pose = camera.pose();
    json!({ "eye": vector(pose.eye), "target": vector(pose.target), "up": vector(pose.up) })
}
