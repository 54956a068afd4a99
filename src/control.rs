//! Keys + camera -> camera, pure: what each key does, and how held keys move the eye.
//!
//! Time is a number that is handed in, so that every movement can be tested without a clock.

use crate::camera::{Camera, Pose};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use glam::Vec3;
use std::time::Duration;

/// What a key can mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// The eye moves while the key is held.
    Move(Direction),
    /// The view turns while the key is held.
    Look(Turn),
    /// Back to the view at the start.
    Reset,
    /// The status line on or off.
    Status,
    /// The help on or off.
    Help,
    /// The help off.
    Close,
    /// The whole screen again, in case something else wrote on it.
    Redraw,
    /// Back to the shell, to come again.
    Suspend,
    /// Out.
    Quit,
}

/// A direction as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along the view.
    Forward,
    /// Against it.
    Back,
    /// Against u.
    Left,
    /// Along u.
    Right,
    /// Along up.
    Up,
    /// Against up.
    Down,
}

/// Where the view turns to, as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// About up.
    Left,
    /// About up.
    Right,
    /// About u.
    Up,
    /// About u.
    Down,
}

/// Keys and what they do: the one table that is asked when a key is pressed, and that the help shows.
pub struct Binding {
    /// The keys, each of which does it.
    pub keys: &'static [Key],
    /// How the help writes the keys.
    pub label: &'static str,
    /// What they do.
    pub command: Command,
    /// What the help says of it.
    pub does: &'static str,
}

/// A key: its code, as typed without Shift, and whether Ctrl is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Which one.
    pub code: KeyCode,
    /// With Ctrl.
    pub ctrl: bool,
}

const fn letter(c: char) -> Key {
    Key { code: KeyCode::Char(c), ctrl: false }
}

const fn ctrl(c: char) -> Key {
    Key { code: KeyCode::Char(c), ctrl: true }
}

const fn named(code: KeyCode) -> Key {
    Key { code, ctrl: false }
}

const fn binding(keys: &'static [Key], label: &'static str, command: Command, does: &'static str) -> Binding {
    Binding { keys, label, command, does }
}

/// All bindings, in the order of the help.
pub const BINDINGS: &[Binding] = &[
    binding(&[letter('w')], "w", Command::Move(Direction::Forward), "move forward"),
    binding(&[letter('s')], "s", Command::Move(Direction::Back), "move back"),
    binding(&[letter('a')], "a", Command::Move(Direction::Left), "move left"),
    binding(&[letter('d')], "d", Command::Move(Direction::Right), "move right"),
    binding(&[letter('e'), named(KeyCode::PageUp)], "e PageUp", Command::Move(Direction::Up), "move up"),
    binding(&[letter('c'), named(KeyCode::PageDown)], "c PageDown", Command::Move(Direction::Down), "move down"),
    binding(&[named(KeyCode::Left), letter('h')], "Left h", Command::Look(Turn::Left), "look left"),
    binding(&[named(KeyCode::Right), letter('l')], "Right l", Command::Look(Turn::Right), "look right"),
    binding(&[named(KeyCode::Up), letter('k')], "Up k", Command::Look(Turn::Up), "look up"),
    binding(&[named(KeyCode::Down), letter('j')], "Down j", Command::Look(Turn::Down), "look down"),
    binding(&[letter('r')], "r", Command::Reset, "back to the first view"),
    binding(&[letter('i')], "i", Command::Status, "status line"),
    binding(&[letter('?')], "?", Command::Help, "this help"),
    binding(&[named(KeyCode::Esc)], "Esc", Command::Close, "close it"),
    binding(&[ctrl('l')], "Ctrl-L", Command::Redraw, "draw the screen again"),
    binding(&[ctrl('z')], "Ctrl-Z", Command::Suspend, "to the shell; fg comes back"),
    binding(&[letter('q'), ctrl('c')], "q Ctrl-C", Command::Quit, "leave"),
];

