//! The default scene around a mesh file.

#[cfg(feature = "ron")]
use super::written_camera::{number_text as number, vector_text as vector};
use super::{Background, Checked, Draft, Object, Scene, staging};
use crate::bounds::Bounds;
use crate::camera::{Camera, FRAMED_SHARE, Pose, ViewRectangle, framing_distance};
use crate::color::LinearRgb;
use crate::light::{Falloff, Light, PointLight};
use crate::material::Material;
use crate::mesh_file::{CLAY, MeshFile, UpAxis};
#[cfg(feature = "ron")]
use crate::shape::Shape;
use crate::shape::{Mesh, MovingParts, Placement, Plane, Poses};
#[cfg(feature = "ron")]
use crate::text::visible;
use crate::threads;
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// The direction from the middle of the mesh to the eye: slightly to the right, and above.
// Seen from straight ahead a symmetric mesh would look flat.
const TOWARDS_EYE: Vec3 = Vec3::new(0.45, 0.4, 1.0);

/// The vertical field of view in radians: 40 degrees.
const FIELD_OF_VIEW: f32 = 0.698_131_7;

/// Half the height that the mesh may fill at distance 1 from the eye: the share `FRAMED_SHARE` of
/// the tangent of half the field of view.
const WITHIN: f32 = FRAMED_SHARE * 0.363_970_23;

/// The aspect ratio for which the camera is placed. All wider pictures, as of most terminals, show
/// the whole mesh.
const ASPECT_RATIO: f32 = 4.0 / 3.0;

/// The lights: their directions from the middle of the mesh, in multiples of its radius, and their
/// colours with intensity.
// A warm key light, a weak blue light from the other side, and a rose one from behind, which sets the mesh off from the
// background: `#ffe6c8`, `#7fa4ff` and `#ffd0e0` times 0.8, 0.16 and 0.3.
const LIGHTS: [(Vec3, LinearRgb); 3] = [
    (Vec3::new(-2.6, 3.9, 3.6), LinearRgb::new(0.8, 0.634, 0.462)),
    (Vec3::new(4.2, 1.4, 2.2), LinearRgb::new(0.034, 0.059, 0.16)),
    (Vec3::new(1.8, 2.6, -4.0), LinearRgb::new(0.3, 0.189, 0.224)),
];

/// The colours of the floor's squares, `#6d737d` and `#5d636d`.
const FLOOR: [LinearRgb; 2] = [LinearRgb::new(0.153, 0.171, 0.205), LinearRgb::new(0.109, 0.125, 0.153)];

/// The gradient of the scene's background, `#2a2d34` straight down and `#0e1016` straight up.
const BACKGROUND: [LinearRgb; 2] = [LinearRgb::new(0.0232, 0.0262, 0.0343), LinearRgb::new(0.0044, 0.0052, 0.008)];

/// The side of a square of the floor, as a multiple of the mesh's radius.
const SQUARE: f32 = 0.2;

/// The distance from a mesh's own ground to the floor below it, as a multiple of the mesh's radius.
// Of two surfaces in one plane, rounding would decide for each pixel which one is seen.
const GROUND_GAP: f32 = 1e-3;

/// Returns the ambient light that makes an otherwise unlit floor as bright as the background at the
/// horizon.
// Far from the mesh the lights reach the floor at grazing angles, so that only ambient light remains there. With any
// other ambient light, the horizon would be a visible edge, mostly a black band.
fn ambient() -> LinearRgb {
    let channel = |of: fn(LinearRgb) -> f32| {
        let [horizon, floor] = [BACKGROUND, FLOOR].map(|[a, b]| of(a) + of(b));
        horizon / floor
    };
    LinearRgb::new(channel(|color| color.r), channel(|color| color.g), channel(|color| color.b))
}

/// The mesh file around which a scene was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshOrigin {
    /// The name of the format; empty if unknown.
    pub format: &'static str,
    /// The axis of the file that points up.
    pub up: UpAxis,
    /// Whether the axis is a guess.
    pub is_guess: bool,
    /// Whether the lights are those of the file.
    pub has_lights: bool,
}

impl Scene {
    /// Returns a scene with the mesh on a floor, all of it visible from the front and above.
    ///
    /// The lights are those of the file. If it has none, a warm light comes from the left, a weak blue one from the
    /// right, and one from behind. The cameras of the file are the views. A mesh without colours is drawn in the colour
    /// of clay. Up is +y. Returns `None` if the mesh has no extent, is too small for its distance from the origin, or
    /// exceeds ±1e9. A scene file can move or scale such a mesh.
    #[doc(hidden)]
    pub fn of_mesh(mesh: MeshFile) -> Option<Self> {
        Draft::of_mesh(mesh).map(Draft::finish)
    }

