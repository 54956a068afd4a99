use super::*;

/// Returns a cup: a box that is open at one end of an axis, with a square bottom at coordinate 0.
fn cup(axis: usize) -> MeshFile {
    let point = |at: [f32; 3]| {
        let mut point = Vec3::ZERO;
        for (i, coordinate) in at.into_iter().enumerate() {
            point[(axis + 1 + i) % 3] = coordinate;
        }
        point
    };
    let corner = |i: usize, height| point([[0.0, 2.0, 2.0, 0.0][i % 4], [0.0, 0.0, 2.0, 2.0][i % 4], height]);
    let positions = (0..4).map(|i| corner(i, 0.0)).chain((0..4).map(|i| corner(i, 3.0)));
    let mut triangles = vec![[0, 2, 1], [0, 3, 2]];
    for i in 0..4_u32 {
        let next = (i + 1) % 4;
        triangles.extend([[i, next, next + 4], [i, next + 4, i + 4]]);
    }
    MeshFile::new(positions.collect(), triangles).expect("a mesh")
}

#[test]
fn a_thing_stands_on_its_flat_end() {
    for usual in [UpAxis::Y, UpAxis::Z] {
        assert_eq!(guessed(&cup(1), usual, false), UpAxis::Y);
        assert_eq!(guessed(&cup(2), usual, false), UpAxis::Z);
        // A cup that lies on its side gives no evidence for either axis.
        assert_eq!(guessed(&cup(0), usual, false), usual);
    }
}

#[test]
fn a_flat_mesh_is_no_reason_to_turn() {
    let square = MeshFile::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).expect("a mesh");
    assert_eq!(guessed(&square, UpAxis::Z, false), UpAxis::Z);
    assert_eq!(guessed(&square, UpAxis::Y, false), UpAxis::Y);
}

#[test]
fn each_axis_is_turned_to_y_without_a_mirror() {
    let directions = [Vec3::Y, Vec3::Z, Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::NEG_X];
    for (axis, direction) in UpAxis::ALL.into_iter().zip(directions) {
        assert_eq!(axis.turn() * direction, Vec3::Y, "{axis:?}");
        assert_eq!(axis.turn().determinant(), 1.0, "{axis:?}");
        assert_eq!(UpAxis::from_name(axis.name()), Some(axis));
        let [x, y, z] = axis.degrees().map(|degrees| f64::from(degrees).to_radians() as f32);
        let written = Mat3::from_rotation_z(z) * Mat3::from_rotation_y(y) * Mat3::from_rotation_x(x);
        assert!((written * direction).distance(Vec3::Y) < 1e-6, "{axis:?}");
    }
    let mut axis = UpAxis::Y;
    for _ in 0..6 {
        axis = axis.next();
    }
    assert_eq!(axis, UpAxis::Y);
}

#[test]
fn all_threads_find_the_same_sums_as_one() {
    // Triangles that lie flat, in five chunks. The sum of the first is so large that each of the others is rounded away
    // if it is added to it, but not all others together.
    let count = 5 * CHUNK - 7;
    let mut positions = vec![Vec3::Z];
    for i in 0..count {
        let side = if i < CHUNK { 1024.0 } else { 1e-5 };
        positions.extend([Vec3::ZERO, Vec3::Y * side, Vec3::X * side]);
    }
    let mut triangles: Vec<_> = (0..count as u32).map(|i| [3 * i + 1, 3 * i + 2, 3 * i + 3]).collect();
    // One that stands, so that the mesh has a height.
    triangles.push([0, 1, 2]);
    let mesh = MeshFile::new(positions, triangles).expect("a mesh");
    let bounds = Bounds::of(mesh.positions().iter().copied());
    let alone = Evidence::of(&mesh, &bounds, false);
    assert_eq!(Evidence::of(&mesh, &bounds, true), alone);
    // The test can tell the order of the sums.
    let last = mesh.positions().len().div_ceil(CHUNK);
    let in_order = |chunks: &mut dyn Iterator<Item = usize>| {
        let chunks = chunks.map(|chunk| Evidence::of_chunk(&mesh, &bounds, chunk));
        chunks.fold(Evidence::default(), |sums, chunk| sums.plus(&chunk))
    };
    assert_eq!(in_order(&mut (0..last)), alone);
    assert_ne!(in_order(&mut (0..last).rev()).flat, alone.flat);
}
