//! The cameras and lights of a mesh file in the scene around it.

#[cfg(feature = "ron")]
use super::written_camera::{number_text as number, vector_text as vector};
use crate::camera::{Camera, Pose, ViewRectangle};
use crate::color::LinearRgb;
use crate::light::{Light, PointLight, SpotLight, Sun};
use crate::mesh_file::{FileCamera, FileLight, FileLightKind, FilePlace};
use glam::Vec3;

/// Returns the lights of a file, dimmed or brightened together.
///
/// Candela and lux are absolute, and a sun has 100,000 lux where a lamp has 500. As a photographer sets the exposure
/// for the light that there is, the factor of all lights makes the light that arrives in the middle of the mesh from
/// all of them, without shadows and cones, that of a white surface in the picture. A light nearer than the mesh's
/// radius counts as if it were that far away.
pub(super) fn lights(lights: &[FileLight], (middle, radius): (Vec3, f32)) -> Vec<Light> {
    let arriving = |light: &FileLight| {
        let distance = (light.place.position - middle).as_dvec3().length().max(radius.into());
        let squared = if light.kind == FileLightKind::Directional { 1.0 } else { distance * distance };
        f64::from(light.intensity.luminance()) / squared
    };
    let total: f64 = lights.iter().map(arriving).sum();
    let factor = if total > 0.0 { 1.0 / total } else { 1.0 };
    let made = |light: &FileLight| {
        let FilePlace { position, forward, .. } = light.place;
        let LinearRgb { r, g, b } = light.intensity;
        let [r, g, b] = [r, g, b].map(|channel| (f64::from(channel) * factor) as f32);
        let intensity = LinearRgb::new(r, g, b);
        match light.kind {
            FileLightKind::Directional => Sun::new(-forward, intensity).ok().map(Light::from),
            FileLightKind::Point => PointLight::new(position, intensity).ok().map(Light::from),
            FileLightKind::Spot { angles } => {
                let [degrees, softness] = cone(angles);
                // At the origin the target has all digits of the direction.
                let spot = SpotLight::new(Vec3::ZERO, forward, intensity).ok()?.with_cone(degrees, softness).ok()?;
                Some(Light::from(spot).moved_to(position))
            }
        }
    };
    lights.iter().filter_map(made).collect()
}

/// Returns the angle in degrees and the softness of the cone that fades between two angles from its
/// axis, which are in radians.
fn cone([inner, outer]: [f64; 2]) -> [f32; 2] {
    [(2.0 * outer.to_degrees()).clamp(0.001, 180.0) as f32, (1.0 - inner / outer) as f32]
}

/// Returns the views of a file's cameras, and their names.
pub(super) fn views(cameras: &[FileCamera], (middle, radius): (Vec3, f32)) -> Vec<(Camera, String)> {
    let view = |camera: &FileCamera| {
        let FilePlace { position: eye, forward, up } = camera.place;
        // The target is the point to orbit, so it lies at the depth of the mesh, if that is in front of the camera.
        let depth = (middle - eye).dot(forward);
        let depth = if depth > 0.01 * radius { depth } else { radius };
        // At less than this distance from the origin, too few digits of the direction would be left.
        let depth = depth.max(1e-3 * eye.abs().max_element());
        let pose = Pose { eye, target: eye + forward * depth, up };
        let rectangle = ViewRectangle::from_vertical_fov(camera.vertical_fov).ok()?;
        let rectangle = camera.aspect_ratio.map_or(Ok(rectangle), |ratio| rectangle.with_aspect_ratio(ratio)).ok()?;
        Some((Camera::new(pose, rectangle).ok()?, camera.name.clone()))
    };
    cameras.iter().filter_map(view).collect()
}

/// Returns a light around a mesh as text of a scene file; `written` is the light of the mesh's file
/// that it was made from.
#[cfg(feature = "ron")]
pub(super) fn light_to_ron(light: &Light, written: Option<&FileLight>) -> String {
    let color = light.color();
    let color = format!("color: {}, intensity: 1", vector(Vec3::new(color.r, color.g, color.b)));
    let position = light.position().unwrap_or_default();
    let at = format!("position: {}", vector(position));
    match written.map(|written| (written.kind, written.place.forward)) {
        None => format!("Point({at}, {color}, falloff: None)"),
        Some((FileLightKind::Point, _)) => format!("Point({at}, {color})"),
        Some((FileLightKind::Directional, forward)) => format!("Sun(direction: {}, {color})", vector(-forward)),
        Some((FileLightKind::Spot { angles }, forward)) => {
            let [angle, softness] = cone(angles).map(number);
            let target = vector(position + forward * (1e-3 * position.abs().max_element()).max(1.0));
            format!("Spot({at}, target: {target}, angle: {angle}, softness: {softness}, {color})")
        }
    }
}
