//! Values as an author writes them, each with its place in the text: how they are read from the syntax tree, and how they are
//! checked.
//!
//! A [`Reader`] goes on after a fault, so that one run tells of all. What is missing or faulty is `None`, and its fault has
//! been noted; nothing complains a second time. A [`Validator`] asks what is no question of type: whether a radius is greater
//! than 0, or a coordinate near enough for light to be followed.

mod colors;
mod reader;
mod validator;

pub use colors::WrittenColor;
pub use reader::{Fields, Reader};
pub(crate) use reader::{description, group_of_values, values};
pub use validator::Validator;

use crate::scene_text::{Node, Span};
use std::fmt::Debug;

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

/// A value that a scene file has as a name with fields, such as `Sphere(center: ..., radius: ...)`.
pub trait InSceneFile {
    /// What the author wrote, typed.
    type Written: Clone + Debug + PartialEq;

    /// The word before the fields: "Sphere".
    const NAME: &'static str;

    /// The same after an article, for messages.
    const OWNER: &'static str;

    /// How all of it is written: "Sphere(center: ..., radius: ...)".
    const FORM: &'static str;

    /// The names of its fields; those of a surface end with `material`, which every object has.
    const FIELDS: &'static [&'static str];

    /// Reads its fields.
    fn read(reader: &mut Reader<'_>, fields: &Fields<'_>) -> Self::Written;

    /// Reads all of it, name and fields.
    fn read_node(reader: &mut Reader<'_>, node: &Node<'_>) -> Option<Self::Written> {
        let fields = reader.fields(node, Self::OWNER, Self::FORM, Self::FIELDS)?;
        Some(Self::read(reader, &fields))
    }
}
