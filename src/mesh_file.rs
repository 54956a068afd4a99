//! OBJ, STL, PLY or glTF -> triangles, checked once: a [`MeshFile`] cannot be wrong.
//!
//! The format is told by the content; the file's ending decides only where that says nothing. Each format has a file of
//! its own here. What they have in common:
//!
//! - Polygons are cut into triangles: convex ones into fans, others ear by ear, those of more than 64 corners always
//!   into fans.
//! - Numbers are finite, and rounded correctly to single precision. Coordinates are as written, whichever axis is up.
//! - Colours become linear light. Those of vertices are sRGB in PLY and OBJ, as the programs that write them mean it;
//!   reflectances (`Kd` of MTL, base colours and vertex colours of glTF) are linear already. Everything is opaque.
//! - The first fault ends the reading. It is a [`MeshError`]: one line with the place.
//! - Any bytes give a mesh or an error, in linear time. Counts that a file claims reserve nothing that the file could
//!   not fill, so that memory stays within a small multiple of the file (40 times the JSON of a glTF file that names
//!   nothing but empty meshes, 8 times and less elsewhere). At most [`MAX_BYTES`] are read, [`MAX_TRIANGLES`] made, and [`MAX_TEXELS`] unpacked.
//!
//! What a mesh names (its MTL file, its textures, the buffers of a glTF file) is asked for by its path relative to the
//! mesh, through one function given from outside; no URL and no absolute path is ever asked for. What is missing is an
//! error, because a picture without it would look plausible and be wrong.
//!
//! # Crates that were tried
//!
//! The readers are our own: a fault has its place, counts are not trusted, and no line costs an allocation. Numbers, JSON,
//! base64 and pictures are left to crates. Times are of one thread, best of five; memory is the peak.
//!
//! - **glTF**: `gltf` 1.4.1, with and without its validation, fails at a GLB whose `POSITION` names an accessor that does
//!   not exist: `Gltf::from_slice` panics, as it does for 62 of 5,544 files made from one GLB by changing a byte (254
//!   without validation; none here). Quantised positions are refused or left out, meshopt and Draco are not decoded, and a
//!   buffer may name any path, such as `/dev/zero`. It is as fast (498,436 triangles: 27 ms, here 26), and twice as fast
//!   where the JSON is large (60,000 nodes in 3.4 MB: 55 ms, here 118). `gltf-json` alone would take the place of one file
//!   of 166 lines, for six more crates and nine times the memory.
//! - **OBJ**: `tobj` 4.0.5 makes a triangle of the polyline `l 1 2 3`. It refuses a line that is continued with a backslash
//!   and a comment in Latin-1, and its errors have no place. 198,916 triangles take 95 ms and 42 MB, here 41 ms and 26 MB.
//!   `mesh-loader` 0.1.13 comes nearest (48 ms, 51 MB, line and column), but fills the notch of a concave quad and says
//!   nothing of a missing MTL file.
//! - **PLY**: `ply-rs-bw` 4.0.1 fails at an element without properties that claims 4,000,000,000 rows: it makes as many
//!   values until memory ends. 868,624 triangles take 192 ms and 102 MB as text, 64 ms and 86 MB in binary; here 78 ms and
//!   49 MB, 33 ms and 34 MB. `serde-ply` 0.2.2 is as fast as that, and its errors have no place.
//! - **STL**: `stl_io` 0.11.0 and `nom_stl` 0.2.2 read the first solid of a text file of two and say nothing of the second;
//!   of a binary file whose count is too low by one, they drop the last triangle. A million triangles take 171 ms, here 50.
//!   `mesh-loader` 0.1.13 is faster on text (400,000 triangles: 112 ms, here 153), but refuses `SOLID` in capitals.

#[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only readers add values"))]
mod attribute;
#[cfg(feature = "mesh")]
mod builder;
#[cfg(feature = "mesh")]
mod coarse;
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only readers fail"))]
mod error;
#[cfg(feature = "mesh")]
mod fault;
#[cfg(feature = "mesh")]
mod gltf;
#[cfg(feature = "mesh")]
mod kind;
mod limits;
#[cfg(feature = "mesh")]
mod mtl;
#[cfg(feature = "mesh")]
mod neighbours;
#[cfg(feature = "mesh")]
mod obj;
#[cfg(feature = "mesh")]
mod ply;
#[cfg(feature = "mesh")]
mod polygon;
#[cfg(feature = "mesh")]
mod read;
#[cfg(feature = "mesh")]
mod stl;
#[cfg(feature = "mesh")]
mod text;
mod texture;
#[cfg(all(feature = "ron", not(feature = "mesh")))]
mod unread;

pub use attribute::Attribute;
pub use error::{MeshError, Place};
pub use limits::{MAX_BYTES, MAX_TEXELS, MAX_TRIANGLES};
#[cfg(feature = "mesh")]
pub use read::is_mesh;
pub use texture::{Texture, TexturePlacement};
#[cfg(all(feature = "ron", not(feature = "mesh")))]
pub use unread::is_mesh;

use crate::color::LinearRgb;
use glam::{Mat3, Vec2, Vec3};

/// Triangles, and what their file says of them. All numbers are finite, all indices in range, and there is at least one
/// triangle; some may have no area.
///
/// ```
/// use termtrace::internals::mesh_file::MeshFile;
///
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let mesh = MeshFile::from_bytes("square.obj", text, &mut |_| unreachable!("it names no other file"))?;
/// assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = MeshFile::from_bytes("x.obj", b"v 0 0 0\nf 1 2 3\n", &mut |_| unreachable!()).unwrap_err();
/// assert_eq!(error.to_string(), "x.obj:2:5: vertex 2 does not exist: 1 stands above this line");
/// # Ok::<(), termtrace::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
    colors: Attribute<LinearRgb>,
    materials: Vec<MeshMaterial>,
    /// Where the material changes: the first triangle, and the material from there on. In the order of the triangles.
    material_runs: Vec<(u32, Option<u32>)>,
}

