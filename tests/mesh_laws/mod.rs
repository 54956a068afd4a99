//! Properties of any bytes that are read as a mesh, for the tests and for the fuzzer.

use glam::{Vec2, Vec3};
use std::io;
use std::path::Path;
use std::sync::Mutex;
use termtrace::internals::bounds::Bounds;
use termtrace::internals::hit::closest_hit;
use termtrace::internals::mesh_file::{FilePosition, MeshFile};
use termtrace::internals::progress::Reporter;
use termtrace::internals::ray::Ray;
use termtrace::{LinearRgb, MeshError, Scene};

/// Asserts that bytes give a valid mesh, or an error that can be printed.
///
/// The file may name others: the bytes behind the first NUL are every MTL file, those behind the second one every other
/// file. (OBJ and MTL have no NUL; for other formats the bytes are the file and every other file.)
pub(crate) fn hold_for(name: &str, bytes: &[u8]) {
    let is_obj = Path::new(name).extension().is_some_and(|ending| ending == "obj");
    let parts: Vec<&[u8]> = if is_obj { bytes.splitn(3, |&byte| byte == 0).collect() } else { vec![bytes; 3] };
    let part = |i: usize| parts.get(i).copied().ok_or_else(|| io::Error::from(io::ErrorKind::NotFound));
    let mut open = |path: &Path| {
        assert_local(path);
        part(if path.extension().is_some_and(|ending| ending == "mtl") { 1 } else { 2 }).map(<[u8]>::to_vec)
    };
    let found = MeshFile::from_bytes(name, parts[0], &mut open);
    let notices = Mutex::new(Vec::new());
    let on_notice = |notice: String| notices.lock().expect("a lock").push(notice);
    let reporter = Reporter::silent().with_warnings(&on_notice);
    match (found, MeshFile::parse(name, None, parts[0], &mut open, &reporter)) {
        (Ok(mesh), Ok(same)) => {
            assert_sound(&mesh);
            assert_eq!(mesh, same, "notices change nothing where there is no fault");
        }
        (Err(error), Ok(mesh)) => {
            assert_shown(&error, bytes);
            assert_sound(&mesh);
            assert!(!notices.lock().expect("a lock").is_empty(), "left out without a notice: {error}");
        }
        (Err(error), Err(_)) => assert_shown(&error, bytes),
        (Ok(_), Err(error)) => panic!("refused, although it is valid: {error}"),
    }
    for notice in notices.into_inner().expect("a lock") {
        assert!(!notice.contains(char::is_control) && notice.chars().count() < 1500, "{notice:?}");
    }
}

/// Asserts that bytes give a valid texture, or an error that can be printed.
pub(crate) fn hold_for_texture(bytes: &[u8]) {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nmtllib x.mtl\nusemtl x\nf 1/1 2/1 3/1\n\0newmtl x\nmap_Kd x.png\n\0";
    hold_for("x.obj", &[mesh.as_bytes(), bytes].concat());
}

/// Asserts that a path is no URL and not absolute.
fn assert_local(path: &Path) {
    let text = path.to_str().expect("paths are UTF-8");
    assert!(path.is_relative() && !text.contains("://") && !text.contains('\0') && !text.is_empty(), "{text}");
}

pub(crate) fn assert_sound(mesh: &MeshFile) {
    assert!(!mesh.triangles().is_empty());
    assert!(mesh.positions().iter().all(|position| position.is_finite()));
    let is_reflectance = |c: LinearRgb| [c.r, c.g, c.b].iter().all(|band| (0.0..=1.0).contains(band));
    for (i, triangle) in mesh.triangles().iter().enumerate() {
        assert!(triangle.iter().all(|&index| (index as usize) < mesh.positions().len()));
        // None of these panics, because their indices are in range.
        assert!(mesh.normals_of(i).into_iter().flatten().all(|n: Vec3| (n.length() - 1.0).abs() < 1e-5));
        assert!(mesh.texture_coordinates_of(i).into_iter().flatten().all(Vec2::is_finite));
        assert!(mesh.colors_of(i).into_iter().flatten().all(is_reflectance));
        assert!(mesh.material_of(i).is_none_or(|material| material < mesh.materials().len()));
    }
    assert_moves(mesh);
    for material in mesh.materials() {
        assert!(is_reflectance(material.reflectance));
        if let Some(placement) = &material.texture {
            let texture = &placement.texture;
            assert!(texture.width() > 0 && texture.height() > 0);
            assert_eq!(texture.texels().len(), texture.width() as usize * texture.height() as usize);
            assert!(placement.transform.iter().all(|row| row.is_finite()));
        }
    }
}

/// Asserts that a mesh that moves has an extent at any time, and can be hit by rays.
fn assert_moves(mesh: &MeshFile) {
    let Some(scene) = mesh.moves().then(|| Scene::of_mesh(mesh.clone())).flatten() else { return };
    for seconds in [0.0, 0.3, -7.0, 1e9] {
        let scene = scene.clone().at_time(seconds);
        let Some(Bounds { min, max }) = scene.bounds() else { continue };
        assert!(min.is_finite() && max.is_finite() && min.cmple(max).all(), "{min} {max}");
        let origin = scene.camera().pose().eye;
        let hit = closest_hit(&scene, &Ray { origin, direction: min + 0.4 * (max - min) - origin });
        assert!(hit.is_none_or(|hit| hit.t.is_finite()), "{hit:?}");
    }
}

fn assert_shown(error: &MeshError, bytes: &[u8]) {
    let message = error.to_string();
    assert!(message.starts_with(error.name()), "{message}");
    assert!(!message.contains(char::is_control), "{message:?}");
    assert!(message.chars().count() < 1000, "{message}");
    match error.position() {
        FilePosition::File => {}
        FilePosition::Byte(byte) => {
            // Of UTF-16 it is a byte of the text as UTF-8, which may be half as long again.
            let is_wide = [[0xff, 0xfe], [0xfe, 0xff]].iter().any(|mark| bytes.starts_with(mark));
            let most = if is_wide { bytes.len() * 3 / 2 } else { bytes.len() };
            assert!(byte <= most, "{message}");
        }
        FilePosition::Text { line, column } => {
            let lines = 1 + bytes.iter().filter(|byte| b"\r\n".contains(byte)).count();
            assert!((1..=lines).contains(&line) && (1..=bytes.len() + 1).contains(&column), "{message}");
        }
    }
}
