//! Formatting of cameras as text for a scene file.

use crate::camera::{Camera, DEFAULT_FOV_DEGREES, Pose, ViewRectangle, radians};
use glam::{Vec2, Vec3};

impl Camera {
    /// Returns the camera as text for a scene file: `camera: (eye: ..., target: ..., ...)`.
    ///
    /// Each number has the fewest digits that are read back with the same bits. Fields with their default values are
    /// left out.
    ///
    /// ```
    /// use termtrace::Scene;
    ///
    /// let line = "camera: (eye: (0, 1.5, 6), target: (0, 0.7, 0), vertical_fov: 40)";
    /// let scene = Scene::from_ron("x.ron", &format!("({line})"))?;
    /// assert_eq!(scene.camera().to_ron(), line);
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    #[doc(hidden)]
    pub fn to_ron(&self) -> String {
        format!("camera: {}", self.value_to_ron())
    }

    /// Returns the value of the field `camera` as text: `(eye: ..., target: ..., ...)`.
    pub(super) fn value_to_ron(&self) -> String {
        let Pose { eye, target, up } = self.pose();
        let rectangle = self.rectangle();
        let mut fields = vec![format!("eye: {}", vector_text(eye)), format!("target: {}", vector_text(target))];
        if up != Vec3::Y {
            fields.push(format!("up: {}", vector_text(up)));
        }
        fields.extend(non_default_lens_fields(&rectangle));
        let shift = rectangle.shift();
        if shift != Vec2::ZERO {
            fields.push(format!("shift: ({}, {})", number_text(shift.x), number_text(shift.y)));
        }
        if rectangle.tilt() != Vec2::ZERO {
            let [right, up] = rectangle.tilt().to_array().map(degrees_text);
            fields.push(format!("tilt: ({right}, {up})"));
        }
        format!("({})", fields.join(", "))
    }

    /// Returns the camera as flags of the command line: `--eye ... --target ... --fov ...`.
    #[doc(hidden)]
    pub fn to_flags(&self) -> String {
        let Pose { eye, target, up } = self.pose();
        let point = |Vec3 { x, y, z }: Vec3| format!("{x},{y},{z}");
        let up = if up == Vec3::Y { String::new() } else { format!(" --up {}", point(up)) };
        let rectangle = self.rectangle();
        let degrees = (100.0 * rectangle.vertical_fov().to_degrees()).round() / 100.0;
        let tilt = rectangle.tilt() * 1_f32.to_degrees();
        let offsets = [("shift", rectangle.shift()), ("tilt", (1e3 * tilt).round() / 1e3)].into_iter();
        let offsets: Vec<_> = offsets
            .filter(|(_, by)| *by != Vec2::ZERO)
            .map(|(name, Vec2 { x, y })| format!(" --{name} {x},{y}"))
            .collect();
        format!("--eye {} --target {}{up} --fov {degrees}{}", point(eye), point(target), offsets.concat())
    }

    /// Returns the camera with its numbers rounded to what a picture resolves.
    ///
    /// In a picture of a thousand rows, eye and target move by less than a tenth of a pixel at the distance of the
    /// target. A camera that cannot be rounded is returned as it is.
    #[doc(hidden)]
    #[must_use]
    pub fn rounded(&self) -> Self {
        let (pose, rectangle) = (self.pose(), self.rectangle());
        let pixel = 1e-3 * f64::from(rectangle.height()) * f64::from(pose.eye.distance(pose.target));
        let digits = -libm::floor(libm::log10(0.1 * pixel));
        let point = |v: Vec3| Vec3::from_array(v.to_array().map(|x| rounded_to_decimals(x.into(), digits) as f32));
        let up = Vec3::from_array(pose.up.to_array().map(|x| rounded_to_decimals(x.into(), 4.0) as f32));
        let camera = self.with_pose(Pose { eye: point(pose.eye), target: point(pose.target), up }).unwrap_or(*self);
        let numbers =
            |v: Vec2, scale: f64| v.to_array().map(|x| rounded_to_decimals(scale * f64::from(x), 3.0) / scale);
        let [shift, tilt] = [numbers(rectangle.shift(), 1.0), numbers(rectangle.tilt(), 1_f64.to_degrees())]
            .map(|[x, y]| Vec2::new(x as f32, y as f32));
        let rectangle = rectangle.with_shift(shift).and_then(|shifted| shifted.with_tilt(tilt)).unwrap_or(rectangle);
        let camera = camera.with_rectangle(rectangle);
        // The field of view is not rounded if the view rectangle has a width, because the author has then chosen the
        // rectangle's exact shape.
        let angle = rounded_to_decimals(approximate_degrees(&rectangle), 2.0);
        match rectangle.with_vertical_fov(radians(angle)) {
            Ok(rounded) if rectangle.width().is_none() => camera.with_rectangle(rounded),
            _ => camera,
        }
    }
}

