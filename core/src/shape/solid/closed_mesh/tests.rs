use super::*;
use proptest::prelude::*;

/// Returns the cube from -1 to 1, whose faces are split along a diagonal.
fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner = |bits: u32| Vec3::from([0, 1, 2].map(|axis| if bits >> axis & 1 == 0 { -1.0 } else { 1.0 }));
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

fn file((positions, triangles): (Vec<Vec3>, Vec<[u32; 3]>)) -> Arc<MeshFile> {
    Arc::new(MeshFile::new(positions, triangles).expect("there are triangles"))
}

fn closed_cube() -> ClosedMesh {
    ClosedMesh::new(file(cube())).expect("a cube is closed")
}

fn crossings(mesh: &ClosedMesh, origin: [f32; 3], direction: [f32; 3]) -> Vec<(f32, bool)> {
    let found = mesh.crossings(&Ray { origin: origin.into(), direction: direction.into() });
    found.iter().map(|crossing| (crossing.t, crossing.enters)).collect()
}

#[test]
fn edges_without_a_second_triangle_are_open() {
    let (positions, triangles) = cube();
    assert_eq!(open_edge_count(&welded_corners(&file((positions.clone(), triangles.clone())))), 0);
    assert_eq!(open_edge_count(&welded_corners(&file((positions.clone(), triangles[1..].to_vec())))), 3);
    let mut flipped = triangles.clone();
    flipped[0].swap(1, 2);
    assert_eq!(open_edge_count(&welded_corners(&file((positions.clone(), flipped)))), 3);
    // The corners of each triangle of its own, as in STL files, and -0 beside 0.
    let apart: Vec<Vec3> = triangles.iter().flatten().map(|&corner| positions[corner as usize]).collect();
    let in_turn = (0..12).map(|triangle| [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]).collect();
    assert_eq!(open_edge_count(&welded_corners(&file((apart, in_turn)))), 0);
}

#[test]
fn a_line_through_edges_and_corners_enters_and_leaves_once() {
    let twice = vec![(4.0, true), (6.0, false)];
    // Along the diagonals of two faces, through corners, and along an edge of the outline.
    assert_eq!(crossings(&closed_cube(), [0.0, 0.0, -5.0], [0.0, 0.0, 1.0]), twice);
    assert_eq!(crossings(&closed_cube(), [0.5, -0.5, -5.0], [0.0, 0.0, 1.0]), twice);
    assert_eq!(crossings(&closed_cube(), [-5.0, -5.0, -5.0], [1.0, 1.0, 1.0]), twice);
    for direction in [[1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, -1.0, 1.0]] {
        let origin = [-5.0 * direction[0], -5.0 * direction[1], -5.0];
        assert_eq!(crossings(&closed_cube(), origin, direction), twice, "{direction:?}");
    }
}

#[test]
fn a_line_that_touches_an_edge_stays_outside() {
    // It meets the edge x = y = 1 from outside, where one triangle faces it and the other does not.
    assert_eq!(crossings(&closed_cube(), [3.0, -1.0, 0.25], [-1.0, 1.0, 0.0]), []);
}

#[test]
fn a_line_from_inside_leaves_first() {
    assert_eq!(crossings(&closed_cube(), [0.25, 0.5, 0.0], [1.0, 0.0, 0.0]), [(0.75, false)]);
    assert!(closed_cube().encloses(Vec3::splat(0.9)));
    assert!(!closed_cube().encloses(Vec3::splat(1.1)));
}

#[test]
fn the_orientation_of_all_triangles_does_not_matter() {
    let (positions, mut triangles) = cube();
    for triangle in &mut triangles {
        triangle.swap(1, 2);
    }
    let inside_out = ClosedMesh::new(file((positions, triangles))).expect("it is closed");
    let (origin, direction) = ([-5.0, 0.2, 0.3], [1.0, 0.0, 0.0]);
    assert_eq!(crossings(&inside_out, origin, direction), crossings(&closed_cube(), origin, direction));
    let ray = Ray { origin: origin.into(), direction: direction.into() };
    let [triangle, other] =
        [&inside_out, &closed_cube()].map(|mesh| mesh.at_crossing(mesh.crossings(&ray)[0].triangle, &ray, 4.0));
    assert_eq!((triangle.side, triangle.geometric_normal), (Side::Front, Vec3::NEG_X));
    assert_eq!(triangle, other);
}

