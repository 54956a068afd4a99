use super::*;

#[test]
fn a_mark_is_on_the_screen_and_around_its_place() {
    let screen = Rect::new(0, 0, 40, 12);
    let area = |column, row| centred_area(screen, Vec2::new(column, row), 3);
    assert_eq!(area(20.5, 6.5), Rect::new(19, 6, 3, 1));
    assert_eq!(area(-1e30, 1e30), Rect::new(0, 11, 3, 1));
    assert_eq!(area(1e30, -0.1), Rect::new(37, 0, 3, 1));
    for size in 0..4 {
        let small = Rect::new(0, 0, size, size);
        assert!(small.union(centred_area(small, Vec2::ONE, 3)) == small, "{size}");
    }
}

const SCREEN: Rect = Rect::new(0, 0, 80, 24);

/// Returns a picture of 80x24 cells, and a camera at (0, 0, 5) that looks along -z.
fn looking() -> (PictureOnScreen, Camera) {
    let camera = Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO).unwrap();
    (PictureOnScreen { aspect_ratio: 80.0 / 48.0, cells: Vec2::new(80.0, 24.0), screen: SCREEN }, camera)
}

#[test]
fn an_arrow_points_at_a_light_outside_the_picture() {
    let (picture, camera) = looking();
    let free = Rect { height: 23, ..SCREEN };
    for (light, text, area) in [
        (Vec3::new(-12.0, 0.0, 0.0), "< 13.0", Rect::new(0, 12, 6, 1)),
        (Vec3::new(12.0, 0.0, 0.0), "13.0 >", Rect::new(74, 12, 6, 1)),
        (Vec3::new(0.0, 400.0, 0.0), "^ 400", Rect::new(38, 0, 5, 1)),
        (Vec3::new(0.0, -12.0, 0.0), "v 13.0", Rect::new(37, 22, 6, 1)),
        (Vec3::new(3.0, 0.0, 9.0), "5.0 behind >", Rect::new(68, 12, 12, 1)),
        (Vec3::new(0.0, 0.0, 9.0), "v 4.0 behind", Rect::new(34, 12, 12, 1)),
    ] {
        assert_eq!(picture.arrow(&camera, light, free), (text.to_owned(), area), "{light}");
    }
}

#[test]
fn a_dotted_line_leads_to_the_surface_below_the_light() {
    let (picture, camera) = looking();
    let column = |of: Vec<Rect>| of.into_iter().map(|dot| (dot.x, dot.y)).collect::<Vec<_>>();
    let inside = column(picture.line(&camera, Vec3::Y, Vec3::NEG_Y));
    assert_eq!(inside, [(40, 17), (40, 15), (40, 13), (40, 11), (40, 9), (40, 7)]);
    // If the light is above the picture or behind the eye, only the part of the line in the picture is left.
    let from_above = column(picture.line(&camera, 100.0 * Vec3::Y, Vec3::NEG_Y));
    assert_eq!((from_above.first(), from_above.last()), (Some(&(40, 17)), Some(&(40, 1))));
    let from_behind = column(picture.line(&camera, Vec3::new(0.5, 0.5, 9.0), Vec3::NEG_Y));
    assert!(from_behind.len() > 3 && from_behind[0] == (40, 17), "{from_behind:?}");
    assert_eq!(picture.line(&camera, 9.0 * Vec3::Z, 8.0 * Vec3::Z), []);
    assert_eq!(picture.line(&camera, 100.0 * Vec3::Y, 90.0 * Vec3::Y), []);
}
