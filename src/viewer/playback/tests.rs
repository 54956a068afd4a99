use super::*;

fn ms(count: u64) -> Duration {
    Duration::from_millis(count)
}

#[test]
fn the_time_runs_until_it_is_paused() {
    let mut playback = Playback::default();
    playback.advance(ms(700));
    assert_eq!((playback.time(), playback.advanced_to()), (ms(0), None), "a still scene has no time");
    playback.resume_unless_paused(true, ms(1000));
    playback.advance(ms(1400));
    assert_eq!((playback.time(), playback.advanced_to()), (ms(400), Some(ms(1400))));
    playback.toggle(ms(1500));
    playback.advance(ms(9000));
    assert_eq!((playback.time(), playback.advanced_to()), (ms(500), None));
    // The scene's file is reloaded while the scene is paused.
    playback.resume_unless_paused(true, ms(9100));
    assert_eq!(playback.advanced_to(), None, "it stays paused");
    playback.toggle(ms(9200));
    playback.advance(ms(9250));
    assert_eq!(playback.time(), ms(550));
}

#[test]
fn the_time_of_a_suspended_program_does_not_count() {
    let mut playback = Playback::default();
    playback.resume_unless_paused(true, ms(0));
    playback.advance(ms(60_000));
    assert_eq!(playback.time(), MAX_STEP);
}
