use super::*;
use glam::Vec3;

#[test]
fn only_edges_are_drawn_and_small_triangles_fainter() {
    let triangle = Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y]).expect("a triangle");
    let at = |x, y, pixel| {
        let ray = Ray { origin: Vec3::new(x, y, 5.0), direction: Vec3::NEG_Z };
        edge_opacity(&triangle, &ray, pixel)
    };
    assert_eq!(at(0.3, 0.3, 0.01), 0.0);
    assert_eq!(at(0.3, 0.0, 0.01), 1.0);
    assert_eq!(at(0.3, 0.005, 0.01), 0.5);
    // First the triangle is four pixels wide, then half a pixel.
    assert!((0.3..0.6).contains(&at(0.3, 0.0, 0.25)));
    assert_eq!(at(0.3, 0.0, 2.0), LEAST_OPACITY);
}

/// Checks that the edges of a long, thin triangle are faint, as full edges would cover all of it.
#[test]
fn slivers_are_as_faint_as_they_are_thin() {
    let sliver = Triangle::new([Vec3::ZERO, Vec3::X, Vec3::new(0.5, 0.02, 0.0)]).expect("a triangle");
    let ray = Ray { origin: Vec3::new(0.5, 0.0, 5.0), direction: Vec3::NEG_Z };
    assert!(edge_opacity(&sliver, &ray, 0.01) < 0.5);
}
