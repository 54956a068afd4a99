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

mod attribute;
mod builder;
mod coarse;
mod error;
mod gltf;
mod limits;
mod kind;
mod mtl;
mod neighbours;
mod obj;
mod ply;
mod polygon;
mod stl;
mod text;
mod texture;

pub use attribute::Attribute;
pub use error::{MeshError, Place};
pub use limits::{MAX_BYTES, MAX_TEXELS, MAX_TRIANGLES};
pub use texture::{Texture, TexturePlacement};

use crate::color::LinearRgb;
use crate::memory;
use crate::named_file::{self, Accepted};
use crate::progress::{Meter, Unfinished, Watcher};
use error::Fault;
use glam::{Mat3, Vec2, Vec3};
use kind::Kind;
use neighbours::Neighbours;
use std::io;
use std::path::Path;

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

    /// The mesh that the bytes describe. The name is used in messages, and its ending where the content does not say
    /// what it is; `open` gives the bytes of a file that the mesh names, by its path relative to the mesh.
    ///
    /// # Errors
    /// The first fault that is found.
    pub fn from_bytes(
        name: &str,
        bytes: &[u8],
        open: &mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
    ) -> Result<Self, MeshError> {
        Self::parse(name, bytes, open, &Watcher::patient()).map_err(Unfinished::failure)
    }

    fn parse(
        name: &str,
        bytes: &[u8],
        open: &mut dyn FnMut(&Path) -> io::Result<Vec<u8>>,
        watcher: &Watcher<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        read(name, bytes, &mut Neighbours::new(name, open), watcher).map_err(|fault| fault.into_error(name, bytes))
    }

    /// The mesh in that file.
    ///
    /// ```no_run
    /// use std::path::Path;
    /// use termtrace::internals::mesh_file::MeshFile;
    ///
    /// match MeshFile::load(Path::new("meshes/teapot.obj")) {
    ///     Ok(mesh) => println!("{} triangles", mesh.triangles().len()),
    ///     Err(error) => println!("{error}"),
    /// }
    /// ```
    ///
    /// # Errors
    /// If the file cannot be read, or as [`MeshFile::from_bytes`].
    pub fn load(path: &Path) -> Result<Self, MeshError> {
        Self::load_or_cancel(path, &Watcher::patient()).map_err(Unfinished::failure)
    }

    /// [`load`](Self::load), until the watcher cancels it.
    ///
    /// # Errors
    /// As [`MeshFile::load`], and if the watcher cancels it.
    pub fn load_or_cancel(path: &Path, watcher: &Watcher<'_>) -> Result<Self, Unfinished<MeshError>> {
        Self::read_whole(path, Accepted::FilesAndPipes, watcher)
    }

    /// The mesh in that file, if it is of an accepted kind.
    pub(crate) fn read_whole(
        path: &Path,
        accepted: Accepted,
        watcher: &Watcher<'_>,
    ) -> Result<Self, Unfinished<MeshError>> {
        let read = named_file::read(path, accepted, |_| MAX_BYTES, watcher);
        if watcher.is_gone() {
            return Err(Unfinished::Cancelled);
        }
        let bytes = read.map_err(|error| {
            Unfinished::Failed(MeshError::of_file(&path.to_string_lossy(), &named_file::reason(&error)))
        })?;
        Self::of_file(path, &bytes, watcher)
    }

    /// The mesh in the file at that path, of which these are the bytes. The files that it names are read from beside it.
    pub(crate) fn of_file(path: &Path, bytes: &[u8], watcher: &Watcher<'_>) -> Result<Self, Unfinished<MeshError>> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut open = |relative: &Path| {
            let path = folder.join(relative);
            watcher.needs(&path);
            named_file::read(&path, Accepted::Files, |_| MAX_BYTES, watcher)
        };
        Self::parse(&path.to_string_lossy(), bytes, &mut open, watcher)
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

/// Whether a file of that name, or with that beginning, is meant to be a mesh.
pub fn is_mesh(name: &str, bytes: &[u8]) -> bool {
    kind::by_ending(name).is_some() || bytes.starts_with(b"ply") || bytes.starts_with(b"glTF")
}

fn is_reflectance(color: LinearRgb) -> bool {
    [color.r, color.g, color.b].iter().all(|band| (0.0..=1.0).contains(band))
}

/// The one place where formats part.
fn read(name: &str, bytes: &[u8], neighbours: &mut Neighbours<'_>, watcher: &Watcher<'_>) -> Result<MeshFile, Fault> {
    if bytes.len() > MAX_BYTES {
        return Err(Fault::of_file("the file is larger than 2 GiB, too large to be read"));
    }
    let meter = Meter::new(watcher, name, bytes.len());
    has_memory(bytes.len() * PEAK_PER_BYTE, "to read it")?;
    let mesh = match kind::of(name, bytes)? {
        Kind::Obj => obj::read(bytes, neighbours, meter),
        Kind::StlText => stl::read_text(bytes, meter),
        Kind::StlBinary => stl::read_binary(bytes, meter),
        Kind::Ply => ply::read(bytes, meter),
        Kind::Gltf => gltf::read_json(bytes, neighbours, meter),
        Kind::Glb => gltf::read_binary(bytes, neighbours, meter),
    }?;
    let triangles = mesh.triangles().len();
    has_memory(triangles * PEAK_PER_TRIANGLE, &format!("for its {triangles} triangles"))?;
    Ok(mesh)
}

/// How many bytes of memory each byte of a file may take while it is read, besides itself. (PLY has the fewest bytes for a
/// triangle.)
const PEAK_PER_BYTE: usize = 8;

/// How many bytes of memory a triangle may take while trees are built over all of them: 230 (PLY) to 290 (STL) were
/// measured, with the file.
const PEAK_PER_TRIANGLE: usize = 320;

fn has_memory(bytes: usize, what_for: &str) -> Result<(), Fault> {
    memory::check(bytes).map_err(|error| Fault::of_file(format!("{error} {what_for}")))
}
