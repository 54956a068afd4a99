//! Disks, boxes, cylinders, cones, tori, quads, ellipsoids and capsules.
//!
//! Each is compared with a function that is negative inside and positive outside (or on different sides of a flat
//! shape), written here in f64 from the shape's definition.

use glam::{DVec2, DVec3, Vec3};
use termtrace::internals::hit::{Kernel, any_hit, closest_hit, closest_hits};
use termtrace::internals::ray::{EightRays, Interval, Ray};
use termtrace::internals::shape::{Side, Surface, SurfacePoint};
use termtrace::{Render, Resolution, Sampling, Scene};

/// A shape, and the function that defines it.
struct Defined {
    object: &'static str,
    /// The function; its gradient has about unit length at the surface.
    f: fn(DVec3) -> f64,
    /// Whether the surface, where the function is 0, is part of the shape.
    is_part: fn(DVec3) -> bool,
    /// Whether the shape is convex and closed.
    is_convex: bool,
}

/// Returns height and distance from the axis of a point about the y axis.
fn cylindrical(p: DVec3) -> DVec2 {
    DVec2::new(p.y, libm::hypot(p.x, p.z))
}

const fn always(_: DVec3) -> bool {
    true
}

/// A unit vector of a scene file: (2, 3, 6) / 7.
const TILTED: DVec3 = DVec3::new(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0);

/// Returns height over the middle of, and distance from, a tilted axis through a point.
fn tilted(p: DVec3, middle: DVec3) -> DVec2 {
    let along = (p - middle).dot(TILTED);
    DVec2::new(along, (p - middle - TILTED * along).length())
}

static SHAPES: [Defined; 14] = [
    Defined {
        object: "Box(min: (-1, -0.5, -0.25), max: (0.5, 1, 0.75))",
        f: |p| {
            let outside = (p - DVec3::new(-0.25, 0.25, 0.25)).abs() - DVec3::new(0.75, 0.75, 0.5);
            outside.max_element()
        },
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Disk(center: (0.25, 0, -0.5), normal: (2, 3, 6), radius: 1.25)",
        f: |p| tilted(p, DVec3::new(0.25, 0.0, -0.5)).x,
        is_part: |p| tilted(p, DVec3::new(0.25, 0.0, -0.5)).y < 1.25,
        is_convex: false,
    },
    Defined {
        object: "Quad(corner: (-1, -0.5, 0), edges: [(2, 0, 0), (0.5, 1, 0)])",
        f: |p| p.z,
        is_part: |p| {
            let up = p.y + 0.5;
            (0.0..1.0).contains(&up) && (0.0..2.0).contains(&(p.x + 1.0 - 0.5 * up))
        },
        is_convex: false,
    },
    Defined {
        object: "Cylinder(from: (0, -0.5, 0), to: (0, 1, 0), radius: 0.75)",
        f: |p| {
            let at = cylindrical(p);
            (at.y - 0.75).max((at.x - 0.25).abs() - 0.75)
        },
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Cylinder(from: (-2, -3, -6), to: (2, 3, 6), radius: 0.5)",
        f: |p| {
            let at = tilted(p, DVec3::ZERO);
            (at.y - 0.5).max(at.x.abs() - 7.0)
        },
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Cylinder(from: (0, -0.5, 0), to: (0, 1, 0), radius: 0.75, open: true)",
        f: |p| cylindrical(p).y - 0.75,
        is_part: |p| (-0.5..1.0).contains(&p.y),
        is_convex: false,
    },
    Defined {
        object: "Cone(from: (0, -1, 0), to: (0, 1, 0), radius: 1)",
        f: |p| {
            let at = cylindrical(p);
            ((at.y - 0.5 * (1.0 - at.x)) / 1.25_f64.sqrt()).max(-1.0 - at.x)
        },
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Cone(from: (0, 1, 0), to: (0, -0.5, 0), radius: 0.25, to_radius: 1)",
        f: |p| {
            let at = cylindrical(p);
            ((at.y - 0.25 - 0.5 * (1.0 - at.x)) / 1.25_f64.sqrt()).max((at.x - 0.25).abs() - 0.75)
        },
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Cone(from: (0, -1, 0), to: (0, 1, 0), radius: 1, open: true)",
        f: |p| (cylindrical(p).y - 0.5 * (1.0 - p.y)) / 1.25_f64.sqrt(),
        is_part: |p| (-1.0..1.0).contains(&p.y),
        is_convex: false,
    },
    Defined {
        object: "Capsule(from: (-0.4, -0.6, -1.2), to: (0.4, 0.6, 1.2), radius: 0.5)",
        f: |p| (p - TILTED * p.dot(TILTED).clamp(-1.4, 1.4)).length() - 0.5,
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Ellipsoid(center: (0.1, 0.2, 0), radii: (1.5, 0.5, 0.75))",
        f: |p| {
            let scaled = (p - DVec3::new(0.1, 0.2, 0.0)) / DVec3::new(1.5, 0.5, 0.75);
            let gradient = scaled / DVec3::new(1.5, 0.5, 0.75);
            0.5 * (scaled.length_squared() - 1.0) / gradient.length()
        },
        is_part: always,
        is_convex: true,
    },
    Defined {
        object: "Torus(center: (0, 0.1, 0), axis: (2, 3, 6), radius: 1, tube_radius: 0.375)",
        f: |p| {
            let at = tilted(p, DVec3::new(0.0, 0.1, 0.0));
            libm::hypot(at.y - 1.0, at.x) - 0.375
        },
        is_part: always,
        is_convex: false,
    },
    Defined {
        object: "Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: 1.5, tube_radius: 0.015625)",
        f: |p| {
            let at = cylindrical(p);
            libm::hypot(at.y - 1.5, at.x) - 0.015_625
        },
        is_part: always,
        is_convex: false,
    },
    Defined {
        object: "Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: 0.5, tube_radius: 0.75)",
        f: |p| {
            let at = cylindrical(p);
            libm::hypot(at.y - 0.5, at.x) - 0.75
        },
        is_part: always,
        is_convex: false,
    },
];

