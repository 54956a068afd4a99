//! The mouse: reports in; the printed camera and the screen out.
//!
//! The screen has 40x12 cells of 10x20 pixels.

use crate::orbit::{BALL, TEAPOT, camera, load, looking, turned};
use crate::pty::{SOON, Session, Size, Start};
use glam::{Vec2, Vec3};
use termtrace::Camera;

/// The whole picture's width over its height.
const ASPECT_RATIO: f32 = 40.0 / 24.0;

const LEFT: u16 = 0;
const MIDDLE: u16 = 1;
const RIGHT: u16 = 2;
const SHIFT: u16 = 4;
const WAY: u16 = 32;
const WHEEL_UP: u16 = 64;
const WHEEL_DOWN: u16 = 65;

/// Returns a report of the mouse in a cell, counted from (0, 0).
pub(crate) fn report(code: u16, [column, row]: [u16; 2], end: char) -> String {
    format!("\x1b[<{code};{};{}{end}", column + 1, row + 1)
}

fn click(at: [u16; 2]) -> String {
    report(LEFT, at, 'M') + &report(LEFT, at, 'm')
}

pub(crate) fn drag(button: u16, from: [u16; 2], to: [u16; 2]) -> String {
    report(button, from, 'M') + &report(button + WAY, to, 'M') + &report(button, to, 'm')
}

/// Returns the camera after these reports.
fn after(scene: &str, reports: &str) -> Camera {
    let mut session = looking(scene, &[]);
    session.send(reports.as_bytes());
    session.wait_for_rest();
    camera(&mut session).unwrap_or_else(|| *load(scene).camera())
}

#[track_caller]
fn assert_near(found: Vec3, wanted: Vec3) {
    assert!(found.abs_diff_eq(wanted, 1e-3), "{found} is not {wanted}");
}

/// A drag over the height of the picture, 24 columns long, is half a round.
#[test]
fn the_left_button_orbits_a_mesh() {
    let start = load(TEAPOT).camera().pose();
    let way = start.eye - start.target;
    for (to, steps) in [([32, 6], -10.0), ([8, 6], 10.0)] {
        let pose = after(TEAPOT, &drag(LEFT, [20, 6], to)).pose();
        assert_near(pose.eye, start.target + turned(way, steps));
        assert_near(pose.target, start.target);
    }
    let pose = after(TEAPOT, &drag(LEFT, [20, 6], [20, 7])).pose();
    assert!(pose.eye.y > start.eye.y && (pose.eye.distance(start.target) - way.length()).abs() < 1e-3, "{pose:?}");
}

#[test]
fn the_left_button_looks_around_in_flight() {
    let start = load(BALL).camera().pose();
    let found = after(BALL, &drag(LEFT, [20, 6], [24, 6]));
    assert_eq!(found.pose().eye, start.eye);
    // The point in the middle has moved with the pointer.
    let at = found.project(start.target, ASPECT_RATIO).expect("it is in front of the eye");
    assert!(at.abs_diff_eq(Vec2::new(0.6, 0.5), 5e-3), "{at}");
}

#[test]
fn the_other_buttons_and_shift_shift_the_picture() {
    for button in [RIGHT, MIDDLE, LEFT + SHIFT] {
        for scene in [TEAPOT, BALL] {
            let start = *load(scene).camera();
            let found = after(scene, &drag(button, [10, 3], [14, 6]));
            let at = found.project(start.pose().target, ASPECT_RATIO).expect("it is in front of the eye");
            assert!(at.abs_diff_eq(Vec2::new(0.6, 0.75), 5e-4), "{button} {at}");
            assert_near(found.basis().w, start.basis().w);
        }
    }
}

#[test]
fn the_wheel_moves_towards_the_point_under_the_pointer() {
    let start = *load(BALL).camera();
    // The pointer in the middle is on the ball, at distance 4.
    let two = report(WHEEL_UP, [20, 6], 'M').repeat(2);
    let nearer = after(BALL, &two).pose();
    let middle = start.project(Vec3::new(0.0, 1.0, 1.0), ASPECT_RATIO).expect("in front");
    assert!(middle.abs_diff_eq(Vec2::splat(0.5), 1e-6));
    assert!((nearer.eye.z - (1.0 + 4.0 * 0.88 * 0.88)).abs() < 0.02, "{nearer:?}");
    assert!((nearer.eye.distance(nearer.target) - 5.0).abs() < 1e-3, "in flight the target goes with the eye");
    // The pointer is on the floor, lower left: its point stays where it is in the picture.
    let at = [8, 10];
    let place = Vec2::new(8.5 / 40.0, 10.5 / 12.0);
    let ray = start.eye_rays(ASPECT_RATIO).through(place.x, 1.0 - place.y - 0.25 / 12.0);
    let floor = ray.at(-ray.origin.y / ray.direction.y);
    for code in [WHEEL_UP, WHEEL_DOWN] {
        let found = after(BALL, &report(code, at, 'M'));
        let there = found.project(floor, ASPECT_RATIO).expect("in front");
        assert!((there - place).abs().max_element() < 0.03, "{there} is not {place}");
        let share = found.pose().eye.distance(floor) / start.pose().eye.distance(floor);
        let wanted = if code == WHEEL_UP { 0.88 } else { 1.0 / 0.88 };
        assert!((share - wanted).abs() < 1e-3, "{share}");
    }
}

