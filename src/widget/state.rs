//! The state of a pane between draw calls.

use super::shot::{PaneTracer, RenderedShot, Shot};
use super::worker::PaneWorker;
use crate::camera::{Camera, Grip};
use crate::grid::Size;
use crate::hit::{Hit, closest_hit};
use crate::ray::Ray;
use crate::scene::Scene;
use glam::{Vec2, Vec3};
use ratatui_core::layout::{Position, Rect};
use std::fmt;

/// The state of a [`SceneView`](super::SceneView): the camera, and the last picture.
///
/// Positions are cells of the whole buffer, as in a terminal's mouse events. Queries by position refer to the picture
/// drawn last, which may be older than the camera.
///
/// A program with several scenes keeps one state for each: it holds the camera, the last picture and, if pictures are
/// traced in the background, one thread. A state that is not drawn starts no work.
///
/// ```
/// use ratatui::{Terminal, backend::TestBackend, layout::Position};
/// use termtrace::{Grip, Scene, SceneState, SceneView};
///
/// let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
/// let mut pane = SceneState::new(scene.camera());
/// let mut terminal = Terminal::new(TestBackend::new(40, 12))?;
/// pane.frame(&scene);
/// terminal.draw(|frame| frame.render_stateful_widget(SceneView::new(&scene), frame.area(), &mut pane))?;
///
/// let cell = Position::new(20, 6);
/// assert!(pane.hit(&scene, cell).is_some());
/// assert!(pane.scroll(&scene, cell, 1.0), "the wheel, over the picture");
/// assert!(pane.press(cell, Grip::Turn));
/// pane.drag(Position::new(24, 6));
/// pane.release();
/// pane.pan(0.1, 0.0);
/// pane.nearer(0.9);
/// assert!(!pane.is_current(), "the camera has moved since the draw call");
/// pane.set_camera(scene.camera());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SceneState {
    camera: Camera,
    /// The distance from the eye to the target when the camera was set. Later distances are limited
    /// relative to it.
    initial_target_distance: f32,
    /// The kind of the current drag and the last position of the pointer.
    drag_state: Option<(Grip, Position)>,
    /// The area of the last draw call.
    area: Rect,
    /// The shot that the last draw call requested.
    requested: Option<Shot>,
    shown: Option<RenderedShot>,
    tracer: PaneTracer,
    worker: Option<PaneWorker>,
}

impl fmt::Debug for SceneState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("SceneState");
        state.field("camera", &self.camera).field("area", &self.area).field("drag", &self.drag_state);
        state.field("is_current", &self.is_current()).finish_non_exhaustive()
    }
}

impl SceneState {
    /// Returns a state without a picture, whose pictures are traced in the draw call.
    pub fn new(camera: &Camera) -> Self {
        Self {
            camera: *camera,
            initial_target_distance: camera.target_distance(),
            drag_state: None,
            area: Rect::ZERO,
            requested: None,
            shown: None,
            tracer: PaneTracer::default(),
            worker: None,
        }
    }

    /// Traces the pictures on a background thread, which calls `wake` whenever one can be drawn.
    ///
    /// A draw call then shows the newest finished picture and requests another if that is out of date. One picture is
    /// traced at a time; of several requests only the newest is kept. With
    /// [`Sampling::UpTo`](crate::render::Sampling::UpTo) a picture with one sample per pixel comes first, and its
    /// refinement is cancelled by a request for a newer view. Dropping the state cancels the picture in progress and
    /// joins the thread.
    ///
    /// ```
    /// use std::sync::mpsc;
    /// use termtrace::{Scene, SceneState};
    ///
    /// let scene = Scene::load("scenes/three_spheres.ron".as_ref())?;
    /// let (events, loop_of_application) = mpsc::channel();
    /// let pane = SceneState::new(scene.camera()).in_background(move || _ = events.send("draw"));
    /// # drop((pane, loop_of_application));
    /// # Ok::<(), termtrace::LoadError>(())
    /// ```
    ///
    /// `wake` must not wait for the drawing thread. A panic of the thread is resumed in the next draw call, for which
    /// `wake` is called. If no thread can be started, pictures are traced in the draw call.
    #[must_use]
    pub fn in_background(self, wake: impl Fn() + Send + 'static) -> Self {
        Self { worker: PaneWorker::start(wake).ok(), ..self }
    }

    /// Returns the camera of the next draw call.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Sets the camera of the next draw call.
    pub fn set_camera(&mut self, camera: &Camera) {
        self.camera = *camera;
        self.initial_target_distance = camera.target_distance();
    }

    /// Replaces the camera, but keeps
    /// [`initial_target_distance`](Self::initial_target_distance).
    pub(super) fn set_camera_only(&mut self, to: Camera) {
        self.camera = to;
    }

    /// Returns the distance from the eye to the target when the camera was set.
    pub(super) fn initial_target_distance(&self) -> f32 {
        self.initial_target_distance
    }

