use super::*;

/// Compares with values of the standard's formula, computed with 40 digits.
#[test]
fn transfer_function_has_the_standards_values() {
    for (linear, encoded) in [
        (0.0, 0.0),
        (0.001, 0.012_92),
        (0.18, 0.461_356_129_500_442),
        (0.214_041_140_482_232_55, 0.5),
        (0.5, 0.735_356_983_052_444_9),
        (1.0, 1.0),
    ] {
        assert!((srgb_from_linear(linear) - encoded).abs() < 1e-9, "{linear}");
        assert!((linear_from_srgb(encoded) - linear).abs() < 1e-9, "{encoded}");
    }
}

#[test]
fn every_code_survives_the_round_trip() {
    for code in 0..=255 {
        let color = Srgb8::new(code, 255 - code, code / 2);
        assert_eq!(Srgb8::from_linear(LinearRgb::from_srgb8(color)), color);
    }
}

/// The values computed at compile time equal the formula to the bit.
#[test]
fn the_tables_equal_the_formula() {
    for code in 0..=255_u8 {
        let light = |code: f64| linear_from_srgb(code / 255.0);
        assert_eq!(TRANSFER.linear_from_srgb8[usize::from(code)], light(code.into()) as f32, "{code}");
        if code < 255 {
            let step = least_f32_at_or_above(light(f64::from(code) + 0.5)).to_bits();
            assert_eq!(TRANSFER.bits_at_step[usize::from(code)], step, "{code}");
        }
    }
}

/// The table agrees with the formula in f64 just beside each step between codes, and over the whole
/// range.
#[test]
fn quantisation_equals_the_rounded_formula() {
    let by_formula = |x: f32| (srgb_from_linear(f64::from(x)) * 255.0).round() as u8;
    let steps = TRANSFER.bits_at_step[..255].iter().map(|&step| f32::from_bits(step));
    let steps = steps.flat_map(|s| [s.next_down(), s, s.next_up()]);
    let spread = (0..0x3f80_0000_u32).step_by(997).map(f32::from_bits);
    for x in steps.chain(spread) {
        assert_eq!(TRANSFER.srgb8(x), by_formula(x), "{x:e}");
    }
}

#[test]
fn light_outside_the_screens_range_is_clamped() {
    for (x, code) in
        [(-1.0, 0), (-0.0, 0), (f32::NAN, 0), (f32::NEG_INFINITY, 0), (1.0, 255), (7.0, 255), (f32::INFINITY, 255)]
    {
        assert_eq!(TRANSFER.srgb8(x), code, "{x}");
    }
}

/// Compares with values computed in f64 from the formulas of OKLab's source.
#[test]
fn oklab_has_the_sources_values() {
    for (color, [l, a, b]) in [
        (Srgb8::new(0, 0, 0), [0.0, 0.0, 0.0]),
        (Srgb8::new(255, 255, 255), [1.0, 0.0, 0.0]),
        (Srgb8::new(255, 0, 0), [0.627_955, 0.224_863, 0.125_846]),
        (Srgb8::new(0, 255, 0), [0.866_440, -0.233_888, 0.179_498]),
        (Srgb8::new(0, 0, 255), [0.452_014, -0.032_457, -0.311_528]),
        (Srgb8::new(128, 128, 128), [0.599_871, 0.0, 0.0]),
    ] {
        let distance = Oklab::from_srgb8(color).distance(Oklab { l, a, b });
        assert!(distance < 2e-6, "{color:?} is {distance} away");
    }
}

#[test]
fn luminance_of_white_is_one() {
    assert!((LinearRgb::grey(1.0).luminance() - 1.0).abs() < 1e-6);
}
