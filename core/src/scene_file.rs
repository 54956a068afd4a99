//! Scene files as typed values in the author's units: degrees, sRGB strings, normals of any length.
//!
//! [`SceneFile::read`] implements the grammar of scenes, [`PathFile::read`] that of camera paths: the fields, their
//! types, and which are required. They continue after a fault, so that one run reports all faults. Whether a radius is
//! positive or a material exists is checked later, by [`scene`](crate::scene), which needs the spans of the values.
//!
//! A required value that is missing, or a value with a fault, is `None`. Its fault has been reported, and later stages
//! do not report it again.

mod camera;
mod objects;
mod path;

pub use camera::{WrittenCamera, WrittenLens};
pub use path::{PathFile, WrittenKeyframe};

use crate::finish::WrittenFinish;
use crate::fog::WrittenFog;
use crate::light::WrittenLight;
use crate::material::WrittenMaterial;
use crate::progress::Reporter;
use crate::scene_text::{Faults, Span, SyntaxNode, Value};
use crate::shape::{OBJECT_REFERENCE, WrittenPlacement, WrittenShape};
use crate::written::{Fields, NodeReader, ReferenceEntry, Spanned, WrittenColor, WrittenNumber};

/// A whole scene file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneFile {
    /// The caption, which says what the scene shows.
    pub caption: Option<String>,
    /// The camera.
    pub camera: Option<WrittenCamera>,
    /// Further views, in the order of the file.
    pub views: Vec<WrittenCamera>,
    /// The background.
    pub background: Option<WrittenBackground>,
    /// The ambient light.
    pub ambient: Option<WrittenColor>,
    /// The light sources.
    pub lights: Vec<WrittenLight>,
    /// The named materials, in the order of the file.
    pub materials: Vec<NamedMaterial>,
    /// Whether the names of all entries of `materials` could be read.
    ///
    /// If not, unknown names are not reported as faults.
    pub materials_complete: bool,
    /// The objects.
    pub objects: Vec<WrittenObject>,
    /// Whether objects cast shadows.
    pub shadows: Option<bool>,
    /// The exposure.
    pub exposure: Option<WrittenNumber>,
    /// The most reflections and refractions of a ray.
    pub bounces: Option<WrittenNumber>,
    /// Whether the scene has the lecture's model of light only.
    pub lecture: Option<bool>,
    /// The fog.
    pub fog: Option<WrittenFog>,
    /// The tone curve.
    pub tone_curve: Option<WrittenToneCurve>,
}

/// A background as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenBackground {
    /// The same colour in all directions.
    Color(WrittenColor),
    /// `Gradient(bottom: ..., top: ...)`
    Gradient {
        /// The colour when looking straight down.
        bottom: Option<WrittenColor>,
        /// The colour when looking straight up.
        top: Option<WrittenColor>,
    },
}

/// A tone curve as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrittenToneCurve {
    /// The word `None`: no curve.
    None,
    /// The word `Reinhard`.
    Reinhard,
    /// The word `Filmic`.
    Filmic,
}

/// An entry of `materials`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// The name.
    pub name: Box<str>,
    /// The material.
    pub material: Option<WrittenMaterial>,
}

/// The material of an object.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialUse {
    /// A material written in place.
    Inline(WrittenMaterial),
    /// The name of an entry of `materials`.
    Named(Box<str>),
}

/// An object as written.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenObject {
    /// The surface.
    pub shape: WrittenShape,
    /// The range of the name of the surface in the text.
    pub span: Span,
    /// The placement, if the surface is scaled, rotated or moved.
    // The box keeps objects without it small: a scene may have 300,000.
    pub placement: Option<Box<WrittenPlacement>>,
    /// The material and its span. By default the shape's own colours (those of a mesh's file or of
    /// an implicit surface's formulas), else light grey.
    pub material: Option<Spanned<MaterialUse>>,
    /// The finish and its span; matte by default.
    pub finish: Option<Spanned<WrittenFinish>>,
    /// The part of the light that does not pass through the surface; 1 by default.
    pub opacity: Option<WrittenNumber>,
}

