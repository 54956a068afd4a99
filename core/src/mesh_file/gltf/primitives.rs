//! The primitives of glTF meshes, read as triangles and transformed by their node.

use super::accessor::{Accessor, DRACO};
use super::buffers::Buffers;
use super::json::Json;
use super::materials;
use super::pose::{Globals, Pose};
use crate::color::LinearRgb;
use crate::mesh_file::MeshFile;
use crate::mesh_file::builder::{MeshBuilder, TriangleIndices};
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::marks::{Mark, MarkEnd};
use crate::mesh_file::motion::Motion;
use crate::mesh_file::staging::Staging;
use glam::{DMat3, DMat4, Vec2};
use std::collections::HashMap;
use std::sync::Arc;

/// A builder of the mesh from the glTF primitives read so far.
pub(super) struct Primitives<'r, 'a, 'b> {
    buffers: &'r mut Buffers<'a, 'b>,
    mesh: MeshBuilder,
    /// The number of the texture coordinate set (`TEXCOORD_n`) that each material uses.
    texture_coordinate_sets: Vec<usize>,
    /// Ranges of the positions and normals of the current node only, because each node transforms
    /// them differently.
    positions: Ranges,
    normals: Ranges,
    /// Ranges of texture coordinates and colours, which no node transforms.
    texture_coordinates: Ranges,
    colors: Ranges,
}

/// A mesh in the place and the pose of the node that shows it.
#[derive(Clone, Copy)]
pub(super) struct Placed<'a, 'w> {
    pub(super) mesh: Json<'a>,
    pub(super) node: Json<'a>,
    /// The transform from the node's coordinates.
    pub(super) transform: DMat4,
    /// The weights of the morph targets, if the animation gives them.
    pub(super) weights: Option<&'w Vec<f64>>,
}

/// The range of each accessor that was read.
///
/// Primitives often share accessors: a mesh that is split by material may keep one list of vertices.
type Ranges = HashMap<RangeKey, Range>;

/// The index of an accessor, and that of the buffer view of its compressed elements, if they are.
type RangeKey = (usize, Option<usize>);

/// The range of an accessor's elements in the mesh's list of positions, normals, texture
/// coordinates or colours.
#[derive(Clone, Copy)]
struct Range {
    start: u32,
    count: usize,
}

/// The attribute names of the texture coordinate sets, by number.
const TEXTURE_COORDINATES: [&str; 8] =
    ["TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3", "TEXCOORD_4", "TEXCOORD_5", "TEXCOORD_6", "TEXCOORD_7"];

impl<'r, 'a, 'b> Primitives<'r, 'a, 'b> {
    pub(super) fn new(buffers: &'r mut Buffers<'a, 'b>) -> Result<Self, MeshFault> {
        let materials = materials::read(buffers)?;
        let texture_coordinate_sets = materials.iter().map(|material| material.texture_coordinates).collect();
        // A file has fewer materials than bytes, so the index fits into 32 bits.
        let unshown = |(i, material): (usize, &materials::Material)| {
            material.not_shown.iter().map(move |&what| (i as u32, what)).collect::<Vec<_>>()
        };
        let not_shown = materials.iter().enumerate().flat_map(unshown).collect();
        let materials = materials.into_iter().map(|material| material.colors).collect();
        Ok(Self {
            buffers,
            mesh: MeshBuilder { materials, not_shown, ..MeshBuilder::default() },
            texture_coordinate_sets,
            positions: Ranges::new(),
            normals: Ranges::new(),
            texture_coordinates: Ranges::new(),
            colors: Ranges::new(),
        })
    }

