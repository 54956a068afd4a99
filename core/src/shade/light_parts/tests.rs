use super::*;
use std::collections::HashSet;

#[test]
fn the_first_directions_are_unit_vectors_with_the_sum_0() {
    let mut sum = [0.0_f64; 2];
    for (at, part) in BASE.iter().enumerate() {
        let [x, y] = part.direction.map(f64::from);
        assert!((x * x + y * y - 1.0).abs() < 2e-7, "part {at}");
        sum = [sum[0] + x, sum[1] + y];
        let pair = (at / 2) as f64 * 0.618_033_988_749_895;
        let (sine, cosine) = libm::sincos(PI * (pair - libm::floor(pair)));
        let sign = if at % 2 == 0 { 1.0 } else { -1.0 };
        assert!((x - sign * cosine).abs() < 1e-7 && (y - sign * sine).abs() < 1e-7, "part {at}");
    }
    assert_eq!(sum, [0.0; 2]);
}

#[test]
fn each_row_and_column_of_the_square_has_one_part_for_every_sample() {
    for sample in [0, 1, 2, 63, 65_535] {
        let shifts = PartShifts::of(&[sample]);
        let squares = (0..PARTS).map(|part| shifts.position::<F32x8>(part).of_lane(0).square);
        let squares: Vec<_> = squares.collect();
        for axis in 0..2 {
            let cells: HashSet<u32> = squares.iter().map(|square| (square[axis] * 16.0) as u32).collect();
            // A shifted set may have two of its numbers at the ends of one cell by rounding.
            assert!(cells.len() >= 15 && squares.iter().all(|square| (0.0..=1.0).contains(&square[axis])), "{sample}");
        }
    }
}

#[test]
fn samples_without_numbers_are_first_samples() {
    let mut shifts = Vec::new();
    PartShifts::fill(&[], 3, &mut shifts);
    assert_eq!(shifts, [PartShifts::NONE; 3]);
    PartShifts::fill(&[0; 9], 2, &mut shifts);
    assert_eq!(shifts, [PartShifts::NONE; 2]);
}
