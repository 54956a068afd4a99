//! Meshes that enclose a volume.

use crate::bounds::Bounds;
use crate::bvh::{Bvh, LeafVisitor, Leaves, Prefetch, RayStack};
use crate::lanes::{Lanes, SimdKernel};
use crate::mesh_file::MeshFile;
use crate::ray::{EightRays, Interval, Probe, Ray, Rays};
use crate::shape::{Mesh, Placement, Side, Surface, SurfacePoint, Triangle};
use crate::simd;
use glam::{Vec2, Vec3};
use std::cell::RefCell;
use std::collections::HashMap;
use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::Arc;

/// The distance, relative to the largest t of the corners, within which crossings may be one point.
// Triangles that share an edge or a corner compute the t of a point on it with roundings of up to four units of 2^-24.
const TOLERANCE: f32 = 8.0 / 16_777_216.0;

/// A mesh without open edges, with a tree for all crossings of a line.
///
/// The scene's trees find one crossing of a ray. A solid has to know all of them, in front of a ray and behind the
/// surfaces of other parts.
#[derive(Clone, Debug)]
pub(super) struct ClosedMesh {
    mesh: Arc<Mesh>,
    /// The tree over the triangles as they are in the file, shared by all copies of the mesh.
    tree: Arc<TriangleTree>,
}

impl PartialEq for ClosedMesh {
    fn eq(&self, other: &Self) -> bool {
        self.mesh == other.mesh
    }
}

/// The tree over the triangles of a file.
#[derive(Debug)]
struct TriangleTree {
    bvh: Bvh,
    leaves: Leaves,
    /// The corners of each triangle by numbers that are equal for equal coordinates.
    corners: Vec<[u32; 3]>,
    /// Whether the front sides of the triangles face the volume.
    is_inside_out: bool,
}

/// A point at which a line enters or leaves a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeshCrossing {
    pub(super) t: f32,
    pub(super) triangle: u32,
    pub(super) enters: bool,
    /// The largest distance from t at which another crossing may be at the same point.
    tolerance: f32,
}

thread_local! {
    /// The traversal stack of a thread: without it, each line would allocate one.
    static STACK: RefCell<RayStack> = RefCell::default();
}

impl ClosedMesh {
    /// Returns a mesh in the coordinates of its file.
    ///
    /// # Errors
    /// The reason why it encloses no volume.
    pub(super) fn new(file: Arc<MeshFile>) -> Result<Self, String> {
        let corners = welded_corners(&file);
        match open_edge_count(&corners) {
            0 => {}
            1 => return Err("1 edge is not shared by two triangles of the same orientation".to_owned()),
            count => return Err(format!("{count} edges are not shared by two triangles of the same orientation")),
        }
        let mesh = Mesh::of_checked(file);
        let volume = six_fold_volume(&mesh);
        if volume == 0.0 {
            return Err("its volume is 0".to_owned());
        }
        let tree = TriangleTree::of(&mesh, corners, volume < 0.0);
        Ok(Self { tree: Arc::new(tree), mesh: Arc::new(mesh) })
    }

    /// Returns the mesh scaled, rotated and moved; it shares its triangles and their tree.
    pub(super) fn placed(&self, placement: &Placement) -> Self {
        let of_file = self.tree.bvh.bounds().unwrap_or(Bounds::EMPTY);
        Self { mesh: Arc::new(self.mesh.placed_sharing(placement, &of_file)), tree: Arc::clone(&self.tree) }
    }

    /// Returns a box around the mesh.
    pub(super) fn bounds(&self) -> Bounds {
        *self.mesh.bounds()
    }

    /// Returns whether any triangle has normals at its corners.
    pub(super) fn is_smooth(&self) -> bool {
        self.mesh.is_smooth()
    }

    /// Returns the crossings of a ray with the outline of the mesh, in ascending order.
    ///
    /// The ray enters and leaves by turns; if it begins inside, it leaves first. Components that overlap are one
    /// volume.
    pub(super) fn crossings(&self, ray: &Ray) -> Vec<MeshCrossing> {
        let (probe, mut found) = (Probe::new(self.mesh.file_ray(ray)), Vec::new());
        let search = LineSearch { mesh: self, probe: &probe, found: &mut found };
        STACK.with_borrow_mut(|stack| simd::dispatch(Traversal { search, stack }));
        found.sort_unstable_by(|one, other| one.t.total_cmp(&other.t).then(one.triangle.cmp(&other.triangle)));
        outline(&found, &self.tree.corners)
    }

