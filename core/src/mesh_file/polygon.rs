//! Triangulation of polygons.

use glam::{DVec2, DVec3, Vec3};

/// Limit on the corners of a polygon that is cut by ear clipping, which takes cubic time: a file of
/// one huge polygon would take hours. Modelled faces have few corners; larger ones are mostly caps of cylinders, which
/// are convex.
const MAX_EAR_CLIPPED_CORNERS: usize = 64;

/// Triangulates a polygon. `corners` are indices into `positions`; each triangle is three indices
/// into `corners`, with the polygon's orientation. A convex polygon becomes a fan; any other is cut by ear clipping. If
/// the positions are unknown, or no ear is left because the outline crosses itself, the rest becomes a fan.
pub(super) fn triangulated(corners: &[u32], positions: &[Vec3]) -> impl Iterator<Item = [usize; 3]> + use<> {
    // A triangle is always convex, and large polygons always become fans: no outline is computed for either.
    let may_be_concave = (4..=MAX_EAR_CLIPPED_CORNERS).contains(&corners.len());
    let outline = if may_be_concave { dominant_plane_outline(corners, positions) } else { None };
    let mut ears = Vec::new();
    let mut fan: Vec<usize> = Vec::new();
    if let Some(outline) = outline.filter(|outline| !is_convex(outline)) {
        (ears, fan) = cut_ears(&outline);
    }
    // For a convex polygon `fan` is empty, and corner `i` of the fan is corner `i` of the polygon.
    let corner = move |i: usize| fan.get(i).copied().unwrap_or(i);
    let fan_length = corners.len() - ears.len();
    ears.into_iter().chain((2..fan_length).map(move |i| [corner(0), corner(i - 1), corner(i)]))
}

/// Returns the corners projected to the coordinate plane where the polygon's area is largest, as a
/// counterclockwise outline; `None` if a corner has no position.
fn dominant_plane_outline(corners: &[u32], positions: &[Vec3]) -> Option<Vec<DVec2>> {
    let points: Vec<DVec3> =
        corners.iter().map(|&i| positions.get(i as usize).map(|p| p.as_dvec3())).collect::<Option<_>>()?;
    let next = |i: usize| points[(i + 1) % points.len()];
    // Newell's normal: its components are twice the areas projected along each axis. The cross product at a single
    // corner would point the wrong way if that corner were concave.
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
fn doubled_signed_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns whether the fan around the first corner covers the polygon: all its triangles have the
/// polygon's orientation.
fn is_convex(outline: &[DVec2]) -> bool {
    let n = outline.len();
    // Turning left at each corner is not enough: a star turns left everywhere, twice around.
    let turns_left = (0..n).all(|i| doubled_signed_area(outline[i], outline[(i + 1) % n], outline[(i + 2) % n]) >= 0.0);
    turns_left && (2..n).all(|i| doubled_signed_area(outline[0], outline[i - 1], outline[i]) >= 0.0)
}

/// Cuts off ears until three corners or no ears remain. Returns the ears' triangles and the
/// remaining corners.
fn cut_ears(outline: &[DVec2]) -> (Vec<[usize; 3]>, Vec<usize>) {
    let mut ears = Vec::new();
    let mut left: Vec<usize> = (0..outline.len()).collect();
    // The last three corners are left to the caller, which cuts them as a fan.
    while left.len() > 3 {
        let Some(ear) = (0..left.len()).find(|&i| is_ear(outline, &left, i)) else { break };
        ears.push(with_neighbours(&left, ear));
        left.remove(ear);
    }
    (ears, left)
}

/// Returns the corner before `left[i]`, `left[i]` itself, and the corner after it.
fn with_neighbours(left: &[usize], i: usize) -> [usize; 3] {
    let n = left.len();
    [left[(i + n - 1) % n], left[i], left[(i + 1) % n]]
}

/// Returns whether a corner is an ear: it turns left, and no other corner lies in its triangle.
fn is_ear(outline: &[DVec2], left: &[usize], i: usize) -> bool {
    let corners = with_neighbours(left, i);
    let [a, b, c] = corners.map(|corner| outline[corner]);
    let is_inside = |p: DVec2| {
        doubled_signed_area(a, b, p) >= 0.0
            && doubled_signed_area(b, c, p) >= 0.0
            && doubled_signed_area(c, a, p) >= 0.0
    };
    doubled_signed_area(a, b, c) > 0.0
        && !left.iter().any(|&other| {
            let p = outline[other];
            // A corner at the same point as `a`, `b` or `c` does not block the ear: an outline with a hole passes twice
            // through the ends of the cut to the hole.
            !corners.contains(&other) && ![a, b, c].contains(&p) && is_inside(p)
        })
}

#[cfg(all(test, unit_tests))]
mod tests;
