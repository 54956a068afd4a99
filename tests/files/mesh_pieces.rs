//! Files that are read in pieces.
//!
//! The size of the pieces and the number of threads change neither the mesh nor what is told of it.

use crate::mesh_writers::{WRITERS, ball, written};
use std::fmt::Write;
use std::path::Path;
use std::sync::Mutex;
use termtrace::internals::mesh_file::MeshFile;
use termtrace::internals::progress::Reporter;

/// Numbers from a seed (an LCG with Knuth's multiplier).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    fn of<'s>(&mut self, items: &[&'s str]) -> &'s str {
        items[self.below(items.len())]
    }
}

/// A way of reading: in pieces of some bytes, on all threads or on one, with notices or without.
#[derive(Clone, Copy, Debug)]
struct Reading {
    piece: usize,
    is_parallel: bool,
    takes_notices: bool,
}

/// Returns everything that is told and drawn of a file.
fn account(name: &str, bytes: &[u8], reading: Reading) -> String {
    let notices = Mutex::new(String::new());
    let on_notice = |notice: String| *notices.lock().unwrap() += &(notice + "\n");
    let mut reporter = Reporter::silent().in_pieces_of(reading.piece);
    if reading.takes_notices {
        reporter = reporter.with_warnings(&on_notice);
    }
    if !reading.is_parallel {
        reporter = reporter.on_this_thread();
    }
    let mut open = |_: &Path| Ok(b"newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n".to_vec());
    let read = MeshFile::parse(name, None, bytes, &mut open, &reporter);
    let mut text = notices.into_inner().unwrap();
    match read {
        Err(error) => text += &error.to_string(),
        Ok(mesh) => {
            write!(text, "{:?} {:?}", mesh.positions(), mesh.materials()).unwrap();
            for triangle in 0..mesh.triangles().len() {
                let corners = mesh.triangles()[triangle];
                let attributes = (mesh.normals_of(triangle), mesh.texture_coordinates_of(triangle));
                let colors = (mesh.colors_of(triangle), mesh.material_of(triangle));
                write!(text, "\n{corners:?} {attributes:?} {colors:?}").unwrap();
            }
        }
    }
    text
}

/// Asserts that the file is read alike in pieces of any size.
#[track_caller]
fn assert_alike(name: &str, bytes: &[u8], random: &mut Random, about: &str) {
    for takes_notices in [true, false] {
        let whole = account(name, bytes, Reading { piece: usize::MAX, is_parallel: true, takes_notices });
        for is_parallel in [true, false] {
            for most in [4, 40, 400] {
                let reading = Reading { piece: 1 + random.below(most), is_parallel, takes_notices };
                let read = account(name, bytes, reading);
                assert!(read == whole, "{about}, {reading:?}\n{whole}\n{read}\n{}", String::from_utf8_lossy(bytes));
            }
        }
    }
}

/// Returns an OBJ file with all that depends on what comes before, and with faults.
fn obj(random: &mut Random) -> String {
    let mut text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\n".to_owned();
    for _ in 0..10 + random.below(60) {
        let (a, b, c, d) = (random.below(9), random.below(9), random.below(9), random.below(12));
        let line = match random.below(22) {
            0..4 => format!("v {a} {b} {c}"),
            4 => format!("v {a} {b} {c} 0.{a} 0.{b} 0.{c}"),
            5 => format!("vn {a} {b} 1"),
            6 => format!("vt 0.{a} 0.{b}"),
            7..10 => "f -1 -2 -3".to_owned(),
            10 => format!("f {} 2 3", d + 1),
            11 => "f 1 2 3 -1".to_owned(),
            12 => "f 1/1/1 2/-1/1 3/1/-1".to_owned(),
            13 => "f 1 \\\n 2 \\\r\n3".to_owned(),
            14 => "v 1 2 \\\n 3".to_owned(),
            15 => format!("usemtl {}", random.of(&["a", "b", "None"])),
            16 => random.of(&["g x\\", "# v 1 2 3 \\", "o x", "s 1", "", "  # x", "curv 1"]).to_owned(),
            17 => "l 1 2 -1".to_owned(),
            18 => "l 1 \\\nv 2".to_owned(),
            19 => "v 1 2 nan # x \\".to_owned(),
            20 => random.of(&["f 1 2", "v 1 2", "foo", "f 1 2 x", "vn 1", "f 1/1 2 3"]).to_owned(),
            _ => "\tv 1 2 3\t".to_owned(),
        };
        text += &line;
        text += random.of(&["\n", "\r\n", "\n", "\r", "\n\n"]);
    }
    text
}

