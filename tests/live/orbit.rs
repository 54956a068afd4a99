//! Flying, orbiting and other changes of the view: keys in, the camera that is printed on leaving
//! out.

use crate::pty::{SOON, Session, Size, Start};
use glam::Vec3;
use termtrace::{Camera, Pose, Scene};

pub(crate) const BALL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/ball.ron");
pub(crate) const TEAPOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/teapot.obj");

pub(crate) fn load(scene: &str) -> Scene {
    Scene::load(scene.as_ref()).expect("the scene is fine")
}

/// Starts the view and waits for rest, at which a movement without a key would be seen.
pub(crate) fn looking(scene: &str, flags: &[&str]) -> Session {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(scene).size(Size::cells(40, 12));
    let mut session = flags.iter().fold(start, Start::arg).says_when_it_rests().spawn();
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains('▀'));
    session.wait_for_rest();
    session
}

/// Leaves, and reads the camera that is printed; `None` if it was not moved.
pub(crate) fn camera(session: &mut Session) -> Option<Camera> {
    let before = session.seen().bytes().len();
    session.send(b"q");
    session.wait_exit(SOON);
    session.assert_clean();
    let said = String::from_utf8_lossy(&session.seen().bytes()[before..]).into_owned();
    let line = said.lines().find_map(|line| Some(&line[line.find("camera:")?..]))?;
    Some(*Scene::from_ron("printed", &format!("({line})")).expect("a line for a scene file").camera())
}

/// Returns the camera after these keys, each of which is one step.
fn after(scene: &str, keys: &[u8]) -> Camera {
    let mut session = looking(scene, &["--reduced-motion"]);
    session.send(keys);
    session.wait_for_rest();
    camera(&mut session).unwrap_or_else(|| *load(scene).camera())
}

/// Returns a vector turned by steps of nine degrees.
pub(crate) fn turned(v: Vec3, steps: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(steps * std::f32::consts::PI / 20.0);
    Vec3::new(v.x * cos + v.z * sin, v.y, v.z * cos - v.x * sin)
}

#[test]
fn a_mesh_given_by_name_is_orbited() {
    let Pose { eye, target, .. } = load(TEAPOT).camera().pose();
    for (keys, steps) in [(&b"\x1b[D\x1b[Dh"[..], -3.0), (b"\x1b[Cll", 3.0), (b"L", 4.0)] {
        let pose = after(TEAPOT, keys).pose();
        let wanted = target + turned(eye - target, steps);
        assert!(pose.eye.abs_diff_eq(wanted, 1e-3), "{} is not {wanted}", pose.eye);
        assert!(pose.target.abs_diff_eq(target, 1e-3), "{}", pose.target);
    }
    let higher = after(TEAPOT, b"k\x1b[Ajk").pose().eye;
    assert!(higher.y > eye.y && (higher.distance(target) / eye.distance(target) - 1.0).abs() < 1e-3);
    let nearer = after(TEAPOT, b"ww").pose();
    assert!((nearer.eye.distance(target) / eye.distance(target) - libm::expf(-0.4)).abs() < 1e-3);
    assert_eq!(after(TEAPOT, b"wsr"), *load(TEAPOT).camera());
}

/// Tab makes the eye orbit the middle of the picture, and makes it fly again.
#[test]
fn a_scene_is_flown_through_until_tab() {
    let start = load(BALL).camera().pose();
    let flown = after(BALL, b"h").pose();
    assert_eq!(flown.eye, start.eye, "it looks around");
    let pose = after(BALL, b"\thh").pose();
    // The ball has radius 1, and the eye is straight before it.
    assert!(pose.target.abs_diff_eq(Vec3::new(0.0, 1.0, 1.0), 1e-3), "{}", pose.target);
    let wanted = pose.target + turned(4.0 * Vec3::Z, -2.0);
    assert!(pose.eye.abs_diff_eq(wanted, 1e-3), "{} is not {wanted}", pose.eye);
    let again = after(BALL, b"\t\th").pose();
    assert_eq!(again.eye, start.eye, "it looks around again");
}

#[test]
fn f_frames_the_scene() {
    let scene = load(BALL);
    let bounds = scene.bounds().expect("there is a ball");
    let found = after(BALL, b"wwwf");
    // 40x24 square pixels.
    let wanted = scene.camera().framing(&bounds, 40.0 / 24.0).pose();
    assert!(found.pose().eye.abs_diff_eq(wanted.eye, 1e-3) && found.pose().target.abs_diff_eq(wanted.target, 1e-3));
}

