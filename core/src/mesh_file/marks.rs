//! Points and lines of mesh files, which are drawn as small bodies of triangles.
//!
//! A point is an octahedron, or in a large cloud a tetrahedron, and a line a prism. With the normals of a sphere and of
//! a cylinder they look round at the size of a few pixels. A body of triangles can be placed, repeated, exported and
//! described as any other mesh.

use super::MAX_TRIANGLES;
use crate::color::LinearRgb;
use glam::Vec3;

/// A point, or a line between two points.
#[derive(Clone, Copy)]
pub(super) struct Mark {
    /// The ends of a line; a point has the same end twice.
    pub(super) ends: [MarkEnd; 2],
    pub(super) material: Option<u32>,
}

/// An end of a line: the indices of its position and colour.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct MarkEnd {
    pub(super) position: u32,
    pub(super) color: Option<u32>,
}

impl Mark {
    pub(super) fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// Limit on the points and lines that are drawn; of more, an even selection is.
pub(super) const MAX_MARKS: usize = 1 << 20;

/// Limit on the points that are octahedra; of more, each is a tetrahedron.
const MAX_OCTAHEDRA: usize = 1 << 17;

/// Greatest memory of a drawn mark in bytes: eight triangles, six vertices, and their attributes.
pub(super) const BYTES_PER_MARK: usize = 1024;

// A mesh of marks alone is far below the limit on triangles.
const _: () = assert!(8 * MAX_MARKS <= MAX_TRIANGLES);

/// The shape of the bodies of all marks of a mesh.
pub(super) struct MarkStyle {
    point_radius: f32,
    line_radius: f32,
    is_large_cloud: bool,
}

/// The body of a mark.
pub(super) struct Body {
    pub(super) vertices: Vec<BodyVertex>,
    /// Indices of vertices, counterclockwise seen from outside.
    pub(super) triangles: &'static [[u32; 3]],
}

/// A vertex of a body.
pub(super) struct BodyVertex {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) color: Option<LinearRgb>,
}

const OCTAHEDRON: ([Vec3; 6], [[u32; 3]; 8]) = (
    [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z],
    [[0, 2, 4], [2, 1, 4], [3, 0, 4], [1, 3, 4], [2, 0, 5], [1, 2, 5], [0, 3, 5], [3, 1, 5]],
);

/// The square root of 1/3.
const THIRD: f32 = 0.577_350_26;

const TETRAHEDRON: ([Vec3; 4], [[u32; 3]; 4]) = (
    [
        Vec3::new(THIRD, THIRD, THIRD),
        Vec3::new(THIRD, -THIRD, -THIRD),
        Vec3::new(-THIRD, THIRD, -THIRD),
        Vec3::new(-THIRD, -THIRD, THIRD),
    ],
    [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
);

/// The triangles of a prism over the triangle of the vertices 0 to 2, up to that of 3 to 5.
const PRISM: [[u32; 3]; 8] = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5], [0, 2, 1], [3, 4, 5]];

impl MarkStyle {
    /// Returns the style for marks with these ends, all finite: points of about the distance of
    /// neighbours, and thin lines.
    pub(super) fn of(points: &[Vec3], lines: &[[Vec3; 2]]) -> Self {
        let all = || points.iter().chain(lines.iter().flatten());
        let (least, most) = all().fold((Vec3::MAX, Vec3::MIN), |(least, most), &p| (least.min(p), most.max(p)));
        let mut extent = least.as_dvec3().distance(most.as_dvec3()) as f32;
        if extent == 0.0 {
            // A single point, anywhere.
            extent = least.abs().max_element().max(1.0);
        }
        let lengths = lines.iter().map(|[a, b]| a.as_dvec3().distance(b.as_dvec3()) as f32).filter(|&l| l > 0.0);
        let line_length = median(lengths.collect()).unwrap_or(extent);
        Self {
            // A radius of more than half the distance leaves few gaps between the points of a surface.
            point_radius: neighbour_distance(points).map_or(0.01 * extent, |d| (0.7 * d).min(0.01 * extent)),
            // A prism is at least 1.5 times as wide as its radius: in the first view in 200 x 60 cells, wider than a
            // pixel also at the far side. Thinner lines look dashed.
            line_radius: (0.0066 * extent).min(0.3 * line_length),
            is_large_cloud: points.len() > MAX_OCTAHEDRA,
        }
    }

    /// Returns the body of a point (two equal ends) or a line.
    pub(super) fn body(&self, ends: [Vec3; 2], colors: [Option<LinearRgb>; 2]) -> Body {
        let [a, b] = ends;
        let Some(along) = (b - a).try_normalize() else { return self.point(a, colors[0]) };
        // Any direction that is not near that of the line gives two directions across it.
        let [u, v] = across(along);
        let ring = [u, u * -0.5 + v * HALF_ROOT_3, u * -0.5 - v * HALF_ROOT_3];
        let vertex = |(end, color): (Vec3, Option<LinearRgb>)| {
            ring.map(|normal| BodyVertex { position: end + normal * self.line_radius, normal, color })
        };
        Body { vertices: ends.into_iter().zip(colors).flat_map(vertex).collect(), triangles: &PRISM }
    }

    fn point(&self, center: Vec3, color: Option<LinearRgb>) -> Body {
        let (directions, triangles, size): (&[Vec3], &'static [_], f32) = if self.is_large_cloud {
            (&TETRAHEDRON.0, &TETRAHEDRON.1, 1.5)
        } else {
            (&OCTAHEDRON.0, &OCTAHEDRON.1, 1.2)
        };
        // Larger than the sphere, whose outline has more area than that of a body within it.
        let radius = size * self.point_radius;
        let vertex = |&normal: &Vec3| BodyVertex { position: center + normal * radius, normal, color };
        Body { vertices: directions.iter().map(vertex).collect(), triangles }
    }
}

/// Half the square root of 3, the sine of 120 degrees.
const HALF_ROOT_3: f32 = 0.866_025_4;

/// Returns two unit vectors that are perpendicular to the unit vector `along` and to each other.
fn across(along: Vec3) -> [Vec3; 2] {
    let size = along.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        Vec3::X
    } else if size.y <= size.z {
        Vec3::Y
    } else {
        Vec3::Z
    };
    let u = along.cross(axis).normalize();
    [u, along.cross(u)]
}

/// Returns the median distance of a point to its nearest neighbour elsewhere, from a sample;
/// `None` if all points are at one place.
fn neighbour_distance(points: &[Vec3]) -> Option<f32> {
    /// Number of points whose nearest neighbours are searched among all points.
    const SAMPLE: usize = 64;
    let step = points.len().div_ceil(SAMPLE).max(1);
    let nearest = |&point: &Vec3| {
        let squares = points.iter().map(|&other| (other - point).length_squared()).filter(|&square| square > 0.0);
        squares.fold(f32::INFINITY, f32::min).sqrt()
    };
    median(points.iter().step_by(step).map(nearest).filter(|distance| distance.is_finite()).collect())
}

fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_unstable_by(f32::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(all(test, unit_tests))]
mod tests;
