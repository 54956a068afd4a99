//! OBJ, STL, PLY and glTF files to checked triangles: a [`MeshFile`] is always valid.
//!
//! The format is recognised by the content; the file name's extension decides only where the content does not. Each
//! format has a file of its own here. All have in common:
//!
//! - Polygons are triangulated: convex ones into fans, others by ear clipping, those of more than 64 corners always
//!   into fans.
//! - Numbers are finite and correctly rounded to single precision. Coordinates stay as written, whichever axis is up.
//! - Colours become linear light. Vertex colours of PLY and OBJ are sRGB, as the programs that write them mean it;
//!   reflectances (`Kd` of MTL, base colours and vertex colours of glTF) are linear already. Opacities of vertices are
//!   not read.
//! - The first fault ends the reading. It is a [`MeshError`]: one line with the position. For a caller that takes
//!   notices, faulty lines, faces and facets are left out instead, unless no triangle remains or more than one in a
//!   hundred is faulty; contents that no picture shows, such as lines, are counted. `left_out` makes notices of both.
//! - Any bytes give a mesh or an error in linear time. Memory is not reserved for a claimed count that the file could
//!   not hold, so that it stays within a small multiple of the file's size (40 times the JSON of a glTF file that names
//!   nothing but empty meshes, 200 times a primitive that Draco compresses, at most 16 times elsewhere), besides 1 KiB
//!   for each of up to 1 Mi points and lines. At most [`MAX_MESH_BYTES`] are read, [`MAX_TRIANGLES`] made, and
//!   [`MAX_TEXELS`] decoded.
//!
//! Side files (MTL files, textures, buffers of glTF) are requested by their path relative to the mesh through a
//! function passed in; no URL and no absolute path is ever requested: of an absolute path only the last part is. A
//! missing side file is an error, because a picture without it would look plausible and be wrong. To a caller that
//! takes warnings, missing materials and textures are reported as such, and their surfaces are clay.
//!
//! # Crates that were tried
//!
//! The readers are our own: every fault has a position, counts are not trusted, and no line costs an allocation.
//! Numbers, JSON, base64 and images are left to crates. Times are of one thread, best of five; memory is the peak.
//!
//! - **glTF**: `gltf` 1.4.1, with and without its validation, fails at a GLB whose `POSITION` names an accessor that
//!   does not exist: `Gltf::from_slice` panics, as it does for 62 of 5,544 files made from one GLB by changing a byte
//!   (254 without validation; none here). Quantised positions are refused or left out, meshopt and Draco are not
//!   decoded, and a buffer may name any path, such as `/dev/zero`. It is as fast (498,436 triangles: 27 ms, here 26),
//!   and twice as fast where the JSON is large (60,000 nodes in 3.4 MB: 55 ms, here 118). `gltf-json` alone would
//!   replace one file of 166 lines, at the price of six more crates and nine times the memory.
//! - **OBJ**: `tobj` 4.0.5 makes a triangle of the polyline `l 1 2 3`. It refuses a line continued with a backslash and
//!   a comment in Latin-1, and its errors have no position. 198,916 triangles take 95 ms and 42 MB, here 41 ms and 26
//!   MB. `mesh-loader` 0.1.13 comes nearest (48 ms, 51 MB, line and column), but fills the notch of a concave quad and
//!   does not report a missing MTL file.
//! - **PLY**: `ply-rs-bw` 4.0.1 fails at an element without properties that claims 4,000,000,000 rows: it creates that
//!   many values until memory is exhausted. 868,624 triangles take 192 ms and 102 MB as text, 64 ms and 86 MB in
//!   binary; here 78 ms and 49 MB, 33 ms and 34 MB. `serde-ply` 0.2.2 is as fast, but its errors have no position.
//! - **STL**: `stl_io` 0.11.0 and `nom_stl` 0.2.2 read the first solid of a text file with two and silently drop the
//!   second; of a binary file whose count is too low by one, they drop the last triangle. A million triangles take 171
//!   ms, here 50. `mesh-loader` 0.1.13 is faster on text (400,000 triangles: 112 ms, here 153), but refuses `SOLID` in
//!   capitals.

