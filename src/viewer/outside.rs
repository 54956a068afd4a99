//! The tracer seen from outside: a second eye, whose picture is beside the first camera's and shows
//! that camera as geometry.

use super::Viewer;
use super::explain::ExplainPanel;
use super::orders::{RenderOrdersPanel, panel_rows};
use super::theme;
use super::tracer_lines::{TracerMarks, VanishingPoints};
use super::view_layout::ViewLayout;
use crate::bounds::Bounds;
use crate::camera::{Basis, Camera, Pose};
use crate::control::Command;
use crate::hit::closest_hit;
use crate::ray::Ray;
use crate::scene::Scene;

/// Whether a second camera shows the first one from outside, and which of the two the keys move.
///
/// A variant with a camera holds the one that the keys do not move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum OutsideView {
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

impl OutsideView {
    /// Returns the caption that replaces the scene's; `None` for the ordinary view.
    pub(super) fn caption(&self) -> Option<&'static str> {
        match self {
            Self::Off => None,
            Self::MovesSecond { .. } => Some(SECOND_EYE_CAPTION),
            Self::MovesFirst { .. } => Some(FIRST_CAMERA_CAPTION),
            Self::Vanishing => Some(VANISHING_CAPTION),
        }
    }

    /// Returns the keys that a caption on a tour names, with what they do.
    pub(super) fn keys(&self) -> [(Command, &'static str); 2] {
        let next = match self {
            Self::Off => return [(Command::Outside, "from outside"), (Command::Orders, "both orders")],
            Self::MovesSecond { .. } => "moves the first camera",
            Self::MovesFirst { .. } => "vanishing points",
            Self::Vanishing => "ordinary view",
        };
        [(Command::Outside, next), (Command::Close, "leaves")]
    }
}

// The first two rows of each caption are its first page on a screen of 80x24 cells.
const SECOND_EYE_CAPTION: &str = "\
The tracer from outside: o is the eye; u points to the right, v up, and the camera looks along -w, through the view \
rectangle (cyan) with its pixel grid.
The white ray is that of the pixel under the cross: from o through the pixel at q to its hit p, where n is the normal.
From p a shadow ray leads to each light (*): yellow if the light arrives, grey if it does not.
The right picture is that of a second eye, which is no part of the tracer: it only watches.
Keys: the arrows choose another pixel, w a s d and e c move the second eye, ( ) shift the view rectangle, { } tilt it.";

const FIRST_CAMERA_CAPTION: &str = "\
Now the keys move the first camera: o, u, v, w and the view rectangle move along, and the left picture is what it sees.
Keys: w a s d move the eye o; [ ] resize the view rectangle, ( ) shift it down and up, { } tilt it down and up, \
; : to the left and right.";

const VANISHING_CAPTION: &str = "\
Parallel lines meet in their vanishing point: where the ray from the eye along them goes through the view rectangle.
Crosses mark it for lines along x, y and z. The white line is the horizon, where all level lines vanish.
Keys: w a s d move the eye, and the points stay; the arrows turn the camera, and the points move.";

impl Viewer {
    /// Switches to the next of four views.
    ///
    /// In the first two, a second camera shows the first one from outside, and keys move the second or the first
    /// camera. Then come the ordinary view with the horizon and vanishing points, and the ordinary view alone.
    pub(super) fn show_next_outside_view(&mut self) {
        if !theme::has_room(theme::area(self.picture_size())) {
            return self.show_note(theme::needs_room("the view from outside"));
        }
        self.close_orders();
        let Some(camera) = self.eye.camera() else { return };
        let (next, text) = match self.outside_view {
            OutsideView::Off => {
                self.screen.open(TracerMarks);
                (OutsideView::MovesSecond { first: camera }, "keys move the second eye")
            }
            OutsideView::MovesSecond { .. } => {
                (OutsideView::MovesFirst { second: camera }, "keys move the first camera")
            }
            OutsideView::MovesFirst { .. } => {
                self.end_outside_view();
                self.screen.open(VanishingPoints);
                (OutsideView::Vanishing, "horizon and vanishing points")
            }
            OutsideView::Vanishing => {
                self.end_outside_view();
                (OutsideView::Off, "ordinary view")
            }
        };
        let moved = match (self.outside_view, next) {
            (OutsideView::MovesSecond { first }, _) => first,
            (_, OutsideView::MovesSecond { .. }) => self.beside(camera),
            _ => camera,
        };
        self.eye.change(self.now, |_, _| moved);
        self.set_outside_view(next);
        if let OutsideView::MovesSecond { .. } = next {
            self.explain_middle_pixel();
        }
        let explains =
            self.outside_view.caption().filter(|_| !self.captions).map(|_| self.hint(Command::Caption, "explains"));
        let explains = explains.unwrap_or_default();
        let hint = self.hint(Command::Outside, "next");
        self.show_note(format!("{text}{explains}{hint}"));
    }

    /// Returns the initial second camera: beside the first one, which it sees.
    fn beside(&self, first: Camera) -> Camera {
        let Some(frame) = self.screen.frame() else { return first };
        camera_beside(&frame.scene, &first, 0.5 * self.resolution().aspect_ratio())
    }