/// A shape as it is defined, or placed at random.
struct Case {
    object: String,
    /// Factors, angles in degrees and a translation.
    placement: Option<[DVec3; 3]>,
    defined: &'static Defined,
}

impl Case {
    fn new(defined: &'static Defined, placement: Option<[DVec3; 3]>) -> Self {
        let object = match placement.map(|placement| placement.map(|DVec3 { x, y, z }| format!("({x}, {y}, {z})"))) {
            None => defined.object.to_owned(),
            Some([scale, rotate, translate]) => {
                let shape = &defined.object[..defined.object.len() - 1];
                format!("{shape}, scale: {scale}, rotate: {rotate}, translate: {translate})")
            }
        };
        Self { object, placement, defined }
    }

    /// Maps a point back to the coordinates of the shape, from the definition of a placement.
    fn shape_point(&self, point: DVec3) -> DVec3 {
        let Some([scale, degrees, translation]) = self.placement else { return point };
        let mut point = point - translation;
        for axis in [2, 1, 0] {
            let (sin, cos) = libm::sincos(-degrees[axis].to_radians());
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            (point[u], point[v]) = (point[u] * cos - point[v] * sin, point[u] * sin + point[v] * cos);
        }
        point / scale
    }

    /// Returns the function that defines the shape.
    fn f(&self, point: DVec3) -> f64 {
        (self.defined.f)(self.shape_point(point))
    }

    fn is_part(&self, point: DVec3) -> bool {
        (self.defined.is_part)(self.shape_point(point))
    }

    /// Returns the most by which f changes per unit of distance.
    fn steepness(&self) -> f64 {
        self.placement.map_or(1.0, |[scale, ..]| 1.0 / scale.abs().min_element())
    }
}

/// Returns all shapes, each as it is, and twice at a random place; some are mirrored.
fn cases() -> Vec<Case> {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut placement = || {
        let factor = random.vector().as_dvec3();
        let scale = factor + factor.map(|factor| 0.5_f64.copysign(factor));
        Some([scale, random.vector().as_dvec3() * 180.0, random.vector().as_dvec3() * 0.5])
    };
    let placements = SHAPES.iter().map(|_| [None, placement(), placement()]).collect::<Vec<_>>();
    let each = SHAPES.iter().zip(placements);
    each.flat_map(|(defined, placements)| placements.map(|placement| Case::new(defined, placement))).collect()
}

