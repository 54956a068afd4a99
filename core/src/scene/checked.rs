//! The only conversion from written to checked values, which changes units and colour spaces.
//!
//! It makes all checks of values beyond their types. Checking continues after a fault, so that one run reports all
//! faults. A value that is missing because of an earlier fault is skipped without a report.

mod camera;
pub(super) mod path;

use super::{Background, Checked, Draft, Object, ToneCurve, caption};
use crate::checks::{self, Message, SceneFault};
use crate::color::{LinearRgb, Srgb8};
use crate::finish::{Finish, WrittenFinish};
use crate::material::{Coloring, Image, Images, Material, WrittenMaterial};
use crate::mesh_file::{MeshFile, Motion};
use crate::progress::Reporter;
use crate::scene_file::{MaterialUse, NamedMaterial, SceneFile, WrittenBackground, WrittenObject, WrittenToneCurve};
use crate::scene_text::{Faults, quoted};
use crate::shape::{
    CornerCells, Mesh, Meshes, MovingParts, Placement, Shape, WrittenMesh, WrittenShape, without_chart,
    without_coordinates, without_inside,
};
use crate::text::{closest, listed};
use crate::written::{Spanned, Validator};
use std::collections::HashMap;
use std::sync::Arc;

/// A source of the files that a scene names.
pub(super) trait SideFiles: Meshes + Images {}

/// Returns the checked scene, or `None` after all faults have been added to `faults`.
///
/// If the reporter is cancelled, objects may be missing.
pub(super) fn check(
    file: &SceneFile,
    side_files: &mut dyn SideFiles,
    reporter: &Reporter<'_>,
    faults: &mut Faults,
) -> Option<Draft> {
    let mut validator = Validator { faults };
    // All values are checked before a fault ends the function. Faults are sorted by their positions in the file later.
    let camera = file.camera.as_ref().and_then(|camera| validator.camera(camera));
    let views = file.views.iter().filter_map(|view| validator.view(view, camera.as_ref())).collect();
    let background = file.background.as_ref().and_then(|written| validator.background(written));
    let ambient = file.ambient.and_then(|color| validator.light_color(color));
    let lights = file.lights.iter().filter_map(|light| light.check(&mut validator)).collect();
    let exposure = file.exposure.and_then(|written| validator.accept(written.span, checks::exposure(written.value)));
    let bounces = file.bounces.and_then(|written| validator.accept(written.span, checks::bounces(written.value)));
    let fog = file.fog.and_then(|fog| fog.check(&mut validator));
    let objects = validator.objects(file, side_files, reporter);
    if !faults.is_empty() {
        return None;
    }
    let tone_curve = match file.tone_curve {
        None | Some(WrittenToneCurve::None) => ToneCurve::None,
        Some(WrittenToneCurve::Reinhard) => ToneCurve::Reinhard,
        Some(WrittenToneCurve::Filmic) => ToneCurve::Filmic,
    };
    let draft = Draft::new(Checked {
        caption: file.caption.as_deref().and_then(caption::displayed_caption),
        views,
        background: background.unwrap_or(Background::Color(LinearRgb::BLACK)),
        ambient: ambient.unwrap_or(LinearRgb::BLACK),
        lights,
        shadows: file.shadows.unwrap_or(true),
        exposure: exposure.unwrap_or(1.0),
        bounces: bounces.unwrap_or(Checked::DEFAULT_BOUNCES),
        fog,
        tone_curve,
        ..Checked::new(camera?, objects)
    });
    Some(if file.lecture == Some(true) { draft.in_lecture() } else { draft })
}

