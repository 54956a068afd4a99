//! The tracer as geometry in its own scene: eye, basis, view rectangle, eye ray, shadow rays; and
//! the horizon and the vanishing points of a picture.

use super::frame::Frame;
use super::layers::{Canvas, Layer, LayerLevel};
use super::lines::Plot;
use crate::camera::{Basis, Camera};
use crate::explain::Explanation;
use crate::framebuffer::Resolution;
use crate::light::Light;
use glam::{Vec2, Vec3};

// Every terminal has these palette colours, in the user's own shades.
const RED: u8 = 9;
const GREEN: u8 = 10;
const YELLOW: u8 = 11;
const BLUE: u8 = 12;
const MAGENTA: u8 = 13;
const CYAN: u8 = 14;
const WHITE: u8 = 15;
const GREY: u8 = 8;
const DARK_CYAN: u8 = 6;

/// Distance from the eye at which the view rectangle is drawn, as a share of the target's distance.
///
/// The distance is free, because only the ratio of the rectangle's sides to its distance matters for the rays.
const RECTANGLE_DISTANCE: f32 = 0.45;

/// The length of drawn basis vectors and normals, as a share of the distance of the target.
const VECTOR_LENGTH: f32 = 0.16;

/// The least number of cells between two lines of the pixel grid.
const MIN_GRID_CELLS: f32 = 1.5;

/// The first camera, drawn into the second camera's picture of it: o, u v w, the view rectangle,
/// and the lights.
pub(super) struct TracerMarks;

impl Layer for TracerMarks {
    fn level(&self) -> LayerLevel {
        LayerLevel::Mark
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame.filter(|_| canvas.has_room()) else { return };
        let Some(mut plot) = Plot::from_outside(canvas, frame) else { return };
        let (camera, (part, _)) = (frame.camera(), frame.part_at([0, 0]));
        add_rectangle(&mut plot, camera, part);
        let (Basis { u, v, w }, eye) = (camera.basis(), camera.pose().eye);
        for (axis, name, color) in [(u, "u", RED), (v, "v", GREEN), (w, "w", BLUE)] {
            let end = eye + VECTOR_LENGTH * camera.target_distance() * axis;
            plot.line([eye, end], color);
            plot.letter(end, name, color);
        }
        add_eye_and_lights(&mut plot, frame);
        plot.draw(canvas);
    }
}

/// Adds the letters of the eye and the lights.
fn add_eye_and_lights(plot: &mut Plot<'_>, frame: &Frame) {
    plot.letter(frame.camera().pose().eye, "o", WHITE);
    for light in frame.scene.lights().iter().filter_map(Light::position) {
        plot.letter(light, "*", YELLOW);
    }
}

/// Returns the t of eye rays at which the view rectangle is drawn.
fn rectangle_t(camera: &Camera) -> f32 {
    RECTANGLE_DISTANCE * camera.target_distance() * camera.rectangle().plane_distance()
}

/// Adds the view rectangle with its pixel grid, and the edges of the pyramid from the eye to it.
fn add_rectangle(plot: &mut Plot<'_>, camera: &Camera, part: Resolution) {
    let (rays, t) = (camera.eye_rays(part.aspect_ratio()), rectangle_t(camera));
    let at = |qu: f32, qv: f32| rays.through(qu, qv).at(t);
    let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
    for corner in corners {
        plot.line([camera.pose().eye, corner], GREY);
    }
    let [columns, rows] = [part.width(), part.height()];
    // The grid is coarser than single pixels, whose lines would fill the rectangle unless the camera is close to it.
    let size = |a: Vec3, b: Vec3| plot.place(a).zip(plot.place(b)).map_or(0.0, |(a, b)| a.distance(b));
    let widths = [size(corners[0], corners[1]) / columns as f32, size(corners[0], corners[3]) / rows as f32];
    let step = widths.map(|width| (0..16).map(|k| 1 << k).find(|&step| step as f32 * width >= MIN_GRID_CELLS));
    if let [Some(across), Some(up)] = step {
        for column in (across..columns).step_by(across as usize) {
            let qu = column as f32 / columns as f32;
            plot.line([at(qu, 0.0), at(qu, 1.0)], DARK_CYAN);
        }
        for row in (up..rows).step_by(up as usize) {
            let qv = 1.0 - row as f32 / rows as f32;
            plot.line([at(0.0, qv), at(1.0, qv)], DARK_CYAN);
        }
    }
    for side in 0..4 {
        plot.line([corners[side], corners[(side + 1) % 4]], CYAN);
    }
}