impl SceneFile {
    /// Reads a scene from its syntax tree and adds all faults to `faults`.
    ///
    /// If the reporter is cancelled, the lists end early.
    pub fn read(root: &SyntaxNode<'_>, reporter: &Reporter<'_>, faults: &mut Faults) -> Self {
        let mut reader = NodeReader::new(faults, reporter);
        let Some(fields) = reader.root_fields(root) else {
            return Self::default();
        };
        // All fields are read, even after a fault in one, so that all faults are found.
        let mut scene = Self {
            caption: reader.optional(&fields, "caption", NodeReader::caption),
            camera: reader.required(&fields, "camera", NodeReader::camera),
            views: reader.optional(&fields, "views", NodeReader::views).unwrap_or_default(),
            background: reader.optional(&fields, "background", NodeReader::background),
            ambient: reader.optional(&fields, "ambient", NodeReader::color),
            lights: reader.optional(&fields, "lights", NodeReader::lights).unwrap_or_default(),
            objects: reader.optional(&fields, "objects", NodeReader::objects).unwrap_or_default(),
            shadows: reader.optional(&fields, "shadows", NodeReader::boolean),
            exposure: reader.optional(&fields, "exposure", NodeReader::number),
            tone_curve: reader.optional_keeping_none(&fields, "tone_curve", NodeReader::tone_curve),
            bounces: reader.optional(&fields, "bounces", NodeReader::number),
            lecture: reader.optional(&fields, "lecture", NodeReader::boolean),
            fog: reader.optional(&fields, "fog", WrittenFog::read),
            materials: Vec::new(),
            materials_complete: true,
        };
        if let Some(materials) = fields.get("materials") {
            scene.materials_complete = reader.collect_all_named_materials(materials, &mut scene.materials);
        }
        scene
    }
}

/// The reference of the fields of a scene.
const REFERENCE: ReferenceEntry = ReferenceEntry {
    name: "scene",
    form: "(camera: ..., lights: [...], objects: [...])",
    summary: "A scene file.",
    fields: &[
        "caption",
        "camera",
        "views",
        "background",
        "ambient",
        "lights",
        "materials",
        "objects",
        "shadows",
        "exposure",
        "tone_curve",
        "bounces",
        "fog",
        "lecture",
    ],
    meanings: &[
        "what the scene shows, in quotes; the comment that the file begins with",
        "the camera",
        "a list of further cameras; none",
        "a colour, or Gradient(bottom: ..., top: ...); black",
        "light that arrives equally from everywhere, a colour; none",
        "a list of lights; none",
        "named materials, {\"name\": ...}; none",
        "a list of objects; none",
        "false leaves shadows out; true",
        "the factor of all light before it is shown; 1",
        "None, Reinhard or Filmic; None",
        "the most mirrors, glass and transparent surfaces on the way of a ray, 0 to 16; 6",
        "air that takes away light; none",
        "true leaves out what the lecture's model of light does not have; false",
    ],
}
.checked();

/// Returns the reference of scene files: titles, each with entries.
pub fn reference() -> [(&'static str, Vec<ReferenceEntry>); 5] {
    [
        ("Scene", vec![REFERENCE, camera::REFERENCE, WrittenFog::REFERENCE]),
        ("Lights", WrittenLight::REFERENCE.to_vec()),
        ("Materials", WrittenMaterial::REFERENCE.to_vec()),
        ("Finishes", WrittenFinish::REFERENCE.to_vec()),
        ("Objects", [&[OBJECT_REFERENCE], WrittenShape::REFERENCE].concat()),
    ]
}

impl NodeReader<'_> {
    fn root_fields<'n>(&mut self, root: &'n SyntaxNode<'n>) -> Option<Fields<'n>> {
        self.fields(root, "a scene", "a scene (camera: ..., lights: [...], objects: [...])", REFERENCE.fields)
    }

    fn caption(&mut self, node: &SyntaxNode<'_>) -> Option<String> {
        self.text(node, "a caption in quotes").map(|caption| caption.value)
    }

    fn background(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenBackground> {
        // A gradient is the only background that is a group with a name; everything else is read as a colour.
        if !matches!(node.value, Value::Group(ref group) if group.name.is_some()) {
            return self.color(node).map(WrittenBackground::Color);
        }
        self.group_name(node, "a background", "a colour or Gradient(bottom: ..., top: ...)", &["Gradient"])?;
        let fields = self.fields(node, "a Gradient", "Gradient(bottom: ..., top: ...)", &["bottom", "top"])?;
        Some(WrittenBackground::Gradient {
            bottom: self.required(&fields, "bottom", NodeReader::color),
            top: self.required(&fields, "top", NodeReader::color),
        })
    }

    fn lights(&mut self, node: &SyntaxNode<'_>) -> Option<Vec<WrittenLight>> {
        let items = self.list(node, "a list of lights [Point(...), ...]")?;
        Some(self.read_all(items, Self::light))
    }

    fn light(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenLight> {
        let name = self.group_name(node, "a light", "a light, such as Point(position: ...)", WrittenLight::NAMES)?;
        WrittenLight::read(name, self, node)
    }

    fn tone_curve(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenToneCurve> {
        let all = [
            ("None", WrittenToneCurve::None),
            ("Reinhard", WrittenToneCurve::Reinhard),
            ("Filmic", WrittenToneCurve::Filmic),
        ];
        self.choice(node, "a tone curve", &all)
    }
}
