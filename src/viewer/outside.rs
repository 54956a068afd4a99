//! The tracer seen from outside: a second eye, whose picture is beside the first camera's and shows
//! that camera as geometry.

use super::Viewer;
use super::explain::ExplainPanel;
use super::orders::OrdersPanel;
use super::theme;
use super::tracer_lines::{TracerMarks, VanishingPoints};
use super::view_layout::ViewLayout;
use crate::bounds::Bounds;
use crate::camera::{Basis, Camera, Pose};
use crate::hit::closest_hit;
use crate::ray::Ray;
use crate::scene::Scene;
use glam::Vec3;

/// Whether a second camera shows the first one from outside, and which of the two the keys move.
///
/// A variant with a camera holds the one that the keys do not move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Outside {
    /// The ordinary view.
    #[default]
    Off,
    /// Keys move the second camera.
    MovesSecond { first: Camera },
    /// Keys move the first camera.
    MovesFirst { second: Camera },
    /// The ordinary view with the horizon and vanishing points.
    Vanishing,
}

impl Viewer {
    /// Switches to the next of four views.
    ///
    /// In the first two, a second camera shows the first one from outside, and keys move the second or the first
    /// camera. Then come the ordinary view with the horizon and vanishing points, and the ordinary view alone.
    pub(super) fn show_next_outside_view(&mut self) {
        if !theme::has_room(theme::area(self.size())) {
            return self.show_note(theme::needs_room("the view from outside"));
        }
        self.close_orders();
        let Some(camera) = self.eye.camera() else { return };
        let (next, text) = match self.outside {
            Outside::Off => {
                self.screen.open(TracerMarks);
                (Outside::MovesSecond { first: camera }, "keys move the second eye")
            }
            Outside::MovesSecond { .. } => (Outside::MovesFirst { second: camera }, "keys move the first camera"),
            Outside::MovesFirst { .. } => {
                self.end_outside();
                self.screen.open(VanishingPoints);
                (Outside::Vanishing, "horizon and vanishing points")
            }
            Outside::Vanishing => {
                self.end_outside();
                (Outside::Off, "ordinary view")
            }
        };
        let moved = match (self.outside, next) {
            (Outside::MovesSecond { first }, _) => first,
            (_, Outside::MovesSecond { .. }) => match self.screen.frame() {
                Some(frame) => camera_beside(&frame.scene, &camera, 0.5 * self.resolution().aspect_ratio()),
                None => camera,
            },
            _ => camera,
        };
        self.eye.change(self.now, |_, _| moved);
        self.set_outside(next);
        if let Outside::MovesSecond { .. } = next {
            self.explain_middle_pixel();
        }
        let hint = self.hint(crate::control::Command::Outside, "next");
        self.show_note(format!("{text}{hint}"));
    }

    /// Opens the explanation of the pixel in the middle of the left picture, whose ray is drawn.
    fn explain_middle_pixel(&mut self) {
        if self.screen.get::<ExplainPanel>().is_none() {
            self.screen.toggle_explaining();
        }
        let resolution = self.resolution();
        // A quarter of the whole width is the middle of the left picture.
        let middle = [resolution.width() / 4, resolution.height() / 2];
        self.screen.explain(|panel, frame| panel.move_to(frame, middle));
    }

    /// Ends the view from outside, with the eye at the first camera.
    pub(super) fn end_outside(&mut self) {
        if let Outside::MovesSecond { first } = self.outside {
            self.eye.change(self.now, |_, _| first);
        }
        if self.outside != Outside::Off {
            self.screen.close::<TracerMarks>();
            self.screen.close::<ExplainPanel>();
            self.screen.close::<VanishingPoints>();
        }
        self.set_outside(Outside::Off);
    }

    /// Returns the first camera: that of the left picture if a second one is shown beside it.
    pub(super) fn first_camera(&self) -> Option<Camera> {
        match self.outside {
            Outside::MovesSecond { first } => Some(first),
            _ => self.eye.camera(),
        }
    }

    /// Returns the second camera, which shows the first one from outside, if there is one.
    pub(super) fn second_camera(&self) -> Option<Camera> {
        match self.outside {
            Outside::MovesSecond { .. } => self.eye.camera(),
            Outside::MovesFirst { second } => Some(second),
            Outside::Off | Outside::Vanishing => None,
        }
    }

    /// Returns the layout of the picture: the map twice while there are two cameras or two orders.
    pub(super) fn shown_layout(&self) -> ViewLayout {
        let is_twice = self.second_camera().is_some() || self.screen.get::<OrdersPanel>().is_some();
        if is_twice { self.layout.twice() } else { self.layout }
    }
}

/// Returns a camera that sees another one, its view rectangle and its target from the side.
///
/// It is in front of a surface that is in the way, and may then not see all of them.
fn camera_beside(scene: &Scene, camera: &Camera, aspect_ratio: f32) -> Camera {
    let (Pose { eye, target, up }, Basis { u, v, w }) = (camera.pose(), camera.basis());
    let distance = camera.target_distance();
    let around = Vec3::splat(0.3 * distance);
    // The box includes the end of the axis w, a little beyond its drawn length of 0.16: no other drawn point is farther
    // from the target.
    let end_of_w = eye + 0.2 * distance * w;
    let bounds = Bounds::of([eye, end_of_w, target - around, target + around]);
    let middle = 0.5 * (bounds.min + bounds.max);
    let from = middle + distance * (0.9 * u + 0.5 * v + 0.8 * w);
    let seen = Camera::look_at(from, middle).and_then(|seen| seen.with_up(up));
    let Ok(seen) = seen.map(|seen| seen.framing(&bounds, aspect_ratio)) else { return *camera };
    // A wall between both eyes would hide the first one.
    let way = seen.pose().eye - eye;
    let t = closest_hit(scene, &Ray { origin: eye, direction: way }).map_or(1.0, |hit| (0.9 * hit.t).min(1.0));
    seen.with_pose(Pose { eye: eye + t * way, ..seen.pose() }).unwrap_or(seen)
}

#[cfg(all(test, unit_tests))]
mod tests;
