use super::*;

/// The time of a frame, 12.5 ms of which are for tracing.
const FRAME: Duration = Duration::from_micros(16_667);

fn ms(milliseconds: f64) -> Duration {
    Duration::from_secs_f64(milliseconds / 1000.0)
}

/// Simulates `frames` frames of a motion that starts from rest, and returns the level of each.
///
/// `time` returns the milliseconds that the frame with this number takes at this level.
fn simulate_motion(control: &mut QualityControl, frames: u32, mut time: impl FnMut(u32, usize) -> f64) -> Vec<usize> {
    let levels = (0..frames).map(|frame| {
        let sampling = control.first_sampling(frame > 0);
        let level = LEVELS.iter().position(|&level| level == sampling).expect("it is one of them");
        control.adapt_level(sampling, ms(time(frame, level)), FRAME);
        level
    });
    levels.collect()
}

/// Returns a function from a level to its milliseconds per frame, for a scene where a third of the
/// pixels has edges.
///
/// A frame with one sample per pixel takes `one` milliseconds.
fn frame_time_by_level(one: f64) -> impl Fn(usize) -> f64 {
    move |level| one * [0.25, 1.0, 2.0, 6.0][level]
}

/// Returns the number of changes of the level.
fn changes(levels: &[usize]) -> usize {
    levels.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

#[test]
fn as_many_samples_as_fit_the_time() {
    for (one, level) in [(0.1, 3), (1.0, 3), (1.6, 3), (2.5, 2), (4.5, 2), (8.0, 1), (12.0, 1), (14.0, 0), (1e3, 0)] {
        let time = frame_time_by_level(one);
        let mut control = QualityControl::new(None);
        let levels = simulate_motion(&mut control, 300, |_, level| time(level));
        assert!(levels[60..].iter().all(|&it| it == level), "{one} ms: {levels:?}");
        // There are at most two changes up from the first level, and two by a failed attempt at a finer one: up and
        // down.
        assert!(changes(&levels) <= 4, "{one} ms: {levels:?}");
    }
}

#[test]
fn the_first_frame_after_a_rest_is_no_finer_than_one_sample() {
    let mut control = QualityControl::new(None);
    assert_eq!(control.first_sampling(false), LEVELS[1], "nothing is known");
    simulate_motion(&mut control, 100, |_, level| frame_time_by_level(0.5)(level));
    assert_eq!((control.first_sampling(false), control.first_sampling(true)), (LEVELS[1], LEVELS[3]));
    // On a slow machine even one sample per pixel is too much.
    simulate_motion(&mut control, 100, |_, level| frame_time_by_level(50.0)(level));
    assert_eq!((control.first_sampling(false), control.first_sampling(true)), (LEVELS[0], LEVELS[0]));
}

#[test]
fn a_scene_that_becomes_slow_is_soon_kept_up_with() {
    let mut control = QualityControl::new(None);
    simulate_motion(&mut control, 100, |_, level| frame_time_by_level(0.5)(level));
    // The level falls at once after a frame that is far too late, and after two frames that are a little late.
    let levels = simulate_motion(&mut control, 20, |_, level| frame_time_by_level(5.0)(level));
    assert!(levels[1..].iter().all(|&level| level == 2), "{levels:?}");
    let mut control = QualityControl::new(None);
    simulate_motion(&mut control, 100, |_, level| frame_time_by_level(1.6)(level));
    let levels = simulate_motion(&mut control, 20, |_, level| frame_time_by_level(2.5)(level));
    assert!(levels[..2] == [1, 3] && levels[2..].iter().all(|&level| level == 2), "{levels:?}");
}

/// Small changes of the frame time do not make the level oscillate, whatever the frame time is.
#[test]
fn no_level_flickers() {
    for tenth in 1..400 {
        let time = frame_time_by_level(f64::from(tenth) / 10.0);
        let mut control = QualityControl::new(None);
        simulate_motion(&mut control, 200, |_, level| time(level));
        // Each frame's time is multiplied by a pseudorandom factor from 0.9 to 1.1.
        let noise = |frame: u32| 0.9 + 0.2 * f64::from(frame.wrapping_mul(2_654_435_769) >> 16) / 65_536.0;
        let levels = simulate_motion(&mut control, 600, |frame, level| time(level) * noise(frame));
        assert!(changes(&levels[1..]) <= 6, "{tenth} tenths of a millisecond: {levels:?}");
    }
}

/// Each attempt that fails doubles the number of frames before the next one.
#[test]
fn attempts_at_a_finer_level_that_fail_become_rare() {
    let mut control = QualityControl::new(None);
    // One sample per pixel is soon too slow each time, but the first coarse frame afterwards hides how much slower.
    let (mut last, mut frames_there) = (0, 0);
    let levels = simulate_motion(&mut control, 2_000, |_, level| {
        frames_there = if level == last { frames_there + 1 } else { 0 };
        last = level;
        match (level, frames_there) {
            (0, 0) => 8.0,
            (0, _) => 2.0,
            (_, 0..4) => 9.0,
            _ => 20.0,
        }
    });
    assert!((6..=48).contains(&changes(&levels)), "{} changes: {levels:?}", changes(&levels));
    // An attempt that succeeds is followed by the next one as soon as by the first one.
    simulate_motion(&mut control, 2_000, |_, level| frame_time_by_level(2.5)(level));
    assert_eq!((control.level, control.frames_before_finer), (2, FRAMES_BEFORE_FINER));
}

/// A single late frame may have been delayed by another process, so it does not change the level.
#[test]
fn one_late_frame_changes_nothing() {
    let mut control = QualityControl::new(None);
    simulate_motion(&mut control, 100, |_, level| frame_time_by_level(1.0)(level));
    let levels = simulate_motion(&mut control, 100, |frame, level| {
        frame_time_by_level(1.0)(level) * if frame % 10 == 9 { 3.0 } else { 1.0 }
    });
    assert_eq!(changes(&levels[1..]), 0, "{levels:?}");
}

/// A finer level is tried only after several frames in a row that were fast enough for it.
#[test]
fn room_now_and_then_is_no_room() {
    let mut control = QualityControl::new(None);
    let levels = simulate_motion(&mut control, 200, |frame, level| {
        frame_time_by_level(if frame % 4 == 3 { 9.0 } else { 2.0 })(level)
    });
    assert_eq!(changes(&levels), 0, "{levels:?}");
}

/// A level that has been too slow is not tried again and again.
///
/// In a scene with edges everywhere each level takes four times as long as the one before, not twice as predicted.
#[test]
fn the_cost_ratio_of_a_level_is_learnt() {
    let mut control = QualityControl::new(None);
    let levels = simulate_motion(&mut control, 600, |_, level| 4.0 * [0.25, 1.0, 4.0, 16.0][level]);
    assert!(levels.contains(&2) && changes(&levels) <= 6, "{levels:?}");
}

/// With fewer frames a second, each frame may take longer and gets more samples.
#[test]
fn the_time_of_a_frame_is_what_counts() {
    let mut control = QualityControl::new(None);
    for _ in 0..100 {
        let sampling = control.first_sampling(true);
        let level = LEVELS.iter().position(|&level| level == sampling).expect("it is one of them");
        control.adapt_level(sampling, ms(frame_time_by_level(10.0)(level)), 6 * FRAME);
    }
    assert_eq!(control.first_sampling(true), LEVELS[3]);
}

/// At rest a picture of any level is refined to the final level in at most two steps.
#[test]
fn a_picture_that_stands_still_is_refined_to_the_end() {
    let control = QualityControl::new(None);
    for (first, steps) in [&[2, 4][..], &[4], &[4], &[4], &[]].into_iter().enumerate() {
        let levels = |shown: &Sampling| control.next_refinement(*shown);
        let found: Vec<_> = std::iter::successors(Some(LEVELS[first]), levels).skip(1).collect();
        let steps: Vec<_> = steps.iter().map(|&level: &usize| LEVELS[level]).collect();
        assert_eq!(found, steps, "from {first}");
    }
}

#[test]
fn a_forced_level_is_the_only_one() {
    for sampling in [Sampling::BEST, Sampling::Each(NonZeroU32::MIN), Sampling::Each(NonZeroU32::new(9).expect("9"))] {
        let mut control = QualityControl::new(Some(sampling));
        for _ in 0..20 {
            control.adapt_level(sampling, ms(500.0), FRAME);
        }
        assert_eq!([control.first_sampling(false), control.first_sampling(true)], [sampling; 2]);
        assert_eq!(control.next_refinement(sampling), None);
    }
}