/// What the key means, and whether Shift makes it faster.
pub fn command(key: &KeyEvent) -> Option<(Command, bool)> {
    let shift = key.modifiers.contains(KeyModifiers::SHIFT);
    let ctrl = key.modifiers.contains(KeyModifiers::CONTROL);
    let code = match key.code {
        // A terminal sends a capital; a capital is its letter with Shift.
        KeyCode::Char(c) if c.is_ascii_uppercase() => KeyCode::Char(c.to_ascii_lowercase()),
        code => code,
    };
    let capital = code != key.code || shift;
    let found = BINDINGS.iter().find(|binding| binding.keys.contains(&Key { code, ctrl }))?;
    let moves = matches!(found.command, Command::Move(_) | Command::Look(_));
    // Capitals of letters that do not move are free for other commands.
    let is_letter = matches!(code, KeyCode::Char(c) if c.is_ascii_lowercase());
    (moves || ctrl || !is_letter || !capital).then_some((found.command, moves && capital))
}

/// The movement that a key keeps going.
///
/// A plain terminal tells of a press, is silent for about 660 ms, then repeats the last key some 25 times a second, and
/// never tells of a release. So a press glides until the first repeat may have come, unless another key is pressed;
/// once it repeats, it stops soon after the last one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    held: Option<Held>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Held {
    key: KeyCode,
    command: Command,
    fast: bool,
    /// When it stops if nothing more is heard.
    until: Duration,
}

/// How long a press moves when no repeat follows: just longer than terminals wait before the first one.
pub const GLIDE: Duration = Duration::from_millis(700);
/// How long a repeated key moves on after its last repeat: longer than the pause between two.
pub const COAST: Duration = Duration::from_millis(150);

impl Motion {
    /// A key event at a time. Any press stops what was going on before.
    pub fn key(&mut self, key: &KeyEvent, now: Duration) {
        let command = command(key).filter(|(command, _)| matches!(command, Command::Move(_) | Command::Look(_)));
        let same = self.held.filter(|held| held.key == key.code && now <= held.until);
        self.held = match (key.kind, command) {
            (KeyEventKind::Release, _) => self.held.filter(|held| held.key != key.code),
            (_, None) => None,
            (_, Some((command, fast))) => {
                let until = now + if same.is_some() { COAST } else { GLIDE };
                Some(Held { key: key.code, command, fast, until })
            }
        };
    }

    /// Nothing is held any more.
    pub fn stop(&mut self) {
        self.held = None;
    }

    /// Whether anything moves at that time.
    pub fn is_moving(&self, now: Duration) -> bool {
        self.held.is_some_and(|held| now < held.until)
    }

    /// The camera after the time from `from` to `to`, at `speed` world units per second.
    pub fn step(&self, camera: &Camera, speed: f32, from: Duration, to: Duration) -> Camera {
        let Some(held) = self.held else { return *camera };
        let seconds = to.min(held.until).saturating_sub(from).as_secs_f32();
        let seconds = if held.fast { FASTER * seconds } else { seconds };
        let pose = match held.command {
            Command::Move(direction) => moved(camera, direction, speed * seconds),
            Command::Look(turn) => turned(camera, turn, TURN_SPEED * seconds),
            _ => camera.pose(),
        };
        // Where the new pose gives no picture (an eye too far out for f32), the view stays.
        camera.with_pose(pose).unwrap_or(*camera)
    }
}

/// With Shift.
const FASTER: f32 = 4.0;
/// Radians per second.
const TURN_SPEED: f32 = std::f32::consts::FRAC_PI_4;
/// The view keeps this far, in radians, from straight up and straight down, where no direction would be vertical.
const POLE: f32 = 0.02;

/// World units per second at which a scene is pleasant to fly through: half the way to the target.
pub fn speed(camera: &Camera) -> f32 {
    let Pose { eye, target, .. } = camera.pose();
    0.5 * eye.distance(target)
}