    /// Returns the text of a scene file with this scene's mesh, floor and lights, and `camera`.
    ///
    /// `name` is the name of the mesh file, in the same folder as the scene file. Returns `None` unless the scene was
    /// made around a mesh file.
    #[cfg(feature = "ron")]
    #[doc(hidden)]
    pub fn around_mesh_to_ron(&self, name: &str, camera: &Camera) -> Option<String> {
        let [meshes @ .., floor] = self.objects() else { return None };
        let (origin, first, Shape::Plane(plane)) = (self.mesh()?, meshes.first()?, &floor.shape) else { return None };
        let color = |color: LinearRgb| vector(Vec3::new(color.r, color.g, color.b));
        let lights = self.lights().iter().map(|light| format!("        {},\n", staging::light_to_ron(light)));
        let turn = match origin.up.degrees() {
            [0, 0, 0] => String::new(),
            [x, y, z] => format!(", rotate: ({x}, {y}, {z})"),
        };
        let clay = if first.material == Material::Own {
            String::new()
        } else {
            format!(", material: Diffuse({})", color(CLAY))
        };
        let [[bottom, top], [a, b]] = [BACKGROUND, FLOOR].map(|colors| colors.map(color));
        let Material::Checker(squares) = floor.material else { return None };
        let size = number(squares.size());
        let about_lights = if origin.has_lights {
            "    // The lights of the file, all times one factor.\n"
        } else {
            "    // A warm light, a blue one, and one from behind, each as bright everywhere.\n"
        };
        let views: Vec<_> = self.views().iter().map(|view| format!("        {},\n", view.value_to_ron())).collect();
        let views = if views.is_empty() { String::new() } else { format!("    views: [\n{}    ],\n", views.concat()) };
        let (camera, ambient, point) = (camera.to_ron(), color(self.ambient()), vector(plane.point()));
        Some(format!(
            "// {}, on a floor. Edit this file while termtrace shows it: each save is seen at once.
(
    {camera},
    background: Gradient(bottom: {bottom}, top: {top}),
    ambient: {ambient},
{views}{about_lights}    lights: [
{}    ],
    objects: [
        Mesh(path: {name:?}{turn}{clay}),
        Plane(point: {point}, normal: (0, 1, 0), material: Checker(a: {a}, b: {b}, size: {size})),
    ],
)
",
            visible(name),
            lights.collect::<String>()
        ))
    }
}

impl Draft {
    /// Returns the scene of [`Scene::of_mesh`] as a draft, without trees.
    pub fn of_mesh(mesh: MeshFile) -> Option<Self> {
        Self::around_mesh(mesh, MeshOrigin::default())
    }

    /// Returns the scene of [`Scene::of_mesh`] as a draft, with the mesh turned so that the axis
    /// `origin.up` points up.
    pub(super) fn around_mesh(mesh: MeshFile, origin: MeshOrigin) -> Option<Self> {
        let mesh = mesh.with_axis_up(origin.up)?;
        let bounds = framed(&mesh)?;
        let middle = bounds.min + 0.5 * bounds.extent();
        let radius = 0.5 * bounds.extent().length();
        let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
        // A mesh smaller than 1e-5 of its distance from the origin has too few of f32's 24 bits left for its shape. The
        // condition is negated, so that NaN and infinity return `None` as well.
        if !(radius > 1e-5 * farthest && radius > 1e-9 && farthest <= 1e9) {
            return None;
        }
        // The lowest place of a part that moves may be its ground.
        let has_ground = mesh.moves() || has_ground(&mesh, &bounds, radius);
        let gap = if has_ground { GROUND_GAP * radius + 4.0 * f32::EPSILON * farthest } else { 0.0 };
        let floor = Plane::new(Vec3::new(middle.x, bounds.min.y - gap, middle.z), Vec3::Y).ok()?;
        let squares = Material::checker(FLOOR[0], FLOOR[1], SQUARE * radius).ok()?;
        let material = if mesh.has_colors() { Material::Own } else { Material::diffuse(CLAY).ok()? };
        // The scene has a floor because the shadows on it show the shape and the height of the mesh.
        let staging = mesh.staging().clone();
        let mut objects: Vec<_> =
            meshes_of(mesh, bounds)?.into_iter().map(|mesh| Object::new(mesh, material)).collect();
        objects.push(Object::new(floor, squares));
        let [bottom, top] = BACKGROUND;
        let middle_and_radius = (middle, radius);
        let mut lights = staging::lights(&staging.lights, middle_and_radius);
        let has_lights = !lights.is_empty();
        if !has_lights {
            // The lights are placed relative to the mesh's radius, so that all meshes are lit alike.
            lights = LIGHTS
                .into_iter()
                .map(|(towards, color)| light(middle + radius * towards, color))
                .collect::<Option<_>>()?;
        }
        let (views, view_names) = staging::views(&staging.cameras, middle_and_radius).into_iter().unzip();
        Some(Self::new(Checked {
            mesh: Some(MeshOrigin { has_lights, ..origin }),
            views,
            view_names,
            background: Background::Gradient { bottom, top },
            ambient: ambient(),
            lights,
            ..Checked::new(camera(&bounds, middle)?, objects)
        }))
    }
}

