//! Keys + camera -> camera, pure: what each key does, and how held keys move the eye.
//!
//! Time is a number that is handed in, so that every movement can be tested without a clock.

use crate::camera::{Camera, Pose};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, ModifierKeyCode};
use glam::{Vec2, Vec3};
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
    // Keys of the window manager: only terminals that tell of everything tell of them.
    if key.modifiers.intersects(KeyModifiers::SUPER | KeyModifiers::HYPER | KeyModifiers::META) {
        return None;
    }
    let code = match unshifted(key.code) {
        // A terminal that does not tell what Shift makes of a key: it is so on most keyboards.
        KeyCode::Char('/') if shift => KeyCode::Char('?'),
        code => code,
    };
    let capital = code != key.code || shift;
    let found = BINDINGS.iter().find(|binding| binding.keys.contains(&Key { code, ctrl }))?;
    let moves = matches!(found.command, Command::Move(_) | Command::Look(_));
    // Capitals of letters that do not move are free for other commands.
    let is_letter = matches!(code, KeyCode::Char(c) if c.is_ascii_lowercase());
    (moves || ctrl || !is_letter || !capital).then_some((found.command, moves && capital))
}

/// A terminal sends a capital; a capital is its letter with Shift.
fn unshifted(code: KeyCode) -> KeyCode {
    match code {
        KeyCode::Char(c) => KeyCode::Char(c.to_ascii_lowercase()),
        code => code,
    }
}

/// The movement that keys keep going.
///
/// A terminal that tells of releases (the kitty keyboard protocol) leaves nothing to guess: any number of keys are held,
/// each from its press to its release.
///
/// A plain terminal tells of a press, is silent for about 660 ms, then repeats the last key some 25 times a second, and
/// never tells of a release. So a press glides until the first repeat may have come, unless another key is pressed;
/// once it repeats, it stops soon after the last one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    held: Vec<Held>,
    /// When all of them stop if nothing more is heard.
    until: Duration,
    /// With Shift.
    fast: bool,
    hears_releases: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Held {
    key: Place,
    command: Command,
}

/// A place on the keyboard, whatever Shift makes of it: the code, and whether it is of the keypad.
type Place = (KeyCode, bool);

fn place(key: &KeyEvent) -> Place {
    (unshifted(key.code), key.state.contains(KeyEventState::KEYPAD))
}

/// How long a press moves when no repeat follows: just longer than terminals wait before the first one.
pub const GLIDE: Duration = Duration::from_millis(700);
/// How long a repeated key moves on after its last repeat: longer than the pause between two.
pub const COAST: Duration = Duration::from_millis(150);

impl Motion {
    /// Whether the terminal tells of releases from now on. What is held is let go of when it no longer does.
    pub fn set_hears_releases(&mut self, hears_releases: bool) {
        if self.hears_releases && !hears_releases {
            self.stop();
        }
        self.hears_releases = hears_releases;
    }

    /// Whether the terminal tells of releases.
    pub fn hears_releases(&self) -> bool {
        self.hears_releases
    }

    /// A key event at a time. Where releases are not told, any press stops what was going on before.
    pub fn key(&mut self, key: &KeyEvent, now: Duration) {
        let moves = |(command, _): &(Command, bool)| matches!(command, Command::Move(_) | Command::Look(_));
        match (key.kind, command(key).filter(moves)) {
            (KeyEventKind::Release, _) => self.held.retain(|held| held.key != place(key)),
            (_, Some((command, fast))) => self.hold(Held { key: place(key), command }, fast, key.kind, now),
            (_, None) if self.hears_releases => {}
            (_, None) => self.held.clear(),
        }
        if let KeyCode::Modifier(ModifierKeyCode::LeftShift | ModifierKeyCode::RightShift) = key.code {
            // Of two held, one may be let go.
            self.fast = key.kind != KeyEventKind::Release || key.modifiers.contains(KeyModifiers::SHIFT);
        }
    }