    /// Returns whether a point is inside.
    pub(super) fn encloses(&self, point: Vec3) -> bool {
        // Along no axis, because the edges of many meshes lie along them.
        let ray = Ray { origin: point, direction: Vec3::new(0.57, 0.61, 0.55) };
        self.crossings(&ray).first().is_some_and(|crossing| !crossing.enters)
    }

    /// Returns the point of a triangle at a crossing, without coordinates on the triangle.
    pub(super) fn at_crossing(&self, triangle: u32, ray: &Ray, t: f32) -> SurfacePoint {
        let point = self.mesh.facet(triangle).at_crossing(ray, t);
        let side = match (point.side, self.tree.is_inside_out) {
            (Side::Front, true) => Side::Back,
            (Side::Back, true) => Side::Front,
            (side, false) => side,
        };
        SurfacePoint { side, uv: Vec2::ZERO, ..point }
    }
}

impl TriangleTree {
    fn of(mesh: &Mesh, corners: Vec<[u32; 3]>, is_inside_out: bool) -> Self {
        let bounds = |index: usize| Bounds::of(mesh.file_corners(index as u32));
        let Ok((bvh, leaves)) = Bvh::of_boxes(corners.len(), bounds, &|_| Ok::<_, Infallible>(()));
        Self { bvh, leaves, corners, is_inside_out }
    }
}

/// Returns the corners of all triangles by numbers that are equal for equal coordinates.
///
/// Files repeat corners for each normal or texture coordinate.
fn welded_corners(file: &MeshFile) -> Vec<[u32; 3]> {
    let mut numbers = HashMap::with_capacity(file.positions().len());
    let number = |corner: &Vec3| {
        let next = numbers.len() as u32;
        // Adding 0 turns -0 into 0.
        *numbers.entry((*corner + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
    };
    let numbers: Vec<u32> = file.positions().iter().map(number).collect();
    file.triangles().iter().map(|triangle| triangle.map(|corner| numbers[corner as usize])).collect()
}

/// Returns the number of edges that are not shared by two triangles of the same orientation.
///
/// A mesh encloses a volume if there are none.
fn open_edge_count(triangles: &[[u32; 3]]) -> usize {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for &[a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            // An edge without length belongs to a triangle without area, whose other edges cancel each other.
            if from != to {
                edges.push(([from.min(to), from.max(to)], if from < to { 1 } else { -1 }));
            }
        }
    }
    edges.sort_unstable();
    let is_open = |edge: &[([u32; 2], i32)]| edge.iter().map(|(_, direction)| direction).sum::<i32>() != 0;
    edges.chunk_by(|(one, _), (other, _)| one == other).filter(|edge| is_open(edge)).count()
}

/// Returns six times the volume, which is negative if the front sides of the triangles face it.
///
/// It is the sum over the tetrahedra between the triangles and one corner.
// The origin would not do: far from it, the products of coordinates cancel each other.
fn six_fold_volume(mesh: &Mesh) -> f64 {
    let [apex, ..] = mesh.file_corners(0).map(Vec3::as_dvec3);
    let of_triangle = |index| {
        let [a, b, c] = mesh.file_corners(index).map(|corner| corner.as_dvec3() - apex);
        a.dot(b.cross(c))
    };
    (0..mesh.triangle_count()).map(of_triangle).sum()
}

/// Returns the crossings at which a line changes between outside and inside of a mesh.
///
/// `found` has its crossings with triangles in ascending order, and `corners` the corners of the triangles. The depth,
/// the number of components that contain a point, changes by 1 at each surface; it is 0 at the end of the line.
fn outline(found: &[MeshCrossing], corners: &[[u32; 3]]) -> Vec<MeshCrossing> {
    let points = || found.chunk_by(|one, other| other.t - one.t <= one.tolerance.max(other.tolerance));
    let change = |point: &[MeshCrossing]| change_of_depth(point, corners);
    let mut depth = points().map(change).sum::<i32>().min(0).abs();
    let mut kept = Vec::new();
    for point in points() {
        let before = depth;
        depth += change(point);
        if let Some(first) = point.first()
            && (before > 0) != (depth > 0)
        {
            kept.push(MeshCrossing { enters: depth > 0, ..*first });
        }
    }
    // After roundings, a line might seem to stay inside.
    if kept.last().is_some_and(|last| last.enters) {
        kept.pop();
    }
    kept
}

/// Returns the change of depth at one point, at which a line crosses several triangles.
///
/// Triangles that share a corner are one surface there, which the line crosses at an edge or a corner. It enters if it
/// enters all of them, and passes by if it enters some and leaves others.
fn change_of_depth(point: &[MeshCrossing], corners: &[[u32; 3]]) -> i32 {
    let direction = |crossing: &MeshCrossing| if crossing.enters { 1 } else { -1 };
    let [first, rest @ ..] = point else { return 0 };
    if rest.is_empty() {
        return direction(first);
    }
    let share_corner = |one: &MeshCrossing, other: &MeshCrossing| {
        let [one, other] = [one, other].map(|crossing| corners[crossing.triangle as usize]);
        one.iter().any(|corner| other.contains(corner))
    };
    let (mut left, mut change) = (point.to_vec(), 0);
    while let Some(first) = left.pop() {
        let (mut surface, mut at) = (vec![first], 0);
        while let Some(one) = surface.get(at).copied() {
            let (more, others) = left.into_iter().partition(|other| share_corner(&one, other));
            left = others;
            surface.extend::<Vec<_>>(more);
            at += 1;
        }
        if surface.iter().all(|crossing| crossing.enters == first.enters) {
            change += direction(&first);
        }
    }
    change
}

/// The search for all triangles that a ray crosses, in the coordinates of the file.
struct LineSearch<'a> {
    mesh: &'a ClosedMesh,
    probe: &'a Probe,
    found: &'a mut Vec<MeshCrossing>,
}

