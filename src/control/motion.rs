//! How held keys move the eye.

use super::{Command, Direction, Turn, bindings::unshifted, command};
use crate::camera::{Camera, Pose};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, ModifierKeyCode};
use glam::{Vec2, Vec3};
use std::time::Duration;

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
        match (key.kind, command(key).filter(|(command, _)| command.moves())) {
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
mod tests;
