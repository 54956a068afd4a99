//! A scene in an inline viewport, below the shell's output: finds a view, and prints it.
//!
//! Arrows orbit the target, plus and minus move nearer and away, Enter prints the eye point above the picture, `q`
//! leaves.

use ratatui::crossterm::event::{self, Event, KeyCode};
use ratatui::text::Line;
use ratatui::widgets::Widget;
use ratatui::{DefaultTerminal, TerminalOptions, Viewport};
use std::error::Error;
use std::io::{self, IsTerminal};
use termtrace::{Scene, SceneState, SceneView, Size, text_frame};

const ROWS: u16 = 14;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
    if !io::stdout().is_terminal() {
        print!("{}", text_frame(&scene, Size::new(80, ROWS)));
        return Ok(());
    }
    let mut terminal = ratatui::init_with_options(TerminalOptions { viewport: Viewport::Inline(ROWS) });
    let result = look_for_views(&mut terminal, &scene);
    ratatui::restore();
    // The shell's prompt continues on the next line.
    println!();
    result
}

fn look_for_views(terminal: &mut DefaultTerminal, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let view = SceneView::new(scene);
    let mut pane = SceneState::new(scene.camera());
    loop {
        terminal.draw(|frame| frame.render_stateful_widget(&view, frame.area(), &mut pane))?;
        let Event::Key(key) = event::read()? else { continue };
        match key.code {
            KeyCode::Left => pane.orbit(-0.1, 0.0),
            KeyCode::Right => pane.orbit(0.1, 0.0),
            KeyCode::Up => pane.orbit(0.0, 0.1),
            KeyCode::Down => pane.orbit(0.0, -0.1),
            KeyCode::Char('+') => pane.nearer(0.9),
            KeyCode::Char('-') => pane.nearer(1.1),
            KeyCode::Enter => {
                let eye = Line::from(format!("eye: {}", pane.camera().pose().eye));
                terminal.insert_before(1, |buffer| eye.render(buffer.area, buffer))?;
            }
            KeyCode::Char('q') => return Ok(()),
            _ => {}
        }
    }
}
