//! Meshes that the animation of their file moves.
//!
//! They are instances, whose map follows from the time: rays are mapped to the coordinates of the part, so that its
//! tree stays as it is.

use super::Mesh;
use super::instance::CornerCells;
use super::placement::{AffineMap, Placement};
use crate::bounds::Bounds;
use crate::checks;
use crate::mesh_file::{MeshFile, Motion};
use glam::{DMat3, DMat4, DVec3};
use std::collections::HashMap;
use std::sync::Arc;

/// The moving parts of a mesh file, before they are placed.
pub(crate) struct MovingParts {
    motion: Arc<Motion>,
    /// The transforms of the parts at time 0.
    transforms: Vec<DMat4>,
    /// The corners of each part; `None` for one without an extent, which no ray hits.
    cells: Vec<Option<Arc<CornerCells>>>,
}

/// The motion of a mesh: a part of that of its file, then a placement.
#[derive(Clone)]
pub(super) struct MeshMotion {
    motion: Arc<Motion>,
    part: usize,
    cells: Arc<CornerCells>,
    placement: AffineMap,
}

/// Compares the motion, but not the corners, which follow from the mesh.
impl PartialEq for MeshMotion {
    fn eq(&self, other: &Self) -> bool {
        self.part == other.part
            && self.placement == other.placement
            && (Arc::ptr_eq(&self.motion, &other.motion) || self.motion == other.motion)
    }
}

/// The transforms of the parts of mesh files at one time, computed once for all parts of a file.
pub(crate) struct Poses {
    pub(super) seconds: f64,
    transforms: HashMap<*const Motion, Vec<DMat4>>,
}

impl Poses {
    /// Returns the poses at a time in seconds.
    pub(crate) fn at(seconds: f64) -> Self {
        Self { seconds, transforms: HashMap::new() }
    }
}

/// The place of a part in the scene.
pub(super) enum PartPlace {
    /// The map to the scene, and the box of the part there.
    Seen(AffineMap, Bounds),
    /// Nowhere: scaled to nothing.
    Nowhere,
    /// Beyond the range of a scene.
    TooFar,
}

/// The extent of a flat part across its plane, as a share of its largest extent.
const THICKNESS: f64 = 1e-6;

/// Returns a map that has an inverse, by which rays are mapped to the coordinates of the part.
///
/// A map to a plane is given a small extent across the plane, so that a flat part is seen. `None` for a map to a line
/// or a point, where no triangle has an area.
fn invertible(map: DMat3) -> Option<DMat3> {
    let [x, y, z] = [map.x_axis, map.y_axis, map.z_axis];
    let longest = x.length().max(y.length()).max(z.length());
    // Of factors whose product is a map to a plane, rounding makes a determinant near 0.
    if map.determinant().abs() > 1e-12 * longest * longest * longest {
        return Some(map);
    }
    // The normal of the plane, and the direction that is mapped to 0.
    let across = normal_of_plane([x, y, z])?;
    let rows = map.transpose();
    let lost = normal_of_plane([rows.x_axis, rows.y_axis, rows.z_axis])? * (THICKNESS * longest);
    Some(DMat3::from_cols(x + across * lost.x, y + across * lost.y, z + across * lost.z))
}

/// Returns the unit normal of the plane that three vectors span; `None` if they span a line or
/// nothing.
fn normal_of_plane([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let longest = a.length_squared().max(b.length_squared()).max(c.length_squared());
    let normals = [a.cross(b), b.cross(c), c.cross(a)];
    let normal = normals.into_iter().max_by(|one, other| one.length_squared().total_cmp(&other.length_squared()))?;
    // Rounding makes small normals of vectors along a line.
    (normal.length() > 1e-12 * longest).then(|| normal.normalize())
}

impl MovingParts {
    pub(crate) fn of(motion: &Arc<Motion>) -> Self {
        let mut known: HashMap<*const MeshFile, Option<Arc<CornerCells>>> = HashMap::new();
        let cells = motion.meshes().map(|mesh| {
            let cells = known.entry(Arc::as_ptr(mesh));
            cells.or_insert_with(|| CornerCells::of_traceable(mesh).map(Arc::new)).clone()
        });
        Self { cells: cells.collect(), transforms: motion.transforms_at(0.0), motion: Arc::clone(motion) }
    }

    /// Returns the parts with this placement; `None` if one reaches too far at time 0.
    pub(crate) fn placed(&self, placement: &Placement) -> Option<Vec<Mesh>> {
        let placement = placement.map();
        let mut meshes = Vec::with_capacity(self.cells.len());
        for (part, (mesh, cells)) in self.motion.meshes().zip(&self.cells).enumerate() {
            let Some(cells) = cells else { continue };
            let motion = MeshMotion { motion: Arc::clone(&self.motion), part, cells: Arc::clone(cells), placement };
            let place = motion.place(&self.transforms[part]);
            if matches!(place, PartPlace::TooFar) {
                return None;
            }
            meshes.push(Mesh::moving(Arc::clone(mesh), motion.into(), &place));
        }
        Some(meshes)
    }
}

impl MeshMotion {
    /// Returns the length in seconds, after which the motion starts again.
    pub(super) fn length(&self) -> f64 {
        self.motion.length()
    }

    /// Returns the place at the time of the poses.
    pub(super) fn place_in(&self, poses: &mut Poses) -> PartPlace {
        let seconds = poses.seconds;
        let transforms = poses.transforms.entry(Arc::as_ptr(&self.motion));
        self.place(&transforms.or_insert_with(|| self.motion.transforms_at(seconds))[self.part])
    }

    /// Returns the place under a transform to the coordinates of the file.
    fn place(&self, transform: &DMat4) -> PartPlace {
        let linear = DMat3::from_mat4(*transform);
        if !transform.is_finite() {
            return PartPlace::TooFar;
        }
        let Some(linear) = invertible(linear) else {
            return PartPlace::Nowhere;
        };
        let part = AffineMap::new(linear, transform.w_axis.truncate());
        let map = part.then(&self.placement);
        let bounds = self.cells.bounds(Some(&map));
        if !checks::are_within_range(&[bounds.min, bounds.max]) {
            return PartPlace::TooFar;
        }
        if !map.is_finite() || !checks::is_long_enough(bounds.max - bounds.min) {
            return PartPlace::Nowhere;
        }
        PartPlace::Seen(map, bounds)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
