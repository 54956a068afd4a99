//! Meshes in the live view: which axis is up, missing materials, and the keys for single objects.

use crate::mouse::report;
use crate::orbit::{TEAPOT, camera, load, looking};
use crate::pty::{SOON, Session, Size, Start};
use glam::Vec3;
use std::fs;
use std::path::Path;
use tempfile::TempDir;
use termtrace::{Camera, Scene};

/// A tetrahedron.
const SOLID: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("a file can be written");
    }
    folder
}

fn start(path: &Path) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(path).size(Size::cells(80, 24));
    let mut session = start.says_when_it_rests().spawn();
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains(['▄', '▀']));
    session.wait_for_rest();
    session
}

#[track_caller]
fn wait_for_no(session: &mut Session, words: &str) {
    session.wait_for(&format!("no {words}"), SOON, |seen| !seen.screen().text().concat().contains(words));
}

#[track_caller]
fn leave(session: &mut Session) {
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

#[test]
fn a_missing_material_file_and_curves_are_named_on_the_screen_until_a_key() {
    let folder = folder(&[("a.obj", &format!("mtllib a.mtl\nusemtl red\n{SOLID}curv 0 1 1 2\n"))]);
    let mut session = start(&folder.path().join("a.obj"));
    session.wait_for_text("materials missing: a.mtl");
    session.wait_for_text("not shown: 1 curve");
    session.send(b"i");
    wait_for_no(&mut session, "materials missing");
    // The file is watched, although it is missing.
    fs::write(folder.path().join("a.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd a.png\n").expect("written");
    session.wait_for_text("texture missing: a.png");
    leave(&mut session);
}

#[test]
fn a_key_turns_a_mesh_and_a_guess_is_announced() {
    let stl = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 2\nendloop\nendfacet\n\
               endsolid a\n";
    let folder = folder(&[("a.stl", stl)]);
    let mut session = start(&folder.path().join("a.stl"));
    session.wait_for_text("z is up in this STL (a guess); z turns it");
    session.send(b"M");
    session.wait_for_text("up         z (a guess)");
    // The panel follows the mesh.
    session.send(b"z");
    session.wait_for_text("up         x");
    session.wait_for_text("size       1 x 1 x 2");
    // The second press comes before the mesh is shown turned by the first.
    session.send(b"zz");
    session.wait_for_text("up         -z");
    leave(&mut session);
    let mut scene = looking(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/ball.ron"), &[]);
    scene.send(b"z");
    scene.wait_for_text("only a mesh that is opened");
    leave(&mut scene);
}

#[test]
fn wireframe_axes_and_metadata_come_and_go() {
    let mut session = start(Path::new(TEAPOT));
    session.send(b"#");
    session.wait_for_text("wire: edges of triangles");
    session.send(b"#");
    wait_for_no(&mut session, "wire: edges");
    session.send(b"X");
    session.wait_for("the axes", SOON, |seen| {
        let rows = seen.screen().text();
        let corner: String = rows[..7].iter().flat_map(|row| row.chars().skip(65)).collect();
        ["x", "y", "z"].iter().all(|axis| corner.contains(axis))
    });
    session.send(b"X");
    session.wait_for("no axes", SOON, |seen| !seen.screen().text()[..7].concat().contains('x'));
    session.send(b"M");
    session.wait_for_text("teapot.obj");
    session.wait_for_text("format     OBJ");
    session.wait_for_text("triangles  ");
    session.send(b"M");
    wait_for_no(&mut session, "format");
    leave(&mut session);
}

#[test]
fn function_keys_look_from_the_front_the_right_and_above() {
    for (key, direction) in [(&b"\x1b[15~"[..], Vec3::Z), (b"\x1b[17~", Vec3::X), (b"\x1b[18~", Vec3::Y)] {
        let mut session = looking(TEAPOT, &[]);
        session.send(key);
        session.wait_for_rest();
        let pose = camera(&mut session).expect("it was moved").pose();
        let found = (pose.eye - pose.target).normalize();
        assert!(found.dot(direction) > 0.999, "{found} is not {direction}");
    }
}

const TWO: &str = "(camera: (eye: (0, 1, 8), target: (0, 1, 0)), background: \"navy\", ambient: 0.2,
    lights: [Point(position: (3, 4, 5), intensity: 40)],
    objects: [
        Sphere(center: (-2, 1, 0), radius: 1), Sphere(center: (2, 1, 0), radius: 0.5),
        Plane(point: (0, 0, 0), normal: (0, 1, 0)),
    ])";

/// Returns the cell of a point of the scene on a screen of 40x12 cells.
fn cell_of(camera: &Camera, point: Vec3) -> [u16; 2] {
    let at = camera.project(point, 40.0 / 24.0).expect("in front");
    [(at.x * 40.0) as u16, (at.y * 12.0) as u16]
}

fn click(at: [u16; 2]) -> String {
    report(0, at, 'M') + &report(0, at, 'm')
}

#[test]
fn a_click_sets_the_centre_of_the_orbit_and_a_double_click_frames_the_object() {
    let folder = folder(&[("two.ron", TWO)]);
    let path = folder.path().join("two.ron");
    let path = path.to_str().expect("UTF-8");
    let scene = load(path);
    let at = cell_of(scene.camera(), Vec3::new(2.0, 1.0, 0.5));

    // In flight a click does nothing.
    let mut session = looking(path, &[]);
    session.send(click(at).as_bytes());
    session.wait_for_rest();
    assert_eq!(camera(&mut session), None);

    let mut session = looking(path, &[]);
    session.send(b"\t");
    session.wait_for_text("orbit");
    session.send(click(at).as_bytes());
    session.wait_for_rest();
    let found = camera(&mut session).expect("it was moved");
    let target = found.pose().target;
    assert!((target.distance(Vec3::new(2.0, 1.0, 0.0)) - 0.5).abs() < 0.01, "{target} is on the sphere");
    assert!(found.basis().w.abs_diff_eq(scene.camera().basis().w, 5e-4), "it looks the same way");

    let mut session = looking(path, &[]);
    session.send((click(at) + &click(at)).as_bytes());
    session.wait_for_rest();
    let target = camera(&mut session).expect("it was moved").pose().target;
    assert!(target.abs_diff_eq(Vec3::new(2.0, 1.0, 0.0), 1e-3), "{target} is the small sphere's centre");

    // On the sky: everything.
    let mut session = looking(path, &[]);
    session.send(click([20, 0]).repeat(2).as_bytes());
    session.wait_for_rest();
    let target = camera(&mut session).expect("it was moved").pose().target;
    assert!(target.abs_diff_eq(Vec3::new(-0.25, 1.0, 0.0), 1e-3), "{target} is the middle of both");
}

#[test]
fn a_scene_is_written_around_a_mesh_and_never_over_a_file() {
    let folder = folder(&[("a.obj", SOLID), ("a.ron", "mine")]);
    let path = folder.path().join("a.obj");
    let mut session = start(&path);
    session.send(b"Y");
    session.wait_for_text("write a scene with this mesh and view?");
    session.send(b"n");
    wait_for_no(&mut session, "write a scene");
    assert!(!folder.path().join("a-2.ron").exists(), "only after a yes");
    session.send(b"Y");
    session.wait_for_text("write a scene with this mesh and view?");
    session.wait_for_text("a-2.ron");
    session.send(b"y");
    session.wait_for_text("a-2.ron");
    session.wait_for("the file", SOON, |_| folder.path().join("a-2.ron").exists());
    leave(&mut session);
    assert_eq!(fs::read_to_string(folder.path().join("a.ron")).expect("it is there"), "mine");
    let (written, mesh) =
        (Scene::load(&folder.path().join("a-2.ron")).expect("a scene"), load(path.to_str().expect("UTF-8")));
    assert_eq!(*written.camera(), mesh.camera().rounded());
    assert_eq!((written.lights(), written.ambient()), (mesh.lights(), mesh.ambient()));
    assert_eq!(written.objects(), mesh.objects());
    assert_eq!(written.background(), mesh.background());
}
