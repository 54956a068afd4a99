use super::*;

/// Without an end of the live view's motion the pause is on for ever.
#[test]
fn a_picture_goes_on_beside_an_endless_motion() {
    let shared = Shared::default();
    shared.pause.lock().unwrap().is_on = true;
    let pauses: Vec<_> = (0..3)
        .map(|_| {
            let start = Instant::now();
            shared.wait_while_paused();
            start.elapsed()
        })
        .collect();
    assert!(pauses[0] < Duration::from_secs(1), "nothing was done before the first pause: {pauses:?}");
}
