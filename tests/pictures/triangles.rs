//! Triangles and the tree over them: no gaps between triangles, and no missed hits.

use glam::Vec3;
use proptest::prelude::*;
use std::collections::{HashMap, HashSet};
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use termtrace::internals::bvh::{Bvh, LeafVisitor, Leaves, Prefetch, RayStack};
use termtrace::internals::hit::{
    Kernel, Observer, PrimitiveTest, any_hit, any_hit_observed, any_hits, closest_hit, closest_hit_observed,
    closest_hits,
};
use termtrace::internals::lanes::{ALL, F32x8, LANES, set_bits};
use termtrace::internals::light::LightSource;
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::ray::{EightRays, Interval, Probe, Ray, Rays};
use termtrace::internals::shade::shadow_ray;
use termtrace::internals::shape::{Side, Surface};
use termtrace::{
    Bounds, Camera, Cancelled, Falloff, Hit, LinearRgb, Material, Mesh, Object, Plane, PointLight, Pose, Resolution,
    Scene, Shape, Sphere, Triangle, ViewRectangle, render,
};

fn scene(shapes: impl IntoIterator<Item = Shape>) -> Scene {
    let pose = Pose { eye: Vec3::new(0.0, 0.0, 5.0), target: Vec3::ZERO, up: Vec3::Y };
    let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(1.0).unwrap()).unwrap();
    Scene::new(camera, shapes.into_iter().map(|shape| Object::new(shape, Material::DEFAULT)).collect())
}

fn mesh(points: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Shape {
    Mesh::new(MeshFile::new(points, triangles).expect("it is a mesh")).expect("a mesh nearby").into()
}

/// Returns an icosahedron on the unit sphere whose triangles are each cut into four, `cuts` times.
fn icosphere(cuts: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let golden = f32::midpoint(1.0, 5.0_f32.sqrt());
    let mut points: Vec<Vec3> = [(0.0, 1.0, golden), (1.0, golden, 0.0), (golden, 0.0, 1.0)]
        .into_iter()
        .flat_map(|(x, y, z)| {
            let signs = move |v: f32| if v == 0.0 { vec![v] } else { vec![v, -v] };
            signs(x).into_iter().flat_map(move |x| {
                signs(y)
                    .into_iter()
                    .flat_map(move |y| signs(z).into_iter().map(move |z| Vec3::new(x, y, z).normalize()))
            })
        })
        .collect();
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let near = |a: Vec3, b: Vec3| (a.distance(b) - edge).abs() < 1e-3;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [points[a], points[b], points[c]];
                if near(p, q) && near(q, r) && near(r, p) {
                    let outward = (q - p).cross(r - p).dot(p) > 0.0;
                    triangles.push(if outward {
                        [a as u32, b as u32, c as u32]
                    } else {
                        [a as u32, c as u32, b as u32]
                    });
                }
            }
        }
    }
    for _ in 0..cuts {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (points, triangles)
}

/// Rays from inside a closed mesh are aimed exactly at corners and points of edges, at any scale.
#[test]
fn a_closed_mesh_lets_no_ray_out() {
    let (points, triangles) = icosphere(4);
    assert_eq!(triangles.len(), 5_120);
    for (scale, center) in [
        (1.0, Vec3::ZERO),
        (1.0, Vec3::new(3.0, -4.0, 5.0)),
        (1e-3, Vec3::new(1.0, 2.0, -3.0)),
        (1e5, Vec3::new(-7.0, 11.0, 13.0)),
    ] {
        let points: Vec<Vec3> = points.iter().map(|&point| center + point * scale).collect();
        let scene = scene([mesh(points.clone(), triangles.clone())]);
        let mut leaks = 0;
        let mut rays = 0;
        for (at, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|corner| points[corner as usize]);
            let share = (at % 17) as f32 / 17.0;
            for target in [a, a + (b - a) * share, b + (c - b) * 0.5, c + (a - c) * (1.0 - share)] {
                let origin = center + Vec3::new(0.1, -0.2, 0.05) * scale;
                rays += 1;
                leaks += u32::from(closest_hit(&scene, &Ray { origin, direction: target - origin }).is_none());
            }
        }
        assert_eq!((rays, leaks), (20_480, 0), "at scale {scale}");
    }
}

