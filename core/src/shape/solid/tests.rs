use super::closed_mesh::ClosedMesh;
use super::*;
use crate::mesh_file::MeshFile;
use crate::scene::Scene;
use crate::shape::{Cuboid, Sphere};
use glam::DVec3;
use proptest::prelude::*;
use std::array::from_fn;

fn solid(text: &str) -> Shape {
    let scene = format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{text}])");
    let scene = Scene::from_ron("solid.ron", &scene).unwrap_or_else(|error| panic!("{error}"));
    scene.objects()[0].shape.clone()
}

fn crossings(shape: &Shape, origin: [f32; 3], direction: [f32; 3]) -> Vec<f32> {
    let ray = Ray { origin: origin.into(), direction: direction.into() };
    let Shape::Solid(solid) = shape else { panic!("a solid") };
    solid.boundaries_of_ray(&ray, ALL).iter().map(|boundary| boundary.t as f32).collect()
}

/// All of a ray.
const ALL: [f32; 2] = [0.0, f32::MAX];

const FROM_LEFT: ([f32; 3], [f32; 3]) = ([-5.0, 0.25, 0.0], [1.0, 0.0, 0.0]);

#[test]
fn a_box_with_a_hole_is_crossed_four_times() {
    let holed = solid(
        "Solid(difference: [Box(min: (-2, -2, -2), max: (2, 2, 2)), Cylinder(from: (0, 0, -3), to: (0, 0, 3), \
            radius: 1)])",
    );
    let half = (1.0_f32 - 0.0625).sqrt();
    let found = crossings(&holed, FROM_LEFT.0, FROM_LEFT.1);
    let expected = [3.0, 5.0 - half, 5.0 + half, 7.0];
    assert!(found.len() == 4 && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?}");
}

#[test]
fn a_union_has_no_surfaces_inside() {
    let pair = solid(
        "Solid(union: [Sphere(center: (-0.5, 0.25, 0), radius: 1), Sphere(center: (0.5, 0.25, 0), \
            radius: 1)])",
    );
    assert_eq!(crossings(&pair, FROM_LEFT.0, FROM_LEFT.1), [3.5, 6.5]);
}

#[test]
fn a_lens_is_what_two_balls_have_in_common() {
    let lens = solid(
        "Solid(intersection: [Sphere(center: (-0.5, 0.25, 0), radius: 1), Sphere(center: (0.5, 0.25, 0), \
            radius: 1)])",
    );
    assert_eq!(crossings(&lens, FROM_LEFT.0, FROM_LEFT.1), [4.5, 5.5]);
    assert_eq!(lens.bounds().expect("bounded").min.x, -0.5);
}

/// All that is behind a plane, on the side away from its normal, is in its half space.
#[test]
fn a_plane_cuts_a_ball() {
    let dome = solid(
        "Solid(intersection: [Sphere(center: (0, 0, 0), radius: 1), Plane(point: (0.5, 0, 0), normal: (-1, 0, 0))])",
    );
    let found = crossings(&dome, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert_eq!(found, [5.5, 6.0]);
    assert!(crossings(&dome, [0.0, 0.0, 5.0], [0.0, 0.0, -1.0]).is_empty());
}

#[test]
fn parts_that_share_a_face_leave_no_sheet() {
    let halves =
        solid("Solid(union: [Box(min: (-1, -1, -1), max: (0.1, 1, 1)), Box(min: (0.1, -1, -1), max: (1, 1, 1))])");
    assert_eq!(crossings(&halves, FROM_LEFT.0, [1.0, 0.01, 0.02]).len(), 2);
    let nothing_left = solid(
        "Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Box(min: (-1, 0, -1), max: (1, 1, 1), \
            translate: (0, 0, 0))])",
    );
    assert_eq!(crossings(&nothing_left, [0.3, 5.0, 0.2], [0.01, -1.0, 0.02]).len(), 2);
}

#[test]
fn solids_are_parts_of_solids() {
    let text = "Solid(difference: [
        Solid(intersection: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Sphere(center: (0, 0, 0), radius: 1.35)]),
        Solid(union: [Cylinder(from: (-2, 0, 0), to: (2, 0, 0), radius: 0.6),
            Cylinder(from: (0, -2, 0), to: (0, 2, 0), radius: 0.6),
            Cylinder(from: (0, 0, -2), to: (0, 0, 2), radius: 0.6)]),
    ])";
    let shape = solid(text);
    assert!(crossings(&shape, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]).is_empty());
    assert_eq!(crossings(&shape, [-5.0, 0.7, 0.0], [1.0, 0.0, 0.0]).len(), 4);
}

