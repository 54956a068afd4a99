//! Properties over random geometry. A failure prints the case, and proptest keeps its seed.

use glam::{DVec3, Vec2, Vec3};
use proptest::prelude::*;
use std::num::NonZeroU32;
use termtrace::internals::hit::{Kernel, any_hit, any_hits, closest_hit, closest_hits};
use termtrace::internals::lanes::LANES;
use termtrace::internals::light::LightSource;
use termtrace::internals::ray::{EightRays, Interval, Probe, Ray};
use termtrace::internals::shade::shadow_ray;
use termtrace::internals::shape::{Primitive, Side, Surface};
use termtrace::{
    Background, Camera, CameraError, Falloff, Framebuffer, Hit, Light, LinearRgb, Material, Object, Plane, PointLight,
    Pose, Resolution, Scene, Shape, Sphere, Triangle, ViewRectangle, render,
};

fn number(limit: f32) -> impl Strategy<Value = f32> {
    (-1.0_f32..1.0).prop_map(move |x| x * limit)
}

fn point(limit: f32) -> impl Strategy<Value = Vec3> {
    [number(limit), number(limit), number(limit)].prop_map(Vec3::from)
}

/// Returns a direction of unit length.
fn direction() -> impl Strategy<Value = Vec3> {
    point(1.0).prop_filter_map("too short to have a direction", |v| (v.length() > 0.1).then(|| v.normalize()))
}

fn sphere() -> impl Strategy<Value = Sphere> {
    (point(5.0), 0.1_f32..3.0).prop_map(|(center, radius)| Sphere::new(center, radius).expect("a sphere"))
}

fn plane() -> impl Strategy<Value = Plane> {
    (point(5.0), direction()).prop_map(|(point, normal)| Plane::new(point, normal).expect("a plane"))
}

fn triangle() -> impl Strategy<Value = Triangle> {
    [point(5.0), point(5.0), point(5.0)].prop_map(Triangle::unchecked)
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![sphere().prop_map(Shape::from), plane().prop_map(Shape::from), triangle().prop_map(Shape::from)]
}

fn ray() -> impl Strategy<Value = Ray> {
    (point(8.0), direction(), 0.1_f32..10.0).prop_map(|(origin, d, length)| Ray { origin, direction: d * length })
}

/// Returns any ray, half of them along an axis or two, from whole numbers.
fn any_ray() -> impl Strategy<Value = Ray> {
    let along = (0..3_usize, -5..=5_i32, -5..=5_i32, any::<bool>()).prop_map(|(axis, x, y, turned)| {
        let origin = Vec3::new(x as f32, y as f32, (x - y) as f32);
        let direction = if turned { -Vec3::AXES[axis] } else { Vec3::AXES[axis] + Vec3::AXES[(axis + 1) % 3] };
        Ray { origin, direction }
    });
    prop_oneof![ray(), along]
}

fn pose() -> impl Strategy<Value = Pose> {
    (point(10.0), point(10.0), direction()).prop_map(|(eye, target, up)| Pose { eye, target, up }).prop_filter(
        "up along the view",
        |pose| {
            let view = pose.target - pose.eye;
            view.length() > 0.1 && view.normalize().cross(pose.up).length() > 0.01
        },
    )
}

fn camera() -> impl Strategy<Value = Camera> {
    (pose(), 0.3_f32..2.0, point(0.3), prop_oneof![Just(Vec3::ZERO), point(1.4)]).prop_map(
        |(pose, fov, shift, tilt)| {
            let rectangle = ViewRectangle::from_vertical_fov(fov).unwrap().with_shift(shift.truncate()).unwrap();
            Camera::new(pose, rectangle.with_tilt(tilt.truncate()).unwrap_or(rectangle)).unwrap()
        },
    )
}

fn objects() -> impl Strategy<Value = Vec<Object>> {
    let object = (shape(), 0.1_f32..1.0)
        .prop_map(|(shape, grey)| Object::new(shape, Material::diffuse(LinearRgb::grey(grey)).expect("a reflectance")));
    prop::collection::vec(object, 1..8)
}

