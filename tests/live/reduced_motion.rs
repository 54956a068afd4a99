//! `--reduced-motion`: each press is one step at once, and nothing moves by itself.

use crate::pty::{SOON, Session, Size, Start};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/three_spheres.ron");

/// Presses keys, waits until the screen no longer changes, and leaves.
fn eye_after(keys: &[u8], flags: &[&str]) -> Vec<f32> {
    let start = Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).size(Size::cells(40, 12));
    let mut session = flags.iter().fold(start.arg("--reduced-motion"), Start::arg).says_when_it_rests().spawn();
    session.wait_for("a picture", SOON, |seen| seen.screen().text().concat().contains('▀'));
    session.send(keys);
    session.wait_for_rest();
    eye(&mut session)
}

/// Leaves, and returns the eye of the line that is printed.
fn eye(session: &mut Session) -> Vec<f32> {
    let before = session.seen().bytes().len();
    session.send(b"q");
    session.wait_exit(SOON);
    let said = String::from_utf8_lossy(&session.seen().bytes()[before..]).into_owned();
    let (_, rest) = said.split_once("eye: (").unwrap_or_else(|| panic!("{said}"));
    let numbers = rest.split(')').next().expect("it ends");
    numbers.split(", ").map(|number| number.parse().expect("a number")).collect()
}

fn is_near(eye: &[f32], wanted: [f32; 3]) -> bool {
    eye.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3)
}

/// A press moves a tenth of the way from (0, 2.1, 6.3) to (0, 0.9, 0).
///
/// Without the flag a tap would move a thirteenth of it, over several frames.
#[test]
fn a_press_is_one_step() {
    let at = eye_after(b"w", &[]);
    assert!(is_near(&at, [0.0, 1.98, 5.67]), "{at:?}");
}

#[test]
fn a_step_is_as_long_as_the_speed_that_was_set() {
    let at = eye_after(b"w", &["--move-speed=2"]);
    assert!(is_near(&at, [0.0, 1.86, 5.04]), "{at:?}");
    let at = eye_after(b"w", &["--move-speed=0.5", "--turn-speed=10"]);
    assert!(is_near(&at, [0.0, 2.04, 5.985]), "{at:?}");
}

/// A repeat is one more step, whatever the terminal reports as one, and other keys stop nothing.
#[test]
fn a_press_with_shift_is_four_steps_and_each_repeat_one_more() {
    let at = eye_after(b"Ww w", &[]);
    assert!(is_near(&at, [0.0, 1.38, 2.52]), "{at:?}");
}