#[test]
fn brackets_change_the_field_of_view_and_show_it() {
    let mut session = looking(BALL, &[]);
    session.send(b"[[[");
    session.wait_for_text("field of view: 34.6 degrees");
    session.send(b"]");
    session.wait_for_text("field of view: 37.8 degrees");
    let camera = camera(&mut session).expect("it was changed");
    assert!((camera.rectangle().vertical_fov().to_degrees() - 37.8).abs() < 0.1);
    assert_eq!(camera.pose(), load(BALL).camera().pose());
}

/// A step of the tilt stops where vertical lines are parallel in the picture.
#[test]
fn keys_shift_and_tilt_the_view_rectangle_and_show_it() {
    let tower = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/tilted_rectangle.ron");
    let mut session = looking(tower, &["--tilt", "0,-20"]);
    session.send(b")");
    session.wait_for_text("shift 0 0.05");
    session.send(b"{");
    session.wait_for_text("tilt 0 -20.87: verticals are parallel");
    session.send(b"{");
    session.wait_for_text("tilt 0 -22");
    session.send(b"}((");
    session.wait_for_text("shift 0 -0.05");
    session.send(b"*");
    session.wait_for_text("shift 0.05 -0.05");
    session.send(b":");
    session.wait_for_text("tilt 2 -20.87");
    session.send(b"&;");
    session.wait_for_text("tilt 0 -20.87: verticals are parallel");
    session.send(b"i");
    session.wait_for_text("tilt 0 -20.87 · eye");
    let camera = camera(&mut session).expect("it was changed");
    let [shift, tilt] = [camera.rectangle().shift(), camera.rectangle().tilt()];
    assert!((shift.y + 0.05).abs() < 1e-4 && (tilt.y.to_degrees() + 20.87).abs() < 1e-2, "{shift} {tilt}");
    assert_eq!(camera.pose(), load(tower).camera().pose());
}

#[test]
fn keys_refuse_a_rectangle_that_contains_the_eye_or_passes_behind_it() {
    for (camera, keys, error) in [
        (["--tilt", "0,-88", "--fov", "60"], "{", "the tilt can be at most 89 degrees"),
        (["--tilt", "0,-60", "--fov", "60"], "((((((((((((", "the rectangle passes behind the eye"),
    ] {
        let mut session = looking(BALL, &camera);
        session.send(keys.as_bytes());
        session.wait_for_text(error);
    }
}

/// `V` splits the screen; the keys move first the second eye, then the first camera.
#[test]
fn v_shows_the_tracer_from_outside() {
    let mut session = looking(BALL, &[]);
    session.send(b"V");
    session.wait_for_text("keys move the second eye; V next");
    session.send(b"i");
    session.wait_for("the letters of the camera", SOON, |seen| {
        let text = seen.screen().text().concat();
        ["o", "v", "q", "p"].iter().all(|letter| text.contains(letter)) && text.contains("first camera")
    });
    // The second eye has a view rectangle, too, but the one to see is the first camera's.
    session.send(b"}");
    session.wait_for_text("tilt 0 2");
    // A key without a binding ends the note, which would be under way for five seconds. The second eye goes back to its
    // place beside the first camera, which stays in the picture.
    session.send(b"[r\x1b[24~");
    session.wait_for_rest();
    let text = session.seen().screen().text().concat();
    assert!(["o", "v", "q", "p"].iter().all(|letter| text.contains(letter)) && text.contains("first camera"), "{text}");
    session.send(b"V");
    session.wait_for_text("keys move the first camera; V next");
    session.send(b"[");
    session.wait_for_text("field of view: 41.3 degrees");
    session.send(b"V");
    session.wait_for_text("horizon and vanishing points; V next");
    session.send(b"V");
    session.wait_for_text("ordinary view; V next");
    session.send(b"\x1b[24~");
    session.wait_for_rest();
    assert!(!session.seen().screen().text().concat().contains("first camera"));
    let camera = camera(&mut session).expect("it was changed");
    assert_eq!(camera.pose(), load(BALL).camera().pose(), "the second eye has not moved the first camera");
    assert!((camera.rectangle().vertical_fov().to_degrees() - 41.3).abs() < 0.1, "one step of the zoom");
    assert!((camera.rectangle().tilt().y.to_degrees() - 2.0).abs() < 0.01, "one step of the tilt");
}

