//! Values as written, each with its span: reading from the syntax tree, and checking.
//!
//! A [`NodeReader`] continues after a fault, so that one run reports all. A missing or faulty value is `None`, and its
//! fault has been reported. A [`Validator`] checks what types do not: that a radius is positive, or that a coordinate
//! is small enough for rays to be traced.

mod colors;
mod node_reader;
mod validator;

pub use colors::WrittenColor;
pub use node_reader::{Fields, NodeReader};
pub(crate) use node_reader::{description, group_of_values, values};
pub use validator::Validator;

use crate::scene_text::{Span, SyntaxNode};
use std::fmt::Debug;

/// A value and its span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// The range of the value in the text.
    pub span: Span,
}

/// A finite number.
pub type WrittenNumber = Spanned<f64>;

/// Three finite numbers: a point or a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenVector {
    /// x, y and z.
    pub components: [WrittenNumber; 3],
    /// The range of the whole value.
    pub span: Span,
}

/// A value that a scene file writes as a name with fields, such as `Sphere(center: ..., radius:
/// ...)`.
pub trait InSceneFile {
    /// The value as written.
    type Written: Clone + Debug + PartialEq;

    /// The name before the fields: "Sphere".
    const NAME: &'static str;

    /// The name with an article, for messages.
    const OWNER: &'static str;

    /// The full form: "Sphere(center: ..., radius: ...)".
    const FORM: &'static str;

    /// The names of the fields; those of a surface end with `material`, which every object has.
    const FIELDS: &'static [&'static str];

    /// Reads the value from its fields.
    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> Self::Written;

    /// Reads the value from its node: the group of fields after its name.
    fn read_node(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self::Written> {
        let fields = reader.fields(node, Self::OWNER, Self::FORM, Self::FIELDS)?;
        Some(Self::read(reader, &fields))
    }
}