    /// Moves the eye back to the scene's own camera, or a second eye to its place beside the first.
    pub(super) fn reset_eye(&mut self) {
        // At the scene's own camera, the second camera would be where the first one is, and would not see it.
        if let OutsideView::MovesSecond { first } = self.outside_view {
            let moved = self.beside(first);
            self.eye.change(self.now, |_, _| moved);
        } else {
            self.eye.reset(self.now);
        }
    }

    /// Opens the explanation of the pixel in the middle of the left picture, whose ray is drawn.
    fn explain_middle_pixel(&mut self) {
        if self.screen.get::<ExplainPanel>().is_none() {
            self.screen.toggle_explaining();
        }
        let resolution = self.shown_resolution();
        // A quarter of the whole width is the middle of the left picture.
        let middle = [resolution.width() / 4, resolution.height() / 2];
        self.screen.explain(|panel, frame| panel.move_to(frame, middle));
    }

    /// Ends the view from outside or with vanishing points. Returns whether there was one.
    ///
    /// The eye is then at the first camera.
    pub(super) fn end_outside_view(&mut self) -> bool {
        if let OutsideView::MovesSecond { first } = self.outside_view {
            self.eye.change(self.now, |_, _| first);
        }
        let was_on = self.outside_view != OutsideView::Off;
        if was_on {
            self.screen.close::<TracerMarks>();
            self.screen.close::<ExplainPanel>();
            self.screen.close::<VanishingPoints>();
        }
        self.set_outside_view(OutsideView::Off);
        was_on
    }

    /// Returns the first camera: that of the left picture if a second one is shown beside it.
    pub(super) fn first_camera(&self) -> Option<Camera> {
        match self.outside_view {
            OutsideView::MovesSecond { first } => Some(first),
            _ => self.eye.camera(),
        }
    }

    /// Replaces the first camera, whichever camera the keys move.
    pub(super) fn change_first_camera(&mut self, camera: Camera) {
        if let OutsideView::MovesSecond { first } = &mut self.outside_view {
            *first = camera;
        } else {
            self.eye.change(self.now, |_, _| camera);
        }
    }

    /// Returns the second camera, which shows the first one from outside, if there is one.
    pub(super) fn second_camera(&self) -> Option<Camera> {
        match self.outside_view {
            OutsideView::MovesSecond { .. } => self.eye.camera(),
            OutsideView::MovesFirst { second } => Some(second),
            OutsideView::Off | OutsideView::Vanishing => None,
        }
    }

    /// Returns the layout: the map twice for two cameras or for image order beside object order.
    pub(super) fn shown_layout(&self) -> ViewLayout {
        if self.screen.get::<RenderOrdersPanel>().is_some() {
            let (_, pixels) = self.display.capabilities().cell_mode.pixels_per_cell();
            return self.layout.twice(pixels * u32::from(panel_rows(theme::area(self.picture_size()))));
        }
        if self.second_camera().is_some() { self.layout.twice(0) } else { self.layout }
    }
}

/// Returns a camera that sees another one, its view rectangle and its target from the side.
///
/// If a surface is in the way, the camera is in front of it, and may then not see everything.
fn camera_beside(scene: &Scene, camera: &Camera, aspect_ratio: f32) -> Camera {
    let (Pose { eye, target, up }, Basis { u, v, w }) = (camera.pose(), camera.basis());
    let distance = camera.target_distance();
    // The end of the axis w, a little beyond its drawn length of 0.16: no other drawn point is farther from the target.
    let end_of_w = eye + 0.2 * distance * w;
    let around = [u, v, w].map(|axis| 0.3 * distance * axis).map(|aside| [target - aside, target + aside]);
    let shown = [[eye, end_of_w], around[0], around[1], around[2]];
    let bounds = Bounds::of(shown.into_iter().flatten());
    let middle = 0.5 * (bounds.min + bounds.max);
    let from = middle + distance * (0.9 * u + 0.5 * v + 0.8 * w);
    let seen = Camera::look_at(from, middle).and_then(|seen| seen.with_up(up));
    let Ok(seen) = seen.map(|seen| seen.framing(&bounds, aspect_ratio)) else { return *camera };
    // A wall between the two eyes would hide the first eye, so the second one is moved to the first one's side of it.
    let way = seen.pose().eye - eye;
    let t = closest_hit(scene, &Ray { origin: eye, direction: way }).map_or(1.0, |hit| (0.9 * hit.t).min(1.0));
    let seen = seen.with_pose(Pose { eye: eye + t * way, ..seen.pose() }).unwrap_or(seen);
    // The bounding box of an oblique line is much larger than the line: without the zoom, half of the picture would
    // contain none of the points `shown`.
    let places = shown.into_iter().flatten().filter_map(|point| seen.project(point, aspect_ratio));
    let reach = places.map(|place| (2.0 * place - 1.0).abs().max_element()).fold(0.0, f32::max);
    if reach > 0.0 { seen.zoomed((reach / 0.95).min(1.0)) } else { seen }
}

#[cfg(all(test, unit_tests))]
mod tests;
