//! The colour scales of maps, which are the same for every picture.

use crate::color::Srgb8;
use glam::Vec3;

/// Converts a number from 0 to 1 to an 8-bit channel.
fn channel(share: f32) -> u8 {
    (share * 255.0 + 0.5) as u8
}

/// Returns the grey for a number from 0 (black) to 1 (white), linear in encoded sRGB.
fn grey(share: f32) -> Srgb8 {
    let channel = channel(share);
    Srgb8::new(channel, channel, channel)
}

/// Returns the grey for a depth `t`: white at 0, middle grey at `middle`, black at infinity.
// The grey changes fastest near `middle`, the depth of the target, which matters most. It has a value for every depth,
// so that no largest depth has to be chosen.
pub(super) fn depth(t: f32, middle: f32) -> Srgb8 {
    let part = t / middle;
    grey(1.0 / (1.0 + part * part))
}

/// Returns the colour for a unit normal: its coordinates from -1 to 1 become channels from 0 to
/// 255.
pub(super) fn normal(n: Vec3) -> Srgb8 {
    let [r, g, b] = n.to_array().map(|coordinate| channel(0.5 * coordinate + 0.5));
    Srgb8::new(r, g, b)
}

/// Returns the grey for `count` out of `total`: dark grey for 0, white for all.
pub(super) fn share_grey(count: u32, total: u32) -> Srgb8 {
    // Not black, so that shadows differ from the colour of pixels without a hit.
    const MIN_GREY: f32 = 0.22;
    grey(MIN_GREY + (1.0 - MIN_GREY) * count.min(total) as f32 / total.max(1) as f32)
}

/// Returns the colour for an object by its index.
// The hues of consecutive objects differ by a golden section of the colour circle, which keeps hues distinct for any
// number of objects. Three alternating lightnesses separate objects whose hues are close: among the first 1,000
// objects, any three consecutive ones are more than 0.1 apart in OKLab.
pub(super) fn object(number: u32) -> Srgb8 {
    const GOLDEN: u32 = 2_654_435_769; // 2^32 / 1.618...
    const MAX_CHANNELS: [f32; 3] = [1.0, 0.72, 0.86];
    const MIN_CHANNELS: [f32; 3] = [0.2, 0.08, 0.5];
    // Computed in integers, because for large numbers a product in f32 has too few digits.
    let hue = 6.0 * (number.wrapping_mul(GOLDEN) >> 8) as f32 / 16_777_216.0;
    let level = (number % 3) as usize;
    let channel_of = |middle: f32| {
        let away = (hue - middle).abs();
        let near = (2.0 - away.min(6.0 - away)).clamp(0.0, 1.0);
        channel(MAX_CHANNELS[level] * (MIN_CHANNELS[level] + (1.0 - MIN_CHANNELS[level]) * near))
    };
    Srgb8::new(channel_of(0.0), channel_of(2.0), channel_of(4.0))
}

/// The colours for 1, 4, 16, 64, 256 and 1024 tests.
// A logarithmic scale, because tests per pixel range over three orders of magnitude: on a linear one, only meshes would
// differ from blue.
const HEAT: [[f32; 3]; 6] =
    [[0.1, 0.1, 0.5], [0.12, 0.5, 0.88], [0.2, 0.72, 0.3], [0.96, 0.86, 0.22], [0.87, 0.2, 0.16], [1.0, 1.0, 1.0]];

/// Returns the colour for a number of tests, from blue for at most 1 to white for 1024 or more.
///
/// Colours between those of [`HEAT`] are interpolated.
pub(super) fn heat(count: u32) -> Srgb8 {
    let power = count.max(1).ilog2();
    // The logarithm to base 2, interpolated linearly between powers of two. A library's logarithm might have other bits
    // on another platform.
    let halves = power as f32 + (count.max(1) as f32 / (1_u64 << power) as f32 - 1.0);
    let place = (0.5 * halves).min((HEAT.len() - 1) as f32);
    let first = (place as usize).min(HEAT.len() - 2);
    let part = place - first as f32;
    let [r, g, b] = [0, 1, 2].map(|at| channel(HEAT[first][at] * (1.0 - part) + HEAT[first + 1][at] * part));
    Srgb8::new(r, g, b)
}

/// Formats a length with two to four digits; below 0.01 and from 10,000 on, with an exponent.
pub(super) fn length_text(length: f32) -> String {
    match length {
        l if !(0.01..1e4).contains(&l) => format!("{l:.1e}"),
        l if l >= 100.0 => format!("{l:.0}"),
        l if l >= 10.0 => format!("{l:.1}"),
        l => format!("{l:.2}"),
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
