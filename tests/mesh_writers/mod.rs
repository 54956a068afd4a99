//! A mesh in every format, written as plainly as possible.

// Each test target that says `mod mesh_writers;` uses a part of it.
#![allow(dead_code)]

use glam::{Vec2, Vec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use termtrace::internals::mesh_file::MeshFile;
use termtrace::{LinearRgb, Srgb8};

/// A mesh before it is written; all vertices have the same things.
#[derive(Clone, Debug)]
pub(crate) struct Written {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) normals: Option<Vec<Vec3>>,
    pub(crate) texture_coordinates: Option<Vec<Vec2>>,
    pub(crate) colors: Option<Vec<[u8; 3]>>,
}

/// A format, and how much of a mesh it can say.
pub(crate) struct Writer {
    pub(crate) name: &'static str,
    pub(crate) write: fn(&Written) -> Vec<u8>,
    /// Positions are numbered: several triangles share one.
    has_indices: bool,
    has_normals_and_colors: bool,
    has_texture_coordinates: bool,
}

pub(crate) const WRITERS: &[Writer] = &[
    Writer::full("x.obj", obj, true),
    Writer::bare("text.stl", stl_text),
    Writer::bare("binary.stl", stl_binary),
    Writer::full("text.ply", |mesh| ply(mesh, "ascii"), false),
    Writer::full("little.ply", |mesh| ply(mesh, "binary_little_endian"), false),
    Writer::full("big.ply", |mesh| ply(mesh, "binary_big_endian"), false),
    Writer::full("x.glb", glb, true),
];

impl Writer {
    const fn full(name: &'static str, write: fn(&Written) -> Vec<u8>, has_texture_coordinates: bool) -> Self {
        Self { name, write, has_indices: true, has_normals_and_colors: true, has_texture_coordinates }
    }

    const fn bare(name: &'static str, write: fn(&Written) -> Vec<u8>) -> Self {
        Self { name, write, has_indices: false, has_normals_and_colors: false, has_texture_coordinates: false }
    }
}

/// Returns a ball of about `triangles` triangles, with its poles above and below.
pub(crate) fn ball(triangles: u32) -> Written {
    let rows = (f64::from(triangles) / 4.0).sqrt() as u32;
    let columns = 2 * rows;
    let point = |row: u32, column: u32| {
        let (up, around) = (f64::from(row) / f64::from(rows) * PI, f64::from(column) / f64::from(columns) * TAU);
        let (ring, y) = (libm::sin(up), libm::cos(up));
        Vec3::new((ring * libm::cos(around)) as f32, y as f32, (ring * libm::sin(around)) as f32)
    };
    let at = |row: u32, column: u32| row * (columns + 1) + column;
    let squares = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let triangles = squares.flat_map(|(row, column)| {
        let (a, b, c, d) = (at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column));
        [[a, b, c], [a, c, d]]
    });
    Written {
        triangles: triangles.collect(),
        positions: (0..=rows).flat_map(|row| (0..=columns).map(move |column| point(row, column))).collect(),
        normals: None,
        texture_coordinates: None,
        colors: None,
    }
}