impl Validator<'_> {
    fn background(&mut self, written: &WrittenBackground) -> Option<Background> {
        match *written {
            WrittenBackground::Color(color) => self.light_color(color).map(Background::Color),
            WrittenBackground::Gradient { bottom, top } => {
                let [bottom, top] = [bottom, top].map(|color| color.and_then(|color| self.light_color(color)));
                Some(Background::Gradient { bottom: bottom?, top: top? })
            }
        }
    }

    // Objects -------------------------------------------------------------------------------------------------------

    fn objects(&mut self, file: &SceneFile, side_files: &mut dyn SideFiles, reporter: &Reporter<'_>) -> Vec<Object> {
        // Each named material is checked once, although thousands of objects may use it.
        let mut materials = HashMap::new();
        for NamedMaterial { name, material } in &file.materials {
            let checked =
                material.as_ref().map(|written| CheckedMaterial { written, coloring: written.check(self, side_files) });
            materials.insert(&**name, checked);
        }
        let (mut objects, mut sharing) = (Vec::new(), MeshSharing::of(file));
        for written in file.objects.iter().take_while(|_| !reporter.is_cancelled()) {
            let shape = written.shape.check(self, side_files);
            let coloring = self.coloring_of(written, shape.as_ref(), file, &materials, side_files);
            let finish = written.finish.map_or(Some(Finish::Matte), |finish| self.finish_of(finish, written));
            let opacity =
                written.opacity.map_or(Some(1.0), |opacity| self.accept(opacity.span, checks::opacity(opacity.value)));
            let placements = written.placement.as_ref().map(|placement| placement.check(self));
            // All parts have been checked by now, so that the faults of each are reported.
            let (Some(shape), Some(coloring), Some(finish), Some(opacity)) = (shape, coloring, finish, opacity) else {
                continue;
            };
            let Coloring { material, image } = coloring;
            let object = |shape, image| Object { shape, material, finish, opacity, image };
            match placements {
                Some(None) => {}
                // The coordinates of a mesh are checked as it is placed.
                None if !matches!(shape, Shape::Mesh(_)) => objects.push(object(shape, image)),
                placements => {
                    let placements = placements.flatten().unwrap_or_else(|| vec![Placement::NONE]);
                    let placed = |placement| sharing.placed(written, &shape, placement);
                    let placed: Result<Vec<_>, _> = placements.iter().map(placed).collect();
                    let shapes = self.accept(written.span, placed).unwrap_or_default();
                    let image = image.map(|image| image_on(&shape, image, placements.first()));
                    objects.extend(shapes.into_iter().flatten().map(|shape| object(shape, image.clone())));
                }
            }
        }
        objects
    }

    /// Returns the finish of an object.
    fn finish_of(&mut self, finish: Spanned<WrittenFinish>, object: &WrittenObject) -> Option<Finish> {
        let checked = finish.value.check(self)?;
        if matches!(checked, Finish::Glass { .. }) && !object.shape.has_inside() {
            return self.fault(finish.span, || without_inside(object.shape.owner()));
        }
        Some(checked)
    }

    /// Returns the colours of an object: those of the material written in place or named, or the
    /// default of its shape.
    fn coloring_of(
        &mut self,
        object: &WrittenObject,
        shape: Option<&Shape>,
        file: &SceneFile,
        materials: &HashMap<&str, Option<CheckedMaterial<'_>>>,
        images: &mut dyn Images,
    ) -> Option<Coloring> {
        let Some(Spanned { value, span }) = &object.material else {
            return Some(if object.shape.brings_colors() { Material::Own } else { Material::DEFAULT }.into());
        };
        let CheckedMaterial { written, coloring } = match value {
            MaterialUse::Inline(written) => CheckedMaterial { written, coloring: written.check(self, images) },
            MaterialUse::Named(name) => match materials.get(&**name) {
                Some(checked) => checked.clone()?,
                // An entry of `materials` whose name could not be read may have this name, so it is not reported as
                // unknown.
                None if !file.materials_complete => return None,
                None => return self.fault(*span, || unknown_material_message(name, file)),
            },
        };
        let owner = object.shape.owner();
        match (written, written.material_and_pattern_names()) {
            (WrittenMaterial::Image(_), Some(pattern)) => {
                if !object.shape.has_chart() {
                    return self.fault(*span, || without_chart(pattern, owner));
                }
                if matches!(shape, Some(Shape::Mesh(mesh)) if !mesh.has_chart()) {
                    let message = "the file of this Mesh has no texture coordinates, on which an Image is laid out";
                    return self.fault(*span, || message.to_owned());
                }
            }
            (_, Some(pattern)) if !object.shape.has_coordinates() => {
                return self.fault(*span, || without_coordinates(pattern, owner));
            }
            _ => {}
        }
        coloring
    }
}

/// Returns the picture on a shape; that on a ball is turned as the ball is placed.
fn image_on(shape: &Shape, image: Arc<Image>, placement: Option<&Placement>) -> Arc<Image> {
    match (shape, placement) {
        // All copies are turned in the same way.
        (Shape::Sphere(_), Some(placement)) => Arc::new(Image::clone(&image).turned(placement.turn_of_ball())),
        _ => image,
    }
}

/// The sharing of meshes among objects: which meshes are shared, and the triangle count so far.
struct MeshSharing<'f> {
    /// The number of objects, copies included, with each mesh path.
    objects: HashMap<&'f str, usize>,
    /// The corners of each mesh that is shared; `None` for one that each object copies.
    corner_cells: HashMap<*const MeshFile, Option<CornerCells>>,
    /// The number of triangles so far, those of each copy and instance counted.
    triangles: usize,
    /// The moving parts of each mesh that moves, and the number of all parts so far.
    moving: HashMap<*const Motion, MovingParts>,
    parts: usize,
}

