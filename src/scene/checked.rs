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
use crate::mesh_file::MeshFile;
use crate::progress::{Unfinished, Watcher};
use crate::scene_file::{
    MaterialUse, SceneFile, Spanned, WrittenBackground, WrittenColor, WrittenFalloff, WrittenLight, WrittenMaterial,
    WrittenNumber, WrittenObject, WrittenShape, WrittenToneCurve, WrittenVector, color_named,
};
use crate::scene_text::{Faults, Span, quoted};
use crate::shape::{Mesh, Plane, Shape, Sphere, Triangle};
use crate::text::{closest, listed};
use glam::{DMat3, DVec3, Mat3, Vec3};
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

/// Coordinates beyond this, squared twice on the light's way, would leave f32.
const FARTHEST: f64 = 1e9;
/// Lengths below this would vanish in f32 when squared twice.
const SHORTEST: f64 = 1e-9;
const BRIGHTEST: f64 = 1e12;
const LARGEST_EXPOSURE: f64 = 1e6;

/// Where meshes come from.
pub(super) trait Meshes {
    /// The mesh of that path, as the scene's file has it, or what is wrong with it.
    fn mesh(&mut self, path: &str) -> Result<MeshFile, Unfinished<String>>;
}

struct Checker<'f> {
    faults: &'f mut Faults,
}

