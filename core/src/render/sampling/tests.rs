use super::*;

/// Each sample is traced once, in order, at its position, and all samples of a batch have the same
/// footprint.
#[test]
fn batches_cover_each_sample_once() {
    for samples in [0..1, 0..3, 0..16, 1..4, 4..16, 16..64, 0..64, 0..65, 0..300, 5..7] {
        for pixels in [0, 1, 5, 21, 22, 255, 256] {
            let mut traced = vec![Vec::new(); pixels];
            for batch in SampleBatches::of(samples.clone()).iter() {
                let shares = [batch.samples.start, batch.samples.end - 1].map(footprint_share);
                assert_eq!(shares[0], shares[1], "{:?}", batch.samples);
                for range in batch.pixel_ranges(pixels) {
                    let numbers: Vec<_> = (0..=u8::MAX).take(pixels).collect();
                    let mut of_rays = Vec::new();
                    batch.assign_pixels(&numbers[range], &mut of_rays);
                    assert!(of_rays.len() <= MAX_BATCH_RAYS, "{samples:?} of {pixels} pixels");
                    for (ray, &pixel) in of_rays.iter().enumerate() {
                        let [x, y] = &batch.positions[ray / LANES];
                        traced[usize::from(pixel)].push((x.0[ray % LANES], y.0[ray % LANES]));
                    }
                }
            }
            let wanted: Vec<_> = samples.clone().map(sample_position).collect();
            assert!(traced.iter().all(|traced| *traced == wanted), "{samples:?} of {pixels} pixels");
        }
    }
}