impl Written {
    /// Compares a mesh that was read with this one, as far as the format can hold it.
    pub(crate) fn compare(&self, mesh: &MeshFile, writer: &Writer) -> Result<(), TestCaseError> {
        let name = writer.name;
        if writer.has_indices {
            prop_assert_eq!(mesh.triangles(), &self.triangles, "{}", name);
            prop_assert_eq!(mesh.positions(), &self.positions, "{}", name);
        }
        prop_assert_eq!(mesh.triangles().len(), self.triangles.len(), "{}", name);
        for (i, triangle) in self.triangles.iter().enumerate() {
            let found = mesh.triangles()[i].map(|index| mesh.positions()[index as usize]);
            prop_assert_eq!(found, triangle.map(|index| self.positions[index as usize]), "{}", name);
            let pick = |has: bool| if has { Some(triangle.map(|index| index as usize)) } else { None };
            let normals = pick(writer.has_normals_and_colors && self.normals.is_some());
            let found = mesh.normals_of(i);
            prop_assert_eq!(found.is_some(), normals.is_some(), "{}", name);
            for (found, index) in found.into_iter().flatten().zip(normals.into_iter().flatten()) {
                prop_assert!(found.abs_diff_eq(self.normals.as_ref().unwrap()[index], 1e-6), "{}", name);
            }
            let colors = pick(writer.has_normals_and_colors && self.colors.is_some());
            let found = mesh.colors_of(i);
            prop_assert_eq!(found.is_some(), colors.is_some(), "{}", name);
            for (found, index) in found.into_iter().flatten().zip(colors.into_iter().flatten()) {
                let meant = linear(self.colors.as_ref().unwrap()[index]);
                let distance = (found.r - meant.r).abs() + (found.g - meant.g).abs() + (found.b - meant.b).abs();
                prop_assert!(distance < 1e-6, "{} {:?} {:?}", name, found, meant);
            }
            let uvs = pick(writer.has_texture_coordinates && self.texture_coordinates.is_some());
            let meant = |index: usize| {
                let uv = self.texture_coordinates.as_ref().unwrap()[index];
                // OBJ measures v from the bottom: what is turned twice has lost the bits that 1 - v has not.
                if name == "x.obj" { Vec2::new(uv.x, 1.0 - (1.0 - uv.y)) } else { uv }
            };
            prop_assert_eq!(mesh.texture_coordinates_of(i), uvs.map(|uvs| uvs.map(meant)), "{}", name);
        }
        Ok(())
    }
}

fn linear([r, g, b]: [u8; 3]) -> LinearRgb {
    LinearRgb::from_srgb8(Srgb8::new(r, g, b))
}

fn obj(mesh: &Written) -> Vec<u8> {
    let mut text = String::new();
    for (i, p) in mesh.positions.iter().enumerate() {
        write!(text, "v {} {:e} {:?}", p.x, p.y, p.z).unwrap();
        if let Some(colors) = &mesh.colors {
            let [r, g, b] = colors[i].map(|band| f64::from(band) / 255.0);
            write!(text, " {r} {g} {b}").unwrap();
        }
        text.push('\n');
    }
    for n in mesh.normals.iter().flatten() {
        writeln!(text, "vn {} {} {}", n.x, n.y, n.z).unwrap();
    }
    for uv in mesh.texture_coordinates.iter().flatten() {
        writeln!(text, "vt {} {}", uv.x, 1.0 - uv.y).unwrap();
    }
    for triangle in &mesh.triangles {
        text.push('f');
        for i in triangle.map(|index| index + 1) {
            match (&mesh.texture_coordinates, &mesh.normals) {
                (None, None) => write!(text, " {i}"),
                (Some(_), None) => write!(text, " {i}/{i}"),
                (None, Some(_)) => write!(text, " {i}//{i}"),
                (Some(_), Some(_)) => write!(text, " {i}/{i}/{i}"),
            }
            .unwrap();
        }
        text.push('\n');
    }
    text.into_bytes()
}