/// The number of the [`examples`].
const EXAMPLES: usize = 9;

/// Returns solids of each operation, with every shape, and their placements.
fn examples() -> Vec<Shape> {
    let texts: [&str; EXAMPLES - 2] = [
        "Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Sphere(center: (1, 1, 1), radius: 0.9)])",
        "Solid(union: [Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: 1, tube_radius: 0.3), \
            Capsule(from: (-1, 0, 0), to: (1, 0.5, 0), radius: 0.2)])",
        "Solid(intersection: [Ellipsoid(center: (0, 0, 0), radii: (1.5, 0.8, 1)), Plane(point: (0, 0.2, 0), \
            normal: (1, 2, 0)), Cone(from: (0, -1, 0), to: (0, 2, 0), radius: 1.2)])",
        "Solid(difference: [Torus(center: (0, 0, 0), axis: (1, 1, 0), radius: 1, tube_radius: 0.4), \
            Plane(point: (0, 0, 0), normal: (0, 0, 1)), Sphere(center: (1, -1, 0), radius: 0.5, scale: (1, 2, \
                1))], rotate: (20, 30, 0), scale: 1.2)",
        "Solid(difference: [Implicit(f: \"x^4 + y^4 + z^4 - 1\", bounds: Box(min: (-1.1, -1.1, -1.1), max: (1.1, \
            1.1, 0.5))), Sphere(center: (0, 0, 0), radius: 0.95)])",
        "Solid(intersection: [Implicit(f: \"sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)\", bounds: \
            Sphere(center: (0, 0, 0), radius: 1.5), rotate: (0, 30, 0)), Box(min: (-1, -1, -1), max: (1, 1, 1))])",
        "Solid(union: [Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Implicit(f: \"x^2 + z^2 - 0.3 - \
            0.2*sin(5*y)\", bounds: Box(min: (-2, -2, -2), max: (2, 2, 2)))]), Implicit(f: \"x + y + z - 0.5\", \
            bounds: Sphere(center: (0, 0, 0), radius: 0.4))], scale: (1, 1.5, 0.8), translate: (0.1, 0, 0))",
    ];
    texts.map(solid).into_iter().chain(solids_of_meshes()).collect()
}

/// Returns a tetrahedron without a ball, and what it has in common with a turned copy of itself.
fn solids_of_meshes() -> [Shape; 2] {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(Vec3::from);
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let file = MeshFile::new(corners.to_vec(), triangles).expect("there are triangles");
    let mesh = Body::Mesh(ClosedMesh::new(file.into()).expect("it is closed"));
    let quarter = Placement::new(DVec3::ONE, DVec3::new(0.0, 90.0, 0.0), DVec3::splat(0.1)).expect("a placement");
    let turned = mesh.placed(&quarter).expect("it is near");
    let ball = Body::Shape(Sphere::unchecked(Vec3::new(0.2, 0.0, 0.0), 0.8).into());
    let solid = |operation, parts: [Body; 2]| Solid::new(operation, parts.into()).expect("a solid").into();
    [solid(Operation::Difference, [mesh.clone(), ball]), solid(Operation::Intersection, [mesh, turned])]
}

