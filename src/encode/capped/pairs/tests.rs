//! The ranks of pairs.

use super::OpenPair;

#[test]
fn pairs_of_nearly_equal_gains_have_a_total_order() {
    // Cross-multiplied products put the first before the second and the second before the third, but not the first
    // before the third.
    let pairs = [(191.00165, 23.0, 5155), (191.00166, 23.0, 16230), (191.00165, 23.000_002, 615)];
    let pairs = pairs.map(|(gain, bytes, key)| OpenPair { key, gain, bytes, has_vacated: true });
    for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let is_before = |one: usize, other: usize| pairs[one].cmp_rank(&pairs[other]).is_lt();
        assert!(!is_before(a, b) || !is_before(b, c) || is_before(a, c), "{a} before {b} before {c}");
    }
}
