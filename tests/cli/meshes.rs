//! Mesh files by themselves: their upright axis, their colours, and what they name and is missing.

use super::Folder;

/// A bowl with z up: open at the top, and flat below, at z = 0.
const BOWL: &str = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv -1 -1 3\nv 3 -1 3\nv 3 3 3\nv -1 3 3\n\
                     f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// Returns the mesh as a text STL file.
fn stl(obj: &str) -> String {
    let vertices: Vec<&str> = obj.lines().filter_map(|line| line.strip_prefix("v ")).collect();
    let faces = obj.lines().filter_map(|line| line.strip_prefix("f "));
    let mut text = "solid bowl\n".to_owned();
    for face in faces {
        let corners: Vec<usize> = face.split(' ').map(|corner| corner.parse().expect("an index")).collect();
        for pair in corners[1..].windows(2) {
            text += "facet normal 0 0 0\nouter loop\n";
            for corner in [corners[0], pair[0], pair[1]] {
                text.extend(["vertex ", vertices[corner - 1], "\n"]);
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid bowl\n"
}

#[test]
fn a_mesh_is_turned_by_a_flag_or_by_a_guess_that_is_announced() {
    let folder = Folder::new();
    folder.write("bowl.obj", BOWL);
    folder.write("bowl.stl", stl(BOWL));
    let upright = folder.frame("bowl.obj --mesh-up z");
    assert_ne!(upright, folder.frame("bowl.obj"), "OBJ means y");
    assert_eq!(upright, folder.frame("bowl.stl --mesh-up z"));
    let guessed = folder.run("frame bowl.stl");
    assert_eq!((guessed.code, guessed.stdout == upright), (Some(0), true));
    let notice = "warning: bowl.stl: z is taken for up in this STL; --mesh-up y (or another axis) says \
                  otherwise\n";
    assert_eq!(guessed.stderr, notice);
    // Turned back to y, with the same z for right.
    assert_eq!(folder.frame("bowl.stl --mesh-up y"), folder.frame("bowl.obj"));
    assert_ne!(folder.frame("bowl.obj --mesh-up -z"), upright);
    folder.run("frame ball.ron --mesh-up z").fails_in_a_line(2, "ball.ron: --mesh-up turns a mesh file");
    folder.run("frame bowl.obj --mesh-up w").is_misused("possible values: y, z, x, -y, -z, -x");
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";

#[test]
fn missing_materials_and_textures_are_warnings_except_in_check_and_with_strict() {
    let folder = Folder::new();
    folder.write("plain.obj", TRIANGLE);
    let named = format!("mtllib a.mtl\nusemtl red\n{TRIANGLE}");
    folder.write("named.obj", &named);
    let run = folder.run("frame named.obj");
    assert_eq!(run.stderr, "warning: named.obj: materials missing: a.mtl\n");
    assert_eq!(run.stdout, folder.frame("plain.obj"), "clay");
    let error = "named.obj:1:8: the materials are missing: \"a.mtl\": there is no such file";
    folder.run("check named.obj").fails_in_a_line(2, error);
    folder.run("frame named.obj --strict").fails_in_a_line(2, error);

    // Each texture is named once, however many materials have it; the other colours stay.
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\nmap_Kd a.png\nnewmtl blue\nmap_Kd a.png\n");
    let run = folder.run("frame named.obj --format ansi");
    assert_eq!(run.stderr, "warning: named.obj: texture missing: a.png\n");
    folder.run("check named.obj").fails_in_a_line(2, "the texture is missing: \"a.png\"");
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    assert_eq!(run.stdout, folder.frame("named.obj --format ansi"));

    // A scene with such a mesh, too.
    folder.write("a.mtl", "newmtl red\nmap_Kd a.png\n");
    let scene = r#"(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, objects: [Mesh(path: "named.obj")])"#;
    folder.write("scene.ron", scene);
    let run = folder.run("describe scene.ron");
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), "warning: named.obj: texture missing: a.png\n"));
    folder.run("check scene.ron").fails(2, "the texture is missing: \"a.png\"");
}

#[test]
fn what_is_left_out_of_a_mesh_is_told_by_every_command() {
    let folder = Folder::new();
    folder.write("odd.obj", format!("{TRIANGLE}f 1 1 2\ncurv 0 1 1 2\nf 1 2\n"));
    folder.write("plain.obj", TRIANGLE);
    let notices = "warning: odd.obj:8:1: a face has at least 3 corners; this one has 2 (ignored)\n\
                   warning: odd.obj: not shown: 1 curve\n";
    for command in ["frame", "frame --strict", "describe", "check"] {
        let run = folder.run(&format!("{command} odd.obj"));
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), notices), "{command}");
    }
    assert_eq!(folder.run("frame odd.obj").stdout, folder.frame("plain.obj"));
    let checked = String::from_utf8(folder.run("check odd.obj").stdout).expect("UTF-8");
    assert!(
        checked.ends_with("OK (2 objects, 3 lights), but object 1: 1 of its 2 triangles has no area\n"),
        "{checked}"
    );
}