/// Twelve balls in a row have more boundaries than most solids have room for.
#[test]
fn every_boundary_of_a_solid_of_many_shapes_is_found() {
    let ball = |at: i32| format!("Sphere(center: ({}, 0, 0), radius: 0.5)", 2 * at);
    let balls: Vec<_> = (0..12).map(ball).collect();
    let shape = solid(&format!("Solid(union: [{}])", balls.join(", ")));
    let Shape::Solid(row) = &shape else { panic!("a solid") };
    let probe = Probe::new(Ray { origin: Vec3::new(-1.0, 0.0, 0.0), direction: Vec3::X });
    let (mut from, mut found) = (0.0, Vec::new());
    while let Some(t) = row.closest_crossing(&probe, Interval { min: from, max: f32::INFINITY }) {
        found.push(t);
        from = t.next_up();
    }
    let expected: Vec<_> = (0..12).flat_map(|at| [2.0 * at as f32 + 0.5, 2.0 * at as f32 + 1.5]).collect();
    assert_eq!(found, expected);
}

proptest! {
    /// Between two neighbouring boundaries all points are inside, or none is.
    #[test]
    fn boundaries_are_where_membership_changes(
        at in 0..EXAMPLES, from in prop::array::uniform3(-3.0_f32..3.0), to in prop::array::uniform3(-1.0_f32..1.0),
    ) {
        let shape = &examples()[at];
        let Shape::Solid(solid) = shape else { panic!("a solid") };
        let (origin, target) = (Vec3::from(from), Vec3::from(to));
        prop_assume!(origin.distance(target) > 0.1);
        let ray = Ray { origin, direction: target - origin };
        let boundaries = solid.boundaries_of_ray(&ray, ALL);
        for step in if solid.is_known_in_front_only { 0 } else { -200 }..400 {
            let t = 0.01 * f64::from(step) + 0.003;
            let near = |boundary: Boundary| (boundary.t - t).abs() < 1e-3;
            if boundaries.iter().any(near) {
                continue;
            }
            let before = boundaries.iter().filter(|boundary| boundary.t < t).last();
            let expected = before.map_or(boundaries.begins_inside, |boundary| boundary.enters);
            let point = ray.at(t as f32);
            // A thin piece, which a line touches, may be missed by rounding of the point.
            if solid.encloses(point) != expected {
                let around = [-1e-5, 1e-5].map(|off| solid.encloses(point + Vec3::splat(off)));
                prop_assert!(around.contains(&expected), "{at}: {ray:?} at {t}: {expected}");
            }
        }
    }

    /// The normal points out of the solid where the line enters it.
    #[test]
    fn normals_point_outwards(
        at in 0..EXAMPLES, from in prop::array::uniform3(-3.0_f32..3.0), to in prop::array::uniform3(-1.0_f32..1.0),
    ) {
        let shape = &examples()[at];
        let Shape::Solid(solid) = shape else { panic!("a solid") };
        let (origin, target) = (Vec3::from(from), Vec3::from(to));
        prop_assume!(origin.distance(target) > 0.1 && !solid.encloses(origin));
        let ray = Ray { origin, direction: target - origin };
        let probe = Probe::new(ray);
        if let Some(t) = solid.closest_crossing(&probe, Interval { min: 0.0, max: f32::INFINITY }) {
            let point = solid.at_crossing(&ray, t);
            prop_assert_eq!(point.side, Side::Front);
            prop_assert!(point.geometric_normal.dot(ray.direction) <= 0.0);
            prop_assert!(!solid.encloses(point.ray_origin()), "{:?}", point);
        }
    }
}

/// The formula of a ball and a ball are crossed at the same points.
#[test]
fn a_formula_is_a_part_like_a_shape() {
    let dome = |ball: &str| solid(&format!("Solid(difference: [{ball}, Box(min: (-2, -2, -2), max: (2, 0.1, 2))])"));
    let formula = dome("Implicit(f: \"x^2 + y^2 + z^2 - 1\", bounds: Box(min: (-2, -2, -2), max: (2, 2, 2)))");
    let ball = dome("Sphere(center: (0, 0, 0), radius: 1)");
    for (origin, direction) in [([-5.0, 0.3, 0.2], [1.0, 0.02, 0.0]), ([0.1, 5.0, 0.2], [0.0, -1.0, 0.1])] {
        let [of_formula, of_ball] = [&formula, &ball].map(|shape| crossings(shape, origin, direction));
        let are_near = of_formula.iter().zip(&of_ball).all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(of_formula.len() == 2 && of_ball.len() == 2 && are_near, "{of_formula:?} {of_ball:?}");
    }
}