/// What a triangle is made of, as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMaterial {
    /// The diffuse reflectance, linear, each band in 0..=1.
    pub reflectance: LinearRgb,
    /// What the reflectance is multiplied by, place by place.
    pub texture: Option<TexturePlacement>,
}

impl MeshFile {
    /// These triangles and nothing else; `None` if there are none, an index has no position, or a position is not
    /// finite.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Option<Self> {
        let mesh = Self {
            positions,
            triangles,
            normals: Attribute::default(),
            texture_coordinates: Attribute::default(),
            colors: Attribute::default(),
            materials: Vec::new(),
            material_runs: Vec::new(),
        };
        mesh.is_valid().then_some(mesh)
    }

    /// With a normal at each position, of any length; `None` unless there are as many, all finite. Where one is zero there
    /// is none.
    pub fn with_normals(self, normals: Vec<Vec3>) -> Option<Self> {
        let normals = normals.into_iter().map(unit_or_zero).collect();
        let mesh = Self { normals: Attribute::of_positions(normals), ..self };
        (mesh.normals.values().len() == mesh.positions.len() && mesh.is_valid()).then_some(mesh)
    }

    /// The mesh scaled along its axes (by nothing that is 0), then turned, then moved. A mesh that becomes its own mirror
    /// image is still seen from outside; `None` if a position leaves what f32 can hold.
    pub fn transformed(mut self, scale: Vec3, turn: Mat3, translation: Vec3) -> Option<Self> {
        for position in &mut self.positions {
            *position = turn * (*position * scale) + translation;
        }
        self.normals = self.normals.map(|normal| unit_or_zero(turn * (normal / scale)));
        if scale.x * scale.y * scale.z < 0.0 {
            attribute::turn(&mut self.triangles);
            self.normals = self.normals.turned();
            self.texture_coordinates = self.texture_coordinates.turned();
            self.colors = self.colors.turned();
        }
        self.is_valid().then_some(self)
    }

    /// The positions of the vertices.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The triangles in the order of the file: indices of positions, counterclockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Whether the file gives normals.
    pub fn has_normals(&self) -> bool {
        !self.normals.values().is_empty()
    }

    /// The normals at a triangle's corners, of length 1; `None` if the file does not give all three: it is flat.
    pub fn normals_of(&self, triangle: usize) -> Option<[Vec3; 3]> {
        self.normals.of(triangle, &self.triangles).filter(|normals| normals.iter().all(|&n| n != Vec3::ZERO))
    }

    /// The texture coordinates at a triangle's corners: u to the right, v down from the texture's top row.
    pub fn texture_coordinates_of(&self, triangle: usize) -> Option<[Vec2; 3]> {
        self.texture_coordinates.of(triangle, &self.triangles)
    }

    /// The colours at a triangle's corners: reflectances that its material's is multiplied by, each band in 0..=1.
    pub fn colors_of(&self, triangle: usize) -> Option<[LinearRgb; 3]> {
        self.colors.of(triangle, &self.triangles)
    }

    /// All normals, of length 1, or zero where the file has none.
    pub fn normals(&self) -> &Attribute<Vec3> {
        &self.normals
    }

    /// All texture coordinates.
    pub fn texture_coordinates(&self) -> &Attribute<Vec2> {
        &self.texture_coordinates
    }

    /// All colours.
    pub fn colors(&self) -> &Attribute<LinearRgb> {
        &self.colors
    }

    /// The materials of the file that its triangles are made of.
    pub fn materials(&self) -> &[MeshMaterial] {
        &self.materials
    }

    /// What a triangle is made of, as an index of [`materials`](Self::materials); `None` if the file does not say.
    pub fn material_of(&self, triangle: usize) -> Option<usize> {
        let runs_so_far = self.material_runs.partition_point(|&(first, _)| first as usize <= triangle);
        let (_, material) = *self.material_runs.get(runs_so_far.checked_sub(1)?)?;
        material.map(|index| index as usize)
    }

    /// What the type promises.
    fn is_valid(&self) -> bool {
        let in_range = |index: u32| (index as usize) < self.positions.len();
        !self.triangles.is_empty()
            && self.triangles.len() <= MAX_TRIANGLES
            && self.triangles.iter().flatten().all(|&index| in_range(index))
            && self.positions.iter().all(|p| p.is_finite())
            && self.normals.is_valid(&self.triangles, |n| *n == Vec3::ZERO || (n.length_squared() - 1.0).abs() < 1e-5)
            && self.texture_coordinates.is_valid(&self.triangles, |uv| uv.is_finite())
            && self.colors.is_valid(&self.triangles, |&color| is_reflectance(color))
            && self.materials.iter().all(|material| is_reflectance(material.reflectance))
            && self.material_runs.iter().all(|(_, m)| m.is_none_or(|m| (m as usize) < self.materials.len()))
    }
}

fn unit_or_zero(normal: Vec3) -> Vec3 {
    // Scaled first: a square must neither overflow nor vanish.
    let largest = normal.abs().max_element();
    if largest > 0.0 { (normal / largest).normalize() } else { Vec3::ZERO }
}

fn is_reflectance(color: LinearRgb) -> bool {
    [color.r, color.g, color.b].iter().all(|band| (0.0..=1.0).contains(band))
}
