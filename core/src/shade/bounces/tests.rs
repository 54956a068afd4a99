use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::finish::Finish;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::light::PointLight;
use crate::material::Material;
#[cfg(feature = "mesh")]
use crate::mesh_file::MeshFile;
use crate::render::render;
use crate::scene::{Background, Object, Scene};
#[cfg(feature = "mesh")]
use crate::shape::Mesh;
use crate::shape::{Plane, Shape, Sphere};
use glam::Vec3;
#[cfg(feature = "mesh")]
use std::fmt::Write;
use std::num::NonZeroU32;

fn grey(reflectance: f32) -> Material {
    Material::diffuse(LinearRgb::grey(reflectance)).expect("a reflectance")
}

fn sphere(center: Vec3, radius: f32) -> Shape {
    Sphere::new(center, radius).expect("a sphere").into()
}

/// Returns a scene in which light comes from the sky only.
fn below_a_sky(objects: Vec<Object>) -> Scene {
    let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO).expect("a camera");
    let sky = Background::Gradient { bottom: LinearRgb::grey(0.2), top: LinearRgb::new(0.4, 0.8, 1.0) };
    Scene::new(camera, objects).with_background(sky).expect("a background")
}

fn picture(scene: &Scene, side: u32) -> Framebuffer {
    render(scene, scene.camera(), Resolution::square(side, side), NonZeroU32::MIN)
}

/// A mirror shows what a camera behind it would see of mirrored objects.
#[test]
fn a_mirror_shows_mirrored_objects() {
    let ball = |z| Object::new(sphere(Vec3::new(0.3, 0.2, z), 0.5), grey(0.6));
    let light = |z| PointLight::new(Vec3::new(1.0, 2.0, z), LinearRgb::grey(5.0)).expect("a light");
    let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO).expect("a camera");
    let mirror = Plane::new(Vec3::ZERO, Vec3::Z).expect("a plane");
    // The ball is behind the eye, so that it is seen in the mirror only.
    let mirror = Object::new(mirror, grey(1.0)).with_finish(Finish::MIRROR);
    let mirrored = Scene::new(camera, vec![mirror, ball(7.0)]).with_lights([light(6.0)]);
    let direct = Scene::new(camera, vec![ball(-7.0)]).with_lights([light(-6.0)]);
    let [mirrored, direct] = [mirrored, direct].map(|scene| picture(&scene, 40));
    let differ = |(a, b): (&LinearRgb, &LinearRgb)| (a.g - b.g).abs() > 1e-3 * b.g.max(0.01);
    let count = mirrored.pixels().iter().zip(direct.pixels()).filter(|&pair| differ(pair)).count();
    assert!(direct.pixels().iter().any(|light| light.g > 0.01));
    // Rays at the outline of the ball may hit or miss it by rounding.
    assert!(count <= 4, "{count} pixels differ");
}

/// With the index 1, glass is neither seen nor does it bend a ray.
#[test]
fn glass_with_the_index_of_air_is_invisible() {
    let behind = Object::new(sphere(Vec3::new(0.2, 0.0, -3.0), 1.0), grey(0.5));
    let glass = Finish::glass(1.0).expect("an index");
    let without = picture(&below_a_sky(vec![behind.clone()]), 24);
    let ball = Object::new(sphere(Vec3::ZERO, 1.0), grey(1.0)).with_finish(glass);
    let with = picture(&below_a_sky(vec![behind, ball]), 24);
    for (with, without) in with.pixels().iter().zip(without.pixels()) {
        assert!((with.b - without.b).abs() < 1e-3, "{with:?} {without:?}");
    }
}

/// A ray through the middle of a glass ball is not bent.
///
/// Of the light behind it (1 - F)^2 arrives, and the rest after it was mirrored inside, or it is mirrored towards the
/// eye: together all of it.
#[test]
fn light_through_the_middle_of_a_glass_ball() {
    let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO).expect("a camera");
    let ball = Object::new(sphere(Vec3::ZERO, 1.0), grey(1.0)).with_finish(Finish::glass(1.5).expect("an index"));
    let scene = Scene::new(camera, vec![ball]).with_background(LinearRgb::grey(1.0)).expect("a background");
    let middle = f64::from(picture(&scene, 1).pixel(0, 0).g);
    // All directions have light 1, and glass neither adds nor takes any. What is lost is left after six bounces.
    assert!((0.9999..=1.000_01).contains(&middle), "{middle}");
}

