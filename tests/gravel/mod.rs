//! A scene whose refinement takes long.

use std::{fmt::Write as _, io::Write as _};

use tempfile::NamedTempFile;

/// A scene with edges everywhere: refined, it takes nearly 64 times as long as at first.
pub(crate) fn gravel() -> NamedTempFile {
    let mut scene = String::from("(camera: (eye: (0, 0, 30), target: (0, 0, 0)), ambient: 0.2, lights: [");
    for x in [-20, 0, 20] {
        let _ = write!(scene, "Point(position: ({x}, 20, 30), intensity: 900),");
    }
    scene.push_str("], objects: [");
    for n in 0..30_000 {
        let _ = write!(
            scene,
            "Sphere(center: ({}, {}, {}), radius: 0.07),",
            f64::from(n % 200) * 0.2 - 20.0,
            f64::from(n / 200) * 0.2 - 15.0,
            f64::from(n * 7 % 31) * 0.1,
        );
    }
    scene.push_str("])");
    let mut file = tempfile::Builder::new().suffix(".ron").tempfile().expect("a file can be made");
    file.write_all(scene.as_bytes()).expect("a file can be written");
    file
}
