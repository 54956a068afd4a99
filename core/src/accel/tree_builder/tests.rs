use super::*;
use crate::lanes::F32x8;
use crate::mesh_file::MeshFile;
use crate::shape::{Crossable, TriangleN};
use glam::Vec3;
use std::convert::Infallible;

/// Returns a triangle at x = `at`.
fn triangle(at: usize) -> [Vec3; 3] {
    [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| corner + at as f32 * Vec3::X)
}

/// Returns a mesh of `count` triangles, the first at x = `first`.
fn mesh(first: usize, count: usize) -> Mesh {
    let positions = (first..first + count).flat_map(triangle).collect();
    let triangles = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh::of_checked(MeshFile::new(positions, triangles).expect("a mesh"))
}

#[test]
fn primitives_of_meshes_and_of_lists_keep_their_ids() {
    // Enough for several threads, and several runs of both kinds.
    let meshes = [mesh(2, 9000), mesh(9002, 1), mesh(9005, 700)];
    let mut builder = TreeBuilder::default();
    let mut expected = Vec::new();
    let mut push = |builder: &mut TreeBuilder<'_, Triangle>, object, at| {
        builder.push(PrimitiveId { object, index: 0 }, Triangle::unchecked(triangle(at)));
        expected.push((PrimitiveId { object, index: 0 }, Bounds::of(triangle(at))));
    };
    push(&mut builder, 0, 0);
    push(&mut builder, 1, 1);
    builder.push_mesh(2, &meshes[0]);
    builder.push_mesh(3, &meshes[1]);
    push(&mut builder, 4, 9003);
    push(&mut builder, 5, 9004);
    builder.push_mesh(6, &meshes[2]);
    for (object, mesh) in [2, 3, 6].into_iter().zip(&meshes) {
        let of_mesh = |index| (PrimitiveId { object, index }, Bounds::of(mesh.file_corners(index)));
        expected.extend((0..mesh.triangle_count()).map(of_mesh));
    }
    expected.sort_by_key(|(id, _)| *id);
    assert_eq!(builder.len(), 9705);

    let Ok(tree) = builder.build::<TriangleN<F32x8>, _>(8, &|_| Ok::<_, Infallible>(()));
    assert_eq!(tree.bvh.bounds(), Some(Bounds { min: Vec3::ZERO, max: Vec3::new(9705.0, 1.0, 0.0) }));
    let mut found = Vec::new();
    for leaf in 0..tree.leaves.len() {
        let [min, max] = tree.leaves[leaf].one_per_lane::<F32x8>().boxes();
        for (lane, id) in tree.primitives(leaf).enumerate() {
            found.push((id, Bounds { min: min.of_lane(lane), max: max.of_lane(lane) }));
        }
    }
    found.sort_by_key(|(id, _)| *id);
    assert!(found == expected);
}
