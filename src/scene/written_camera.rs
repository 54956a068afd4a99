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

#[cfg(test)]
mod tests {
    use crate::camera::{Camera, Pose, ViewRectangle};
    use crate::scene::Scene;
    use glam::{Vec2, Vec3};
    use proptest::prelude::*;

    fn read_back(camera: &Camera) -> Camera {
        let text = format!("({})", camera.to_ron());
        *Scene::from_ron("camera", &text).unwrap().camera()
    }

    #[test]
    fn what_was_written_comes_back() {
        for lens in [
            "vertical_fov: 45",
            "vertical_fov: 12.5",
            "vertical_fov: 40, aspect_ratio: 1.5",
            "focal_length: 1, width: 1.8, height: 1.2",
            "focal_length: 1, width: 1.8, height: 1.2, shift: (0, 0.35)",
            "vertical_fov: 100, shift: (-0.25, 1)",
        ] {
            let line = format!("camera: (eye: (0.1, -3e-20, 4), target: (1000000, 0, 0), up: (0, 0.3, 0), {lens})");
            let scene = Scene::from_ron("x", &format!("({line})")).unwrap();
            assert_eq!(scene.camera().to_ron(), line);
        }
    }

    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![-10.0_f32..10.0, -1e9_f32..1e9, -1e-30_f32..1e-30, Just(-0.0)]
    }

    fn point() -> impl Strategy<Value = Vec3> {
        [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
    }

    fn rectangle() -> impl Strategy<Value = ViewRectangle> {
        let by_angle = (0.001_f32..3.1).prop_map(|angle| ViewRectangle::from_vertical_fov(angle).unwrap());
        let by_ratio = (0.1_f32..3.0, 0.01_f32..100.0).prop_map(|(angle, ratio)| {
            ViewRectangle::from_vertical_fov(angle).unwrap().with_aspect_ratio(ratio).unwrap()
        });
        let by_length = (0.1_f32..10.0, 0.1_f32..10.0, 0.1_f32..10.0)
            .prop_map(|(f, w, h)| ViewRectangle::from_focal_length(f, w, h).unwrap());
        (prop_oneof![by_angle, by_ratio, by_length], -2.0_f32..2.0, -2.0_f32..2.0)
            .prop_map(|(rectangle, right, up)| rectangle.with_shift(Vec2::new(right, up)).unwrap())
    }

    proptest! {
        #[test]
        fn every_camera_is_read_back_bit_for_bit(eye in point(), target in point(), rectangle in rectangle()) {
            let pose = Pose { eye, target, up: Vec3::new(0.3, 1.0, -0.1) };
            prop_assume!(Camera::new(pose, rectangle).is_ok());
            let camera = Camera::new(pose, rectangle).unwrap();
            prop_assert_eq!(read_back(&camera), camera);
        }
    }
}
