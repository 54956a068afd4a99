//! A mesh under construction.

use super::attribute::{Attribute, index_after};
use super::fault::MeshFault;
use super::left_out::LeftOut;
use super::limits::MAX_TRIANGLES;
use super::marks::{BYTES_PER_MARK, MAX_MARKS, Mark, MarkEnd, MarkStyle};
use super::motion::Motion;
use super::staging::Staging;
use super::{MeshFile, MeshMaterial, is_flat};
use crate::color::LinearRgb;
use crate::memory;
use crate::threads;
use glam::{DVec3, Vec2, Vec3};
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// The triangles and attributes read so far.
#[derive(Default)]
pub(super) struct MeshBuilder {
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) normals: Attribute<Vec3>,
    pub(super) texture_coordinates: Attribute<Vec2>,
    pub(super) colors: Attribute<LinearRgb>,
    pub(super) materials: Vec<MeshMaterial>,
    pub(super) material_runs: Vec<(u32, Option<u32>)>,
    /// Features of materials that are not shown: the material's index, the name in the singular.
    pub(super) not_shown: Vec<(u32, &'static str)>,
    /// Points and lines.
    pub(super) marks: Vec<Mark>,
    /// The cameras and lights.
    pub(super) staging: Staging,
    /// The motion of the nodes.
    pub(super) motion: Option<Arc<Motion>>,
    /// Whether the file has faces or surfaces. In a file without them, and without marks, all
    /// vertices are points.
    pub(super) has_faces: bool,
}

/// The indices of a triangle's corners, for its positions and each attribute that it has.
#[derive(Clone, Copy)]
pub(super) struct TriangleIndices {
    pub(super) positions: [u32; 3],
    pub(super) normals: Option<[u32; 3]>,
    pub(super) texture_coordinates: Option<[u32; 3]>,
    pub(super) colors: Option<[u32; 3]>,
}

impl TriangleIndices {
    /// Returns a triangle whose corners have positions and no other attributes.
    pub(super) fn new(positions: [u32; 3]) -> Self {
        Self { positions, normals: None, texture_coordinates: None, colors: None }
    }
}

impl MeshBuilder {
    /// Adds a triangle, whose indices must be in range.
    ///
    /// # Errors
    /// If the mesh has [`MAX_TRIANGLES`] already.
    pub(super) fn push(&mut self, triangle: TriangleIndices) -> Result<(), MeshFault> {
        if self.triangles.len() >= MAX_TRIANGLES {
            return Err(MeshFault::of_file(too_many_triangles()));
        }
        let TriangleIndices { positions, normals, texture_coordinates, colors } = triangle;
        self.normals.push(&self.triangles, positions, normals);
        self.texture_coordinates.push(&self.triangles, positions, texture_coordinates);
        self.colors.push(&self.triangles, positions, colors);
        self.triangles.push(positions);
        Ok(())
    }

    /// Adds `count` triangles, on several threads if they are many and `is_parallel` is true.
    ///
    /// # Errors
    /// If the mesh then has more than [`MAX_TRIANGLES`].
    pub(super) fn push_all(
        &mut self,
        count: usize,
        is_parallel: bool,
        triangle: impl Fn(usize) -> TriangleIndices + Send + Sync,
    ) -> Result<(), MeshFault> {
        /// The number of triangles that a thread adds to a piece.
        const PIECE: usize = 1 << 15;
        let pieces = count.div_ceil(PIECE);
        let of_piece = |piece: usize| piece * PIECE..count.min((piece + 1) * PIECE);
        if !is_parallel || pieces < 4 {
            return (0..count).try_for_each(|i| self.push(triangle(i)));
        }
        let batch = 4 * threads::count();
        for first in (0..pieces).step_by(batch) {
            let made = threads::map(batch.min(pieces - first), |piece| {
                let mut mesh = Self::default();
                of_piece(first + piece).try_for_each(|i| mesh.push(triangle(i))).map(|()| mesh)
            });
            for piece in made {
                self.append(piece?, self.current_material())?;
            }
        }
        Ok(())
    }

