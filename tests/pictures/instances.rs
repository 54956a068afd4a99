//! Instances of meshes: the same hits as those of copies, from any kernel, in little memory.

use super::shapes::Random;
use glam::Vec3;
use std::fmt::Write;
use std::path::Path;
use std::sync::LazyLock;
use termtrace::internals::hit::{Kernel, any_hits, closest_hits};
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::ray::{EightRays, Interval, Ray};
use termtrace::internals::scene::Object;
use termtrace::internals::shape::{Mesh, Placement, Surface};
use termtrace::{Hit, LinearRgb, Render, Resolution, Scene, Shape};

/// The number of instances, which have 1.1 million triangles together.
const COUNT: usize = 1100;

fn path(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name).to_string_lossy().into_owned()
}

/// Returns factors, angles in degrees and translations; some mirror.
fn placements() -> Vec<[Vec3; 3]> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut placement = || {
        let scale = random.vector() * 0.2;
        let scale = scale + scale.map(|factor| 0.1_f32.copysign(factor));
        [scale, random.vector() * 180.0, random.vector() * Vec3::new(5.0, 3.0, 5.0)]
    };
    (0..COUNT).map(|_| placement()).collect()
}

const CAMERA: &str = "camera: (eye: (0, 1, 9), target: (0, 0.5, 0)), ambient: 0.1, \
                      lights: [Point(position: (4, 6, 5), intensity: 60)]";

/// Returns a scene of teapots in random places, which share their triangles.
fn shared() -> Scene {
    static SCENE: LazyLock<Scene> = LazyLock::new(load_shared);
    SCENE.clone()
}

fn load_shared() -> Scene {
    let mut text = format!("({CAMERA}, objects: [");
    for placement in placements() {
        let [scale, rotate, translate] = placement.map(|Vec3 { x, y, z }| format!("({x:?}, {y:?}, {z:?})"));
        let _ = write!(text, "Mesh(path: \"teapot.obj\", scale: {scale}, rotate: {rotate}, translate: {translate}), ");
    }
    text += "Sphere(center: (0, 0, 0), radius: 1), Plane(point: (0, -3, 0), normal: (0, 1, 0))])";
    let scene = Scene::from_ron(&path("scenes/x.ron"), &text).unwrap_or_else(|error| panic!("{error}"));
    let [Shape::Mesh(one), Shape::Mesh(other)] = [0, 1].map(|at| &scene.objects()[at].shape) else { panic!("meshes") };
    assert!(std::ptr::eq(one.file(), other.file()), "they share their triangles");
    scene
}

/// Returns the scene of [`shared`], in which each teapot has its own moved corners.
fn copied() -> Scene {
    static SCENE: LazyLock<Scene> = LazyLock::new(|| build_copied(&shared()));
    SCENE.clone()
}

fn build_copied(shared: &Scene) -> Scene {
    let bytes = std::fs::read(path("scenes/teapot.obj")).expect("the mesh is there");
    let file = MeshFile::from_bytes("teapot.obj", &bytes, &mut |_| unreachable!("it names no file")).expect("a mesh");
    let mesh = Shape::from(Mesh::new(file).expect("it is near"));
    let placed = |placement: [Vec3; 3]| {
        let [scale, degrees, translation] = placement.map(Vec3::as_dvec3);
        let placement = Placement::new(scale, degrees, translation).expect("a placement");
        mesh.clone().placed(&placement).expect("it is near")
    };
    let shapes = placements().into_iter().map(placed).chain(shared.objects()[COUNT..].iter().map(|o| o.shape.clone()));
    let objects = shapes.zip(shared.objects()).map(|(shape, object)| Object::new(shape, object.material));
    Scene::builder(*shared.camera()).objects(objects).build().expect("a scene")
}

fn rays(count: usize) -> Vec<Ray> {
    let mut random = Random(7);
    let mut ray = |at: usize| {
        let origin = random.vector() * [20.0, 4.0, 300.0][at % 3];
        let direction = random.vector() * Vec3::new(5.0, 3.0, 5.0) - origin;
        Ray { origin, direction }
    };
    (0..count).map(&mut ray).collect()
}

fn hits(kernel: Kernel, scene: &Scene, rays: &[Ray]) -> Vec<Option<Hit>> {
    let groups: Vec<_> = rays.chunks(8).map(EightRays::of).collect();
    let mut hits = Vec::new();
    closest_hits(kernel, scene, &groups, &mut hits);
    (0..rays.len()).map(|at| hits[at / 8].hit(scene, at % 8)).collect()
}

