//! Every map of one scene: goldens, the same bytes on any number of threads, and the values of each
//! pixel.
//!
//! `INSTA_UPDATE=always cargo test --test pictures maps` writes the goldens in `tests/snapshots/maps` and the hashes
//! anew.

use std::num::NonZeroU32;
use std::path::Path;
use termtrace::internals::hit::closest_hit;
use termtrace::internals::maps::{self, picture};
use termtrace::internals::render::Executor;
use termtrace::internals::shape::{Side, Surface};
use termtrace::internals::{cell, shade};
use termtrace::{
    Camera, CellMode, Light, LinearRgb, Map, Picture, Resolution, Sampling, Scene, Srgb8, export, render, tone,
};

const ONE: NonZeroU32 = NonZeroU32::MIN;

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.ron"));
    Scene::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns a picture's FNV-1a, as of framebuffers.
fn hash(picture: &Picture) -> u64 {
    let size = [picture.width(), picture.height()].map(u32::to_le_bytes).concat();
    let bytes = picture.pixels().iter().flat_map(|pixel| [pixel.r, pixel.g, pixel.b]);
    let fold = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    size.into_iter().chain(bytes).fold(0xcbf2_9ce4_8422_2325, fold)
}

fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path("../snapshots/maps");
    settings
}

#[test]
fn every_map_looks_as_its_golden() {
    let scene = scene("three_spheres");
    let resolution = Resolution::square(60, 40);
    for map in Map::ALL {
        let seen = picture(map, &scene, scene.camera(), resolution, ONE);
        let text = export::text(&cell::grid_from_picture(CellMode::RAMP, &seen));
        let framed =
            format!("{}\n|{}|", map.legend(&scene, scene.camera()), text.trim_end_matches('\n').replace('\n', "|\n|"));
        settings().bind(|| insta::assert_snapshot!(map.name(), framed));
    }
}

/// A map has the same bytes on any number of threads, or without a pool; and no two maps are alike.
#[test]
fn every_map_has_the_same_bytes_everywhere() {
    let mut hashes = Vec::new();
    let mut found = Vec::new();
    for name in ["three_spheres", "teapots", "inside_sphere"] {
        let scene = scene(name);
        for map in Map::ALL {
            let resolution = Resolution::square(83, 50);
            let made = |threads| {
                let pool =
                    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
                hash(&pool.install(|| picture(map, &scene, scene.camera(), resolution, ONE)))
            };
            let [one, two, seven] = [1, 2, 7].map(made);
            let alone = maps::trace(map, Executor::CurrentThread, &scene, scene.camera(), resolution, ONE.into())
                .expect("it has no token");
            assert!(one == two && one == seven && one == hash(&alone.picture), "{name} {map:?}");
            assert!(!found.contains(&one), "{name} {map:?} looks as another map");
            found.push(one);
            hashes.push(format!("{name} {} {one:016x}", map.name()));
        }
    }
    settings().bind(|| insta::assert_snapshot!("hashes", hashes.join("\n")));
}

/// While the camera moves, two by two pixels are alike.
#[test]
fn a_coarse_map_is_of_larger_pixels() {
    let scene = scene("three_spheres");
    for map in Map::ALL {
        let coarse = picture(map, &scene, scene.camera(), Resolution::square(41, 23), Sampling::Coarse);
        let at = |x: usize, y: usize| coarse.pixels()[y * 41 + x];
        let is_alike = |x, y| at(x, y) == at(x & !1, y & !1);
        let lines = usize::from(map == Map::Contrast) * 41 * 23;
        let others = (0..41 * 23).filter(|pixel| !is_alike(pixel % 41, pixel / 41)).count();
        assert!(others <= lines, "{map:?}: {others} pixels differ from their squares");
    }
}

