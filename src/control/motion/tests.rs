//! Tests of the camera's motion after key events at given times.

use super::*;
use crate::camera::{Pose, ViewRectangle};
use crate::control::{KeyMode, Keymap};

/// Adds a method to [`Motion`] that handles a key with its command in `KeyMode::Fly`.
trait Flown {
    fn key(&mut self, key: &KeyEvent, now: Duration);
}

impl Flown for Motion {
    fn key(&mut self, key: &KeyEvent, now: Duration) {
        self.take_key(key, Keymap::default().command(&[KeyMode::Fly, KeyMode::Always], key), now);
    }
}

fn camera() -> Camera {
    let pose = Pose { eye: Vec3::new(0.0, 0.0, 4.0), target: Vec3::ZERO, up: Vec3::Y };
    Camera::new(pose, ViewRectangle::from_vertical_fov(0.7).unwrap()).unwrap()
}

fn press(c: char) -> KeyEvent {
    KeyEvent::new(KeyCode::Char(c), KeyModifiers::NONE)
}

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn event(c: char, kind: KeyEventKind) -> KeyEvent {
    KeyEvent { kind, ..press(c) }
}

fn release(c: char) -> KeyEvent {
    event(c, KeyEventKind::Release)
}

/// Returns a motion with keys held since time 0, on a terminal that reports releases.
fn holding(keys: &str) -> Motion {
    let mut motion = Motion::default();
    motion.set_reports_releases(true);
    for c in keys.chars() {
        motion.key(&press(c), ms(0));
    }
    motion
}

/// Returns the eye and the view direction after `time` at a speed of 1 unit per second.
fn eye_and_view_after(motion: &Motion, time: Duration) -> (Vec3, Vec3) {
    let pose = motion.step(&camera(), 1.0, ms(0), time).pose();
    (pose.eye, (pose.target - pose.eye).normalize())
}

#[track_caller]
fn assert_after_a_second(keys: &str, eye: [f32; 3], view: [f32; 3]) {
    let (at, looks) = eye_and_view_after(&holding(keys), ms(1_000));
    assert!(at.abs_diff_eq(Vec3::from(eye), 1e-5), "{keys}: eye {at}");
    assert!(looks.abs_diff_eq(Vec3::from(view), 1e-5), "{keys}: view {looks}");
}

const AHEAD: [f32; 3] = [0.0, 0.0, -1.0];
const HERE: [f32; 3] = [0.0, 0.0, 4.0];

#[test]
fn moving_and_turning_have_separate_speeds() {
    let after = |keys, key_speed| {
        let motion = Motion { key_speed, ..holding(keys) };
        eye_and_view_after(&motion, ms(1_000))
    };
    let usual = KeySpeed::default();
    let (eye, _) = after("w", KeySpeed { moving: 2.0, ..usual });
    assert!(eye.abs_diff_eq(Vec3::new(0.0, 0.0, 2.0), 1e-5), "{eye}");
    assert_eq!(after("w", KeySpeed { turning: 2.0, ..usual }), after("w", usual));
    let (_, view) = after("l", KeySpeed { turning: 2.0, moving: 5.0 });
    assert!(view.abs_diff_eq(Vec3::X, 1e-5), "{view}");
}

/// Holds each key for a second at a speed of 1 unit per second, and checks eye and view direction.
#[test]
fn each_key_moves_the_camera_its_way() {
    let turn = std::f32::consts::FRAC_1_SQRT_2; // sine and cosine of the 45 degrees that a second turns
    for (key, eye, view) in [
        ("w", [0.0, 0.0, 3.0], AHEAD),
        ("s", [0.0, 0.0, 5.0], AHEAD),
        ("a", [-1.0, 0.0, 4.0], AHEAD),
        ("d", [1.0, 0.0, 4.0], AHEAD),
        ("e", [0.0, 1.0, 4.0], AHEAD),
        ("c", [0.0, -1.0, 4.0], AHEAD),
        ("h", HERE, [-turn, 0.0, -turn]),
        ("l", HERE, [turn, 0.0, -turn]),
        ("k", HERE, [0.0, turn, -turn]),
        ("j", HERE, [0.0, -turn, -turn]),
        ("W", [0.0, 0.0, 0.0], AHEAD),
    ] {
        assert_after_a_second(key, eye, view);
        let pose = holding(key).step(&camera(), 1.0, ms(0), ms(1_000)).pose();
        assert!((pose.target.distance(pose.eye) - 4.0).abs() < 1e-5, "{key}: the distance to the target stays");
    }
}