fn scene(objects: &str) -> Scene {
    let text = format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{objects}])");
    Scene::from_ron("x.ron", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
    Ray { origin: origin.into(), direction: direction.into() }
}

/// Returns the t of the closest hit.
fn t_of(scene: &Scene, origin: [f32; 3], direction: [f32; 3]) -> Option<f32> {
    closest_hit(scene, &ray(origin, direction)).map(|hit| hit.t)
}

fn point(scene: &Scene, ray: &Ray, t: f32) -> SurfacePoint {
    scene.objects()[0].shape.primitive(0).at_crossing(ray, t)
}

/// A generator of numbers that is good enough for test cases (Marsaglia's xorshift).
pub(super) struct Random(pub(super) u64);

impl Random {
    /// Returns a number from -1 to 1.
    pub(super) fn number(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    pub(super) fn vector(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }
}

/// Returns rays towards and past the origin, from outside and from inside shapes of size 1.
fn rays(count: usize) -> Vec<Ray> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut ray = |at: usize| {
        let far = [3.0, 0.4, 8.0][at % 3];
        let origin = random.vector() * far;
        let mut direction = random.vector() * 1.4 - origin;
        // Some rays are parallel to an axis or a plane of axes.
        (0..3).filter(|axis| (at / 3) >> axis & 7 == 1).for_each(|axis| direction[axis] = 0.0);
        Ray { origin, direction: if direction == Vec3::ZERO { Vec3::X } else { direction } }
    };
    (0..count).map(&mut ray).collect()
}

/// The first change of sign among samples of f is never before the hit, and is always hit.
#[test]
fn no_nearer_root_is_found_by_dense_sampling() {
    const SAMPLES: usize = 800;
    for case in cases() {
        let object = &case.object;
        let (f, is_part) = (|point| case.f(point), |point| case.is_part(point));
        let (scene, mut hits) = (scene(object), 0);
        for ray in rays(1500) {
            let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
            let found = closest_hit(&scene, &ray).map(|hit| f64::from(hit.t));
            let at = |sample: usize| 4.0 * sample as f64 / SAMPLES as f64;
            let is_inside = |t: f64| f(o + d * t) < 0.0;
            let crossed = (1..=SAMPLES).find(|&sample| {
                let (before, after) = (at(sample - 1), at(sample));
                is_inside(before) != is_inside(after) && is_part(o + d * (0.5 * (before + after)))
            });
            if let Some(crossed) = crossed {
                let Some(t) = found else {
                    // The middle of the samples may be part of the shape where the crossing is not.
                    let at_edge = [at(crossed - 1), at(crossed)].iter().any(|&t| !is_part(o + d * t));
                    assert!(at_edge, "{object}: {ray:?} crosses before {}", at(crossed));
                    continue;
                };
                assert!(t <= at(crossed) * (1.0 + 1e-6), "{object}: {ray:?} hits at {t}, not {}", at(crossed));
            }
            let Some(t) = found else { continue };
            hits += 1;
            let off = f(o + d * t).abs() / d.length();
            assert!(
                off <= 3e-7 * t.max(1.0) * case.steepness(),
                "{object}: {ray:?} hits at {t}, {off} off the surface"
            );
            let point = point(&scene, &ray, t as f32);
            let off = f(point.position.as_dvec3()).abs();
            assert!(
                off <= 1.5e-7 * case.steepness() * f64::from(point.position.abs().max_element().max(1.0)),
                "{object}: {point:?} is {off} off"
            );
        }
        assert!(hits > 10, "{object}: {hits} hits");
    }
}

