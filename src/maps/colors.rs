//! The colour scales of maps, the same for every picture.

use crate::color::Srgb8;
use glam::Vec3;

/// Converts a share from 0 to 1 to a channel of a colour.
fn channel(share: f32) -> u8 {
    (share * 255.0 + 0.5) as u8
}

/// Returns the grey of a share from 0 (black) to 1 (white), linear in sRGB.
fn grey(share: f32) -> Srgb8 {
    let channel = channel(share);
    Srgb8::new(channel, channel, channel)
}

/// Returns the grey of a depth: white at 0, middle grey at `middle`, black at infinity.
// The slope is greatest near `middle`, the target, where the eye is led; no depth needs a limit.
pub(super) fn depth(t: f32, middle: f32) -> Srgb8 {
    let part = t / middle;
    grey(1.0 / (1.0 + part * part))
}

/// Returns the colour of a unit normal, whose coordinates from -1 to 1 become channels.
pub(super) fn normal(n: Vec3) -> Srgb8 {
    let [r, g, b] = n.to_array().map(|coordinate| channel(0.5 * coordinate + 0.5));
    Srgb8::new(r, g, b)
}

/// Returns the grey of `count` among `of`: dark for 0, white for all.
pub(super) fn share(count: u32, of: u32) -> Srgb8 {
    // Not black, so that shadows stay apart from the colour of rays without a hit.
    const MIN_GREY: f32 = 0.22;
    grey(MIN_GREY + (1.0 - MIN_GREY) * count.min(of) as f32 / of.max(1) as f32)
}

/// Returns the colour of an object.
// Consecutive hues are a golden section of the circle apart, which keeps them distinct for any number of objects. Three
// lightnesses in turn separate those whose hues come close: of the first 1,000 objects, three consecutive ones are more
// than 0.1 apart in Oklab.
pub(super) fn object(number: u32) -> Srgb8 {
    const GOLDEN: u32 = 2_654_435_769; // 2^32 / 1.618...
    const MAX_CHANNELS: [f32; 3] = [1.0, 0.72, 0.86];
    const MIN_CHANNELS: [f32; 3] = [0.2, 0.08, 0.5];
    // In integers, as a multiple in f32 would lose the hue of large numbers.
    let hue = 6.0 * (number.wrapping_mul(GOLDEN) >> 8) as f32 / 16_777_216.0;
    let level = (number % 3) as usize;
    let channel_of = |middle: f32| {
        let away = (hue - middle).abs();
        let near = (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0);
        channel(MAX_CHANNELS[level] * (MIN_CHANNELS[level] + (1.0 - MIN_CHANNELS[level]) * near))
    };
    Srgb8::new(channel_of(0.0), channel_of(2.0), channel_of(4.0))
}

/// The colours of 1, 4, 16, 64, 256 and 1024 tests.
// Powers of four, as tests per pixel range over three orders of magnitude: a linear scale would show a mesh only.
const HEAT: [[f32; 3]; 6] =
    [[0.1, 0.1, 0.5], [0.12, 0.5, 0.88], [0.2, 0.72, 0.3], [0.96, 0.86, 0.22], [0.87, 0.2, 0.16], [1.0, 1.0, 1.0]];

/// Returns the colour of a number of tests, from blue up to 1 to white from 1024 on.
///
/// Between the powers of four of [`HEAT`] colours are interpolated.
pub(super) fn heat(count: u32) -> Srgb8 {
    let power = count.max(1).ilog2();
    // The logarithm to base 2, interpolated linearly between powers of two: no platform's logarithm is on the path of
    // a picture.
    let halves = power as f32 + (count.max(1) as f32 / (1_u64 << power) as f32 - 1.0);
    let place = (0.5 * halves).min((HEAT.len() - 1) as f32);
    let first = (place as usize).min(HEAT.len() - 2);
    let part = place - first as f32;
    let [r, g, b] = [0, 1, 2].map(|at| channel(HEAT[first][at] * (1.0 - part) + HEAT[first + 1][at] * part));
    Srgb8::new(r, g, b)
}

/// Formats a length with two to four digits, and an exponent below 0.01 and from 10,000 on.
pub(super) fn short(length: f32) -> String {
    match length {
        l if !(0.01..1e4).contains(&l) => format!("{l:.1e}"),
        l if l >= 100.0 => format!("{l:.0}"),
        l if l >= 10.0 => format!("{l:.1}"),
        l => format!("{l:.2}"),
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
