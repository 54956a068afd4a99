//! The rules for the numbers of a scene and their messages, the same for scene files and for code.
//!
//! [`Validator`](crate::written::Validator) applies them to numbers of a scene file and reports their spans. The
//! functions whose names begin with `checked` apply them to parameters in code and report their names.

use crate::color::LinearRgb;
use glam::{DVec3, Vec3};
use std::borrow::Cow;
use std::fmt;

/// The largest magnitude of a coordinate.
// The computation of hits squares lengths twice. (1e9)^4 = 1e36 leaves a factor of 340 for sums below the largest f32,
// 3.4e38.
const MAX_COORDINATE: f64 = 1e9;

/// The least length.
// This length, squared twice, is 1e-36, above the least normal f32, 1.2e-38.
const MIN_LENGTH: f64 = 1e-9;

/// The largest amount of light.
// Sums over lights and products with the exposure stay far below the largest f32, 3.4e38.
const MAX_LIGHT: f64 = 1e12;
/// The largest exposure.
// Products with light stay far below the largest f32, 3.4e38.
const MAX_EXPOSURE: f64 = 1e6;

/// The largest ratio between two of a view rectangle's width, height and focal length.
const MAX_RATIO: f64 = 1e6;

/// The message for an invalid value: one line without a full stop, which says what would be right
/// where possible.
pub(crate) type Message = Cow<'static, str>;

/// The error of a value that no scene may have, given in code.
///
/// Its message has the name of the value, the value, and the message of a scene file's error.
///
/// ```
/// use termtrace::{LinearRgb, PointLight};
///
/// let error = PointLight::new(glam::Vec3::ZERO, LinearRgb::grey(-1.0)).unwrap_err();
/// assert_eq!(error.to_string(), "intensity is (-1, -1, -1): light must not be negative");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFault {
    subject: Message,
    message: Message,
}

impl SceneFault {
    /// Returns the error of `subject`, which is the name of a value, or its name and the value.
    pub(crate) fn new(subject: impl Into<Message>, message: impl Into<Message>) -> Self {
        Self { subject: subject.into(), message: message.into() }
    }

    /// Returns the message without the value and its name, as errors in scene files have it.
    #[doc(hidden)]
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for SceneFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.subject, self.message)
    }
}

impl std::error::Error for SceneFault {}

/// Returns whether a number is within `least` and `most` after it is rounded to f32.
///
/// Because of the rounding, a stored value that is written back to a file is accepted again.
fn is_within(value: f64, least: f64, most: f64) -> bool {
    (least as f32..=most as f32).contains(&(value as f32))
}

/// Checks that a number is finite.
pub(crate) fn finite(value: f64) -> Result<f64, Message> {
    if value.is_finite() { Ok(value) } else { Err("the number must be finite".into()) }
}

/// Checks that a coordinate is within the range that rays can be traced in.
pub(crate) fn coordinate(value: f64) -> Result<f32, Message> {
    if value.abs() <= MAX_COORDINATE { Ok(value as f32) } else { Err(TOO_FAR.into()) }
}

pub(crate) const TOO_FAR: &str =
    "coordinates must lie within ±1e9; light cannot be followed farther in single precision";

/// Returns whether all points are within the range that rays can be traced in.
pub(crate) fn are_within_range(points: &[Vec3]) -> bool {
    points.iter().all(|point| f64::from(point.abs().max_element()) <= MAX_COORDINATE)
}

/// The message for a mesh that is not [within range](are_within_range).
pub(crate) const MESH_TOO_FAR: &str = "this mesh reaches beyond ±1e9; scale it down, or light cannot be followed";

/// Checks that a length is positive and can be squared twice in f32; `what` is its name for
/// messages.
pub(crate) fn length(what: &str, value: f64) -> Result<f32, Message> {
    if value <= 0.0 {
        return Err(format!("the {what} must be greater than 0").into());
    }
    if !is_within(value, MIN_LENGTH, MAX_COORDINATE) {
        return Err(format!("the {what} must lie between 1e-9 and 1e9").into());
    }
    Ok(value as f32)
}

