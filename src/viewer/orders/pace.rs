//! The pace at which image order and object order build their pictures.

use std::time::Duration;

/// The time of a whole build at speed 1.
const BUILD_TIME: Duration = Duration::from_secs(10);

/// The least time between two steps that are shown.
// More than twenty pictures a second would not look smoother, because image order advances by whole pixels, each as
// wide as a character.
const STEP: Duration = Duration::from_millis(50);

/// The number of steps of a build with reduced motion, one for each press of a key.
const STEPS: u64 = 16;

/// The least and the greatest exponent of the speed, which is a power of two.
// A build then takes from 160 s down to 0.16 s, which is three shown steps.
const POWERS: [i32; 2] = [-4, 6];

/// The progress of a build in tests of a ray or pixel against an object.
pub(in crate::viewer) struct BuildPace {
    /// The tests carried out, at most `total`.
    // Not an integer, because a step of a small scene may carry out less than one test.
    tests: f64,
    // The number of tests of the whole build; `u64::MAX` from `start` until `set_total`.
    total: u64,
    /// The exponent of the speed, which is 2 to this power.
    power: i32,
    is_paused: bool,
    /// Whether the build proceeds only by key presses, one step each.
    by_steps: bool,
    /// The time up to which the build has been carried out; `None` if it has not begun or pauses.
    since: Option<Duration>,
}

impl BuildPace {
    pub(super) fn new(by_steps: bool) -> Self {
        Self { tests: 0.0, total: u64::MAX, power: 0, is_paused: false, by_steps, since: None }
    }

    /// Begins a build; one that proceeds by key presses is shown complete until the first press.
    pub(super) fn start(&mut self) {
        self.total = u64::MAX;
        self.tests = if self.by_steps { f64::INFINITY } else { 0.0 };
        self.since = None;
    }

    /// Sets the number of tests of the whole build.
    pub(super) fn set_total(&mut self, total: u64) {
        self.total = total;
        self.tests = self.tests.min(total as f64);
    }

    /// Returns the number of tests carried out.
    pub(super) fn tests(&self) -> u64 {
        self.tests as u64
    }

    /// Returns the speed as a factor, such as `2x` or `1/2x`.
    pub(super) fn factor_text(&self) -> String {
        let factor = 1_u32 << self.power.unsigned_abs();
        if self.power < 0 { format!("1/{factor}x") } else { format!("{factor}x") }
    }

    pub(super) fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Returns whether the build proceeds only by key presses, one step each.
    pub(super) fn is_by_steps(&self) -> bool {
        self.by_steps
    }

    /// Proceeds to `now`. Returns whether there was progress, and the time of the next step if
    /// there is one.
    pub(super) fn advance(&mut self, total: u64, now: Duration) -> (bool, Option<Duration>) {
        self.set_total(total);
        // The time until the next step begins anew, so that a pause does not count.
        if self.by_steps || self.is_paused || self.tests() >= total {
            self.since = None;
            return (false, None);
        }
        let since = *self.since.get_or_insert(now);
        if now < since + STEP {
            return (false, Some(since + STEP));
        }
        self.since = Some(now);
        let rate = total as f64 / BUILD_TIME.as_secs_f64() * libm::exp2(f64::from(self.power));
        self.tests += rate * now.saturating_sub(since).as_secs_f64();
        self.set_total(total);
        (true, (self.tests() < total).then_some(now + STEP))
    }

    /// Pauses or resumes the build, or builds one step if the build proceeds by key presses.
    ///
    /// After the end the build starts again.
    pub(in crate::viewer) fn pause_or_step(&mut self) {
        let is_at_end = self.tests() >= self.total;
        if is_at_end {
            self.tests = 0.0;
        }
        if self.by_steps {
            let step = self.total as f64 / STEPS as f64;
            self.tests = (self.tests + step).min(self.total as f64);
        } else {
            self.is_paused = !is_at_end && !self.is_paused;
            self.since = None;
        }
    }

    pub(in crate::viewer) fn faster(&mut self) {
        self.power = (self.power + 1).min(POWERS[1]);
    }

    pub(in crate::viewer) fn slower(&mut self) {
        self.power = (self.power - 1).max(POWERS[0]);
    }

    /// Starts to build the pictures of both orders again from the beginning.
    pub(in crate::viewer) fn restart(&mut self) {
        (self.tests, self.is_paused, self.since) = (0.0, false, None);
    }
}
