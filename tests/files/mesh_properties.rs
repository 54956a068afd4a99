//! Properties of meshes: each format reads what it wrote, and any file gives a mesh or an error.

use crate::mesh_laws;
use crate::mesh_writers::{WRITERS, Written};
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use rayon::prelude::*;
use std::path::Path;
use termtrace::internals::mesh_file::MeshFile;

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -10.0_f32..10.0,
        1 => proptest::num::f32::NORMAL | proptest::num::f32::SUBNORMAL | proptest::num::f32::ZERO,
        1 => (-1000_i16..1000).prop_map(f32::from),
    ]
}

fn direction() -> impl Strategy<Value = Vec3> {
    let number = || -1.0_f32..1.0;
    (number(), number(), number()).prop_map(|(x, y, z)| Vec3::new(x, y, z).normalize_or(Vec3::Z))
}

prop_compose! {
    fn written()(count in 3_usize..30)(
        positions in prop::collection::vec((number(), number(), number()).prop_map(Vec3::from), count),
        triangles in prop::collection::vec(prop::array::uniform3(0..count as u32), 1..50),
        normals in prop::option::of(prop::collection::vec(direction(), count)),
        texture_coordinates in prop::option::of(prop::collection::vec((number(), number()).prop_map(Vec2::from), count)),
        colors in prop::option::of(prop::collection::vec(any::<[u8; 3]>(), count)),
    ) -> Written {
        Written { positions, triangles, normals, texture_coordinates, colors }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_written_mesh_reads_back_equal(written in written()) {
        for writer in WRITERS {
            let bytes = (writer.write)(&written);
            let mesh = MeshFile::from_bytes(writer.name, &bytes, &mut |_| unreachable!());
            let mesh = mesh.map_err(|error| TestCaseError::fail(error.to_string()))?;
            mesh_laws::assert_sound(&mesh);
            written.compare(&mesh, writer)?;
        }
    }

    #[test]
    fn any_bytes_give_a_mesh_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for name in ["x.obj", "x.stl", "x.ply", "x.gltf", "x.glb", "x"] {
            mesh_laws::hold_for(name, &bytes);
        }
    }
}

/// Returns the bytes of all valid files.
fn valid_files() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    let read = |path: &Path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap());
    std::fs::read_dir(folder).unwrap().map(|entry| read(&entry.unwrap().path())).collect()
}

#[test]
fn every_prefix_of_a_file_gives_a_mesh_or_an_error() {
    for (name, bytes) in valid_files() {
        for length in 0..bytes.len() {
            mesh_laws::hold_for(&name, &bytes[..length]);
        }
    }
}

#[test]
fn every_changed_byte_gives_a_mesh_or_an_error() {
    valid_files().par_iter().for_each(|(name, bytes)| {
        for i in 0..bytes.len() {
            for new in [0, 0xff, b'9', b'-', b' ', b'\n', bytes[i] ^ 1, bytes[i] ^ 0x80] {
                let mut changed = bytes.clone();
                changed[i] = new;
                mesh_laws::hold_for(name, &changed);
            }
        }
    });
}