    fn hold(&mut self, key: Held, fast: bool, kind: KeyEventKind, now: Duration) {
        let glides = self.until < Duration::MAX;
        let again = now <= self.until && self.held.contains(&key) || kind == KeyEventKind::Repeat;
        // Whether a key that glides is still held, nobody knows.
        self.held.retain(|held| !glides && held.key != key.key);
        self.held.push(key);
        self.fast = fast;
        self.until = match again {
            _ if self.hears_releases => Duration::MAX,
            true => now + COAST,
            false => now + GLIDE,
        };
    }

    /// Nothing is held any more.
    pub fn stop(&mut self) {
        self.held.clear();
        self.until = Duration::ZERO;
    }

    /// Whether anything moves at that time.
    pub fn is_moving(&self, now: Duration) -> bool {
        now < self.until && self.sum() != Sum::default()
    }

    /// The camera after the time from `from` to `to`, at `speed` world units per second.
    pub fn step(&self, camera: &Camera, speed: f32, from: Duration, to: Duration) -> Camera {
        let sum = self.sum();
        let seconds = to.min(self.until).saturating_sub(from).as_secs_f32();
        let seconds = if self.fast { FASTER * seconds } else { seconds };
        // Half of the turn before the way and half after it: a curve is nearly the same in one step as in many.
        let turn = |camera: Camera| match 0.5 * TURN_SPEED * seconds * sum.turn {
            Vec2::ZERO => camera,
            turn => with_pose(camera, turned(&camera, turn)),
        };
        let camera = turn(*camera);
        let camera = match speed * seconds * sum.way {
            Vec3::ZERO => camera,
            way => with_pose(camera, moved(&camera, way)),
        };
        turn(camera)
    }

    /// Opposite keys cancel; two keys for the same are one.
    fn sum(&self) -> Sum {
        let holds = |command: Command| self.held.iter().any(|held| held.command == command);
        let number = |command: Command| f32::from(u8::from(holds(command)));
        let way = |plus, minus| number(Command::Move(plus)) - number(Command::Move(minus));
        let turn = |plus, minus| number(Command::Look(plus)) - number(Command::Look(minus));
        Sum {
            way: Vec3::new(
                way(Direction::Right, Direction::Left),
                way(Direction::Up, Direction::Down),
                way(Direction::Back, Direction::Forward),
            ),
            turn: Vec2::new(turn(Turn::Left, Turn::Right), turn(Turn::Up, Turn::Down)),
        }
    }
}

/// What all held keys come to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sum {
    /// Along u, up and w.
    way: Vec3,
    /// To the left about up, and upwards about u.
    turn: Vec2,
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

/// Where the pose gives no picture (an eye too far out for f32), the view stays.
fn with_pose(camera: Camera, pose: Pose) -> Camera {
    camera.with_pose(pose).unwrap_or(camera)
}

/// `way` is along u, up and w.
fn moved(camera: &Camera, way: Vec3) -> Pose {
    let Pose { eye, target, up } = camera.pose();
    let basis = camera.basis();
    let by = way.x * basis.u + way.y * up.normalize_or_zero() + way.z * basis.w;
    Pose { eye: eye + by, target: target + by, up }
}

