//! What the author wrote, typed, in his own units: degrees, sRGB strings, normals of any length.
//!
//! [`SceneFile::read`] knows the grammar of scenes, [`PathFile::read`] that of camera paths: which fields there are, of which types, which must be given. It
//! goes on after a fault, so that one run tells of all. Whether a radius is greater than 0, whether a material exists,
//! is asked by the next stage that knows, [`scene`](crate::scene); for that each value keeps its place in the text.
//!
//! What is missing or faulty is `None`, and its fault has been noted; nobody need complain a second time.

mod colors;
mod objects;
mod path;
mod reader;
mod words;

pub use colors::WrittenColor;
pub(crate) use colors::color_named;
pub use path::{PathFile, WrittenKeyframe};
pub(crate) use words::{closest, listed};

use crate::scene_text::{Faults, Node, Span, Value, quoted};
use reader::{Fields, Reader};

/// A value and where it was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its bytes.
    pub span: Span,
}

/// A finite number.
pub type WrittenNumber = Spanned<f64>;

/// Three finite numbers: a point or a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenVector {
    /// x, y and z.
    pub components: [WrittenNumber; 3],
    /// All of it.
    pub span: Span,
}

/// A whole scene file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneFile {
    /// From where it is seen.
    pub camera: Option<WrittenCamera>,
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

/// The camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenCamera {
    /// Where to point when it is wrong as a whole.
    pub span: Span,
    /// The eye point.
    pub eye: Option<WrittenVector>,
    /// The target point.
    pub target: Option<WrittenVector>,
    /// The up vector; +y if none is given.
    pub up: Option<WrittenVector>,
    /// The intrinsic parameters.
    pub lens: WrittenLens,
    /// The view rectangle off centre: to the right and up, in its heights.
    pub shift: Option<[WrittenNumber; 2]>,
}

/// The intrinsic parameters, in either of the lecture's forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenLens {
    /// By angle.
    FieldOfView {
        /// In degrees; 45 if none is given.
        vertical_fov: Option<WrittenNumber>,
        /// Width over height; the picture's own if none is given.
        aspect_ratio: Option<WrittenNumber>,
    },
    /// By the lecture's f, w and h.
    FocalLength {
        /// f.
        focal_length: Option<WrittenNumber>,
        /// w.
        width: Option<WrittenNumber>,
        /// h.
        height: Option<WrittenNumber>,
    },
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

/// A point light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenLight {
    /// Where it is.
    pub position: Option<WrittenVector>,
    /// Its colour; white if none is given.
    pub color: Option<WrittenColor>,
    /// The factor of its colour; 1 if none is given.
    pub intensity: Option<WrittenNumber>,
    /// How it grows weaker; by the inverse square if nothing is given.
    pub falloff: Option<WrittenFalloff>,
}

/// How a light grows weaker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrittenFalloff {
    /// `InverseSquare`
    InverseSquare,
    /// `None`
    None,
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

/// A material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenMaterial {
    /// One reflectance.
    Diffuse(Option<WrittenColor>),
    /// Two, in squares.
    Checker {
        /// Of the first square; `"#dddddd"` if none is given.
        a: Option<WrittenColor>,
        /// Of the others; `"#333333"` if none is given.
        b: Option<WrittenColor>,
        /// A square's side; 1 if none is given.
        size: Option<WrittenNumber>,
    },
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

/// A surface.
#[derive(Clone, Debug, PartialEq)]
pub enum WrittenShape {
    /// `Sphere(center: ..., radius: ...)`
    Sphere {
        /// The centre.
        center: Option<WrittenVector>,
        /// The radius.
        radius: Option<WrittenNumber>,
    },
    /// `Triangle(corners: [..., ..., ...])`
    Triangle {
        /// The three corners.
        corners: Option<[WrittenVector; 3]>,
    },
    /// `Mesh(path: ..., scale: ..., rotate: ..., translate: ...)`
    Mesh {
        /// The mesh's file, seen from the scene's.
        path: Option<Spanned<String>>,
        /// Along each axis; 1 if none is given.
        scale: Option<WrittenVector>,
        /// About x, then y, then z, in degrees.
        rotate: Option<WrittenVector>,
        /// By so much, after scale and rotation.
        translate: Option<WrittenVector>,
    },
    /// `Plane(point: ..., normal: ...)`
    Plane {
        /// Any of its points.
        point: Option<WrittenVector>,
        /// Of any length but 0.
        normal: Option<WrittenVector>,
    },
}