/// Checks that `length`, the distance of two points named `from` and `to`, is not too small.
pub(crate) fn distance(from: &str, to: &str, length: f64) -> Result<f64, Message> {
    if length < MIN_LENGTH {
        return Err(format!("{from} and {to} must be different points, at least 1e-9 apart").into());
    }
    Ok(length)
}

/// Checks a scale factor along an axis, which may be negative, to mirror a mesh, but not 0.
pub(crate) fn nonzero_factor(value: f64) -> Result<f32, Message> {
    if is_within(value.abs(), MIN_LENGTH, MAX_COORDINATE) {
        Ok(value as f32)
    } else {
        Err("a factor must lie between 1e-9 and 1e9, or be as far below 0".into())
    }
}

/// Checks a number of copies.
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have copies"))]
pub(crate) fn copy_count(copies: f64) -> Result<f32, Message> {
    if copies >= 1.0 && libm::trunc(copies) == copies {
        Ok(copies as f32)
    } else {
        Err("a number of copies must be a whole number from 1 on".into())
    }
}

/// Checks an angle of a rotation in degrees, and returns it in degrees.
pub(crate) fn angle_in_degrees(degrees: f64) -> Result<f32, Message> {
    const MAX_ANGLE: f64 = 36_000.0;
    if degrees.abs() <= MAX_ANGLE { Ok(degrees as f32) } else { Err("an angle must lie within ±36000 degrees".into()) }
}

/// Checks the angle of a light's whole cone in degrees, and returns it in degrees.
pub(crate) fn cone_angle(degrees: f64) -> Result<f32, Message> {
    // Unit vectors in f32 are exact to about 1e-7, which is a hundredth of the least angle.
    if is_within(degrees, 0.001, 180.0) {
        Ok(degrees as f32)
    } else {
        Err("the angle of a cone must lie between 0.001 and 180 degrees".into())
    }
}

/// Checks the angular diameter of a sun in degrees, and returns it in degrees.
pub(crate) fn sun_size(degrees: f64) -> Result<f32, Message> {
    if (0.0..=90.0).contains(&degrees) {
        Ok(degrees as f32)
    } else {
        Err("the size of a sun must lie between 0 and 90 degrees".into())
    }
}

/// Checks the softness of a light's cone: the share of half its angle in which the light fades.
pub(crate) fn softness(share: f64) -> Result<f32, Message> {
    if (0.0..=1.0).contains(&share) { Ok(share as f32) } else { Err("the softness must lie within 0 and 1".into()) }
}

/// Checks an amount of light; `what` is its name for messages.
pub(crate) fn light_amount(what: &str, value: f64) -> Result<f32, Message> {
    if value < 0.0 {
        return Err(format!("{what} must not be negative").into());
    }
    if value > MAX_LIGHT {
        return Err(format!("{what} must be at most 1e12").into());
    }
    Ok(value as f32)
}

/// Checks a channel of light.
pub(crate) fn light(channel: f64) -> Result<f32, Message> {
    light_amount("light", channel)
}

/// Checks a channel of a reflectance, which is from 0 to 1.
pub(crate) fn reflectance(channel: f64) -> Result<f32, Message> {
    if (0.0..=1.0).contains(&channel) {
        Ok(channel as f32)
    } else {
        Err("a reflectance must lie within 0 and 1; no surface reflects more light than it gets".into())
    }
}

/// Checks an opacity.
pub(crate) fn opacity(part: f64) -> Result<f32, Message> {
    if (0.0..=1.0).contains(&part) { Ok(part as f32) } else { Err("the opacity must lie within 0 and 1".into()) }
}

/// Checks a number of reflections and refractions.
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have bounces"))]
pub(crate) fn bounces(count: f64) -> Result<u32, Message> {
    // Glass may split a ray in two at each bounce; `shade::bounces` bounds the number of rays.
    const MAX_BOUNCES: f64 = 16.0;
    if (0.0..=MAX_BOUNCES).contains(&count) && libm::trunc(count) == count {
        Ok(count as u32)
    } else {
        Err("the number of bounces must be a whole number from 0 to 16".into())
    }
}