/// `turn` is to the left about up, and upwards about u.
fn turned(camera: &Camera, turn: Vec2) -> Pose {
    let Pose { eye, target, up } = camera.pose();
    let (left, upwards) = (turn.x, up_to_the_pole(camera, turn.y));
    let axis_up = up.normalize_or_zero();
    let u = rotated(camera.basis().u, axis_up, left);
    let view = rotated(rotated(target - eye, axis_up, left), u, upwards);
    Pose { eye, target: eye + view, up }
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
        assert_eq!(
            fast(KeyCode::Char('/')),
            Some((Command::Help, false)),
            "a terminal that tells only where the key is"
        );
        assert_eq!(command(&press('/')), None);
        assert_eq!(command(&press('R')), None, "a capital that moves nothing is free");
        for modifiers in [KeyModifiers::SUPER, KeyModifiers::HYPER, KeyModifiers::META] {
            assert_eq!(command(&KeyEvent { modifiers, ..press('q') }), None, "the window manager's");
        }
        assert_eq!(command(&KeyEvent::new(KeyCode::Char('w'), KeyModifiers::CONTROL)), None);
        assert_eq!(command(&KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)), Some((Command::Quit, false)));
    }

    fn event(c: char, kind: KeyEventKind) -> KeyEvent {
        KeyEvent { kind, ..press(c) }
    }

    fn release(c: char) -> KeyEvent {
        event(c, KeyEventKind::Release)
    }

    /// Keys pressed at time 0 on a terminal that tells of releases, and kept down.
    fn holding(keys: &str) -> Motion {
        let mut motion = Motion::default();
        motion.set_hears_releases(true);
        for c in keys.chars() {
            motion.key(&press(c), ms(0));
        }
        motion
    }

    /// Where the eye and the direction of view are after that time at speed 1.
    fn after(motion: &Motion, time: Duration) -> (Vec3, Vec3) {
        let pose = motion.step(&camera(), 1.0, ms(0), time).pose();
        (pose.eye, (pose.target - pose.eye).normalize())
    }

    #[track_caller]
    fn assert_after_a_second(keys: &str, eye: [f32; 3], view: [f32; 3]) {
        let (at, looks) = after(&holding(keys), ms(1_000));
        assert!(at.abs_diff_eq(Vec3::from(eye), 1e-5), "{keys}: eye {at}");
        assert!(looks.abs_diff_eq(Vec3::from(view), 1e-5), "{keys}: view {looks}");
    }

    const AHEAD: [f32; 3] = [0.0, 0.0, -1.0];
    const HERE: [f32; 3] = [0.0, 0.0, 4.0];

    /// Key, and where eye and view direction are after a second of it at speed 1.
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
        // To the left and upwards: 45 degrees each.
        assert_after_a_second("hk", HERE, [-0.5, turn, -0.5]);
        // Ahead on a curve: half of the turn before the way.
        assert_after_a_second("wh", [-0.382_68, 0.0, 4.0 - 0.923_88], [-turn, 0.0, -turn]);
    }

    #[test]
    fn opposite_keys_cancel_and_two_for_the_same_are_one() {
        for keys in ["ws", "ad", "ec", "hl", "kj", "wsadechlkj"] {
            let motion = holding(keys);
            assert!(!motion.is_moving(ms(10)), "{keys}");
            assert_eq!(motion.step(&camera(), 1.0, ms(0), ms(1_000)), camera(), "{keys}");
        }
        assert_after_a_second("wsa", [-1.0, 0.0, 4.0], AHEAD);
        let mut motion = holding("h");
        motion.key(&KeyCode::Left.into(), ms(0));
        assert_eq!(after(&motion, ms(1_000)), after(&holding("h"), ms(1_000)));
        motion.key(&release('h'), ms(10));
        assert!(motion.is_moving(ms(20)), "the other key is still held");
        motion.key(&KeyEvent { kind: KeyEventKind::Release, ..KeyCode::Left.into() }, ms(20));
        assert!(!motion.is_moving(ms(20)));
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

    #[test]
    fn without_releases_a_press_glides_for_700_ms() {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(100));
        assert!(motion.is_moving(ms(799)) && !motion.is_moving(ms(800)));
        motion.key(&press('w'), ms(1_000));
        assert!(motion.is_moving(ms(1_699)) && !motion.is_moving(ms(1_700)), "pressed anew");
    }

    #[test]
    fn without_releases_a_repeat_coasts_for_150_ms() {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(0));
        // The first repeat of a slow terminal comes in time; the others far faster.
        for at in [660, 700, 740] {
            assert!(motion.is_moving(ms(at)));
            motion.key(&press('w'), ms(at));
        }
        assert!(motion.is_moving(ms(889)) && !motion.is_moving(ms(890)));
        motion.key(&press('d'), ms(2_000));
        motion.key(&event('d', KeyEventKind::Repeat), ms(2_100));
        assert!(motion.is_moving(ms(2_249)) && !motion.is_moving(ms(2_250)), "a repeat told as one");
    }

    #[test]
    fn without_releases_another_key_stops_a_glide() {
        for other in ['d', 'i', 'x', 'R'] {
            let mut motion = Motion::default();
            motion.key(&press('w'), ms(0));
            motion.key(&press(other), ms(100));
            let z = motion.step(&camera(), 1.0, ms(100), ms(200)).pose().eye.z;
            assert_eq!(z, 4.0, "{other}");
            assert_eq!(motion.is_moving(ms(799)), other == 'd', "{other}: it glides itself");
        }
    }

    #[test]
    fn a_release_stops_a_glide_too() {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(0));
        motion.key(&release('w'), ms(50));
        assert!(!motion.is_moving(ms(50)));
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
            assert_eq!(motion.is_moving(ms(300)), other != release('W'), "{other:?}");
        }
    }

    #[test]
    fn a_release_counts_whatever_modifiers_are_held_by_then() {
        use KeyModifiers as Mods;
        for modifiers in [Mods::SHIFT, Mods::CONTROL, Mods::ALT, Mods::SUPER, Mods::CONTROL | Mods::SHIFT] {
            for c in ['w', 'W'] {
                let mut motion = holding("wW");
                motion.key(&KeyEvent { modifiers, ..release(c) }, ms(10));
                assert!(!motion.is_moving(ms(10)), "{c} with {modifiers:?}");
            }
        }
    }

    #[test]
    fn a_release_without_a_press_is_nothing() {
        let mut motion = holding("");
        let before = motion.clone();
        motion.key(&release('w'), ms(10));
        assert_eq!(motion, before);
    }

    #[test]
    fn a_repeat_without_a_press_is_a_key_that_is_held() {
        // It was pressed before the window had the focus.
        let mut motion = holding("");
        motion.key(&event('w', KeyEventKind::Repeat), ms(10));
        assert!(motion.is_moving(ms(10_000)));
        motion.key(&release('w'), ms(10_010));
        assert!(!motion.is_moving(ms(10_010)));
    }

    #[test]
    fn the_keypad_is_another_place() {
        let keypad = |kind| KeyEvent { kind, state: KeyEventState::KEYPAD, ..KeyCode::Left.into() };
        let mut motion = holding("");
        motion.key(&KeyCode::Left.into(), ms(0));
        motion.key(&keypad(KeyEventKind::Press), ms(0));
        motion.key(&keypad(KeyEventKind::Release), ms(10));
        assert!(motion.is_moving(ms(20)), "the arrow itself is held");
    }

    #[test]
    fn shift_makes_what_is_held_faster_while_it_is_held() {
        let shift =
            |kind, modifiers| KeyEvent::new_with_kind(KeyCode::Modifier(ModifierKeyCode::LeftShift), modifiers, kind);
        let way = |motion: &Motion| 4.0 - after(motion, ms(100)).0.z;
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
    fn a_glide_from_before_releases_were_told_ends_as_a_glide() {
        let mut motion = Motion::default();
        motion.key(&press('w'), ms(0));
        motion.set_hears_releases(true);
        assert!(motion.is_moving(ms(699)) && !motion.is_moving(ms(700)));
        let mut repeated = motion.clone();
        repeated.key(&event('w', KeyEventKind::Repeat), ms(660));
        assert!(repeated.is_moving(ms(5_000)), "it is held after all");
        // Nobody knows whether it still is.
        motion.key(&press('d'), ms(300));
        assert_eq!(motion, holding("d"));
    }

    #[test]
    fn nothing_is_held_when_all_is_stopped_or_releases_are_no_longer_told() {
        let mut motion = holding("wdh");
        motion.stop();
        assert!(!motion.is_moving(ms(0)));
        motion.key(&press('w'), ms(0));
        assert!(motion.is_moving(ms(5_000)), "pressed anew");
        motion.set_hears_releases(false);
        assert!(!motion.is_moving(ms(0)));
        motion.key(&press('w'), ms(0));
        assert!(!motion.is_moving(ms(700)), "it glides again");
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
