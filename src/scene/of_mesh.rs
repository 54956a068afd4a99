//! The default scene around a mesh file.

use super::{Background, Checked, Draft, Object, Scene};
use crate::bounds::Bounds;
use crate::camera::{Camera, FRAMED_SHARE, Pose, ViewRectangle, framing_distance};
use crate::color::{LinearRgb, Srgb8};
use crate::light::{Falloff, Light, PointLight};
use crate::material::Material;
use crate::mesh_file::MeshFile;
use crate::shape::{Mesh, Plane};
use glam::{Vec2, Vec3};

/// The direction from the middle of the mesh to the eye: slightly to the right, and above.
// Seen from straight ahead a symmetric mesh would look flat.
const TOWARDS_EYE: Vec3 = Vec3::new(0.45, 0.4, 1.0);

/// The vertical field of view in radians: 40 degrees.
const FIELD_OF_VIEW: f32 = 0.698_131_7;

/// Half the height that the mesh may fill, at distance 1 from the eye: the tangent of half the
/// field of view, reduced by a margin.
const WITHIN: f32 = FRAMED_SHARE * 0.363_970_23;

/// The least aspect ratio of a picture that shows the whole mesh. Most terminals are wider.
const ASPECT_RATIO: f32 = 4.0 / 3.0;

impl Scene {
    /// Returns a scene with the mesh on a floor, all of it visible from the front and above.
    ///
    /// A strong light comes from the left, a weak one from the right. Up is +y. Returns `None` if the mesh has no
    /// extent, is too small for its distance from the origin, or exceeds ±1e9. A scene file can move or scale such a
    /// mesh.
    #[doc(hidden)]
    pub fn of_mesh(mesh: MeshFile) -> Option<Self> {
        Draft::of_mesh(mesh).map(Draft::finish)
    }
}

impl Draft {
    /// Returns the draft of [`Scene::of_mesh`].
    pub fn of_mesh(mesh: MeshFile) -> Option<Self> {
        let bounds = Bounds::of(mesh.positions().iter().copied());
        let middle = bounds.min + 0.5 * bounds.extent();
        let radius = 0.5 * bounds.extent().length();
        let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
        // A mesh smaller than 1e-5 of its distance from the origin has too few of f32's 24 bits left for its shape. The
        // condition is negated, so that NaN and infinity return `None` as well.
        if !(radius > 1e-5 * farthest && radius > 1e-9 && farthest <= 1e9) {
            return None;
        }
        let floor = Plane::new(Vec3::new(middle.x, bounds.min.y, middle.z), Vec3::Y).ok()?;
        let concrete = Material::diffuse(grey(0xb0)).ok()?;
        // There is a floor because the shadows on it show the shape and the height of the mesh.
        let objects = vec![Object::new(Mesh::of_checked(mesh), Material::Own), Object::new(floor, concrete)];
        Some(Self::new(Checked {
            background: Background::Gradient {
                bottom: grey(0x90),
                top: LinearRgb::from_srgb8(Srgb8::new(0x87, 0xa6, 0xcc)),
            },
            ambient: LinearRgb::grey(0.12),
            // The lights are placed relative to the mesh's radius, so that all meshes are lit alike.
            lights: vec![
                light(middle + radius * Vec3::new(-2.5, 4.0, 3.0), 0.85)?,
                light(middle + radius * Vec3::new(4.0, 2.0, 2.0), 0.2)?,
            ],
            ..Checked::new(camera(&bounds, middle)?, objects)
        }))
    }
}

/// Returns the camera at the distance from which the corners of the box just fit into the picture.
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
fn light(position: Vec3, strength: f32) -> Option<Light> {
    let light = PointLight::new(position, LinearRgb::grey(strength)).ok()?;
    Some(light.with_falloff(Falloff::None).into())
}

fn grey(level: u8) -> LinearRgb {
    LinearRgb::from_srgb8(Srgb8::new(level, level, level))
}