/// Returns whether a triangle that is seen from above lies where the floor would be.
fn has_ground(mesh: &MeshFile, bounds: &Bounds, radius: f32) -> bool {
    let top = bounds.min.y + 0.1 * GROUND_GAP * radius;
    // A flat mesh is seen from above on either side.
    let is_flat = bounds.max.y <= top;
    let is_ground = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions()[corner as usize]);
        a.y.max(b.y).max(c.y) <= top && (is_flat || (b - a).cross(c - a).y > 0.0)
    };
    let chunks: Vec<_> = mesh.triangles().chunks(GROUND_CHUNK).collect();
    let has_ground = |chunk: usize| chunks[chunk].iter().any(is_ground);
    if chunks.len() == 1 { has_ground(0) } else { threads::map(chunks.len(), has_ground).contains(&true) }
}

/// The number of triangles that a thread searches for one on the ground.
// Fewer are searched in a millisecond, for which no threads need to be started.
const GROUND_CHUNK: usize = 1 << 17;

/// Returns the box that the first picture shows: that around all places of the mesh over time.
///
/// Of a mesh that moves far away, it is that of the mesh at time 0.
fn framed(mesh: &MeshFile) -> Option<Bounds> {
    /// The number of times at which the mesh is looked for.
    const TIMES: u32 = 16;
    /// Limit on the size of the box, as a multiple of that at time 0.
    // In a larger one the mesh would be hard to see.
    const MAX_GROWTH: f32 = 5.0;
    let bounds = Bounds::of(mesh.positions().iter().copied());
    let Some(motion) = mesh.motion() else { return Some(bounds) };
    let parts = MovingParts::of(motion).placed(&Placement::NONE)?;
    let at_time = |step: u32| {
        let mut poses = Poses::at(motion.length() * (f64::from(step) / f64::from(TIMES)));
        let parts = parts.iter().map(|part| part.at_time(&mut poses)).filter(|part| !part.is_nowhere());
        parts.map(|part| *part.bounds()).reduce(|a, b| a.union(&b))
    };
    let moving = (0..TIMES).filter_map(at_time).reduce(|a, b| a.union(&b));
    if bounds.extent() == Vec3::ZERO {
        // The mesh appears later.
        return moving;
    }
    let whole = moving.map_or(bounds, |moving| bounds.union(&moving));
    let is_near = whole.extent().length() <= MAX_GROWTH * bounds.extent().length();
    Some(if is_near { whole } else { bounds })
}

/// Returns the mesh, or the part of it that does not move and the parts that do.
///
/// `bounds` is the box around a mesh that does not move.
fn meshes_of(mesh: MeshFile, bounds: Bounds) -> Option<Vec<Mesh>> {
    let Some(motion) = mesh.motion() else { return Some(vec![Mesh::within(mesh, bounds)]) };
    let still = motion.still().map(|still| Mesh::of_checked(Arc::clone(still)));
    Some(still.into_iter().chain(MovingParts::of(motion).placed(&Placement::NONE)?).collect())
}

/// Returns the camera at the distance at which the mesh's box fills `FRAMED_SHARE` of the picture.
fn camera(bounds: &Bounds, middle: Vec3) -> Option<Camera> {
    let w = TOWARDS_EYE.normalize();
    let u = Vec3::Y.cross(w).normalize();
    let v = w.cross(u);
    let half = Vec2::new(WITHIN * ASPECT_RATIO, WITHIN);
    let eye = middle + w * framing_distance(bounds, [u, v, w], half, Vec2::ZERO);
    let pose = Pose { eye, target: middle, up: Vec3::Y };
    ViewRectangle::from_vertical_fov(FIELD_OF_VIEW).and_then(|rectangle| Camera::new(pose, rectangle)).ok()
}

/// Returns a light without falloff, whose effect does not depend on the mesh's size.
fn light(position: Vec3, color: LinearRgb) -> Option<Light> {
    let light = PointLight::new(position, color).ok()?;
    Some(light.with_falloff(Falloff::None).into())
}