/// From outside, too, no ray goes between two triangles of the near side and hits the far one.
#[test]
fn no_ray_goes_through_the_near_side() {
    let (points, triangles) = icosphere(3);
    let scene = scene([mesh(points.clone(), triangles.clone())]);
    let origin = Vec3::new(0.3, 0.4, 4.0);
    for corners in &triangles {
        let [a, b, c] = corners.map(|corner| points[corner as usize]);
        if a.z < 0.5 {
            continue;
        }
        for target in [a, (a + b) * 0.5, (b + c) * 0.5] {
            let ray = Ray { origin, direction: target - origin };
            let hit = closest_hit(&scene, &ray).expect("it is in the way");
            assert!((hit.t - 1.0).abs() < 1e-3, "{hit:?} behind {target}");
            assert_eq!(hit.surface(&scene).at_crossing(&ray, hit.t).side, Side::Front);
        }
    }
}

/// Of the lit points of a closed mesh nearly none may seem to be in its own shadow, at any scale.
#[test]
fn meshes_do_not_shadow_themselves() {
    let (points, triangles) = icosphere(3);
    for scale in [1e-3_f32, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5] {
        let center = Vec3::new(3.0, 4.0, -1.0) * scale;
        let points = points.iter().map(|&point| center + point * scale).collect();
        let scene = scene([mesh(points, triangles.clone())]);
        let mut numbers = 0_u32;
        let mut next = || {
            numbers = numbers.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (numbers >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let mut direction = || Vec3::new(next(), next(), next()).normalize_or(Vec3::X);
        let shadowed = (0..100_000)
            .filter(|_| {
                let origin = center + direction() * (5.0 * scale);
                let ray = Ray { origin, direction: center + direction() * (0.9 * scale) - origin };
                let Some(hit) = closest_hit(&scene, &ray) else { return false };
                let point = hit.surface(&scene).at_crossing(&ray, hit.t);
                let position = center + direction() * (8.0 * scale);
                let lamp =
                    PointLight::new(position, LinearRgb::grey(1.0)).expect("a light").with_falloff(Falloff::None);
                // The mesh is convex: each surface that faces the light is lit.
                let faces = (position - point.position).normalize().dot(point.geometric_normal) > 1e-3;
                faces && any_hit(&scene, &shadow_ray(&lamp.into(), &point), PointLight::BLOCKING_INTERVAL)
            })
            .count();
        assert!(shadowed <= 10, "{shadowed} false shadows of 100,000 at scale {scale}");
    }
}

/// Returns whole numbers, exact in f32, whose products are exact in i128.
fn whole(limit: i128) -> impl Strategy<Value = [i128; 3]> {
    [-limit..=limit, -limit..=limit, -limit..=limit]
}

fn determinant([a, b, c]: [[i128; 3]; 3]) -> i128 {
    (0..3).map(|x| (x, (x + 1) % 3, (x + 2) % 3)).map(|(x, y, z)| a[x] * (b[y] * c[z] - b[z] * c[y])).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// Rays go through points of an edge, rounded to whole numbers, and one beside them.
    ///
    /// Each triangle, however small for its distance, is hit if the ray passes all three edges on the same side.
    #[test]
    fn the_side_on_which_a_ray_passes_an_edge_is_exact(
        origin in whole(1 << 22),
        place in whole(1 << 21),
        corners in (2..21_u32).prop_flat_map(|size| [whole(1 << size), whole(1 << size), whole(1 << size)]),
        share in 0..=64_i128,
        beside in whole(1),
        exponent in -100..=60_i32,
    ) {
        let plus = |a: [i128; 3], b: [i128; 3], factor: i128| [0, 1, 2].map(|axis| a[axis] + b[axis] * factor);
        let corners = corners.map(|corner| plus(corner, place, 1));
        let [a, b, _] = corners;
        let on_edge = [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * share / 64);
        let direction = plus(plus(on_edge, beside, 1), origin, -1);
        prop_assume!(direction != [0; 3]);
        let [a, b, c] = corners.map(|corner| plus(corner, origin, -1));
        let sides = [[direction, c, b], [direction, a, c], [direction, b, a]].map(determinant);
        let expected = sides.iter().all(|&side| side >= 0) != sides.iter().all(|&side| side <= 0);
        let scale = f32::from_bits(((127 + exponent) as u32) << 23);
        let vector = |v: [i128; 3]| Vec3::from(v.map(|x| x as f32 * scale));
        let probe = Probe::new(Ray { origin: vector(origin), direction: vector(direction) });
        let line = Interval { min: f32::MIN, max: f32::MAX };
        let found = Triangle::unchecked(corners.map(vector)).closest_crossing(&probe, line);
        prop_assert_eq!(found.is_some(), expected, "{:?}, {:?}", sides, found);
    }
}

/// A triangle is hit from both sides and on its edges, and not beside it.
#[test]
fn a_triangle_is_between_its_corners() {
    let triangle = Triangle::unchecked([Vec3::ZERO, Vec3::X, Vec3::Y]);
    let hit = |x: f32, y: f32, z: f32| {
        let ray = Ray { origin: Vec3::new(x, y, z), direction: Vec3::new(0.0, 0.0, -z) };
        let t = triangle.closest_crossing(&Probe::new(ray), Interval::IN_FRONT)?;
        let point = triangle.at_crossing(&ray, t);
        assert!((t - 1.0).abs() < 1e-6 && point.position.abs_diff_eq(Vec3::new(x, y, 0.0), 1e-6));
        assert!(point.uv.abs_diff_eq(glam::Vec2::new(x, y), 1e-6), "{point:?}");
        Some((point.side, point.shading_normal))
    };
    assert_eq!(hit(0.25, 0.25, 3.0), Some((Side::Front, Vec3::Z)));
    assert_eq!(hit(0.25, 0.25, -3.0), Some((Side::Back, -Vec3::Z)));
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.0, 0.3)] {
        assert!(hit(x, y, 2.0).is_some(), "({x}, {y}) is on an edge");
    }
    for (x, y) in [(-0.001, 0.5), (0.5, -0.001), (0.501, 0.5), (2.0, 2.0)] {
        assert!(hit(x, y, 2.0).is_none(), "({x}, {y}) is beside it");
    }
    let edge_on = Ray { origin: Vec3::new(-1.0, 0.25, 0.0), direction: Vec3::X };
    assert_eq!(triangle.closest_crossing(&Probe::new(edge_on), Interval::IN_FRONT), None);
    let flat = Triangle::unchecked([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]);
    let ray = Ray { origin: Vec3::new(0.5, 0.0, 1.0), direction: -Vec3::Z };
    assert_eq!(flat.closest_crossing(&Probe::new(ray), Interval::IN_FRONT), None);
}