#[test]
fn any_number_of_keys_move_together() {
    let turn = std::f32::consts::FRAC_1_SQRT_2;
    assert_after_a_second("wa", [-1.0, 0.0, 3.0], AHEAD);
    assert_after_a_second("wde", [1.0, 1.0, 3.0], AHEAD);
    assert_after_a_second("ah", [-0.923_88, 0.0, 4.0 + 0.382_68], [-turn, 0.0, -turn]);
    // The view turns by 45 degrees to the left and by 45 degrees upwards.
    assert_after_a_second("hk", HERE, [-0.5, turn, -0.5]);
    // Forward on a curve: the view turns by 22.5 degrees before the translation and by as much after it.
    assert_after_a_second("wh", [-0.382_68, 0.0, 4.0 - 0.923_88], [-turn, 0.0, -turn]);
}

#[test]
fn opposite_keys_cancel_and_two_keys_of_a_command_count_once() {
    for keys in ["ws", "ad", "ec", "hl", "kj", "wsadechlkj"] {
        let motion = holding(keys);
        assert!(!motion.is_moving(ms(10)), "{keys}");
        assert_eq!(motion.step(&camera(), 1.0, ms(0), ms(1_000)), camera(), "{keys}");
    }
    assert_after_a_second("wsa", [-1.0, 0.0, 4.0], AHEAD);
    let mut motion = holding("h");
    motion.key(&KeyCode::Left.into(), ms(0));
    assert_eq!(eye_and_view_after(&motion, ms(1_000)), eye_and_view_after(&holding("h"), ms(1_000)));
    motion.key(&release('h'), ms(150));
    assert!(motion.is_moving(ms(160)), "the other key is still held");
    motion.key(&KeyEvent { kind: KeyEventKind::Release, ..KeyCode::Left.into() }, ms(160));
    assert!(!motion.is_moving(ms(160)));
}

#[test]
fn a_curve_does_not_depend_on_its_steps() {
    let motion = holding("wak");
    let at_once = motion.step(&camera(), 1.0, ms(0), ms(400)).pose();
    let mut in_steps = camera();
    for at in 0..400 {
        in_steps = motion.step(&in_steps, 1.0, ms(at), ms(at + 1));
    }
    assert!(at_once.target.abs_diff_eq(in_steps.pose().target, 2e-2), "{at_once:?} {:?}", in_steps.pose());
}

#[test]
fn movement_is_per_second_not_per_step() {
    let mut motion = Motion::default();
    motion.key(&press('h'), ms(0));
    let at_once = motion.step(&camera(), 1.0, ms(0), ms(600));
    let mut in_steps = camera();
    for at in (0..600).step_by(7) {
        in_steps = motion.step(&in_steps, 1.0, ms(at), ms((at + 7).min(600)));
    }
    assert!(at_once.pose().target.abs_diff_eq(in_steps.pose().target, 1e-4));
}

/// Returns the world units that the eye moves forward until `end` with these events of the key `w`.
///
/// `end` and the times of `events` are in milliseconds from 0.
fn forward_distance(motion: &mut Motion, events: &[(u64, KeyEventKind)], end: u64) -> f32 {
    let (mut camera, mut last) = (camera(), ms(0));
    for &(at, kind) in events {
        camera = motion.step(&camera, 1.0, last, ms(at));
        motion.key(&event('w', kind), ms(at));
        last = ms(at);
    }
    4.0 - motion.step(&camera, 1.0, last, ms(end)).pose().eye.z
}

const PRESS: KeyEventKind = KeyEventKind::Press;
const REPEAT: KeyEventKind = KeyEventKind::Repeat;
const RELEASE: KeyEventKind = KeyEventKind::Release;

