//! Values as an author writes them, each with its place in the text: how they are read from the syntax tree, and how they are
//! checked.
//!
//! A [`Reader`] goes on after a fault, so that one run tells of all. What is missing or faulty is `None`, and its fault has
//! been noted; nothing complains a second time. A [`Checker`] asks what is no question of type: whether a radius is greater
//! than 0, or a coordinate near enough for light to be followed.

mod checker;
mod colors;
mod reader;

pub use checker::Checker;
pub(crate) use checker::{FARTHEST, SHORTEST};
pub use colors::WrittenColor;
pub(crate) use colors::color_named;
pub use reader::{Fields, Reader};
pub(crate) use reader::{description, group_of_values, values};

use crate::scene_text::Span;

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