/// The light on a mesh with normals is smooth, but shadow rays start off the flat triangle.
#[test]
fn normals_between_corners_are_interpolated() {
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let normals = [Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0)];
    let smooth = |normals: [Vec3; 3]| {
        Shape::from(
            Mesh::new(MeshFile::new(corners.clone(), vec![[0, 1, 2]]).unwrap().with_normals(normals.into()).unwrap())
                .expect("a mesh nearby"),
        )
    };
    let point = |shape: &Shape, z: f32| {
        let ray = Ray { origin: Vec3::new(0.25, 0.5, z), direction: Vec3::new(0.0, 0.0, -z) };
        shape.primitive(0).at_crossing(&ray, 1.0)
    };
    let [a, b, c] = normals.map(Vec3::normalize);
    let expected = (a * 0.25 + b * 0.25 + c * 0.5).normalize();
    let front = point(&smooth(normals), 1.0);
    assert!(front.shading_normal.abs_diff_eq(expected, 1e-6) && front.geometric_normal == Vec3::Z, "{front:?}");
    let back = point(&smooth(normals), -1.0);
    assert!(back.shading_normal.abs_diff_eq(-expected, 1e-6) && back.geometric_normal == -Vec3::Z, "{back:?}");
    let without = point(&smooth([Vec3::ZERO; 3]), 1.0);
    assert_eq!(without.shading_normal, Vec3::Z, "where there is none, the triangle's own");
}

