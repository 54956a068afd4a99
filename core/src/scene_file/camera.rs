//! Cameras as written: the scene's camera and further views.

use crate::scene_text::{Span, SyntaxNode, quoted};
use crate::text::listed;
use crate::written::{Fields, NodeReader, ReferenceEntry, WrittenNumber, WrittenVector};

/// The scene's camera or a view, as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenCamera {
    /// The span at which faults of the whole camera are reported.
    pub span: Span,
    /// The eye point.
    pub eye: Option<WrittenVector>,
    /// The target point.
    pub target: Option<WrittenVector>,
    /// The up vector. By default +y, or for a view the up vector of the scene's camera.
    pub up: Option<WrittenVector>,
    /// The intrinsic parameters. A view without any has those of the scene's camera.
    pub lens: WrittenLens,
    /// The shift of the view rectangle from the centre, to the right and up, in heights of the
    /// rectangle.
    pub shift: Option<[WrittenNumber; 2]>,
    /// The angles between the direction of view and the normal of the view rectangle, to the right
    /// and up, in degrees.
    pub tilt: Option<[WrittenNumber; 2]>,
}

/// The intrinsic parameters as written, in one of two forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenLens {
    /// The lens given by its vertical field of view and aspect ratio.
    FieldOfView {
        /// The vertical field of view in degrees; 45 if not given.
        vertical_fov: Option<WrittenNumber>,
        /// Width divided by height; the picture's if not given.
        aspect_ratio: Option<WrittenNumber>,
    },
    /// The lens given by focal length, width and height: the lecture's f, w and h.
    FocalLength {
        /// The focal length f.
        focal_length: Option<WrittenNumber>,
        /// The width w of the view rectangle.
        width: Option<WrittenNumber>,
        /// The height h of the view rectangle.
        height: Option<WrittenNumber>,
    },
}

impl WrittenCamera {
    /// Returns whether no intrinsic parameter is given.
    pub fn has_no_intrinsics(&self) -> bool {
        let nothing = WrittenLens::FieldOfView { vertical_fov: None, aspect_ratio: None };
        self.lens == nothing && self.shift.is_none() && self.tilt.is_none()
    }
}

/// The reference of the fields of a camera or view.
pub(super) const REFERENCE: ReferenceEntry = ReferenceEntry {
    name: "camera",
    form: "(eye: ..., target: ...)",
    summary: "The camera, and each of the views.",
    fields: &[
        "eye",
        "target",
        "up",
        "vertical_fov",
        "aspect_ratio",
        "focal_length",
        "width",
        "height",
        "shift",
        "tilt",
    ],
    meanings: &[
        "the point that the picture is seen from",
        "the point in the middle of the picture",
        "the direction that is up in the picture; (0, 1, 0)",
        "the vertical field of view in degrees; 45",
        "width over height of the view rectangle; that of the picture",
        "the distance of the view rectangle, with width and height instead of vertical_fov; none",
        "the width of the view rectangle; none",
        "the height of the view rectangle; none",
        "the shift of the view rectangle to the right and up, in its heights; (0, 0)",
        "the tilt of the view rectangle to the right and up, in degrees; (0, 0)",
    ],
}
.checked();

impl NodeReader<'_> {
    pub(super) fn camera(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenCamera> {
        self.camera_called(node, "a camera", "a camera (eye: ..., target: ...)")
    }

    /// Reads the views of a scene, each with the fields of a camera.
    pub(super) fn views(&mut self, node: &SyntaxNode<'_>) -> Option<Vec<WrittenCamera>> {
        let items = self.list(node, "a list of views [(eye: ..., target: ...), ...]")?;
        Some(
            self.read_all(items, |reader, item| reader.camera_called(item, "a view", "a view (eye: ..., target: ...)")),
        )
    }

    /// Reads a camera or a view. For messages, `owner` is what it is called, and `form` an example
    /// of it.
    fn camera_called(&mut self, node: &SyntaxNode<'_>, owner: &'static str, form: &str) -> Option<WrittenCamera> {
        let fields = self.fields(node, owner, form, REFERENCE.fields)?;
        Some(WrittenCamera {
            span: node.head(),
            eye: self.required(&fields, "eye", NodeReader::point),
            target: self.required(&fields, "target", NodeReader::point),
            up: self.optional(&fields, "up", NodeReader::direction),
            lens: self.lens(&fields),
            shift: self.optional(&fields, "shift", NodeReader::shift),
            tilt: self.optional(&fields, "tilt", NodeReader::tilt),
        })
    }

    fn lens(&mut self, fields: &Fields<'_>) -> WrittenLens {
        const FOCAL: [&str; 3] = ["focal_length", "width", "height"];
        // One field of the focal form is enough to recognize it.
        if FOCAL.iter().all(|&name| fields.get(name).is_none()) {
            return WrittenLens::FieldOfView {
                vertical_fov: self.optional(fields, "vertical_fov", NodeReader::number),
                aspect_ratio: self.optional(fields, "aspect_ratio", NodeReader::number),
            };
        }
        for name in ["vertical_fov", "aspect_ratio"] {
            if let Some(field) = fields.field(name) {
                self.fault(field.name.span, || {
                    format!("\"{name}\" cannot be combined with focal_length, width and height; use either form")
                });
            }
        }
        self.missing_of_focal_form(fields, &FOCAL);
        let [focal_length, width, height] = FOCAL.map(|name| self.optional(fields, name, NodeReader::number));
        WrittenLens::FocalLength { focal_length, width, height }
    }

    /// Reports which of the three required fields of the focal form are missing.
    fn missing_of_focal_form(&mut self, fields: &Fields<'_>, names: &[&str]) {
        let missing = names.iter().filter(|name| !fields.is_given_or_misspelt(name));
        let missing: Vec<_> = missing.map(|name| quoted(name)).collect();
        let given = names.iter().find_map(|name| fields.field(name));
        // Reports one fault for all missing fields, at the first given one.
        if let (false, Some(given)) = (missing.is_empty(), given) {
            let s = if missing.len() > 1 { "s" } else { "" };
            self.fault(given.name.span, || {
                format!("missing field{s} {}; focal_length, width and height go together", listed(&missing))
            });
        }
    }

    fn shift(&mut self, node: &SyntaxNode<'_>) -> Option<[WrittenNumber; 2]> {
        self.numbers(node, "a shift (right, up)")
    }

    fn tilt(&mut self, node: &SyntaxNode<'_>) -> Option<[WrittenNumber; 2]> {
        self.numbers(node, "a tilt (right, up) in degrees")
    }
}