    /// Returns the kind of the current drag and the last position of the pointer.
    pub(super) fn drag_state(&self) -> Option<(Grip, Position)> {
        self.drag_state
    }

    /// Starts, continues or ends (`None`) a drag.
    pub(super) fn set_drag_state(&mut self, drag_state: Option<(Grip, Position)>) {
        self.drag_state = drag_state;
    }

    /// Returns whether the pane shows the requested picture with all samples.
    ///
    /// A picture traced in the background counts once a draw call has shown it; `wake` is called when one can be drawn.
    pub fn is_current(&self) -> bool {
        let (Some(shown), Some(requested)) = (&self.shown, &self.requested) else { return false };
        shown.is_final && shown.shot.has_same_picture_as(requested) && self.camera == requested.camera
    }

    /// Returns the closest hit in `scene` of the ray through the middle of a cell.
    ///
    /// Returns `None` outside the picture, and if the ray hits nothing.
    pub fn hit(&self, scene: &Scene, at: Position) -> Option<Hit> {
        closest_hit(scene, &self.ray_through(at)?)
    }

    /// Returns the cell that shows a point of the scene, whether or not the point is hidden.
    ///
    /// Returns `None` outside the picture, and for points behind the eye.
    #[doc(hidden)]
    pub fn cell_of(&self, point: Vec3) -> Option<Position> {
        let (RenderedShot { shot, .. }, part) = (self.shown.as_ref()?, self.covered_area()?);
        let place = shot.camera.project(point, shot.resolution.aspect_ratio())?;
        let cell = (place * self.size_in_cells()?).floor();
        let is_inside =
            cell.cmpge(Vec2::ZERO).all() && cell.cmplt(Vec2::new(part.width.into(), part.height.into())).all();
        is_inside.then(|| Position::new(part.x + cell.x as u16, part.y + cell.y as u16))
    }

    /// Returns the size of the last picture in cells.
    pub(super) fn size_in_cells(&self) -> Option<Vec2> {
        let Size { columns, rows } = self.shown.as_ref()?.shot.size;
        Some(Vec2::new(columns.into(), rows.into()))
    }

    /// Returns the aspect ratio of the last requested picture; 1 before the first.
    pub(super) fn aspect_ratio(&self) -> f32 {
        self.requested.as_ref().map_or(1.0, |requested| requested.resolution.aspect_ratio())
    }

    /// Returns the eye ray through the middle of a cell of the last picture.
    pub(super) fn ray_through(&self, position: Position) -> Option<Ray> {
        let (RenderedShot { shot, .. }, part) = (self.shown.as_ref()?, self.covered_area()?);
        if !part.contains(position) {
            return None;
        }
        // The ray passes through the middle of the cell, so that `cell_of` maps the point that it hits to this cell.
        let share = |at: u16, of: u16| (f32::from(at) + 0.5) / f32::from(of);
        let (qu, qv) =
            (share(position.x - part.x, shot.size.columns), 1.0 - share(position.y - part.y, shot.size.rows));
        Some(shot.camera.eye_rays(shot.resolution.aspect_ratio()).through(qu, qv))
    }

    /// Returns the part of the pane that the last picture covers.
    // If the pane has grown, the old picture covers a part of it until the new one arrives.
    fn covered_area(&self) -> Option<Rect> {
        let size = self.shown.as_ref()?.shot.size;
        Some(self.area.intersection(Rect { width: size.columns, height: size.rows, ..self.area }))
    }

    /// Records that the pane shows nothing.
    pub(super) fn hide(&mut self) {
        self.area = Rect::ZERO;
    }

    /// Requests the picture of `shot`, if it is new, and returns the picture to draw and the part
    /// of `area` for it.
    ///
    /// # Panics
    /// With the payload of a panic in the background thread.
    pub(super) fn show(&mut self, shot: Shot, area: Rect) -> Option<(&RenderedShot, Rect)> {
        self.area = area;
        let is_new = !self.requested.as_ref().is_some_and(|requested| requested.has_same_picture_as(&shot));
        if is_new {
            self.requested = Some(shot.clone());
        }
        match &self.worker {
            Some(worker) => {
                if is_new {
                    worker.request(shot);
                }
                // The old picture stays until the new one arrives, even if its size is another.
                self.shown = worker.take_finished().or(self.shown.take());
            }
            None if is_new => self.shown = Some(self.tracer.trace(shot)),
            None => {}
        }
        let part = self.covered_area()?;
        self.shown.as_ref().map(|shown| (shown, part))
    }

    /// Writes a mark into the shown picture, by which tests notice whether the picture is replaced.
    #[cfg(test)]
    pub(super) fn mark_shown_picture(&mut self, mark: &'static str) {
        if let Some(shown) = &mut self.shown {
            shown.cells[(0, 0)].set_symbol(mark);
        }
    }

    /// Returns whether the background thread has taken the last request.
    #[cfg(test)]
    pub(super) fn has_taken_request(&self) -> bool {
        self.worker.as_ref().is_some_and(PaneWorker::has_taken_request)
    }
}