    pub(super) fn left_out(&mut self) -> &mut LeftOut<'b> {
        self.buffers.left_out()
    }

    /// Returns the mesh, with the cameras and lights of the file, and its motion.
    pub(super) fn finish(mut self, staging: Staging, motion: Option<Motion>) -> Result<MeshFile, MeshFault> {
        (self.mesh.staging, self.mesh.motion) = (staging, motion.map(Arc::new));
        self.mesh.finish("its scene shows no mesh of triangles", self.buffers.left_out())
    }

    /// Returns what `add` adds as a mesh of its own; `None` if it adds no triangle.
    pub(super) fn apart(
        &mut self,
        add: impl FnOnce(&mut Self) -> Result<(), MeshFault>,
    ) -> Result<Option<MeshFile>, MeshFault> {
        let whole = std::mem::take(&mut self.mesh);
        // These ranges are of lists of the whole mesh.
        self.texture_coordinates.clear();
        self.colors.clear();
        let added = add(self);
        let apart = std::mem::replace(&mut self.mesh, whole);
        added?;
        apart.finish_part(&self.mesh.materials)
    }

    /// Adds the primitives of a mesh.
    pub(super) fn add_mesh(&mut self, placed: &Placed<'a, '_>, globals: &Globals) -> Result<(), MeshFault> {
        let Placed { mesh, node, transform, weights } = *placed;
        // These ranges are of positions and normals to which the transform of the previous node was applied.
        self.positions.clear();
        self.normals.clear();
        // In glTF the weights of a node take precedence over those of its mesh.
        let mut weights = weights.map_or_else(|| node.any_numbers("weights"), |weights| Ok(weights.clone()))?;
        if weights.is_empty() {
            weights = mesh.any_numbers("weights")?;
        }
        let mut pose = Pose { node, transform, joints: Vec::new(), weights };
        if let Some(skin) = node.field("skin")? {
            pose.joints = globals.joints(skin, self.buffers)?;
        }
        for primitive in mesh.list("primitives")? {
            self.add(primitive, &pose)?;
        }
        Ok(())
    }

    fn add(&mut self, primitive: Json<'a>, pose: &Pose<'a>) -> Result<(), MeshFault> {
        // Primitives with the same accessor may have different morph targets or joints.
        if pose.differs_by_primitive() {
            self.positions.clear();
            self.normals.clear();
        }
        let mut mode = primitive.index_or("mode", 4)?;
        if compressed(primitive)?.is_some() {
            if ![4, 5].contains(&mode) {
                return Err(primitive.fault(format!("Draco compresses triangles (mode 4 or 5), found mode {mode}")));
            }
            // A strip is stored as separate triangles, too.
            mode = 4;
        }
        let material = primitive.field("material")?.map(|index| index.item_of(self.buffers.root(), "materials"));
        let material = material.transpose()?.map(|(index, _)| index);
        let attributes = primitive.required("attributes")?;
        let positions = self.positions(primitive, attributes, pose)?;
        let normals = self.normals(primitive, attributes, pose)?;
        let texture_coordinates = self.texture_coordinates(primitive, attributes, material)?;
        let colors = self.colors(primitive, attributes)?;
        for range in [normals, texture_coordinates, colors].into_iter().flatten() {
            if range.count != positions.count {
                let (count, other) = (positions.count, range.count);
                return Err(attributes.fault(format!("there are {count} positions but {other} of another attribute")));
            }
        }
        let indices = self.indices(primitive, positions.count)?;
        let length = indices.as_ref().map_or(positions.count, Vec::len);
        if mode < 4 {
            let material = material.map(|index| index as u32); // fewer than the file's bytes
            for ends in marks(mode, length) {
                let end = |corner: usize| {
                    let vertex = indices.as_ref().map_or(corner as u32, |indices| indices[corner]);
                    let at = |range: Range| range.start + vertex;
                    MarkEnd { position: at(positions), color: colors.map(at) }
                };
                self.mesh.marks.push(Mark { ends: ends.map(end), material });
            }
            return self.check_size(primitive);
        }
        self.mesh.set_material(material.map(|index| index as u32)); // fewer than the file's bytes
        // glTF: a negative determinant reverses the orientation of the triangles.
        let is_mirrored = DMat3::from_mat4(pose.transform).determinant() < 0.0;
        let count = triangle_count(mode, length).ok_or_else(|| primitive.fault(format!("there is no mode {mode}")))?;
        let triangle = |i: usize| {
            let mut corners = triangle_corners(mode, i);
            if is_mirrored {
                corners.swap(1, 2);
            }
            let vertices = corners.map(|corner| indices.as_ref().map_or(corner as u32, |indices| indices[corner]));
            let at = |range: Range| vertices.map(|vertex| range.start + vertex);
            TriangleIndices {
                positions: at(positions),
                normals: normals.map(at),
                texture_coordinates: texture_coordinates.map(at),
                colors: colors.map(at),
            }
        };
        self.mesh.push_all(count, self.buffers.is_parallel(), triangle)?;
        self.check_size(primitive)
    }

    fn range_key(&self, primitive: Json<'a>, index: Json<'a>) -> Result<RangeKey, MeshFault> {
        let (number, _) = index.item_of(self.buffers.root(), "accessors")?;
        let view = compressed(primitive)?.map(|compressed| compressed.required("bufferView")?.index());
        Ok((number, view.transpose()?))
    }

    fn check_size(&self, json: Json<'_>) -> Result<(), MeshFault> {
        let most = self.buffers.max_elements();
        let counts = [self.mesh.triangles.len(), self.mesh.positions.len(), self.mesh.marks.len()];
        if counts.into_iter().any(|count| count > most) {
            return Err(
                json.fault(format!("the nodes repeat meshes until there are more than {most} triangles or vertices"))
            );
        }
        Ok(())
    }

    fn positions(&mut self, primitive: Json<'a>, attributes: Json<'a>, pose: &Pose<'a>) -> Result<Range, MeshFault> {
        let index = attributes.required("POSITION")?;
        let number = self.range_key(primitive, index)?;
        if let Some(&range) = self.positions.get(&number) {
            return Ok(range);
        }
        let vectors = Accessor::of_attribute(primitive, "POSITION", index, self.buffers)?.vectors::<3>()?;
        let range = range_after(self.mesh.positions.len(), vectors.len());
        self.mesh.positions.extend(pose.placed(primitive, "POSITION", vectors, self.buffers)?);
        if !self.mesh.positions[range.start as usize..].iter().all(|position| position.is_finite()) {
            return Err(pose.node.fault("this node and those above it put vertices beyond 3.4e38"));
        }
        // The size is checked here as well as after the triangles: vertices alone could exhaust memory too.
        self.check_size(pose.node)?;
        self.positions.insert(number, range);
        Ok(range)
    }

    fn normals(
        &mut self,
        primitive: Json<'a>,
        attributes: Json<'a>,
        pose: &Pose<'a>,
    ) -> Result<Option<Range>, MeshFault> {
        let Some(index) = attributes.field("NORMAL")? else { return Ok(None) };
        let number = self.range_key(primitive, index)?;
        if let Some(&range) = self.normals.get(&number) {
            return Ok(Some(range));
        }
        let vectors = Accessor::of_attribute(primitive, "NORMAL", index, self.buffers)?.vectors::<3>()?;
        let normals = pose.placed(primitive, "NORMAL", vectors, self.buffers)?;
        let values = self.mesh.normals.values_mut();
        let range = range_after(values.len(), normals.len());
        values.extend(normals);
        self.normals.insert(number, range);
        Ok(Some(range))
    }

    fn texture_coordinates(
        &mut self,
        primitive: Json<'a>,
        attributes: Json<'a>,
        material: Option<usize>,
    ) -> Result<Option<Range>, MeshFault> {
        let set = material.map_or(0, |index| self.texture_coordinate_sets[index]);
        let Some(name) = TEXTURE_COORDINATES.get(set) else {
            return Err(attributes.fault(format!("the material wants TEXCOORD_{set}; only 0 to 7 are read")));
        };
        let Some(index) = attributes.field(name)? else { return Ok(None) };
        let number = self.range_key(primitive, index)?;
        if let Some(&range) = self.texture_coordinates.get(&number) {
            return Ok(Some(range));
        }
        let vectors = Accessor::of_attribute(primitive, name, index, self.buffers)?.vectors::<2>()?;
        let values = self.mesh.texture_coordinates.values_mut();
        let range = range_after(values.len(), vectors.len());
        values.extend(vectors.into_iter().map(Vec2::from));
        self.texture_coordinates.insert(number, range);
        Ok(Some(range))
    }

    fn colors(&mut self, primitive: Json<'a>, attributes: Json<'a>) -> Result<Option<Range>, MeshFault> {
        // The attribute has three or four components; the fourth is an opacity, which is not shown.
        let Some(index) = attributes.field("COLOR_0")? else { return Ok(None) };
        let number = self.range_key(primitive, index)?;
        if let Some(&range) = self.colors.get(&number) {
            return Ok(Some(range));
        }
        let vectors = Accessor::of_attribute(primitive, "COLOR_0", index, self.buffers)?.vectors::<3>()?;
        let values = self.mesh.colors.values_mut();
        let range = range_after(values.len(), vectors.len());
        values.extend(vectors.into_iter().map(|channels| {
            let [r, g, b] = channels.map(|channel| channel.clamp(0.0, 1.0));
            LinearRgb::new(r, g, b)
        }));
        self.colors.insert(number, range);
        Ok(Some(range))
    }

    /// Returns the vertex indices of a primitive, each below `count`; `None` if the primitive has
    /// no index list.
    fn indices(&mut self, primitive: Json<'a>, count: usize) -> Result<Option<Vec<u32>>, MeshFault> {
        #[cfg(feature = "draco")]
        if let Some(compressed) = compressed(primitive)? {
            let indices = self.buffers.primitive(compressed)?.indices();
            return checked_indices(compressed, indices, count).map(Some);
        }
        let Some(index) = primitive.field("indices")? else { return Ok(None) };
        let accessor = Accessor::read(index, self.buffers)?;
        let indices = accessor.indices()?;
        let (_, json) = index.item_of(self.buffers.root(), "accessors")?;
        checked_indices(json, indices, count).map(Some)
    }
}

