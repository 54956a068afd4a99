//! A list of scenes beside a pane that shows one of them, traced off the thread that draws.
//!
//! Up and down choose, left and right orbit, plus and minus move nearer and away, `q` leaves.

use ratatui::crossterm::event::{self, Event, KeyCode};
use ratatui::layout::{Constraint, Layout};
use ratatui::widgets::{Block, List, ListState};
use std::io::{self, IsTerminal};
use std::time::Duration;
use termtrace::{Sampling, Scene, SceneState, SceneView, Size, text_frame};

const NAMES: [&str; 3] = ["three_spheres", "corridor", "teapots"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut panes = Vec::new();
    for name in NAMES {
        let scene = Scene::load(format!("scenes/{name}.ron").as_ref())?;
        let pane = SceneState::new(scene.camera()).in_background(|| {});
        panes.push((scene, pane));
    }
    if !io::stdout().is_terminal() {
        print!("{}", text_frame(&panes[0].0, Size::new(80, 24)));
        return Ok(());
    }
    let mut list = ListState::default().with_selected(Some(0));
    ratatui::run(|terminal| {
        loop {
            let (scene, pane) = &mut panes[list.selected().unwrap_or(0).min(NAMES.len() - 1)];
            terminal.draw(|frame| {
                let [left, right] =
                    Layout::horizontal([Constraint::Length(17), Constraint::Fill(1)]).areas(frame.area());
                let names = List::new(NAMES).block(Block::bordered().title("scenes")).highlight_symbol("> ");
                frame.render_stateful_widget(names, left, &mut list);
                frame.render_stateful_widget(SceneView::new(scene).sampling(Sampling::BEST), right, pane);
            })?;
            // Looks for the next picture as long as one is on its way.
            if !pane.is_current() && !event::poll(Duration::from_millis(10))? {
                continue;
            }
            let Event::Key(key) = event::read()? else { continue };
            match key.code {
                KeyCode::Up => list.select_previous(),
                KeyCode::Down => list.select_next(),
                KeyCode::Left => pane.orbit(-0.1, 0.0),
                KeyCode::Right => pane.orbit(0.1, 0.0),
                KeyCode::Char('+') => pane.nearer(0.9),
                KeyCode::Char('-') => pane.nearer(1.1),
                KeyCode::Char('q') => return Ok(()),
                _ => {}
            }
        }
    })
}
