use super::*;

/// Asserts that a body is closed, counterclockwise seen from outside, and around its centre.
fn assert_closed(body: &Body) {
    let at = |i: u32| body.vertices[i as usize].position;
    let center = body.vertices.iter().map(|vertex| vertex.position).sum::<Vec3>() / body.vertices.len() as f32;
    for &[a, b, c] in body.triangles {
        let outwards = (at(b) - at(a)).cross(at(c) - at(a));
        assert!(outwards.dot((at(a) + at(b) + at(c)) / 3.0 - center) > 0.0, "{a} {b} {c}");
        for edge in [[a, b], [b, c], [c, a]] {
            let has_reverse = |other: &[u32; 3]| {
                let [a, b, c] = *other;
                [[b, a], [c, b], [a, c]].contains(&edge)
            };
            assert_eq!(body.triangles.iter().filter(|other| has_reverse(other)).count(), 1, "{edge:?}");
        }
    }
    assert!(body.vertices.iter().all(|vertex| (vertex.normal.length() - 1.0).abs() < 1e-6));
}

#[test]
fn bodies_are_closed() {
    for is_large_cloud in [false, true] {
        let style = MarkStyle { point_radius: 0.1, line_radius: 0.1, is_large_cloud };
        assert_closed(&style.body([Vec3::ONE; 2], [None; 2]));
        for end in [Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::new(1.0, -2.0, 0.5)] {
            assert_closed(&style.body([Vec3::ZERO, end], [None; 2]));
        }
    }
}

/// The points of a grid nearly touch, and few points do not become large.
#[test]
fn points_have_the_size_of_gaps() {
    let grid: Vec<_> = (0..10_000).map(|i| Vec3::new((i % 100) as f32, 0.0, (i / 100) as f32)).collect();
    assert!((MarkStyle::of(&grid, &[]).point_radius - 0.7).abs() < 1e-6);
    let few = [Vec3::ZERO, Vec3::new(3.0, 4.0, 0.0)];
    assert!((MarkStyle::of(&few, &[]).point_radius - 0.05).abs() < 1e-6);
    let one = MarkStyle::of(&[Vec3::ZERO; 3], &[]);
    assert!((one.point_radius - 0.01).abs() < 1e-6);
}
