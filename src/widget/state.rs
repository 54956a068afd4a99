//! What a pane keeps from one draw call to the next.

use super::shot::{Shot, Shown, Tracer};
use super::worker::Worker;
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
/// Positions are cells of the whole buffer, as in the mouse events of a terminal. What is asked by position is answered
/// about the picture that was drawn last, which may be older than the camera.
pub struct SceneState {
    camera: Camera,
    /// A length that says how near the eye may come, and how far away it may go.
    scale: f32,
    /// What a drag does, and where the pointer was last.
    held: Option<(Grip, Position)>,
    /// Where the pane was drawn last.
    area: Rect,
    /// What the last draw call asked for.
    wanted: Option<Shot>,
    shown: Option<Shown>,
    tracer: Tracer,
    worker: Option<Worker>,
}

impl fmt::Debug for SceneState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("SceneState");
        state.field("camera", &self.camera).field("area", &self.area).field("held", &self.held);
        state.field("is_current", &self.is_current()).finish_non_exhaustive()
    }
}

impl SceneState {
    /// Returns a state with nothing drawn yet, whose pictures are traced in the draw call.
    pub fn new(camera: &Camera) -> Self {
        Self {
            camera: *camera,
            scale: camera.target_distance(),
            held: None,
            area: Rect::ZERO,
            wanted: None,
            shown: None,
            tracer: Tracer::default(),
            worker: None,
        }
    }

    /// Traces the pictures on a thread of this state's own, and calls `wake` on it whenever there is something new to draw.
    ///
    /// A draw call then shows the newest picture that is finished, and asks for another where that is out of date. One
    /// picture is traced at a time; of several that are asked for meanwhile, only the newest is traced. With
    /// [`Sampling::UpTo`](crate::render::Sampling::UpTo) a picture with one sample a pixel comes first, and the other
    /// samples are given up for a newer view. To drop the state gives everything up, and waits for the thread.
    ///
    /// `wake` must not wait for the thread that draws. A panic on the thread goes on in the next draw call, for which `wake` is called. Where no thread can be started,
    /// pictures are traced in the draw call.
    #[must_use]
    pub fn in_background(self, wake: impl Fn() + Send + 'static) -> Self {
        Self { worker: Worker::start(wake).ok(), ..self }
    }

    /// Returns where the scene is looked at from in the next draw call.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Looks at the scene from somewhere else.
    pub fn set_camera(&mut self, camera: &Camera) {
        self.camera = *camera;
        self.scale = camera.target_distance();
    }

    /// Moves the camera, in the scale in which it was set.
    pub(super) fn move_camera(&mut self, to: Camera) {
        self.camera = to;
    }

    /// Returns the distance from the eye to the target when the camera was set.
    pub(super) fn scale(&self) -> f32 {
        self.scale
    }

    /// Returns what a drag does, and where the pointer was last; `None` if nothing is held.
    pub(super) fn held(&self) -> Option<(Grip, Position)> {
        self.held
    }

    /// Takes hold of the picture there, or lets go of it.
    pub(super) fn hold(&mut self, held: Option<(Grip, Position)>) {
        self.held = held;
    }

    /// Returns whether the pane shows what the last draw call asked for, with all of its samples, and the camera has not
    /// changed since. In the background, `wake` is called before it can become so.
    pub fn is_current(&self) -> bool {
        let (Some(shown), Some(wanted)) = (&self.shown, &self.wanted) else { return false };
        shown.is_final && shown.shot.is_same(wanted) && self.camera == wanted.camera
    }

    /// Returns what is seen in the cell at a position: the closest hit in `scene` of the ray through the cell's middle.
    /// `None` outside the picture, and where the ray meets nothing.
    pub fn hit(&self, scene: &Scene, at: Position) -> Option<Hit> {
        closest_hit(scene, &self.ray_through(at)?)
    }

    /// Returns the cell in which a point of the scene is, or would be if nothing were in front of it. `None` outside the picture,
    /// and behind the eye.
    pub fn cell_of(&self, point: Vec3) -> Option<Position> {
        let (Shown { shot, .. }, part) = (self.shown.as_ref()?, self.part()?);
        let place = shot.camera.place_of(point, shot.resolution.aspect_ratio())?;
        let cell = (place * self.size()?).floor();
        let is_inside =
            cell.cmpge(Vec2::ZERO).all() && cell.cmplt(Vec2::new(part.width.into(), part.height.into())).all();
        is_inside.then(|| Position::new(part.x + cell.x as u16, part.y + cell.y as u16))
    }

    /// Returns the size of the picture that was drawn last, in cells.
    pub(super) fn size(&self) -> Option<Vec2> {
        let Size { columns, rows } = self.shown.as_ref()?.shot.size;
        Some(Vec2::new(columns.into(), rows.into()))
    }

    /// Returns the aspect ratio of the picture that was asked for last; a square's before the first.
    pub(super) fn aspect_ratio(&self) -> f32 {
        self.wanted.as_ref().map_or(1.0, |wanted| wanted.resolution.aspect_ratio())
    }

    /// Returns the eye ray through the middle of a cell, in the picture that was drawn last.
    pub(super) fn ray_through(&self, at: Position) -> Option<Ray> {
        let (Shown { shot, .. }, part) = (self.shown.as_ref()?, self.part()?);
        if !part.contains(at) {
            return None;
        }
        let share = |at: u16, of: u16| (f32::from(at) + 0.5) / f32::from(of);
        let (qu, qv) = (share(at.x - part.x, shot.size.columns), 1.0 - share(at.y - part.y, shot.size.rows));
        Some(shot.camera.eye_rays(shot.resolution.aspect_ratio()).through(qu, qv))
    }

    /// The part of the pane that the picture covers: less than all of it, where a larger one is asked for.
    fn part(&self) -> Option<Rect> {
        let size = self.shown.as_ref()?.shot.size;
        Some(self.area.intersection(Rect { width: size.columns, height: size.rows, ..self.area }))
    }

    /// Takes note of a pane that shows nothing.
    pub(super) fn hide(&mut self) {
        self.area = Rect::ZERO;
    }

    /// Sees to it that there is a picture of that shot, or will be, and returns the one to be drawn, with its part of the
    /// pane.
    ///
    /// # Panics
    /// With what the thread in the background panicked with.
    pub(super) fn show(&mut self, shot: Shot, area: Rect) -> Option<(&Shown, Rect)> {
        self.area = area;
        let is_new = !self.wanted.as_ref().is_some_and(|wanted| wanted.is_same(&shot));
        if is_new {
            self.wanted = Some(shot.clone());
        }
        match &self.worker {
            Some(worker) => {
                if is_new {
                    worker.want(shot);
                }
                self.shown = worker.take().or(self.shown.take());
            }
            None if is_new => self.shown = Some(self.tracer.trace(shot)),
            None => {}
        }
        let part = self.part()?;
        self.shown.as_ref().map(|shown| (shown, part))
    }

    /// Puts a mark into the picture that is shown, which nothing but another picture removes.
    #[cfg(test)]
    pub(super) fn mark(&mut self, mark: &'static str) {
        if let Some(shown) = &mut self.shown {
            shown.cells[(0, 0)].set_symbol(mark);
        }
    }

    /// Returns whether the thread in the background has taken up what was asked for last.
    #[cfg(test)]
    pub(super) fn is_in_work(&self) -> bool {
        self.worker.as_ref().is_some_and(Worker::is_in_work)
    }
}