impl SceneFile {
    /// What the tree says, as far as it is a scene; the rest goes to `faults`.
    pub fn read(root: &Node<'_>, faults: &mut Faults) -> Self {
        let mut reader = Reader::new(faults);
        let Some(fields) = reader.root(root) else {
            return Self::default();
        };
        let mut scene = Self {
            camera: reader.required(&fields, "camera", Reader::camera),
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
        const FIELDS: &[&str] =
            &["camera", "background", "ambient", "lights", "materials", "objects", "shadows", "exposure", "tone_curve"];
        self.fields(root, "a scene", "a scene (camera: ..., lights: [...], objects: [...])", FIELDS)
    }

    fn camera(&mut self, node: &Node<'_>) -> Option<WrittenCamera> {
        const FIELDS: &[&str] =
            &["eye", "target", "up", "vertical_fov", "aspect_ratio", "focal_length", "width", "height", "shift"];
        let fields = self.fields(node, "a camera", "a camera (eye: ..., target: ...)", FIELDS)?;
        Some(WrittenCamera {
            span: node.head(),
            eye: self.required(&fields, "eye", Reader::point),
            target: self.required(&fields, "target", Reader::point),
            up: self.optional(&fields, "up", Reader::direction),
            lens: self.lens(&fields),
            shift: self.optional(&fields, "shift", Reader::shift),
        })
    }

    fn lens(&mut self, fields: &Fields<'_>) -> WrittenLens {
        const FOCAL: [&str; 3] = ["focal_length", "width", "height"];
        if FOCAL.iter().all(|&name| fields.get(name).is_none()) {
            return WrittenLens::FieldOfView {
                vertical_fov: self.optional(fields, "vertical_fov", Reader::number),
                aspect_ratio: self.optional(fields, "aspect_ratio", Reader::number),
            };
        }
        for name in ["vertical_fov", "aspect_ratio"] {
            if let Some(field) = fields.field(name) {
                self.fault(field.name.span, || {
                    format!("\"{name}\" cannot stand beside focal_length, width and height; use either form")
                });
            }
        }
        self.missing_of_focal_form(fields, &FOCAL);
        let [focal_length, width, height] = FOCAL.map(|name| self.optional(fields, name, Reader::number));
        WrittenLens::FocalLength { focal_length, width, height }
    }

    fn missing_of_focal_form(&mut self, fields: &Fields<'_>, names: &[&str]) {
        let missing = names.iter().filter(|name| !fields.is_given(name));
        let missing: Vec<_> = missing.map(|name| quoted(name)).collect();
        let given = names.iter().find_map(|name| fields.field(name));
        if let (false, Some(given)) = (missing.is_empty(), given) {
            let s = if missing.len() > 1 { "s" } else { "" };
            self.fault(given.name.span, || {
                format!("missing field{s} {}; focal_length, width and height go together", listed(&missing))
            });
        }
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
        Some(items.iter().filter_map(|item| self.light(item)).collect())
    }

    fn light(&mut self, node: &Node<'_>) -> Option<WrittenLight> {
        self.variant(node, "a light", "a light Point(position: ...)", &["Point"])?;
        let known = &["position", "color", "intensity", "falloff"];
        let fields = self.fields(node, "a Point light", "Point(position: ...)", known)?;
        Some(WrittenLight {
            position: self.required(&fields, "position", Reader::point),
            color: self.optional(&fields, "color", Reader::color),
            intensity: self.optional(&fields, "intensity", Reader::number),
            falloff: self.optional_word(&fields, "falloff", Reader::falloff),
        })
    }

    fn falloff(&mut self, node: &Node<'_>) -> Option<WrittenFalloff> {
        let all = [("InverseSquare", WrittenFalloff::InverseSquare), ("None", WrittenFalloff::None)];
        self.choice(node, "a falloff", &all)
    }

    fn tone_curve(&mut self, node: &Node<'_>) -> Option<WrittenToneCurve> {
        let all = [
            ("None", WrittenToneCurve::None),
            ("Reinhard", WrittenToneCurve::Reinhard),
            ("Filmic", WrittenToneCurve::Filmic),
        ];
        self.choice(node, "a tone curve", &all)
    }

    fn shift(&mut self, node: &Node<'_>) -> Option<[WrittenNumber; 2]> {
        self.numbers(node, "a shift (right, up)")
    }
}