#[test]
fn copies_share_the_tree_and_are_crossed_where_they_are() {
    let placement = Placement::new([2.0, -1.0, 1.0].into(), [0.0, 0.0, 90.0].into(), [10.0, 0.0, 0.0].into());
    let copy = closed_cube().placed(&placement.expect("it is a placement"));
    assert_eq!(crossings(&copy, [10.0, -5.0, 0.25], [0.0, 1.0, 0.0]), [(3.0, true), (7.0, false)]);
    let bounds = copy.bounds();
    assert_eq!([bounds.min, bounds.max], [Vec3::new(9.0, -2.0, -1.0), Vec3::new(11.0, 2.0, 1.0)]);
}

/// Returns cubes of side 2 whose centres are at these x, as one mesh.
fn cubes(at: &[f32]) -> ClosedMesh {
    let (corners, triangles) = cube();
    let positions = at.iter().flat_map(|&x| corners.iter().map(move |corner| *corner + Vec3::X * x)).collect();
    let of_cube = |number: usize| triangles.iter().map(move |triangle| triangle.map(|at| at + 8 * number as u32));
    ClosedMesh::new(file((positions, (0..at.len()).flat_map(of_cube).collect()))).expect("it is closed")
}

#[test]
fn components_that_overlap_or_touch_are_one_volume() {
    // They overlap, contain each other, touch, and have a face in one plane.
    for (at, expected) in [
        (&[0.0, 1.0][..], vec![(4.0, true), (7.0, false)]),
        (&[0.0, 1.0, 0.5], vec![(4.0, true), (7.0, false)]),
        (&[0.0, 2.0], vec![(4.0, true), (8.0, false)]),
        (&[0.0, 3.0], vec![(4.0, true), (6.0, false), (7.0, true), (9.0, false)]),
    ] {
        for [y, z] in [[0.2, 0.3], [0.5, 0.5]] {
            let found = crossings(&cubes(at), [-5.0, y, z], [1.0, 0.0, 0.0]);
            let found: Vec<_> = found.into_iter().map(|(t, enters)| ((t * 1e4).round() / 1e4, enters)).collect();
            assert_eq!(found, expected, "{at:?}");
        }
        assert!(cubes(at).encloses(Vec3::splat(0.9)), "{at:?}");
    }
}

#[test]
fn a_mesh_far_from_the_origin_is_not_inside_out() {
    let (positions, triangles) = cube();
    let far = positions.into_iter().map(|corner| corner + Vec3::new(5e5, 4.6e6, 100.0)).collect();
    assert!(ClosedMesh::new(file((far, triangles))).is_ok_and(|mesh| !mesh.tree.is_inside_out));
}

#[test]
fn a_sheet_with_two_sides_encloses_nothing() {
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let sheet = ClosedMesh::new(file((corners, vec![[0, 1, 2], [0, 2, 1]])));
    assert_eq!(sheet.expect_err("it is flat"), "its volume is 0");
}

proptest! {
    /// A line crosses the cube where it crosses the planes of its faces.
    #[test]
    fn a_cube_is_crossed_where_the_box_is(
        from in prop::array::uniform3(-3.0_f32..3.0), to in prop::array::uniform3(-1.5_f32..1.5),
    ) {
        let (origin, target) = (Vec3::from(from), Vec3::from(to));
        prop_assume!(origin.distance(target) > 0.1);
        let direction = target - origin;
        let [a, b] = [-1.0_f32, 1.0].map(|at| (Vec3::splat(at) - origin) / direction);
        let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
        // A line that touches an edge is decided by rounding.
        prop_assume!((leaves - enters).abs() > 1e-4 && enters.abs() > 1e-4 && leaves.abs() > 1e-4);
        let expected: Vec<_> =
            [(enters, true), (leaves, false)].into_iter().filter(|(t, _)| enters < leaves && *t > 0.0).collect();
        let found = crossings(&closed_cube(), from, direction.into());
        prop_assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            prop_assert!((found.0 - expected.0).abs() < 1e-4 && found.1 == expected.1, "{:?}", found);
        }
    }
}
