//! How held keys move the eye.

use super::key::unshifted;
use super::{Command, Direction, Toward};
use crate::camera::Camera;
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
    reports_releases: bool,
    key_speed: KeySpeed,
}

/// How fast keys move and turn the view, in multiples of what is usual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeySpeed {
    /// Ways, and distances from the target.
    pub moving: f32,
    /// Turns, of the view and around the target.
    pub turning: f32,
}

impl Default for KeySpeed {
    fn default() -> Self {
        Self { moving: 1.0, turning: 1.0 }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Held {
    key: PhysicalKey,
    command: Command,
}

/// A place on the keyboard, whatever Shift makes of it: the code, and whether it is of the keypad.
type PhysicalKey = (KeyCode, bool);

fn physical_key(key: &KeyEvent) -> PhysicalKey {
    (unshifted(key.code), key.state.contains(KeyEventState::KEYPAD))
}

/// How long a press moves when no repeat follows: just longer than terminals wait before the first one.
pub const GLIDE_TIME: Duration = Duration::from_millis(700);
/// How long a repeated key moves on after its last repeat: longer than the pause between two.
pub const COAST_TIME: Duration = Duration::from_millis(150);

impl Motion {
    /// Nothing is held yet; what will be moves the eye at that key_speed.
    pub fn with_speed(key_speed: KeySpeed) -> Self {
        Self { key_speed, ..Self::default() }
    }

    /// Whether the terminal tells of releases from now on. What is held is let go of when it no longer does.
    pub fn set_reports_releases(&mut self, reports_releases: bool) {
        if self.reports_releases && !reports_releases {
            self.stop();
        }
        self.reports_releases = reports_releases;
    }

    /// Whether the terminal tells of releases.
    pub fn reports_releases(&self) -> bool {
        self.reports_releases
    }

    /// A key event at a time, what the key means, and whether Shift asks for more of it. Where releases are not told, any
    /// press stops what was going on before.
    pub fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        match (key.kind, meant.filter(|(command, _)| command.moves())) {
            (KeyEventKind::Release, _) => self.held.retain(|held| held.key != physical_key(key)),
            (_, Some((command, fast))) => self.hold(Held { key: physical_key(key), command }, fast, key.kind, now),
            (_, None) if self.reports_releases => {}
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
            _ if self.reports_releases => Duration::MAX,
            true => now + COAST_TIME,
            false => now + GLIDE_TIME,
        };
    }

    /// Nothing is held any more.
    pub fn stop(&mut self) {
        self.held.clear();
        self.until = Duration::ZERO;
    }

    /// Whether anything moves at that time.
    pub fn is_moving(&self, now: Duration) -> bool {
        now < self.until && self.net_motion() != NetMotion::default()
    }

    /// The camera after the time from `from` to `to`, at `speed` world units per second.
    pub fn step(&self, camera: &Camera, speed: f32, from: Duration, to: Duration) -> Camera {
        let net = self.net_motion();
        let seconds = to.min(self.until).saturating_sub(from).as_secs_f32();
        let seconds = if self.fast { SHIFT_SPEED_FACTOR * seconds } else { seconds };
        // Half of the turn before the way and half after it: a curve is nearly the same in one step as in many.
        let half = 0.5 * TURN_SPEED * self.key_speed.turning * seconds;
        let (view, around) = (half * net.turn, half * net.around);
        let turn = |camera: Camera| camera.turned(-view.x, view.y).orbited(-around.x, around.y);
        let seconds = self.key_speed.moving * seconds;
        let way = speed * seconds * net.way;
        let camera = turn(*camera).moved(way.x, way.y, -way.z);
        turn(camera.nearer_within(libm::expf(-NEARER_SPEED * seconds * net.nearer), speed))
    }

    /// Opposite keys cancel; two keys for the same are one.
    fn net_motion(&self) -> NetMotion {
        let holds = |command: Command| self.held.iter().any(|held| held.command == command);
        let number = |command: Command| f32::from(u8::from(holds(command)));
        let way = |plus, minus| number(Command::Move(plus)) - number(Command::Move(minus));
        let turn = |of: fn(Toward) -> Command| {
            let turn = |plus, minus| number(of(plus)) - number(of(minus));
            Vec2::new(turn(Toward::Left, Toward::Right), turn(Toward::Up, Toward::Down))
        };
        NetMotion {
            way: Vec3::new(
                way(Direction::Right, Direction::Left),
                way(Direction::Up, Direction::Down),
                way(Direction::Back, Direction::Forward),
            ),
            turn: turn(Command::Look),
            around: turn(Command::Around),
            nearer: number(Command::Nearer) - number(Command::Farther),
        }
    }
}

/// What all held keys come to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct NetMotion {
    /// Along u, up and w.
    way: Vec3,
    /// To the left about up, and upwards about u.
    turn: Vec2,
    /// The eye around the target, to the left and upwards.
    around: Vec2,
    /// The eye to the target.
    nearer: f32,
}

/// With Shift.
const SHIFT_SPEED_FACTOR: f32 = 4.0;
/// Radians per second.
const TURN_SPEED: f32 = std::f32::consts::FRAC_PI_4;
/// In a second the distance to the target becomes 1/e of it.
const NEARER_SPEED: f32 = 1.0;

#[cfg(test)]
mod tests;
