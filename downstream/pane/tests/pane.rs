//! The pane below another widget, on a screen in memory.

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout};
use std::error::Error;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use termtrace::{Sampling, Scene, SceneState, SceneView};

const SCENE: &str = include_str!("../ball.ron");
/// Far longer than any picture takes; a test that waits this long fails.
const LONG: Duration = Duration::from_secs(60);

type Outcome = Result<(), Box<dyn Error>>;

/// Draws a line of text and the pane until the pane is current; returns the screen.
fn drawn(scene: &Scene, pane: &mut SceneState, woken: Option<&Receiver<()>>) -> Result<Buffer, Box<dyn Error>> {
    let mut terminal = Terminal::new(TestBackend::new(60, 20))?;
    loop {
        terminal.draw(|frame| {
            let [top, rest] = Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(frame.area());
            frame.render_widget("a title", top);
            frame.render_stateful_widget(SceneView::new(scene).sampling(Sampling::BEST), rest, pane);
        })?;
        match woken {
            _ if pane.is_current() => return Ok(terminal.backend().buffer().clone()),
            Some(woken) => woken.recv_timeout(LONG)?,
            None => return Err("traced in the draw call, the pane is current after it".into()),
        }
    }
}

#[test]
fn the_background_draws_the_same_picture_as_the_draw_call() -> Outcome {
    let scene = Scene::from_ron("ball.ron", SCENE)?;
    let in_place = drawn(&scene, &mut SceneState::new(scene.camera()), None)?;
    let (wake, woken) = channel();
    let mut pane = SceneState::new(scene.camera()).in_background(move || {
        let _ = wake.send(());
    });
    let in_background = drawn(&scene, &mut pane, Some(&woken))?;
    assert_eq!(in_background, in_place);
    let title: String = in_place.content()[..7].iter().map(|cell| cell.symbol()).collect();
    assert_eq!(title, "a title");
    assert!(in_place.content()[60..].iter().any(|cell| cell.symbol() == "▄"), "half blocks: {in_place:?}");
    Ok(())
}

#[test]
fn a_turned_scene_looks_different_and_turned_back_the_same() -> Outcome {
    let scene = Scene::from_ron("ball.ron", SCENE)?;
    let mut pane = SceneState::new(scene.camera());
    let before = drawn(&scene, &mut pane, None)?;
    pane.orbit(0.4, 0.1);
    assert!(!pane.is_current());
    assert_ne!(drawn(&scene, &mut pane, None)?, before);
    pane.set_camera(scene.camera());
    assert_eq!(drawn(&scene, &mut pane, None)?, before);
    Ok(())
}
