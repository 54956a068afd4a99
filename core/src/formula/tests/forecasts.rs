//! Tests of what models and forecasts tell about a piece.

use super::*;

/// Returns the model and the forecasts of a formula on a piece of the x axis, in each lane.
fn on_the_x_axis(text: &str, [from, to]: [f64; 2]) -> (model::Model, SignForecasts) {
    let lines = [[[0.0; LANES]; 3], [[1.0; LANES], [0.0; LANES], [0.0; LANES]]];
    let (formula, pieces) = (formula(text), [[from; LANES], [to; LANES]]);
    let (models, forecasts) = simd::dispatch(WithModels(packet(&formula, &lines, &pieces, &mut Vec::new())));
    (model_of_lane(&models, 0), forecasts)
}

/// From -1 to 1, x^3 is 3/4 x but for 1/4, and x^4 is x^2 - 1/8 but for 1/8.
#[test]
fn high_powers_become_the_closest_quadratics() {
    for (text, expected, error) in
        [("x^3", [0.0, 0.75, 0.0], 0.25), ("x^4", [-0.125, 0.0, 1.0], 0.125), ("x*(x^2 + x)", [0.0, 0.75, 1.0], 0.25)]
    {
        let (model, _) = on_the_x_axis(text, [-1.0, 1.0]);
        assert!((0..3).all(|at| (model.c[at] - expected[at]).abs() < 1e-6), "{text}: {model:?}");
        assert!((model.error - error).abs() < 1e-5, "{text}: {model:?}");
    }
}

/// With terms of order 3 in the error, the models of these functions would be off by more.
#[test]
fn functions_keep_a_part_of_their_third_terms() {
    for (text, most) in [("sin(x)", 0.09), ("cos(x + 1)", 0.09), ("exp(x)", 0.16), ("1/(x + 4)", 0.006)] {
        let (model, _) = on_the_x_axis(text, [-1.0, 1.0]);
        assert!(model.error < most, "{text}: {model:?}");
    }
}

/// The sign of a greatest or least value is known where that of one operand decides it.
#[test]
fn one_operand_decides_the_sign_of_an_extreme() {
    for (text, sign) in [
        ("max(sin(9*x), x + 1.5)", 1.0),
        ("max(x + 1.5, sin(9*x), -9)", 1.0),
        ("min(sin(9*x), -1.5 - x)", -1.0),
        ("min(-1.5 - x, sin(9*x), cos(8*x))", -1.0),
        ("-max(sin(9*x), -min(cos(8*x), -1.5 - x))", -1.0),
    ] {
        let (_, forecasts) = on_the_x_axis(text, [-1.0, 1.0]);
        let forecast = forecasts.forecast(0);
        assert!(forecast.has_no_zero && forecast.sign == sign, "{text}: {forecast:?}");
    }
    assert!(!on_the_x_axis("max(sin(9*x), x)", [-1.0, 1.0]).1.has_no_zero(0));
}

/// An extreme changes its sign where all operands have changed theirs, or where the first one has.
#[test]
fn extremes_change_their_signs_with_their_operands() {
    for (text, sign, change) in [
        ("max(-x, x - 2)", 1.0, 0.5),
        ("max(-x, -0.5 - x)", 1.0, 0.5),
        ("max(x - 0.5, x - 0.75)", -1.0, 0.75),
        ("min(x, 2 - x)", -1.0, 0.5),
        ("max(x - 0.5, -min(x + 1.5, 2 - x))", -1.0, 0.75),
        ("min(0.25 - x, -x)", 1.0, 0.5),
    ] {
        let (_, forecasts) = on_the_x_axis(text, [-1.0, 1.0]);
        let forecast = forecasts.forecast(0);
        assert_eq!(forecast.sign, sign, "{text}: {forecast:?}");
        let is_bracketed = forecast.near <= change && (change <= forecast.far);
        assert!(is_bracketed && forecast.near > change - 0.01, "{text}: {forecast:?}");
    }
    // Where the second operand becomes positive in front of the first one's fall, no fall is known.
    let (_, forecasts) = on_the_x_axis("max(-x, x + 0.5)", [-1.0, 1.0]);
    let forecast = forecasts.forecast(0);
    assert!(forecast.sign == 1.0 && (forecast.near - 0.5).abs() < 0.01 && forecast.far > 1.0, "{forecast:?}");
}
