//! Mouse actions on the view, the line between two maps, and the cursor of an explanation.

use super::Viewer;
use super::note::Note;
use super::pointer::DragTarget;
use super::warnings::Warnings;
use crate::control::{self, Gesture, Grip, KeyMode};
use crate::hit::closest_hit;
use crate::input::Input;
use crate::ray::Ray;
use crossterm::event::{Event, MouseEvent, MouseEventKind};
use glam::{Vec2, Vec3};

/// Greatest distance in columns from the line between two maps at which a press takes hold of the
/// line.
// The line itself is one column wide, which is hard to hit with a pointer that moves by whole cells.
const WIPE_GRAB_COLUMNS: f32 = 2.0;

/// Returns whether `input` need not be handled because `next` continues the same drag.
///
/// Of consecutive motions of a drag that arrive together, only the last position matters.
// If all motions were handled, each would trace a frame, and on a slow link the picture would lag behind the pointer.
pub(super) fn is_superseded(input: &Input, next: Option<&Input>) -> bool {
    let way = |input: &Input| match input {
        Input::Event(Event::Mouse(MouseEvent { kind: kind @ MouseEventKind::Drag(_), .. })) => Some(*kind),
        _ => None,
    };
    way(input).is_some() && way(input) == next.and_then(way)
}

impl Viewer {
    /// Carries out a mouse event. An open question is answered by keys only.
    pub(super) fn take_mouse(&mut self, event: MouseEvent) {
        let at = self.screen_shares(event);
        let modes = self.screen.active_modes(self.picture_size());
        let Some(gesture) = self.pointer.take(event, at, self.now).filter(|_| modes.contains(&self.eye.mode())) else {
            return;
        };
        match gesture {
            Gesture::Press { at, grip } => {
                self.screen.close::<Note>();
                self.screen.close::<Warnings>();
                let target = self.drag_target_at(at, grip, &modes);
                let is_on_view = grip == Grip::Turn && target == DragTarget::View;
                let object = is_on_view.then(|| self.object_at(at)).flatten();
                self.pointer.start_drag(target, object);
                self.drag(at, at, grip);
            }
            Gesture::Drag { from, to, grip } => {
                if from != to {
                    self.pointer.record_motion();
                }
                self.drag(from, to, grip);
            }
            Gesture::Release if self.pointer.is_click_on_object() => self.centre_on(at),
            Gesture::Release => {}
            Gesture::DoubleClick if self.pointer.drag_target() == DragTarget::View => {
                self.frame_object(self.pointer.object());
                // The double click counts as a motion, so that the release of its second press is not a click.
                self.pointer.record_motion();
            }
            // If the first press took hold of the line, a light or the cursor, the second press of a double click acts
            // like the first one, and the view does not change.
            Gesture::DoubleClick => self.drag(at, at, Grip::Turn),
            Gesture::Wheel { at, notches } => self.wheel(at, notches),
        }
    }

    /// Returns the event's position as shares of the screen's width and height, from the upper
    /// left.
    fn screen_shares(&self, event: MouseEvent) -> Vec2 {
        let (width, height) = self.display.pixel_mouse_cell_size().unwrap_or((1, 1));
        let size = self.picture_size();
        let screen = Vec2::new(f32::from(width) * f32::from(size.columns), f32::from(height) * f32::from(size.rows));
        // The position within the cell or pixel is unknown, so its middle is used.
        let at = Vec2::new(f32::from(event.column), f32::from(event.row)) + 0.5;
        (at / screen).clamp(Vec2::ZERO, Vec2::ONE)
    }

    /// Returns what a drag that starts at this position with this grip moves.
    fn drag_target_at(&self, at: Vec2, grip: Grip, modes: &[KeyMode]) -> DragTarget {
        let beside = (at.x - self.screen.wipe()).abs() * f32::from(self.picture_size().columns);
        // The line comes first, because it is the smallest target and no other way of dragging reaches it. A pan always
        // moves the view, so that the view can be shifted whatever is under the pointer.
        match grip {
            Grip::Turn if self.layout.is_wipe() && beside <= WIPE_GRAB_COLUMNS => DragTarget::Line,
            Grip::Turn if modes.contains(&KeyMode::Light) => DragTarget::Light,
            Grip::Turn if modes.contains(&KeyMode::Explain) => DragTarget::Cursor,
            _ => DragTarget::View,
        }
    }

    fn drag(&mut self, from: Vec2, to: Vec2, grip: Grip) {
        match self.pointer.drag_target() {
            DragTarget::Line => self.wipe_to(to.x),
            DragTarget::Cursor => {
                let pixel = self.pixel_at(to);
                self.screen.explain(|panel, frame| panel.move_to(frame, pixel));
            }
            DragTarget::Light => self.drag_light(self.to_map_shares(to - from)),
            DragTarget::View if from == to => {}
            DragTarget::View => {
                let (by, aspect_ratio) = (self.to_map_shares(to - from), self.first_map_resolution().aspect_ratio());
                let mode = self.eye.mode();
                let drag = |camera: &_, _| control::dragged(camera, mode, grip, by, aspect_ratio);
                self.eye.change(self.now, drag);
            }
        }
    }

    fn wheel(&mut self, at: Vec2, notches: f32) {
        // While a light is held, the wheel moves the light in depth, which a drag cannot do.
        if self.holds_light() {
            self.wheel_light(notches);
            return;
        }
        let Some(point) = self.zoom_point_at(at) else { return };
        let mode = self.eye.mode();
        let wheel = |camera: &_, size| control::wheeled(camera, mode, point, notches, size);
        self.eye.change(self.now, wheel);
    }

    /// Converts a displacement in shares of the screen to shares of one map's width and height.
    fn to_map_shares(&self, displacement: Vec2) -> Vec2 {
        displacement * Vec2::new(self.resolution().width() as f32 / self.first_map_resolution().width() as f32, 1.0)
    }

    /// Returns the pixel of the picture at a position in shares of the screen.
    fn pixel_at(&self, at: Vec2) -> [u32; 2] {
        let resolution = self.shown_resolution();
        [(at.x * resolution.width() as f32) as u32, (at.y * resolution.height() as f32) as u32]
    }

    /// Returns the surface point that is seen at a position in shares of the screen, or `None`
    /// without a frame.
    ///
    /// If nothing is hit there, returns a point as far away as the target.
    fn zoom_point_at(&self, at: Vec2) -> Option<Vec3> {
        let (frame, pose) = (self.screen.frame()?, self.eye.camera()?.pose());
        let ray = self.eye_ray_at(at)?;
        // Without a hit, the ray ends at the t at which the ray towards the target reaches the target.
        let miss = pose.eye.distance(pose.target) * self.eye.camera()?.rectangle().plane_distance();
        let t = closest_hit(&frame.scene, &ray).map_or(miss, |hit| hit.t);
        Some(ray.at(t))
    }

    /// Returns the eye ray through the pixel at a position of the screen.
    pub(super) fn eye_ray_at(&self, at: Vec2) -> Option<Ray> {
        let (frame, camera) = (self.screen.frame()?, self.eye.camera()?);
        let (part, [x, y]) = frame.part_at(self.pixel_at(at));
        let share = |at: u32, of: u32| (at as f32 + 0.5) / of.max(1) as f32;
        let rays = camera.eye_rays(part.aspect_ratio());
        Some(rays.through(share(x, part.width()), 1.0 - share(y, part.height())))
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
