//! Instances: meshes that share the triangles of their file, to which rays are mapped.
//!
//! The copies of a mesh would each take 50 to 100 bytes per triangle and a tree of their own. An instance takes less
//! than a kilobyte; rays are mapped to the coordinates of the file, in double precision, and traced in one tree there.

use super::placement::AffineMap;
use crate::bounds::Bounds;
use crate::checks;
use crate::mesh_file::MeshFile;
use crate::ray::{Interval, clamp_keeping_nan};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// The most triangles that all objects with one mesh file have together before they share them.
// Copies are traced in packets, which is several times as fast. A million triangles take about 100 MB.
const MAX_COPIED_TRIANGLES: usize = 1 << 20;

/// The number of cubic cells along a mesh's longest side, into which its corners are sorted.
const CELLS: f32 = 8.0;

/// The corners of a mesh, sorted into cells: the outermost ones in any direction are found fast.
// Without cells, the boxes around 10,000 instances of 75,000 triangles would take two billion products.
pub(crate) struct CornerCells {
    cells: Vec<Cell>,
}

struct Cell {
    center: DVec3,
    half: DVec3,
    corners: Vec<Vec3>,
}

impl CornerCells {
    /// Sorts the corners of a mesh if `objects` objects should share its triangles.
    pub(crate) fn of_shared(file: &MeshFile, objects: usize) -> Option<Self> {
        let is_shared = objects > 1 && objects.saturating_mul(file.triangles().len()) > MAX_COPIED_TRIANGLES;
        if is_shared { Self::of_traceable(file) } else { None }
    }

    /// Sorts the corners of a mesh if rays can be traced in the coordinates of its file.
    pub(super) fn of_traceable(file: &MeshFile) -> Option<Self> {
        let Bounds { min, max } = Bounds::of(file.positions().iter().copied());
        let is_traceable = checks::are_within_range(&[min, max]) && checks::is_long_enough(max - min);
        is_traceable.then(|| Self::of(file))
    }

    /// Sorts the corners of a mesh.
    pub(super) fn of(file: &MeshFile) -> Self {
        let Bounds { min, max } = Bounds::of(file.positions().iter().copied());
        let per_length = CELLS / (max - min).max_element().max(f32::MIN_POSITIVE);
        let mut cells = BTreeMap::<_, Vec<Vec3>>::new();
        for &corner in file.positions() {
            cells.entry(((corner - min) * per_length).to_array().map(|at| at as u32)).or_default().push(corner);
        }
        let cell = |corners: Vec<Vec3>| {
            let bounds = Bounds::of(corners.iter().copied());
            let [min, max] = [bounds.min, bounds.max].map(Vec3::as_dvec3);
            Cell { center: (min + max) * 0.5, half: (max - min) * 0.5, corners }
        };
        Self { cells: cells.into_values().map(cell).collect() }
    }

    /// Returns the smallest box around the corners in the scene.
    pub(super) fn bounds(&self, map: Option<&AffineMap>) -> Bounds {
        AffineMap::bounds(map, DVec3::ZERO, |direction| self.reach(direction))
    }

    /// Returns the largest dot product of a vector and a corner.
    fn reach(&self, direction: DVec3) -> f64 {
        let along = |cell: &Cell| cell.center.dot(direction) + cell.half.dot(direction.abs());
        let of_corners =
            |cell: &Cell| cell.corners.iter().map(|at| at.as_dvec3().dot(direction)).fold(f64::MIN, f64::max);
        let outermost = |(most, found), cell| {
            let along = along(cell);
            if along > most { (along, Some(cell)) } else { (most, found) }
        };
        let (_, outermost) = self.cells.iter().fold((f64::MIN, None), outermost);
        let farther = |reach, cell| if along(cell) > reach { of_corners(cell).max(reach) } else { reach };
        self.cells.iter().fold(outermost.map_or(f64::MIN, of_corners), farther)
    }
}

/// The passage of a ray through the box of an instance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage {
    /// The interval of t in the box.
    inside: [f32; 2],
    within: Interval,
}

impl Passage {
    /// Returns the passage of a ray that is in the box at some t of `within`.
    #[inline(always)]
    pub(crate) fn new(inside: [f32; 2], within: Interval) -> Option<Self> {
        let [enters, leaves] = inside;
        (enters <= leaves && enters <= within.max && within.min <= leaves).then_some(Self { inside, within })
    }

    /// Returns the interval in which a crossing in the coordinates of the file counts.
    ///
    /// [`clamp_to_box`](Self::clamp_to_box) moves a crossing beyond the box to the end of the box, so there is no upper
    /// limit if the box ends before `within` does.
    #[inline(always)]
    pub(crate) fn search(&self) -> Interval {
        let Interval { min, max } = self.within;
        Interval { min, max: if self.inside[1] <= max { f32::MAX } else { max } }
    }

    /// Clamps the t of a crossing to the interval of t in which the ray is inside the box.
    // As for all surfaces, the boxes of the tree then never hide a hit (`culling.md`, 2).
    #[inline(always)]
    pub(crate) fn clamp_to_box(&self, t: f32) -> f32 {
        clamp_keeping_nan(self.inside[0], self.inside[1], t)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