/// Returns the part of a primitive that is compressed with Draco.
fn compressed(primitive: Json<'_>) -> Result<Option<Json<'_>>, MeshFault> {
    if cfg!(feature = "draco") { primitive.extension(DRACO) } else { Ok(None) }
}

/// Returns indices that are all below `count`; `json` is where they are from.
fn checked_indices(json: Json<'_>, indices: Vec<u32>, count: usize) -> Result<Vec<u32>, MeshFault> {
    match indices.iter().position(|&index| index as usize >= count) {
        Some(i) => {
            let message = format!("index {} (number {i}) is out of range: there are {count} vertices", indices[i]);
            Err(json.fault(message))
        }
        None => Ok(indices),
    }
}

/// Returns the range of `count` elements that are appended to a list of `length`. Both are below
/// 2^31, the limit on a file's size.
fn range_after(length: usize, count: usize) -> Range {
    Range { start: length as u32, count }
}

/// Returns the ends of each point or line, as positions in an index list of `length`, for a glTF
/// primitive mode: 0 is points, 1 separate lines, 2 a loop, and 3 a strip.
fn marks(mode: usize, length: usize) -> impl Iterator<Item = [usize; 2]> {
    let count = match mode {
        0 => length,
        1 => length / 2,
        2 if length > 1 => length,
        _ => length.saturating_sub(1),
    };
    (0..count).map(move |i| match mode {
        0 => [i, i],
        1 => [2 * i, 2 * i + 1],
        _ => [i, (i + 1) % length],
    })
}

/// Returns the number of triangles of an index list of `length`, for a glTF primitive mode: 4 is
/// triangles, 5 a strip, 6 a fan. `None` for an unknown mode.
fn triangle_count(mode: usize, length: usize) -> Option<usize> {
    match mode {
        4 => Some(length / 3),
        5 | 6 => Some(length.saturating_sub(2)),
        _ => None,
    }
}

/// Returns the corners of triangle number `i`, as positions in an index list.
fn triangle_corners(mode: usize, i: usize) -> [usize; 3] {
    match mode {
        4 => [3 * i, 3 * i + 1, 3 * i + 2],
        // Every second triangle of a strip has the opposite orientation.
        5 => [i, i + 1 + i % 2, i + 2 - i % 2],
        _ => [i + 1, i + 2, 0],
    }
}
