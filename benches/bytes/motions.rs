//! Motions of the camera through scenes, on which frames with a limit of bytes are judged.
//!
//! Four are fixed; any number of others are drawn from a seed.

use crate::scenes::Draw;
use glam::Vec3;
use std::num::NonZeroU32;
use std::path::Path;
use termtrace::internals::cell;
use termtrace::{Camera, CellMode, Picture, Pose, Scene, Size, render, tone};

/// The number of frames of a motion, 1/30 s apart.
pub(crate) const FRAMES: usize = 48;

/// Rays for each pixel: the colours of antialiased edges are what makes frames large.
const SAMPLES: NonZeroU32 = NonZeroU32::new(16).expect("not 0");

/// A camera that moves evenly, in degrees and world units a second.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    pub(crate) name: &'static str,
    /// The scene, a file in `benches/scenes`.
    scene: &'static str,
    /// The turn of the eye around the target.
    orbit: f32,
    /// The turns of the view around the eye, to the left and up.
    yaw: f32,
    pitch: f32,
    /// The ways of the eye forwards and to the right.
    walk: f32,
    pan: f32,
}

impl Motion {
    const STILL: Self = Self { name: "", scene: "", orbit: 0.0, yaw: 0.0, pitch: 0.0, walk: 0.0, pan: 0.0 };

    pub(crate) const ALL: [Self; 4] = [
        Self { name: "orbit", scene: "three_spheres.ron", orbit: 22.5, ..Self::STILL },
        Self { name: "walk", scene: "corridor.ron", walk: 1.2, ..Self::STILL },
        // 1.15 pixels a frame at 80x24.
        Self { name: "yaw", scene: "three_spheres.ron", yaw: 26.7, ..Self::STILL },
        Self { name: "pan", scene: "teapots.ron", pan: 0.8, ..Self::STILL },
    ];

    /// Returns a motion that mixes two of the five ways to move, in a scene drawn as well.
    pub(crate) fn drawn(seed: u64) -> Self {
        let mut draw = Draw::new(seed);
        let scenes = ["three_spheres.ron", "corridor.ron", "teapots.ron", "many_spheres.ron", "three_lights.ron"];
        let mut motion = Self { name: "drawn", scene: scenes[draw.below(scenes.len())], ..Self::STILL };
        for _ in 0..2 {
            let speed = draw.sign() * draw.between(0.5, 1.5);
            match draw.below(5) {
                0 => motion.orbit += 20.0 * speed,
                1 => motion.yaw += 20.0 * speed,
                2 => motion.pitch += 10.0 * speed,
                3 => motion.walk += speed,
                _ => motion.pan += 0.8 * speed,
            }
        }
        motion
    }

    /// Returns the frames on a screen of that size, whose half cells are square.
    pub(crate) fn frames(&self, size: Size, count: usize) -> Vec<Picture> {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scenes").join(self.scene);
        let scene = Scene::load(&scene).expect("the scenes of the benches are valid");
        let resolution = cell::resolution(CellMode::HALF_BLOCK, size, 2.0).expect("a size that pictures can have");
        let picture = |k| tone(&render(&scene, &self.camera(&scene, k as f32 / 30.0), resolution, SAMPLES), &scene);
        (0..count).map(picture).collect()
    }

    fn camera(&self, scene: &Scene, seconds: f32) -> Camera {
        let Pose { eye, target, up } = scene.camera().pose();
        let angle = |speed: f32| (speed * seconds).to_radians();
        let eye = target + turned(eye - target, Vec3::Y, angle(self.orbit));
        let view = turned(target - eye, Vec3::Y, angle(self.yaw));
        let right = view.cross(up).normalize();
        let view = turned(view, right, angle(self.pitch));
        let level = Vec3::new(view.x, 0.0, view.z).normalize();
        let eye = eye + seconds * (self.walk * level + self.pan * right);
        scene.camera().with_pose(Pose { eye, target: eye + view, up }).expect("a view that is not straight down")
    }
}

/// Returns a vector turned around a unit axis (Rodrigues 1840).
fn turned(vector: Vec3, axis: Vec3, angle: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(angle);
    cos * vector + sin * axis.cross(vector) + (1.0 - cos) * axis.dot(vector) * axis
}