#[track_caller]
fn assert_way(motion: &mut Motion, events: &[(u64, KeyEventKind)], wanted: f32) {
    let way = forward_distance(motion, events, 5_000);
    assert!((way - wanted).abs() < 1e-5, "{way}, not {wanted}: {events:?}");
}

#[test]
fn without_releases_a_press_is_a_step_of_falling_speed() {
    assert_way(&mut Motion::default(), &[(100, PRESS)], 0.15);
    let speeds = [100, 200, 300, 400].map(|at| {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(100));
        4.0 - motion.step(&camera(), 1.0, ms(at), ms(at + 1)).pose().eye.z
    });
    assert!(speeds.is_sorted_by(|a, b| a > b) && speeds[0] > 0.99e-3 && speeds[3] == 0.0, "{speeds:?}");
    // A second press after the end of the first step is another step, not a held key.
    assert_way(&mut Motion::default(), &[(100, PRESS), (500, PRESS)], 0.3);
}

#[test]
fn without_releases_a_second_press_soon_and_a_repeat_run_at_full_speed() {
    let first = 0.15 - 0.5 * 0.1 * 0.1 / 0.3;
    assert_way(&mut Motion::default(), &[(100, PRESS), (300, PRESS)], first + 0.15);
    assert_way(&mut Motion::default(), &[(100, PRESS), (1_000, REPEAT)], 0.3);
    let mut motion = Motion::default();
    let way = forward_distance(&mut motion, &[(0, PRESS), (300, PRESS), (340, PRESS), (380, PRESS)], 420);
    assert!((way - 0.15 - 0.12).abs() < 1e-5, "{way}");
    assert!(motion.is_moving(ms(529)) && !motion.is_moving(ms(530)));
}

/// A first repeat after a long delay counts as a tap; the later ones, 40 ms apart, continue it.
#[test]
fn without_releases_a_held_key_rests_until_its_repeats() {
    let mut motion = Motion::default();
    motion.key(&press('w'), ms(0));
    assert!(motion.is_moving(ms(299)) && !motion.is_moving(ms(300)));
    let repeats: Vec<_> = (660..1_660).step_by(40).map(|at| (at, PRESS)).collect();
    let way = forward_distance(&mut motion, &repeats, 1_660);
    assert!((way - 1.15).abs() < 0.01, "{way}");
}

#[test]
fn without_releases_another_key_ends_a_step() {
    for other in ['d', 'i', 'x', 'R'] {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(0));
        motion.key(&press(other), ms(100));
        let z = motion.step(&camera(), 1.0, ms(100), ms(200)).pose().eye.z;
        assert_eq!(z, 4.0, "{other}");
        assert_eq!(motion.is_moving(ms(399)), other == 'd', "{other}: a step of its own");
    }
}

/// A press shorter than a step still moves by a whole step; a longer one ends at its release.
#[test]
fn with_releases_a_tap_is_a_whole_step() {
    for (events, wanted) in [
        (&[(100, PRESS), (110, RELEASE)][..], 0.15),
        (&[(100, PRESS), (100, RELEASE)], 0.15),
        (&[(100, PRESS), (110, RELEASE), (120, RELEASE)], 0.15),
        (&[(100, PRESS), (240, RELEASE)], 0.15),
        (&[(100, PRESS), (400, RELEASE)], 0.3),
        (&[(100, PRESS), (700, REPEAT), (740, REPEAT), (745, RELEASE)], 0.645),
    ] {
        assert_way(&mut holding(""), events, wanted);
    }
}

#[test]
fn with_releases_a_key_is_held_from_press_to_release() {
    let mut motion = holding("w");
    assert!(motion.is_moving(ms(3_600_000)));
    motion.key(&event('w', KeyEventKind::Repeat), ms(660));
    assert!(motion.is_moving(ms(3_600_000)), "repeats change nothing");
    motion.key(&release('w'), ms(700));
    assert!(!motion.is_moving(ms(700)));
}

