//! Solids of formulas and meshes.

use glam::Vec3;
use std::num::NonZeroU32;
use termtrace::internals::hit::{Kernel, any_hits, closest_hits};
use termtrace::internals::ray::{EightRays, Interval, Ray};
use termtrace::{Framebuffer, LinearRgb, Resolution, Scene, render};

/// Returns a scene whose paths begin at the meshes of the tests.
fn scene(objects: &str) -> Scene {
    let text = format!(
        "(camera: (eye: (2, 1.5, 4), target: (0, 0, 0)), lights: [Point(position: (4, 5, 6), intensity: 60)], \
            objects: [{objects}])"
    );
    Scene::from_ron("tests/meshes/scene.ron", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn picture(scene: &Scene) -> Framebuffer {
    render(scene, scene.camera(), Resolution::square(96, 72), NonZeroU32::MIN)
}

/// Returns the share of pixels whose light differs by more than a hundredth.
fn difference(one: &Framebuffer, other: &Framebuffer) -> f64 {
    let differ = |(a, b): &(&LinearRgb, &LinearRgb)| {
        let [a, b] = [a, b].map(|light| [light.r, light.g, light.b]);
        (0..3).any(|channel| (a[channel] - b[channel]).abs() > 0.01)
    };
    let pairs = one.pixels().iter().zip(other.pixels());
    pairs.filter(differ).count() as f64 / one.pixels().len() as f64
}

/// A mesh looks the same as an object and as the only visible part of a solid, smooth as it is.
#[test]
fn a_smooth_mesh_stays_smooth_in_a_solid() {
    let mesh = "Mesh(path: \"octahedron_smooth.obj\", rotate: (10, 20, 0)";
    let object = picture(&scene(&format!("{mesh}, material: Diffuse(\"white\"))")));
    let part = picture(&scene(&format!(
        "Solid(union: [{mesh}), Sphere(center: (0, 0, 0), radius: 0.3)], material: Diffuse(\"white\"))"
    )));
    assert!(object.pixels().iter().filter(|light| light.g > 0.05).count() > 300, "the mesh is seen");
    assert!(difference(&object, &part) < 0.002, "{}", difference(&object, &part));
}

/// The volume of a formula is drawn as the shape that it describes.
#[test]
fn a_formula_looks_like_its_shape_in_a_solid() {
    let carved = |ball: &str| {
        picture(&scene(&format!(
            "Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), {ball}], material: Diffuse(\"gold\"))"
        )))
    };
    let shape = carved("Sphere(center: (1, 1, 1), radius: 1.1)");
    let formula = carved(
        "Implicit(f: \"(x-1)^2 + (y-1)^2 + (z-1)^2 - 1.21\", bounds: Box(min: (-0.2, -0.2, -0.2), max: (2.2, 2.2, \
            2.2)))",
    );
    assert!(difference(&shape, &formula) < 0.002, "{}", difference(&shape, &formula));
}

#[test]
fn a_mesh_with_open_edges_is_no_part_of_a_solid() {
    let text = "(camera: (eye: (2, 1.5, 4), target: (0, 0, 0)), objects: [
        Solid(union: [Mesh(path: \"square.obj\"), Sphere(center: (0, 0, 0), radius: 1)]),
        Solid(union: [Mesh(path: \"tetrahedron.obj\", scale: 1e9), Sphere(center: (0, 0, 0), radius: 1)]),
    ])";
    let error = Scene::from_ron("tests/meshes/scene.ron", text).expect_err("there are faults").to_string();
    for message in [
        "scene.ron:2:23: this Mesh encloses no volume, so it cannot be a part of a Solid: 4 edges are not shared by \
            two triangles of the same orientation",
        "scene.ron:3:23: scaled, rotated and moved, a shape must lie within ±1e9",
    ] {
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn all_kernels_find_the_same_hits_on_solids() {
    let scene = Scene::load("benches/scenes/carved.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let ray = |at: u8| {
        let [x, y] = [at % 64, at / 64].map(f32::from);
        Ray { origin: Vec3::new(0.0, 2.5, 7.0), direction: Vec3::new(0.11 * x - 3.5, 0.6 * y - 2.7, -7.0) }
    };
    let groups: Vec<_> = (0..=255).map(ray).collect::<Vec<_>>().chunks(8).map(EightRays::of).collect();
    let hits = |kernel| {
        let mut hits = Vec::new();
        closest_hits(kernel, &scene, &groups, &mut hits);
        hits.iter().flat_map(|eight| (0..8).map(|lane| eight.hit(&scene, lane))).collect::<Vec<_>>()
    };
    let masks = |kernel| {
        let mut masks = Vec::new();
        any_hits(kernel, &scene, &groups, Interval { min: 0.0, max: 0.95 }, &mut masks);
        masks
    };
    let (single, near) = (hits(Kernel::Single), masks(Kernel::Single));
    let on_solids = single.iter().flatten().filter(|hit| hit.object > 0).count();
    assert!(on_solids > 60, "{on_solids} of 256 rays hit solids");
    for kernel in [Kernel::Packet, Kernel::Scalar, Kernel::Auto] {
        assert_eq!(hits(kernel), single, "{kernel:?}");
        assert_eq!(masks(kernel), near, "{kernel:?}");
    }
}
