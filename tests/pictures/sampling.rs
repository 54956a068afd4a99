//! More samples at edges: their result, their cost, and no visible steps.

use glam::Vec3;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use termtrace::internals::material::{Checker, Gradient, Noise, Stripes};
use termtrace::internals::progress::Cancellation;
use termtrace::internals::render::{Executor, ProgressiveRender, render_by};
use termtrace::{
    Camera, Cancelled, Framebuffer, LinearRgb, Material, Object, Plane, Pose, Resolution, Sampling, Scene,
    ViewRectangle, render, tone,
};

const SIZE: Resolution = Resolution::square(80, 48);

fn shipped() -> impl Iterator<Item = (PathBuf, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = std::fs::read_dir(folder).expect("the folder is there").map(|entry| entry.unwrap().path());
    files.filter(|path| path.extension().is_some_and(|ending| ending == "ron")).map(|path| {
        let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
        (path, scene)
    })
}

fn samples(count: u32) -> NonZeroU32 {
    NonZeroU32::new(count).expect("at least one")
}

/// Returns the PSNR of the displayed colours, in dB.
fn psnr(scene: &Scene, a: &Framebuffer, b: &Framebuffer) -> f64 {
    let (a, b) = (tone(a, scene), tone(b, scene));
    let bands = |p: &termtrace::Srgb8| [p.r, p.g, p.b].map(f64::from);
    let pairs = a.pixels().iter().flat_map(bands).zip(b.pixels().iter().flat_map(bands));
    let squares: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
    10.0 * libm::log10(255.0 * 255.0 * 3.0 * a.pixels().len() as f64 / squares)
}

#[test]
fn the_steps_of_a_refinement_do_not_change_its_result() {
    for (path, scene) in shipped() {
        let at_once = render(&scene, scene.camera(), SIZE, Sampling::BEST).hash();
        for steps in [&[1, 4, 16, 64][..], &[4, 64], &[1, 2, 3, 17, 63, 64], &[16, 16, 64, 64]] {
            let mut picture = ProgressiveRender::new(scene.camera(), SIZE);
            for &step in steps {
                picture.refine_or_cancel(&Cancellation::default(), &scene, samples(step)).unwrap();
            }
            assert_eq!(picture.framebuffer().hash(), at_once, "{} in {steps:?}", path.display());
            assert!(picture.is_final());
        }
    }
}

/// Light of -0.0 is equal to light of 0.0.
#[test]
fn zero_has_no_sign() {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), background: (-0.0, -0.0, -0.0))";
    let dark = Scene::from_ron("dark.ron", text).expect("the scene is fine");
    let hash = |sampling: Sampling| render(&dark, dark.camera(), SIZE, sampling).hash();
    let [each, at_most] = [Sampling::Each, Sampling::UpTo].map(|sampling| hash(sampling(NonZeroU32::MIN)));
    assert_eq!(each, at_most);
}

/// Refinement gives nearly the picture of 64 rays for every pixel, at a part of their cost.
#[test]
fn samples_go_where_the_edges_are() {
    for (path, scene) in shipped() {
        let traced = |sampling| render_by(Executor::Pool, &scene, scene.camera(), SIZE, sampling).unwrap();
        let (all, best, one) =
            (traced(Sampling::Each(samples(64))), traced(Sampling::BEST), traced(Sampling::Each(NonZeroU32::MIN)));
        let [near, far] = [&best, &one].map(|it| psnr(&scene, &it.framebuffer, &all.framebuffer));
        let share = best.cost.rays as f64 / all.cost.rays as f64;
        println!("{}: {near:.1} dB, of one ray {far:.1} dB; {share:.3} of the rays", path.display());
        assert!(near > 45.0 && near > far + 12.0, "{}: {near} dB, of one ray {far} dB", path.display());
        assert!(share < 0.85, "{}: {share} of the rays", path.display());
    }
}

