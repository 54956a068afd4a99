//! Generated scenes for benchmarks, which other programs can generate too, for comparisons.

use clap::ValueEnum;
use glam::Vec3;
use termtrace::internals::rasterize::random_centers_and_scales;
use termtrace::{
    Camera, CameraError, LinearRgb, Material, Object, Plane, PointLight, Pose, Scene, Shape, Sphere, ViewRectangle,
};

/// The values of `--scene`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Generated {
    /// Three spheres on a plane
    Three,
    /// 10 spheres in a cube, larger than those of s1k
    S10,
    /// 100 spheres in the same cube, larger than those of s1k
    S100,
    /// 1,000 spheres in a cube
    S1k,
    /// 10,000 smaller spheres in the same cube
    S10k,
    /// 100,000 smaller spheres in the same cube
    S100k,
}

impl Generated {
    /// Returns the scene, with one light.
    pub(super) fn scene(self) -> Result<Scene, CameraError> {
        let grey = |shape: Shape| Object::new(shape, Material::diffuse(LinearRgb::grey(0.5)).expect("a reflectance"));
        let light = PointLight::new(Vec3::new(4.0, 6.0, 5.0), LinearRgb::grey(50.0)).expect("a light");
        let objects = self.shapes().into_iter().map(grey).collect();
        Ok(Scene::new(camera()?, objects).with_lights(vec![light]))
    }

    fn shapes(self) -> Vec<Shape> {
        match self {
            Self::Three => {
                let spheres = [([0.0, 0.7, 0.0], 0.7), ([-1.4, 0.5, 0.4], 0.5), ([1.3, 0.4, 0.7], 0.4)];
                let spheres = spheres
                    .map(|(center, radius)| Sphere::new(Vec3::from_array(center), radius).expect("a sphere").into());
                [&spheres[..], &[Plane::new(Vec3::ZERO, Vec3::Y).expect("a plane").into()]].concat()
            }
            // Radii of 0.6 / cbrt(count), so that the spheres of all scenes have about the same total volume.
            Self::S10 => spheres(10, 0.28),
            Self::S100 => spheres(100, 0.13),
            Self::S1k => spheres(1_000, 0.06),
            Self::S10k => spheres(10_000, 0.028),
            Self::S100k => spheres(100_000, 0.013),
        }
    }
}

fn camera() -> Result<Camera, CameraError> {
    let pose = Pose { eye: Vec3::new(0.0, 1.2, 5.0), target: Vec3::new(0.0, 0.4, 0.0), up: Vec3::Y };
    Camera::new(pose, ViewRectangle::from_vertical_fov(40_f32.to_radians())?)
}

/// Returns `count` spheres at random positions in a cube of side 2.4, with radii of 0.5 to 1.5
/// times `radius`.
fn spheres(count: u32, radius: f32) -> Vec<Shape> {
    let sphere = |(center, factor)| Sphere::new(center, radius * factor).expect("a sphere").into();
    random_centers_and_scales(count).map(sphere).collect()
}