#[test]
fn a_mesh_that_moves_is_described_with_the_length_of_its_animation() {
    let folder = Folder::new();
    let rising = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/odd_meshes/s4_rise.gltf")).expect("a file");
    folder.write("rise.gltf", rising);
    folder.write("plain.obj", TRIANGLE);
    assert!(folder.run("describe rise.gltf").text().contains(", which moves in an animation of 2 s: "));
    assert!(!folder.run("describe plain.obj").text().contains("moves"));
}

#[test]
fn a_missing_buffer_of_key_frames_is_a_warning_but_an_error_of_check() {
    let folder = Folder::new();
    let gone = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/odd_meshes/s4_gone.gltf");
    let gone = std::fs::read_to_string(gone).expect("a file");
    // The channel with another fault is played.
    folder.write("gone.gltf", gone.replace("BEZIER", "LINEAR"));
    let missing = "gone.gltf: buffers[1].uri: \"gone.bin\": there is no such file";
    let run = folder.run("frame gone.gltf");
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stderr.contains(&format!("warning: {missing} (this channel is not played)\n")), "{}", run.stderr);
    folder.run("frame gone.gltf --strict").fails_in_a_line(2, missing);
    folder.run("check gone.gltf").fails(2, missing);
}

/// A message may leave out folders, but not the name of the file.
#[test]
fn the_name_of_a_missing_file_is_told_however_long_its_folder_is() {
    let folder = Folder::new();
    let long = "folder_with_a_long_name/".repeat(4);
    std::fs::create_dir_all(folder.path(&long)).expect("a folder");
    folder.write(&format!("{long}x.obj"), format!("mtllib the_missing_one.mtl\n{TRIANGLE}"));
    folder.run(&format!("check {long}x.obj")).fails_in_a_line(2, "/the_missing_one.mtl\": there is no such file");
}

#[test]
fn a_binary_stl_file_without_an_ending_in_its_name_is_recognised() {
    let folder = Folder::new();
    let number = |x: f32| x.to_le_bytes();
    let facet = [[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]].concat().into_iter().flat_map(number);
    let bytes: Vec<u8> = [0; 80].into_iter().chain(1_u32.to_le_bytes()).chain(facet).chain([0, 0]).collect();
    folder.write("part", &bytes);
    folder.write("part.stl", &bytes);
    assert_eq!(folder.frame("part --mesh-up y"), folder.frame("part.stl --mesh-up y"));
}

#[test]
fn a_missing_picture_of_a_gltf_file_is_a_warning_but_not_a_missing_buffer() {
    let folder = Folder::new();
    let positions = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let document = |buffer: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "buffers": [{{"uri": "{buffer}", "byteLength": 36}}],
            "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}],
            "textures": [{{"source": 0}}], "images": [{{"uri": "a.png"}}]}}"#
        )
    };
    folder.write("a.gltf", document(positions));
    let run = folder.run("frame a.gltf");
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), "warning: a.gltf: texture missing: a.png\n"));
    folder.run("check a.gltf").fails_in_a_line(2, "\"a.png\": there is no such file");
    folder.write("b.gltf", document("b.bin"));
    folder.run("frame b.gltf --strict").fails_in_a_line(2, "\"a.png\": there is no such file");
    let run = folder.run("frame b.gltf");
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.ends_with("\"b.bin\": there is no such file\n"), "{run:?}");
}

/// Far away the floor of a mesh is as bright as the background, without a band at the horizon.
#[test]
fn the_floor_of_a_mesh_melts_into_the_background() {
    use termtrace::glam::Vec3;
    use termtrace::{Pose, Render, Resolution, Scene, tone};
    let scene = Scene::load(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/teapot.obj").as_ref()).expect("a scene");
    // Level with the floor's horizon, and away from the mesh.
    let pose = scene.camera().pose();
    let away = pose.eye + (pose.eye - pose.target);
    let target = Vec3::new(away.x, pose.eye.y, away.z);
    let level = scene.camera().with_pose(Pose { target, ..pose }).expect("a camera");
    let scene = scene.with_camera(level);
    let light = Render::new(&scene).resolution(Resolution::new(9, 201).expect("a size")).run().expect("a picture");
    let picture = tone(&light, &scene);
    let column: Vec<i32> = (0..201).map(|y| i32::from(picture.pixels()[y * 9 + 4].g)).collect();
    let steps = column.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let widest = steps.skip(60).take(60).max().expect("rows");
    assert!(widest <= 3, "a step of {widest} levels near the horizon: {column:?}");
    assert!(column[95..110].iter().all(|&level| level > 20), "black at the horizon: {column:?}");
}
