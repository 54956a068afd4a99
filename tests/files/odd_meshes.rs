//! Meshes as other programs write them: what is left out is told, and the rest is drawn.
//!
//! In `tests/odd_meshes`, `make.py` writes the meshes, `NAME.txt` has the notices about the mesh `NAME` and its
//! contents, and `beside/` has the files that meshes name. `BLESS=1 cargo test --test files odd_meshes` writes them
//! anew.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use termtrace::glam::{Vec2, Vec3};
use termtrace::internals::bounds::Bounds;
use termtrace::internals::mesh_file::{Emission, FileCamera, FileLight, FilePlace, MeshFile, MeshMaterial, Opacity};
use termtrace::internals::progress::Reporter;
use termtrace::{LinearRgb, Scene};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/odd_meshes")
}

fn meshes() -> Vec<PathBuf> {
    let is_mesh = |path: &PathBuf| {
        let ending = path.extension().unwrap_or_default();
        path.is_file() && !["txt", "py", "png"].iter().any(|other| ending == *other)
    };
    let mut meshes: Vec<_> =
        std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).filter(is_mesh).collect();
    meshes.sort();
    meshes
}

/// Returns the notices of reading a mesh, and its contents or the error.
fn account_of(path: &Path, is_strict: bool) -> String {
    let lines = Mutex::new(Vec::new());
    let on_notice = |notice: String| lines.lock().unwrap().push(format!("notice: {notice}"));
    let reporter = Reporter::silent().with_warnings(&on_notice);
    let read = MeshFile::load_or_cancel(path, &if is_strict { reporter.strict() } else { reporter });
    let contents = match read {
        Ok(mesh) => contents_of(&mesh),
        Err(error) => format!("error: {error}"),
    };
    let mut lines = lines.into_inner().unwrap();
    lines.push(contents);
    lines.join("\n").replace(&format!("{}/", folder().display()), "") + "\n"
}

fn contents_of(mesh: &MeshFile) -> String {
    let places = mesh.triangles().iter().flatten().map(|&corner| mesh.positions()[corner as usize]);
    let (least, most) = places.fold((Vec3::MAX, Vec3::MIN), |(least, most), p| (least.min(p), most.max(p)));
    let colors: BTreeSet<_> = (0..mesh.triangles().len()).map(|triangle| color_of(mesh, triangle)).collect();
    let colors = colors.into_iter().collect::<Vec<_>>().join(", ");
    let count = mesh.triangles().len();
    format!("{count} triangles from {least} to {most}, {colors}{}{}", staging_of(mesh), motion_of(mesh))
}

/// Returns a line for each of some times, if the mesh moves: the extent that it then has.
fn motion_of(mesh: &MeshFile) -> String {
    let Some(scene) = mesh.moves().then(|| Scene::of_mesh(mesh.clone())).flatten() else { return String::new() };
    let extent_at = |seconds: f64| {
        let bounds = scene.clone().at_time(seconds).bounds();
        let rounded = |point: Vec3| ((point + 1e4) * 1e3).round() / 1e3 - 1e4;
        let extent = bounds.map(|Bounds { min, max }| format!("from {:.2} to {:.2}", rounded(min), rounded(max)));
        format!("\nat {seconds} s {}", extent.unwrap_or_else(|| "nothing".to_owned()))
    };
    [0.0, 0.5, 1.0, 3.5].map(extent_at).concat()
}

/// Returns a line for each camera and light.
fn staging_of(mesh: &MeshFile) -> String {
    let at = |place: &FilePlace| {
        let FilePlace { position, forward, up } = place;
        format!("at {position} towards {forward}, up {up}")
    };
    let cameras = mesh.staging().cameras.iter().map(|camera| {
        let FileCamera { name, place, vertical_fov, aspect_ratio } = camera;
        format!("\ncamera {name:?} {}, {vertical_fov} {aspect_ratio:?}", at(place))
    });
    let lights = mesh.staging().lights.iter().map(|light| {
        let FileLight { place, intensity: LinearRgb { r, g, b }, kind } = light;
        format!("\nlight {kind:?} {r} {g} {b} {}", at(place))
    });
    cameras.chain(lights).collect()
}