/// A white sky around a polished white ball under white ambient light: 1 from each direction.
#[test]
fn a_polished_surface_reflects_no_more_than_it_gets() {
    let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO).expect("a camera");
    let ball = Object::new(sphere(Vec3::ZERO, 1.0), grey(1.0)).with_finish(Finish::polished(1.5).expect("an index"));
    let white = LinearRgb::grey(1.0);
    let scene = Scene::new(camera, vec![ball]).with_background(white).expect("a background");
    let scene = scene.with_ambient(white).expect("an ambient light");
    for light in picture(&scene, 16).pixels() {
        assert!((light.g - 1.0).abs() < 1e-3, "{light:?}");
    }
}

#[test]
fn a_glowing_surface_has_its_own_light() {
    let ball = Object::new(sphere(Vec3::ZERO, 1.0), grey(0.5)).with_finish(Finish::glowing(3.0).expect("a strength"));
    assert_eq!(picture(&below_a_sky(vec![ball]), 1).pixel(0, 0).g, 1.5);
}

/// Two mirrors that face each other end after the scene's number of bounces.
#[test]
fn the_number_of_bounces_is_limited() {
    let mirror = |z: f32| {
        let plane = Plane::new(Vec3::Z * z, Vec3::Z).expect("a plane");
        Object::new(plane, grey(1.0)).with_finish(Finish::MIRROR)
    };
    let scene = below_a_sky(vec![mirror(-1.0), mirror(6.0)]);
    assert_eq!(picture(&scene, 1).pixel(0, 0), LinearRgb::BLACK);
}

/// Returns a unit ball of triangles with the normals of a sphere, as an OBJ file.
#[cfg(feature = "mesh")]
fn ball_of_triangles() -> String {
    const COLUMNS: usize = 96;
    const ROWS: usize = 48;
    let mut text = String::new();
    for row in 0..=ROWS {
        for column in 0..COLUMNS {
            let (y, ring) = libm::sincos(std::f64::consts::PI * (row as f64 / ROWS as f64 - 0.5));
            let (x, z) = libm::sincos(std::f64::consts::TAU * column as f64 / COLUMNS as f64);
            let point = format!("{} {y} {}", ring * x, ring * z);
            let _ = writeln!(text, "v {point}\nvn {point}");
        }
    }
    let at = |row: usize, column: usize| row * COLUMNS + column % COLUMNS + 1;
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            let _ = writeln!(text, "f {a}//{a} {b}//{b} {c}//{c} {d}//{d}");
        }
    }
    text
}

/// Rays enter and leave the triangles of a smooth mesh as they do the sphere that it approximates.
#[test]
#[cfg(feature = "mesh")]
fn a_glass_mesh_refracts_as_the_sphere_does() {
    let file = MeshFile::from_bytes("ball.obj", ball_of_triangles().as_bytes(), &mut |_| unreachable!("no side file"));
    let mesh = Mesh::new(file.expect("a mesh")).expect("it is near");
    let behind = Object::new(sphere(Vec3::new(0.4, 0.6, -4.0), 1.0), grey(0.9));
    let pictures = [Shape::from(mesh), sphere(Vec3::ZERO, 1.0)].map(|ball| {
        let ball = Object::new(ball, grey(1.0)).with_finish(Finish::glass(1.5).expect("an index"));
        picture(&below_a_sky(vec![ball, behind.clone()]), 48)
    });
    let [of_mesh, of_sphere] = pictures.each_ref().map(Framebuffer::pixels);
    let count = of_mesh.iter().zip(of_sphere).filter(|(a, b)| (a.g - b.g).abs() > 0.05).count();
    assert!(count <= of_sphere.len() / 50, "{count} pixels differ");
}

/// A metal ball shows the sky after one bounce, and none if there may be none.
#[test]
#[cfg(feature = "ron")]
fn a_scene_says_how_often_rays_bounce() {
    let middle = |bounces: u32| {
        let text = format!(
            "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), background: 0.5, bounces: {bounces},
              objects: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(1), finish: Metal)])"
        );
        picture(&Scene::from_ron("ball.ron", &text).expect("a scene"), 1).pixel(0, 0).g
    };
    assert_eq!([0, 1].map(middle), [0.0, 0.5]);
}
