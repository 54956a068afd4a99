//! The cameras and lights of a glTF file, placed by its nodes.

use super::json::Json;
use crate::checks;
use crate::color::LinearRgb;
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::staging::{FileCamera, FileLight, FileLightKind, FilePlace, Staging};
use glam::{DMat4, DVec3, Vec3};
use std::collections::HashSet;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// The extension that adds lights.
const LIGHTS: &str = "KHR_lights_punctual";

/// The largest numbers of cameras and of lights.
// There are nine keys for views, and each pixel takes time for every light.
const MAX_CAMERAS: usize = 9;
const MAX_LIGHTS: usize = 64;

/// A reader of the cameras and lights at the nodes of the default scene.
#[derive(Default)]
pub(super) struct StagingReader {
    staging: Staging,
    /// The indices of the cameras and of the lights that nodes place.
    cameras: HashSet<usize>,
    lights: HashSet<usize>,
}

impl StagingReader {
    /// Adds the camera and the light of a node. `transform` maps the node's coordinates to those of
    /// the scene.
    pub(super) fn add<'a>(
        &mut self,
        node: Json<'a>,
        root: Json<'a>,
        transform: &DMat4,
        left_out: &mut LeftOut<'_>,
    ) -> Result<(), MeshFault> {
        // A fault of a camera or light is no reason to refuse the shape.
        if let Some(index) = node.field("camera")? {
            let camera = index.item_of(root, "cameras").and_then(|(index, camera)| {
                self.cameras.insert(index);
                camera_at(camera, node, transform)
            });
            match camera.unwrap_or(Err("faulty camera")) {
                Ok(_) if self.staging.cameras.len() == MAX_CAMERAS => left_out.not_shown("camera (more than 9)", 1),
                Ok(camera) => self.staging.cameras.push(camera),
                Err(what) => left_out.not_shown(what, 1),
            }
        }
        if let Some(light) = node.extension(LIGHTS)? {
            let lights = root.required("extensions").and_then(|extensions| extensions.required(LIGHTS));
            let index = lights.and_then(|lights| light.required("light")?.item_of(lights, "lights"));
            let light = index.and_then(|(index, light)| {
                self.lights.insert(index);
                light_at(light, transform)
            });
            match light.unwrap_or(Err("faulty light")) {
                Ok(_) if self.staging.lights.len() == MAX_LIGHTS => left_out.not_shown("light (more than 64)", 1),
                Ok(light) => self.staging.lights.push(light),
                Err(what) => left_out.not_shown(what, 1),
            }
        }
        Ok(())
    }

    /// Returns the cameras and lights, and counts those that no node of the scene places.
    pub(super) fn finish(self, root: Json<'_>, left_out: &mut LeftOut<'_>) -> Staging {
        // A faulty list has no cameras or lights. Its fault was counted at each node that names one of them.
        let cameras = root.list_len("cameras").unwrap_or(0);
        let lights = root.extension(LIGHTS).and_then(|lights| lights.map_or(Ok(0), |lights| lights.list_len("lights")));
        left_out.not_shown("camera (not in the scene)", cameras.saturating_sub(self.cameras.len()));
        left_out.not_shown("light (not in the scene)", lights.unwrap_or(0).saturating_sub(self.lights.len()));
        self.staging
    }
}

/// Counts the motion of the camera and the light of a moving node, which stay where they are at
/// time 0.
pub(super) fn count_motion(node: Json<'_>, left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
    left_out.not_shown("animation (of a camera)", usize::from(node.field("camera")?.is_some()));
    left_out.not_shown("animation (of a light)", usize::from(node.extension(LIGHTS)?.is_some()));
    Ok(())
}

/// Returns the camera at a node, or what it is if it is not shown.
fn camera_at(
    camera: Json<'_>,
    node: Json<'_>,
    transform: &DMat4,
) -> Result<Result<FileCamera, &'static str>, MeshFault> {
    if camera.required("type")?.string()? == "orthographic" {
        return Ok(Err("orthographic camera"));
    }
    let perspective = camera.required("perspective")?;
    let fov = perspective.required("yfov")?;
    let vertical_fov = fov.number()? as f32;
    if !(vertical_fov > 1e-6 && f64::from(vertical_fov) < PI) {
        return Err(fov.fault("a field of view is between 0 and pi, both excluded"));
    }
    let aspect_ratio = perspective.field("aspectRatio")?.map(Json::number).transpose()?;
    // Some programs write 0 for "that of the window".
    let aspect_ratio = aspect_ratio.filter(|&ratio| ratio != 0.0);
    if aspect_ratio.is_some_and(|ratio| !checks::is_ratio_within_range(ratio)) {
        return Err(perspective.fault("the aspectRatio is not within 1e-6 and 1e6"));
    }
    let names = [camera.field("name")?, node.field("name")?].into_iter().flatten();
    let name = names.filter_map(|name| name.string().ok()).find(|name| !name.is_empty());
    let Some(place) = place_of_camera(transform) else {
        return Ok(Err("camera (too far away, or without a direction)"));
    };
    let name = name.unwrap_or_default().to_owned();
    Ok(Ok(FileCamera { name, place, vertical_fov, aspect_ratio: aspect_ratio.map(|ratio| ratio as f32) }))
}

