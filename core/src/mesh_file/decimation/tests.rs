use super::*;

/// Returns a mesh in the plane z = 0: `side` by `side` unit squares of two triangles, with a normal
/// at each vertex.
fn square(side: u32) -> MeshFile {
    let vertices = (0..=side).flat_map(|y| (0..=side).map(move |x| Vec3::new(x as f32, y as f32, 0.0)));
    let vertices: Vec<Vec3> = vertices.collect();
    let at = |x: u32, y: u32| y * (side + 1) + x;
    let squares = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    let triangles = squares
        .flat_map(|(x, y)| [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]);
    let normals = vec![Vec3::Z; vertices.len()];
    let mesh = MeshFile::new(vertices, triangles.collect()).and_then(|mesh| mesh.with_normals(normals));
    mesh.expect("it is a mesh")
}

fn area(mesh: &MeshFile) -> f32 {
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        0.5 * (b - a).cross(c - a).z
    };
    mesh.triangles.iter().map(area).sum()
}

#[test]
fn a_coarse_mesh_covers_what_the_mesh_covers() {
    let mesh = square(100);
    let decimated = mesh.decimated(10).expect("something is left");
    assert_eq!(decimated.positions.len(), 100);
    assert_eq!(decimated.triangles.len(), 2 * 9 * 9);
    // Clustered vertices lie near the centres of cubes of side 10, so half a cube is lost at each edge of the square.
    assert!((area(&decimated) - 90.0 * 90.0).abs() < 200.0, "{}", area(&decimated));
    assert!((0..decimated.triangles.len()).all(|i| decimated.normals_of(i) == Some([Vec3::Z; 3])));
}

#[test]
fn triangles_larger_than_the_cubes_stay() {
    let mesh = square(4);
    let decimated = mesh.decimated(200).expect("something is left");
    assert_eq!((decimated.positions.len(), decimated.triangles.len()), (25, 32));
    assert_eq!(area(&decimated), 16.0);
}

#[test]
fn of_a_point_nothing_is_left() {
    let point = MeshFile::new(vec![Vec3::X; 3], vec![[0, 1, 2]]).expect("it is a mesh");
    assert_eq!(point.decimated(96), None);
}