/// `I` builds the picture in both orders, up to the end; keys change the pace.
#[test]
fn i_builds_the_picture_in_both_orders() {
    for (size, left, right) in [
        (Size::cells(80, 24), "what object is visible at this pixel?", "at what pixels is this object visible?"),
        (Size::cells(40, 12), "image order", "object order"),
    ] {
        let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(BALL).size(size);
        let mut session = start.says_when_it_rests().spawn();
        session.wait_for_rest();
        session.send(b"I");
        session.wait_for_text(left);
        session.wait_for_text(right);
        session.send(b" ");
        session.wait_for_text("Space goes on; +- speed 1x");
        session.wait_for_rest();
        let text = session.seen().screen().text();
        assert_eq!(text.last().map(|row| row.trim()), Some(""), "the pictures end above the panel");
        session.send(b"++++++ ");
        session.wait_for_text("Space pauses; +- speed 64x");
        session.wait_for_text("10,000");
        session.wait_for_rest();
        session.send(b"\x1b");
        session.wait_for("the ordinary view", SOON, |seen| !seen.screen().text().concat().contains(left));
        session.send(b"II");
        session.wait_for_rest();
        assert!(!session.seen().screen().text().concat().contains(left), "I leaves too");
        assert_eq!(camera(&mut session), None, "the eye has not moved");
    }
}

/// The turntable turns until a command moves the eye; then nothing moves.
#[test]
fn t_turns_until_the_next_move() {
    let mut session = looking(TEAPOT, &[]);
    session.send(b"t");
    let mut frames = session.seen().bytes().len();
    for _ in 0..5 {
        session.wait_for("the next frame", SOON, |seen| seen.bytes().len() > frames);
        frames = session.seen().bytes().len();
    }
    // A loss of the focus releases keys and leaves the turntable on; the help does not move it.
    session.send(b"\x1b[O");
    session.send(b"?");
    session.wait_for_text("keys: orbit");
    frames = session.seen().bytes().len();
    session.wait_for("a frame below the help", SOON, |seen| seen.bytes().len() > frames);
    session.send(b"\x1b");
    session.wait_for("the help to go", SOON, |seen| !seen.screen().text().concat().contains("keys: orbit"));
    session.send(b"1r");
    session.wait_for_rest();
    assert_eq!(camera(&mut session), None, "r stops it and goes back");
}

#[test]
fn nothing_turns_by_itself_where_motion_is_reduced() {
    let mut session = looking(TEAPOT, &["--reduced-motion"]);
    session.send(b"t");
    session.wait_for_text("the turntable is off");
    // A key without a binding ends the note.
    session.send(b"\x1b[24~");
    session.wait_for_rest();
    assert_eq!(camera(&mut session), None);
}

#[test]
fn digits_go_to_the_views_of_the_scene_and_to_saved_ones() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let file = folder.path().join("views.ron");
    let text = std::fs::read_to_string(BALL).expect("it is there").replacen(
        "camera:",
        "views: [(eye: (1, 9, 0), target: (0, 0, 0)), (eye: (6, 1, 0), target: (0, 1, 0), vertical_fov: 30)],\n camera:",
        1,
    );
    std::fs::write(&file, text).expect("written");
    let file = file.to_str().expect("a plain name");
    let scene = load(file);
    assert_eq!(after(file, b"1"), scene.views()[0]);
    assert_eq!(after(file, b"1r2"), scene.views()[1]);
    // Saves over a view, for this session only; the digit that follows is its number.
    let moved = after(file, b"2w");
    assert_eq!(after(file, b"2wm1r1"), moved);
    assert_eq!(after(file, b"2wm9rr9"), moved);
    assert_eq!(after(file, b"2wmx1"), scene.views()[0], "x is no number, and explains nothing");
    let mut session = looking(file, &[]);
    session.send(b"m");
    session.wait_for_text("save this view as");
    session.send(b"3");
    session.wait_for_text("saved as view 3");
    session.send(b"4");
    session.wait_for_text("there is no view 4");
    assert_eq!(camera(&mut session), None);
}
