use super::*;
use crate::scene::Scene;
use proptest::prelude::*;

fn solid(text: &str) -> Shape {
    let scene = format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [{text}])");
    let scene = Scene::from_ron("solid.ron", &scene).unwrap_or_else(|error| panic!("{error}"));
    scene.objects()[0].shape.clone()
}

fn crossings(shape: &Shape, origin: [f32; 3], direction: [f32; 3]) -> Vec<f32> {
    let ray = Ray { origin: origin.into(), direction: direction.into() };
    let Shape::Solid(solid) = shape else { panic!("a solid") };
    solid.boundaries::<MAX_BOUNDARIES>(&Probe::new(ray)).iter().map(|boundary| boundary.t as f32).collect()
}

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

/// Returns solids of each operation, with every shape, and their placements.
fn examples() -> Vec<Shape> {
    [
        "Solid(difference: [Box(min: (-1, -1, -1), max: (1, 1, 1)), Sphere(center: (1, 1, 1), radius: 0.9)])",
        "Solid(union: [Torus(center: (0, 0, 0), axis: (0, 1, 0), radius: 1, tube_radius: 0.3), \
            Capsule(from: (-1, 0, 0), to: (1, 0.5, 0), radius: 0.2)])",
        "Solid(intersection: [Ellipsoid(center: (0, 0, 0), radii: (1.5, 0.8, 1)), Plane(point: (0, 0.2, 0), \
            normal: (1, 2, 0)), Cone(from: (0, -1, 0), to: (0, 2, 0), radius: 1.2)])",
        "Solid(difference: [Torus(center: (0, 0, 0), axis: (1, 1, 0), radius: 1, tube_radius: 0.4), \
            Plane(point: (0, 0, 0), normal: (0, 0, 1)), Sphere(center: (1, -1, 0), radius: 0.5, scale: (1, 2, \
                1))], rotate: (20, 30, 0), scale: 1.2)",
    ]
    .map(solid)
    .into()
}

/// Twelve balls in a row have more boundaries than most solids have room for.
#[test]
fn every_boundary_of_a_solid_of_many_shapes_is_found() {
    let ball = |at: i32| format!("Sphere(center: ({}, 0, 0), radius: 0.5)", 2 * at);
    let balls: Vec<_> = (0..12).map(ball).collect();
    let shape = solid(&format!("Solid(union: [{}])", balls.join(", ")));
    let Shape::Solid(row) = &shape else { panic!("a solid") };
    assert!(!row.has_few_boundaries);
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
        at in 0_usize..4, from in prop::array::uniform3(-3.0_f32..3.0), to in prop::array::uniform3(-1.0_f32..1.0),
    ) {
        let shape = &examples()[at];
        let Shape::Solid(solid) = shape else { panic!("a solid") };
        let (origin, target) = (Vec3::from(from), Vec3::from(to));
        prop_assume!(origin.distance(target) > 0.1);
        let ray = Ray { origin, direction: target - origin };
        let boundaries = solid.boundaries::<MAX_BOUNDARIES>(&Probe::new(ray));
        let few = solid.boundaries::<FEW_BOUNDARIES>(&Probe::new(ray));
        prop_assert!(solid.has_few_boundaries);
        prop_assert!(few.iter().map(|few| few.t).eq(boundaries.iter().map(|boundary| boundary.t)));
        for step in -200..400 {
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
        at in 0_usize..4, from in prop::array::uniform3(-3.0_f32..3.0), to in prop::array::uniform3(-1.0_f32..1.0),
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
