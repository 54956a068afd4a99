//! A notice that nothing of the scene is visible, with the keys that lead back.

use super::layers::{Canvas, Layer, LayerLevel};
use super::legend;
use crate::camera::{Camera, Pose};
use crate::describe::short_name;
use crate::hit::closest_hit;
use crate::scene::Scene;
use crate::shape::{Side, Surface};
use ratatui_core::layout::Rect;
use unicode_width::UnicodeWidthStr;

/// Columns and rows of the grid of rays by which [`Hiding::find`] searches for something visible.
// At 80x24 cells this is one ray for every second pixel in either direction. The first ray that hits the front of a
// surface ends the search, so that it takes time only if nothing is visible.
const RAYS: [u32; 2] = [40, 24];

/// The notice that nothing of the scene is visible, in several versions, longest first.
///
/// The first version that fits into the row is shown.
#[derive(PartialEq)]
pub(super) struct LostNotice(Vec<String>);

impl LostNotice {
    /// Returns the notice for the reason `hiding`, followed by `keys`, the keys that lead back.
    pub(super) fn new(hiding: &Hiding, keys: &str) -> Self {
        let of_object = |is: &str, Hidden { number, name }: &Hidden| {
            vec![format!("{is} object {number} ({name})"), format!("{is} object {number}")]
        };
        let said = match hiding {
            Hiding::Inside(hidden) => of_object("inside", hidden),
            Hiding::Behind(hidden) => of_object("behind", hidden),
            Hiding::Nothing => vec!["nothing in view".to_owned()],
        };
        let said = said.into_iter().chain(["lost".to_owned()]);
        Self(said.map(|said| if keys.is_empty() { said } else { format!("{said}: {keys}") }).collect())
    }
}

impl Layer for LostNotice {
    fn level(&self) -> LayerLevel {
        LayerLevel::Legend
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let row = canvas.row_from_bottom(canvas.status_rows);
        let width = |text: &str| text.width() as u16 + 2;
        if let Some(text) = self.0.iter().find(|text| width(text) <= row.width) {
            let area = Rect { width: width(text), ..row };
            canvas.lay(area, |theme, area, buffer| legend::draw(text, theme, area, buffer));
        }
    }
}

/// The reason why nothing of a scene is visible.
#[derive(Debug, PartialEq)]
pub(super) enum Hiding {
    /// The eye is inside this object.
    Inside(Hidden),
    /// The eye is on the back of this plane.
    Behind(Hidden),
    /// No object is in the picture.
    Nothing,
}

/// An object of which only the back is visible.
#[derive(Debug, PartialEq)]
pub(super) struct Hidden {
    /// Number of the object in the scene file, from 1.
    number: u32,
    /// Colour and kind of the object, such as `red sphere`.
    name: String,
}

impl Hiding {
    /// Returns the reason why nothing is visible: all rays that hit anything see the back of one
    /// object.
    ///
    /// `None` if something is visible, and for a scene without objects.
    pub(super) fn find(scene: &Scene, camera: &Camera, aspect_ratio: f32) -> Option<Self> {
        let rays = camera.eye_rays(aspect_ratio);
        let share = |at: u32, of: u32| (at as f32 + 0.5) / of as f32;
        let mut seen = None;
        for at in 0..RAYS[0] * RAYS[1] {
            let ray = rays.through(share(at % RAYS[0], RAYS[0]), share(at / RAYS[0], RAYS[1]));
            let Some(hit) = closest_hit(scene, &ray) else { continue };
            let is_front = hit.surface(scene).at_crossing(&ray, hit.t).side == Side::Front;
            if is_front || seen.is_some_and(|seen| seen != hit.object) {
                return None;
            }
            seen = Some(hit.object);
        }
        match seen {
            None => (!scene.objects().is_empty()).then_some(Self::Nothing),
            Some(object) => Self::from_visible_back(scene, camera.pose(), object),
        }
    }

    /// Returns the reason if only the back of `object` is visible.
    ///
    /// `None` if the eye is outside the object's bounding box. The object then counts as visible: it is a mesh whose
    /// triangles have the opposite winding order.
    fn from_visible_back(scene: &Scene, Pose { eye, .. }: Pose, object: u32) -> Option<Self> {
        let of = &scene.objects()[object as usize];
        let hidden = Hidden { number: object + 1, name: short_name(of) };
        match of.shape.bounds() {
            // A plane has no inside.
            None => Some(Self::Behind(hidden)),
            Some(bounds) if bounds.min.cmple(eye).all() && eye.cmple(bounds.max).all() => Some(Self::Inside(hidden)),
            Some(_) => None,
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
