//! Meshes as read, compared with their meaning.
//!
//! `tests/meshes/` describes two shapes in every format and variety: a tetrahedron, and a square with a normal,
//! colours, texture coordinates and a material.

use glam::{Vec2, Vec3};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use termtrace::internals::mesh_file::{FilePosition, MeshFile};
use termtrace::{LinearRgb, Srgb8};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes")
}

/// Returns the meshes of that shape: files with its name and a format's extension.
fn meshes_of(shape: &str) -> Vec<(String, MeshFile)> {
    let mut paths: Vec<_> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let is_mesh = |path: &&PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy();
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        name.starts_with(shape) && ["obj", "stl", "ply", "gltf", "glb"].contains(&&*ending)
    };
    let read = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, MeshFile::load(path).unwrap_or_else(|error| panic!("{error}")))
    };
    paths.iter().filter(is_mesh).map(read).collect()
}

/// Refuses to read: a mesh that names no other file may not ask for one.
fn alone(path: &Path) -> io::Result<Vec<u8>> {
    panic!("{} was asked for", path.display())
}

fn read(name: &str, text: &str) -> MeshFile {
    MeshFile::from_bytes(name, text.as_bytes(), &mut alone).unwrap_or_else(|error| panic!("{error}"))
}

/// Reads a text that may name the given files.
fn read_with(name: &str, text: &str, files: &[(&str, &[u8])]) -> Result<MeshFile, String> {
    let mut open = |path: &Path| {
        let found = files.iter().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))
    };
    MeshFile::from_bytes(name, text.as_bytes(), &mut open).map_err(|error| error.to_string())
}

/// Returns the corners of each triangle, the least first, in thousandths.
fn corners(mesh: &MeshFile) -> Vec<[[i32; 3]; 3]> {
    let corner = |index: u32| mesh.positions()[index as usize].to_array().map(|x| (x * 1e3).round() as i32);
    let mut triangles: Vec<_> = mesh.triangles().iter().map(|triangle| triangle.map(corner)).collect();
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&i| triangle[i]).unwrap();
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    triangles
}

#[test]
fn every_tetrahedron_is_the_same() {
    let [o, x, y, z] = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::Y, 3.0 * Vec3::Z];
    let meant = MeshFile::new(vec![o, x, y, z], vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
    let meshes = meshes_of("tetrahedron");
    assert!(meshes.len() >= 20, "{}", meshes.len());
    for (name, mesh) in meshes {
        assert_eq!(corners(&mesh), corners(&meant), "{name}");
        for triangle in 0..4 {
            assert_eq!(mesh.normals_of(triangle), None, "{name}");
            assert_eq!(mesh.colors_of(triangle), None, "{name}");
            assert_eq!(mesh.texture_coordinates_of(triangle), None, "{name}");
            assert_eq!(mesh.material_of(triangle), None, "{name}");
        }
        assert_eq!(mesh.normals_of(4), None, "{name}");
    }
}

#[test]
fn every_square_has_all_attributes_of_its_format() {
    let colors = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 1.0, 1.0)];
    let meshes = meshes_of("square");
    assert!(meshes.len() >= 5, "{}", meshes.len());
    for (name, mesh) in meshes {
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]], "{name}");
        for (i, triangle) in mesh.triangles().iter().enumerate() {
            let positions = triangle.map(|index| mesh.positions()[index as usize]);
            assert_eq!(mesh.normals_of(i), Some([Vec3::Z; 3]), "{name}");
            let meant = triangle.map(|index| colors[index as usize]).map(|(r, g, b)| LinearRgb::new(r, g, b));
            assert_eq!(mesh.colors_of(i), Some(meant), "{name}");
            if !name.contains(".ply") {
                let meant = positions.map(|p| Vec2::new(p.x, 1.0 - p.y));
                assert_eq!(mesh.texture_coordinates_of(i), Some(meant), "{name}");
                let material = &mesh.materials()[mesh.material_of(i).unwrap()];
                assert_eq!(material.reflectance, LinearRgb::new(0.5, 0.25, 0.125), "{name}");
                let placement = material.texture.as_ref().unwrap();
                assert_eq!(placement.at(Vec2::new(0.25, 0.5)), Vec2::new(0.25, 0.5), "{name}");
                let texels = [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)];
                assert_eq!(placement.texture.texels(), texels.map(|(r, g, b)| Srgb8::new(r, g, b)), "{name}");
                assert_eq!((placement.texture.width(), placement.texture.height()), (2, 2), "{name}");
            }
        }
    }
}

