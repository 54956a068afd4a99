use super::*;

#[test]
fn numbers_take_nine_columns() {
    for (x, text) in [
        (0.0, "   0.0000"),
        (-0.0, "   0.0000"),
        (-123.456_78, "-123.4568"),
        (-12_345.678, "-12345.68"),
        (123_456_790.0, "   1.23e8"),
        (-1.5e-10, "-1.50e-10"),
        (f32::INFINITY, "      inf"),
    ] {
        assert_eq!(padded_number(x), text);
    }
}

#[test]
fn long_formulas_take_three_lines() {
    assert_eq!(formula_lines("x - 1"), ["  f = x - 1"]);
    let lines = formula_lines(&"x + ".repeat(40));
    assert_eq!(lines.len(), 3);
    assert!(lines.iter().all(|line| line.len() <= MAX_LINE_WIDTH) && lines[2].ends_with("..."), "{lines:#?}");
}