fn moved(camera: &Camera, direction: Direction, distance: f32) -> Pose {
    let Pose { eye, target, up } = camera.pose();
    let basis = camera.basis();
    let by = distance
        * match direction {
            Direction::Forward => -basis.w,
            Direction::Back => basis.w,
            Direction::Left => -basis.u,
            Direction::Right => basis.u,
            Direction::Up => up.normalize_or_zero(),
            Direction::Down => -up.normalize_or_zero(),
        };
    Pose { eye: eye + by, target: target + by, up }
}

fn turned(camera: &Camera, turn: Turn, angle: f32) -> Pose {
    let Pose { eye, target, up } = camera.pose();
    let view = target - eye;
    let axis_up = up.normalize_or_zero();
    let turned = match turn {
        Turn::Left => rotated(view, axis_up, angle),
        Turn::Right => rotated(view, axis_up, -angle),
        Turn::Up => rotated(view, camera.basis().u, up_to_the_pole(camera, angle)),
        Turn::Down => rotated(view, camera.basis().u, up_to_the_pole(camera, -angle)),
    };
    Pose { eye, target: eye + turned, up }
}

/// As much of an upward turn as the pole leaves. A view that begins beyond the limit may turn away from the pole only.
fn up_to_the_pole(camera: &Camera, angle: f32) -> f32 {
    let limit = std::f32::consts::FRAC_PI_2 - POLE;
    let sine = -camera.basis().w.dot(camera.pose().up.normalize_or_zero());
    let elevation = libm::asinf(sine.clamp(-1.0, 1.0));
    if angle > 0.0 { angle.min((limit - elevation).max(0.0)) } else { angle.max((-limit - elevation).min(0.0)) }
}