// The tree -----------------------------------------------------------------------------------------------------------

/// Returns coordinates of which many are equal.
///
/// They give triangles without an area, boxes without a size, and objects in one place.
fn coarse() -> impl Strategy<Value = Vec3> {
    [-3..=3_i8, -3..=3_i8, -3..=3_i8].prop_map(|[x, y, z]| Vec3::new(x.into(), y.into(), z.into()))
}

fn anywhere() -> impl Strategy<Value = Vec3> {
    [-4.0_f32..4.0, -4.0_f32..4.0, -4.0_f32..4.0].prop_map(Vec3::from)
}

fn place() -> impl Strategy<Value = Vec3> {
    prop_oneof![coarse(), anywhere()]
}

fn any_mesh() -> impl Strategy<Value = Shape> {
    prop::collection::vec(place(), 3..30).prop_flat_map(|points| {
        let count = points.len() as u32;
        let triangles = prop::collection::vec([0..count, 0..count, 0..count], 1..60);
        triangles.prop_map(move |triangles| mesh(points.clone(), triangles))
    })
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        3 => [place(), place(), place()].prop_map(|corners| Triangle::unchecked(corners).into()),
        3 => (place(), 0.05_f32..1.5).prop_map(|(center, radius)| Sphere::new(center, radius).expect("a sphere").into()),
        1 => place().prop_map(|point| Plane::new(point, Vec3::Y).expect("a plane").into()),
        1 => any_mesh(),
    ]
}

fn ray() -> impl Strategy<Value = Ray> {
    (place(), place())
        .prop_map(|(origin, target)| Ray { origin, direction: target - origin })
        .prop_filter("it goes somewhere", |ray| ray.direction != Vec3::ZERO)
}

/// Returns the closest hit by testing every primitive of every object.
fn brute_force(scene: &Scene, ray: &Ray, within: Interval) -> Option<Hit> {
    let probe = Probe::new(*ray);
    let objects = (0..).zip(scene.objects());
    let primitives = objects
        .flat_map(|(object, it)| (0..it.shape.primitive_count()).map(move |primitive| (object, primitive, &it.shape)));
    primitives
        .filter_map(|(object, primitive, shape)| {
            let t = shape.primitive(primitive).closest_crossing(&probe, within)?;
            Some(Hit { t, object, primitive })
        })
        // The first of several hits at the same t.
        .min_by(|a, b| a.t.partial_cmp(&b.t).expect("no t is NaN"))
}

/// An observer that records every test.
#[derive(Default)]
struct TestRecorder {
    boxes: usize,
    tests: Vec<PrimitiveTest>,
}

impl Observer for TestRecorder {
    fn node_tested(&mut self) {
        self.boxes += 1;
    }

    fn primitive_tested(&mut self, test: PrimitiveTest) {
        self.tests.push(test);
    }
}