/// Returns the light at a node, or what it is if it is not shown.
fn light_at(light: Json<'_>, transform: &DMat4) -> Result<Result<FileLight, &'static str>, MeshFault> {
    let kind = light.required("type")?;
    let kind = match kind.string()? {
        "directional" => FileLightKind::Directional,
        "point" => FileLightKind::Point,
        "spot" => FileLightKind::Spot { angles: cone_of(light)? },
        _ => return Err(kind.fault("expected directional, point or spot")),
    };
    let [r, g, b] = light.numbers::<3>("color")?.unwrap_or([1.0; 3]).map(|channel| channel.clamp(0.0, 1.0));
    let intensity = light.field("intensity")?.map_or(Ok(1.0), Json::number)?;
    if !(0.0..=1e30).contains(&intensity) {
        return Err(light.fault("the intensity is not within 0 and 1e30"));
    }
    let Some(place) = place_of_light(kind, transform) else {
        return Ok(Err("light (too far away, or without a direction)"));
    };
    let [r, g, b] = [r, g, b].map(|channel| (channel * intensity) as f32);
    Ok(Ok(FileLight { place, intensity: LinearRgb::new(r, g, b), kind }))
}

/// Returns the angles of a spot's cone from its axis.
fn cone_of(light: Json<'_>) -> Result<[f64; 2], MeshFault> {
    let Some(spot) = light.field("spot")? else { return Ok([0.0, FRAC_PI_4]) };
    let angle = |name, default| spot.field(name)?.map_or(Ok(default), Json::number);
    let angles = [angle("innerConeAngle", 0.0)?, angle("outerConeAngle", FRAC_PI_4)?];
    let [inner, outer] = angles;
    // Single precision of pi / 2 is a little more than pi / 2.
    if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= FRAC_PI_2 + 1e-6) {
        return Err(spot.fault("the cone angles are not 0 <= inner <= outer <= pi / 2"));
    }
    Ok(angles)
}

/// Returns the place of a camera at a node, which looks along the node's -z axis, with +y up.
///
/// `None` if its axes have no directions, or the position is not within ±1e9.
fn place_of_camera(transform: &DMat4) -> Option<FilePlace> {
    let forward = direction_of(transform, DVec3::NEG_Z)?;
    let up = up_of(transform, forward)?;
    Some(FilePlace { position: position_of(transform)?, forward: forward.as_vec3(), up: up.as_vec3() })
}

/// Returns the place of a light at a node, which shines along the node's -z axis.
///
/// `None` if the axis has no direction, or the position is not within ±1e9. A point source needs no direction, and a
/// directional light no position; for these any will do.
fn place_of_light(kind: FileLightKind, transform: &DMat4) -> Option<FilePlace> {
    let (position, forward) = (position_of(transform), direction_of(transform, DVec3::NEG_Z));
    let (position, forward) = match kind {
        FileLightKind::Directional => (position.unwrap_or_default(), forward?),
        FileLightKind::Point => (position?, forward.unwrap_or(DVec3::NEG_Z)),
        FileLightKind::Spot { .. } => (position?, forward?),
    };
    let up = up_of(transform, forward).unwrap_or_else(|| forward.any_orthonormal_vector());
    Some(FilePlace { position, forward: forward.as_vec3(), up: up.as_vec3() })
}

/// Returns the position of a node; `None` if it is not within ±1e9.
fn position_of(transform: &DMat4) -> Option<Vec3> {
    let position = transform.transform_point3(DVec3::ZERO);
    (position.is_finite() && checks::is_within_range(position)).then(|| position.as_vec3())
}

/// Returns the unit vector along an axis of a node; `None` if the axis has no direction.
fn direction_of(transform: &DMat4, axis: DVec3) -> Option<DVec3> {
    let direction = transform.transform_vector3(axis);
    (direction / direction.abs().max_element()).try_normalize()
}

/// Returns the unit vector perpendicular to `forward` that is nearest to the +y axis of a node.
fn up_of(transform: &DMat4, forward: DVec3) -> Option<DVec3> {
    let up = direction_of(transform, DVec3::Y)?;
    // Scaled parents of rotated nodes may have made the axes oblique.
    (up - forward * up.dot(forward)).try_normalize()
}