/// Each map has the values that single rays find and the formulas of docs/controls.md give.
#[test]
fn maps_say_what_is_there() {
    for name in ["three_spheres", "inside_sphere", "teapots", "bare", "tilted_rectangle"] {
        let scene = scene(name);
        let resolution = Resolution::square(32, 20);
        let maps = Map::ALL.map(|map| picture(map, &scene, scene.camera(), resolution, ONE));
        let shown = |map: Map, at: usize| maps[Map::ALL.iter().position(|&v| v == map).expect("a map")].pixels()[at];
        let light = tone(&render(&scene, scene.camera(), resolution, ONE), &scene);
        for at in 0..32 * 20 {
            let ray = eye_ray(scene.camera(), resolution, at);
            assert_eq!(shown(Map::Shaded, at), light.pixels()[at]);
            let Some(hit) = closest_hit(&scene, &ray) else {
                for map in [Map::Lambert, Map::Depth, Map::Normal, Map::Object, Map::Shadow, Map::Facing] {
                    assert_eq!(shown(map, at), Srgb8::new(16, 20, 56), "{name} {map:?} {at}");
                }
                continue;
            };
            let surface = hit.surface(&scene).at_crossing(&ray, hit.t);
            let arriving = |light| shade::incidence(light, &surface);
            let lambert: f32 = scene.lights().iter().filter_map(arriving).map(|light| light.cosine).sum();
            assert_eq!(shown(Map::Lambert, at), Srgb8::from_linear(LinearRgb::grey(lambert)), "{name} {at}");
            let pose = scene.camera().pose();
            let part = hit.t / pose.eye.distance(pose.target);
            let depth = (255.0 / (1.0 + part * part)).round() as u8;
            assert!(shown(Map::Depth, at).r.abs_diff(depth) <= 1, "{name} {at}");
            let n = surface.shading_normal.to_array().map(|n| (127.5 * (n + 1.0)).round() as u8);
            let Srgb8 { r, g, b } = shown(Map::Normal, at);
            assert!([r, g, b].iter().zip(n).all(|(band, n)| band.abs_diff(n) <= 1), "{name} {at}");
            let is_front = surface.side == Side::Front;
            let Srgb8 { r, b, .. } = shown(Map::Facing, at);
            let is_bounded = scene.objects()[hit.object as usize].shape.bounds().is_some();
            // At a slant both are black; a plane is shown as nothing is.
            let is_right = if is_bounded { r == b || (b > r) == is_front } else { (r, b) == (16, 56) };
            assert!(is_right, "{name} {at}: {r} {b}");
            let is_blocked = |light: &Light| {
                scene.shadows()
                    && termtrace::internals::hit::any_hit(
                        &scene,
                        &shade::shadow_ray(light, &surface),
                        light.blocking_interval(),
                    )
            };
            let lit = scene.lights().iter().filter(|light| arriving(light).is_some() && !is_blocked(light)).count();
            let share = 0.22 + 0.78 * lit as f32 / scene.lights().len() as f32;
            assert!(shown(Map::Shadow, at).r.abs_diff((255.0 * share).round() as u8) <= 1, "{name} {at}: lit by {lit}");
        }
    }
}

fn eye_ray(camera: &Camera, resolution: Resolution, at: usize) -> termtrace::internals::ray::Ray {
    let (width, height) = (resolution.width(), resolution.height());
    let (x, y) = (at as u32 % width, at as u32 / width);
    let (qu, qv) = ((x as f32 + 0.5) / width as f32, (height as f32 - (y as f32 + 0.5)) / height as f32);
    camera.eye_rays(resolution.aspect_ratio()).through(qu, qv)
}

/// Each ray is tested against the three spheres and the plane, for which no tree is built.
///
/// The rays are the eye ray, and one for each light that the surface faces.
#[test]
fn the_cost_counts_the_tests_of_rays() {
    let scene = scene("three_spheres");
    let resolution = Resolution::square(40, 30);
    let picture = picture(Map::Cost, &scene, scene.camera(), resolution, ONE);
    let mut kinds = picture.pixels().to_vec();
    kinds.sort();
    kinds.dedup();
    assert!((2..=12).contains(&kinds.len()), "{} costs", kinds.len());
    // A ray into the sky is the eye ray alone; spheres and floor have shadow rays.
    let sky = picture.pixels()[0];
    assert_eq!(sky, Srgb8::new(31, 128, 224), "four tests: the second of the scale's colours");
    let at = |x: usize, y: usize| picture.pixels()[y * 40 + x];
    assert_eq!(at(39, 0), sky);
    assert!(at(20, 15) != sky && at(20, 29) != sky);
    // Without shadows there are no shadow rays.
    let bare = scene.clone().with_shadows(false);
    let bare = maps::picture(Map::Cost, &bare, bare.camera(), resolution, ONE);
    assert!(bare.pixels().iter().all(|&pixel| pixel == sky), "each eye ray meets the same tests");
}

/// A legend fits half of a screen of 80 columns.
#[test]
fn legends_are_short() {
    for name in ["three_spheres", "many_spheres", "teapots"] {
        let scene = scene(name);
        for map in Map::ALL {
            let legend = map.legend(&scene, scene.camera());
            assert!(legend.is_ascii() && legend.len() <= 38 && legend.starts_with(map.name()), "{legend}");
        }
    }
}

#[test]
fn the_last_map_is_followed_by_the_first() {
    for map in Map::ALL {
        assert_eq!(map.next().previous(), map);
        assert_eq!(Map::named(map.name()), Some(map));
    }
    assert_eq!(Map::Shaded.previous().next(), Map::Shaded);
    assert_eq!(Map::named("nothing"), None);
}
