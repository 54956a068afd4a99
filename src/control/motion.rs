//! The motion of the camera by held keys.

use super::key::unshifted;
use super::{Command, Direction, Toward};
use crate::camera::Camera;
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, ModifierKeyCode};
use glam::{Vec2, Vec3};
use std::time::Duration;

/// The keys that are held, and the motion that they cause.
///
/// With the kitty keyboard protocol the terminal reports releases, and each of any number of keys is held from its
/// press to its release.
///
/// A plain terminal reports a press, then after about 660 ms repeats of the last key, some 25 a second, and no release.
/// So a press moves for [`GLIDE_TIME`], which bridges the delay before the first repeat, and each repeat for
/// [`COAST_TIME`], which bridges the interval between repeats. Another key ends the motion at once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    held: Vec<Held>,
    /// Time at which the motion stops without further events.
    ///
    /// `Duration::MAX` where releases are reported.
    until: Duration,
    /// Whether Shift is held.
    fast: bool,
    reports_releases: bool,
    key_speed: KeySpeed,
}

/// Factors of the default speeds of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeySpeed {
    /// Factor of moving, and of changing the distance to the target.
    pub moving: f32,
    /// Factor of turning the view and of orbiting the target.
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

/// A key of the keyboard, independent of Shift.
///
/// It consists of the unshifted code, and whether it is on the keypad.
type PhysicalKey = (KeyCode, bool);

fn physical_key(key: &KeyEvent) -> PhysicalKey {
    (unshifted(key.code), key.state.contains(KeyEventState::KEYPAD))
}

/// Duration of the motion by a press without repeats.
// X11 repeats after 660 ms by default, the longest delay among common systems: with less, a held key stutters once.
// The price is that a tap glides as long; only releases could shorten it.
pub const GLIDE_TIME: Duration = Duration::from_millis(700);
/// Duration of the motion after the last repeat of a key.
// Repeats are 33 to 40 ms apart; three may be lost or late on a slow link without a visible stop.
pub const COAST_TIME: Duration = Duration::from_millis(150);

impl Motion {
    /// Returns a motion without held keys, at these speeds.
    pub fn with_speed(key_speed: KeySpeed) -> Self {
        Self { key_speed, ..Self::default() }
    }

    /// Sets whether the terminal reports releases. Held keys are released if it no longer does.
    pub fn set_reports_releases(&mut self, reports_releases: bool) {
        if self.reports_releases && !reports_releases {
            self.stop();
        }
        self.reports_releases = reports_releases;
    }

    /// Returns whether the terminal reports releases.
    pub fn reports_releases(&self) -> bool {
        self.reports_releases
    }

    /// Takes a key event at time `now`, with its command from the keymap and whether Shift makes
    /// that faster.
    ///
    /// Without reports of releases, any press ends the previous motion.
    pub fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        // Releases by the physical key, not by the command: the mode may have changed while it was held.
        match (key.kind, meant.filter(|(command, _)| command.moves())) {
            (KeyEventKind::Release, _) => self.held.retain(|held| held.key != physical_key(key)),
            (_, Some((command, fast))) => self.hold(Held { key: physical_key(key), command }, fast, key.kind, now),
            (_, None) if self.reports_releases => {}
            // The terminal repeats only the newest key, so the previous one would glide on unnoticed.
            (_, None) => self.held.clear(),
        }
        // Reported by the kitty keyboard protocol only: Shift pressed or released while a key is held.
        if let KeyCode::Modifier(ModifierKeyCode::LeftShift | ModifierKeyCode::RightShift) = key.code {
            // Of the two Shift keys, one may still be held: the modifiers of the event tell.
            self.fast = key.kind != KeyEventKind::Release || key.modifiers.contains(KeyModifiers::SHIFT);
        }
    }

    fn hold(&mut self, key: Held, fast: bool, kind: KeyEventKind, now: Duration) {
        let glides = self.until < Duration::MAX;
        // Plain terminals send repeats as presses; a press of the same key within the glide is taken for one.
        let again = now <= self.until && self.held.contains(&key) || kind == KeyEventKind::Repeat;
        // Without reports of releases it is unknown whether the previous key is still held; it is assumed not to be,
        // because terminals repeat only the key pressed last.
        self.held.retain(|held| !glides && held.key != key.key);
        self.held.push(key);
        self.fast = fast;
        self.until = match again {
            // A release will come, or the loss of the focus.
            _ if self.reports_releases => Duration::MAX,
            true => now + COAST_TIME,
            false => now + GLIDE_TIME,
        };
    }

    /// Releases all keys.
    pub fn stop(&mut self) {
        self.held.clear();
        self.until = Duration::ZERO;
    }

    /// Returns whether a key causes motion at time `now`.
    pub fn is_moving(&self, now: Duration) -> bool {
        now < self.until && self.net_motion() != NetMotion::default()
    }

    /// Returns the camera after the motion from time `from` to `to`, at `speed` world units per
    /// second.
    pub fn step(&self, camera: &Camera, speed: f32, from: Duration, to: Duration) -> Camera {
        let net = self.net_motion();
        // A glide may have ended between two frames.
        let seconds = to.min(self.until).saturating_sub(from).as_secs_f32();
        let seconds = if self.fast { SHIFT_SPEED_FACTOR * seconds } else { seconds };
        // Strang splitting: half of the turn before the translation and half after it. The error is of third order in
        // the step, so that a curve hardly depends on the frame rate.
        let half = 0.5 * TURN_SPEED * self.key_speed.turning * seconds;
        let (view, around) = (half * net.turn, half * net.around);
        let turn = |camera: Camera| camera.turned(-view.x, view.y).orbited(-around.x, around.y);
        let seconds = self.key_speed.moving * seconds;
        let way = speed * seconds * net.way;
        let camera = turn(*camera).moved(way.x, way.y, -way.z);
        // `libm`, so that a motion has the same bits on every machine.
        turn(camera.nearer_within(libm::expf(-NEARER_SPEED * seconds * net.nearer), speed))
    }

    /// Returns the motion of all held keys together.
    ///
    /// Opposite keys cancel, and two keys of one command count once.
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

/// The direction of the motion of all held keys; each component is -1, 0 or 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct NetMotion {
    /// Translation along u, up and w.
    way: Vec3,
    /// Rotation of the view: to the left about up, and upwards about u.
    turn: Vec2,
    /// Rotation of the eye about the target: to the left, and upwards.
    around: Vec2,
    /// Approach of the eye to the target.
    nearer: f32,
}

/// Factor of all speeds while Shift is held.
const SHIFT_SPEED_FACTOR: f32 = 4.0;
/// Angular speed of turning in radians per second: a full turn in 8 s.
const TURN_SPEED: f32 = std::f32::consts::FRAC_PI_4;
/// Rate of approach per second: the distance to the target falls to 1/e of itself in one second.
// Exponential, so that the target is approached at every scale and never passed.
const NEARER_SPEED: f32 = 1.0;

#[cfg(all(test, unit_tests))]
mod tests;