/// Draws the eye ray of an explained pixel into the picture from outside: through its pixel at q to
/// its hit p, the normal n there, and the shadow rays.
///
/// Does nothing for a frame without a picture from outside.
pub(super) fn draw_eye_ray(canvas: &mut Canvas<'_>, frame: &Frame, explanation: &Explanation) {
    let Some(mut plot) = Plot::from_outside(canvas, frame) else { return };
    let (camera, ray) = (frame.camera(), explanation.ray);
    let (distance, near) = (camera.target_distance(), rectangle_t(camera));
    let hit = explanation.hit.as_ref();
    if let Some(hit) = hit {
        let p = hit.point.position;
        for lit in &hit.lights {
            let end = lit.light.position().unwrap_or(p + distance * lit.incidence.l);
            plot.line([p, end], if lit.is_lit() { YELLOW } else { GREY });
        }
        let end = p + VECTOR_LENGTH * distance * hit.point.shading_normal;
        plot.line([p, end], MAGENTA);
        plot.letter(end, "n", MAGENTA);
    }
    // A ray without a hit is drawn to twice the target's distance, so that it visibly passes the scene.
    plot.line([ray.origin, ray.at(hit.map_or(2.0 * distance, |shaded| shaded.hit.t))], WHITE);
    plot.letter(ray.at(near), "q", CYAN);
    // Adds these letters again, because the rays end at them and would cover them.
    add_eye_and_lights(&mut plot, frame);
    if let Some(hit) = hit {
        plot.letter(hit.point.position, "p", WHITE);
    }
    plot.draw(canvas);
}

/// The horizon, and the vanishing points of lines along x, y and z, over the ordinary picture.
pub(super) struct VanishingPoints;

/// The number of parts in which the horizon is drawn.
// All parts lie in the level plane through the eye, so the line is exactly straight with any number of them.
const HORIZON_PARTS: u32 = 64;

impl Layer for VanishingPoints {
    fn level(&self) -> LayerLevel {
        LayerLevel::Mark
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let Some(frame) = canvas.frame.filter(|_| canvas.has_room()) else { return };
        let (camera, (part, _)) = (*frame.camera(), frame.part_at([0, 0]));
        let mut plot = Plot::new(canvas, camera, part, 0);
        for [from, to] in horizon(&camera) {
            plot.line([from, to], WHITE);
        }
        for (direction, name, color) in vanishing_directions() {
            // The vanishing point of a direction is the image of any point on the eye ray along it.
            let point = camera.pose().eye + direction;
            let Some(place) = plot.place(point) else { continue };
            // Four columns are as long as two rows, because a cell is twice as high as wide.
            for arm in [Vec2::new(4.0, 0.0), Vec2::new(0.0, 2.0)] {
                plot.segment([place - arm, place + arm], color);
            }
            plot.letter(point, name, color);
        }
        plot.draw(canvas);
    }
}

/// Returns the directions of the axes, both ways, with their names and colours.
fn vanishing_directions() -> [(Vec3, &'static str, u8); 6] {
    [
        (Vec3::X, "+x", RED),
        (-Vec3::X, "-x", RED),
        (Vec3::Y, "+y", GREEN),
        (-Vec3::Y, "-y", GREEN),
        (Vec3::Z, "+z", CYAN),
        (-Vec3::Z, "-z", CYAN),
    ]
}

/// Returns a circle of short lines around the eye, at its height: their image is the horizon.
fn horizon(camera: &Camera) -> impl Iterator<Item = [Vec3; 2]> + use<> {
    let (eye, up) = (camera.pose().eye, camera.pose().up.normalize_or_zero());
    let ahead = camera.basis().u.cross(up);
    let (right, step) = (camera.basis().u, std::f32::consts::TAU / HORIZON_PARTS as f32);
    let point = move |part: u32| {
        let (sin, cos) = libm::sincosf(part as f32 * step);
        eye + right * cos + ahead * sin
    };
    (0..HORIZON_PARTS).map(move |part| [point(part), point(part + 1)])
}

#[cfg(all(test, unit_tests))]
mod tests;