#[test]
fn normals_are_gradients() {
    for case in cases() {
        let (object, f) = (&case.object, |point| case.f(point));
        let (scene, mut compared, mut hits) = (scene(object), 0, 0);
        for ray in rays(1500) {
            let Some(hit) = closest_hit(&scene, &ray) else { continue };
            hits += 1;
            let point = point(&scene, &ray, hit.t);
            let at = point.position.as_dvec3();
            let gradient = |h: f64| {
                let along = |axis: DVec3| (f(at + axis * h) - f(at - axis * h)) / (2.0 * h);
                DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)).normalize()
            };
            let gradients = [4e-4, 1e-4, 2.5e-5].map(gradient);
            // At an edge, differences of different lengths are different.
            if gradients[0].distance(gradients[1]) > 1e-3 || gradients[1].distance(gradients[2]) > 1e-3 {
                continue;
            }
            compared += 1;
            let outward = point.geometric_normal * if point.side == Side::Front { 1.0 } else { -1.0 };
            let off = outward.as_dvec3().distance(gradients[2]);
            assert!(off < 1e-4, "{object}: {point:?} has the gradient {}", gradients[2]);
            assert!(point.geometric_normal.dot(ray.direction) <= 0.0, "{object}: {point:?} faces the ray");
        }
        assert!(compared * 10 > hits * 9, "{object}: {compared} of {hits} normals were compared");
    }
}

/// A ray that leaves a convex solid outward never hits it again, at any scale and distance.
#[test]
fn no_shape_shadows_itself() {
    let mut random = Random(42);
    for Case { object, .. } in cases().iter().filter(|case| case.defined.is_convex) {
        let scene = scene(object);
        for ray in rays(1500) {
            let Some(hit) = closest_hit(&scene, &ray) else { continue };
            let point = point(&scene, &ray, hit.t);
            if point.side == Side::Back {
                continue;
            }
            let any = random.vector();
            let direction = any - point.geometric_normal * (any.dot(point.geometric_normal) - 1e-3);
            let away = Ray { origin: point.ray_origin(), direction };
            assert!(!any_hit(&scene, &away, Interval::IN_FRONT), "{object}: {point:?} is hidden from {direction}");
        }
    }
}

#[test]
fn all_kernels_see_the_same() {
    let all: Vec<_> = cases().into_iter().map(|case| case.object).collect();
    let one_each = all.join(", ");
    let many = (0..4).map(|_| one_each.as_str()).collect::<Vec<_>>().join(", ");
    for scene in [scene(&one_each), scene(&many), scene(&format!("{one_each}, Sphere(center: (1, 1, 1), radius: 0.5)"))]
    {
        let groups: Vec<_> = rays(640).chunks(8).map(EightRays::of).collect();
        let hits = |kernel| {
            let mut hits = Vec::new();
            closest_hits(kernel, &scene, &groups, &mut hits);
            hits.iter().flat_map(|eight| (0..8).map(|lane| eight.hit(&scene, lane))).collect::<Vec<_>>()
        };
        let single = hits(Kernel::Single);
        assert!(single.iter().flatten().count() > 400, "rays hit");
        for kernel in [Kernel::Packet, Kernel::Scalar, Kernel::Auto] {
            assert_eq!(hits(kernel), single);
        }
    }
}

/// Seen from its axis, a ring has two outlines: tangents of the circle that its tube is cut in.
#[test]
fn the_outlines_of_a_torus_are_tangents_of_its_tube() {
    let ring = scene("Torus(center: (0, 0, 0), axis: (0, 0, 1), radius: 2, tube_radius: 0.5)");
    let (distance, half) = (20.0_f64.sqrt(), libm::asin(0.5 / 20.0_f64.sqrt()));
    let middle = libm::asin(2.0 / distance);
    for turn in 0..40 {
        let (sin, cos) = libm::sincos(f64::from(turn) * 0.1571);
        let is_hit = |angle: f64| {
            let side = libm::tan(angle);
            t_of(&ring, [0.0, 0.0, 4.0], [(side * cos) as f32, (side * sin) as f32, -1.0]).is_some()
        };
        for (outline, inward) in [(middle - half, 1.0), (middle + half, -1.0)] {
            assert!(is_hit(outline + inward * 1e-6), "turn {turn}");
            assert!(!is_hit(outline - inward * 1e-6), "turn {turn}");
        }
    }
}