fn stl_text(mesh: &Written) -> Vec<u8> {
    let mut text = "solid\n".to_owned();
    for triangle in &mesh.triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for p in triangle.map(|index| mesh.positions[index as usize]) {
            writeln!(text, "vertex {:e} {} {}", p.x, p.y, p.z).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid\n").into_bytes()
}

fn stl_binary(mesh: &Written) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        bytes.extend([0; 12]);
        for p in triangle.map(|index| mesh.positions[index as usize]) {
            bytes.extend(p.to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn ply(mesh: &Written, format: &str) -> Vec<u8> {
    let mut header = format!("ply\nformat {format} 1.0\nelement vertex {}\n", mesh.positions.len());
    let mut property = |kind: &str, names: [&str; 3]| {
        for name in names {
            writeln!(header, "property {kind} {name}").unwrap();
        }
    };
    if mesh.colors.is_some() {
        property("uchar", ["red", "green", "blue"]);
    }
    property("float", ["x", "y", "z"]);
    if mesh.normals.is_some() {
        property("double", ["nx", "ny", "nz"]);
    }
    writeln!(header, "element face {}\nproperty list uchar int vertex_indices\nend_header", mesh.triangles.len())
        .unwrap();
    let mut body = Body { bytes: header.into_bytes(), format };
    for (i, p) in mesh.positions.iter().enumerate() {
        for band in mesh.colors.iter().flat_map(|colors| colors[i]) {
            body.put(band, [band]);
        }
        for x in p.to_array() {
            body.put(x, x.to_le_bytes());
        }
        for x in mesh.normals.iter().flat_map(|normals| normals[i].as_dvec3().to_array()) {
            body.put(x, x.to_le_bytes());
        }
        body.end_row();
    }
    for triangle in &mesh.triangles {
        body.put(3, [3]);
        for index in triangle {
            body.put(index, index.to_le_bytes());
        }
        body.end_row();
    }
    body.bytes
}

/// The body of a PLY file.
struct Body<'a> {
    bytes: Vec<u8>,
    format: &'a str,
}

impl Body<'_> {
    fn put<const N: usize>(&mut self, value: impl std::fmt::Display, little_endian: [u8; N]) {
        match self.format {
            "ascii" => self.bytes.extend(format!("{value} ").into_bytes()),
            "binary_big_endian" => self.bytes.extend(little_endian.iter().rev()),
            _ => self.bytes.extend(little_endian),
        }
    }

    fn end_row(&mut self) {
        if self.format == "ascii" {
            self.bytes.push(b'\n');
        }
    }
}

fn glb(mesh: &Written) -> Vec<u8> {
    let mut bin = Vec::new();
    let (mut views, mut accessors, mut attributes) = (Vec::new(), Vec::new(), Vec::new());
    let mut add = |name: &str, kind: &str, component: u32, count: usize, numbers: Vec<[u8; 4]>| {
        let index = views.len();
        let (offset, length) = (bin.len(), 4 * numbers.len());
        bin.extend(numbers.into_iter().flatten());
        views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#));
        accessors
            .push(format!(r#"{{"bufferView":{index},"componentType":{component},"count":{count},"type":"{kind}"}}"#));
        if !name.is_empty() {
            attributes.push(format!(r#""{name}":{index}"#));
        }
        index
    };
    let floats = |numbers: &mut dyn Iterator<Item = f32>| numbers.map(f32::to_le_bytes).collect::<Vec<_>>();
    let count = mesh.positions.len();
    add("POSITION", "VEC3", 5126, count, floats(&mut mesh.positions.iter().flat_map(Vec3::to_array)));
    if let Some(normals) = &mesh.normals {
        add("NORMAL", "VEC3", 5126, count, floats(&mut normals.iter().flat_map(Vec3::to_array)));
    }
    if let Some(uvs) = &mesh.texture_coordinates {
        add("TEXCOORD_0", "VEC2", 5126, count, floats(&mut uvs.iter().flat_map(Vec2::to_array)));
    }
    if let Some(colors) = &mesh.colors {
        let bands = colors.iter().map(|&color| linear(color)).flat_map(|c| [c.r, c.g, c.b]);
        add("COLOR_0", "VEC3", 5126, count, floats(&mut bands.into_iter()));
    }
    let indices = mesh.triangles.iter().flatten().map(|index| index.to_le_bytes()).collect();
    let indices = add("", "SCALAR", 5125, 3 * mesh.triangles.len(), indices);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[
        {{"attributes":{{{}}},"indices":{indices}}}]}}],"buffers":[{{"byteLength":{}}}],"bufferViews":[{}],"accessors":[{}]}}"#,
        attributes.join(","),
        bin.len(),
        views.join(","),
        accessors.join(",")
    );
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunks = [(b"JSON", json), (b"BIN\0", bin)];
    let length: usize = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
    let mut bytes = [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(length as u32).to_le_bytes()].concat();
    for (kind, chunk) in chunks {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

/// The mesh in that format.
pub(crate) fn written(mesh: &Written, format: &str) -> Vec<u8> {
    let writer = WRITERS.iter().find(|writer| writer.name == format).expect("there is such a format");
    (writer.write)(mesh)
}
