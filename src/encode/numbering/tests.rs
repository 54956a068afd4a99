use super::*;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Bits(u64);

impl Key for Bits {
    fn bits(self) -> u64 {
        self.0
    }
}

#[test]
fn keys_are_numbered_in_the_order_in_which_they_are_first_seen() {
    let mut numbering = Numbering::default();
    assert_eq!(numbering.get(Bits(7)), None);
    for count in [1, 2, 1_000, 3] {
        numbering.clear(count);
        // Keys that differ only in the highest bits, only in the lowest, and in both.
        let bits = (0..count as u64).map(|at| ((at % 30) << 59) ^ (at / 30));
        let keys: Vec<Bits> = bits.map(Bits).collect();
        let mut distinct: Vec<Bits> = Vec::new();
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
