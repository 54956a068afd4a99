//! A list of solids beside a pane that shows the selected one, traced off the draw thread. Up and down select, left and
//! right orbit, plus and minus move nearer and away, `q` quits.

use ratatui::crossterm::event::{self, Event, KeyCode};
use ratatui::layout::{Constraint, Layout};
use ratatui::widgets::{Block, List, ListState};
use std::time::Duration;
use termtrace::{Sampling, Scene, SceneState, SceneView};

const SOLIDS: [(&str, &str); 2] = [("ball", include_str!("../ball.ron")), ("snowman", include_str!("../snowman.ron"))];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut panes = Vec::new();
    for (name, text) in SOLIDS {
        let scene = Scene::from_ron(name, text)?;
        let pane = SceneState::new(scene.camera()).in_background(|| {});
        panes.push((scene, pane));
    }
    let mut list = ListState::default().with_selected(Some(0));
    Ok(ratatui::run(|terminal| -> std::io::Result<()> {
        loop {
            let last = panes.len() - 1;
            let (scene, pane) = &mut panes[list.selected().unwrap_or(0).min(last)];
            terminal.draw(|frame| {
                let [left, right] =
                    Layout::horizontal([Constraint::Length(12), Constraint::Fill(1)]).areas(frame.area());
                let names = List::new(SOLIDS.map(|(name, _)| name)).highlight_symbol(">").block(Block::bordered());
                frame.render_stateful_widget(names, left, &mut list);
                frame.render_stateful_widget(SceneView::new(scene).sampling(Sampling::BEST), right, pane);
            })?;
            if !pane.is_current() && !event::poll(Duration::from_millis(16))? {
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
    })?)
}