/// The shadow of a cone ends in the projected tip, and its sides are tangents of the base.
#[test]
fn the_shadow_of_a_cone_has_straight_edges() {
    let cone = scene("Cone(from: (0, 0, 0), to: (0, 2, 0), radius: 1)");
    let lamp = Vec3::new(-4.0, 4.0, 0.0);
    let is_dark = |x: f64, z: f64| {
        let floor = Vec3::new(x as f32, -1e-4, z as f32);
        any_hit(&cone, &Ray { origin: floor, direction: lamp - floor }, Interval { min: 0.0, max: 1.0 })
    };
    // Twice as high as the tip, the lamp throws its shadow as far to the other side: to x = 4, and 2e-4 farther for a
    // floor that is 1e-4 lower.
    let tip = 4.0 + 2e-4;
    assert!(is_dark(tip - 1e-3, 0.0) && !is_dark(tip + 1e-3, 0.0));
    let sine = 1.0 / 4.0;
    let slope = sine / (1.0_f64 - sine * sine).sqrt();
    for x in [1.0, 2.0, 3.0, 3.9] {
        let edge = (4.0 - x) * slope;
        for side in [-1.0, 1.0] {
            assert!(is_dark(x, side * (edge - 2e-4)) && !is_dark(x, side * (edge + 2e-4)), "{x} {side}");
        }
    }
}

#[test]
fn the_tip_of_a_cone_is_closed() {
    for (cone, tip, inward) in [
        ("Cone(from: (0, 0, 0), to: (0, 2, 0), radius: 1)", Vec3::Y * 2.0, Vec3::NEG_Y),
        ("Cone(from: (2, 3, 6), to: (0, 0, 0), radius: 3)", Vec3::ZERO, Vec3::new(2.0, 3.0, 6.0)),
    ] {
        let cone = scene(cone);
        for ray in rays(300) {
            // Rays into the tip at any angle that is steeper than the side.
            let direction = inward.normalize() + ray.direction.normalize() * 0.3;
            let into = Ray { origin: tip - direction * 3.0, direction };
            let hit = closest_hit(&cone, &into).expect("the tip is hit");
            assert!((hit.t - 3.0).abs() < 1e-5, "{into:?} {hit:?}");
        }
    }
}

