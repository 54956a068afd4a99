//! Written -> checked, once: every change of unit and colour space is here, and every question about a value that is
//! not one of type.
//!
//! Nothing stops at a fault. What is missing has its fault already, and is left out.

mod camera;
pub(super) mod path;

pub(super) use camera::radians;

use super::{Background, Checked, Draft, Object, ToneCurve};
use crate::color::{LinearRgb, Srgb8};
use crate::light::{Falloff, PointLight};
use crate::material::Material;
use crate::progress::Watcher;
use crate::scene_file::{
    MaterialUse, SceneFile, WrittenBackground, WrittenFalloff, WrittenLight, WrittenMaterial, WrittenObject,
    WrittenToneCurve,
};
use crate::scene_text::{Faults, quoted};
use crate::shape::Meshes;
use crate::text::{closest, listed};
use crate::written::{Checker, Spanned, WrittenColor, WrittenNumber, color_named};
use std::collections::HashMap;

/// The scene, if nothing is wrong with it; else every fault has been added. Once the watcher has gone, objects are left
/// out.
pub(super) fn check(
    file: &SceneFile,
    meshes: &mut dyn Meshes,
    watcher: &Watcher<'_>,
    faults: &mut Faults,
) -> Option<Draft> {
    let mut checker = Checker { faults };
    let camera = file.camera.as_ref().and_then(|camera| checker.camera(camera));
    let views = file.views.iter().filter_map(|view| checker.view(view, camera.as_ref())).collect();
    let background = file.background.as_ref().and_then(|written| checker.background(written));
    let ambient = file.ambient.and_then(|color| checker.light_color(color));
    let lights = file.lights.iter().filter_map(|light| checker.light(light)).collect();
    let exposure = file.exposure.and_then(|exposure| checker.exposure(exposure));
    let objects = checker.objects(file, meshes, watcher);
    if !faults.is_empty() {
        return None;
    }
    let tone_curve = match file.tone_curve {
        None | Some(WrittenToneCurve::None) => ToneCurve::None,
        Some(WrittenToneCurve::Reinhard) => ToneCurve::Reinhard,
        Some(WrittenToneCurve::Filmic) => ToneCurve::Filmic,
    };
    Some(Draft::new(Checked {
        views,
        background: background.unwrap_or(Background::Color(LinearRgb::BLACK)),
        ambient: ambient.unwrap_or(LinearRgb::BLACK),
        lights,
        shadows: file.shadows.unwrap_or(true),
        exposure: exposure.unwrap_or(1.0),
        tone_curve,
        ..Checked::new(camera?, objects)
    }))
}

const LARGEST_EXPOSURE: f64 = 1e6;