#[test]
fn with_releases_other_keys_stop_nothing() {
    let mut motion = holding("w");
    for other in [press('i'), release('i'), press('x'), release('d'), release('W'), press('w')] {
        motion.key(&press('w'), ms(100));
        motion.key(&other, ms(200));
        assert_eq!(motion.is_moving(ms(600)), other != release('W'), "{other:?}");
    }
}

#[test]
fn a_release_counts_with_any_modifiers() {
    use KeyModifiers as Mods;
    for modifiers in [Mods::SHIFT, Mods::CONTROL, Mods::ALT, Mods::SUPER, Mods::CONTROL | Mods::SHIFT] {
        for c in ['w', 'W'] {
            let mut motion = holding("wW");
            motion.key(&KeyEvent { modifiers, ..release(c) }, ms(150));
            assert!(!motion.is_moving(ms(150)), "{c} with {modifiers:?}");
        }
    }
}

#[test]
fn a_release_without_a_press_is_ignored() {
    let mut motion = holding("");
    let before = motion.clone();
    motion.key(&release('w'), ms(10));
    assert_eq!(motion, before);
}

#[test]
fn a_repeat_without_a_press_holds_the_key() {
    // The press is missing because another window had the focus then.
    let mut motion = holding("");
    motion.key(&event('w', REPEAT), ms(10));
    assert!(motion.is_moving(ms(10_000)));
    motion.key(&release('w'), ms(10_010));
    assert!(!motion.is_moving(ms(10_010)));
}

#[test]
fn keypad_keys_are_separate_keys() {
    let keypad = |kind| KeyEvent { kind, state: KeyEventState::KEYPAD, ..KeyCode::Left.into() };
    let mut motion = holding("");
    motion.key(&KeyCode::Left.into(), ms(0));
    motion.key(&keypad(KeyEventKind::Press), ms(0));
    motion.key(&keypad(KeyEventKind::Release), ms(10));
    assert!(motion.is_moving(ms(20)), "the arrow itself is held");
}

#[test]
fn shift_makes_held_keys_faster_while_it_is_held() {
    let shift =
        |kind, modifiers| KeyEvent::new_with_kind(KeyCode::Modifier(ModifierKeyCode::LeftShift), modifiers, kind);
    let way = |motion: &Motion| 4.0 - eye_and_view_after(motion, ms(100)).0.z;
    let mut motion = holding("w");
    motion.key(&shift(KeyEventKind::Press, KeyModifiers::NONE), ms(0));
    assert!((way(&motion) - 0.4).abs() < 1e-5, "{}", way(&motion));
    motion.key(&shift(KeyEventKind::Release, KeyModifiers::SHIFT), ms(0));
    assert!((way(&motion) - 0.4).abs() < 1e-5, "the other Shift is still held");
    motion.key(&shift(KeyEventKind::Release, KeyModifiers::NONE), ms(0));
    assert!((way(&motion) - 0.1).abs() < 1e-5, "{}", way(&motion));
    motion.key(&KeyEvent { modifiers: KeyModifiers::SHIFT, ..event('W', KeyEventKind::Repeat) }, ms(0));
    assert!((way(&motion) - 0.4).abs() < 1e-5, "the repeat says so too");
}

#[test]
fn a_step_from_before_reports_of_releases_ends_as_a_step() {
    let mut motion = Motion::default();
    motion.key(&press('w'), ms(0));
    motion.set_reports_releases(true);
    assert!(motion.is_moving(ms(299)) && !motion.is_moving(ms(300)));
    let mut repeated = motion.clone();
    repeated.key(&event('w', REPEAT), ms(660));
    assert!(repeated.is_moving(ms(5_000)), "it is held after all");
    motion.key(&press('d'), ms(300));
    assert_eq!(motion.held.len(), 1, "it has ended");
}

#[test]
fn all_keys_are_released_on_a_stop_and_when_reports_of_releases_end() {
    let mut motion = holding("wdh");
    motion.stop();
    assert!(!motion.is_moving(ms(0)));
    motion.key(&press('w'), ms(0));
    assert!(motion.is_moving(ms(5_000)), "pressed anew");
    motion.set_reports_releases(false);
    assert!(!motion.is_moving(ms(0)));
    motion.key(&press('w'), ms(0));
    assert!(!motion.is_moving(ms(300)), "it is a step again");
}

