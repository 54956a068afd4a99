//! Lights that are moved: keys and reports of the mouse in, the picture out.
//!
//! The screen has 40x12 cells of 10x20 pixels.

use crate::mouse::{drag, report};
use crate::orbit::{BALL, camera, load, looking};
use crate::pty::{SOON, Session, picture, shows};
use glam::{Vec2, Vec3};
use termtrace::{CellMode, Size};

/// The whole picture's width over its height.
const ASPECT_RATIO: f32 = 40.0 / 24.0;

/// Waits for the picture of the ball with its light there, and nothing over it.
#[track_caller]
fn wait_for_light(session: &mut Session, light: Vec3) {
    let scene = load(BALL);
    let light = scene.lights()[0].moved_to(light);
    let scene = scene.with_lights([light]);
    let wanted = picture(&scene, CellMode::HALF_BLOCK, Size::new(40, 12), 2.0);
    session.wait_for("the picture in another light", SOON, |seen| shows(seen.screen(), &wanted));
}

/// Returns how far a drag moves the light in the scene of the ball.
fn dragged(by: Vec2) -> Vec3 {
    let scene = load(BALL);
    scene.camera().point_dragged(scene.lights()[0].position().expect("a point light"), by, ASPECT_RATIO)
}

#[test]
fn arrows_move_the_light_that_g_takes() {
    let mut session = looking(BALL, &[]);
    session.send(b"g");
    session.wait_for_text("light 1 of 1");
    // The light is far outside of the picture, up and to the right, and 5.1 from the eye.
    session.wait_for("its arrow", SOON, |seen| seen.screen().text()[0].contains("^ 5.1"));
    session.send(b"\x1b[D\x1b[D\x1b[B\x1b");
    let step = 1.0 / 32.0;
    wait_for_light(&mut session, dragged(Vec2::new(-2.0 * step / ASPECT_RATIO, step)));
    // With Shift a press is four steps; r resets the light; Esc leaves it where it is.
    session.send(b"g\x1b[1;2D\x1b");
    wait_for_light(&mut session, dragged(Vec2::new(-6.0 * step / ASPECT_RATIO, step)));
    session.send(b"gr\x1b");
    let start = load(BALL).lights()[0].position().expect("a point light");
    wait_for_light(&mut session, start);
    session.send(b"g\x1b[5~\x1b");
    wait_for_light(&mut session, load(BALL).camera().point_pushed_away(start, 1.0));
    session.send(b"g\x1b[6~\x1b[6~\x1b");
    wait_for_light(&mut session, load(BALL).camera().point_pushed_away(start, -1.0));
    assert_eq!(camera(&mut session), None, "the eye stays where it is");
}

#[test]
fn a_drag_moves_the_light_and_the_wheel_its_distance() {
    let start = load(BALL).lights()[0].position().expect("a point light");
    let mut session = looking(BALL, &[]);
    session.send(b"g");
    session.wait_for_text("^ 5.1");
    session.send(format!("{}\x1b", drag(0, [30, 2], [20, 5])).as_bytes());
    wait_for_light(&mut session, dragged(Vec2::new(-0.25, 0.25)));
    session.send(format!("gr{}\x1b", report(64, [5, 5], 'M')).as_bytes());
    wait_for_light(&mut session, load(BALL).camera().point_pushed_away(start, 1.0));
    session.send(format!("gr{}\x1b", report(65, [5, 5], 'M')).as_bytes());
    wait_for_light(&mut session, load(BALL).camera().point_pushed_away(start, -1.0));
    assert_eq!(camera(&mut session), None, "the eye stays where it is");
}

#[test]
fn the_light_nearest_to_the_pointer_is_taken_and_then_the_next() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let file = folder.path().join("lights.ron");
    let text = std::fs::read_to_string(BALL).expect("it is there");
    let right_and_left = "Point(position: (2, 2, 0)), Point(position: (-2, 2, 0))";
    std::fs::write(&file, text.replace("Point(position: (3, 5, 4), intensity: 30)", right_and_left)).expect("written");
    let file = file.to_str().expect("a plain name");
    for (column, first, second) in [(39, 1, 2), (0, 2, 1)] {
        let mut session = looking(file, &[]);
        session.send(format!("{}{}g", report(0, [column, 0], 'M'), report(0, [column, 0], 'm')).as_bytes());
        session.wait_for_text(&format!("light {first} of 2"));
        session.send(b"g");
        session.wait_for_text(&format!("light {second} of 2"));
        session.send(b"\x1b");
        session.wait_for("no mark", SOON, |seen| !seen.screen().text().concat().contains("(*)"));
    }
}
