//! `termtrace bench`: its figures are true.

use super::{Folder, shipped_scenes};
use std::collections::HashMap;
use std::num::NonZeroU32;
use termtrace::internals::hit::closest_hit;
use termtrace::{Resolution, Scene, export, render, tone};

/// Returns the figures of each round by the words before and after them.
///
/// `7 hits` is 7 of hits, `hash 7` is 7 of hash.
fn rounds(text: &str) -> Vec<HashMap<&str, &str>> {
    let pairs = |(_, line)| str::split(line, [',', ';']).filter_map(|figure| figure.trim().split_once(' '));
    let rounds = text.lines().filter_map(|line| line.strip_prefix("round ")?.split_once(": "));
    rounds.map(|round| pairs(round).flat_map(|(a, b)| [(a, b), (b, a)]).collect()).collect()
}

/// The timed picture is that of `frame`, and the counted hits are those of its rays.
#[test]
fn the_timed_picture_is_that_of_frame() {
    let folder = Folder::new();
    for scene in shipped_scenes() {
        let path = scene.display();
        let resolution = Resolution::square(60, 40);
        let one = NonZeroU32::MIN;
        let scene = Scene::load(&scene).expect("a shipped scene is fine");
        let light = render(&scene, scene.camera(), resolution, one);
        let png = export::png(&tone(&light, &scene), 1.0, 1).expect("a PNG");
        assert!(folder.run(&format!("frame {path} --pixels 60x40 --samples 1 --format png")).done() == png, "{path}");
        let eye_rays = scene.camera().eye_rays(resolution.aspect_ratio());
        let places = (0..40).flat_map(|y| (0..60).map(move |x| ((x as f32 + 0.5) / 60.0, (y as f32 + 0.5) / 40.0)));
        let hits: Vec<_> = places.filter_map(|(x, y)| closest_hit(&scene, &eye_rays.through(x, y))).collect();
        let depths: f64 = hits.iter().map(|hit| f64::from(hit.t)).sum();
        let flags = ["--threads 2", "--threads 1", "--kernel single", "--kernel packet", "--kernel scalar"];
        let texts = flags.map(|flags| folder.run(&format!("bench {path} --pixels 60x40 --rounds 2 {flags}")).text());
        for text in texts {
            let rounds = rounds(&text);
            assert_eq!(rounds.len(), 2, "{text}");
            let round = &rounds[1];
            assert_eq!(round["hash"], format!("{:016x}", light.hash()), "{path}: {text}");
            assert_eq!(round["hits"], hits.len().to_string(), "{path}: {text}");
            let said: f64 = round["depths"].parse().expect("a number");
            assert!((said - depths).abs() <= 1e-3 + 1e-9 * depths, "{path}: {depths} are {said}");
            let rays: usize = round["rays"].parse().expect("a number");
            let shadow_rays = if scene.shadows() { hits.len() * scene.lights().len() } else { 0 };
            assert_eq!(rays, 60 * 40 + shadow_rays, "{path}: {text}");
        }
    }
}

/// Other tracers have the same scenes: the hits and depths of the last two are those of Embree.
#[test]
fn generated_scenes_have_the_hits_that_embree_finds() {
    let folder = Folder::new();
    for (name, hits, depths) in
        [("three", 47_828, 501_301.8), ("s1k", 30_202, 134_031.7), ("s100k", 42_175, 171_679.05)]
    {
        let text = folder.run(&format!("bench --scene {name} --pixels 256x256 --rounds 1")).text();
        let round = &rounds(&text)[0];
        assert_eq!(round["hits"], format!("{hits}"), "{text}");
        let said: f64 = round["depths"].parse().expect("a number");
        assert!((said - depths).abs() < 0.1, "{text}");
    }
    let text = folder.run("bench --pixels 64x64 --rounds 1 --no-shadow").text();
    assert_eq!((rounds(&text)[0]["rays"], rounds(&text)[0]["lit"]), ("4096", "0"), "{text}");
}

/// Both orders see as many pixels of objects, except at edges, at the same depths.
#[test]
fn object_order_is_measured_beside_image_order() {
    let folder = Folder::new();
    for scene in ["three", "s1k"] {
        let run = |order: &str| {
            folder
                .run(&format!("bench --scene {scene} --pixels 64x64 --rounds 1 --no-shadow --algorithm {order}"))
                .text()
        };
        let [traced, drawn] = ["raytrace", "rasterize"].map(run);
        let number = |text: &str, name| rounds(text)[0][name].parse::<f64>().expect("a number");
        assert!((number(&traced, "hits") - number(&drawn, "hits")).abs() <= 4.0, "{traced}{drawn}");
        assert!((number(&traced, "depths") / number(&drawn, "depths") - 1.0).abs() < 0.01, "{traced}{drawn}");
    }
    let json = folder.run("bench --pixels 9x9 --rounds 1 --algorithm rasterize --json").text();
    assert!(json.contains("\"draw_seconds\"") && !json.contains("trace_seconds"), "{json}");
}

#[test]
fn wrong_arguments_are_reported() {
    let folder = Folder::new();
    folder.run("bench none.ron").fails(2, "none.ron");
    folder.run("bench --scene four").is_misused("three");
    folder.run("bench --pixels 65536x65536").fails(2, "too large");
    folder.run("bench --kernel best").is_misused("scalar");
    folder.run("bench --rounds 0").is_misused("--rounds");
    folder.run("bench --algorithm rasterize --samples 4").fails(2, "one sample per pixel");
    folder.run("bench --algorithm painter").is_misused("rasterize");
}
