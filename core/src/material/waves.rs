//! Means of periodic waves over intervals: patterns filtered by a box as wide as a footprint.

use crate::lanes::Number;

/// Returns the mean of a square wave over an interval.
///
/// The wave is 1 from each even integer to the next integer, and -1 otherwise.
#[inline(always)]
pub(super) fn mean_of_square_wave<N: Number>(middle: N, width: N) -> N {
    let (zero, one, half) = (N::splat(0.0), N::splat(1.0), N::splat(0.5) * width);
    let (start, end) = (middle - half, middle + half);
    let (first, last) = (start.floor(), end.floor());
    let sign = N::select(is_even(first), one, -one);
    // The mean over an interval with one edge of the wave: the share before the edge minus the share after it, with the
    // sign of the wave before the edge.
    let over_one = sign * ((last - start) - (end - last)) / (end - start);
    let over_more = (triangle_wave(end) - triangle_wave(start)) / (end - start);
    let over_edges = N::select((last - first).eq(one), over_one, over_more);
    let mean = N::select(first.eq(last), sign, over_edges);
    // For widths from 1e6 on, whose intervals may be infinite or NaN, the mean is below 1e-6, and taken as 0.
    N::select(width.lt(N::splat(1e6)), mean, zero)
}

/// Returns the mean of the triangle wave over an interval.
#[inline(always)]
pub(super) fn mean_of_triangle_wave<N: Number>(middle: N, width: N) -> N {
    let (one, half) = (N::splat(1.0), N::splat(0.5));
    let reach = half * width;
    // An interval of a length below 1 contains at most one edge, which is at an integer. The wave is 0 at even
    // integers, 1 at odd ones, and changes from the nearest one by the distance to it.
    let edge = (middle + half).floor();
    let distance = (middle - edge).abs();
    let mean_distance = N::select(distance.lt(reach), (reach * reach + distance * distance) / width, distance);
    let over_one = N::select(is_even(edge), mean_distance, one - mean_distance);
    let over_more = half + (triangle_wave_integral(middle + reach) - triangle_wave_integral(middle - reach)) / width;
    let mean = N::select(width.lt(one), over_one, over_more);
    // As for the square wave, whose mean 0 is the mean 1/2 of this one.
    N::select(width.lt(N::splat(1e6)), mean, half)
}

/// Returns the integral from 0 of the triangle wave less its mean of 1/2.
///
/// It is periodic like the wave, so that differences of two integrals stay exact far from 0.
#[inline(always)]
fn triangle_wave_integral<N: Number>(x: N) -> N {
    let (half, one, two) = (N::splat(0.5), N::splat(1.0), N::splat(2.0));
    let in_period = x - two * (half * x).floor();
    let is_rising = in_period.lt(one);
    // The parabola of the falling half is that of the rising one, turned upside down.
    let in_half = N::select(is_rising, in_period, in_period - one);
    let falling = half * in_half * (one - in_half);
    N::select(is_rising, -falling, falling)
}

/// Returns the triangle wave: 0 at even integers, 1 at odd ones, and straight between.
///
/// It is the integral of the square wave from 0.
#[inline(always)]
fn triangle_wave<N: Number>(x: N) -> N {
    let (one, two) = (N::splat(1.0), N::splat(2.0));
    let in_period = x - two * (N::splat(0.5) * x).floor();
    one - (in_period - one).abs()
}

/// Returns whether an integer is even.
// In f32 all integers above 2^24 are even.
#[inline(always)]
fn is_even<N: Number>(whole: N) -> N::Mask {
    let half = whole * N::splat(0.5);
    half.floor().eq(half)
}

#[cfg(all(test, unit_tests))]
mod tests;
