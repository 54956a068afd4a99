use super::*;

const A: [u32; 3] = [0, 1, 2];
const B: [u32; 3] = [2, 1, 3];

/// Pushes a triangle for each item of `corners`. Returns their attribute indices as read back, and
/// the representation.
fn pushed(corners: &[Option<[u32; 3]>]) -> (Vec<Option<[u32; 3]>>, CornerIndices) {
    let mut attribute = Attribute { values: vec![0.0; 9], corners: CornerIndices::Absent };
    let triangles: Vec<_> = [A, B].into_iter().cycle().take(corners.len()).collect();
    for (i, &corner) in corners.iter().enumerate() {
        attribute.push(&triangles[..i], triangles[i], corner);
    }
    assert!(attribute.is_valid(&triangles, |_| true));
    ((0..corners.len()).map(|i| attribute.indices_of(i, &triangles)).collect(), attribute.corners)
}

#[test]
fn corners_have_indices_of_their_own_only_where_they_differ() {
    assert_eq!(pushed(&[None, None]).1, CornerIndices::Absent);
    assert_eq!(pushed(&[Some(A), Some(B), Some(A)]).1, CornerIndices::OfPositions);
    for corners in [
        [None, Some(B), None, Some([5, 6, 7])],
        [Some(A), Some(A), Some(A), None],
        [Some(A), None, Some(A), Some(B)],
        [Some(B), None, Some(A), Some(B)],
    ] {
        let (found, kept) = pushed(&corners);
        assert_eq!(found, corners);
        assert!(matches!(kept, CornerIndices::Own(_)));
    }
}
