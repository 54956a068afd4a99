//! A counter of tree builds, and the tests that a scene builds its trees once and that no picture
//! builds one.

use crate::camera::Pose;
use crate::color::LinearRgb;
use crate::describe::describe;
use crate::explain::explain;
use crate::framebuffer::Resolution;
use crate::hit::{self, Kernel};
use crate::maps;
use crate::maps::Map;
use crate::progress::Reporter;
use crate::ray::{Interval, Ray};
use crate::render::{self, ProgressiveRender, Sampling};
use crate::scene::{Draft, Scene};
use crate::tone::tone;
use glam::Vec3;
use std::cell::Cell;
use std::num::NonZeroU32;

thread_local! {
    static BUILDS: Cell<u32> = const { Cell::new(0) };
}

/// Counts the build of a scene's trees on the current thread.
pub(super) fn count_build() {
    BUILDS.set(BUILDS.get() + 1);
}

const SPHERES: &str = r#"(
    camera: (eye: (0, 1, 6), target: (0, 1, 0)),
    lights: [Point(position: (3, 4, 5), intensity: 40)],
    objects: [
        Sphere(center: (0, 1, 0), radius: 1, material: Diffuse("tomato")),
        Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Checker(a: "white", b: "black", size: 1)),
        Triangle(corners: [(0, 0, 0), (2, 0, 0), (0, 2, 0)], material: Diffuse("blue")),
    ],
)"#;

/// Returns how many times `work` builds a scene's trees, on the threads of a separate pool.
#[cfg(feature = "parallel")]
fn builds_during(work: impl FnOnce() + Send) -> u32 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads can be started");
    pool.install(work);
    pool.broadcast(|_| BUILDS.get()).into_iter().sum()
}

/// Returns how many times `work` builds a scene's trees.
#[cfg(not(feature = "parallel"))]
fn builds_during(work: impl FnOnce() + Send) -> u32 {
    let before = BUILDS.get();
    work();
    BUILDS.get() - before
}

#[test]
fn every_way_to_make_a_scene_builds_its_trees_once() {
    assert_eq!(builds_during(|| drop(Scene::from_ron("x", SPHERES).expect("a scene"))), 1);
    let draft = || Draft::from_bytes("x", SPHERES.as_bytes(), &Reporter::silent()).expect("a scene");
    assert_eq!(builds_during(|| drop(draft())), 0);
    assert_eq!(builds_during(|| drop(draft().finish())), 1);
}

#[test]
fn no_picture_builds_a_tree() {
    let scene = &Scene::from_ron("x", SPHERES).expect("a scene");
    let (camera, resolution) = (scene.camera(), Resolution::square(40, 24));
    let built = builds_during(|| {
        let light = render::render(scene, camera, resolution, Sampling::BEST);
        tone(&light, scene);
        ProgressiveRender::new(camera, resolution);
        render::count_rays_and_hits(Kernel::Auto, scene, camera, resolution, NonZeroU32::MIN);
        render::trace_pixel(scene, camera, resolution, [20, 12]);
        for map in Map::ALL {
            maps::picture(map, scene, camera, resolution, Sampling::BEST);
        }
        describe("x", scene, camera, resolution);
        explain(scene, camera, resolution, [20, 12]);
        let ray = Ray { origin: Vec3::new(0.0, 1.0, 6.0), direction: Vec3::NEG_Z };
        hit::closest_hit(scene, &ray);
        hit::any_hit(scene, &ray, Interval::IN_FRONT);
    });
    assert_eq!(built, 0);
}

#[test]
fn a_scene_with_another_camera_or_light_keeps_its_trees() {
    let scene = &Scene::from_ron("x", SPHERES).expect("a scene");
    let built = builds_during(|| {
        let pose = Pose { eye: Vec3::X * 9.0, ..scene.camera().pose() };
        let other = scene.clone().with_camera(scene.camera().with_pose(pose).expect("a pose"));
        let other = other
            .with_lights([] as [crate::light::Light; 0])
            .with_ambient(LinearRgb::grey(1.0))
            .expect("some light")
            .with_exposure(2.0)
            .expect("an exposure");
        assert!(std::ptr::eq(other.accelerator(), scene.accelerator()));
    });
    assert_eq!(built, 0);
}
