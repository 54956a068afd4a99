//! Triangulation of polygons.

use glam::{DVec2, DVec3, Vec3};

/// Limit on the corners of a polygon that is cut by ear clipping, which takes cubic time: a file of
/// one huge polygon would take hours. Modelled faces have few corners; larger ones are mostly caps of cylinders, which
/// are convex.
const MAX_EARS: usize = 64;

/// Triangulates a polygon. `corners` are indices into `positions`; each triangle is three indices
/// into `corners`, with the polygon's orientation. A convex polygon becomes a fan; any other is cut by ear clipping. If
/// the positions are unknown, or no ear is left because the outline crosses itself, the rest becomes a fan.
pub(super) fn cut(corners: &[u32], positions: &[Vec3]) -> impl Iterator<Item = [usize; 3]> + use<> {
    // Triangles and quads are nearly all faces; a triangle needs no test at all.
    let may_be_concave = (4..=MAX_EARS).contains(&corners.len());
    let outline = if may_be_concave { projected(corners, positions) } else { None };
    let mut ears = Vec::new();
    let mut fan: Vec<usize> = Vec::new();
    if let Some(outline) = outline.filter(|outline| !is_convex(outline)) {
        (ears, fan) = cut_ears(&outline);
    }
    // A fan of all corners needs no list.
    let corner = move |i: usize| fan.get(i).copied().unwrap_or(i);
    let fan_length = corners.len() - ears.len();
    ears.into_iter().chain((2..fan_length).map(move |i| [corner(0), corner(i - 1), corner(i)]))
}

/// Returns the outline, counterclockwise, in the coordinate plane where the polygon is largest.
fn projected(corners: &[u32], positions: &[Vec3]) -> Option<Vec<DVec2>> {
    let points: Vec<DVec3> =
        corners.iter().map(|&i| positions.get(i as usize).map(|p| p.as_dvec3())).collect::<Option<_>>()?;
    let next = |i: usize| points[(i + 1) % points.len()];
    // Newell's normal: twice the polygon's area along each axis. One corner's cross product would be wrong at a notch.
    let normal: DVec3 = (0..points.len()).map(|i| (points[i] - points[0]).cross(next(i) - points[0])).sum();
    let size = normal.abs();
    let flat = |p: &DVec3| match size.max_element() {
        m if m == size.x => DVec2::new(p.y, p.z * normal.x.signum()),
        m if m == size.y => DVec2::new(p.z, p.x * normal.y.signum()),
        _ => DVec2::new(p.x, p.y * normal.z.signum()),
    };
    Some(points.iter().map(flat).collect())
}

/// Returns twice the area of a triangle, negative if it is clockwise.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns whether the fan around the first corner covers the polygon: all its triangles have the
/// polygon's orientation.
fn is_convex(outline: &[DVec2]) -> bool {
    let n = outline.len();
    // Turning left at each corner is not enough: a star turns left everywhere, twice around.
    let turns_left = (0..n).all(|i| area(outline[i], outline[(i + 1) % n], outline[(i + 2) % n]) >= 0.0);
    turns_left && (2..n).all(|i| area(outline[0], outline[i - 1], outline[i]) >= 0.0)
}

/// Returns the ears and the remaining corners.
fn cut_ears(outline: &[DVec2]) -> (Vec<[usize; 3]>, Vec<usize>) {
    let mut ears = Vec::new();
    let mut left: Vec<usize> = (0..outline.len()).collect();
    // The last three corners become the fan.
    while left.len() > 3 {
        let Some(ear) = (0..left.len()).find(|&i| is_ear(outline, &left, i)) else { break };
        ears.push(around(&left, ear));
        left.remove(ear);
    }
    (ears, left)
}

/// Returns a corner between its two neighbours.
fn around(left: &[usize], i: usize) -> [usize; 3] {
    let n = left.len();
    [left[(i + n - 1) % n], left[i], left[(i + 1) % n]]
}

/// Returns whether a corner is an ear: it turns left, and no other corner lies in its triangle.
fn is_ear(outline: &[DVec2], left: &[usize], i: usize) -> bool {
    let corners = around(left, i);
    let [a, b, c] = corners.map(|corner| outline[corner]);
    let is_inside = |p: DVec2| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
    area(a, b, c) > 0.0
        && !left.iter().any(|&other| {
            let p = outline[other];
            // A corner at the same point as one of the ear's does not block it: outlines with a hole go there twice.
            !corners.contains(&other) && ![a, b, c].contains(&p) && is_inside(p)
        })
}

#[cfg(all(test, unit_tests))]
mod tests;
