//! A scene without a file: a ring of spheres, built in code and printed in truecolor half blocks.

use glam::Vec3;
use std::f32::consts::TAU;
use std::io::{self, Write};
use std::num::NonZeroU32;
use termtrace::internals::capabilities::USUAL_CELL_ASPECT;
use termtrace::internals::cell;
use termtrace::{
    Camera, CellMode, LinearRgb, Material, Object, Plane, PointLight, Scene, SceneFault, Size, Sphere, export, render,
    tone,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let camera = Camera::look_at(Vec3::new(0.0, 3.0, 7.0), Vec3::new(0.0, 0.4, 0.0))?.with_fov_degrees(40.0)?;
    let scene = Scene::builder(camera)
        .objects((0..9).map(ball).collect::<Result<Vec<_>, _>>()?)
        .object(Plane::new(Vec3::ZERO, Vec3::Y)?, Material::DEFAULT)
        .light(PointLight::new(Vec3::new(3.0, 6.0, 4.0), LinearRgb::grey(45.0))?)
        .ambient(LinearRgb::grey(0.05))
        .build()?;

    let resolution = cell::resolution(CellMode::HALF_BLOCK, Size::new(80, 24), USUAL_CELL_ASPECT)?;
    let picture = tone(&render(&scene, scene.camera(), resolution, NonZeroU32::MIN), &scene);
    io::stdout().write_all(&export::ansi(&cell::grid_from_picture(CellMode::HALF_BLOCK, &picture)))?;
    Ok(())
}

/// The k-th of nine spheres in a ring, from red to blue.
fn ball(k: u8) -> Result<Object, SceneFault> {
    let part = f32::from(k) / 9.0;
    let (sin, cos) = libm::sincosf(part * TAU);
    let reflectance = LinearRgb::new(0.9, 0.1, 0.1).lerp(LinearRgb::new(0.1, 0.2, 0.9), part);
    let sphere = Sphere::new(Vec3::new(2.2 * cos, 0.5, 2.2 * sin), 0.5)?;
    Ok(Object::new(sphere, Material::diffuse(reflectance)?))
}
