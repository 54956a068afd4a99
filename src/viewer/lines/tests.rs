use super::*;
use crate::camera::{Pose, ViewRectangle};
use crate::scene::Scene;

fn camera() -> Camera {
    let pose = Pose { eye: Vec3::new(0.0, 0.0, 5.0), target: Vec3::ZERO, up: Vec3::Y };
    ViewRectangle::from_vertical_fov(1.0).and_then(|rectangle| Camera::new(pose, rectangle)).expect("a camera")
}

fn plot(scene: Option<&Scene>) -> Plot<'_> {
    let (dots, letters) = (BTreeMap::new(), Vec::new());
    let cells = Vec2::new(20.0, 10.0);
    Plot { camera: camera(), aspect_ratio: 1.0, corner: Vec2::new(3.0, 0.0), cells, scene, dots, letters }
}

fn dot_count(plot: &Plot<'_>) -> u32 {
    plot.dots.values().map(|(_, bits)| bits.count_ones()).sum()
}

/// The camera's target is in the middle of the plot, and a line across the picture has two dots in
/// each cell.
#[test]
fn a_line_is_where_its_points_are_projected() {
    let mut plot = plot(None);
    assert_eq!(plot.place(Vec3::ZERO), Some(Vec2::new(10.0, 5.0)));
    plot.line([Vec3::new(-100.0, 0.0, 0.0), Vec3::new(100.0, 0.0, 0.0)], 7);
    let rows: Vec<_> = plot.dots.keys().map(|[_, y]| *y).collect();
    assert!(rows.iter().all(|&y| y == 5), "{rows:?}");
    let columns: Vec<_> = plot.dots.keys().map(|[x, _]| *x).collect();
    assert_eq!(columns, (3..23).collect::<Vec<_>>(), "within the part, which starts at column 3");
    assert_eq!(dot_count(&plot), 40);
}

#[test]
fn a_line_ends_before_the_eye() {
    let mut plot = plot(None);
    plot.line([Vec3::new(0.0, 0.1, 4.0), Vec3::new(0.0, 0.1, 60.0)], 7);
    assert!(dot_count(&plot) > 0, "its part in front of the eye is drawn");
    let mut behind = self::plot(None);
    behind.line([Vec3::new(0.0, 0.1, 6.0), Vec3::new(0.0, 0.1, 60.0)], 7);
    assert_eq!(dot_count(&behind), 0);
}

/// A third of the dots is left of a line behind a sphere; one that ends on it is whole.
#[test]
fn surfaces_hide_most_of_a_line() {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Sphere(center: (0, 0, 0), radius: 3)])";
    let scene = Scene::from_ron("ball", text).expect("a scene");
    let counts = [None, Some(&scene)].map(|scene| {
        let mut plot = plot(scene);
        plot.line([Vec3::new(-1.0, 0.0, -4.0), Vec3::new(1.0, 0.0, -4.0)], 7);
        dot_count(&plot)
    });
    assert!(counts[1] * 3 <= counts[0] + 3 && counts[1] > 0, "{counts:?}");
    let on_it = [None, Some(&scene)].map(|scene| {
        let mut plot = plot(scene);
        plot.line([Vec3::new(1.0, 1.0, 4.0), Vec3::new(0.0, 0.0, 3.0)], 7);
        dot_count(&plot)
    });
    assert_eq!(on_it[0], on_it[1]);
}