/// Returns a text STL file with faults.
fn stl(random: &mut Random) -> String {
    let mut text = "solid x\n".to_owned();
    for _ in 0..2 + random.below(20) {
        let mut facet = "facet normal 0 0 1\n outer loop\n".to_owned();
        for _ in 0..3 + random.below(3) / 2 {
            writeln!(facet, "  vertex {} {} {}", random.below(9), random.below(9), random.below(9)).unwrap();
        }
        facet += " endloop\nendfacet\n";
        if random.below(6) == 0 {
            let (from, to) =
                [(" endloop\n", ""), ("vertex", "vortex"), (" outer loop\n", ""), ("loop", "loop \\")][random.below(4)];
            facet = facet.replacen(from, to, 1);
        }
        text += &if random.below(4) == 0 { facet.replace('\n', "\r\n") } else { facet };
    }
    text + "endsolid x\n"
}

/// Returns a PLY file as text, with faults.
fn ply(random: &mut Random) -> String {
    let (vertices, faces, edges) = (3 + random.below(20), 1 + random.below(20), random.below(5));
    let has_face_colors = random.below(2) == 0;
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float nx\nproperty float ny\n\
         property float nz\nelement other 2\nproperty int a\nelement face {faces}\n\
         property list uchar int vertex_indices\n{}element edge {edges}\nproperty int vertex1\nproperty int vertex2\n\
         end_header\n",
        if has_face_colors { "property uchar red\nproperty uchar green\nproperty uchar blue\n" } else { "" }
    );
    for row in 0..vertices + 2 + faces + edges {
        let (a, b, c) = (random.below(vertices + 1), random.below(vertices), random.below(vertices));
        let color = if has_face_colors { " 255 0 0" } else { "" };
        let line = match row {
            _ if row < vertices => format!("{a} {b} {c} {a} {b} {c} 0 0 1"),
            _ if row < vertices + 2 => "7".to_owned(),
            _ if row < vertices + 2 + faces && a % 3 == 0 => format!("4 {a} {b} {c} 0{color}"),
            _ if row < vertices + 2 + faces => format!("3 {a} {b} {c}{color}"),
            _ => format!("{b} {c}"),
        };
        text += if random.below(40) == 0 { "nan" } else { &line };
        let may_continue = random.below(30) == 0;
        text += random.of(if may_continue { &["\n", " \\\n"] } else { &["\n", "\r\n", "\r"] });
    }
    text
}

#[test]
fn a_text_in_pieces_is_read_as_a_whole_one() {
    for seed in 0..150 {
        let random = &mut Random(seed);
        for (name, text) in [("x.obj", obj(random)), ("x.stl", stl(random)), ("x.ply", ply(random))] {
            assert_alike(name, text.as_bytes(), random, &format!("seed {seed}, {name}"));
        }
    }
}

/// A face that begins within a facet makes the reader of text STL files start anew.
#[test]
fn a_loop_that_does_not_end_is_told_however_the_text_is_cut() {
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let text = ["solid x\n", facet, &facet.replace("endloop\n", ""), facet, facet, "endsolid x\n"].concat();
    let reading = Reading { piece: 100, is_parallel: true, takes_notices: false };
    let read = account("x.stl", text.as_bytes(), reading);
    assert_eq!(read, "x.stl:14:1: expected vertex or endloop, found \"endfacet\"");
    assert_alike("x.stl", text.as_bytes(), &mut Random(0), "an open loop");
}

#[test]
fn a_written_ball_in_pieces_is_read_as_a_whole_one() {
    let mesh = ball(300);
    for writer in WRITERS {
        let bytes = written(&mesh, writer.name);
        assert_alike(writer.name, &bytes, &mut Random(bytes.len() as u64), writer.name);
    }
}

/// Valid files and others, as they are in the folders of meshes.
#[test]
fn every_mesh_of_the_tests_in_pieces_is_read_as_a_whole_one() {
    let mut count = 0;
    for folder in ["tests/meshes", "tests/odd_meshes", "tests/invalid_meshes"] {
        for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if [".obj", ".stl", ".ply"].iter().any(|ending| name.ends_with(ending)) {
                count += 1;
                assert_alike(name, &std::fs::read(&path).unwrap(), &mut Random(count), name);
            }
        }
    }
    assert!(count > 100, "{count}");
}
