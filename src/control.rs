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
    /// The whole screen again, in case something else wrote on it.
    Redraw,
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
    binding(&[ctrl('l')], "Ctrl-L", Command::Redraw, "draw the screen again"),
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