fn scene() -> impl Strategy<Value = Scene> {
    (camera(), objects(), prop::collection::vec((point(8.0), 0.0_f32..50.0), 0..3)).prop_map(
        |(camera, objects, lights)| {
            let light = |(position, i)| PointLight::new(position, LinearRgb::grey(i)).expect("a light");
            let (bottom, top) = (LinearRgb::grey(0.2), LinearRgb::new(0.3, 0.5, 0.9));
            Scene::new(camera, objects)
                .with_lights(lights.into_iter().map(light))
                .with_ambient(LinearRgb::grey(0.1))
                .expect("light")
                .with_background(Background::Gradient { bottom, top })
                .expect("light")
        },
    )
}

fn picture(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Framebuffer {
    render(scene, camera, Resolution::square(width, height), NonZeroU32::MIN)
}

/// Returns f(x) of the lecture in f64, over its gradient's length: the distance to a near surface.
fn distance_to(shape: &Shape, x: DVec3) -> f64 {
    match shape.primitive(0) {
        Primitive::Sphere(sphere) => x.distance(sphere.center().as_dvec3()) - f64::from(sphere.radius()),
        Primitive::Plane(plane) => (x - plane.point().as_dvec3()).dot(plane.normal().as_dvec3()),
        Primitive::Triangle(triangle) => {
            let [a, b, c] = triangle.corners().map(Vec3::as_dvec3);
            (x - a).dot((b - a).cross(c - a).normalize())
        }
        _ => unreachable!("there are no other shapes here"),
    }
}

/// Returns all t > 0 at which the line crosses the shape, in f64, by the lecture's formulas.
fn crossings(shape: &Shape, ray: &Ray) -> Vec<f64> {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let found = match shape.primitive(0) {
        Primitive::Sphere(sphere) => {
            let f = o - sphere.center().as_dvec3();
            let r = f64::from(sphere.radius());
            let root = (f.dot(d) * f.dot(d) - d.dot(d) * (f.dot(f) - r * r)).sqrt();
            vec![(-f.dot(d) - root) / d.dot(d), (-f.dot(d) + root) / d.dot(d)]
        }
        Primitive::Plane(plane) => {
            let n = plane.normal().as_dvec3();
            vec![(plane.point().as_dvec3() - o).dot(n) / d.dot(n)]
        }
        Primitive::Triangle(triangle) => {
            let ([second, third], t) = shares_and_t(triangle, ray);
            if second >= 0.0 && third >= 0.0 && second + third <= 1.0 { vec![t] } else { Vec::new() }
        }
        _ => unreachable!("there are no other shapes here"),
    };
    found.into_iter().filter(|t| t.is_finite() && *t >= 0.0).collect()
}

/// Returns the barycentric coordinates of the second and third corner, and t, by Cramer's rule.
///
/// At the point where the line meets the triangle's plane.
fn shares_and_t(triangle: &Triangle, ray: &Ray) -> ([f64; 2], f64) {
    let [a, b, c] = triangle.corners().map(Vec3::as_dvec3);
    let (to_b, to_c, f, d) = (b - a, c - a, ray.origin.as_dvec3() - a, ray.direction.as_dvec3());
    let determinant = to_b.cross(to_c).dot(-d);
    ([f.cross(to_c).dot(-d) / determinant, to_b.cross(f).dot(-d) / determinant], to_b.cross(to_c).dot(f) / determinant)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn the_basis_is_orthonormal_and_right_handed(pose in pose()) {
        let basis = Camera::new(pose, ViewRectangle::from_vertical_fov(1.0).unwrap()).unwrap().basis();
        let (u, v, w) = (basis.u, basis.v, basis.w);
        for (found, expected) in [(u.dot(u), 1.0), (v.dot(v), 1.0), (w.dot(w), 1.0), (u.dot(v), 0.0), (v.dot(w), 0.0), (w.dot(u), 0.0)] {
            prop_assert!((found - expected).abs() < 1e-6, "{basis:?}");
        }
        prop_assert!(u.cross(v).abs_diff_eq(w, 1e-6), "right-handed");
        prop_assert!((pose.target - pose.eye).dot(-w) > 0.0, "looks at the target");
        prop_assert!(pose.up.dot(v) > 0.0, "up is up");
        prop_assert!(pose.up.dot(u).abs() < 1e-5, "up is vertical in the picture");
    }

    #[test]
    fn a_hit_lies_on_its_surface_and_its_normal_faces_the_ray(shape in shape(), ray in ray()) {
        if let Some(t) = shape.primitive(0).closest_crossing(&Probe::new(ray), Interval::IN_FRONT) {
            let point = shape.primitive(0).at_crossing(&ray, t);
            prop_assume!(point.position.length() < 1e3);
            let scale = 20.0 + f64::from(point.position.length());
            prop_assert!(distance_to(&shape, ray.at(t).as_dvec3()).abs() < 1e-5 * scale, "at t");
            prop_assert!(distance_to(&shape, point.position.as_dvec3()).abs() < f64::from(point.clearance), "{point:?}");
            prop_assert!(point.shading_normal.is_normalized());
            prop_assert!(point.shading_normal.dot(ray.direction) <= 0.0);
            prop_assert_eq!(point.geometric_normal, point.shading_normal, "nothing here is smoothed");
            let outward = distance_to(&shape, (point.position + point.shading_normal * 0.01).as_dvec3()) > 0.0;
            prop_assert_eq!(point.side, if outward { Side::Front } else { Side::Back });
        }
    }

    #[test]
    fn no_closer_hit_exists(objects in objects(), ray in ray()) {
        let camera = Camera::new(Pose { eye: Vec3::ZERO, target: Vec3::X, up: Vec3::Y }, ViewRectangle::from_vertical_fov(1.0).unwrap()).unwrap();
        let scene = Scene::new(camera, objects);
        let all: Vec<f64> = scene.objects().iter().flat_map(|object| crossings(&object.shape, &ray)).collect();
        let closest = all.iter().copied().fold(f64::INFINITY, f64::min);
        let found = closest_hit(&scene, &ray);
        // A grazing ray may hit or miss.
        let grazes = scene.objects().iter().any(|object| match object.shape.primitive(0) {
            Primitive::Sphere(sphere) => {
                let (f, d) = ((ray.origin - sphere.center()).as_dvec3(), ray.direction.as_dvec3());
                let to_line = (f - d * (f.dot(d) / d.dot(d))).length();
                (to_line - f64::from(sphere.radius())).abs() < 1e-4
            }
            Primitive::Plane(plane) => plane.normal().dot(ray.direction.normalize()).abs() < 1e-3,
            Primitive::Triangle(triangle) => {
                let ([second, third], t) = shares_and_t(triangle, &ray);
                let from_edge = second.min(third).min(1.0 - second - third).abs();
                !t.is_finite() || t.abs() > 1e3 || from_edge < 1e-3
            }
            _ => unreachable!("there are no other shapes here"),
        });
        prop_assume!(!grazes && closest > 1e-4 && !(1e3..f64::INFINITY).contains(&closest));
        match found {
            Some(hit) => {
                prop_assert!((f64::from(hit.t) - closest).abs() < 1e-3 * (1.0 + closest), "{hit:?}, f64 says {closest}");
                let own = crossings(&scene.objects()[hit.object as usize].shape, &ray);
                prop_assert!(own.iter().any(|t| (t - f64::from(hit.t)).abs() < 1e-3 * (1.0 + t)), "of that object");
            }
            None => prop_assert!(closest.is_infinite(), "f64 hits at {closest}"),
        }
        prop_assert_eq!(any_hit(&scene, &ray, Interval::IN_FRONT), found.is_some());
        if let Some(hit) = found {
            prop_assert!(!any_hit(&scene, &ray, Interval { min: 0.0, max: hit.t.next_down() }), "nothing before the closest hit");
        }
    }

    /// A ray in a packet gets the same bits as a single one.
    ///
    /// Also along the axes, where some divide by zero, and among objects that lie in one another.
    #[test]
    fn a_packet_has_the_same_bits_as_single_rays(objects in objects(), twice in 0..3_usize, rays in prop::collection::vec(any_ray(), 0..30)) {
        let camera = Camera::new(Pose { eye: Vec3::ZERO, target: Vec3::X, up: Vec3::Y }, ViewRectangle::from_vertical_fov(1.0).unwrap()).unwrap();
        let again = objects.iter().take(twice).cloned().collect();
        let scene = Scene::new(camera, [again, objects].concat());
        let bits = |hit: Option<Hit>| hit.map(|hit| (hit.t.to_bits(), hit.object, hit.primitive));
        let eights: Vec<_> = rays.chunks(LANES).map(EightRays::of).collect();
        let mut hits = Vec::new();
        closest_hits(Kernel::Auto, &scene, &eights, &mut hits);
        for (at, ray) in rays.iter().enumerate() {
            prop_assert_eq!(bits(hits[at / LANES].hit(&scene, at % LANES)), bits(closest_hit(&scene, ray)));
        }
        let mut met = Vec::new();
        for within in [Interval::IN_FRONT, PointLight::BLOCKING_INTERVAL, Interval { min: 0.3, max: 0.9 }] {
            any_hits(Kernel::Auto, &scene, &eights, within, &mut met);
            for (at, ray) in rays.iter().enumerate() {
                prop_assert_eq!(met[at / LANES] >> (at % LANES) & 1 == 1, any_hit(&scene, ray, within));
            }
        }
    }

    #[test]
    fn a_ray_that_leaves_a_sphere_outward_never_hits_it_again(sphere in sphere(), ray in ray(), away in direction()) {
        if let Some(t) = sphere.closest_crossing(&Probe::new(ray), Interval::IN_FRONT) {
            let point = sphere.at_crossing(&ray, t);
            prop_assume!(point.side == Side::Front);
            let direction = if away.dot(point.shading_normal) < 0.0 { -away } else { away };
            prop_assume!(direction.dot(point.shading_normal) > 1e-3);
            let leaving = Ray { origin: point.ray_origin(), direction };
            prop_assert_eq!(sphere.closest_crossing(&Probe::new(leaving), Interval::IN_FRONT), None);
        }
    }

    #[test]
    fn scaling_the_view_rectangle_changes_nothing(pose in pose(), f in 0.1_f32..10.0, w in 0.1_f32..10.0, h in 0.1_f32..10.0, a in 0.01_f32..100.0, k in -8_i32..8) {
        let rays = |a: f32| Camera::new(pose, ViewRectangle::from_focal_length(a * f, a * w, a * h).unwrap()).unwrap().eye_rays(w / h);
        let power_of_two = f32::from_bits(((127 + k) as u32) << 23);
        prop_assert_eq!(rays(1.0), rays(power_of_two), "exactly, by powers of two");
        for (qu, qv) in [(0.0, 0.0), (1.0, 0.3), (0.5, 1.0)] {
            let (one, other) = (rays(1.0).through(qu, qv), rays(a).through(qu, qv));
            prop_assert!(one.direction.abs_diff_eq(other.direction, 1e-5 * one.direction.length()));
        }
    }

    #[test]
    fn a_camera_is_an_error_or_orthonormal(eye in any::<[f32; 3]>(), target in any::<[f32; 3]>(), up in any::<[f32; 3]>(), fov in any::<f32>()) {
        let pose = Pose { eye: Vec3::from(eye), target: Vec3::from(target), up: Vec3::from(up) };
        let rectangle = ViewRectangle::from_vertical_fov(fov);
        prop_assert_eq!(rectangle.is_ok(), fov > 0.0 && fov < std::f32::consts::PI, "{}", fov);
        let camera = Camera::new(pose, ViewRectangle::from_vertical_fov(1.0).unwrap());
        match camera {
            Ok(camera) => prop_assert!(camera.basis().u.is_normalized() && camera.basis().v.is_normalized()),
            Err(CameraError::NotFinite) => prop_assert!(!(pose.eye.is_finite() && pose.target.is_finite() && pose.up.is_finite())),
            Err(_) => {}
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn turning_up_by_180_degrees_turns_the_picture_by_180_degrees(scene in scene()) {
        let pose = scene.camera().pose();
        let straight = scene.camera().with_rectangle(scene.camera().rectangle().with_tilt(Vec2::ZERO).and_then(|r| r.with_shift(Vec2::ZERO)).unwrap());
        let turned = straight.with_pose(Pose { up: -pose.up, ..pose }).unwrap();
        let (a, b) = (picture(&scene, &straight, 24, 16), picture(&scene, &turned, 24, 16));
        let differ = a.pixels().iter().zip(b.pixels().iter().rev()).filter(|(a, b)| (a.g - b.g).abs() > 1e-3 * (1.0 + a.g)).count();
        // A pixel whose ray grazes an edge may fall on its other side.
        prop_assert!(differ <= 4, "{differ} of 384 pixels differ");
    }

    #[test]
    fn scaling_the_world_by_a_power_of_two_leaves_every_bit(scene in scene(), k in -10_i32..=10) {
        let s = f32::from_bits(((127 + k) as u32) << 23);
        let pose = scene.camera().pose();
        let camera = scene.camera().with_pose(Pose { eye: pose.eye * s, target: pose.target * s, up: pose.up }).unwrap();
        let objects = scene.objects().iter().map(|object| Object::new(scaled(&object.shape, s), object.material)).collect();
        let lights = scene.lights().iter().map(|light| {
            let Light::Point(l) = light else { panic!("the scene has only points of light") };
            PointLight::new(l.position() * s, l.intensity() * (s * s)).expect("a light").with_falloff(l.falloff())
        });
        let large = Scene::new(camera, objects).with_ambient(scene.ambient()).expect("light").with_background(scene.background()).expect("light").with_lights(lights);
        prop_assert_eq!(picture(&scene, scene.camera(), 24, 16).hash(), picture(&large, &camera, 24, 16).hash());
    }

    #[test]
    fn the_number_of_threads_does_not_change_the_picture(scene in scene()) {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| picture(&scene, scene.camera(), 50, 37).hash())
        };
        prop_assert_eq!(on(1), on(2));
        prop_assert_eq!(on(1), on(7));
    }

    #[test]
    fn every_pixel_is_a_number(scene in scene()) {
        prop_assert!(picture(&scene, scene.camera(), 40, 30).pixels().iter().all(|pixel| pixel.is_finite()));
    }
}

fn scaled(shape: &Shape, s: f32) -> Shape {
    match shape.primitive(0) {
        Primitive::Sphere(sphere) => Sphere::unchecked(sphere.center() * s, sphere.radius() * s).into(),
        Primitive::Plane(plane) => Plane::unchecked(plane.point() * s, plane.normal()).into(),
        Primitive::Triangle(triangle) => Triangle::unchecked(triangle.corners().map(|corner| corner * s)).into(),
        _ => unreachable!("there are no other shapes here"),
    }
}

/// Random numbers in -1..1, the same in every run: the trials below count rare cases.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        // Knuth's linear congruential generator (MMIX).
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / 8_388_608.0 - 1.0
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::new(self.next(), self.next(), self.next());
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// Of 100,000 lit points of a sphere, at most 10 may seem to be in its own shadow, at any scale.
#[test]
fn surfaces_do_not_shadow_themselves() {
    let mut numbers = Numbers(1);
    for scale in [1e-3_f32, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5] {
        let center = Vec3::new(3.0, 4.0, -1.0) * scale;
        let sphere = Sphere::new(center, scale).expect("a sphere");
        let shadowed = (0..100_000)
            .filter(|_| {
                let origin = center + numbers.direction() * (5.0 * scale);
                let direction = center + numbers.direction() * (0.99 * scale) - origin;
                let ray = Ray { origin, direction };
                let Some(t) = sphere.closest_crossing(&Probe::new(ray), Interval::IN_FRONT) else { return false };
                let point = sphere.at_crossing(&ray, t);
                let lamp = PointLight::new(center + numbers.direction() * (8.0 * scale), LinearRgb::grey(1.0))
                    .expect("a light")
                    .with_falloff(Falloff::None);
                // Lights at a grazing angle are left out: the sphere really shadows those.
                let faces = (lamp.position() - point.position).normalize().dot(point.shading_normal) > 1e-3;
                faces
                    && sphere
                        .closest_crossing(&Probe::new(shadow_ray(&lamp.into(), &point)), PointLight::BLOCKING_INTERVAL)
                        .is_some()
            })
            .count();
        assert!(shadowed <= 10, "{shadowed} false shadows of 100,000 at scale {scale}");
    }
}

/// Of the lit points of a plane of any direction, at most 10 may seem to be in its own shadow.
#[test]
fn planes_do_not_shadow_themselves() {
    let mut numbers = Numbers(2);
    for scale in [1e-3_f32, 1.0, 1e3, 1e5] {
        let shadowed = (0..20_000)
            .filter(|_| {
                let plane = Plane::new(numbers.direction() * (3.0 * scale), numbers.direction()).expect("a plane");
                let origin = numbers.direction() * (5.0 * scale);
                let ray = Ray { origin, direction: numbers.direction() };
                let Some(t) = plane.closest_crossing(&Probe::new(ray), Interval::IN_FRONT) else { return false };
                let point = plane.at_crossing(&ray, t);
                let lamp = PointLight::new(numbers.direction() * (8.0 * scale), LinearRgb::grey(1.0))
                    .expect("a light")
                    .with_falloff(Falloff::None);
                let height = (lamp.position() - point.position).dot(point.shading_normal);
                height > 1e-3 * scale
                    && plane
                        .closest_crossing(&Probe::new(shadow_ray(&lamp.into(), &point)), PointLight::BLOCKING_INTERVAL)
                        .is_some()
            })
            .count();
        assert_eq!(shadowed, 0, "false shadows of 20,000 at scale {scale}");
    }
}

/// Against f64: no wrong hit or miss at 200 radii, and crossings within 5e-5 radii.
#[test]
fn far_spheres_are_hit_where_they_are() {
    let mut numbers = Numbers(3);
    for (distance, limit) in [(2.0_f32, 1e-6), (20.0, 1e-5), (200.0, 5e-5)] {
        for _ in 0..100_000 {
            let sphere = Sphere::new(numbers.direction() * 3.0, 1.0).expect("a sphere");
            let origin = sphere.center() + numbers.direction() * distance;
            let aim = sphere.center() + numbers.direction() * (1.2 * numbers.next());
            let ray = Ray { origin, direction: (aim - origin).normalize() };
            let found = sphere.closest_crossing(&Probe::new(ray), Interval::IN_FRONT);
            let (f, d) = (ray.origin.as_dvec3() - sphere.center().as_dvec3(), ray.direction.as_dvec3());
            let to_line = (f - d * (f.dot(d) / d.dot(d))).length();
            // Closer to the edge than the resolution of f32 either answer is right.
            if (to_line - 1.0).abs() < 2e-7 * f64::from(distance) {
                continue;
            }
            let expected = crossings(&sphere.into(), &ray).first().copied();
            assert_eq!(found.is_some(), expected.is_some(), "at {distance} radii, {to_line} from the middle: {ray:?}");
            if let (Some(found), Some(expected)) = (found, expected) {
                // Near the edge t itself is ill-conditioned: the distance to the surface is what must be small.
                let off = distance_to(&sphere.into(), ray.origin.as_dvec3() + d * f64::from(found)).abs();
                let error = (f64::from(found) - expected).abs().min(off);
                assert!(error < limit, "{error:e} radii off at {distance} radii: {ray:?}");
            }
        }
    }
}