/// Colours between black and white: sRGB in PLY and OBJ, linear in glTF.
#[test]
fn colors_of_vertices_become_linear_light() {
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let tail = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let middle = LinearRgb::from_srgb8(Srgb8::new(128, 64, 32));
    for (kind, rgb) in
        [("uchar", "128 64 32"), ("float", "0.50196078 0.25098039 0.12549020"), ("ushort", "32896 16448 8224")]
    {
        let properties = ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat();
        let text = format!("{head}{properties}{tail}{}3 0 1 2\n", format!("1 2 3 {rgb}\n").repeat(3));
        let found = read("x.ply", &text).colors_of(0).unwrap()[2];
        let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
        assert!(near(found.r, middle.r) && near(found.g, middle.g) && near(found.b, middle.b), "{kind} {found:?}");
    }
    let obj = read("x.obj", "v 0 0 0 0.5019608 0 0\nv 1 0 0 -7 0 1e9\nv 0 1 0\nf 1 2 3\n");
    let colors = obj.colors_of(0).unwrap();
    assert!((colors[0].r - middle.r).abs() < 1e-6);
    assert_eq!(colors[1..], [LinearRgb::new(0.0, 0.0, 1.0), LinearRgb::grey(1.0)]);
}

/// The three indices of a corner in OBJ are independent.
#[test]
fn corners_of_obj_have_indices_of_their_own() {
    let mesh = read(
        "x.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 3\nvn 0 4 0\nvn 0 0 0\nvt 0.25 0.25\nvt 0.5\n\
         f 1 2 3\nf 1//1 2//2 3//-3\nf 1/1 2/2 3/-2\nf 1/1/1 2/1/1 3/1/3\n",
    );
    let (a, b) = (Vec2::new(0.25, 0.75), Vec2::new(0.5, 1.0));
    let found: Vec<_> = (0..4).map(|i| (mesh.normals_of(i), mesh.texture_coordinates_of(i))).collect();
    // The last triangle has a normal without length.
    let meant =
        [(None, None), (Some([Vec3::Z, Vec3::Y, Vec3::Z]), None), (None, Some([a, b, a])), (None, Some([a; 3]))];
    assert_eq!(found, meant);
}

#[test]
fn materials_change_between_triangles() {
    let mtl = "newmtl a\nKd 0.5\nnewmtl b b\nKd 2 -1 0.25\n\nnewmtl c\nillum 2\n";
    let face = "f 1 2 3\n";
    let text = format!(
        "mtllib my colours.MTL other.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n\
         {face}usemtl a\n{face}{face}usemtl b b\nusemtl c\n{face}usemtl d\n{face}usemtl None\n{face}usemtl a\n"
    );
    let files: [(&str, &[u8]); 2] = [("my colours.MTL", mtl.as_bytes()), ("other.mtl", b"newmtl d")];
    let mesh = read_with("x.obj", &text, &files).unwrap();
    let found: Vec<_> = (0..mesh.triangles().len()).map(|i| mesh.material_of(i)).collect();
    assert_eq!(found, [None, Some(0), Some(0), Some(2), Some(3), None]);
    let reflectances: Vec<_> = mesh.materials().iter().map(|material| material.reflectance).collect();
    let meant = [LinearRgb::grey(0.5), LinearRgb::new(1.0, 0.0, 0.25), LinearRgb::grey(0.8), LinearRgb::grey(0.8)];
    assert_eq!(reflectances, meant);
    // A model that came without its MTL file's name.
    assert_eq!(read("x.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl x\nf 1 2 3\n").material_of(0), None);
}

