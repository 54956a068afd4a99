use super::*;

#[test]
fn keys_are_numbered_in_the_order_in_which_they_are_first_seen() {
    let mut numbering = Numbering::default();
    assert_eq!(numbering.get(7), None);
    for count in [1, 2, 1_000, 3] {
        numbering.clear(count);
        // Keys that differ only in the highest bits, only in the lowest, and in both.
        let keys: Vec<u64> = (0..count as u64).map(|at| ((at % 30) << 59) ^ (at / 30)).collect();
        let mut distinct: Vec<u64> = Vec::new();
        for key in keys {
            let number = distinct.iter().position(|&other| other == key).unwrap_or(distinct.len());
            if number == distinct.len() {
                assert_eq!(numbering.get(key), None);
                distinct.push(key);
            }
            assert_eq!(numbering.add(key), number);
            assert_eq!(numbering.get(key), Some(number));
        }
        assert_eq!(numbering.keys(), distinct);
    }
}
