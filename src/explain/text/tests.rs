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