#[test]
fn a_step_never_goes_past_the_end_of_the_motion() {
    let mut motion = Motion::default();
    motion.key(&press('w'), ms(0));
    let eye = motion.step(&camera(), 1.0, ms(0), ms(60_000)).pose().eye;
    assert!((eye.z - 3.85).abs() < 1e-5, "{eye}");
    assert_eq!(motion.step(&camera(), 1.0, ms(800), ms(900)), camera(), "after its end nothing moves");
}

#[test]
fn the_view_never_turns_over_the_pole() {
    for key in ['k', 'j'] {
        let mut camera = camera();
        for at in (0..10_000).step_by(100) {
            let mut motion = Motion::default();
            motion.key(&press(key), ms(at));
            camera = motion.step(&camera, 1.0, ms(at), ms(at + 100));
        }
        let up = -camera.basis().w.y;
        assert!(up.abs() > 0.999 && up.abs() < 1.0, "{key}: {up}");
        assert!(camera.basis().v.y > 0.0, "up is still up");
        // At the pole, the opposite key still turns the view back.
        let mut motion = Motion::default();
        motion.key(&press(if key == 'k' { 'j' } else { 'k' }), ms(0));
        assert_ne!(motion.step(&camera, 1.0, ms(0), ms(100)), camera);
    }
}

#[test]
fn the_view_turns_about_a_tilted_up() {
    let up = Vec3::new(1.0, 1.0, 0.0);
    let camera = camera().with_pose(Pose { up, ..camera().pose() }).unwrap();
    let turned = holding("l").step(&camera, 1.0, ms(0), ms(500)).pose();
    assert!((turned.target - turned.eye).dot(up).abs() < 1e-5, "the view stays perpendicular to up");
    let eye = holding("e").step(&camera, 1.0, ms(0), ms(500)).pose().eye;
    assert!((eye - camera.pose().eye).abs_diff_eq(up.normalize() * 0.5, 1e-5));
}

/// Checks that orbiting keeps the target and the eye's distance to it.
#[test]
fn the_eye_orbits_the_target() {
    let after = |key: KeyCode, shift: bool| {
        let modifiers = if shift { KeyModifiers::SHIFT } else { KeyModifiers::NONE };
        let key = KeyEvent::new(key, modifiers);
        let mut motion = Motion::default();
        motion.set_reports_releases(true);
        motion.take_key(&key, Keymap::default().command(&[KeyMode::Orbit], &key), ms(0));
        motion.step(&camera(), 2.0, ms(0), ms(1_000)).pose()
    };
    let turn = 4.0 * std::f32::consts::FRAC_1_SQRT_2;
    for (key, eye) in [
        (KeyCode::Left, [-turn, 0.0, turn]),
        (KeyCode::Char('l'), [turn, 0.0, turn]),
        (KeyCode::Up, [0.0, turn, turn]),
        (KeyCode::Char('j'), [0.0, -turn, turn]),
        (KeyCode::Char('w'), [0.0, 0.0, 4.0 / std::f32::consts::E]),
        (KeyCode::Char('s'), [0.0, 0.0, 4.0 * std::f32::consts::E]),
    ] {
        let pose = after(key, false);
        assert!(pose.eye.abs_diff_eq(Vec3::from(eye), 1e-4), "{key:?}: {pose:?}");
        assert_eq!(pose.target, Vec3::ZERO, "{key:?}");
    }
    let pose = after(KeyCode::Char('d'), false);
    assert!(pose.eye.abs_diff_eq(Vec3::new(2.0, 0.0, 4.0), 1e-5), "{pose:?}");
    assert!(pose.target.abs_diff_eq(2.0 * Vec3::X, 1e-5), "{pose:?}");
    let fast = after(KeyCode::Left, true).eye;
    assert!(fast.abs_diff_eq(Vec3::new(0.0, 0.0, -4.0), 1e-4), "half a round: {fast}");
}
