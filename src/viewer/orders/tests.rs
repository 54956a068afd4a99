use super::*;
use crate::framebuffer::Resolution;
use crate::maps::Map;
use crate::rasterize::Comparison;
use crate::render::{Cost, Sampling, render};
use crate::scene::Scene;
use crate::tone::tone;
use crate::viewer::frame::Shot;
use crate::viewer::view_layout::ViewLayout;
use std::num::NonZeroU32;
use unicode_width::UnicodeWidthStr;

const SIZE: [u32; 2] = [41, 20];

/// The pixel rows below the pictures.
const PANEL_HEIGHT: u32 = 4;

/// Returns a frame that compares both orders: a red ball in front of a wall, drawn after the wall.
fn frame() -> Frame {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: \"#fff\", objects: [
        Sphere(center: (0, 0, -40), radius: 30, material: Diffuse(\"#fff\")),
        Sphere(center: (0, 0, 0), radius: 1, material: Diffuse(\"#f00\")),
    ])";
    let scene = Scene::from_ron("ball", text).expect("a scene");
    let (layout, resolution) =
        (ViewLayout::single(Map::Shaded).twice(PANEL_HEIGHT), Resolution::square(SIZE[0], SIZE[1]));
    let [(_, left), (_, right)] = *layout.map_sizes(resolution) else { panic!("two pictures") };
    let camera = *scene.camera();
    let parts = [left, right].map(|part| tone(&render(&scene, &camera, part, NonZeroU32::MIN), &scene));
    Frame {
        picture: layout.combined(&parts, 0.5).expect("two pictures"),
        orders: Some(Comparison::new(&scene, &camera, [left, right]).into()),
        shot: Shot {
            scene: 0,
            lights: 0,
            time: Duration::ZERO,
            camera,
            outside: None,
            resolution,
            layout,
            orders: true,
            geometry: false,
        },
        scene,
        geometry: None,
        parts: Vec::new(),
        legends: Vec::new(),
        cost: Cost::default(),
        sampling: Sampling::Each(NonZeroU32::MIN),
        refines: false,
        trace: Duration::ZERO,
        interval: Duration::ZERO,
    }
}

fn seconds(seconds: f64) -> Duration {
    Duration::from_secs_f64(seconds)
}

/// The left picture grows pixel by pixel, the right one object by object, both up to the picture
/// of the frame.
#[test]
fn both_pictures_are_built_up_to_that_of_the_frame() {
    let frame = frame();
    let mut panel = RenderOrdersPanel::new(false);
    panel.take_frame(&frame);
    let (mut pixels, mut objects) = (0, Vec::new());
    let mut now = Duration::ZERO;
    loop {
        let (_, next) = panel.advance(now);
        let Some(picture) = panel.partial_picture(&frame) else {
            assert_eq!(next, None, "no timer after the end");
            break;
        };
        let [width, height] = [SIZE[0], SIZE[1] - PANEL_HEIGHT].map(|side| side as usize);
        let rows = || picture.pixels().chunks(width).zip(frame.picture.pixels().chunks(width)).take(height);
        // In image order all pixels before the current one are complete.
        let built: Vec<_> = rows().flat_map(|(row, last)| row[..20].iter().zip(&last[..20])).collect();
        let count = built.iter().take_while(|(pixel, last)| pixel == last).count();
        assert!(count >= pixels && *built[count].0 == CURRENT_PIXEL_COLOR, "{count} after {pixels}");
        assert!(built[count + 1..].iter().all(|(pixel, _)| **pixel == EMPTY));
        pixels = count;
        let shown = rows().flat_map(|(row, _)| &row[21..]).filter(|pixel| **pixel != EMPTY).count();
        if objects.last() != Some(&shown) {
            objects.push(shown);
        }
        let next = next.expect("the build goes on");
        assert!(next > now);
        now = next;
    }
    assert!(now >= seconds(9.5), "{now:?}");
    // The number of drawn pixels is first 0 and then that of the wall. The ball adds none, as it is in front of the
    // wall.
    assert_eq!(objects.len(), 2, "{objects:?}");
    assert_eq!(objects[0], 0);
}

/// A pixel of the wall that the ball will hide has the colour of the wall.
#[test]
fn objects_that_later_ones_hide_have_their_own_colour() {
    let frame = frame();
    let mut build = ObjectOrderBuild::new(&frame).expect("both orders");
    let [wall, _] = build.comparison.object_tests[..] else { panic!("two objects") };
    build.draw(wall);
    let (red, middle) = (Srgb8::new(255, 0, 0), [9, 10]);
    let at = middle[1] as usize * SIZE[0] as usize + 21 + middle[0] as usize;
    let last = frame.picture.pixels()[at];
    assert!(last.g < 20, "the ball: {last:?}");
    let shown = build.pixel_color(middle[0], middle[1], EMPTY, last);
    assert!(shown != red && shown.g > 100 && shown.r == shown.b, "the wall: {shown:?}");
}

#[test]
fn keys_change_the_pace() {
    let frame = frame();
    let mut panel = RenderOrdersPanel::new(false);
    panel.take_frame(&frame);
    panel.advance(Duration::ZERO);
    assert!(panel.advance(seconds(2.0)).0);
    let after_two = panel.pace.tests();
    panel.change_pace(BuildPace::pause_or_step);
    assert_eq!(panel.advance(seconds(3.0)), (false, None), "no timer while it pauses");
    panel.change_pace(BuildPace::pause_or_step);
    panel.change_pace(BuildPace::faster);
    panel.advance(seconds(4.0));
    panel.advance(seconds(5.0));
    assert!(panel.pace.tests().abs_diff(2 * after_two) <= 2, "a second at twice the speed");
    panel.change_pace(BuildPace::restart);
    assert_eq!(panel.pace.tests(), 0);
    assert_eq!(panel.pace.factor_text(), "2x");
    (0..3).for_each(|_| panel.change_pace(BuildPace::slower));
    assert_eq!(panel.pace.factor_text(), "1/4x");
}

/// With reduced motion the pictures are complete, and each press builds a step.
#[test]
fn with_reduced_motion_nothing_moves_by_itself() {
    let frame = frame();
    let mut panel = RenderOrdersPanel::new(true);
    panel.take_frame(&frame);
    assert_eq!(panel.advance(Duration::ZERO), (false, None));
    assert!(panel.partial_picture(&frame).is_none(), "complete");
    for press in 1..=16 {
        panel.change_pace(BuildPace::pause_or_step);
        assert_eq!(panel.advance(seconds(f64::from(press))), (false, None));
        assert_eq!(panel.partial_picture(&frame).is_none(), press == 16, "press {press}");
    }
}

#[test]
fn the_words_fit_into_every_screen() {
    let frame = frame();
    let mut comparison = (**frame.orders.as_ref().expect("both orders")).clone();
    comparison.times.image = seconds(0.1234);
    for (columns, rows, most) in [(40, 12, 7), (80, 24, 8), (200, 60, 8), (81, 12, 7)] {
        let total = comparison.max_total_tests();
        for tests in [0, total / 2, total] {
            let lines = words::lines(&comparison, "object", tests, columns, rows);
            let height = usize::from(words::height(columns, rows));
            assert!(tests == total || lines.len() + 1 == height, "{height}: {lines:?}");
            assert!(lines.len() < most, "{lines:?}");
            assert!(lines.iter().all(|line| line.width() + 2 <= usize::from(columns)), "{columns}: {lines:?}");
            assert!(lines.iter().any(|line| line.contains("123 ms")), "{lines:?}");
            // At the end the first line shows each number of tests as a product: pixels, or objects, times the tests of
            // each.
            let is_whole = lines[0].contains(" pixels x ") && lines[0].contains("2 objects x ");
            assert_eq!(is_whole, columns >= 80 && tests == total, "{lines:?}");
        }
    }
}

#[test]
fn numbers_of_tests_are_grouped_by_thousands() {
    let mut comparison = (**frame().orders.as_ref().expect("both orders")).clone();
    comparison.object_tests = vec![3_438, 6_876];
    let lines = words::lines(&comparison, "object", comparison.max_total_tests(), 80, 24);
    assert!(lines[0].ends_with("Object order: 2 objects x 3,438 tests"), "{lines:?}");
}