    /// Appends a piece: its vertices, triangles and marks.
    ///
    /// Its indices are those in the whole mesh, except for values of its own, which have the indices of
    /// [`of_piece`](super::attribute::of_piece). Its triangles before its first run have the material `material`.
    ///
    /// # Errors
    /// If the mesh then has more than [`MAX_TRIANGLES`].
    pub(super) fn append(&mut self, mut piece: Self, material: Option<u32>) -> Result<(), MeshFault> {
        if self.triangles.len() + piece.triangles.len() > MAX_TRIANGLES {
            return Err(MeshFault::of_file(too_many_triangles()));
        }
        let base = self.positions.len() as u32; // fewer than 2^31
        for corner in piece.triangles.as_flattened_mut() {
            *corner = index_after(base, *corner);
        }
        append(&mut self.positions, &mut piece.positions);
        self.normals.append(piece.normals, &self.triangles, &piece.triangles);
        self.texture_coordinates.append(piece.texture_coordinates, &self.triangles, &piece.triangles);
        self.colors.append(piece.colors, &self.triangles, &piece.triangles);
        let first = self.triangles.len() as u32; // at most MAX_TRIANGLES
        self.set_material_from(first, material);
        for (from, material) in piece.material_runs {
            self.set_material_from(first + from, material);
        }
        append(&mut self.triangles, &mut piece.triangles);
        append(&mut self.marks, &mut piece.marks);
        self.has_faces |= piece.has_faces;
        Ok(())
    }

    /// Sets the material of the triangles added from here on.
    pub(super) fn set_material(&mut self, material: Option<u32>) {
        self.set_material_from(self.triangles.len() as u32, material); // at most MAX_TRIANGLES
    }

    /// Sets the material from a triangle on that is not before any run.
    fn set_material_from(&mut self, from: u32, material: Option<u32>) {
        // A run that has no triangle yet is replaced, so that no two runs start at the same triangle.
        if self.material_runs.last().is_some_and(|&(start, _)| start == from) {
            self.material_runs.pop();
        }
        if self.current_material() != material {
            self.material_runs.push((from, material));
        }
    }

    /// Returns the material of the triangles added from here on.
    pub(super) fn current_material(&self) -> Option<u32> {
        self.material_runs.last().and_then(|&(_, material)| material)
    }

    /// Returns the mesh, in which triangles that lack a corner are flattened to a point.
    ///
    /// `nothing` describes the contents of a file without triangles, for the message.
    pub(super) fn finish(mut self, nothing: &str, left_out: &mut LeftOut<'_>) -> Result<MeshFile, MeshFault> {
        if let Some((what, count)) = self.add_marks()? {
            left_out.not_shown(format!("{what} (too many; evenly selected)"), count);
        }
        if self.triangles.is_empty() || (left_out.has_faults() && !self.flatten_incomplete_triangles(left_out)) {
            return Err(left_out.fault_of_nothing(format!("there are no triangles in this file: {nothing}")));
        }
        // A part that is flat at time 0 may grow later.
        let is_flat = || self.triangles.iter().all(|&corners| is_flat(corners, &self.positions));
        if self.motion.as_ref().map_or_else(is_flat, |motion| motion.is_flat()) {
            left_out.not_shown("triangle (no triangle of the file has an area)", self.triangles.len());
        }
        let used: HashSet<_> = self.material_runs.iter().filter_map(|&(_, material)| material).collect();
        for &(_, what) in self.not_shown.iter().filter(|(material, _)| used.contains(material)) {
            left_out.not_shown(what, 1);
        }
        let is_charted = self.texture_coordinates.is_of_any();
        let invisible = used.iter().filter(|&&material| {
            self.materials.get(material as usize).is_some_and(|material| material.is_invisible(is_charted))
        });
        left_out.not_shown("invisible material (opacity too low)", invisible.count());
        // Readers have already checked all this, and reported faults with their positions; this is the last line of
        // defence.
        self.into_mesh().ok_or_else(|| MeshFault::of_file("this mesh has numbers or indices out of range"))
    }

