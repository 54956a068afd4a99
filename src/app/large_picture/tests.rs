use super::*;

/// A large picture makes progress even if the live view moves, and requests a pause, all the time.
#[test]
fn a_picture_goes_on_beside_an_endless_motion() {
    let shared = SharedPicture::default();
    shared.pause.lock().unwrap().is_on = true;
    let pauses: Vec<_> = (0..3)
        .map(|_| {
            let start = Instant::now();
            shared.throttle_while_paused();
            start.elapsed()
        })
        .collect();
    assert!(pauses[0] < Duration::from_secs(1), "nothing was done before the first pause: {pauses:?}");
}