#[test]
fn a_double_click_frames_the_scene() {
    let scene = load(TEAPOT);
    let bounds = scene.bounds().expect("there is a mesh");
    let moved = report(WHEEL_UP, [3, 3], 'M').repeat(4) + &click([20, 6]);
    let wanted = scene.camera().framing(&bounds, ASPECT_RATIO).pose();
    let found = after(TEAPOT, &(moved.clone() + &click([20, 6]))).pose();
    assert_near(found.eye, wanted.eye);
    assert_near(found.target, wanted.target);
    let once = after(TEAPOT, &moved).pose();
    assert!(once.eye.distance(wanted.eye) > 0.1, "one click does nothing");
}

/// Of several reports that are read together only the last counts; all lead to the same camera.
#[test]
fn only_the_last_of_several_pointer_reports_counts() {
    let there_and_back =
        |row: u16| (0..40).chain((0..40).rev()).map(move |column| report(LEFT + WAY, [column, row], 'M'));
    let ways: String = (0..40).flat_map(|_| there_and_back(6)).collect();
    let reports = report(LEFT, [20, 6], 'M') + &ways + &report(LEFT + WAY, [32, 6], 'M') + &report(LEFT, [32, 6], 'm');
    let start = load(TEAPOT).camera().pose();
    let pose = after(TEAPOT, &reports).pose();
    assert_near(pose.eye, start.target + turned(start.eye - start.target, -10.0));
}

/// A drag that begins on the line between two maps moves the line, and nothing else.
#[test]
fn the_line_of_a_wipe_is_dragged() {
    let mut session = looking(BALL, &["--map", "normal"]);
    session.send(b"||");
    let line = |column: usize| {
        move |session: &mut Session| {
            session.wait_for("the line", SOON, |seen| {
                (0..11).all(|row| {
                    let cell = seen.screen().cell(column, row);
                    [cell.foreground, cell.background].contains(&crate::pty::Colour::Rgb(255, 208, 64))
                })
            });
        }
    };
    line(20)(&mut session);
    session.send(drag(LEFT, [21, 4], [30, 8]).as_bytes());
    line(30)(&mut session);
    session.send(drag(LEFT, [30, 4], [2, 4]).as_bytes());
    line(2)(&mut session);
    assert_eq!(camera(&mut session), None);
}

#[test]
fn a_click_puts_the_cursor_of_an_explanation() {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(BALL).says_when_it_rests();
    let mut session = start.spawn();
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains('▀'));
    session.wait_for_rest();
    session.send(b"x");
    session.wait_for_text("(i, j) = (40, 24) of 80x48");
    session.send(click([10, 4]).as_bytes());
    session.wait_for_text("(i, j) = (10, 9) of 80x48");
    session.send(drag(LEFT, [12, 5], [70, 20]).as_bytes());
    session.wait_for_text("(i, j) = (70, 41) of 80x48");
    session.send(b"x");
    session.wait_for_rest();
    assert_eq!(camera(&mut session), None);
}

/// Positions are in pixels if the terminal reports that mode: the same drag as in cells.
#[test]
fn positions_may_be_reported_in_pixels() {
    let program = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(TEAPOT).size(Size::cells(40, 12)).mute();
    let mut session = program.says_when_it_rests().spawn();
    session.wait_for("the questions", SOON, |seen| seen.has(b"\x1b[?1016$p"));
    assert!(!session.seen().has(b"\x1b[?1016h"));
    session.send(b"\x1b[?1016;2$y\x1b[?62c");
    session.wait_for("pixels", SOON, |seen| seen.has(b"\x1b[?1016h"));
    // The queries after the first ones.
    let fence = session.seen().bytes().windows(3).position(|bytes| bytes == b"\x1b[c").expect("it has asked");
    session.answer_from(fence + 3);
    session.wait_for_rest();
    session.send(drag(LEFT, [205, 130], [325, 130]).as_bytes());
    session.wait_for_rest();
    let start = load(TEAPOT).camera().pose();
    let pose = camera(&mut session).expect("it was moved").pose();
    assert_near(pose.eye, start.target + turned(start.eye - start.target, -10.0));
}

/// While a question is open, keys answer it, and the view stays.
#[test]
fn a_question_is_not_dragged_away() {
    let mut session = looking(TEAPOT, &[]);
    session.send(b"m");
    session.wait_for_text("save this view as");
    session.send(drag(LEFT, [20, 6], [32, 6]).as_bytes());
    session.send(b"4");
    session.wait_for_text("saved as view 4");
    assert_eq!(camera(&mut session), None);
}
