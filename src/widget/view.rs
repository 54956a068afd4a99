//! The widget that draws a pane.

use super::SceneState;
use super::shot::{Options, Shot};
use crate::capabilities::{USUAL_CELL_ASPECT, is_plausible_cell_aspect};
use crate::cell::CellMode;
use crate::grid::Size;
use crate::maps::Map;
use crate::render::Sampling;
use crate::scene::Scene;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::widgets::StatefulWidget;
use std::num::NonZeroU32;

/// A widget that shows a scene as the camera of its [`SceneState`] sees it.
///
/// The widget fills the part of its area that is inside the buffer. It draws nothing into an area with more pixels than
/// a picture may have. For a frame around it, draw a block and pass the area inside to the widget:
///
/// ```
/// use ratatui::{Frame, widgets::Block};
/// use termtrace::{Scene, SceneState, SceneView};
///
/// fn draw(frame: &mut Frame<'_>, scene: &Scene, pane: &mut SceneState) {
///     let block = Block::bordered().title("a scene");
///     let inside = block.inner(frame.area());
///     frame.render_widget(block, frame.area());
///     frame.render_stateful_widget(SceneView::new(scene), inside, pane);
/// }
/// ```
///
/// A scene whose formulas depend on the time is shown at the scene's own time, which is 0 after loading. A pane is not
/// traced again while it gets copies of one scene.
///
/// # Panics
/// Drawing resumes a panic of the [background](SceneState::in_background) thread.
#[derive(Clone, Debug)]
#[must_use = "a widget does nothing before it is rendered"]
pub struct SceneView<'a> {
    scene: &'a Scene,
    options: Options,
}

impl<'a> SceneView<'a> {
    /// Returns a view with the defaults.
    ///
    /// They are the shaded picture, one ray per pixel, truecolor half blocks, and cells twice as high as wide.
    ///
    /// ```
    /// use termtrace::{CellMode, Map, Sampling, Scene, SceneView};
    ///
    /// let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
    /// let view = SceneView::new(&scene).map(Map::Depth).cells(CellMode::RAMP).sampling(Sampling::BEST);
    /// # drop(view);
    /// # Ok::<(), termtrace::LoadError>(())
    /// ```
    pub fn new(scene: &'a Scene) -> Self {
        let options = Options {
            map: Map::Shaded,
            cells: CellMode::HALF_BLOCK,
            cell_aspect: USUAL_CELL_ASPECT,
            sampling: Sampling::Each(NonZeroU32::MIN),
        };
        Self { scene, options }
    }

    /// Sets the map to show instead of the shaded picture.
    pub fn map(self, map: Map) -> Self {
        Self { options: Options { map, ..self.options }, ..self }
    }

    /// Sets the glyphs and colours.
    pub fn cells(self, cells: CellMode) -> Self {
        Self { options: Options { cells, ..self.options }, ..self }
    }

    /// Sets the cell aspect: a cell's height divided by its width.
    ///
    /// Implausible numbers, less than 0.25 or more than 8, are replaced by 2.
    ///
    /// [`cell_aspect_of`](crate::cell_aspect_of) derives it from the size of the terminal's window in pixels:
    ///
    /// ```no_run
    /// use ratatui::crossterm::terminal::{WindowSize, window_size};
    /// use termtrace::cell_aspect_of;
    ///
    /// let WindowSize { columns, rows, width, height } = window_size()?;
    /// let aspect = cell_aspect_of(columns, rows, width, height).unwrap_or(2.0);
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn cell_aspect(self, aspect: f32) -> Self {
        let cell_aspect = if is_plausible_cell_aspect(aspect) { aspect } else { USUAL_CELL_ASPECT };
        Self { options: Options { cell_aspect, ..self.options }, ..self }
    }

    /// Sets the sampling.
    pub fn sampling(self, sampling: impl Into<Sampling>) -> Self {
        Self { options: Options { sampling: sampling.into(), ..self.options }, ..self }
    }
}

#[cfg(test)]
impl<'a> SceneView<'a> {
    /// Returns the same view of another scene.
    pub(super) fn of(self, scene: &'a Scene) -> Self {
        Self { scene, ..self }
    }
}

impl StatefulWidget for SceneView<'_> {
    type State = SceneState;

    fn render(self, area: Rect, buffer: &mut Buffer, state: &mut SceneState) {
        StatefulWidget::render(&self, area, buffer, state);
    }
}

impl StatefulWidget for &SceneView<'_> {
    type State = SceneState;

    fn render(self, area: Rect, buffer: &mut Buffer, state: &mut SceneState) {
        let area = area.intersection(buffer.area);
        let size = Size::new(area.width, area.height);
        let shot = Shot::new(self.scene, state.camera(), size, self.options).ok().filter(|_| !area.is_empty());
        let Some(shot) = shot else {
            state.hide();
            return;
        };
        let Some((shown, part)) = state.show(shot, area) else { return };
        // Rows are copied as a whole, because copying cell by cell would compute and check an index for each cell.
        let columns = usize::from(part.width);
        for (from, row) in part.rows().enumerate() {
            let (from, to) = (shown.cells.index_of(0, from as u16), buffer.index_of(row.x, row.y));
            buffer.content[to..][..columns].clone_from_slice(&shown.cells.content[from..][..columns]);
        }
    }
}
