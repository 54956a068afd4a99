//! The explanation of a pixel, compared with the picture.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use termtrace::internals::explain::MAX_LINE_WIDTH;
use termtrace::internals::finish::Finish;
use termtrace::{Explanation, Light, LinearRgb, Picture, Resolution, Scene, ToneCurve, explain, render, tone};

fn shipped_scenes() -> Vec<(PathBuf, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let paths = std::fs::read_dir(folder).expect("the folder is there").map(|entry| entry.expect("a file").path());
    let scenes = paths.filter(|path| path.extension().is_some_and(|ending| ending == "ron"));
    scenes.map(|path| (path.clone(), Scene::load(&path).unwrap_or_else(|error| panic!("{error}")))).collect()
}

/// A size that is not a whole number of tiles, with pixels that are not square.
const SIZE: Resolution = match Resolution::square(60, 34).with_pixel_aspect(1.25) {
    Ok(size) => size,
    Err(_) => panic!("a shape of pixels"),
};

fn picture(scene: &Scene) -> Picture {
    tone(&render(scene, scene.camera(), SIZE, NonZeroU32::MIN), scene)
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE.height()).flat_map(|y| (0..SIZE.width()).map(move |x| [x, y]))
}

/// Asserts that the parts of an explanation add up to its result, to the bit.
#[track_caller]
fn adds_up(scene: &Scene, explanation: &Explanation) {
    let Explanation { tested, hit: seen, .. } = explanation;
    let closest = tested.first().and_then(|tested| Some((tested.name, tested.t?)));
    assert_eq!(closest, seen.as_ref().map(|seen| (seen.name, seen.hit.t)), "{explanation:?}");
    if let Some(seen) = seen {
        let sum = seen.lights.iter().fold(seen.ambient, |sum, lit| sum + lit.arriving());
        if scene.lights().iter().any(Light::has_size) {
            // The parts of a light are added to the ambient light one by one, which rounds otherwise.
            assert!((sum.g - seen.arriving.g).abs() <= 1e-4 * sum.g, "{explanation:?}");
        } else {
            assert_eq!(sum, seen.arriving, "{explanation:?}");
        }
        let (sum, light) = (seen.arriving, &explanation.light);
        // What further rays bring is not part of an explanation.
        match seen.finish {
            _ if seen.opacity < 1.0 || explanation.transmittance.is_some() => {}
            (Finish::Matte, _) => assert_eq!(sum * seen.reflectance, *light, "{explanation:?}"),
            (Finish::Glowing { strength }, _) => assert_eq!(seen.reflectance * strength, *light, "{explanation:?}"),
            (Finish::Polished { .. }, mirrored) => {
                let own = sum * seen.reflectance * (1.0 - mirrored);
                assert!(own.g * 0.9999 <= light.g, "{explanation:?}");
            }
            _ => {}
        }
    }
    assert_eq!(explanation.shown, termtrace::internals::tone::tone_mapped(explanation.light, scene));
    let through = scene.camera().eye_rays(SIZE.aspect_ratio()).through(explanation.q.x, explanation.q.y);
    assert_eq!(explanation.ray, through);
}

#[test]
fn every_pixel_of_every_scene_is_explained() {
    let scenes = shipped_scenes();
    assert!(scenes.len() >= 11, "only {} scenes", scenes.len());
    for (path, scene) in scenes {
        let picture = picture(&scene);
        for (at, pixel) in pixels().enumerate() {
            let explanation = explain(&scene, scene.camera(), SIZE, pixel);
            assert_eq!(explanation.bytes, picture.pixels()[at], "{} {pixel:?}", path.display());
            adds_up(&scene, &explanation);
        }
    }
}

#[test]
fn exposure_and_curve_are_the_frames() {
    let (_, mut scene) = shipped_scenes().swap_remove(0);
    for (exposure, tone_curve) in [(3.0, ToneCurve::None), (0.5, ToneCurve::Reinhard), (2.0, ToneCurve::Filmic)] {
        scene = scene.with_exposure(exposure).expect("an exposure").with_tone_curve(tone_curve);
        let picture = picture(&scene);
        for (at, pixel) in pixels().enumerate().step_by(7) {
            let explanation = explain(&scene, scene.camera(), SIZE, pixel);
            assert_eq!(explanation.bytes, picture.pixels()[at], "{tone_curve:?} {pixel:?}");
            adds_up(&scene, &explanation);
        }
    }
}

/// The explained equations have the picture's t as a root, and the text fits in any panel.
#[test]
fn equations_and_lines_say_the_same_as_the_picture() {
    for (path, scene) in shipped_scenes() {
        for pixel in pixels().step_by(5) {
            let explanation = explain(&scene, scene.camera(), SIZE, pixel);
            for tested in &explanation.tested {
                let roots = &tested.equation.roots;
                let is_close = |root: &f64, t: f32| (root - f64::from(t)).abs() < 2e-3 * f64::from(t).max(1.0);
                let agrees = tested.t.is_none_or(|t| roots.iter().any(|root| is_close(root, t)));
                assert!(agrees, "{} {pixel:?}: {tested:?}", path.display());
            }
            for line in explanation.lines() {
                assert!(line.len() <= MAX_LINE_WIDTH, "{} {pixel:?}: {line:?}", path.display());
                assert!(line.bytes().all(|byte| (b' '..=b'~').contains(&byte)), "{line:?}");
            }
        }
    }
}

/// A ball on a floor under one light: the lit side and the shadow.
#[test]
fn the_blocker_of_a_light_is_named() {
    let scene = Scene::from_ron(
        "ball.ron",
        "(
            camera: (eye: (0, 2, 7), target: (0, 1.4, 0)),
            ambient: 0.1,
            lights: [Point(position: (0, 8, 0), intensity: 60)],
            objects: [
                Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Diffuse(0.5)),
                Sphere(center: (0, 1, 0), radius: 1, material: Diffuse(0.5)),
            ],
        )",
    )
    .expect("a scene");
    let all: Vec<_> = pixels().map(|pixel| explain(&scene, scene.camera(), SIZE, pixel)).collect();
    let says = |words: &str| all.iter().filter(|it| it.lines().join("\n").contains(words)).count();
    assert!(says("V = 0, behind sphere #2") > 5, "the ball's shadow on the floor");
    assert!(says("faces away") > 5, "the ball's lower half");
    assert!(says("no hit: L = background") > 5);
    assert!(says("closest hit: plane #1") > 5 && says("closest hit: sphere #2") > 5 && says("miss") > 5);
    let dark = all.iter().find(|it| it.lines().join("\n").contains("V = 0, behind")).expect("it is there");
    assert_eq!(dark.light, LinearRgb::grey(0.1) * LinearRgb::grey(0.5), "ambient light is left");
}
