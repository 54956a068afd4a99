//! A ratatui widget that shows a scene.
//!
//! [`SceneView`] says what is shown, and how; [`SceneState`] is kept by the application from one draw call to the next: it
//! has the camera and the last picture. A picture is traced in the draw call, or [in the background](SceneState::in_background).
//! Either way nothing is traced for a pane that is to show what it showed before.
//!
//! Nothing here reads events: an application passes on what its keys and its mouse mean.
//!
//! ```
//! use ratatui::{Terminal, backend::TestBackend};
//! use termtrace::{Scene, SceneState, SceneView};
//!
//! let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
//! let mut pane = SceneState::new(scene.camera());
//! let mut terminal = Terminal::new(TestBackend::new(40, 12))?;
//! terminal.draw(|frame| frame.render_stateful_widget(SceneView::new(&scene), frame.area(), &mut pane))?;
//! pane.orbit(0.1, 0.0);
//! terminal.draw(|frame| frame.render_stateful_widget(SceneView::new(&scene), frame.area(), &mut pane))?;
//! assert!(pane.is_current());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod shot;
mod worker;
mod state;
mod motions;
mod view;
#[cfg(test)]
mod tests;

pub use state::SceneState;
pub use view::SceneView;
