//! Properties of any bytes that are read as a scene, a formula, a camera path or a file of keys.
//!
//! For the tests and for the fuzzer.

use glam::Vec3;
use termtrace::internals::control::Keymap;
use termtrace::internals::hit::{self, Kernel};
use termtrace::internals::ray::{EightRays, Ray};
use termtrace::internals::scene_text::text_from;
use termtrace::{CameraPath, Render, Resolution, Scene, SceneError};

/// A scene, or faults that can be shown.
pub(crate) fn scene(bytes: &[u8]) {
    if let Err(error) = Scene::from_bytes("scene.ron", bytes) {
        assert_shown(&error, bytes);
    }
}

/// A surface that can be traced, or a fault that can be shown.
pub(crate) fn formula(bytes: &[u8]) {
    // The end of the raw string would end the formula.
    let formula = String::from_utf8_lossy(bytes).replace('"', "'");
    let text = format!(
        "(camera: (eye: (1, 2, 3), target: (0, 0, 0)), ambient: 1, objects: [Implicit(f: r\"{formula}\", \
         params: {{\"a\": 0.5}}, bounds: Box(min: (-1, -1, -1), max: (1, 1, 1)))])"
    );
    match Scene::from_bytes("scene.ron", text.as_bytes()) {
        Ok(scene) => {
            let resolution = Resolution::new(4, 3).expect("a small picture");
            let light = Render::new(&scene).resolution(resolution).run().expect("there is memory for it");
            let is_finite = |channel: f32| channel.is_finite() && channel >= 0.0;
            assert!(light.pixels().iter().all(|light| [light.r, light.g, light.b].into_iter().all(is_finite)));
        }
        Err(error) => assert_shown(&error, text.as_bytes()),
    }
}

/// The first roots of a formula, after six bytes for the eye and the point that it looks at.
///
/// They do not depend on the kernel, nor on how many rays are searched together, and the next root lies behind.
pub(crate) fn roots(bytes: &[u8]) {
    let Some((view, formula)) = bytes.split_at_checked(6) else { return };
    let formula = String::from_utf8_lossy(formula).replace('"', "'");
    let text = format!(
        "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), objects: [Implicit(f: r\"{formula}\", \
         params: {{\"a\": 0.5}}, bounds: Box(min: (-1, -1, -1), max: (1, 1, 1)))])"
    );
    let Ok(scene) = Scene::from_bytes("scene.ron", text.as_bytes()) else { return };
    let [ex, ey, ez, tx, ty, tz] = [0, 1, 2, 3, 4, 5].map(|at| f32::from(view[at].cast_signed()) / 32.0);
    let direction = |lane: u8| Vec3::new(tx - ex + 0.02 * f32::from(lane), ty - ey, tz - ez + 0.013);
    let rays: Vec<_> = (0..8).map(|lane| Ray { origin: Vec3::new(ex, ey, ez), direction: direction(lane) }).collect();
    let hits = |kernel| {
        let mut hits = Vec::new();
        hit::closest_hits(kernel, &scene, &[EightRays::of(&rays)], &mut hits);
        (0..8).map(|lane| hits[0].hit(&scene, lane).map(|hit| hit.t)).collect::<Vec<_>>()
    };
    let found = hits(Kernel::Packet);
    assert_eq!(found, hits(Kernel::Single), "{formula}");
    assert_eq!(found, hits(Kernel::Scalar), "{formula}");
    for (ray, t) in rays.iter().zip(found) {
        let alone = hit::closest_hit(&scene, ray).map(|hit| hit.t);
        assert_eq!(alone, t, "{formula}");
        assert!(t.is_none_or(|t| t.is_finite() && t >= 0.0), "{formula}: {t:?}");
    }
}

/// A path with a camera at any time, or faults that can be shown.
pub(crate) fn camera_path(bytes: &[u8]) {
    let scene = Scene::from_ron("x", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))").expect("a scene");
    match CameraPath::from_bytes("path.ron", bytes, scene.camera()) {
        Ok(path) => {
            assert!(path.seconds().is_finite());
            for share in [-1.0, 0.0, 0.3, 1.0, 2.0] {
                // Half way between two eyes there may be none; that is told, too.
                if let Err(error) = path.camera_at(share * path.seconds()) {
                    assert!(!error.to_string().contains(char::is_control));
                }
            }
        }
        Err(error) => assert_shown(&error, bytes),
    }
}

/// A table that can be written and read again, or faults that can be shown.
pub(crate) fn keys(bytes: &[u8]) {
    match text_from("keys.ron", bytes).and_then(|text| Keymap::from_ron("keys.ron", text)) {
        Ok(keymap) => {
            let written = keymap.to_ron();
            let again = Keymap::from_ron("keys.ron", &written).expect("what was written can be read");
            assert_eq!(again.to_ron(), written);
        }
        Err(error) => assert_shown(&error, bytes),
    }
}

/// Each fault lies inside the text and can be printed on a terminal.
fn assert_shown(error: &SceneError, bytes: &[u8]) {
    assert!(!error.reports().is_empty());
    let lines = bytes.split(|&byte| byte == b'\n').count();
    for report in error.reports() {
        assert!(report.span.start <= report.span.end && report.span.end as usize <= bytes.len());
        assert!((1..=lines).contains(&report.line) && report.column >= 1 && report.caret_width >= 1);
    }
    assert!(!error.to_string().contains(|c: char| c.is_control() && c != '\n'));
}
