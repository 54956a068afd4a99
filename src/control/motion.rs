//! The motion of the camera by held keys.

use super::key::unshifted;
use super::{Command, Direction, Toward};
use crate::camera::Camera;
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, ModifierKeyCode};
use glam::{Vec2, Vec3};
use std::time::Duration;

/// The keys that are held, and the motion of the camera that they cause.
///
/// A tap moves the camera by a step: the distance covered in [`TAP_TIME`] at full speed. While a key is held, the
/// camera moves at full speed. If the key is released before the step is complete, the speed falls evenly to 0 over the
/// rest of the step.
///
/// With the kitty keyboard protocol the terminal reports releases, and each of any number of keys is held from its
/// press to its release.
///
/// A plain terminal reports a press, then after 250 to 660 ms repeats of the last key, some 25 a second, and no
/// release. On such a terminal a press counts as a tap. A repeat, or another press of the key within [`AGAIN_TIME`],
/// moves the camera at full speed for [`COAST_TIME`], which is longer than the interval between repeats. Another key
/// ends the motion at once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// The keys that move the camera.
    ///
    /// A key stays after its motion has ended, until the next press, which may come within [`AGAIN_TIME`].
    held: Vec<Held>,
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
    /// Time of the last press event. A repeat event of a held key does not change it.
    pressed: Duration,
    /// Time until which the key moves at full speed; `Duration::MAX` until its release.
    full_until: Duration,
    /// Time at which the speed, which falls evenly after `full_until`, is 0.
    ends: Duration,
    /// Factor of the motion: 1, or less for a tap that is shortened before a surface.
    tap_factor: f32,
}

impl Held {
    /// Returns the motion from time `from` to `to`, in seconds of motion at full speed.
    fn full_speed_seconds(&self, from: Duration, to: Duration) -> f32 {
        let full = to.min(self.full_until).saturating_sub(from);
        // The distance left while the speed falls evenly: half of the time left, times the speed at that time.
        let falls = self.ends.saturating_sub(self.full_until).as_secs_f32();
        let left = |at: Duration| {
            let left = self.ends.saturating_sub(at.max(self.full_until)).as_secs_f32();
            if falls > 0.0 { 0.5 * left * (left / falls) } else { 0.0 }
        };
        self.tap_factor * (full.as_secs_f32() + left(from) - left(to))
    }

    /// Releases the key at time `now`. The rest of an incomplete step follows at a falling speed.
    fn release(&mut self, now: Duration) {
        let rest = TAP_TIME.saturating_sub(now.saturating_sub(self.pressed));
        self.full_until = now;
        self.ends = now + 2 * rest;
    }
}

/// A key of the keyboard, independent of Shift.
///
/// It consists of the unshifted code, and whether it is on the keypad.
type PhysicalKey = (KeyCode, bool);

fn physical_key(key: &KeyEvent) -> PhysicalKey {
    (unshifted(key.code), key.state.contains(KeyEventState::KEYPAD))
}

/// Length of a tap's motion, as the time that it would take at full speed.
// A tap moves the eye by a thirteenth of the distance to the target, or turns it by seven degrees: small enough to
// place the eye precisely, large enough to be visible.
pub const TAP_TIME: Duration = Duration::from_millis(150);
/// Time after a press of a key within which another press of it continues the motion instead of
/// starting a new one.
// The eye moves for this long after a tap, at a falling speed, so quick taps make one motion. A held key repeats at
// least every 40 ms.
pub const AGAIN_TIME: Duration = Duration::from_millis(300);
/// Duration of the motion after the last repeat of a key.
// Repeats are 33 to 40 ms apart; three may be lost or late on a slow link without a visible stop.
pub const COAST_TIME: Duration = Duration::from_millis(150);

impl Motion {
    /// Returns a motion without held keys, with these factors of the default speeds.
    pub fn with_speed(key_speed: KeySpeed) -> Self {
        Self { key_speed, ..Self::default() }
    }

