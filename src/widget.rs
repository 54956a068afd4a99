//! A ratatui widget that shows a scene.
//!
//! [`SceneView`] holds the options of a pane; [`SceneState`] is kept by the application between draw calls and holds
//! the camera and the last picture. Pictures are traced in the draw call or [in the
//! background](SceneState::in_background). A pane whose scene, camera, size and options are unchanged is not traced
//! again.
//!
//! The widget reads no events: the application calls the state's methods for its keys and mouse events.
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
#[cfg(all(test, unit_tests))]
mod tests;

pub use state::SceneState;
pub use view::SceneView;
