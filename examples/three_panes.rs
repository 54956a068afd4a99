//! Three panes that share one scene, each traced by a thread of its own, with the mouse.
//!
//! The left button orbits the target, the right one shifts the picture, the wheel moves nearer to the point under the
//! pointer, and a click names the object there. `f` frames the whole scene, `q` leaves.

use ratatui::crossterm::event::{self, DisableMouseCapture, EnableMouseCapture, Event, KeyCode};
use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
use ratatui::crossterm::{execute, terminal::window_size};
use ratatui::layout::{Constraint, Layout, Position};
use ratatui::widgets::Block;
use ratatui::{DefaultTerminal, Frame};
use std::error::Error;
use std::io::{self, IsTerminal};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use termtrace::{Grip, Map, Sampling, Scene, SceneState, SceneView, Size, cell_aspect_of, text_frame};

const MAPS: [Map; 3] = [Map::Shaded, Map::Depth, Map::Object];

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::load("scenes/teapots.ron".as_ref())?;
    if !io::stdout().is_terminal() {
        print!("{}", text_frame(&scene, Size::new(80, 24)));
        return Ok(());
    }
    let (sender, inbox) = channel();
    let panes = MAPS.map(|_| {
        let sender = sender.clone();
        SceneState::new(scene.camera()).in_background(move || _ = sender.send(None))
    });
    thread::spawn(move || read_events(&sender));
    let window = window_size()?;
    let cell_aspect = cell_aspect_of(window.columns, window.rows, window.width, window.height).unwrap_or(2.0);
    let mut app = App { scene, panes, cell_aspect, said: "click at something".to_owned() };
    ratatui::run(|terminal| {
        execute!(io::stdout(), EnableMouseCapture)?;
        let result = app.run(terminal, &inbox);
        execute!(io::stdout(), DisableMouseCapture)?;
        result
    })
}

/// Sends all events until the input ends or the receiver is gone.
fn read_events(sender: &Sender<Option<Event>>) {
    while let Ok(event) = event::read() {
        if sender.send(Some(event)).is_err() {
            return;
        }
    }
}

struct App {
    scene: Scene,
    panes: [SceneState; 3],
    cell_aspect: f32,
    said: String,
}

impl App {
    /// Draws after each event or picture; `None` stands for a picture.
    fn run(&mut self, terminal: &mut DefaultTerminal, inbox: &Receiver<Option<Event>>) -> Result<(), Box<dyn Error>> {
        loop {
            terminal.draw(|frame| self.draw(frame))?;
            let first = inbox.recv()?;
            // Events that have arrived meanwhile are handled before the next draw call.
            for event in std::iter::once(first).chain(inbox.try_iter()).flatten() {
                match event {
                    Event::Key(key) if key.code == KeyCode::Char('q') => return Ok(()),
                    Event::Key(key) if key.code == KeyCode::Char('f') => {
                        self.panes.iter_mut().for_each(|pane| pane.frame(&self.scene));
                    }
                    Event::Mouse(mouse) => self.take_mouse(mouse),
                    _ => {}
                }
            }
        }
    }

    fn draw(&mut self, frame: &mut Frame<'_>) {
        let [left, right] = Layout::horizontal([Constraint::Fill(2), Constraint::Fill(1)]).areas(frame.area());
        let [above, below] = Layout::vertical([Constraint::Fill(1), Constraint::Fill(1)]).areas(right);
        for ((pane, map), area) in self.panes.iter_mut().zip(MAPS).zip([left, above, below]) {
            let title = if map == Map::Shaded { &self.said } else { map.name() };
            let block = Block::bordered().title(title);
            let view = SceneView::new(&self.scene).map(map).cell_aspect(self.cell_aspect).sampling(Sampling::BEST);
            frame.render_stateful_widget(view, block.inner(area), pane);
            frame.render_widget(block, area);
        }
    }

    fn take_mouse(&mut self, mouse: MouseEvent) {
        let (at, scene) = (Position::new(mouse.column, mouse.row), &self.scene);
        for pane in &mut self.panes {
            // Each pane knows whether the position is its own.
            let is_inside = match mouse.kind {
                MouseEventKind::Down(MouseButton::Left) => pane.press(at, Grip::Turn),
                MouseEventKind::Down(_) => pane.press(at, Grip::Pan),
                MouseEventKind::ScrollUp => pane.scroll(scene, at, 1.0),
                MouseEventKind::ScrollDown => pane.scroll(scene, at, -1.0),
                MouseEventKind::Drag(_) => {
                    pane.drag(at);
                    false
                }
                _ => {
                    pane.release();
                    false
                }
            };
            if is_inside {
                let object = pane.hit(scene, at).map(|hit| format!("object {}", hit.object + 1));
                self.said = object.unwrap_or("nothing".to_owned());
            }
        }
    }
}