    /// Sets whether the terminal reports releases. If it no longer does, the motion of all keys
    /// ends at once.
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
    /// If the terminal does not report releases, a press of any other key ends the motion.
    pub fn take_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>, now: Duration) {
        // A release is matched by the physical key, not by the command, because the mode may have changed since the
        // press.
        match (key.kind, meant.filter(|(command, _)| command.is_motion())) {
            (KeyEventKind::Release, _) => {
                let key = physical_key(key);
                let lets_go = |held: &&mut Held| held.key == key && held.full_until > now;
                self.held.iter_mut().filter(lets_go).for_each(|held| held.release(now));
            }
            (_, Some((command, fast))) => self.hold(physical_key(key), command, fast, key.kind, now),
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

    fn hold(&mut self, key: PhysicalKey, command: Command, fast: bool, kind: KeyEventKind, now: Duration) {
        // Terminals without the kitty keyboard protocol send repeats as presses.
        let is_again = |held: &Held| (held.key, held.command) == (key, command) && now <= held.pressed + AGAIN_TIME;
        let again = kind == KeyEventKind::Repeat || self.held.iter().any(is_again);
        // A repeat keeps the time of the first press. With a time of its own it would count as a new tap, and the
        // motion would go on for the rest of that tap's step after the release.
        let is_held =
            |held: &&Held| kind == KeyEventKind::Repeat && held.key == key && held.full_until == Duration::MAX;
        let pressed = self.held.iter().find(is_held).map_or(now, |held| held.pressed);
        // Without reports of releases it is unknown whether the previous key is still held; it is assumed not to be,
        // because terminals repeat only the key pressed last.
        self.held.retain(|held| self.reports_releases && held.key != key && held.ends > now);
        self.fast = fast;
        let mut held = Held { key, command, pressed, full_until: Duration::MAX, ends: Duration::MAX, tap_factor: 1.0 };
        match (self.reports_releases, again) {
            // The key moves until the terminal reports its release, or that the window has lost the focus.
            (true, _) => {}
            (false, true) => (held.full_until, held.ends) = (now + COAST_TIME, now + COAST_TIME),
            (false, false) => held.release(now),
        }
        self.held.push(held);
    }

    /// Halves the rest of a tap's motion at time `now` until `is_free(self)`, at most six times.
    ///
    /// After six halvings, the motion ends.
    ///
    /// Does nothing while a key is held.
    pub fn halve_taps_until(&mut self, now: Duration, is_free: impl Fn(&Self) -> bool) {
        if self.held.iter().any(|held| held.full_until > now) {
            return;
        }
        for _ in 0..6 {
            if is_free(self) {
                return;
            }
            self.held.iter_mut().for_each(|held| held.tap_factor *= 0.5);
        }
        // The motion ends, but the key stays in `held`, so that another press within `AGAIN_TIME` counts as a repeat.
        self.held.iter_mut().for_each(|held| held.tap_factor = 0.0);
    }

    /// Ends the motion of all keys at once.
    pub fn stop(&mut self) {
        self.held.clear();
    }

    /// Returns whether a key causes motion at time `now`.
    pub fn is_moving(&self, now: Duration) -> bool {
        self.net_motion(|held| held.full_speed_seconds(now, now + Duration::from_millis(1))) != NetMotion::default()
    }

    /// Returns the camera after the motion from time `from` to `to`, at `speed` world units per
    /// second.
    pub fn step(&self, camera: &Camera, speed: f32, from: Duration, to: Duration) -> Camera {
        let net = self.net_motion(|held| held.full_speed_seconds(from, to));
        let shift = if self.fast { SHIFT_SPEED_FACTOR } else { 1.0 };
        // Strang splitting: half of the turn before the translation and half after it. The error is of third order in
        // the step, so that a curve hardly depends on the frame rate.
        let half = 0.5 * TURN_SPEED * self.key_speed.turning * shift;
        let (view, around) = (half * net.turn, half * net.around);
        let turn = |camera: Camera| camera.turned(-view.x, view.y).orbited(-around.x, around.y);
        let moving = self.key_speed.moving * shift;
        let way = speed * moving * net.way;
        let camera = turn(*camera).moved(way.x, way.y, -way.z);
        // `libm`, so that a motion has the same bits on every machine.
        turn(camera.nearer_within(libm::expf(-NEARER_SPEED * moving * net.nearer), speed))
    }

    /// Returns the motion of all held keys together, each for the seconds that `seconds` returns.
    ///
    /// Opposite keys cancel, and two keys of one command count once.
    fn net_motion(&self, seconds: impl Fn(&Held) -> f32) -> NetMotion {
        let number = |command: Command| {
            let held = self.held.iter().filter(|held| held.command == command);
            held.map(&seconds).fold(0.0, f32::max)
        };
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

/// The motion of all held keys, in seconds at full speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct NetMotion {
    /// Seconds of translation along the camera's u, up and w.
    way: Vec3,
    /// Seconds of turning the view direction: to the left about the up vector, and upwards about u.
    turn: Vec2,
    /// Seconds of rotating the eye about the target: to the left, and upwards.
    around: Vec2,
    /// Seconds of moving the eye towards the target; negative for moving away from it.
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
