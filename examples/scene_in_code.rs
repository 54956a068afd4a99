//! A scene without a file: a ring of spheres, built in code and printed in truecolor half blocks.

use glam::Vec3;
use std::f32::consts::TAU;
use std::io::{self, Write};
use std::num::NonZeroU32;
use termtrace::internals::capabilities::USUAL_CELL_ASPECT;
use termtrace::internals::cell;
use termtrace::{
    Camera, CellMode, Falloff, LinearRgb, Material, Object, Plane, PointLight, Pose, Scene, Size, Sphere,
    ViewRectangle, export, render, tone,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pose = Pose { eye: Vec3::new(0.0, 3.0, 7.0), target: Vec3::new(0.0, 0.4, 0.0), up: Vec3::Y };
    let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(0.7)?)?;

    let floor = Object::new(Plane::new(Vec3::ZERO, Vec3::Y), Material::DEFAULT);
    let light = PointLight {
        position: Vec3::new(3.0, 6.0, 4.0),
        intensity: LinearRgb::grey(45.0),
        falloff: Falloff::InverseSquare,
    };
    let scene = Scene::new(camera, (0..9).map(ball).chain([floor]).collect())
        .with_ambient(LinearRgb::grey(0.05))
        .with_lights(vec![light]);

    let resolution = cell::resolution(CellMode::HALF_BLOCK, Size::new(80, 24), USUAL_CELL_ASPECT)?;
    let picture = tone(&render(&scene, scene.camera(), resolution, NonZeroU32::MIN), &scene);
    io::stdout().write_all(&export::ansi(&cell::grid_from_picture(CellMode::HALF_BLOCK, &picture)))?;
    Ok(())
}

/// The k-th of nine spheres in a ring, from red to blue.
fn ball(k: u8) -> Object {
    let part = f32::from(k) / 9.0;
    let (sin, cos) = libm::sincosf(part * TAU);
    let reflectance = LinearRgb::new(0.9, 0.1, 0.1).lerp(LinearRgb::new(0.1, 0.2, 0.9), part);
    Object::new(Sphere::new(Vec3::new(2.2 * cos, 0.5, 2.2 * sin), 0.5), Material::diffuse(reflectance))
}