#[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only readers add values"))]
mod attribute;
#[cfg(feature = "mesh")]
mod builder;
#[cfg(feature = "mesh")]
mod decimation;
#[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only readers fail"))]
mod mesh_error;
#[cfg(feature = "mesh")]
mod fault;
#[cfg(feature = "mesh")]
mod gltf;
#[cfg(feature = "mesh")]
mod format;
#[cfg(feature = "mesh")]
mod left_out;
mod limits;
#[cfg_attr(not(feature = "mesh"), allow(dead_code, unused_imports, reason = "only glTF files move"))]
mod motion;
mod staging;
#[cfg(feature = "mesh")]
mod pieces;
#[cfg(feature = "mesh")]
mod marks;
mod material;
#[cfg_attr(not(feature = "mesh"), allow(dead_code, reason = "only mesh files are turned"))]
mod up;
#[cfg(feature = "mesh")]
mod mtl;
#[cfg(feature = "mesh")]
mod side_files;
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
pub use limits::{MAX_MESH_BYTES, MAX_TEXELS, MAX_TRIANGLES};
use material::MeshMaterials;
pub use material::{Emission, MeshMaterial, Opacity};
pub use mesh_error::{FilePosition, MeshError};
pub(crate) use motion::Motion;
#[cfg(feature = "mesh")]
pub use read::{format_name, is_mesh};
pub use staging::{FileCamera, FileLight, FileLightKind, FilePlace, Staging};
#[cfg(feature = "mesh")]
pub(crate) use texture::TextureDecoder;
pub use texture::{Sampler, Texture, TexturePlacement, Wrap};
#[cfg(all(feature = "ron", not(feature = "mesh")))]
pub(crate) use unread::TextureDecoder;
#[cfg(all(feature = "ron", not(feature = "mesh")))]
pub use unread::{format_name, is_mesh};
pub use up::UpAxis;
#[cfg(feature = "ron")]
pub(crate) use up::guessed;

use crate::color::LinearRgb;
use glam::{DVec3, Mat3, Vec2, Vec3};
use std::sync::Arc;

/// Warm clay, `#d98b5f`: the reflectance of missing materials and textures, and of a mesh without
/// colours in a scene made around it.
// The colour is not the default light grey, in which a mesh hardly stands out from a grey floor.
pub(crate) const CLAY: LinearRgb = LinearRgb::new(0.694, 0.258, 0.114);

/// Triangles and their attributes as in a file. All numbers are finite, all indices in range, and
/// there is at least one triangle; some may have no area.
///
/// ```
/// use termtrace::internals::mesh_file::MeshFile;
///
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let mesh = MeshFile::from_bytes("square.obj", text, &mut |_| unreachable!("it names no other file"))?;
/// assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = MeshFile::from_bytes("x.obj", b"v 0 0 0\nf 1 2 3\n", &mut |_| unreachable!()).unwrap_err();
/// assert_eq!(error.to_string(), "x.obj:2:5: vertex 2 does not exist: the file has 1");
/// # Ok::<(), termtrace::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
    colors: Attribute<LinearRgb>,
    materials: MeshMaterials,
    /// Runs of consecutive triangles with one material: the first triangle of each run, and the
    /// index of the run's material in `materials`.
    material_runs: Vec<(u32, Option<u32>)>,
    /// The cameras and lights.
    staging: Staging,
    /// The motion of its parts. The triangles above are where they are at time 0.
    motion: Option<Arc<Motion>>,
}

