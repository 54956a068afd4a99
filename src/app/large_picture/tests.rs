use super::*;

/// A large picture makes progress even if the live view moves, and requests a pause, all the time.
#[test]
fn a_picture_goes_on_beside_an_endless_motion() {
    let mut first_pauses = (0..3).map(|_| {
        let shared = SharedPicture::default();
        shared.pause.lock().unwrap().is_on = true;
        let start = Instant::now();
        shared.throttle_while_paused();
        let pause = start.elapsed();
        // The next ones end, too.
        shared.throttle_while_paused();
        shared.throttle_while_paused();
        pause
    });
    assert!(first_pauses.any(|pause| pause < Duration::from_secs(1)), "nothing was done before the first pause");
}
