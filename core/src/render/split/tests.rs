use super::*;
use crate::render::{Sampling, render, render_by};
use std::num::NonZeroU32;

fn scene(sphere_count: i32) -> Scene {
    let sphere = |at: i32| format!("Sphere(center: ({}, {}, 0), radius: 0.3)", (at + 4) % 8 - 4, (at / 8 + 2) % 4 - 2);
    let objects: Vec<_> = (0..sphere_count).map(sphere).collect();
    let light = "lights: [Point(position: (3, 5, 4), intensity: 20)]";
    let text = format!("(camera: (eye: (0, 0, 6), target: (0, 0, 0)), {light}, objects: [{}])", objects.join(", "));
    Scene::from_ron("spheres.ron", &text).expect("a scene")
}

#[test]
fn pixels_are_those_of_blocks_or_of_1_or_16_samples_and_few_blocks_are_split() {
    let resolution = Resolution::square(101, 75);
    for sphere_count in [1, 4, 32] {
        let scene = scene(sphere_count);
        let each = |samples| Sampling::Each(NonZeroU32::new(samples).expect("not 0"));
        let [split, coarse, fine, finest] = [Sampling::Split, Sampling::Coarse, each(1), each(FINEST_SAMPLES)]
            .map(|sampling| render(&scene, scene.camera(), resolution, sampling));
        let mut changed = std::collections::HashSet::new();
        for (at, light) in split.pixels().iter().enumerate() {
            assert!([&coarse, &fine, &finest].iter().any(|other| other.pixels()[at] == *light), "pixel {at}");
            if *light != coarse.pixels()[at] {
                changed.insert((at % 101 / 2, at / 101 / 2));
            }
        }
        let most = 51 * 38 * MAX_SHARE.0 / MAX_SHARE.1;
        assert!((1..=most).contains(&changed.len()), "{} of at most {most} blocks", changed.len());
        let error = |other: &Framebuffer| {
            let differences = other.pixels().iter().zip(fine.pixels()).map(|(a, b)| (a.g - b.g) * (a.g - b.g));
            differences.sum::<f32>()
        };
        assert!(error(&split) < 0.5 * error(&coarse), "{sphere_count}: {} of {}", error(&split), error(&coarse));
    }
}

/// Checks that the rays that are left bring a picture nearer to that of many samples, and are fewer
/// than those of one per pixel.
#[test]
fn rays_that_are_left_go_to_the_pixels_that_differ_most() {
    let resolution = Resolution::square(128, 96);
    let scene = scene(1);
    let [split, fine, finest] = [Sampling::Split, Sampling::Each(NonZeroU32::MIN), Sampling::BEST].map(|sampling| {
        render_by(Executor::CurrentThread, &scene, scene.camera(), resolution, sampling).expect("it is not cancelled")
    });
    let error = |other: &Framebuffer| {
        let differences =
            other.pixels().iter().zip(finest.framebuffer.pixels()).map(|(a, b)| (a.g - b.g) * (a.g - b.g));
        differences.sum::<f32>()
    };
    let errors = [&split, &fine].map(|rendered| error(&rendered.framebuffer));
    assert!(errors[0] < 0.5 * errors[1], "{errors:?}");
    assert!(split.cost.rays < fine.cost.rays, "{} of {}", split.cost.rays, fine.cost.rays);
}

#[test]
fn the_blocks_that_differ_most_are_split() {
    let scene = scene(1);
    let resolution = Resolution::square(64, 2);
    let mut framebuffer = Framebuffer::new(resolution);
    // The square root of the light rises at every third block, by 1/70, then 2/70, and so on. Both blocks beside a step
    // have its contrast.
    for (x, pixel) in framebuffer.pixels_mut().iter_mut().enumerate() {
        let root = (x % 64 / 2 / 3) as f32;
        let shown = root * (root + 1.0) / 2.0 / 70.0;
        *pixel = LinearRgb::grey(shown * shown);
    }
    let splits = blocks_to_split(&framebuffer, &Tiles::new(scene.camera(), resolution, 2), 1.0);
    let split: Vec<usize> = (0..32).filter(|&block| splits[block]).collect();
    assert_eq!(split.len(), 9, "{split:?}");
    assert!(split.iter().all(|&block| block > 14), "the steps are highest on the right: {split:?}");
    framebuffer.pixels_mut().fill(LinearRgb::grey(0.3));
    assert!(!blocks_to_split(&framebuffer, &Tiles::new(scene.camera(), resolution, 2), 1.0).contains(&true));
}