impl MeshFile {
    /// Returns a mesh of these triangles without attributes; `None` if there are none, an index has
    /// no position, or a position is not finite.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Option<Self> {
        let mesh = Self {
            positions,
            triangles,
            normals: Attribute::default(),
            texture_coordinates: Attribute::default(),
            colors: Attribute::default(),
            materials: MeshMaterials::default(),
            material_runs: Vec::new(),
            staging: Staging::default(),
            motion: None,
        };
        mesh.is_valid().then_some(mesh)
    }

    /// Returns the mesh with one normal per position; `None` unless there are as many normals as
    /// positions, all finite. Normals of any length become unit vectors; a zero vector means "no normal here".
    pub fn with_normals(self, normals: Vec<Vec3>) -> Option<Self> {
        let normals = normals.into_iter().map(unit_or_zero).collect();
        let mesh = Self { normals: Attribute::of_positions(normals), ..self };
        (mesh.normals.values().len() == mesh.positions.len() && mesh.is_valid()).then_some(mesh)
    }

    /// Returns the mesh scaled along its axes (factors not 0), then rotated, then translated. A
    /// mirrored mesh keeps its triangles counterclockwise seen from outside, and one that moves stays as at time 0.
    /// `None` if a position exceeds the range of f32.
    pub fn transformed(self, scale: Vec3, turn: Mat3, translation: Vec3) -> Option<Self> {
        let mesh = self.transformed_unchecked(scale, turn, translation);
        mesh.is_valid().then_some(mesh)
    }

    /// Returns the mesh as [`transformed`](Self::transformed) does, although a position may exceed
    /// the range of f32.
    fn transformed_unchecked(mut self, scale: Vec3, turn: Mat3, translation: Vec3) -> Self {
        self.motion = None;
        for position in &mut self.positions {
            *position = turn * (*position * scale) + translation;
        }
        // Normals transform by the inverse transpose, which for a scale along the axes is a division.
        self.normals = self.normals.map(|normal| unit_or_zero(turn * (normal / scale)));
        // A mirror image reverses the orientation of every triangle.
        if scale.x * scale.y * scale.z < 0.0 {
            attribute::reverse_orientation(&mut self.triangles);
            self.normals = self.normals.with_reversed_triangles();
            self.texture_coordinates = self.texture_coordinates.with_reversed_triangles();
            self.colors = self.colors.with_reversed_triangles();
        }
        self
    }

    /// Returns the mesh turned so that this axis of its file points along +y; `None` if a position
    /// exceeds the range of f32.
    pub fn with_axis_up(self, up: UpAxis) -> Option<Self> {
        // A mesh that is not turned keeps the bits of its normals: `transformed` would normalise them once more.
        if up == UpAxis::Y {
            return Some(self);
        }
        let staging = self.staging.clone().turned(up.turn());
        let motion = match &self.motion {
            Some(motion) => Some(Arc::new(motion.turned(up.turn())?)),
            None => None,
        };
        // Axes that change their places and signs keep all numbers within their range.
        Some(Self { staging, motion, ..self.transformed_unchecked(Vec3::ONE, up.turn(), Vec3::ZERO) })
    }

    /// Returns whether the mesh has colours of its own: of materials, vertices or a texture.
    pub(crate) fn has_colors(&self) -> bool {
        !self.materials().is_empty() || !self.colors.values().is_empty()
    }

    /// Returns whether a material has holes.
    pub(crate) fn has_holes(&self) -> bool {
        self.materials.has_holes
    }

    /// Returns whether a material is blended with what is behind it.
    pub(crate) fn is_blended(&self) -> bool {
        self.materials.is_blended
    }

    /// Returns whether a material sends out light.
    pub(crate) fn has_emission(&self) -> bool {
        self.materials.has_emission
    }

    /// Returns the positions of the vertices.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Returns the triangles in the order of the file: indices of positions, counterclockwise seen
    /// from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the number of triangles without an area, which no ray hits.
    pub fn flat_triangle_count(&self) -> usize {
        self.triangles.iter().filter(|&&corners| is_flat(corners, &self.positions)).count()
    }

    /// Returns whether the file has normals.
    pub fn has_normals(&self) -> bool {
        !self.normals.values().is_empty()
    }

    /// Returns the unit normals at a triangle's corners; `None` if the file does not give all
    /// three, in which case the triangle is shaded flat.
    pub fn normals_of(&self, triangle: usize) -> Option<[Vec3; 3]> {
        self.normals.values_at(triangle, &self.triangles).filter(|normals| normals.iter().all(|&n| n != Vec3::ZERO))
    }

    /// Returns the texture coordinates at a triangle's corners: u to the right, v down from the
    /// texture's top row.
    pub fn texture_coordinates_of(&self, triangle: usize) -> Option<[Vec2; 3]> {
        self.texture_coordinates.values_at(triangle, &self.triangles)
    }

    /// Returns the colours at a triangle's corners: factors of its material's reflectance, each
    /// channel in 0..=1.
    pub fn colors_of(&self, triangle: usize) -> Option<[LinearRgb; 3]> {
        self.colors.values_at(triangle, &self.triangles)
    }

    /// Returns all normals: unit vectors, or zero where the file has none.
    pub fn normals(&self) -> &Attribute<Vec3> {
        &self.normals
    }

    /// Returns all texture coordinates.
    pub fn texture_coordinates(&self) -> &Attribute<Vec2> {
        &self.texture_coordinates
    }

    /// Returns all colours.
    pub fn colors(&self) -> &Attribute<LinearRgb> {
        &self.colors
    }

    /// Returns the materials of the file, to which [`material_of`](Self::material_of) refers by
    /// index.
    pub fn materials(&self) -> &[MeshMaterial] {
        self.materials.all()
    }

    /// Returns the material of a triangle as an index of [`materials`](Self::materials); `None` if
    /// the file gives none.
    pub fn material_of(&self, triangle: usize) -> Option<usize> {
        // `material_runs` has an entry per run instead of per triangle: files sort triangles by material, so runs are
        // few.
        let runs_so_far = self.material_runs.partition_point(|&(first, _)| first as usize <= triangle);
        let (_, material) = *self.material_runs.get(runs_so_far.checked_sub(1)?)?;
        material.map(|index| index as usize)
    }

    /// Returns the cameras and lights of the file.
    pub fn staging(&self) -> &Staging {
        &self.staging
    }

    /// Returns whether the file has an animation that moves the mesh.
    pub fn moves(&self) -> bool {
        self.motion.is_some()
    }

    /// Returns the motion of the mesh, if it moves.
    pub(crate) fn motion(&self) -> Option<&Arc<Motion>> {
        self.motion.as_ref()
    }

    /// Checks the invariants of the type.
    fn is_valid(&self) -> bool {
        let in_range = |index: u32| (index as usize) < self.positions.len();
        !self.triangles.is_empty()
            && self.triangles.len() <= MAX_TRIANGLES
            && self.triangles.iter().flatten().all(|&index| in_range(index))
            && self.positions.iter().all(|p| p.is_finite())
            && self.normals.is_valid(&self.triangles, |n| *n == Vec3::ZERO || (n.length_squared() - 1.0).abs() < 1e-5)
            && self.texture_coordinates.is_valid(&self.triangles, |uv| uv.is_finite())
            && self.colors.is_valid(&self.triangles, |&color| is_reflectance(color))
            && self.materials().iter().all(MeshMaterial::is_valid)
            && self.material_runs.iter().all(|(_, m)| m.is_none_or(|m| (m as usize) < self.materials().len()))
    }
}

/// Returns whether a triangle has no area.
fn is_flat(corners: [u32; 3], positions: &[Vec3]) -> bool {
    let [a, b, c] = corners.map(|corner| positions[corner as usize].as_dvec3());
    (b - a).cross(c - a) == DVec3::ZERO
}

fn unit_or_zero(normal: Vec3) -> Vec3 {
    // Divided by its largest component first, so that the squares in `normalize` neither overflow nor underflow.
    let largest = normal.abs().max_element();
    if largest > 0.0 { (normal / largest).normalize() } else { Vec3::ZERO }
}

fn is_reflectance(color: LinearRgb) -> bool {
    [color.r, color.g, color.b].iter().all(|channel| (0.0..=1.0).contains(channel))
}
