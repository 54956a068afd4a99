use super::*;

fn rotation(x: f64, z: f64) -> DMat3 {
    DMat3::from_rotation_x(x) * DMat3::from_rotation_z(z)
}

#[test]
fn a_flat_part_has_a_small_extent_across_its_plane() {
    let flat = DMat3::from_diagonal(DVec3::new(2.0, 0.0, 3.0));
    for (above, below) in [(0.0, 0.0), (0.7, 0.0), (0.0, 0.3), (1.1, -2.0)] {
        let (above, below) = (rotation(above, 0.4 * above), rotation(below, 1.0 + below));
        let map = above * flat * below;
        let thick = invertible(map).expect("a plane");
        // Points stay where they are in the plane, and the others are moved by less than a millionth.
        assert!((thick - map).to_cols_array().iter().all(|entry| entry.abs() < 1e-5), "{thick}");
        let across = thick * (below.transpose() * DVec3::Y);
        let normal = above * DVec3::Y;
        // The longest column of a rotated map is shorter than its longest factor.
        assert!((THICKNESS..3.001 * THICKNESS).contains(&across.dot(normal).abs()), "{across} along {normal}");
        assert!((thick.inverse() * thick - DMat3::IDENTITY).to_cols_array().iter().all(|entry| entry.abs() < 1e-8));
    }
}

#[test]
fn what_a_map_leaves_of_a_part_decides_whether_it_is_seen() {
    let scale = |x, y, z| rotation(0.3, 0.4) * DMat3::from_diagonal(DVec3::new(x, y, z)) * rotation(-1.0, 2.0);
    // Not flat, however small or however far from a ball.
    for map in [scale(1.0, 2.0, 3.0), scale(1e-9, 1e-9, 1e-9), scale(1e3, 1.0, 1e-3), scale(-1.0, 1.0, 1.0)] {
        assert_eq!(invertible(map), Some(map));
    }
    assert_eq!(invertible(scale(1.0, 0.0, 0.0)), None);
    assert_eq!(invertible(DMat3::ZERO), None);
}
