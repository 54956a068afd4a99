use super::*;

/// Returns the mean of a wave at many places of an interval.
fn sampled(wave: fn(f64) -> f64, middle: f32, width: f32) -> f64 {
    const SAMPLES: u32 = 20_000;
    let place =
        |sample: u32| f64::from(middle) + f64::from(width) * ((f64::from(sample) + 0.5) / f64::from(SAMPLES) - 0.5);
    (0..SAMPLES).map(|sample| wave(place(sample))).sum::<f64>() / f64::from(SAMPLES)
}

fn square(x: f64) -> f64 {
    if x.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 }
}

fn triangle(x: f64) -> f64 {
    1.0 - (x.rem_euclid(2.0) - 1.0).abs()
}

/// Compares the closed forms with dense samples, at edges, inside and outside one period, and on
/// both sides of 0.
#[test]
fn means_are_those_of_dense_samples() {
    for width in [0.01, 0.25, 0.999, 1.0, 1.001, 1.5, 2.0, 3.7, 10.2, 101.0] {
        for step in -40..=40 {
            let middle = 0.093 * step as f32;
            for (found, wave) in [
                (mean_of_square_wave(middle, width), square as fn(f64) -> f64),
                (mean_of_triangle_wave(middle, width), triangle),
            ] {
                let expected = sampled(wave, middle, width);
                assert!((f64::from(found) - expected).abs() < 2e-4, "{middle} {width}: {found}, sampled {expected}");
            }
        }
    }
}

#[test]
fn a_point_has_the_value_of_the_wave_itself() {
    for step in -100..=100 {
        let x = 0.0625 * step as f32;
        assert_eq!(f64::from(mean_of_square_wave(x, 0.0)), square(x.into()), "{x}");
        assert_eq!(f64::from(mean_of_triangle_wave(x, 0.0)), triangle(x.into()), "{x}");
    }
}

#[test]
fn wide_and_invalid_intervals_have_the_mean_of_the_wave() {
    for width in [1e6, 1e30, f32::INFINITY, f32::NAN] {
        for middle in [0.3, -1e18, 1e30] {
            assert_eq!(mean_of_square_wave(middle, width), 0.0);
            assert_eq!(mean_of_triangle_wave(middle, width), 0.5);
        }
    }
}

/// The two closed forms of the triangle wave meet where the interval has the length 1.
#[test]
fn the_mean_of_the_triangle_wave_has_no_jump() {
    for step in 0..1000 {
        let middle = 0.01 * step as f32;
        let [before, after] = [0.999_999_9, 1.0].map(|width| mean_of_triangle_wave(middle, width));
        assert!((before - after).abs() < 2e-6, "{middle}: {before} {after}");
    }
}
