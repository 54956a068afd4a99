//! Tracks: values that key frames give at some times, and the values between them.

use glam::DVec4;
use std::sync::Arc;

/// The course of a value between two key frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interpolation {
    /// The value of the key frame before.
    Step,
    /// The straight line, or the shortest rotation at an even speed.
    Linear,
    /// Hermite's cubic: each key frame has an incoming tangent, a value and an outgoing tangent.
    CubicSpline,
}

impl Interpolation {
    /// Returns the number of values that each key frame has.
    pub(crate) fn values_per_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// The times of key frames in seconds: at least one, and none is less than the one before.
///
/// Many tracks may share them, which is why their order is checked once.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeyTimes(Arc<[f32]>);

impl KeyTimes {
    /// Returns the times; `None` if there are none, or they decrease or cannot be compared.
    pub(crate) fn new(times: Vec<f32>) -> Option<Self> {
        (!times.is_empty() && times.is_sorted()).then(|| Self(times.into()))
    }

    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// Returns the last time.
    pub(crate) fn last(&self) -> f64 {
        f64::from(self.0[self.0.len() - 1])
    }
}

/// Key frames of vectors or quaternions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track<const N: usize> {
    times: KeyTimes,
    values: Arc<[[f32; N]]>,
    interpolation: Interpolation,
}

/// The place of a time among key frames.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// At a key frame, before the first or after the last one.
    At(usize),
    /// Between a key frame and the next one: the share of the way, and the time from one to the
    /// other.
    Between { key: usize, share: f64, step: f64 },
}

impl<const N: usize> Track<N> {
    /// Returns the track of these key frames; `None` if the number of values is another.
    pub(crate) fn new(times: KeyTimes, values: Arc<[[f32; N]]>, interpolation: Interpolation) -> Option<Self> {
        let is_valid = times.count().checked_mul(interpolation.values_per_key()) == Some(values.len());
        is_valid.then_some(Self { times, values, interpolation })
    }

    /// Returns the value at a time in seconds.
    pub(crate) fn at(&self, seconds: f64) -> [f64; N] {
        match self.place(seconds) {
            Place::At(key) => self.key(key),
            Place::Between { key, share, step } => self.between(key, share, step),
        }
    }

    /// Returns the place of a time.
    fn place(&self, seconds: f64) -> Place {
        let KeyTimes(times) = &self.times;
        let next = times.partition_point(|&time| f64::from(time) <= seconds);
        let (Some(key), true) = (next.checked_sub(1), next < times.len()) else {
            return Place::At(next.min(times.len() - 1));
        };
        if self.interpolation == Interpolation::Step {
            return Place::At(key);
        }
        // The next time is later than `seconds`, and so later than this one: the step is not 0.
        let [start, end] = [times[key], times[next]].map(f64::from);
        Place::Between { key, share: (seconds - start) / (end - start), step: end - start }
    }

    /// Returns the value of a key frame.
    fn key(&self, key: usize) -> [f64; N] {
        let middle = if self.interpolation == Interpolation::CubicSpline { 3 * key + 1 } else { key };
        self.values[middle].map(f64::from)
    }

    fn between(&self, key: usize, share: f64, step: f64) -> [f64; N] {
        let (from, to) = (self.key(key), self.key(key + 1));
        if self.interpolation != Interpolation::CubicSpline {
            return std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share);
        }
        let outgoing = self.values[3 * key + 2].map(f64::from);
        let incoming = self.values[3 * key + 3].map(f64::from);
        let (square, cube) = (share * share, share * share * share);
        let of_from = 2.0 * cube - 3.0 * square + 1.0;
        let (of_outgoing, of_incoming) = (step * (cube - 2.0 * square + share), step * (cube - square));
        std::array::from_fn(|i| {
            of_from * from[i] + (1.0 - of_from) * to[i] + of_outgoing * outgoing[i] + of_incoming * incoming[i]
        })
    }
}

impl Track<4> {
    /// Returns the quaternion at a time, whose length need not be 1.
    pub(super) fn rotation_at(&self, seconds: f64) -> DVec4 {
        match self.place(seconds) {
            Place::Between { key, share, .. } if self.interpolation == Interpolation::Linear => {
                slerp([key, key + 1].map(|key| DVec4::from_array(self.key(key)).normalize_or(DVec4::W)), share)
            }
            _ => DVec4::from_array(self.at(seconds)),
        }
    }
}

/// Returns the quaternion on the shortest way between two of unit length, at a share of the angle.
fn slerp([from, mut to]: [DVec4; 2], share: f64) -> DVec4 {
    let mut cosine = from.dot(to);
    // A quaternion and its negative are the same rotation: the one nearer to `from` is taken.
    if cosine < 0.0 {
        (to, cosine) = (-to, -cosine);
    }
    let angle = libm::acos(cosine.min(1.0));
    let sine = libm::sin(angle);
    // Between almost equal rotations the straight line differs from the arc by less than a rounding error.
    if sine < 1e-9 {
        return from + (to - from) * share;
    }
    from * (libm::sin((1.0 - share) * angle) / sine) + to * (libm::sin(share * angle) / sine)
}