/// Returns the colour at a triangle's first corner.
fn color_of(mesh: &MeshFile, triangle: usize) -> String {
    let white = LinearRgb::grey(1.0);
    let material = mesh.material_of(triangle).map(|index| &mesh.materials()[index]);
    let uv = mesh.texture_coordinates_of(triangle).map(|uvs| uvs[0]);
    let texel = |uv: Vec2| Some(material?.texture.as_ref()?.color_at(uv));
    let own = mesh.colors_of(triangle).map(|colors| colors[0]);
    if material.is_none() && own.is_none() {
        return "no colour".to_owned();
    }
    let color = material.map_or(white, |material| material.reflectance)
        * own.unwrap_or(white)
        * uv.and_then(texel).unwrap_or(white);
    let looks = material.map_or_else(String::new, |material| looks_of(material, uv));
    format!("rgb {}{looks}", channels(color))
}

/// Returns what a material shows besides its colour: holes, opacity and light.
fn looks_of(material: &MeshMaterial, uv: Option<Vec2>) -> String {
    let opacity_at = |opacity: &Opacity| {
        let texel = opacity.texture.as_ref().zip(uv).map_or(1.0, |(texture, uv)| texture.opacity_at(uv));
        (opacity.factor * texel * 1e3).round() / 1e3
    };
    let holes = material.holes.iter().map(|(opacity, cutoff)| format!(", {} of cutoff {cutoff}", opacity_at(opacity)));
    let blended = material.blended.iter().map(|opacity| format!(", opacity {}", opacity_at(opacity)));
    let emission = material.emission.iter().map(|Emission { light, texture }| {
        let texel = texture.as_ref().zip(uv).map_or(LinearRgb::grey(1.0), |(texture, uv)| texture.color_at(uv));
        format!(", light {}", channels(*light * texel))
    });
    holes.chain(blended).chain(emission).collect()
}

fn channels(LinearRgb { r, g, b }: LinearRgb) -> String {
    let [r, g, b] = [r, g, b].map(|channel| (channel * 1e3).round() / 1e3);
    format!("{r} {g} {b}")
}

#[test]
fn what_is_left_out_is_told_and_the_rest_is_drawn() {
    let meshes = meshes();
    assert!(meshes.len() >= 70, "only {}", meshes.len());
    let mut wrong = Vec::new();
    for path in meshes {
        let name = path.file_name().unwrap().to_str().unwrap();
        let found = account_of(&path, false);
        let expected = folder().join(format!("{name}.txt"));
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&expected, &found).unwrap();
        }
        let expected = std::fs::read_to_string(expected).unwrap_or_default();
        if found != expected {
            wrong.push(format!("{name}\nexpected:\n{expected}found:\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// With warnings as errors, faults of colours are errors, and others stay notices.
#[test]
fn strict_reading_refuses_a_mesh_without_its_colours() {
    for (name, error) in [
        ("b1.obj", Some("b1.obj:1:8: the materials are missing: ")),
        ("b2.obj", None),
        ("b3.obj", Some("beside/b3.mtl:2:8: the texture is missing: ")),
        ("b3.gltf", Some("b3.gltf: images[0].uri: ")),
        ("b4.obj", Some("b4.obj:8:8: material \"zzz\" is not in any MTL file")),
        ("b6.obj", Some("beside/b6.mtl:2:8: ")),
        ("b6.gltf", Some("b6.gltf: images[0]: ")),
        ("a7_gone.ply", Some("a7_gone.ply: the texture gone.png is missing: ")),
        ("s4_gone.gltf", Some("s4_gone.gltf: buffers[1].uri: \"")),
        ("s4_bezier.gltf", None),
        ("c5.obj", None),
        ("b11_high.stl", None),
    ] {
        let found = account_of(&folder().join(name), true);
        // Notices may come before the error.
        let found = found.lines().last().unwrap_or_default();
        assert_eq!(found.starts_with("error: "), error.is_some(), "{found}");
        assert!(error.is_none_or(|error| found.starts_with(&format!("error: {error}"))), "{found}");
    }
}