#[test]
fn instances_look_like_copies_with_moved_corners() {
    let shared = shared();
    let copied = copied();
    let rays = rays(6000);
    let [of_shared, of_copied] = [&shared, &copied].map(|scene| hits(Kernel::Auto, scene, &rays));
    let (mut found, mut other) = (0, 0);
    for ((ray, one), another) in rays.iter().zip(of_shared).zip(of_copied) {
        let (Some(one), Some(another)) = (one, another) else {
            other += u32::from(one.is_some() || another.is_some());
            continue;
        };
        // At an edge, the rounding of the corners decides which object or triangle is hit.
        if (one.object, one.primitive) != (another.object, another.primitive) {
            other += 1;
            continue;
        }
        found += 1;
        let length = ray.direction.length();
        assert!((one.t - another.t).abs() * length <= 3e-5 * (1.0 + one.t * length), "{ray:?}: {one:?} {another:?}");
        let [a, b] = [(&shared, one), (&copied, another)]
            .map(|(scene, hit)| (hit.surface(scene).at_crossing(ray, hit.t), hit.surface(scene)));
        let far = 1e-4 * (1.0 + ray.origin.length());
        assert!(a.0.position.distance(b.0.position) < far, "{ray:?}: {:?} {:?}", a.0, b.0);
        assert!(a.0.geometric_normal.dot(b.0.geometric_normal) > 0.999, "{ray:?}: {:?} {:?}", a.0, b.0);
        assert!(a.0.shading_normal.dot(b.0.shading_normal) > 0.99, "{ray:?}: {:?} {:?}", a.0, b.0);
        assert_eq!(a.0.side, b.0.side, "{ray:?}");
        assert_eq!(
            shared.objects()[one.object as usize].shape.kind(),
            copied.objects()[one.object as usize].shape.kind()
        );
    }
    assert!(found > 3000, "{found} rays hit the same triangle");
    assert!(other * 200 < found, "{other} of {found} rays hit another triangle");
}

/// The boxes around instances are those of their moved corners.
#[test]
fn bounds_of_instances_are_tight() {
    let shared = shared();
    for (one, other) in shared.objects().iter().zip(copied().objects()).take(COUNT) {
        let [one, other] = [one, other].map(|object| object.shape.bounds().expect("a mesh has bounds"));
        let off = (one.min - other.min).abs().max((one.max - other.max).abs()).max_element();
        assert!(off < 2e-6, "{one:?} {other:?}");
    }
}

#[test]
fn all_kernels_see_the_same_instances() {
    let (scene, rays) = (shared(), rays(3000));
    let single = hits(Kernel::Single, &scene, &rays);
    let groups: Vec<_> = rays.chunks(8).map(EightRays::of).collect();
    let near = Interval { min: 0.0, max: 0.9 };
    let shadows = |kernel| {
        let mut masks = Vec::new();
        any_hits(kernel, &scene, &groups, near, &mut masks);
        masks
    };
    let single_shadows = shadows(Kernel::Single);
    for kernel in [Kernel::Packet, Kernel::Scalar, Kernel::Auto] {
        assert_eq!(hits(kernel, &scene, &rays), single, "{kernel:?}");
        assert_eq!(shadows(kernel), single_shadows, "{kernel:?}");
    }
    for (at, hit) in single.iter().enumerate() {
        let is_near = hit.is_some_and(|hit| near.contains(hit.t));
        assert_eq!(single_shadows[at / 8] >> (at % 8) & 1 == 1, is_near, "{:?}", rays[at]);
    }
}

/// Smooth instances are lit as their copies are, up to the triangles at edges.
#[test]
fn pictures_of_instances_are_those_of_copies() {
    let shared = shared();
    let copied = copied();
    let copied = Scene::builder(*shared.camera())
        .objects(copied.objects().iter().cloned())
        .ambient(shared.ambient())
        .light(shared.lights()[0])
        .build()
        .expect("a scene");
    let resolution = Resolution::new(160, 120).expect("a size");
    let [one, other] =
        [&shared, &copied].map(|scene| Render::new(scene).resolution(resolution).run().expect("no limit"));
    let differs = |(a, b): &(&LinearRgb, &LinearRgb)| (a.g - b.g).abs() > 0.01;
    let off = one.pixels().iter().zip(other.pixels()).filter(differs).count();
    assert!(off < 160 * 120 / 200, "{off} pixels differ");
}

/// Explanations and descriptions are about the mesh as it is placed in the scene.
#[test]
fn instances_are_described_and_explained_as_meshes() {
    let scene = shared();
    let ray = rays(600)
        .into_iter()
        .find(|ray| hits(Kernel::Auto, &scene, &[*ray])[0].is_some_and(|hit| (hit.object as usize) < COUNT));
    let ray = ray.expect("a ray meets a teapot");
    let hit = hits(Kernel::Auto, &scene, &[ray])[0].expect("it is hit");
    let equation = hit.surface(&scene).equation(&ray);
    assert!(!equation.is_outside, "{equation:?}");
    assert!((equation.roots[0] - f64::from(hit.t)).abs() < 1e-4 * f64::from(hit.t), "{equation:?} {hit:?}");
    let described = scene.objects()[0].shape.described("clay");
    assert!(described.starts_with("a clay mesh of 992 triangles, "), "{described}");
}

/// Copies are objects of their own in rows along the axes, x first.
#[test]
fn copies_stand_in_rows() {
    let text = "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), objects: [
        Sphere(center: (1, 0, 0), radius: 0.5, scale: 2, translate: (0, 1, 0), \
        copies: (count: (3, 2, 1), step: (5, 4, 9))), Plane(point: (0, -3, 0), normal: (0, 1, 0))])";
    let scene = Scene::from_ron("x.ron", text).unwrap_or_else(|error| panic!("{error}"));
    let centers: Vec<_> =
        scene.objects().iter().filter_map(|o| o.shape.bounds()).map(|b| ((b.min + b.max) * 0.5).to_array()).collect();
    let expected = [[2, 1], [7, 1], [12, 1], [2, 5], [7, 5], [12, 5]].map(|[x, y]| [x as f32, y as f32, 0.0]);
    assert_eq!((centers, scene.objects().len()), (expected.to_vec(), 7));
}