/// Checks an exposure.
pub(crate) fn exposure(value: f64) -> Result<f32, Message> {
    // The second comparison rejects numbers that f32 rounds to 0, which would make the picture black.
    if value > 0.0 && value as f32 > 0.0 && value <= MAX_EXPOSURE {
        return Ok(value as f32);
    }
    let wanted = if value <= 0.0 { "greater than 0" } else { "between 1e-45 and 1e6" };
    Err(format!("the exposure must be {wanted}").into())
}

/// Returns a vector scaled to unit length, in f64, so that the caller rounds only once; `what` is
/// its name for messages.
pub(crate) fn unit_vector(what: &str, vector: DVec3) -> Result<DVec3, Message> {
    let largest = vector.abs().max_element();
    if largest == 0.0 {
        return Err(format!("the {what} must have a length; (0, 0, 0) points nowhere").into());
    }
    // Divides by the largest coordinate first, so that the square of a tiny vector does not underflow.
    let vector = vector / largest;
    Ok(vector / vector.dot(vector).sqrt())
}

/// Checks that three corners are not on one line.
pub(crate) fn corners(corners: [Vec3; 3]) -> Result<[Vec3; 3], Message> {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    // Both differences are exact in f64, or their errors are too small to make the product 0.
    if (b - a).cross(c - a) == DVec3::ZERO {
        return Err("the corners of a triangle must not lie on one line; no ray would meet it".into());
    }
    Ok(corners)
}

/// Returns whether the ratio of two lengths, such as an aspect ratio, is within its limits.
pub(crate) fn is_ratio_within_range(ratio: f64) -> bool {
    is_within(ratio, 1.0 / MAX_RATIO, MAX_RATIO)
}

/// Returns whether an up vector is long enough to be squared twice in f32.
pub(crate) fn is_long_enough(vector: Vec3) -> bool {
    vector.abs().max_element() >= MIN_LENGTH as f32
}

/// Returns whether a point is within the range that rays can be traced in.
pub(crate) fn is_within_range(point: DVec3) -> bool {
    point.abs().max_element() <= MAX_COORDINATE
}

// Parameters of constructors
// --------------------------------------------------------------------------------------------

/// Checks a number that is given in code, by `rule`.
pub(crate) fn checked_number(
    name: &'static str,
    value: f32,
    rule: impl FnOnce(f64) -> Result<f32, Message>,
) -> Result<f32, SceneFault> {
    let checked = finite(value.into()).and_then(rule);
    checked.map_err(|message| SceneFault::new(format!("{name} is {value}"), message))
}

/// Checks the coordinates of a vector that is given in code, and returns the result of `rule`
/// for it.
fn checked_vector<T>(
    name: impl fmt::Display,
    vector: Vec3,
    rule: impl FnOnce(DVec3) -> Result<T, Message>,
) -> Result<T, SceneFault> {
    let numbers = vector.as_dvec3();
    let checked = numbers.to_array().into_iter().try_for_each(|number| {
        finite(number)?;
        coordinate(number).map(drop)
    });
    checked.and_then(|()| rule(numbers)).map_err(|message| {
        let Vec3 { x, y, z } = vector;
        SceneFault::new(format!("{name} is ({x}, {y}, {z})"), message)
    })
}

/// Checks a point that is given in code.
pub(crate) fn checked_point(name: impl fmt::Display, point: Vec3) -> Result<Vec3, SceneFault> {
    checked_vector(name, point, |_| Ok(point))
}

/// Checks a direction that is given in code, with any length but 0, and returns it with unit
/// length.
pub(crate) fn checked_direction(name: &'static str, direction: Vec3) -> Result<Vec3, SceneFault> {
    checked_vector(name, direction, |numbers| unit_vector(name, numbers)).map(DVec3::as_vec3)
}

/// Checks each channel of a colour that is given in code, by `rule`.
pub(crate) fn checked_color(
    name: &'static str,
    color: LinearRgb,
    rule: impl Fn(f64) -> Result<f32, Message>,
) -> Result<LinearRgb, SceneFault> {
    let LinearRgb { r, g, b } = color;
    let checked = [r, g, b].into_iter().try_for_each(|channel| {
        finite(channel.into())?;
        rule(channel.into()).map(drop)
    });
    checked.map_err(|message| SceneFault::new(format!("{name} is ({r}, {g}, {b})"), message))?;
    Ok(color)
}