/// The SIMD kernel that visits the leaves which a ray reaches.
struct Traversal<'a> {
    search: LineSearch<'a>,
    stack: &'a mut RayStack,
}

impl SimdKernel for Traversal<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let Self { mut search, stack } = self;
        let bvh = &search.mesh.tree.bvh;
        let rays = Rays::<N>::load(&EightRays::of(&[search.probe.ray]), false);
        if let Some(root) = bvh.root() {
            bvh.visit_by_single_ray(root, &rays, Interval::IN_FRONT, stack, &mut search);
        }
    }
}

impl Prefetch for LineSearch<'_> {
    fn prefetch(&self, _: usize) {}
}

impl LeafVisitor for LineSearch<'_> {
    // Not inlined: the code is the same for all vector types, as triangles are tested one by one.
    #[inline(never)]
    fn visit(&mut self, leaf: usize) -> ControlFlow<(), f32> {
        let TriangleTree { leaves, is_inside_out, .. } = &*self.mesh.tree;
        for &index in leaves.boxes(leaf) {
            let corners = self.mesh.mesh.file_corners(index);
            if let Some(t) = Triangle::unchecked(corners).closest_crossing(self.probe, Interval::IN_FRONT) {
                let Ray { origin, direction } = self.probe.ray;
                let (origin, direction, [a, b, c]) =
                    (origin.as_dvec3(), direction.as_dvec3(), corners.map(Vec3::as_dvec3));
                let along = [a, b, c].map(|corner| (corner - origin).dot(direction).abs());
                let along = along.into_iter().fold(0.0, f64::max);
                let tolerance = TOLERANCE * t.max((along / direction.dot(direction)) as f32);
                let facing = (b - a).cross(c - a).dot(direction);
                // A triangle that is seen edge-on is between others, which decide.
                if facing != 0.0 {
                    let enters = (facing < 0.0) != *is_inside_out;
                    self.found.push(MeshCrossing { t, triangle: index, enters, tolerance });
                }
            }
        }
        ControlFlow::Continue(Interval::IN_FRONT.max)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