impl TestRecorder {
    /// Returns whether the reported tests are right.
    ///
    /// No primitive is reported twice; each has its crossing and the closest is the hit.
    fn is_right(&self, scene: &Scene, ray: &Ray, min: f32, met: Option<Hit>) -> bool {
        let from_min = Interval { min, max: f32::MAX };
        let crossing = |test: &PrimitiveTest| {
            let primitive = scene.objects()[test.object as usize].shape.primitive(test.primitive);
            primitive.closest_crossing(&Probe::new(*ray), from_min)
        };
        let names: HashSet<_> = self.tests.iter().map(|test| (test.object, test.primitive)).collect();
        let tells_of =
            |Hit { t, object, primitive }| self.tests.contains(&PrimitiveTest { object, primitive, t: Some(t) });
        names.len() == self.tests.len()
            && self.tests.iter().all(|test| test.t == crossing(test))
            && met.is_none_or(tells_of)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    /// An observed ray has the same hit, and the observer gets each step to it.
    #[test]
    fn an_observer_changes_no_hit_and_gets_every_test(shapes in prop::collection::vec(shape(), 1..40), ray in ray()) {
        let scene = scene(shapes);
        let mut observer = TestRecorder::default();
        let hit = closest_hit_observed(&scene, &ray, &mut observer);
        prop_assert_eq!(hit, closest_hit(&scene, &ray));
        prop_assert!(observer.is_right(&scene, &ray, 0.0, hit), "{:?} {:?}", observer.tests, hit);
        let closest = observer.tests.iter().filter_map(|test| test.t).fold(f32::INFINITY, f32::min);
        prop_assert_eq!(hit.map_or(f32::INFINITY, |hit| hit.t), closest);
        let parts: u32 = scene.objects().iter().map(|object| object.shape.primitive_count()).sum();
        // There are more primitives than a leaf of each kind holds: the tree has inner nodes, whose root is visited.
        prop_assert!(parts <= 16 || observer.boxes > 0 || observer.tests.len() == parts as usize);
        for within in [PointLight::BLOCKING_INTERVAL, Interval { min: 0.3, max: 0.7 }] {
            let mut observer = TestRecorder::default();
            let met = any_hit_observed(&scene, &ray, within, &mut observer);
            prop_assert_eq!(met.is_some(), any_hit(&scene, &ray, within));
            prop_assert!(met.is_none_or(|hit| within.contains(hit.t)));
            prop_assert!(observer.is_right(&scene, &ray, within.min, met), "{:?} {:?}", observer.tests, met);
        }
    }

    #[test]
    fn the_tree_finds_the_hits_of_a_brute_force_search(shapes in prop::collection::vec(shape(), 1..40), rays in prop::collection::vec(ray(), 1..20)) {
        let doubled: Vec<Shape> = shapes.iter().chain(&shapes[..shapes.len() / 2]).cloned().collect();
        let scene = scene(doubled);
        for ray in &rays {
            let found = closest_hit(&scene, ray);
            prop_assert_eq!(found, brute_force(&scene, ray, Interval::IN_FRONT), "{:?}", ray);
            for within in [PointLight::BLOCKING_INTERVAL, Interval::IN_FRONT, Interval { min: 0.3, max: 0.7 }] {
                prop_assert_eq!(any_hit(&scene, ray, within), brute_force(&scene, ray, within).is_some(), "{:?} {:?}", ray, within);
            }
        }
    }

    /// Objects that are not visible change the tree, but not the picture.
    #[test]
    fn hidden_objects_do_not_change_the_picture(shapes in prop::collection::vec(shape(), 1..40), hidden in prop::collection::vec(anywhere(), 1..40)) {
        let light = PointLight::new(Vec3::new(3.0, 6.0, 5.0), LinearRgb::grey(40.0)).expect("a light");
        let picture = |shapes: Vec<Shape>| {
            let scene = scene(shapes).with_lights(vec![light]);
            render(&scene, scene.camera(), Resolution::square(24, 16), NonZeroU32::MIN).hash()
        };
        let behind = hidden.iter().map(|&place| Sphere::new(place * 3.0 + Vec3::Z * 40.0, 1.0).expect("a sphere").into());
        let more: Vec<Shape> = shapes.iter().cloned().chain(behind).collect();
        prop_assert_eq!(picture(shapes), picture(more));
    }

    /// The interval of a ray in a box has that of its contents, and of a box in it.
    #[test]
    fn intervals_of_nested_boxes_are_nested(corners in [place(), place()], more in place(), ray in ray(), share in [0.0_f32..=1.0, 0.0..=1.0, 0.0..=1.0]) {
        let inner = Bounds::of(corners);
        let outer = inner.union(&Bounds::of([more]));
        let probe = Probe::new(ray);
        let (inside, around) = (inner.crossed(&probe), outer.crossed(&probe));
        prop_assert!(around.min <= inside.min && around.max >= inside.max);
        let point = inner.min + inner.extent() * Vec3::from(share);
        let through = Ray { origin: ray.origin, direction: point - ray.origin };
        prop_assume!(through.direction != Vec3::ZERO);
        let way = inner.crossed(&Probe::new(through));
        prop_assert!(way.contains(1.0), "{:?} does not have {}", way, point);
    }

    #[test]
    fn every_box_is_in_one_leaf(boxes in prop::collection::vec([place(), place()], 0..300)) {
        let boxes: Vec<Bounds> = boxes.into_iter().map(Bounds::of).collect();
        let leaves = Bvh::new(&boxes).1;
        let mut order: Vec<u32> = (0..leaves.leaf_count()).flat_map(|leaf| leaves.boxes(leaf).to_vec()).collect();
        order.sort_unstable();
        prop_assert_eq!(order, (0..boxes.len() as u32).collect::<Vec<_>>());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Packets and single rays, with and without the CPU's own instructions, find the same.
    ///
    /// Some of the rays are a bundle, as a packet likes them, from one origin or to one light; the others are random.
    #[test]
    fn all_kernels_find_the_same(
        shapes in prop::collection::vec(shape(), 1..40),
        corners in [place(), place(), place(), place()],
        spread in [0.001_f32..2.0, 0.001_f32..2.0],
        strays in prop::collection::vec(ray(), 0..40),
        count in 1..150_usize,
        active in prop::collection::vec(prop_oneof![Just(ALL), 0..=ALL], 30),
    ) {
        let scene = scene(shapes.iter().chain(&shapes[..shapes.len() / 2]).cloned());
        let [eye, target, across, down] = corners;
        let bundle = (0..count).map(|at| {
            let step = across * ((at % 4 + at / 8 % 2 * 4) as f32 * spread[0]) + down * ((at / 4 % 2 + at / 16 * 2) as f32 * spread[1]);
            Ray { origin: eye, direction: target + step - eye }
        });
        let back = bundle.clone().map(|ray| Ray { origin: ray.origin + ray.direction, direction: -ray.direction });
        let rays: Vec<Ray> = bundle.chain(back).chain(strays).filter(|ray| ray.direction != Vec3::ZERO).collect();
        let eights: Vec<_> = rays.chunks(LANES).map(EightRays::of).zip(active).map(|(rays, active)| some_of(&rays, active)).collect();
        let is_active = |rays: &EightRays, lane: usize| rays.active >> lane & 1 == 1;
        let by_brute_force = |within: Interval| -> Vec<[Option<Hit>; LANES]> {
            let hit = |rays: &EightRays, lane| is_active(rays, lane).then(|| brute_force(&scene, &rays.ray(lane), within)).flatten();
            eights.iter().map(|rays| std::array::from_fn(|lane| hit(rays, lane))).collect()
        };
        // The truth is computed once for all kernels.
        let closest = by_brute_force(Interval::IN_FRONT);
        let met = [PointLight::BLOCKING_INTERVAL, Interval::IN_FRONT, Interval { min: 0.3, max: 0.7 }].map(|within| {
            let bits = |hits: [Option<Hit>; LANES]| (0..LANES).filter(|&lane| hits[lane].is_some()).fold(0_u32, |met, lane| met | 1 << lane);
            (within, by_brute_force(within).into_iter().map(bits).collect::<Vec<_>>())
        });
        for kernel in [Kernel::Auto, Kernel::Packet, Kernel::Single, Kernel::Scalar] {
            let mut hits = Vec::new();
            closest_hits(kernel, &scene, &eights, &mut hits);
            prop_assert_eq!(hits.len(), eights.len());
            for (hits, closest) in hits.iter().zip(&closest) {
                for (lane, closest) in closest.iter().enumerate() {
                    prop_assert_eq!(hits.hit(&scene, lane), *closest, "{:?}", kernel);
                }
            }
            for (within, expected) in &met {
                let mut found = Vec::new();
                any_hits(kernel, &scene, &eights, *within, &mut found);
                prop_assert_eq!(&found, expected, "{:?} {:?}", kernel, within);
            }
        }
    }
}

/// Returns the active ones of these rays as [`EightRays`] needs them.
fn some_of(rays: &EightRays, active: u32) -> EightRays {
    let active = active & rays.active;
    let one = set_bits(active).next().unwrap_or(0);
    let each: Vec<_> = (0..LANES).map(|lane| rays.ray(if active >> lane & 1 == 1 { lane } else { one })).collect();
    EightRays { active, ..EightRays::of(&each) }
}

/// A visitor that counts the visited boxes.
struct Count<'l>(&'l Leaves, usize);

/// Its boxes have no contents.
impl Prefetch for Count<'_> {
    fn prefetch(&self, _: usize) {}
}

