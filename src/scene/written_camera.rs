//! Cameras written as text for a scene file.

use crate::camera::{Camera, ViewRectangle, radians};
use glam::Vec3;

impl Camera {
    /// Returns the camera as in a scene file: `camera: (eye: ..., target: ..., ...)`, each number
    /// with the fewest digits that are read back with the same bits.
    ///
    /// ```
    /// use termtrace::Scene;
    ///
    /// let line = "camera: (eye: (0, 1.5, 6), target: (0, 0.7, 0), up: (0, 1, 0), vertical_fov: 40)";
    /// let scene = Scene::from_ron("x.ron", &format!("({line})"))?;
    /// assert_eq!(scene.camera().to_ron(), line);
    /// # Ok::<(), termtrace::SceneError>(())
    /// ```
    #[doc(hidden)]
    pub fn to_ron(&self) -> String {
        format!("camera: {}", self.value_to_ron())
    }

    /// Returns the value of that field alone: `(eye: ..., target: ..., ...)`.
    pub(super) fn value_to_ron(&self) -> String {
        let pose = self.pose();
        let [eye, target, up] = [pose.eye, pose.target, pose.up].map(vector);
        let rectangle = self.rectangle();
        let lens = lens(&rectangle);
        let shift = rectangle.shift();
        let shift = if shift == glam::Vec2::ZERO {
            String::new()
        } else {
            format!(", shift: ({}, {})", number(shift.x), number(shift.y))
        };
        format!("(eye: {eye}, target: {target}, up: {up}, {lens}{shift})")
    }
}

fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}

/// Returns the shortest decimal that is read back as `x`.
fn number(x: f32) -> String {
    let plain = x.to_string();
    // Rust never writes an exponent by itself: 1e-30 would have 31 digits.
    let short = if plain.len() > 16 { format!("{x:e}") } else { plain };
    // The reader rounds twice, to f64 and then to f32, which changes a few numbers: these are written with all digits.
    if reads_as(&short, |value| value as f32 == x) { short } else { f64::from(x).to_string() }
}

fn reads_as(text: &str, is_right: impl Fn(f64) -> bool) -> bool {
    text.parse().is_ok_and(is_right)
}

/// Returns the lens in degrees if that gives the same bits; otherwise as the lecture's f, w and h,
/// with f = 1.
fn lens(rectangle: &ViewRectangle) -> String {
    let Some(width) = rectangle.width() else {
        let degrees = degrees(rectangle).unwrap_or_else(|| approximate_degrees(rectangle).to_string());
        return format!("vertical_fov: {degrees}");
    };
    match (degrees(rectangle), aspect_ratio(rectangle, width)) {
        // An angle or ratio that needs more digits was not written as such by the author.
        (Some(degrees), Some(ratio)) if degrees.len() <= 6 && ratio.len() <= 9 => {
            format!("vertical_fov: {degrees}, aspect_ratio: {ratio}")
        }
        _ => {
            let (width, height) = (number(width), number(rectangle.height()));
            format!("focal_length: 1, width: {width}, height: {height}")
        }
    }
}

fn approximate_degrees(rectangle: &ViewRectangle) -> f64 {
    (2.0 * libm::atan(0.5 * f64::from(rectangle.height()))).to_degrees()
}

/// Returns the angle with the fewest digits that gives the same height.
fn degrees(rectangle: &ViewRectangle) -> Option<String> {
    let gives_the_height = |value: f64| {
        ViewRectangle::from_vertical_fov(radians(value)).is_ok_and(|read| read.height() == rectangle.height())
    };
    shortest(approximate_degrees(rectangle), gives_the_height)
}

/// Returns the aspect ratio with the fewest digits that gives the same width.
fn aspect_ratio(rectangle: &ViewRectangle, width: f32) -> Option<String> {
    let gives_the_width = |value: f64| rectangle.height() * value as f32 == width;
    shortest(f64::from(width) / f64::from(rectangle.height()), gives_the_width)
}

/// Returns the decimal with the fewest digits after the point that passes the check.
fn shortest(value: f64, is_right: impl Fn(f64) -> bool) -> Option<String> {
    // Tried from the shortest on. Each try parses a number, but a camera is written only when a view is saved or
    // copied.
    let digits = (0..=15).map(|digits| format!("{value:.digits$}"));
    let exact = value.to_string();
    digits.chain([exact]).find(|text| reads_as(text, &is_right))
}

#[cfg(all(test, unit_tests))]
mod tests;
