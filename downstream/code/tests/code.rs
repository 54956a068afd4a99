//! Progress and cancellation of a render.

use code::{balls, traced};
use std::error::Error;
use termtrace::{Resolution, Scene, export, tone};

type Outcome = Result<(), Box<dyn Error>>;

#[test]
fn progress_has_many_steps_and_ends_with_the_whole() -> Outcome {
    let whole = traced(&balls(7)?, Resolution::new(640, 400)?, |_| false);
    let shares = &whole.shares;
    assert!(shares.len() >= 50, "{} steps", shares.len());
    assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)) && shares.contains(&1.0), "{shares:?}");
    assert!(whole.light.is_some());
    Ok(())
}

#[test]
fn a_cancelled_render_has_no_picture() -> Outcome {
    let cancelled = traced(&balls(7)?, Resolution::new(640, 400)?, |share| share >= 0.3);
    assert!(cancelled.light.is_none());
    assert!(!cancelled.shares.contains(&1.0), "{:?}", cancelled.shares);
    Ok(())
}

#[test]
fn a_picture_can_be_written() -> Outcome {
    let scene = balls(3)?;
    let light = traced(&scene, Resolution::new(32, 20)?, |_| false).light.ok_or("it was cancelled")?;
    assert!(export::png(&tone(&light, &scene), 1.0, 2)?.starts_with(b"\x89PNG"));
    Ok(())
}

/// Values of the crate can be sent to other threads and boxed as errors.
#[test]
fn values_are_send_and_sync() {
    fn holds<T: Send + Sync + 'static>() {}
    holds::<Scene>();
    holds::<termtrace::CameraError>();
    holds::<termtrace::SceneFault>();
    holds::<termtrace::ResolutionError>();
}