/// A texture is read once, by the path that the MTL file means, and may be scaled and moved.
#[test]
fn textures_are_found_beside_the_file_that_names_them() {
    let png = std::fs::read(folder().join("square.png")).unwrap();
    let mtl = "newmtl a\nmap_Kd -s 2 4 1 -o 0.5 0.25 t\\wood floor.png\nnewmtl b\nmap_Kd t/wood floor.png\n";
    let obj = "mtllib sub/x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    let files: [(&str, &[u8]); 2] = [("sub/x.mtl", mtl.as_bytes()), ("sub/t/wood floor.png", &png)];
    let asked = Mutex::new(Vec::new());
    let mesh = MeshFile::from_bytes("models/x.obj", obj.as_bytes(), &mut |path| {
        asked.lock().unwrap().push(path.to_owned());
        Ok(files.iter().find(|(name, _)| Path::new(name) == path).unwrap().1.to_vec())
    });
    let mesh = mesh.unwrap();
    assert_eq!(*asked.lock().unwrap(), [Path::new("sub/x.mtl"), Path::new("sub/t/wood floor.png")]);
    let [a, b] = [0, 1].map(|i| mesh.materials()[i].clone());
    assert_eq!((a.reflectance, b.reflectance), (LinearRgb::grey(1.0), LinearRgb::grey(1.0)));
    // v = 1 is the picture's top row in OBJ: 4 * 1 + 0.25 is a quarter above it.
    assert_eq!(a.texture.unwrap().at(Vec2::new(0.25, 0.0)), Vec2::new(1.0, -3.25));
    assert_eq!(b.texture.unwrap().at(Vec2::new(0.25, 0.0)), Vec2::new(0.25, 0.0));
}

/// JPEG is lossy, and the same on all machines.
#[test]
fn jpeg_textures_are_read() {
    let jpeg = std::fs::read(folder().join("grey_to_red.jpg")).unwrap();
    let obj = "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    let mesh = read_with("x.obj", obj, &[("x.mtl", b"newmtl a\nmap_Kd a.jpg"), ("a.jpg", &jpeg)]).unwrap();
    let texture = mesh.materials()[0].texture.as_ref().unwrap().texture.clone();
    assert_eq!((texture.width(), texture.height()), (16, 8));
    let near =
        |color: Srgb8, meant: [u8; 3]| [color.r, color.g, color.b].iter().zip(meant).all(|(a, b)| a.abs_diff(b) < 8);
    assert!(near(texture.texels()[0], [128, 128, 128]), "{:?}", texture.texels()[0]);
    assert!(near(texture.texels()[15], [220, 20, 30]), "{:?}", texture.texels()[15]);
}

#[test]
fn truncated_textures_are_errors() {
    let obj = "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    for name in ["grey_to_red.jpg", "square.png"] {
        let bytes = std::fs::read(folder().join(name)).unwrap();
        for length in [10, bytes.len() / 2, bytes.len() * 9 / 10] {
            let mtl = b"newmtl a\nmap_Kd a";
            let error = read_with("x.obj", obj, &[("x.mtl", mtl), ("a", &bytes[..length])]).unwrap_err();
            assert!(error.starts_with("x.mtl:2:8: \"a\" is a "), "{error}");
        }
    }
    // 65520 x 248 pixels in 200 bytes.
    let mut jpeg = std::fs::read(folder().join("grey_to_red.jpg")).unwrap();
    let size = jpeg.windows(4).position(|bytes| bytes == [0, 8, 0, 16]).expect("height and width");
    jpeg[size..size + 4].copy_from_slice(&[0, 248, 255, 240]);
    let error = read_with("x.obj", obj, &[("x.mtl", b"newmtl a\nmap_Kd a"), ("a", &jpeg)]).unwrap_err();
    assert!(error.ends_with("is a JPEG picture that is cut short"), "{error}");
}

