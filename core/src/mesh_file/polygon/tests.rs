use super::*;
use glam::Vec3Swizzles;

fn triangles(outline: &[Vec3]) -> Vec<[usize; 3]> {
    let corners: Vec<u32> = (0..outline.len() as u32).collect();
    triangulated(&corners, outline).collect()
}

fn normal([a, b, c]: [usize; 3], outline: &[Vec3]) -> Vec3 {
    (outline[b] - outline[a]).cross(outline[c] - outline[a])
}

#[test]
fn a_convex_polygon_becomes_a_fan() {
    let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    assert_eq!(triangles(&square), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(triangles(&vec![Vec3::ZERO; 200]).len(), 198);
}

/// Triangulates an L-shaped polygon in several planes and from each first corner: all triangles
/// have its orientation, and their areas sum up to its area.
#[test]
fn a_concave_polygon_is_covered_once() {
    let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    for shift in 0..l.len() {
        for axes in 0..6 {
            let mut outline: Vec<Vec3> = l.iter().map(|[x, y]| Vec3::new(*x, *y, 0.5 * x)).collect();
            outline.rotate_left(shift);
            for p in &mut outline {
                *p = [*p, p.zxy(), p.yzx(), p.yxz(), p.xzy(), p.zyx()][axes];
            }
            let cut = triangles(&outline);
            let normals: Vec<Vec3> = cut.iter().map(|&t| normal(t, &outline)).collect();
            let sum: Vec3 = normals.iter().sum();
            assert_eq!(cut.len(), 4);
            assert!(normals.iter().all(|n| n.dot(sum) > 0.0), "{shift} {axes} {cut:?}");
            let area: f32 = normals.iter().map(|n| n.length()).sum();
            assert!((area - 8.0 * 1.25_f32.sqrt()).abs() < 1e-5, "{area}");
        }
    }
}

#[test]
fn an_outline_that_crosses_itself_still_becomes_n_minus_2_triangles() {
    let bow = [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::X];
    assert_eq!(triangles(&bow).len(), 2);
    let star: Vec<Vec3> = (0..5)
        .map(|i| f64::from(i) * 2.513_274)
        .map(|a| Vec3::new(libm::cos(a) as f32, libm::sin(a) as f32, 0.0))
        .collect();
    assert_eq!(triangles(&star).len(), 3);
}