/// Rays along axes and in the planes of faces.
#[test]
fn special_rays_are_decided_as_defined() {
    let of = |object: &str, origin: [f32; 3], direction: [f32; 3]| t_of(&scene(object), origin, direction);
    let disk = "Disk(center: (0, 0, 0), normal: (0, 1, 0), radius: 1)";
    assert_eq!(of(disk, [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), None, "a disk shows its edge");
    assert_eq!(of(disk, [1.0, 2.0, 0.0], [0.0, -1.0, 0.0]), Some(2.0), "its rim is part of it");
    assert_eq!(of(disk, [1.0001, 2.0, 0.0], [0.0, -1.0, 0.0]), None);
    let cube = "Box(min: (-1, -1, -1), max: (1, 1, 1))";
    assert_eq!(of(cube, [0.0, 1.0, 3.0], [0.0, 0.0, -1.0]), Some(2.0), "in the plane of its top");
    assert_eq!(of(cube, [0.0, 1.0 + 1e-6, 3.0], [0.0, 0.0, -1.0]), None);
    assert_eq!(of(cube, [0.0, 0.0, 0.0], [0.0, 0.0, -1.0]), Some(1.0), "from inside");
    assert_eq!(of(cube, [3.0, 3.0, 0.0], [-1.0, -1.0, 0.0]), Some(2.0), "at an edge");
    let cylinder = "Cylinder(from: (0, 0, 0), to: (0, 2, 0), radius: 1)";
    assert_eq!(of(cylinder, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]), Some(3.0), "along its axis");
    assert_eq!(of(cylinder, [1.0, 5.0, 0.0], [0.0, -1.0, 0.0]), Some(3.0), "along its side");
    let open = "Cylinder(from: (0, 0, 0), to: (0, 2, 0), radius: 1, open: true)";
    assert_eq!(of(open, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]), None, "through an open one");
    assert_eq!(of(open, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), Some(1.0));
    let torus = |radius: f32, tube: f32| {
        format!("Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: {radius}, tube_radius: {tube})")
    };
    assert_eq!(of(&torus(1.0, 0.5), [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]), None, "through its hole");
    assert_eq!(of(&torus(1.0, 0.5), [1.0, 5.0, 0.0], [0.0, -1.0, 0.0]), Some(4.5));
    assert_eq!(of(&torus(1.0, 0.5), [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Some(3.5));
    assert_eq!(of(&torus(1.0, 0.5), [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Some(0.5), "from the middle of its hole");
    assert_eq!(of(&torus(3.0, 5.0), [0.0, 9.0, 0.0], [0.0, -1.0, 0.0]), Some(5.0), "3^2 + 4^2 = 5^2");
    assert_eq!(of(&torus(3.0, 5.0), [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]), Some(4.0), "no wall is inside");
}

/// A placed shape is the shape that its definition, mapped by hand, gives.
#[test]
fn a_placement_is_that_of_the_equivalent_shape() {
    const BALL: &str = "bounds: Sphere(center: (0, 0, 0), radius: 1.1)";
    let pairs = [
        (
            "Sphere(center: (0.5, 0, 0), radius: 0.5, scale: -2, rotate: (0, 0, 90), translate: (0, 0.25, 0))"
                .to_owned(),
            "Sphere(center: (0, -0.75, 0), radius: 1)",
        ),
        (
            "Sphere(center: (0, 0, 0), radius: 1, scale: (1.5, 0.5, 0.75), translate: (0.1, 0.2, 0))".to_owned(),
            "Ellipsoid(center: (0.1, 0.2, 0), radii: (1.5, 0.5, 0.75))",
        ),
        (
            format!(
                "Implicit(f: \"r - 1\", {BALL}, scale: (0.5, 1.5, 0.75), rotate: (0, 0, 90), translate: (0.1, 0.2, 0))"
            ),
            "Ellipsoid(center: (0.1, 0.2, 0), radii: (1.5, 0.5, 0.75))",
        ),
        (
            "Plane(point: (0, 0, 0), normal: (0, 1, 0), rotate: (0, 0, 90), translate: (0.5, 0, 0))".to_owned(),
            "Plane(point: (0.5, 3, 4), normal: (-1, 0, 0))",
        ),
        (
            "Plane(point: (1, 0, 0), normal: (1, 1, 0), scale: (1, 2, 1))".to_owned(),
            "Plane(point: (1, 0, 0), normal: (2, 1, 0))",
        ),
        (
            "Triangle(corners: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], scale: (2, 2, -1), rotate: (0, 90, 0))".to_owned(),
            "Triangle(corners: [(0, 0, 0), (0, 2, 0), (0, 0, -2)])",
        ),
        (
            "Box(min: (-1, -1, -1), max: (1, 1, 1), scale: (0.5, 1, 0.25), rotate: (0, 0, 90))".to_owned(),
            "Box(min: (-1, -0.5, -0.25), max: (1, 0.5, 0.25))",
        ),
        (
            "Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: 1, tube_radius: 0.25, rotate: (90, 0, 0))".to_owned(),
            "Torus(center: (0, 0, 0), axis: (0, 0, 1), radius: 1, tube_radius: 0.25)",
        ),
    ];
    for (placed, plain) in &pairs {
        let (scenes, mut hits) = ([scene(placed), scene(plain)], 0);
        for ray in rays(1500) {
            let [one, other] = scenes.each_ref().map(|scene| closest_hit(scene, &ray).map(|hit| hit.t));
            // A ray that grazes an edge may hit only one of both.
            let (Some(one), Some(other)) = (one, other) else { continue };
            hits += 1;
            assert!((one - other).abs() <= 2e-5 * one.max(1.0), "{plain:?}: {ray:?} hits at {one} and {other}");
            let [one, other] = [(0, one), (1, other)].map(|(at, t): (usize, f32)| point(&scenes[at], &ray, t));
            assert_eq!(one.side, other.side, "{plain:?}: {ray:?}");
            assert!(one.geometric_normal.dot(other.geometric_normal) > 0.999, "{plain:?}: {one:?} {other:?}");
        }
        assert!(hits > 100, "{plain:?}: {hits} hits");
        let [one, other] = scenes.each_ref().map(|scene| scene.objects()[0].shape.bounds());
        // The bounds of a formula are those that its author states.
        if let (Some(one), Some(other), false) = (one, other, placed.contains("Implicit")) {
            let off = (one.min - other.min).abs().max((one.max - other.max).abs()).max_element();
            assert!(off <= 2e-7, "{one:?} {other:?}");
        }
    }
}

/// Parallel rays see a scaled and rotated ball as an ellipse with known half axes.
#[test]
fn the_outline_of_a_scaled_sphere_is_an_ellipse() {
    let ball = scene(
        "Sphere(center: (0, 0, 0), radius: 1, scale: (1.5, 0.5, 3), rotate: (0, 0, 30), translate: (0.25, 0, 0))",
    );
    let (sin, cos) = libm::sincos(30_f64.to_radians());
    for turn in 0..60 {
        let (v, u) = libm::sincos(f64::from(turn) * 0.1047);
        let edge = [1.5 * u * cos - 0.5 * v * sin, 1.5 * u * sin + 0.5 * v * cos];
        let is_hit = |share: f64| {
            let [x, y] = edge.map(|edge| (share * edge) as f32);
            t_of(&ball, [0.25 + x, y, 9.0], [0.0, 0.0, -1.0]).is_some()
        };
        assert!(is_hit(1.0 - 1e-6) && !is_hit(1.0 + 1e-6), "turn {turn}");
    }
}

/// The squares of a checker are scaled, rotated and moved with a plane, a box, a disk and a quad.
#[test]
fn patterns_are_placed_with_their_shapes() {
    for shape in [
        "Plane(point: (1, 0, 2), normal: (0, 1, 0)",
        "Disk(center: (0.5, 0, 0), normal: (0, 1, 0), radius: 2",
        "Quad(corner: (-1, 0, -1), edges: [(2, 0, 0), (0, 0, 2)]",
        "Box(min: (-1, -1, -1), max: (1, 0, 1)",
    ] {
        let [plain, placed] = [format!("{shape})"), format!("{shape}, scale: (2, 0.5, 4), translate: (0, 0.25, 0))")]
            .map(|object| scene(&object));
        let mut random = Random(7);
        for _ in 0..200 {
            let (x, z) = (random.number() * 0.9, random.number() * 0.9);
            let down = |x: f32, z: f32| ray([x, 3.0, z], [0.0, -1.0, 0.0]);
            let uv = |scene: &Scene, ray: Ray| {
                let t = closest_hit(scene, &ray).expect("the ray meets the shape").t;
                point(scene, &ray, t).uv
            };
            let off = uv(&plain, down(x, z)) - uv(&placed, down(2.0 * x, 4.0 * z));
            assert!(off.length() < 1e-6, "{shape} at {x} {z}: {off}");
        }
    }
}

/// A wall of quads has no gap between them.
///
/// The common edges are numbers of f32, so that rays go exactly to them.
#[test]
fn neighbouring_quads_leave_no_gap() {
    let quads = [[-0.7, -0.7], [0.125, -0.7], [-0.7, 0.25], [0.125, 0.25]].map(|[x, y]: [f64; 2]| {
        let [wide, high] = [if x < 0.0 { 0.825 } else { 0.6 }, if y < 0.0 { 0.95 } else { 0.4 }];
        format!("Quad(corner: ({x}, {y}, 0), edges: [({wide}, 0, 0), (0, {high}, 0)])")
    });
    let wall = scene(&quads.join(", "));
    for step in 0..1000 {
        let along = step as f32 * 0.0013 - 0.65;
        for target in [Vec3::new(along, 0.25, 0.0), Vec3::new(0.125, along, 0.0)] {
            for eye in [Vec3::new(0.3, 0.2, 2.0), Vec3::new(target.x, target.y, 1.0)] {
                assert!(closest_hit(&wall, &Ray { origin: eye, direction: target - eye }).is_some(), "{target} {eye}");
            }
        }
    }
}

#[test]
fn checkers_follow_flat_faces() {
    let colors = |object: &str, eye: &str, up: &str| {
        let text = format!(
            "(camera: (eye: {eye}, target: (0, 0, 0), up: {up}, vertical_fov: 20), ambient: 1,
            objects: [{object}])"
        );
        let scene = Scene::from_ron("x.ron", &text).unwrap_or_else(|error| panic!("{error}"));
        let light =
            Render::new(&scene).resolution(Resolution::new(40, 40).unwrap()).sampling(Sampling::BEST).run().unwrap();
        [[25, 25], [15, 25], [25, 15], [15, 15]].map(|[x, y]| light.pixel(x, y).g > 0.3)
    };
    let checker = "material: Checker(a: 0.5, b: 0.1, size: 1)";
    for object in [
        format!("Box(min: (-2, -2, -2), max: (2, 2, 2), {checker})"),
        format!("Disk(center: (0, 0, 2), normal: (0, 0, 1), radius: 2, {checker})"),
        format!("Quad(corner: (-2, -2, 2), edges: [(4, 0, 0), (0, 4, 0)], {checker})"),
    ] {
        let [a, b, c, d] = colors(&object, "(0, 0, 9)", "(0, 1, 0)");
        assert!(a == d && b == c && a != b, "{object}: {:?}", [a, b, c, d]);
    }
    for eye in ["(9, 0, 0)", "(0, 9, 0)", "(0, 0, -9)", "(-9, 0, 0)", "(0, -9, 0)"] {
        let up = if eye.contains(", 0)") && !eye.contains("(0, ") { "(0, 1, 0)" } else { "(1, 0, 0)" };
        let [a, b, c, d] = colors(&format!("Box(min: (-2, -2, -2), max: (2, 2, 2), {checker})"), eye, up);
        assert!(a == d && b == c && a != b, "{eye}: {:?}", [a, b, c, d]);
    }
}

#[test]
fn shapes_are_described_and_explained() {
    let described = |object: &str| scene(object).objects()[0].shape.described("red");
    let texts = SHAPES.iter().map(|shape| described(shape.object)).collect::<Vec<_>>();
    assert_eq!(
        texts,
        [
            "a red box, 1.5 wide, 1.5 high, 1 deep",
            "a red disk of radius 1.25",
            "a red quad with edges of 2 and 1.12",
            "a red cylinder of radius 0.75 and length 1.5",
            "a red cylinder of radius 0.5 and length 14",
            "a red open cylinder of radius 0.75 and length 1.5",
            "a red cone of radius 1 and length 2",
            "a red cone of radii 0.25 to 1 and length 1.5",
            "a red open cone of radius 1 and length 2",
            "a red capsule of radius 0.5 and length 3.8",
            "a red ellipsoid, 3 wide, 1 high, 1.5 deep",
            "a red torus of radius 1 with a tube of radius 0.38",
            "a red torus of radius 1.5 with a tube of radius 0.016",
            "a red torus of radius 0.5 with a tube of radius 0.75",
        ]
    );
    for Defined { object, f, .. } in &SHAPES {
        let (scene, mut count) = (scene(object), 0);
        let shape = &scene.objects()[0].shape;
        for ray in rays(300) {
            let hit = closest_hit(&scene, &ray);
            let equation = shape.primitive(0).equation(&ray);
            let root = equation.roots.iter().find(|&&root| root >= 0.0).filter(|_| !equation.is_outside);
            assert_eq!(hit.map(|hit| hit.t), root.map(|&root| root as f32), "{object}: {equation:?}");
            count += usize::from(hit.is_some());
            let at = ray.origin.as_dvec3();
            let is_solid = !object.contains("open") && !["Disk", "Quad"].iter().any(|flat| object.starts_with(flat));
            assert_eq!(shape.encloses(ray.origin), is_solid && f(at) < 0.0, "{object}: {at}");
        }
        assert!(count > 2, "{object}: {count} hits");
    }
}
