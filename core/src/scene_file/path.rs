//! Camera paths as written, and their reading from the syntax tree.

use crate::progress::Reporter;
use crate::scene_text::{Faults, Span, SyntaxNode};
use crate::written::{NodeReader, WrittenNumber, WrittenVector};

/// A camera path file as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathFile {
    /// The keyframes, in the order of the file, and the span of their list.
    pub keyframes: Option<(Vec<WrittenKeyframe>, Span)>,
}

/// A keyframe as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenKeyframe {
    /// The span at which faults of the whole keyframe are reported.
    pub span: Span,
    /// The time in seconds from the start of the film.
    pub time: Option<WrittenNumber>,
    /// The eye point.
    pub eye: Option<WrittenVector>,
    /// The target point.
    pub target: Option<WrittenVector>,
    /// The up vector; the scene's if not given.
    pub up: Option<WrittenVector>,
    /// The vertical field of view in degrees; the scene's if not given.
    pub vertical_fov: Option<WrittenNumber>,
}

impl PathFile {
    /// Reads a camera path from its syntax tree and adds every fault to `faults`.
    pub fn read(root: &SyntaxNode<'_>, faults: &mut Faults) -> Self {
        const FORM: &str = "a camera path (keyframes: [(time: ..., eye: ..., target: ...), ...])";
        let reporter = Reporter::silent();
        let mut reader = NodeReader::new(faults, &reporter);
        let fields = reader.fields(root, "a camera path", FORM, &["keyframes"]);
        Self { keyframes: fields.and_then(|fields| reader.required(&fields, "keyframes", NodeReader::keyframes)) }
    }
}

impl NodeReader<'_> {
    fn keyframes(&mut self, node: &SyntaxNode<'_>) -> Option<(Vec<WrittenKeyframe>, Span)> {
        let items = self.list(node, "a list of keyframes [(time: ..., eye: ..., target: ...), ...]")?;
        Some((self.read_all(items, Self::keyframe), node.span))
    }

    fn keyframe(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenKeyframe> {
        const FORM: &str = "a keyframe (time: ..., eye: ..., target: ...)";
        const FIELDS: &[&str] = &["time", "eye", "target", "up", "vertical_fov"];
        let fields = self.fields(node, "a keyframe", FORM, FIELDS)?;
        Some(WrittenKeyframe {
            span: node.head(),
            time: self.required(&fields, "time", NodeReader::number),
            eye: self.required(&fields, "eye", NodeReader::point),
            target: self.required(&fields, "target", NodeReader::point),
            up: self.optional(&fields, "up", NodeReader::direction),
            vertical_fov: self.optional(&fields, "vertical_fov", NodeReader::number),
        })
    }
}