impl Checker<'_> {
    fn exposure(&mut self, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value > 0.0 && value as f32 > 0.0 && value <= LARGEST_EXPOSURE {
            return Some(value as f32);
        }
        let wanted = if value <= 0.0 { "greater than 0" } else { "between 1e-45 and 1e6" };
        self.fault(span, || format!("the exposure must be {wanted}"))
    }

    fn background(&mut self, written: &WrittenBackground) -> Option<Background> {
        match *written {
            WrittenBackground::Color(color) => self.light_color(color).map(Background::Color),
            WrittenBackground::Gradient { bottom, top } => {
                let [bottom, top] = [bottom, top].map(|color| color.and_then(|color| self.light_color(color)));
                Some(Background::Gradient { bottom: bottom?, top: top? })
            }
        }
    }

    // Light ---------------------------------------------------------------------------------------------------------

    fn light(&mut self, written: &WrittenLight) -> Option<PointLight> {
        let position = written.position.and_then(|position| self.point(position));
        let color = match written.color {
            Some(color) => self.light_color(color),
            None => Some(LinearRgb::grey(1.0)),
        };
        let factor = match written.intensity {
            Some(intensity) => self.amount("the intensity", intensity),
            None => Some(1.0),
        };
        Some(PointLight {
            position: position?,
            intensity: color? * factor?,
            falloff: match written.falloff {
                None | Some(WrittenFalloff::InverseSquare) => Falloff::InverseSquare,
                Some(WrittenFalloff::None) => Falloff::None,
            },
        })
    }

    // Objects -------------------------------------------------------------------------------------------------------

    fn objects(&mut self, file: &SceneFile, meshes: &mut dyn Meshes, watcher: &Watcher<'_>) -> Vec<Object> {
        let materials: HashMap<&str, Named> = file
            .materials
            .iter()
            .map(|named| {
                let material = named.material.as_ref();
                let made = Named {
                    is_checker: matches!(material, Some(WrittenMaterial::Checker { .. })),
                    material: material.and_then(|material| self.material(material)),
                };
                (&*named.name, made)
            })
            .collect();
        let object = |written: &WrittenObject| {
            let (shape, material) = (written.shape.check(self, meshes), self.material_of(written, file, &materials));
            let (shape, material) = (shape?, material?);
            Some(Object { shape, material })
        };
        file.objects.iter().take_while(|_| !watcher.is_gone()).filter_map(object).collect()
    }

    fn material(&mut self, written: &WrittenMaterial) -> Option<Material> {
        match *written {
            WrittenMaterial::Diffuse(color) => self.reflectance(color?).map(Material::Diffuse),
            WrittenMaterial::Checker { a, b, size } => {
                let mut color_or = |color: Option<WrittenColor>, grey: u8| match color {
                    Some(color) => self.reflectance(color),
                    None => Some(LinearRgb::from_srgb8(Srgb8::new(grey, grey, grey))),
                };
                let (a, b) = (color_or(a, 0xdd), color_or(b, 0x33));
                let size = size.map_or(Some(1.0), |size| self.length("size of a square", size));
                let (a, b, size) = (a?, b?, size?);
                Some(Material::Checker { a, b, size })
            }
        }
    }

    fn material_of(
        &mut self,
        object: &WrittenObject,
        file: &SceneFile,
        materials: &HashMap<&str, Named>,
    ) -> Option<Material> {
        let Some(Spanned { value, span }) = &object.material else {
            return Some(if object.shape.brings_colors() { Material::Own } else { Material::DEFAULT });
        };
        let (is_checker, material) = match value {
            MaterialUse::Inline(written) => {
                (matches!(written, WrittenMaterial::Checker { .. }), self.material(written))
            }
            MaterialUse::Named(name) => match materials.get(&**name) {
                Some(named) => (named.is_checker, named.material),
                None if !file.materials_complete => return None,
                None => return self.fault(*span, || unknown_material(name, file)),
            },
        };
        if is_checker && !object.shape.has_coordinates() {
            return self.fault(*span, || {
                let shape = object.shape.owner();
                format!("a Checker needs a Plane, on which its squares are laid out; this is {shape}")
            });
        }
        material
    }
}

/// A named material after its check.
struct Named {
    is_checker: bool,
    material: Option<Material>,
}

fn unknown_material(name: &str, file: &SceneFile) -> String {
    let unknown = format!("unknown material {}", quoted(name));
    let names = || file.materials.iter().map(|named| &*named.name);
    let is_color = name.starts_with('#') || color_named(name).is_some();
    match (closest(name, names()), is_color) {
        (Some(meant), false) => return format!("{unknown}; did you mean {}?", quoted(meant)),
        (Some(meant), true) => {
            return format!("{unknown}; did you mean {} or the colour Diffuse({})?", quoted(meant), quoted(name));
        }
        (None, true) => return format!("{unknown}; a colour is written Diffuse({})", quoted(name)),
        (None, false) => {}
    }
    let shown: Vec<_> = names().take(8).map(quoted).collect();
    match file.materials.len() {
        0 => format!("{unknown}; the scene has no named materials"),
        1 => format!("{unknown}; there is only {}", listed(&shown)),
        all if all > shown.len() => format!("{unknown}; there are {} and more", shown.join(", ")),
        _ => format!("{unknown}; there are {}", listed(&shown)),
    }
}