/// The bounds of a formula cap it: its solid is a half ball with a flat face.
#[test]
fn bounds_cap_a_formula() {
    let half = solid(
        "Solid(union: [Implicit(f: \"x^2 + y^2 + z^2 - 1\", bounds: Box(min: (-2, -2, -2), max: (2, 0.25, 2))), \
            Sphere(center: (9, 0, 0), radius: 1)])",
    );
    let ray = Ray { origin: Vec3::new(0.1, 5.0, 0.2), direction: Vec3::NEG_Y };
    let found = crossings(&half, ray.origin.into(), ray.direction.into());
    assert!((found[0] - 4.75).abs() < 1e-6 && found.len() == 2, "{found:?}");
    let Shape::Solid(solid) = &half else { panic!("a solid") };
    assert_eq!(solid.at_crossing(&ray, found[0]).geometric_normal, Vec3::Y);
}

/// In a solid, a formula is cut off where its sign changes at a jump, from both sides alike.
#[test]
fn a_formula_in_a_solid_is_closed_where_it_jumps() {
    let slabs = solid(
        "Solid(union: [Implicit(f: \"x - floor(x) - 0.5\", bounds: Box(min: (0, -1, -1), max: (3, 1, 1))), \
            Sphere(center: (0, 9, 0), radius: 1)])",
    );
    let expected = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5];
    let there = crossings(&slabs, [-5.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    let back = crossings(&slabs, [8.0, 0.1, 0.2], [-1.0, 0.0, 0.0]);
    assert_eq!(there.len(), 6, "{there:?}");
    assert!(there.iter().zip(expected).all(|(t, at)| (t - 5.0 - at).abs() < 1e-5), "{there:?}");
    assert!(back.len() == 6 && back.iter().rev().zip(expected).all(|(t, at)| (8.0 - t - at).abs() < 1e-5), "{back:?}");
    // Below 0 the formula is undefined, which is outside.
    let undefined = solid(
        "Solid(union: [Implicit(f: \"y - sqrt(x)\", bounds: Box(min: (-1, -1, -1), max: (1, 1, 1))), \
            Sphere(center: (0, 9, 0), radius: 1)])",
    );
    let found = crossings(&undefined, [-5.0, -0.5, 0.2], [1.0, 0.0, 0.0]);
    assert!(found.len() == 2 && (found[0] - 5.0).abs() < 1e-5, "{found:?}");
}

/// A jump is found although the search ends in front of the end of the bounds.
#[test]
fn a_jump_is_found_whatever_is_behind_it() {
    let halved = solid(
        "Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Implicit(f: \"floor(x) + 0.5\", bounds: Box(min: \
            (-2, -2, -2), max: (2, 2, 2)))])",
    );
    let Shape::Solid(halved) = &halved else { panic!("a solid") };
    let probe = Probe::new(Ray { origin: Vec3::new(-5.0, 0.2, 0.3), direction: Vec3::X });
    for max in [5.5, 6.5, 1e9] {
        let found = halved.closest_crossing(&probe, Interval { min: 0.0, max });
        assert!(found.is_some_and(|t| (t - 5.0).abs() < 1e-5), "{max}: {found:?}");
    }
}

/// A ball far from the origin, whose box is rounded, is entered, not left.
#[test]
fn the_box_of_a_solid_cuts_nothing_off() {
    let far = solid(
        "Solid(union: [Sphere(center: (1000, 0, 0), radius: 0.1), Implicit(f: \"x + 1000\", bounds: Box(min: (999, \
            0, 0), max: (999.5, 1, 1)))])",
    );
    let Shape::Solid(far) = &far else { panic!("a solid") };
    let ray = Ray { origin: Vec3::new(1000.5, 0.0, 0.0), direction: Vec3::NEG_X };
    let found = far.closest_crossing(&Probe::new(ray), Interval { min: 0.0, max: 9.0 });
    assert!(found.is_some_and(|t| (t - 0.4).abs() < 1e-3), "{found:?}");
    assert_eq!(found.map(|t| far.at_crossing(&ray, t).side), Some(Side::Front));
}

/// A ray that starts on the surface of a formula goes the way that its direction says.
#[test]
fn a_ray_may_start_where_a_formula_is_zero() {
    let lower = solid(
        "Solid(union: [Implicit(f: \"y\", bounds: Box(min: (-1, -1, -1), max: (1, 1, 1))), Sphere(center: (9, 0, 0), \
            radius: 1)])",
    );
    let in_front = |y| {
        let found = crossings(&lower, [0.1, 0.0, 0.2], [0.0, y, 0.0]);
        found.into_iter().filter(|&t| t > 0.0).collect::<Vec<_>>()
    };
    assert_eq!([in_front(-1.0), in_front(1.0)], [vec![1.0], vec![]]);
}

/// Roots outside the box of the solid take none of the number that is found.
#[test]
fn roots_are_searched_for_in_the_box_of_the_solid() {
    let carved = solid(
        "Solid(difference: [Sphere(center: (900, 0, 0), radius: 1), Implicit(f: \"sin(9*x)\", bounds: Box(min: \
            (-1000, -2, -2), max: (1000, 2, 2)))])",
    );
    let Shape::Solid(carved) = &carved else { panic!("a solid") };
    let probe = Probe::new(Ray { origin: Vec3::new(-1010.0, 0.1, 0.1), direction: Vec3::X });
    let (mut from, mut found) = (0.0, 0);
    while let Some(t) = carved.closest_crossing(&probe, Interval { min: from, max: f32::MAX }) {
        (from, found) = (t.next_up(), found + 1);
    }
    // Two units have 18 / pi = 5.7 zeros, and the ball has two ends.
    assert!((5..=8).contains(&found), "{found}");
}

/// A hole whose face lies in that of a mesh is open.
#[test]
fn a_face_shared_with_a_mesh_leaves_no_sheet() {
    let corner = |bits: u32| Vec3::from([0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { -1.0 } else { 1.0 }));
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let file = MeshFile::new((0..8).map(corner).collect(), triangles).expect("there are triangles");
    let mesh = Body::Mesh(ClosedMesh::new(file.into()).expect("it is closed"));
    let hole = Body::Shape(Cuboid::new(DVec3::new(-0.5, -0.5, -0.5), DVec3::new(0.5, 1.0, 0.5)).into());
    let shape = Solid::new(Operation::Difference, vec![mesh, hole]).expect("a solid").into();
    for step in 0..100 {
        let x = 0.009 * step as f32 - 0.45;
        let found = crossings(&shape, [x + 3.0, 6.0, 0.1], [-0.6, -1.0, 0.02]);
        // It enters at the floor or a wall of the hole.
        assert!(found.first().is_none_or(|&t| t > 5.05), "{x}: {found:?}");
    }
}

/// Eight rays are searched together, with the results of each one alone.
#[test]
fn rays_together_find_what_each_finds_alone() {
    let mut hits = 0;
    for (number, shape) in examples().iter().enumerate() {
        let Shape::Solid(solid) = shape else { panic!("a solid") };
        let ray = |lane: usize| {
            let origin = Vec3::new(-3.0, 0.31 * lane as f32 - 1.0, 0.1);
            Ray { origin, direction: Vec3::new(0.2 * lane as f32 - 0.7, 0.1, 0.05) - origin }
        };
        let rays: Vec<_> = (0..8).map(ray).collect();
        let eight = EightRays::of(&rays);
        let probes: Vec<_> = rays.iter().map(|ray| Probe::new(*ray)).collect();
        let lanes = |of: &dyn Fn(&Probe) -> f32| F32x8(from_fn(|lane| of(&probes[lane])));
        let crossed = |probe: &Probe| solid.bounds.crossed(probe);
        let inside = [lanes(&|probe| crossed(probe).min), lanes(&|probe| crossed(probe).max)];
        let (found, t) = solid.closest_crossings(&eight, &inside, &[F32x8::ZERO, F32x8([f32::MAX; 8])]);
        for (lane, probe) in probes.iter().enumerate() {
            let alone = solid.closest_crossing(probe, Interval { min: 0.0, max: f32::MAX });
            assert_eq!((found >> lane & 1 != 0).then(|| t.0[lane]), alone, "solid {number}, lane {lane}");
        }
        hits += found.count_ones();
    }
    assert!(hits > 20, "{hits} of 72 rays hit");
}

#[test]
fn a_formula_in_a_solid_moves() {
    let scene = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Solid(union: [Implicit(f: \"x^2 + y^2 + z^2 - \
        1 - time\", bounds: Box(min: (-2, -2, -2), max: (2, 2, 2))), Box(min: (5, 0, 0), max: (6, 1, 1))])])";
    let scene = Scene::from_ron("solid.ron", scene).unwrap_or_else(|error| panic!("{error}"));
    assert!(scene.depends_on_time());
    let at = |seconds| crossings(&scene.clone().at_time(seconds).objects()[0].shape, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert_eq!(at(0.0)[..2], [4.0, 6.0]);
    assert_eq!(at(1.25)[..2], [3.5, 6.5]);
}

#[test]
fn faults_are_reported_where_they_are() {
    let fault = |text: &str| {
        let scene = format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{text}])");
        Scene::from_ron("solid.ron", &scene).expect_err("a fault").to_string()
    };
    for (text, message) in [
        ("Solid()", "a Solid needs union, intersection or difference"),
        ("Solid(union: [Sphere(center: (0, 0, 0), radius: 1)])", "at least two parts"),
        ("Solid(union: [], difference: [])", "a Solid has one of union, intersection and difference"),
        (
            "Solid(union: [Plane(point: (0, 0, 0), normal: (0, 1, 0)), Sphere(center: (0, 0, 0), radius: 1)])",
            "must be bounded",
        ),
        (
            "Solid(intersection: [Sphere(center: (0, 0, 0), radius: 1), Sphere(center: (5, 0, 0), radius: 1)])",
            "no volume in common",
        ),
        (
            "Solid(union: [Disk(center: (0, 0, 0), normal: (0, 1, 0), radius: 1), Sphere(center: (0, 0, 0), \
                radius: 1)])",
            "encloses nothing",
        ),
        (
            "Solid(union: [Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(\"red\")), Sphere(center: (1, \
                0, 0), radius: 1)])",
            "a part of a Solid has no material",
        ),
        (
            "Solid(union: [Sphere(center: (0, 0, 0), radius: 1), Implicit(f: \"x\", bounds: Box(min: (0, 0, 0), max: \
                (1, 1, 1)), color: [\"1\", \"0\", \"0\"])])",
            "a part of a Solid has no color; give the Solid a material",
        ),
    ] {
        assert!(fault(text).contains(message), "{text}: {}", fault(text));
    }
}

/// A line that only touches a torus, or passes through its middle point, stays outside.
#[test]
fn a_torus_that_is_touched_changes_nothing() {
    let beside = |torus: &str| solid(&format!("Solid(union: [{torus}, Sphere(center: (4, 0, 0), radius: 0.5)])"));
    let touched = beside("Torus(center: (0, 0, 0), axis: (0, 0, 1), radius: 1, tube_radius: 0.25)");
    assert_eq!(crossings(&touched, [-5.0, 0.0, 0.25], [1.0, 0.0, 0.0]), [8.566_987, 9.433_013]);
    let pinched = solid(
        "Solid(union: [Torus(center: (0, 0, 0), axis: (1, 0, 0), radius: 1, tube_radius: 1), Sphere(center: (4, \
            0, 0), radius: 0.5)])",
    );
    assert_eq!(crossings(&pinched, [-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [8.5, 9.5]);
}

/// A plane that is almost parallel to a line does not merge the other boundaries.
#[test]
fn a_far_crossing_of_a_plane_hides_nothing() {
    let cut = solid(
        "Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Plane(point: (0, 2, 0), normal: (0, -1, 0))])",
    );
    assert_eq!(crossings(&cut, [-5.0, 0.0, 0.0], [1.0, 1e-12, 0.0]), [4.0, 6.0]);
}