/// A level that is a whole pass has at most its number of samples for a pixel, and at least one.
///
/// Also where the picture ends within a tile.
#[test]
fn one_sample_at_most_is_one_sample() {
    for (path, scene) in shipped() {
        for size in [SIZE, Resolution::square(81, 45), Resolution::square(70, 33), Resolution::square(3, 2)] {
            let one = render(&scene, scene.camera(), size, NonZeroU32::MIN);
            for most in [1, 2, 3] {
                let at_most = render(&scene, scene.camera(), size, Sampling::UpTo(samples(most)));
                assert_eq!(at_most.hash(), one.hash(), "{} {size:?}, {most} at most", path.display());
            }
        }
        let [one, four] = [1, 4].map(|most| render(&scene, scene.camera(), SIZE, Sampling::UpTo(samples(most))));
        assert_ne!(four.hash(), one.hash(), "{}", path.display());
    }
}

#[test]
fn threads_do_not_change_a_refined_picture() {
    let (_, scene) = shipped().next().expect("there are scenes");
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&scene, scene.camera(), Resolution::square(83, 45), Sampling::BEST).hash())
    };
    assert_eq!(on(1), on(2));
    assert_eq!(on(1), on(7));
}

/// Two by two pixels are one block, and the picture stays where it is; sides may be odd.
#[test]
fn a_coarse_picture_is_made_of_blocks() {
    for (path, scene) in shipped() {
        let resolution = Resolution::square(81, 47);
        let coarse = render_by(Executor::Pool, &scene, scene.camera(), resolution, Sampling::Coarse).unwrap();
        for y in 0..47 {
            for x in 0..81 {
                let block = coarse.framebuffer.pixel(x / 2 * 2, y / 2 * 2);
                assert_eq!(coarse.framebuffer.pixel(x, y), block, "{} ({x}, {y})", path.display());
            }
        }
        let fine = render_by(Executor::Pool, &scene, scene.camera(), resolution, NonZeroU32::MIN).unwrap();
        assert!(coarse.cost.rays * 3 < fine.cost.rays, "{}", path.display());
        assert!(psnr(&scene, &coarse.framebuffer, &fine.framebuffer) > 14.0, "{}", path.display());
    }
}

#[test]
fn a_refinement_can_be_cancelled() {
    let (_, scene) = shipped().next().expect("there are scenes");
    let mut picture = ProgressiveRender::new(scene.camera(), SIZE);
    let token = Cancellation::default();
    token.cancel();
    assert_eq!(picture.refine_or_cancel(&token, &scene, samples(64)), Err(Cancelled));
    let cancelled = render_by(Executor::Cancellable(&token), &scene, scene.camera(), SIZE, Sampling::BEST);
    assert_eq!(cancelled, Err(Cancelled));
}

/// Returns a checkered floor to the horizon, lit by ambient light alone.
fn floor(size: f32) -> Scene {
    floor_of(Checker::new(LIGHT, DARK, size).expect("a pattern"))
}

/// The colours of the floors.
const LIGHT: LinearRgb = LinearRgb::grey(0.9);
const DARK: LinearRgb = LinearRgb::grey(0.1);

