//! The cameras and lights of a mesh file in the scene around it.

#[cfg(feature = "ron")]
use super::written_camera::{number_text as number, vector_text as vector};
use crate::camera::{Camera, Pose, ViewRectangle};
use crate::color::LinearRgb;
use crate::light::{Falloff, Light, LightSource, PointLight, SpotLight, Sun};
use crate::mesh_file::{FileCamera, FileLight, FileLightKind, FilePlace};
use glam::Vec3;

/// The distance, as a multiple of the mesh's radius, from which on the light of a point source is
/// parallel.
// The rays to a mesh that is so far away differ in direction by at most 0.06 degrees, and in brightness by 0.2 %.
const DISTANT: f64 = 1e3;

/// Returns the lights of a file, all times one factor.
///
/// Candela and lux are absolute, and a sun has 100,000 lux where a lamp has 500. One factor multiplies all lights, in
/// place of an exposure: a white surface in the middle of the mesh that faced all of them, without shadows and inside
/// all cones, would have luminance 1. A light nearer than the mesh's radius counts as if it were that far away.
///
/// A [distant](DISTANT) light is a sun. Each light is within the range of lights in a scene.
pub(super) fn lights(lights: &[FileLight], (middle, radius): (Vec3, f32)) -> Vec<Light> {
    let radius = f64::from(radius);
    let distance = |light: &FileLight| (light.place.position - middle).as_dvec3().length();
    let squared = |light: &FileLight| {
        let distance = distance(light).max(radius);
        if light.kind == FileLightKind::Directional { 1.0 } else { distance * distance }
    };
    let total: f64 = lights.iter().map(|light| f64::from(light.intensity.luminance()) / squared(light)).sum();
    let factor = if total > 0.0 { 1.0 / total } else { 1.0 };
    let made = |light: &FileLight| -> Option<Light> {
        let FilePlace { position, forward, .. } = light.place;
        let LinearRgb { r, g, b } = light.intensity;
        let times = |factor: f64| {
            let [r, g, b] = [r, g, b].map(|channel| (f64::from(channel) * factor) as f32);
            LinearRgb::new(r, g, b)
        };
        // At the origin the target has all digits of the direction.
        let spot = |[degrees, softness]: [f32; 2], intensity| {
            SpotLight::new(Vec3::ZERO, forward, intensity)?.with_cone(degrees, softness)
        };
        let (intensity, in_the_middle) = (times(factor), times(factor / squared(light)));
        match light.kind {
            FileLightKind::Directional => Sun::new(-forward, intensity).ok().map(Light::from),
            kind if distance(light) > DISTANT * radius => {
                let towards = (position - middle).normalize();
                let share = match kind {
                    FileLightKind::Spot { angles } => spot(cone(angles), LinearRgb::BLACK).ok()?.cone_share(towards)?,
                    _ => 1.0,
                };
                Sun::new(towards, in_the_middle * share).ok().map(Light::from)
            }
            // From about 1e6 away, a light with falloff would exceed the range of intensities.
            FileLightKind::Point => {
                let light = PointLight::new(position, intensity);
                let even = |_| PointLight::new(position, in_the_middle).map(|light| light.with_falloff(Falloff::None));
                light.or_else(even).ok().map(Light::from)
            }
            FileLightKind::Spot { angles } => {
                let even = |_| spot(cone(angles), in_the_middle).map(|light| light.with_falloff(Falloff::None));
                let light = spot(cone(angles), intensity).or_else(even).ok()?;
                Some(Light::from(light).moved_to(position))
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

/// Returns the views of a file's cameras, and their names, without the cameras that are out of the
/// range of those in a scene.
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

/// Returns a light around a mesh as text of a scene file.
#[cfg(feature = "ron")]
pub(super) fn light_to_ron(light: &Light) -> String {
    let color = light.color();
    let color = format!("color: {}, intensity: 1", vector(Vec3::new(color.r, color.g, color.b)));
    let position = light.position().unwrap_or_default();
    let at = format!("position: {}", vector(position));
    let is_even = matches!(light.as_in_lecture(), Light::Point(source) if source.falloff() == Falloff::None);
    let falloff = if is_even { ", falloff: None" } else { "" };
    match light {
        Light::Sun(sun) => format!("Sun(direction: {}, {color})", vector(sun.direction())),
        Light::Spot(spot) => {
            let target = position - spot.axis() * (1e-3 * position.abs().max_element()).max(1.0);
            let [angle, softness] = spot.cone().map(number);
            format!("Spot({at}, target: {}, angle: {angle}, softness: {softness}, {color}{falloff})", vector(target))
        }
        _ => format!("Point({at}, {color}{falloff})"),
    }
}