/// The most triangles of a scene, those of each copy and instance counted.
// Traversal numbers them with 32 bits, of which other primitives need a part.
const MAX_TRIANGLES: usize = 2_000_000_000;

/// The most moving parts of the meshes of a scene, those of each copy counted.
const MAX_PARTS: usize = 1 << 20;

impl<'f> MeshSharing<'f> {
    fn of(file: &'f SceneFile) -> Self {
        let mut objects = HashMap::new();
        for WrittenObject { shape, placement, .. } in &file.objects {
            if let WrittenShape::Mesh(WrittenMesh { path: Some(path) }) = shape {
                let copies = placement.as_ref().map_or(1, |placement| placement.copy_count());
                let count: &mut usize = objects.entry(&*path.value).or_default();
                *count = count.saturating_add(copies);
            }
        }
        Self { objects, corner_cells: HashMap::new(), triangles: 0, moving: HashMap::new(), parts: 0 }
    }

    /// Returns a shape of an object scaled, rotated and moved.
    ///
    /// A mesh that moves becomes several shapes.
    fn placed(&mut self, object: &WrittenObject, shape: &Shape, placement: &Placement) -> Result<Vec<Shape>, Message> {
        let of_fault = |fault: SceneFault| fault.message().to_owned().into();
        let (Shape::Mesh(mesh), WrittenShape::Mesh(WrittenMesh { path: Some(path) })) = (shape, &object.shape) else {
            return shape.clone().placed(placement).map(|shape| vec![shape]).map_err(of_fault);
        };
        self.triangles = self.triangles.saturating_add(mesh.triangle_count() as usize);
        if self.triangles > MAX_TRIANGLES {
            return Err("a scene may have up to 2,000,000,000 triangles, those of each copy counted".into());
        }
        let count = self.objects.get(&*path.value).copied().unwrap_or(1);
        let Some(motion) = mesh.file().motion() else {
            return self.still(mesh, count, placement).map(|shape| vec![shape]);
        };
        self.parts = self.parts.saturating_add(motion.meshes().len());
        if self.parts > MAX_PARTS {
            return Err("a scene may have up to 1,048,576 moving parts of meshes, those of each copy counted".into());
        }
        let still = motion.still().map(|still| self.still(&Mesh::of_checked(Arc::clone(still)), count, placement));
        let parts = self.moving.entry(Arc::as_ptr(motion)).or_insert_with(|| MovingParts::of(motion));
        let parts = parts.placed(placement).ok_or(checks::MESH_TOO_FAR)?;
        Ok(still.transpose()?.into_iter().chain(parts.into_iter().map(Shape::from)).collect())
    }

    /// Returns a mesh that does not move, of which there are `count`, scaled, rotated and moved.
    fn still(&mut self, mesh: &Mesh, count: usize, placement: &Placement) -> Result<Shape, Message> {
        let file = mesh.shared_file();
        let cells = self.corner_cells.entry(Arc::as_ptr(file));
        if let Some(cells) = cells.or_insert_with(|| CornerCells::of_shared(file, count)) {
            return Mesh::instance(file, cells, placement).map(Shape::from).ok_or(checks::MESH_TOO_FAR.into());
        }
        let placed = Shape::from(mesh.clone()).placed(placement);
        placed.map_err(|fault| fault.message().to_owned().into())
    }
}

/// A checked material, with the material as written in the file.
#[derive(Clone)]
struct CheckedMaterial<'f> {
    written: &'f WrittenMaterial,
    /// `None` if the material has a fault.
    coloring: Option<Coloring>,
}

/// Returns the message about an unknown material, with the name or colour that was probably meant.
fn unknown_material_message(name: &str, file: &SceneFile) -> String {
    let unknown = format!("unknown material {}", quoted(name));
    let names = || file.materials.iter().map(|named| &*named.name);
    let is_color = name.starts_with('#') || Srgb8::from_name(name).is_some();
    match (closest(name, names()), is_color) {
        (Some(meant), false) => return format!("{unknown}; did you mean {}?", quoted(meant)),
        (Some(meant), true) => {
            return format!("{unknown}; did you mean {} or the colour Diffuse({})?", quoted(meant), quoted(name));
        }
        (None, true) => return format!("{unknown}; a colour is written Diffuse({})", quoted(name)),
        (None, false) => {}
    }
    // Shows the eight names that fit on a line; a generated scene may have thousands.
    let shown: Vec<_> = names().take(8).map(quoted).collect();
    match file.materials.len() {
        0 => format!("{unknown}; the scene has no named materials"),
        1 => format!("{unknown}; there is only {}", listed(&shown)),
        all if all > shown.len() => format!("{unknown}; there are {} and more", shown.join(", ")),
        _ => format!("{unknown}; there are {}", listed(&shown)),
    }
}
