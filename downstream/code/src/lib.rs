//! A scene built in code, and a render of it with progress and cancellation.

use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Mutex;
use termtrace::glam::Vec3;
use termtrace::{
    Background, Camera, Framebuffer, LinearRgb, Material, Plane, PointLight, Render, Resolution, Sampling, Scene,
    Sphere,
};

/// A row of balls of growing size.
pub fn balls(count: u16) -> Result<Scene, Box<dyn Error>> {
    let camera = Camera::look_at(Vec3::new(0.0, 2.5, 9.0), Vec3::new(0.0, 0.8, 0.0))?.with_fov_degrees(40.0)?;
    let mut scene = Scene::builder(camera)
        .background(Background::Gradient { bottom: LinearRgb::grey(0.7), top: LinearRgb::new(0.2, 0.4, 0.8) })
        .ambient(LinearRgb::grey(0.05))
        .light(PointLight::new(Vec3::new(4.0, 7.0, 5.0), LinearRgb::grey(80.0))?)
        .object(Plane::new(Vec3::ZERO, Vec3::Y)?, Material::checker(LinearRgb::grey(0.3), LinearRgb::grey(0.8), 1.0)?);
    for at in 0..count {
        let share = (f32::from(at) + 0.5) / f32::from(count);
        let radius = 0.3 + 0.5 * share;
        let ball = Sphere::new(Vec3::new(8.0 * share - 4.0, radius, 0.0), radius)?;
        scene = scene.object(ball, Material::diffuse(LinearRgb::new(0.9 * share, 0.4, 0.9 - 0.9 * share))?);
    }
    Ok(scene.build()?)
}

/// The progress reports of a render, and its result unless it was cancelled.
#[derive(Debug)]
pub struct Traced {
    /// The completed shares, from 0 to 1, in the order of the reports.
    pub shares: Vec<f32>,
    /// The linear light of the picture; `None` if the render was cancelled.
    pub light: Option<Framebuffer>,
}

/// Traces the scene; cancels the render once `is_enough` returns true for the completed share.
pub fn traced(scene: &Scene, resolution: Resolution, is_enough: impl Fn(f32) -> bool + Send + Sync) -> Traced {
    let shares = Mutex::new(Vec::new());
    let render = Render::new(scene).resolution(resolution).sampling(Sampling::BEST).on_progress(|share| {
        shares.lock().expect("no thread panics with it").push(share);
        if is_enough(share) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let light = render.run().ok();
    Traced { shares: shares.into_inner().expect("no thread panicked with it"), light }
}