    /// Returns a mesh of triangles and marks whose numbers are checked already, with those of
    /// `materials` that it uses; `None` if it has no triangle.
    pub(super) fn finish_part(mut self, materials: &[MeshMaterial]) -> Result<Option<MeshFile>, MeshFault> {
        // A part without marks has no points either.
        self.has_faces = true;
        // The whole mesh has told of the marks that are left out.
        self.add_marks()?;
        let mut places = BTreeMap::new();
        for material in self.material_runs.iter_mut().filter_map(|(_, material)| material.as_mut()) {
            let place = places.len() as u32; // at most as many as there are runs
            let place = *places.entry(*material).or_insert(place);
            // A material is copied when it is met first.
            if place as usize == self.materials.len() {
                self.materials.push(materials[*material as usize].clone());
            }
            *material = place;
        }
        Ok(self.into_mesh())
    }

    /// Adds the triangles of the points and lines.
    ///
    /// Returns what is left out if there are too many: its name in the singular, and the number.
    fn add_marks(&mut self) -> Result<Option<(&'static str, usize)>, MeshFault> {
        let mut marks = std::mem::take(&mut self.marks);
        if marks.is_empty() && self.triangles.is_empty() && !self.has_faces {
            marks = self.vertices_as_points();
        }
        // A position that could not be read is not finite.
        marks.retain(|mark| mark.ends.iter().all(|end| self.positions[end.position as usize].is_finite()));
        let kept = marks.len().div_ceil(marks.len().div_ceil(MAX_MARKS).max(1));
        let mut left_out = None;
        if kept < marks.len() {
            let what = if marks.iter().all(Mark::is_point) { "point" } else { "line" };
            left_out = Some((what, marks.len() - kept));
            marks = marks.iter().step_by(marks.len().div_ceil(MAX_MARKS)).copied().collect();
        }
        if marks.is_empty() {
            return Ok(left_out);
        }
        let count = marks.len();
        memory::check(count * BYTES_PER_MARK)
            .map_err(|error| MeshFault::of_file(format!("{error} for its {count} points and lines")))?;
        // In a mesh of marks alone the only vertices are those of bodies, so that all attributes share their indices.
        let (positions, colors) = if self.triangles.is_empty() {
            self.normals = Attribute::default();
            self.texture_coordinates = Attribute::default();
            (std::mem::take(&mut self.positions), std::mem::take(&mut self.colors).values().to_vec())
        } else {
            (self.positions.clone(), self.colors.values().to_vec())
        };
        let place = |mark: &Mark| mark.ends.map(|end| positions[end.position as usize]);
        let (points, lines): (Vec<_>, Vec<_>) = marks.iter().partition(|mark| mark.is_point());
        let points: Vec<_> = points.into_iter().map(|mark| place(&mark)[0]).collect();
        let style = MarkStyle::of(&points, &lines.iter().map(place).collect::<Vec<_>>());
        for mark in &marks {
            let mark_colors = mark.ends.map(|end| end.color.map(|color| colors[color as usize]));
            self.set_material(mark.material);
            self.add_body(&style, place(mark), mark_colors)?;
        }
        Ok(left_out)
    }

    /// Returns a point for each position, with the colour of the same index.
    fn vertices_as_points(&self) -> Vec<Mark> {
        let has_colors = self.colors.values().len() == self.positions.len();
        let material = self.current_material();
        let point = |position| {
            let end = MarkEnd { position, color: has_colors.then_some(position) };
            Mark { ends: [end; 2], material }
        };
        (0..self.positions.len() as u32).map(point).collect() // fewer than the file's bytes
    }