/// Returns a floor to the horizon, lit by ambient light alone.
fn floor_of(material: impl Into<Material>) -> Scene {
    let pose = Pose { eye: Vec3::new(0.3, 1.0, 0.0), target: Vec3::new(0.9, 0.8, -3.0), up: Vec3::Y };
    let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(1.0).unwrap()).unwrap();
    let mut scene = Scene::new(camera, vec![Object::new(Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane"), material)]);
    scene = scene.with_ambient(LinearRgb::grey(1.0)).expect("light");
    scene
}

/// Far away a pattern is its mean: no pixel has the colour of one square, and neighbours are alike.
#[test]
fn far_patterns_are_grey() {
    are_grey_far_away(&floor(0.02));
    are_grey_far_away(&floor_of(Stripes::new(LIGHT, DARK, 0.01).expect("a pattern")));
    are_grey_far_away(&floor_of(Gradient::new(LIGHT, DARK, 0.02).expect("a pattern")));
    are_grey_far_away(&floor_of(Noise::new(LIGHT, DARK, 0.02).expect("a pattern")));
}

#[track_caller]
fn are_grey_far_away(scene: &Scene) {
    let light = render(scene, scene.camera(), SIZE, NonZeroU32::MIN);
    let rows = |y: u32| (0..80).map(move |x| (x, y)).collect::<Vec<_>>();
    let floor_from = (0..48).find(|&y| light.pixel(0, y) != LinearRgb::BLACK).expect("there is a floor");
    for y in floor_from + 1..floor_from + 8 {
        for (x, y) in rows(y) {
            let off = (light.pixel(x, y).r - 0.5).abs();
            assert!(off < 0.03, "({x}, {y}) is off by {off}");
        }
    }
}

/// One ray with a filtered pattern is nearer to the truth than 16 rays are.
///
/// The truth is 1,024 rays that each see a point.
#[test]
fn a_filtered_pattern_is_near_the_truth() {
    let squares = |x: f32, z: f32| if (x.floor() + z.floor()) % 2.0 == 0.0 { 0.9 } else { 0.1 };
    let stripes = |x: f32, _: f32| if x.floor() % 2.0 == 0.0 { 0.9 } else { 0.1 };
    let gradient = |_: f32, z: f32| 0.1 + 0.8 * (z.rem_euclid(2.0) - 1.0).abs();
    for size in [0.3, 1.0] {
        is_near_the_truth("squares", size, &floor(size), squares);
        is_near_the_truth("stripes", size, &floor_of(Stripes::new(LIGHT, DARK, size).expect("a pattern")), stripes);
        is_near_the_truth("gradient", size, &floor_of(Gradient::new(LIGHT, DARK, size).expect("a pattern")), gradient);
    }
}

/// Compares a picture with the truth, by the reflectance at points of a pattern of size 1.
#[track_caller]
fn is_near_the_truth(pattern: &str, size: f32, scene: &Scene, reflectance: impl Fn(f32, f32) -> f32) {
    let truth = truth(scene, size, reflectance);
    let one = psnr(scene, &render(scene, scene.camera(), SIZE, NonZeroU32::MIN), &truth);
    let best = psnr(scene, &render(scene, scene.camera(), SIZE, Sampling::BEST), &truth);
    println!("{pattern} of {size}: one ray {one:.1} dB, best {best:.1} dB");
    assert!(one > 22.0, "one ray of {pattern} of {size}: {one} dB");
    assert!(best > 30.0, "{pattern} of {size}: {best} dB");
}

/// Returns the truth by the lecture's formula for the plane, with 32 times 32 samples of a pixel.
fn truth(scene: &Scene, size: f32, reflectance: impl Fn(f32, f32) -> f32) -> Framebuffer {
    let eye_rays = scene.camera().eye_rays(SIZE.aspect_ratio());
    let shade = |x: f32, y: f32| {
        let ray = eye_rays.through(x / 80.0, (48.0 - y) / 48.0);
        let t = -ray.origin.y / ray.direction.y;
        if !(t > 0.0) {
            return 0.0;
        }
        let point = ray.at(t) / size;
        reflectance(point.x, point.z)
    };
    let mut truth = Framebuffer::new(SIZE);
    for (at, pixel) in (0..).zip(truth.pixels_mut()) {
        let (x, y) = ((at % 80) as f32, (at / 80) as f32);
        let places = (0..32 * 32).map(|s| (x + ((s % 32) as f32 + 0.5) / 32.0, y + ((s / 32) as f32 + 0.5) / 32.0));
        *pixel = LinearRgb::grey(places.map(|(x, y)| shade(x, y)).sum::<f32>() / 1024.0);
    }
    truth
}
