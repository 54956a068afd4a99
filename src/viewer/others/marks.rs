//! Marks at the cameras of the other viewers, and the number of viewers in the upper right corner.

use super::OtherViewers;
use crate::camera::Camera;
use crate::capabilities::Colors;
use crate::hit::any_hit;
use crate::ray::Ray;
use crate::viewer::layers::{Canvas, Layer, LayerLevel};
use crate::viewer::legend;
use crate::viewer::light_marker::{PictureOnScreen, centred_area};
use crate::viewer::lines::{HIDING_INTERVAL, Plot};
use glam::Vec3;
use ratatui_core::layout::Rect;

/// The most marks on a screen.
// More of them would hide the picture.
const MAX_MARKS: usize = 50;

/// The most cameras for which a ray tests whether a surface hides them.
// Hidden cameras have no mark, but take a ray, too.
const MAX_TESTED: usize = 200;

/// The length of the line in the direction of a camera, as a share of the distance to its target.
const LINE_LENGTH: f32 = 0.15;

/// The colour of that line: light yellow of the first 16 colours, as the marks.
const LINE_COLOR: u8 = 11;

/// The layer of marks.
pub(super) struct OtherEyes {
    viewers: OtherViewers,
}

impl OtherEyes {
    /// Returns the marks of these viewers.
    pub(super) fn new(viewers: OtherViewers) -> Self {
        Self { viewers }
    }

    /// Replaces the viewers.
    pub(super) fn set_viewers(&mut self, viewers: OtherViewers) {
        self.viewers = viewers;
    }

    /// Draws a mark at each camera that is in the picture and that no surface hides.
    fn draw_marks(&self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame else { return };
        let (screen, camera) = (canvas.screen(), *frame.camera());
        let picture = PictureOnScreen::of(frame, screen);
        let (part, _) = frame.part_at([0, 0]);
        let eye = camera.pose().eye;
        let mut marks = Vec::new();
        let mut tested = 0;
        let mut lines = Plot::new(canvas, camera, part, 0).hidden_by(&frame.scene);
        for other in &self.viewers.others {
            let Some(theirs) = other.camera else { continue };
            let place = theirs.pose().eye;
            let Some(cell) = picture.cell_of(&camera, place).filter(|&cell| picture.contains(cell)) else { continue };
            if tested == MAX_TESTED {
                break;
            }
            tested += 1;
            if any_hit(&frame.scene, &Ray { origin: eye, direction: place - eye }, HIDING_INTERVAL) {
                continue;
            }
            if canvas.cell_mode.colors != Colors::None {
                lines.line([place, tip(&theirs)], LINE_COLOR);
            }
            let name = other.name.as_ref().map(|name| format!(" {name}")).unwrap_or_default();
            marks.push((format!("({}{name})", other.number), cell));
            if marks.len() == MAX_MARKS {
                break;
            }
        }
        lines.draw(canvas);
        for (text, cell) in marks {
            // Names and numbers are ASCII.
            let area = centred_area(screen, cell, text.len() as u16);
            canvas.lay(area, |theme, area, buffer| {
                buffer.set_stringn(area.x, area.y, text, area.width.into(), theme.mark());
            });
        }
    }
}

/// Returns the end of the line in the direction of a camera.
fn tip(camera: &Camera) -> Vec3 {
    let pose = camera.pose();
    pose.eye.lerp(pose.target, LINE_LENGTH)
}

impl Layer for OtherEyes {
    fn level(&self) -> LayerLevel {
        LayerLevel::Mark
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        self.draw_marks(canvas);
        let (screen, text) = (canvas.screen(), self.viewers.count_line());
        let width = (text.len() as u16 + 2).min(screen.width);
        let corner = Rect { x: screen.right() - width, width, height: screen.height.min(1), ..screen };
        canvas.lay(corner, |theme, area, buffer| legend::draw(&text, theme, area, buffer));
    }
}
