//! What the author wrote, typed, in his own units: degrees, sRGB strings, normals of any length.
//!
//! [`SceneFile::read`] knows the grammar of scenes, [`PathFile::read`] that of camera paths: which fields there are, of which types, which must be given. It
//! goes on after a fault, so that one run tells of all. Whether a radius is greater than 0, whether a material exists,
//! is asked by the next stage that knows, [`scene`](crate::scene); for that each value keeps its place in the text.
//!
//! What is missing or faulty is `None`, and its fault has been noted; nobody need complain a second time.

mod camera;
mod objects;
mod path;

pub use camera::{WrittenCamera, WrittenLens};
pub use path::{PathFile, WrittenKeyframe};

use crate::light::WrittenLight;
use crate::material::WrittenMaterial;
use crate::progress::Watcher;
use crate::scene_text::{Faults, Node, Value};
use crate::shape::WrittenShape;
use crate::written::{Fields, Reader, Spanned, WrittenColor, WrittenNumber};

/// A whole scene file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneFile {
    /// From where it is seen.
    pub camera: Option<WrittenCamera>,
    /// Other views of it, in the order of the file.
    pub views: Vec<WrittenCamera>,
    /// What is seen where nothing is.
    pub background: Option<WrittenBackground>,
    /// Light from everywhere.
    pub ambient: Option<WrittenColor>,
    /// The light sources.
    pub lights: Vec<WrittenLight>,
    /// The named materials, in the order of the file.
    pub materials: Vec<NamedMaterial>,
    /// Whether `materials` is all that the author wanted to name; else nobody can say that a name is unknown.
    pub materials_complete: bool,
    /// The objects.
    pub objects: Vec<WrittenObject>,
    /// Whether objects throw shadows.
    pub shadows: Option<bool>,
    /// The factor of all light before it is shown.
    pub exposure: Option<WrittenNumber>,
    /// How bright light is brought into the screen's range.
    pub tone_curve: Option<WrittenToneCurve>,
}

/// The background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenBackground {
    /// One colour.
    Color(WrittenColor),
    /// Two colours.
    Gradient {
        /// Straight down.
        bottom: Option<WrittenColor>,
        /// Straight up.
        top: Option<WrittenColor>,
    },
}

/// How bright light is brought into the screen's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrittenToneCurve {
    /// `None`
    None,
    /// `Reinhard`
    Reinhard,
    /// `Filmic`
    Filmic,
}

/// An entry of `materials`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// The name that objects use.
    pub name: Box<str>,
    /// What it names.
    pub material: Option<WrittenMaterial>,
}

/// An object's material.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialUse {
    /// Written where it is used.
    Inline(WrittenMaterial),
    /// By the name of an entry of `materials`.
    Named(Box<str>),
}

/// An object.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenObject {
    /// Its surface.
    pub shape: WrittenShape,
    /// Its material, and where; a light grey if none is given.
    pub material: Option<Spanned<MaterialUse>>,
}

impl SceneFile {
    /// What the tree says, as far as it is a scene; the rest goes to `faults`. Once the watcher has gone, the lists end
    /// early.
    pub fn read(root: &Node<'_>, watcher: &Watcher<'_>, faults: &mut Faults) -> Self {
        let mut reader = Reader::new(faults, watcher);
        let Some(fields) = reader.root(root) else {
            return Self::default();
        };
        let mut scene = Self {
            camera: reader.required(&fields, "camera", Reader::camera),
            views: reader.optional(&fields, "views", Reader::views).unwrap_or_default(),
            background: reader.optional(&fields, "background", Reader::background),
            ambient: reader.optional(&fields, "ambient", Reader::color),
            lights: reader.optional(&fields, "lights", Reader::lights).unwrap_or_default(),
            objects: reader.optional(&fields, "objects", Reader::objects).unwrap_or_default(),
            shadows: reader.optional(&fields, "shadows", Reader::boolean),
            exposure: reader.optional(&fields, "exposure", Reader::number),
            tone_curve: reader.optional_word(&fields, "tone_curve", Reader::tone_curve),
            materials: Vec::new(),
            materials_complete: true,
        };
        if let Some(materials) = fields.get("materials") {
            scene.materials_complete = reader.materials(materials, &mut scene.materials);
        }
        scene
    }
}

impl Reader<'_> {
    fn root<'n>(&mut self, root: &'n Node<'n>) -> Option<Fields<'n>> {
        const FIELDS: &[&str] = &[
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
        ];
        self.fields(root, "a scene", "a scene (camera: ..., lights: [...], objects: [...])", FIELDS)
    }

    fn background(&mut self, node: &Node<'_>) -> Option<WrittenBackground> {
        if !matches!(node.value, Value::Group(ref group) if group.name.is_some()) {
            return self.color(node).map(WrittenBackground::Color);
        }
        self.variant(node, "a background", "a colour or Gradient(bottom: ..., top: ...)", &["Gradient"])?;
        let fields = self.fields(node, "a Gradient", "Gradient(bottom: ..., top: ...)", &["bottom", "top"])?;
        Some(WrittenBackground::Gradient {
            bottom: self.required(&fields, "bottom", Reader::color),
            top: self.required(&fields, "top", Reader::color),
        })
    }

    fn lights(&mut self, node: &Node<'_>) -> Option<Vec<WrittenLight>> {
        let items = self.list(node, "a list of lights [Point(...), ...]")?;
        Some(self.each(items, Self::light))
    }

    fn light(&mut self, node: &Node<'_>) -> Option<WrittenLight> {
        let name = self.variant(node, "a light", "a light, such as Point(position: ...)", WrittenLight::NAMES)?;
        WrittenLight::read(name, self, node)
    }

    fn tone_curve(&mut self, node: &Node<'_>) -> Option<WrittenToneCurve> {
        let all = [
            ("None", WrittenToneCurve::None),
            ("Reinhard", WrittenToneCurve::Reinhard),
            ("Filmic", WrittenToneCurve::Filmic),
        ];
        self.choice(node, "a tone curve", &all)
    }
}