/// A child is in its parent's coordinates, not the other way round.
#[test]
fn gltf_nodes_are_relative_to_their_parents() {
    let document = std::fs::read_to_string(folder().join("tetrahedron_data.gltf")).unwrap();
    let nodes = r#"[{"children":[1],"scale":[2,2,2],"rotation":[0,0,1,1]},{"mesh":0,"translation":[1,0,0]}]"#;
    let mesh = read("x.gltf", &document.replacen(r#"[{"mesh": 0}]"#, nodes, 1));
    assert!(mesh.positions()[0].abs_diff_eq(Vec3::new(0.0, 2.0, 0.0), 1e-6), "{}", mesh.positions()[0]);
    assert!(mesh.positions()[1].abs_diff_eq(Vec3::new(0.0, 4.0, 0.0), 1e-6), "{}", mesh.positions()[1]);
}

/// The primitives of a glTF mesh share their vertices, with any other attributes.
#[test]
fn vertices_that_primitives_share_are_kept_once() {
    let mut document = std::fs::read_to_string(folder().join("square.gltf")).unwrap();
    let primitive = r#"{"attributes": {"POSITION": 0}, "indices": 4},"#;
    document = document.replacen(r#""primitives": ["#, &format!(r#""primitives": [ {primitive} {primitive}"#), 1);
    let png = std::fs::read(folder().join("square.png")).unwrap();
    let mesh = read_with("x.gltf", &document, &[("square.png", &png)]).unwrap();
    assert_eq!((mesh.positions().len(), mesh.triangles().len()), (4, 6));
    let found: Vec<_> = (0..6).map(|i| (mesh.normals_of(i).is_some(), mesh.material_of(i))).collect();
    assert_eq!(found, [[(false, None); 4].as_slice(), &[(true, Some(1)); 2]].concat());
}

/// Normals stay perpendicular to stretched surfaces, and mirrored ones point outwards.
#[test]
fn normals_of_gltf_are_turned_with_their_node() {
    let document = std::fs::read_to_string(folder().join("square.gltf")).unwrap();
    let png = std::fs::read(folder().join("square.png")).unwrap();
    for (node, normal) in [
        (r#""scale": [1, 1, -2]"#, -Vec3::Z),
        (r#""scale": [3, 2, 1]"#, Vec3::Z),
        (r#""scale": [1, 1, 0]"#, Vec3::Z),
        (r#""rotation": [1, 0, 0, 1]"#, -Vec3::Y),
        (r#""matrix": [1,0,1,0, 0,1,0,0, 0,0,1,0, 5,5,5,1]"#, Vec3::new(-1.0, 0.0, 1.0).normalize()),
    ] {
        let text = document.replacen(r#""mesh": 0"#, &format!(r#""mesh": 0, {node}"#), 1);
        let mesh = read_with("x.gltf", &text, &[("square.png", &png)]).unwrap();
        let found = mesh.normals_of(0).unwrap()[0];
        assert!(found.abs_diff_eq(normal, 1e-6), "{node} {found}");
        let [a, b, c] = mesh.triangles()[0].map(|index| mesh.positions()[index as usize]);
        assert!((b - a).cross(c - a).normalize().dot(normal) > 0.999, "{node}: the triangle goes round the other way");
    }
}

/// A tree of any depth costs no stack.
#[test]
fn nodes_may_be_deep() {
    let count = 100_000;
    let nodes: Vec<_> =
        (1..count).map(|i| format!(r#"{{"children":[{i}]}}"#)).chain([r#"{"mesh":0}"#.into()]).collect();
    let document = std::fs::read_to_string(folder().join("tetrahedron_data.gltf")).unwrap();
    let text = document.replacen(r#"[{"mesh": 0}]"#, &format!("[{}]", nodes.join(",")), 1);
    assert!(text.len() > 1_000_000);
    assert_eq!(read("x.gltf", &text).triangles().len(), 4);
}

/// A document of many small values, each of which takes many times its text, is limited, too.
#[test]
fn values_of_json_are_limited() {
    let start = r#"{"asset":{"version":"2.0"},"extras":["#;
    for (value, count) in [("{}", 1 << 20), ("0", 16 << 20)] {
        let text = format!("{start}{}]}}", vec![value; count].join(","));
        assert!(read_with("x.gltf", &text, &[]).unwrap_err().contains("too many to be read"));
    }
}

/// A small file cannot fill the memory by showing one mesh again and again.
#[test]
fn repeated_meshes_are_limited() {
    let positions = vec![0_u8; 12 * 3 * 40_000];
    let mut json = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":["#.to_owned();
    json += &(0..60).map(|i| i.to_string()).collect::<Vec<_>>().join(",");
    json += r#"]}],"nodes":["#;
    json += &vec![r#"{"mesh":0}"#; 60].join(",");
    json += r#"],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"uri":"x.bin","byteLength":0}],
        "bufferViews":[{"buffer":0,"byteLength":1440000}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":120000}]}"#;
    let error = read_with("x.gltf", &json, &[("x.bin", &positions)]).unwrap_err();
    assert!(error.contains("the nodes repeat meshes"), "{error}");
}

#[test]
fn formats_are_recognised_by_content_first() {
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.starts_with("tetrahedron") && !name.contains(".bin") {
            let bytes = std::fs::read(&path).unwrap();
            for wrong in ["x.ply", "x.obj", "x", "x.png"] {
                let mesh = MeshFile::from_bytes(wrong, &bytes, &mut |name| std::fs::read(folder().join(name)));
                assert_eq!(mesh.map(|mesh| mesh.triangles().len()), Ok(4), "{name} as {wrong}");
            }
        }
    }
}

#[test]
fn a_missing_file_is_an_error() {
    // Messages name a mesh's files by their whole path, too.
    let mesh = "mtllib x.mtl\nv 0 0 0\n";
    let error = MeshFile::from_bytes("models/x.obj", mesh.as_bytes(), &mut |_| Ok(b"Kd 1".to_vec())).unwrap_err();
    assert!(error.to_string().starts_with("models/x.mtl:1:1: "), "{error}");
    let error = MeshFile::load(&folder().join("nowhere\u{1b}.obj")).unwrap_err();
    assert_eq!((error.position(), error.message()), (FilePosition::File, "there is no such file"));
    assert!(error.name().ends_with("nowhere\u{fffd}.obj"));
    assert!(MeshFile::load(&folder()).unwrap_err().to_string().ends_with(": this is a directory, not a file"));
}

#[test]
fn a_mesh_made_by_hand_is_checked_too() {
    let points = vec![Vec3::ZERO; 3];
    assert!(MeshFile::new(points.clone(), vec![[0, 1, 2]]).is_some());
    assert_eq!(MeshFile::new(points.clone(), vec![]), None);
    assert_eq!(MeshFile::new(points.clone(), vec![[0, 1, 3]]), None);
    assert_eq!(MeshFile::new(vec![Vec3::NAN; 3], vec![[0, 1, 2]]), None);
}

/// The mesh that comes with termtrace stands on y = 0 and has normals on its triangles' front
/// sides.
#[test]
fn the_teapot_is_a_teapot() {
    let teapot = MeshFile::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/teapot.obj")).unwrap();
    assert_eq!((teapot.triangles().len(), teapot.positions().len()), (992, 529));
    let low = teapot.positions().iter().copied().reduce(Vec3::min).unwrap();
    let high = teapot.positions().iter().copied().reduce(Vec3::max).unwrap();
    assert_eq!((low.y, high.y), (0.0, 3.15));
    for (i, triangle) in teapot.triangles().iter().enumerate() {
        let [a, b, c] = triangle.map(|index| teapot.positions()[index as usize]);
        let across = (b - a).cross(c - a);
        let normals = teapot.normals_of(i).unwrap();
        assert!(normals.iter().all(|n| n.dot(across) > 0.4 * across.length()), "triangle {i}");
    }
}