/// Returns `x` rounded to this number of decimals.
fn rounded_to_decimals(x: f64, decimals: f64) -> f64 {
    // The scale is a power of ten with an exponent of 0 or more, because 0.1 is not exact in binary. Adding 0 turns -0
    // into 0.
    let scale = libm::pow(10.0, decimals.clamp(0.0, 20.0));
    (x * scale).round() / scale + 0.0
}

pub(super) fn vector_text(v: Vec3) -> String {
    format!("({}, {}, {})", number_text(v.x), number_text(v.y), number_text(v.z))
}

/// Returns the shortest decimal that is read back as `x`.
pub(super) fn number_text(x: f32) -> String {
    let plain = x.to_string();
    // `to_string` never writes an exponent: 1e-30 would have 31 digits.
    let short = if plain.len() > 16 { format!("{x:e}") } else { plain };
    // The reader rounds twice: to f64, then to f32. The few numbers for which this gives another f32 are written with
    // all their digits.
    if parses_as(&short, |value| value as f32 == x) { short } else { f64::from(x).to_string() }
}

fn parses_as(text: &str, is_right: impl Fn(f64) -> bool) -> bool {
    text.parse().is_ok_and(is_right)
}

/// Returns the fields of the lens; `None` for the default angle without a width.
///
/// A rectangle without a width has an angle in degrees. One with a width has an angle and an aspect ratio if both are
/// short and are read back with the same bits, otherwise f, w and h with f = 1.
fn non_default_lens_fields(rectangle: &ViewRectangle) -> Option<String> {
    let Some(width) = rectangle.width() else {
        let degrees = fov_degrees_text(rectangle).unwrap_or_else(|| approximate_degrees(rectangle).to_string());
        return (degrees != DEFAULT_FOV_DEGREES.to_string()).then(|| format!("vertical_fov: {degrees}"));
    };
    Some(match (fov_degrees_text(rectangle), aspect_ratio_text(rectangle, width)) {
        // If the angle or the ratio needs more digits than this, the author probably gave f, w and h.
        (Some(degrees), Some(ratio)) if degrees.len() <= 6 && ratio.len() <= 9 => {
            format!("vertical_fov: {degrees}, aspect_ratio: {ratio}")
        }
        _ => {
            let (width, height) = (number_text(width), number_text(rectangle.height()));
            format!("focal_length: 1, width: {width}, height: {height}")
        }
    })
}

/// Returns an angle in degrees, with the fewest digits that are read back with the same bits.
fn degrees_text(angle: f32) -> String {
    let degrees = f64::from(angle).to_degrees();
    shortest_decimal(degrees, |value| radians(value) == angle).unwrap_or_else(|| degrees.to_string())
}

fn approximate_degrees(rectangle: &ViewRectangle) -> f64 {
    (2.0 * libm::atan(0.5 * f64::from(rectangle.height()))).to_degrees()
}

/// Returns the vertical field of view in degrees, with the fewest digits that give the same height.
fn fov_degrees_text(rectangle: &ViewRectangle) -> Option<String> {
    let gives_the_height = |value: f64| {
        ViewRectangle::from_vertical_fov(radians(value)).is_ok_and(|read| read.height() == rectangle.height())
    };
    shortest_decimal(approximate_degrees(rectangle), gives_the_height)
}

/// Returns the aspect ratio with the fewest digits that give the same width.
fn aspect_ratio_text(rectangle: &ViewRectangle, width: f32) -> Option<String> {
    let gives_the_width = |value: f64| rectangle.height() * value as f32 == width;
    shortest_decimal(f64::from(width) / f64::from(rectangle.height()), gives_the_width)
}

/// Returns `value` with the fewest digits after the point for which `is_right` is true.
fn shortest_decimal(value: f64, is_right: impl Fn(f64) -> bool) -> Option<String> {
    // Tries all lengths from the shortest on. Each try parses a number, but a camera is formatted only when a view is
    // saved or copied.
    let digits = (0..=15).map(|digits| format!("{value:.digits$}"));
    let exact = value.to_string();
    digits.chain([exact]).find(|text| parses_as(text, &is_right))
}

#[cfg(all(test, unit_tests))]
mod tests;
