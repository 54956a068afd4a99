//! Generated scenes for benchmarks, which other programs can generate too, for comparisons.

use clap::ValueEnum;
use glam::Vec3;
use termtrace::{
    Camera, CameraError, LinearRgb, Material, Object, Plane, PointLight, Pose, Scene, Shape, Sphere, ViewRectangle,
};

/// The values of `--scene`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Generated {
    /// Three spheres on a plane
    Three,
    /// 1,000 spheres in a cube
    S1k,
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
            Self::S1k => spheres(1_000, 0.06),
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
fn spheres(count: usize, radius: f32) -> Vec<Shape> {
    // The seed is fixed, so that results of different days and programs are about the same scene.
    let mut random = Xorshift(0x9E37_79B9_7F4A_7C15);
    let sphere = |_| {
        let [x, y, z] = [(); 3].map(|()| random.next() * 2.4 - 1.2);
        Sphere::new(Vec3::new(x, y + 0.4, z), radius * (0.5 + random.next())).expect("a sphere").into()
    };
    (0..count).map(sphere).collect()
}

/// Marsaglia's xorshift generator (Xorshift RNGs, 2003) with 64 bits and the shifts 13, 7 and 17.
/// Our own, because a crate's generator may change its sequence with a release, and a program in another language needs
/// the same one.
struct Xorshift(u64);

impl Xorshift {
    /// Returns the next random number, uniform in 0..1, from the upper 24 bits of the state: as
    /// many as an f32 represents exactly.
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / 16_777_216.0
    }
}
