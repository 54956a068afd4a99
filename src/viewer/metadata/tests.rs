use super::*;

#[test]
fn digits_are_grouped_in_threes() {
    assert_eq!([0, 12, 999, 1000, 1_234_567].map(grouped), ["0", "12", "999", "1,000", "1,234,567"]);
}
