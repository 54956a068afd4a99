//! A scene without a file: a ring of spheres, built in code and printed in truecolor half blocks.

use glam::Vec3;
use std::f32::consts::TAU;
use std::io::{self, Write};
use termtrace::{
    Camera, CellMode, LinearRgb, Material, Painter, Plane, PointLight, Render, Sampling, Scene, SceneFault, Size,
    Sphere, export, tone,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let camera = Camera::look_at(Vec3::new(0.0, 3.0, 7.0), Vec3::new(0.0, 0.4, 0.0))?.with_fov_degrees(40.0)?;
    let mut scene = Scene::builder(camera)
        .object(Plane::new(Vec3::ZERO, Vec3::Y)?, Material::default())
        .light(PointLight::new(Vec3::new(3.0, 6.0, 4.0), LinearRgb::grey(45.0))?)
        .ambient(LinearRgb::grey(0.05));
    for k in 0..9 {
        let (sphere, material) = ball(k)?;
        scene = scene.object(sphere, material);
    }
    let scene = scene.build()?;

    let mode = CellMode::HALF_BLOCK;
    let resolution = mode.resolution(Size::new(80, 24), 2.0)?;
    let light = Render::new(&scene).resolution(resolution).sampling(Sampling::BEST).run()?;
    let grid = Painter::new(mode).grid(&tone(&light, &scene));
    io::stdout().write_all(&export::ansi(&grid))?;
    Ok(())
}

/// The k-th of nine spheres in a ring, from red to blue.
fn ball(k: u8) -> Result<(Sphere, Material), SceneFault> {
    let part = f32::from(k) / 9.0;
    let (sin, cos) = libm::sincosf(part * TAU);
    let reflectance = LinearRgb::new(0.9, 0.1, 0.1).lerp(LinearRgb::new(0.1, 0.2, 0.9), part);
    Ok((Sphere::new(Vec3::new(2.2 * cos, 0.5, 2.2 * sin), 0.5)?, Material::diffuse(reflectance)?))
}
