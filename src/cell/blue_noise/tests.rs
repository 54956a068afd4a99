use super::*;

#[test]
fn thresholds_are_equally_frequent() {
    let mut counts = [0; 256];
    THRESHOLDS.iter().for_each(|&threshold| counts[usize::from(threshold)] += 1);
    assert_eq!(counts, [TILE_PIXELS / 256; 256]);
}

/// Checks that the means of blocks of 16 thresholds hardly vary. With white noise their deviation
/// is 74 / 4 = 18.
#[test]
fn block_means_vary_less_than_those_of_white_noise() {
    let mean = |x: usize, y: usize| {
        let block = (0..16).map(|k| f64::from(threshold(x + k % 4, y + k / 4)));
        block.sum::<f64>() / 16.0 - 127.5
    };
    let square = |x: f64| x * x;
    let sum: f64 = (0..TILE_PIXELS).map(|at| square(mean(at % TILE_SIDE, at / TILE_SIDE))).sum();
    let deviation = (sum / TILE_PIXELS as f64).sqrt();
    assert!(deviation < 10.0, "{deviation}");
}
