//! The roots of a quartic without a cubic term.

/// Limit on the steps of the search for one root.
// Newton's method takes about six, and halving the interval about 60 near a double root.
const MAX_STEPS: usize = 128;

/// s^4 + squares s^2 + linear s + constant; a value with a magnitude up to `rounding` counts as 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quartic {
    pub(super) squares: f64,
    pub(super) linear: f64,
    pub(super) constant: f64,
    pub(super) rounding: f64,
}

impl Quartic {
    /// Returns the roots from `-reach` to `reach`, in ascending order.
    ///
    /// Between two neighbouring zeros of its derivative the quartic is monotone, and has a root if it has different
    /// signs there. In the same way the zeros of the derivative are between those of the second derivative. No root is
    /// lost, unlike with a closed formula, which takes the roots of a cubic and cancels digits. Where the quartic
    /// touches 0 up to rounding, it has one root.
    pub(super) fn roots(&self, reach: f64) -> impl Iterator<Item = f64> {
        let Self { squares, linear, constant, rounding } = *self;
        let value = move |s: f64| ((s * s + squares) * s + linear) * s + constant;
        let slope = move |s: f64| (4.0 * s * s + 2.0 * squares) * s + linear;
        let bend = move |s: f64| 12.0 * s * s + 2.0 * squares;
        let inflection = (-squares / 6.0).max(0.0).sqrt().min(reach);
        let mut extrema = [reach; 5];
        extrema[0] = -reach;
        let ends = [-reach, -inflection, inflection, reach];
        for (at, range) in ends.windows(2).enumerate() {
            // If the derivative has no zero in this range, the range's end is stored instead, which only splits a range
            // in which the quartic is monotone.
            extrema[at + 1] = root_between([range[0], range[1]], slope, bend).unwrap_or(range[1]);
        }
        let mut between = [None; 4];
        for (root, range) in between.iter_mut().zip(extrema.windows(2)) {
            *root = root_between([range[0], range[1]], value, slope);
        }
        // Finds double roots, at which the quartic touches 0 without changing its sign: a line along the axis of a
        // torus that meets itself enters the torus at one.
        let touches = move |at: usize| between[at..(at + 2).min(4)].iter().all(Option::is_none);
        let touched =
            move |at: usize| Some(extrema[at + 1]).filter(|&s| at < 3 && touches(at) && value(s).abs() <= rounding);
        (0..4).flat_map(move |at| [between[at], touched(at)]).flatten()
    }
}

/// Returns the root of a function between two numbers, if it has different signs there.
///
/// The function must be monotone between them. A step of Newton's method that would leave the interval between them is
/// replaced by halving the interval; each step shrinks it.
fn root_between([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> Option<f64> {
    let is_negative = value(low) <= 0.0;
    if is_negative == (value(high) <= 0.0) {
        return None;
    }
    let mut at = 0.5 * (low + high);
    for _ in 0..MAX_STEPS {
        let error = value(at);
        *(if (error <= 0.0) == is_negative { &mut low } else { &mut high }) = at;
        let newton = at - error / slope(at);
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if next == at || next <= low || high <= next {
            break;
        }
        at = next;
    }
    Some(at)
}
