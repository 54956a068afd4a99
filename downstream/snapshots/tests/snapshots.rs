//! Snapshots of frames, colours and an error message. `INSTA_UPDATE=always cargo test -p snapshots` updates them.

use snapshots::BALL;
use termtrace::export::{compare, framed, styled};
use termtrace::{CellMode, Scene, SceneError, Size, frame_grid, text_frame};

#[test]
fn the_ball_as_text() -> Result<(), SceneError> {
    insta::assert_snapshot!(text_frame(&Scene::from_ron("ball.ron", BALL)?, Size::new(24, 10)));
    Ok(())
}

/// The border keeps the blank rows in the snapshot.
#[test]
fn the_ball_with_its_margins() -> Result<(), SceneError> {
    let scene = Scene::from_ron("ball.ron", BALL)?;
    insta::assert_snapshot!(framed(&frame_grid(&scene, CellMode::RAMP, Size::new(24, 10), 2.0)));
    let taller = framed(&frame_grid(&scene, CellMode::RAMP, Size::new(24, 12), 2.0));
    assert!(taller.starts_with("24x12\n"));
    Ok(())
}

#[test]
fn the_ball_in_colours_that_can_be_reviewed() -> Result<(), SceneError> {
    let scene = Scene::from_ron("ball.ron", BALL)?;
    insta::assert_snapshot!(styled(&frame_grid(&scene, CellMode::HALF_BLOCK, Size::new(10, 4), 2.0)));
    Ok(())
}

#[test]
fn a_misspelt_field() {
    let error = Scene::from_ron("ball.ron", &BALL.replace("radius", "radus")).expect_err("there is no such field");
    insta::assert_snapshot!(error);
}

#[test]
fn a_difference_says_where() -> Result<(), SceneError> {
    let frame = |text: &str| Ok(text_frame(&Scene::from_ron("ball.ron", text)?, Size::new(24, 10)));
    let (small, large) = (frame(BALL)?, frame(&BALL.replace("radius: 1", "radius: 1.3"))?);
    assert_eq!(compare(&small, &small), None);
    insta::assert_snapshot!(compare(&small, &large).expect("they differ"));
    Ok(())
}
