use super::*;
use crate::camera::{Camera, Pose, ViewRectangle};
use crate::color::LinearRgb;
use crate::describe::describe;
use crate::explain::explain;
use crate::framebuffer::Resolution;
use crate::hit::{self, Kernel};
use crate::light::PointLight;
use crate::material::Material;
use crate::ray::EightRays;
use crate::render::{Sampling, render};
use crate::scene::{Object, Scene};
use crate::shape::Shape;

fn ray(y: f32) -> Ray {
    Ray { origin: Vec3::new(0.0, y, 10.0), direction: Vec3::new(0.0, 0.0, -1.0) }
}

/// Returns a scene with `count` cubes along the x axis, of side 2, with centers 3 apart.
fn scene(count: u32) -> Scene {
    let pose = Pose { eye: Vec3::new(0.0, 0.0, 10.0), target: Vec3::ZERO, up: Vec3::Y };
    let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(0.8).expect("an angle")).expect("a pose");
    let cube = |at: u32| Cube::new(Vec3::X * 3.0 * at as f32, 1.0);
    let light = PointLight::new(Vec3::new(0.0, 0.0, 3.0), LinearRgb::grey(8.0)).expect("a light");
    Scene::new(camera, (0..count).map(|at| Object::new(cube(at), Material::DEFAULT)).collect()).with_lights(vec![light])
}

#[test]
fn it_is_met_where_its_face_is_whatever_is_beside_it() {
    for count in [1, 8, 9, 1000] {
        let scene = scene(count);
        let found = hit::closest_hit(&scene, &ray(0.5)).expect("the ray goes through the first cube");
        assert!((found.t - 9.0).abs() < 1e-4 && found.object == 0, "{found:?} of {count}");
        assert_eq!(hit::closest_hit(&scene, &ray(1.5)), None);
        assert!(hit::any_hit(&scene, &ray(-0.5), Interval::IN_FRONT));
    }
}

#[test]
fn all_kernels_see_the_same() {
    let scene = scene(40);
    let rays: Vec<_> = (0..640)
        .map(|at| Ray {
            origin: Vec3::new(0.0, 0.0, 10.0),
            direction: Vec3::new((at % 40) as f32 * 0.1 - 1.0, (at / 40) as f32 * 0.02 - 0.16, -1.0),
        })
        .collect();
    let rays: Vec<_> = rays.chunks(8).map(EightRays::of).collect();
    let hits = |kernel| {
        let mut hits = Vec::new();
        hit::closest_hits(kernel, &scene, &rays, &mut hits);
        hits.iter().flat_map(|eight| (0..8).map(|lane| eight.hit(&scene, lane))).collect::<Vec<_>>()
    };
    let single = hits(Kernel::Single);
    assert!(single.iter().flatten().count() > 100, "rays meet cubes");
    assert_eq!(hits(Kernel::Packet), single);
    assert_eq!(hits(Kernel::Scalar), single);
    assert_eq!(hits(Kernel::Auto), single);
}

/// Expects 8 / 2^2 = 2 of arriving light in the middle of the face, times the reflectance 0.8.
#[test]
fn its_light_is_that_of_the_closed_form() {
    let scene = scene(1);
    let light = render(&scene, scene.camera(), Resolution::square(41, 41), Sampling::BEST);
    assert!((light.pixel(20, 20).g - 1.6).abs() < 1e-3, "{:?}", light.pixel(20, 20));
}

#[test]
fn it_is_read_from_a_scene_file() {
    let scene = |object: &str| {
        Scene::from_ron("x.ron", &format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{object}])"))
    };
    let shape = |object| scene(object).map(|scene| scene.objects()[0].shape.clone());
    let cube = |half_side| Shape::from(Cube::new(Vec3::X, half_side));
    assert_eq!(shape("Cube(center: (1, 0, 0), side: 4)").expect("it is fine"), cube(2.0));
    assert_eq!(shape("Cube(center: (1, 0, 0))").expect("a side need not be given"), cube(0.5));
    let message = |object| scene(object).expect_err("something is wrong").to_string();
    assert!(message("Cube(centre: (1, 0, 0))").contains("unknown field \"centre\"; did you mean \"center\"?"));
    assert!(message("Cube(side: 1)").contains("missing field \"center\"; a Cube needs one"));
    assert!(message("Cube(center: (1, 0, 0), side: -1)").contains("the side must be greater than 0"));
    assert!(message("Cub(center: (1, 0, 0))").contains("Cub is not an object; did you mean Cube?"));
}

#[test]
fn it_is_described_and_explained() {
    let (scene, resolution) = (scene(2), Resolution::square(40, 24));
    let text = describe("cubes.ron", &scene, scene.camera(), resolution);
    assert!(text.contains("a light grey cube with sides of 2"), "{text}");
    let lines = explain(&scene, scene.camera(), resolution, [20, 12]).lines();
    assert!(lines.iter().any(|line| line == "closest hit: cube #1"), "{lines:#?}");
    assert!(lines.iter().any(|line| line.starts_with("  t = ") && line.contains(" or ")), "{lines:#?}");
    assert!(Shape::from(Cube::new(Vec3::ZERO, 1.0)).encloses(Vec3::splat(0.9)));
}