/// Rodrigues' rotation of `v` about a unit axis, to the left when seen against it; the length is kept.
fn rotated(v: Vec3, axis: Vec3, angle: f32) -> Vec3 {
    let (sin, cos) = libm::sincosf(angle);
    let turned = v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    turned * (v.length() / turned.length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ViewRectangle;
    use std::collections::HashSet;

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

    #[test]
    fn no_key_is_bound_twice() {
        let mut seen = HashSet::new();
        for key in BINDINGS.iter().flat_map(|binding| binding.keys) {
            assert!(seen.insert(format!("{key:?}")), "{key:?} is bound twice");
        }
        // Shift makes movement faster: no other command may be the capital of one of its letters.
        let moves = |c: &Command| matches!(c, Command::Move(_) | Command::Look(_));
        for binding in BINDINGS.iter().filter(|binding| moves(&binding.command)) {
            for key in binding.keys {
                if let KeyCode::Char(letter) = key.code {
                    let capital = Key { code: KeyCode::Char(letter.to_ascii_uppercase()), ctrl: key.ctrl };
                    assert!(!BINDINGS.iter().any(|other| other.keys.contains(&capital)), "{capital:?}");
                }
            }
        }
    }

    #[test]
    fn keys_mean_what_the_table_says() {
        let fast = |code| command(&KeyEvent::new(code, KeyModifiers::SHIFT));
        assert_eq!(command(&press('w')), Some((Command::Move(Direction::Forward), false)));
        assert_eq!(command(&press('W')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Char('W')), Some((Command::Move(Direction::Forward), true)));
        assert_eq!(fast(KeyCode::Left), Some((Command::Look(Turn::Left), true)));
        assert_eq!(fast(KeyCode::PageUp), Some((Command::Move(Direction::Up), true)));
        assert_eq!(command(&press('?')), Some((Command::Help, false)));
        assert_eq!(fast(KeyCode::Char('?')), Some((Command::Help, false)), "however it is typed");
        assert_eq!(command(&press('R')), None, "a capital that moves nothing is free");
        assert_eq!(command(&KeyEvent::new(KeyCode::Char('w'), KeyModifiers::CONTROL)), None);
        assert_eq!(command(&KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)), Some((Command::Quit, false)));
    }

    /// Key, and where eye and view direction are after a second of it at speed 1.
    #[test]
    fn each_key_moves_the_camera_its_way() {
        let turn = std::f32::consts::FRAC_1_SQRT_2; // sine and cosine of the 45 degrees that a second turns
        for (key, eye, view) in [
            ('w', [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]),
            ('s', [0.0, 0.0, 5.0], [0.0, 0.0, -1.0]),
            ('a', [-1.0, 0.0, 4.0], [0.0, 0.0, -1.0]),
            ('d', [1.0, 0.0, 4.0], [0.0, 0.0, -1.0]),
            ('e', [0.0, 1.0, 4.0], [0.0, 0.0, -1.0]),
            ('c', [0.0, -1.0, 4.0], [0.0, 0.0, -1.0]),
            ('h', [0.0, 0.0, 4.0], [-turn, 0.0, -turn]),
            ('l', [0.0, 0.0, 4.0], [turn, 0.0, -turn]),
            ('k', [0.0, 0.0, 4.0], [0.0, turn, -turn]),
            ('j', [0.0, 0.0, 4.0], [0.0, -turn, -turn]),
            ('W', [0.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ] {
            let (command, fast) = command(&press(key)).unwrap();
            let held = Held { key: KeyCode::Char(key), command, fast, until: ms(9_000) };
            let pose = Motion { held: Some(held) }.step(&camera(), 1.0, ms(1_000), ms(2_000)).pose();
            assert!(pose.eye.abs_diff_eq(Vec3::from(eye), 1e-5), "{key}: eye {}", pose.eye);
            let looks = (pose.target - pose.eye).normalize();
            assert!(looks.abs_diff_eq(Vec3::from(view), 1e-5), "{key}: view {looks}");
            assert!((pose.target.distance(pose.eye) - 4.0).abs() < 1e-5, "{key}: the distance to the target stays");
        }
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

    #[test]
    fn a_press_glides_a_repeat_coasts_and_another_key_stops_it() {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(0));
        assert!(motion.is_moving(ms(699)) && !motion.is_moving(ms(700)), "a single press");
        motion.key(&press('w'), ms(660));
        assert!(motion.is_moving(ms(700)), "the first repeat comes in time");
        motion.key(&press('w'), ms(700));
        assert!(motion.is_moving(ms(849)) && !motion.is_moving(ms(850)), "the last repeat");
        motion.key(&press('w'), ms(1_000));
        assert!(motion.is_moving(ms(1_699)), "pressed anew");
        motion.key(&press('i'), ms(1_100));
        assert!(!motion.is_moving(ms(1_100)), "another key");
        motion.key(&press('w'), ms(2_000));
        motion.key(&KeyEvent { kind: KeyEventKind::Release, ..press('w') }, ms(2_050));
        assert!(!motion.is_moving(ms(2_050)), "a terminal that tells of releases");
    }

    #[test]
    fn a_step_never_goes_past_the_end_of_the_motion() {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(0));
        let eye = motion.step(&camera(), 1.0, ms(0), ms(60_000)).pose().eye;
        assert!((eye.z - 3.3).abs() < 1e-5, "{eye}");
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
            // And back again.
            let mut motion = Motion::default();
            motion.key(&press(if key == 'k' { 'j' } else { 'k' }), ms(0));
            assert_ne!(motion.step(&camera, 1.0, ms(0), ms(100)), camera);
        }
    }

    #[test]
    fn a_tilted_up_is_what_is_turned_about() {
        let up = Vec3::new(1.0, 1.0, 0.0);
        let camera = camera().with_pose(Pose { up, ..camera().pose() }).unwrap();
        let mut motion = Motion::default();
        motion.key(&press('l'), ms(0));
        let turned = motion.step(&camera, 1.0, ms(0), ms(500)).pose();
        assert!((turned.target - turned.eye).dot(up).abs() < 1e-5, "the view stays perpendicular to up");
        motion.key(&press('e'), ms(0));
        let eye = motion.step(&camera, 1.0, ms(0), ms(500)).pose().eye;
        assert!((eye - camera.pose().eye).abs_diff_eq(up.normalize() * 0.5, 1e-5));
    }
}
