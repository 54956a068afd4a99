//! The motion of the camera by held keys.

use super::key::unshifted;
use super::{Command, Direction, Toward};
use crate::camera::Camera;
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, ModifierKeyCode};
use glam::{Vec2, Vec3};
use std::time::Duration;

/// The keys that are held, and the motion of the camera that they cause.
///
/// With the kitty keyboard protocol the terminal reports releases, so any number of keys can be held, each from its
/// press to its release.
///
/// A plain terminal reports a press, then after about 660 ms repeats of the last key, some 25 a second, and no release.
/// So a press causes motion for [`GLIDE_TIME`], which bridges the delay before the first repeat, and each repeat for
/// [`COAST_TIME`], which bridges the interval between repeats. A press of another key ends the motion at once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    held: Vec<Held>,
    /// Time at which the motion stops if no further key event arrives.
    ///
    /// `Duration::MAX` if the terminal reports releases.
    until: Duration,
    /// Whether Shift is held.
    fast: bool,
    reports_releases: bool,
    key_speed: KeySpeed,
}

/// Factors of the default speeds of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeySpeed {
    /// Factor of the speeds of moving and of changing the distance to the target.
    pub moving: f32,
    /// Factor of the speeds of turning the view and of orbiting the target.
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

/// Duration of the motion after a press without repeats, if the terminal does not report releases.
// X11 repeats keys after 660 ms by default, the longest delay among common systems: with a shorter duration the motion
// by a held key stops once before the first repeat. The price is that a short press moves as long; only releases could
// shorten it.
pub const GLIDE_TIME: Duration = Duration::from_millis(700);
/// Duration of the motion after the last repeat of a key, if the terminal does not report releases.
// Repeats are 33 to 40 ms apart, so three may be lost or late on a slow link without a visible stop.
pub const COAST_TIME: Duration = Duration::from_millis(150);

impl Motion {
    /// Returns a motion without held keys, with these factors of the default speeds.
    pub fn with_speed(key_speed: KeySpeed) -> Self {
        Self { key_speed, ..Self::default() }
    }

    /// Sets whether the terminal reports releases. If it no longer does, all held keys are
    /// released.
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

    /// Handles a key event at time `now`. `meant` is the key's command, and whether Shift makes it
    /// faster.
    ///
    /// If the terminal does not report releases, any press ends the previous motion.
    pub fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        // A release is matched by the physical key, not by the command, because the mode may have changed since the
        // press.
        match (key.kind, meant.filter(|(command, _)| command.moves())) {
            (KeyEventKind::Release, _) => self.held.retain(|held| held.key != physical_key(key)),
            (_, Some((command, fast))) => self.hold(Held { key: physical_key(key), command }, fast, key.kind, now),
            (_, None) if self.reports_releases => {}
            // Without reports of releases, a press of any other key stops the motion: the terminal now repeats that key
            // only.
            (_, None) => self.held.clear(),
        }
        // Presses and releases of Shift alone, which only the kitty keyboard protocol reports, change the speed of held
        // keys.
        if let KeyCode::Modifier(ModifierKeyCode::LeftShift | ModifierKeyCode::RightShift) = key.code {
            // After the release of one Shift key the other may still be held, which the event's modifiers show.
            self.fast = key.kind != KeyEventKind::Release || key.modifiers.contains(KeyModifiers::SHIFT);
        }
    }

    fn hold(&mut self, key: Held, fast: bool, kind: KeyEventKind, now: Duration) {
        let glides = self.until < Duration::MAX;
        // Plain terminals send repeats as presses, so a press of a key that still causes motion counts as a repeat.
        let again = now <= self.until && self.held.contains(&key) || kind == KeyEventKind::Repeat;
        // Without reports of releases it is unknown whether the previous key is still held; it is assumed not to be,
        // because terminals repeat only the key pressed last.
        self.held.retain(|held| !glides && held.key != key.key);
        self.held.push(key);
        self.fast = fast;
        self.until = match again {
            // The motion ends by a release or by the loss of focus, which the terminal reports.
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
        // The motion may have ended between `from` and `to`.
        let seconds = to.min(self.until).saturating_sub(from).as_secs_f32();
        let seconds = if self.fast { SHIFT_SPEED_FACTOR * seconds } else { seconds };
        // Strang splitting: half of the rotation before the translation and half after it. The error per step is of
        // third order in its duration, so that a curved path hardly depends on the frame rate.
        let half = 0.5 * TURN_SPEED * self.key_speed.turning * seconds;
        let (view, around) = (half * net.turn, half * net.around);
        let turn = |camera: Camera| camera.turned(-view.x, view.y).orbited(-around.x, around.y);
        let seconds = self.key_speed.moving * seconds;
        let way = speed * seconds * net.way;
        let camera = turn(*camera).moved(way.x, way.y, -way.z);
        // By `libm`, so that a motion has the same bits on every machine.
        turn(camera.nearer_within(libm::expf(-NEARER_SPEED * seconds * net.nearer), speed))
    }

    /// Returns the combined motion of all held keys.
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

/// The direction of the combined motion of all held keys; each component is -1, 0 or 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct NetMotion {
    /// Translation along the camera's u, up and w.
    way: Vec3,
    /// Rotation of the view direction: to the left about the up vector, and upwards about u.
    turn: Vec2,
    /// Rotation of the eye about the target: to the left, and upwards.
    around: Vec2,
    /// Change of the eye's distance to the target: 1 for nearer, -1 for farther.
    nearer: f32,
}

/// Factor of all speeds while Shift is held.
const SHIFT_SPEED_FACTOR: f32 = 4.0;
/// Angular speed of turning in radians per second: a full turn in 8 s.
const TURN_SPEED: f32 = std::f32::consts::FRAC_PI_4;
/// Rate of approach per second: the distance to the target falls to 1/e of itself in one second.
// The distance changes exponentially, so that the speed fits every scale and the eye never passes the target.
const NEARER_SPEED: f32 = 1.0;

#[cfg(all(test, unit_tests))]
mod tests;
