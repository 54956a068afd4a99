use super::*;

#[test]
fn a_mark_is_on_the_screen_and_around_its_place() {
    let screen = Rect::new(0, 0, 40, 12);
    assert_eq!(centred_area(screen, 20.5, 6.5), Rect::new(19, 6, 3, 1));
    assert_eq!(centred_area(screen, -1e30, 1e30), Rect::new(0, 11, 3, 1));
    assert_eq!(centred_area(screen, 1e30, -0.1), Rect::new(37, 0, 3, 1));
    for size in 0..4 {
        let small = Rect::new(0, 0, size, size);
        assert!(small.union(centred_area(small, 1.0, 1.0)) == small, "{size}");
    }
}