impl Checker<'_> {
    fn fault<T>(&mut self, span: Span, message: impl FnOnce() -> String) -> Option<T> {
        self.faults.add(span, message);
        None
    }

    // Numbers -----------------------------------------------------------------------------------------------------

    /// All three coordinates within what f32 can carry through a picture.
    fn coordinates(&mut self, written: WrittenVector) -> Option<DVec3> {
        let mut fine = true;
        for component in written.components {
            if component.value.abs() > FARTHEST {
                fine = false;
                self.faults.add(component.span, || {
                    "coordinates must lie within ±1e9; light cannot be followed farther in single precision".to_owned()
                });
            }
        }
        fine.then(|| DVec3::from_array(written.components.map(|component| component.value)))
    }

    fn point(&mut self, written: WrittenVector) -> Option<Vec3> {
        Some(self.coordinates(written)?.as_vec3())
    }

    /// A length greater than 0 that f32 can square.
    fn length(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value <= 0.0 {
            return self.fault(span, || format!("the {what} must be greater than 0"));
        }
        if !(SHORTEST..=FARTHEST).contains(&value) {
            return self.fault(span, || format!("the {what} must lie between 1e-9 and 1e9"));
        }
        Some(value as f32)
    }

    /// An amount of light.
    fn amount(&mut self, what: &str, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value < 0.0 {
            return self.fault(span, || format!("{what} must not be negative"));
        }
        if value > BRIGHTEST {
            return self.fault(span, || format!("{what} must be at most 1e12"));
        }
        Some(value as f32)
    }

    fn exposure(&mut self, written: WrittenNumber) -> Option<f32> {
        let Spanned { value, span } = written;
        if value > 0.0 && value as f32 > 0.0 && value <= LARGEST_EXPOSURE {
            return Some(value as f32);
        }
        let wanted = if value <= 0.0 { "greater than 0" } else { "between 1e-45 and 1e6" };
        self.fault(span, || format!("the exposure must be {wanted}"))
    }

    // Colours -----------------------------------------------------------------------------------------------------

    /// A colour of light: any amount.
    fn light_color(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        if let Some(span) = written.first_band(|band| band < 0.0) {
            return self.fault(span, || "light must not be negative".to_owned());
        }
        if let Some(span) = written.first_band(|band| band > BRIGHTEST) {
            return self.fault(span, || "light must be at most 1e12".to_owned());
        }
        Some(linear(written))
    }

    /// A colour of a surface: a part of the light.
    fn reflectance(&mut self, written: WrittenColor) -> Option<LinearRgb> {
        match written.first_band(|band| !(0.0..=1.0).contains(&band)) {
            Some(span) => self.fault(span, || {
                "a reflectance must lie within 0 and 1; no surface reflects more light than it gets".to_owned()
            }),
            None => Some(linear(written)),
        }
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
        let object = |written| {
            let (shape, material) = (self.shape(written, meshes), self.material_of(written, file, &materials));
            let (shape, material) = (shape?, material?);
            Some(Object { shape, material })
        };
        file.objects.iter().take_while(|_| !watcher.is_gone()).filter_map(object).collect()
    }

    fn shape(&mut self, written: &WrittenObject, meshes: &mut dyn Meshes) -> Option<Shape> {
        match &written.shape {
            &WrittenShape::Sphere { center, radius } => {
                let center = center.and_then(|center| self.point(center));
                let radius = radius.and_then(|radius| self.length("radius", radius));
                Some(Sphere::new(center?, radius?).into())
            }
            WrittenShape::Triangle { corners } => {
                let [a, b, c] = (*corners)?.map(|corner| self.point(corner));
                Some(Triangle::new([a?, b?, c?]).into())
            }
            WrittenShape::Mesh { path, scale, rotate, translate } => {
                let placed = self.placement(*scale, *rotate, *translate);
                let path = path.as_ref()?;
                let mesh = match meshes.mesh(&path.value) {
                    Ok(mesh) => mesh,
                    Err(Unfinished::Cancelled) => return None,
                    Err(Unfinished::Failed(message)) => return self.fault(path.span, || message),
                };
                let (scale, turn, translation) = placed?;
                match mesh.transformed(scale, turn, translation) {
                    Some(mesh) if is_near(&mesh) => Some(Mesh::from(mesh).into()),
                    _ => self.fault(path.span, || {
                        "this mesh reaches beyond ±1e9; scale it down, or light cannot be followed".to_owned()
                    }),
                }
            }
            &WrittenShape::Plane { point, normal } => {
                let point = point.and_then(|point| self.point(point));
                let normal = normal.and_then(|normal| self.unit_vector("normal", normal));
                Some(Plane::new(point?, normal?.as_vec3()).into())
            }
        }
    }

    /// Scale, rotation and translation of a mesh.
    fn placement(
        &mut self,
        scale: Option<WrittenVector>,
        rotate: Option<WrittenVector>,
        translate: Option<WrittenVector>,
    ) -> Option<(Vec3, Mat3, Vec3)> {
        let scale = match scale {
            Some(scale) => self.factors(scale),
            None => Some(Vec3::ONE),
        };
        let turn = match rotate {
            Some(angles) => self.turn(angles),
            None => Some(Mat3::IDENTITY),
        };
        let translation = match translate {
            Some(translation) => self.point(translation),
            None => Some(Vec3::ZERO),
        };
        Some((scale?, turn?, translation?))
    }

    /// Along no axis nothing is left of a mesh; it may be mirrored.
    fn factors(&mut self, written: WrittenVector) -> Option<Vec3> {
        let factors = written.components.map(|factor| factor.value);
        match written.components.iter().find(|factor| !(SHORTEST..=FARTHEST).contains(&factor.value.abs())) {
            Some(factor) => {
                self.fault(factor.span, || "a factor must lie between 1e-9 and 1e9, or be as far below 0".to_owned())
            }
            None => Some(DVec3::from_array(factors).as_vec3()),
        }
    }

    /// About x first, then about y, then about z; counterclockwise for who looks against the axis.
    fn turn(&mut self, written: WrittenVector) -> Option<Mat3> {
        const MOST_TURNS: f64 = 36_000.0;
        if let Some(angle) = written.components.iter().find(|angle| angle.value.abs() > MOST_TURNS) {
            return self.fault(angle.span, || "an angle must lie within ±36000 degrees".to_owned());
        }
        let [x, y, z] = written.components.map(|angle| cosine_and_sine(angle.value));
        let about_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, x.0, x.1), DVec3::new(0.0, -x.1, x.0));
        let about_y = DMat3::from_cols(DVec3::new(y.0, 0.0, -y.1), DVec3::Y, DVec3::new(y.1, 0.0, y.0));
        let about_z = DMat3::from_cols(DVec3::new(z.0, z.1, 0.0), DVec3::new(-z.1, z.0, 0.0), DVec3::Z);
        Some((about_z * about_y * about_x).as_mat3())
    }

    /// The direction, of unit length: of f64's, so that nothing is lost before the one rounding.
    fn unit_vector(&mut self, what: &str, written: WrittenVector) -> Option<DVec3> {
        let vector = self.coordinates(written)?;
        let largest = vector.abs().max_element();
        if largest == 0.0 {
            return self.fault(written.span, || format!("the {what} must have a length; (0, 0, 0) points nowhere"));
        }
        let vector = vector / largest;
        Some(vector / vector.dot(vector).sqrt())
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
            return Some(if matches!(object.shape, WrittenShape::Mesh { .. }) {
                Material::Own
            } else {
                Material::DEFAULT
            });
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
        if is_checker && !matches!(object.shape, WrittenShape::Plane { .. }) {
            return self.fault(*span, || {
                let shape = match object.shape {
                    WrittenShape::Sphere { .. } => "a Sphere",
                    WrittenShape::Triangle { .. } => "a Triangle",
                    _ => "a Mesh",
                };
                format!("a Checker needs a Plane, on which its squares are laid out; this is {shape}")
            });
        }
        material
    }
}

/// Of an angle in degrees; exact for quarter turns.
fn cosine_and_sine(degrees: f64) -> (f64, f64) {
    let quarters = libm::round(degrees / 90.0);
    let (sine, cosine) = libm::sincos((degrees - 90.0 * quarters).to_radians());
    match (quarters as i64).rem_euclid(4) {
        0 => (cosine, sine),
        1 => (-sine, cosine),
        2 => (-cosine, -sine),
        _ => (sine, -cosine),
    }
}

/// Whether light can be followed to all of it.
fn is_near(mesh: &MeshFile) -> bool {
    mesh.positions().iter().all(|position| f64::from(position.abs().max_element()) <= FARTHEST)
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

/// A colour as light.
fn linear(written: WrittenColor) -> LinearRgb {
    match written {
        WrittenColor::Srgb(color) => LinearRgb::from_srgb8(color),
        WrittenColor::Linear([r, g, b]) => LinearRgb::new(r.value as f32, g.value as f32, b.value as f32),
        WrittenColor::Grey(amount) => LinearRgb::grey(amount.value as f32),
    }
}