impl LeafVisitor for Count<'_> {
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32> {
        self.1 += self.0.boxes(leaf).len();
        ControlFlow::Continue(f32::MAX)
    }
}

/// Each box is half as far away as the next: no cut between equal bins parts them well.
#[test]
fn a_tree_is_never_too_deep_for_its_stack() {
    let boxes: Vec<Bounds> = (0..100_000)
        .map(|at: u32| {
            let x = f32::from_bits((1 + at % 250) << 23);
            Bounds::of([Vec3::new(x, x, x), Vec3::new(x, x, -x)])
        })
        .collect();
    let (bvh, leaves) = Bvh::new(&boxes);
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::new(1.0, 1.0, 0.0) };
    let mut count = Count(&leaves, 0);
    let rays = Rays::<F32x8>::load(&EightRays::of(&[ray]), false);
    bvh.visit_by_single_ray(bvh.root().unwrap(), &rays, Interval::IN_FRONT, &mut RayStack::default(), &mut count);
    assert_eq!(count.1, boxes.len(), "the ray meets them all");
}

#[test]
fn a_build_reports_progress_and_can_be_cancelled() {
    let (points, triangles) = icosphere(6);
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| points[corner as usize]);
    let boxes: Vec<Bounds> = triangles.iter().map(|triangle| Bounds::of(corners(triangle))).collect();
    let placed = AtomicUsize::new(0);
    let built = Bvh::new_or_cancel(&boxes, &|count| {
        placed.fetch_add(count, Ordering::Relaxed);
        Ok::<_, Cancelled>(())
    });
    assert_eq!((built, placed.into_inner()), (Ok(Bvh::new(&boxes)), boxes.len()));
    let placed = AtomicUsize::new(0);
    let given_up = Bvh::new_or_cancel(&boxes, &|count| {
        placed.fetch_add(count, Ordering::Relaxed);
        Err(Cancelled)
    });
    assert_eq!((given_up, placed.into_inner()), (Err(Cancelled), 0));
}

#[test]
fn the_floor_lies_below_the_ground_of_a_mesh() {
    let ground = "v -2 0.1 -2\nv 2 0.1 -2\nv 2 0.1 2\nv -2 0.1 2\n";
    // With something on it, and alone, also upside down.
    for faces in ["v 0 1 0\nf 1 4 3 2\nf 1 3 5\n", "f 1 4 3 2\n", "f 1 2 3 4\n"] {
        let text = format!("{ground}{faces}");
        let mesh = MeshFile::from_bytes("x.obj", text.as_bytes(), &mut |_| unreachable!()).expect("a mesh");
        let scene = Scene::of_mesh(mesh).expect("it has a size");
        let origin = scene.camera().pose().eye;
        for (x, z) in (-19..=19).flat_map(|x| (-19..=19).map(move |z| (x, z))) {
            let direction = Vec3::new(0.1 * x as f32, 0.1, 0.1 * z as f32) - origin;
            let hit = closest_hit(&scene, &Ray { origin, direction }).expect("the ground");
            assert_eq!(hit.object, 0, "{faces:?} at {x}, {z}");
        }
    }
}
