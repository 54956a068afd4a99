//! A picture from a file as the colours of a surface.

use crate::checks::{self, Message};
use crate::color::LinearRgb;
use crate::mesh_file::{Sampler, Texture, Wrap};
use crate::progress::Unfinished;
use crate::scene_text::{Body, SyntaxNode, Value};
use crate::written::{Fields, InSceneFile, NodeReader, Spanned, Validator, WrittenNumber};
use glam::{Mat3, Vec2};
use std::sync::Arc;

/// A picture that is laid on a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    texture: Arc<Texture>,
    /// The number of times that the picture is repeated across the surface, and down it.
    repeat: Vec2,
    sampler: Sampler,
    /// The opacity below which the surface has a hole.
    cutoff: Option<f32>,
    /// The rotation from the scene to the picture on a ball, which is the same shape however it is
    /// turned.
    turn: Option<Mat3>,
}

/// A source of pictures by their paths.
pub trait Images {
    /// Returns the picture whose path in a scene file is `path`.
    ///
    /// # Errors
    /// The message for the user, or a cancellation.
    fn image(&mut self, path: &str) -> Result<Arc<Texture>, Unfinished<String>>;
}

impl Image {
    /// The name of the picture's parts for messages, as [`PATTERN`](super::Reflecting::PATTERN).
    pub(super) const PATTERN: &'static str = "its pixels";

    /// Returns the picture on a ball that is turned by the inverse of `turn`.
    #[cfg_attr(not(feature = "ron"), allow(dead_code, reason = "only scene files have pictures"))]
    pub(crate) fn turned(self, turn: Mat3) -> Self {
        Self { turn: Some(turn), ..self }
    }

    /// Returns the rotation from the scene to the picture on a ball.
    pub(crate) fn turn(&self) -> Mat3 {
        self.turn.unwrap_or(Mat3::IDENTITY)
    }

    /// Returns the reflectance where the surface has the coordinates `at`, from (0, 0) in the upper
    /// left corner to (1, 1).
    pub(crate) fn reflectance(&self, at: Vec2) -> LinearRgb {
        self.texture.sample(at * self.repeat, self.sampler)
    }

    /// Returns whether the picture makes holes.
    pub(crate) fn has_holes(&self) -> bool {
        self.cutoff.is_some()
    }

    /// Returns whether the surface has a hole where it has the coordinates `at`.
    pub(crate) fn has_hole(&self, at: Vec2) -> bool {
        self.cutoff.is_some_and(|cutoff| self.texture.sample_opacity(at * self.repeat, self.sampler) < cutoff)
    }

    /// Returns the checked picture, or `None` after a fault has been reported to `validator`.
    pub(super) fn check(
        written: &WrittenImage,
        validator: &mut Validator<'_>,
        images: &mut dyn Images,
    ) -> Option<Self> {
        let repeat = written.repeat.map_or(Some([1.0; 2]), |repeat| {
            let [across, down] =
                repeat.map(|number| validator.accept(number.span, checks::nonzero_factor(number.value)));
            Some([across?, down?])
        });
        let cutoff = match written.cutoff {
            Some(cutoff) => validator.accept(cutoff.span, opacity_cutoff(cutoff.value)).map(Some),
            None => Some(None),
        };
        let path = written.path.as_ref()?;
        let texture = match images.image(&path.value) {
            Ok(texture) => texture,
            Err(Unfinished::Cancelled) => return None,
            Err(Unfinished::Failed(message)) => return validator.fault(path.span, || message),
        };
        // A picture without transparent pixels makes no holes, for which rays would have to be examined.
        let cutoff = cutoff?.filter(|_| texture.is_transparent());
        let sampler = Sampler { wrap: [written.wrap.unwrap_or_default(); 2], is_nearest: written.is_nearest };
        Some(Self { texture, repeat: repeat?.into(), sampler, cutoff, turn: None })
    }
}

/// Checks the opacity below which a picture makes holes.
fn opacity_cutoff(cutoff: f64) -> Result<f32, Message> {
    if cutoff > 0.0 && cutoff <= 1.0 {
        Ok(cutoff as f32)
    } else {
        Err("the cutoff must be greater than 0 and at most 1: less opaque parts of the picture are holes".into())
    }
}

/// A picture as written: `Image("wood.png")`, or `Image(path: "wood.png", repeat: ...)`.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenImage {
    path: Option<Spanned<String>>,
    repeat: Option<[WrittenNumber; 2]>,
    wrap: Option<Wrap>,
    is_nearest: bool,
    cutoff: Option<WrittenNumber>,
}

impl WrittenImage {
    fn of_path(path: Option<Spanned<String>>) -> Self {
        Self { path, repeat: None, wrap: None, is_nearest: false, cutoff: None }
    }
}

impl InSceneFile for Image {
    type Written = WrittenImage;

    const NAME: &'static str = "Image";
    const OWNER: &'static str = "an Image";
    const FORM: &'static str = "Image(path: \"...\")";
    const FIELDS: &'static [&'static str] = &["path", "repeat", "wrap", "filter", "cutoff"];
    const SUMMARY: &'static str = "A picture; Image(\"wood.png\") is the short form.";
    const MEANINGS: &'static [&'static str] = &[
        "the path of a PNG, JPEG or other picture, relative to the scene file, in quotes",
        "how often it is repeated, or (across, down); 1",
        "what is beyond its edges: Repeat, Mirror or Clamp; Repeat",
        "Linear blends neighbouring pixels, Nearest shows them as squares; Linear",
        "the opacity of the picture below which the surface has holes; no holes",
    ];

    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> WrittenImage {
        let wraps = [("Repeat", Wrap::Repeat), ("Mirror", Wrap::Mirror), ("Clamp", Wrap::Clamp)];
        let filters = [("Linear", false), ("Nearest", true)];
        WrittenImage {
            repeat: reader.optional(fields, "repeat", read_repeat),
            wrap: reader.optional(fields, "wrap", |reader, node| reader.choice(node, "a wrap", &wraps)),
            is_nearest: reader
                .optional(fields, "filter", |reader, node| reader.choice(node, "a filter", &filters))
                .unwrap_or(false),
            cutoff: reader.optional(fields, "cutoff", NodeReader::number),
            ..WrittenImage::of_path(reader.required(fields, "path", read_path))
        }
    }

    /// Reads `Image("...")` or `Image(path: "...", ...)`.
    fn read_node(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<WrittenImage> {
        if let Value::Group(group) = &node.value
            && let Body::Values(values) = &group.body
            && let [path] = &values[..]
        {
            return Some(WrittenImage::of_path(read_path(reader, path)));
        }
        let fields = reader.fields(node, Self::OWNER, Self::FORM, Self::FIELDS)?;
        Some(Self::read(reader, &fields))
    }
}

fn read_path(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Spanned<String>> {
    reader.text(node, "the path of a picture in quotes")
}

/// Reads a number of repetitions: one for both directions, or two.
fn read_repeat(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<[WrittenNumber; 2]> {
    if matches!(node.value, Value::Number(_)) {
        return reader.number(node).map(|number| [number; 2]);
    }
    reader.numbers(node, "a number, or one across and one down (x, y)")
}