    /// Adds the triangles of a point or line.
    fn add_body(
        &mut self,
        style: &MarkStyle,
        ends: [Vec3; 2],
        colors: [Option<LinearRgb>; 2],
    ) -> Result<(), MeshFault> {
        let body = style.body(ends, colors);
        let first_position = self.positions.len() as u32; // below 2^31, as their number and that of the marks
        let first_normal = self.normals.values().len() as u32;
        let first_color = self.colors.values().len() as u32;
        self.positions.extend(body.vertices.iter().map(|vertex| vertex.position));
        self.normals.values_mut().extend(body.vertices.iter().map(|vertex| vertex.normal));
        let white = LinearRgb::grey(1.0);
        let has_color = colors.iter().any(Option::is_some);
        if has_color {
            self.colors.values_mut().extend(body.vertices.iter().map(|vertex| vertex.color.unwrap_or(white)));
        }
        for triangle in body.triangles {
            let from = |first: u32| triangle.map(|vertex| first + vertex);
            self.push(TriangleIndices {
                positions: from(first_position),
                normals: Some(from(first_normal)),
                texture_coordinates: None,
                colors: has_color.then(|| from(first_color)),
            })?;
        }
        Ok(())
    }

    /// Returns the mesh; `None` if a number or index is out of range, or there is no triangle.
    pub(super) fn into_mesh(mut self) -> Option<MeshFile> {
        self.shrink_to_fit();
        let Self { positions, triangles, normals, texture_coordinates, colors, materials, material_runs, .. } = self;
        let mesh = MeshFile {
            positions,
            triangles,
            normals,
            texture_coordinates,
            colors,
            materials: materials.into(),
            material_runs,
            staging: self.staging,
            motion: self.motion,
        };
        mesh.is_valid().then_some(mesh)
    }

    /// Replaces the positions that could not be read, which are not finite, by a point of the mesh.
    ///
    /// Triangles with such a corner are flattened to a point. Returns false if there is no other triangle.
    // No triangle is removed, because the attributes and material runs refer to triangles by their number.
    fn flatten_incomplete_triangles(&mut self, left_out: &mut LeftOut<'_>) -> bool {
        let is_whole = |triangle: &[u32; 3]| triangle.iter().all(|&i| self.positions[i as usize].is_finite());
        let Some(&[whole, ..]) = self.triangles.iter().find(|triangle| is_whole(triangle)) else { return false };
        for triangle in &mut self.triangles {
            if !triangle.iter().all(|&i| self.positions[i as usize].is_finite()) {
                *triangle = [whole; 3];
                left_out.count_incomplete_triangle();
            }
        }
        // A point of the mesh is taken, so that the extent of the mesh does not change.
        let point = self.positions[whole as usize];
        for position in self.positions.iter_mut().filter(|position| !position.is_finite()) {
            *position = point;
        }
        true
    }

    /// Frees unused capacity: a mesh lives as long as its scene, and a vector that grew is up to
    /// twice as large.
    fn shrink_to_fit(&mut self) {
        self.positions.shrink_to_fit();
        self.triangles.shrink_to_fit();
        self.normals.shrink_to_fit();
        self.texture_coordinates.shrink_to_fit();
        self.colors.shrink_to_fit();
    }
}

/// Moves all values of one list to the end of another, without a copy if that is empty.
fn append<T>(all: &mut Vec<T>, more: &mut Vec<T>) {
    if all.is_empty() {
        *all = std::mem::take(more);
    } else {
        all.append(more);
    }
}

/// Returns the message about a mesh with too many triangles.
pub(super) fn too_many_triangles() -> String {
    format!("there are more than {MAX_TRIANGLES} triangles in this file, which is the most that are read")
}

/// Returns `direction` as a unit vector, or zero if its length is zero.
pub(super) fn unit(direction: DVec3) -> Vec3 {
    // Divided by its largest component first, so that no square overflows or underflows.
    let direction = direction / direction.abs().max_element();
    let length = direction.length();
    // The comparison is false for NaN too, which the division above gives for a zero vector.
    if length > 0.0 { (direction / length).as_vec3() } else { Vec3::ZERO }
}
