use super::*;
use crate::mesh_file::MeshFile;
use crate::progress::Reporter;
use std::io::ErrorKind;
use std::sync::Mutex;

/// Returns a binary file of more facets than are read on one thread, on a spiral. `faulty` are
/// corners without a finite y.
fn spiral(faulty: &[usize]) -> Vec<u8> {
    let count = MIN_PARALLEL_FACETS + 20;
    let mut bytes = vec![b' '; HEADER - 4];
    bytes.extend((count as u32).to_le_bytes());
    for facet in 0..count {
        bytes.extend([0; 12]);
        for corner in 3 * facet..3 * facet + 3 {
            let angle = corner as f32 * 0.1;
            let y = if faulty.contains(&corner) { f32::INFINITY } else { libm::sinf(angle) };
            bytes.extend([libm::cosf(angle), y, angle * 0.001].into_iter().flat_map(f32::to_le_bytes));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// Returns the mesh or the error of a file that is read with or without all threads, and the
/// notices.
fn read(bytes: &[u8], takes_notices: bool, is_parallel: bool) -> (Result<MeshFile, String>, Vec<String>) {
    let notices = Mutex::new(Vec::new());
    let on_warning = |notice| notices.lock().expect("no thread panicked").push(notice);
    let reporter = Reporter::silent();
    let reporter = if takes_notices { reporter.with_warnings(&on_warning) } else { reporter };
    let reporter = if is_parallel { reporter } else { reporter.on_this_thread() };
    let mesh = MeshFile::parse("x.stl", None, bytes, &mut |_| Err(ErrorKind::NotFound.into()), &reporter);
    let mesh = mesh.map_err(|error| error.to_string());
    (mesh, notices.into_inner().expect("no thread panicked"))
}

#[test]
fn all_threads_read_the_same_mesh_as_one() {
    let bytes = spiral(&[]);
    let (parallel, alone) = (read(&bytes, false, true), read(&bytes, false, false));
    assert!(parallel == alone);
    let mesh = parallel.0.expect("a mesh");
    for (corner, position) in mesh.positions().iter().enumerate().step_by(977) {
        let angle = corner as f32 * 0.1;
        assert_eq!(*position, Vec3::new(libm::cosf(angle), libm::sinf(angle), angle * 0.001));
        assert_eq!(mesh.triangles()[corner / 3][corner % 3], corner as u32);
    }
}

#[test]
fn all_threads_report_the_same_faults_as_one() {
    // One fault in each of two blocks, the later one first in the list.
    let bytes = spiral(&[3 * BLOCK_FACETS + 4, 700]);
    for takes_notices in [false, true] {
        let (parallel, alone) = (read(&bytes, takes_notices, true), read(&bytes, takes_notices, false));
        assert!(parallel == alone);
        let message = format!("x.stl: byte {}: inf is not a finite number", HEADER + 233 * FACET + OFFSETS[1] + 4);
        match parallel {
            (Ok(_), notices) => {
                assert_eq!(notices, [format!("{message} (ignored, with 1 more fault, 2 triangles)")]);
            }
            (Err(error), _) => assert_eq!((takes_notices, error), (false, message)),
        }
    }
}
