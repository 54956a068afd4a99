//! Text -> a syntax tree that knows where everything stands; faults with line, column and caret.
//!
//! Scenes are written in RON (Rusty Object Notation). The tree says nothing of what a scene is: that is the next
//! stage's affair, [`scene_file`](crate::scene_file). Two things are its own. Every [`Node`] has the bytes it was
//! written in, so that a later check can point at them, and a program can put something else in their place without
//! touching the comments around them. And no text, however large, deep or broken, does more than give a [`Fault`]:
//! nesting is limited, memory stays within a small multiple of the text, time is linear.
//!
//! # Crates that were tried
//!
//! - `ron2` 0.3 keeps names and places, but a text of 2 KB (`a(a(a(...`) passes its limit of depth and overflows the stack, a
//!   map of bare names (`{a,a,a,...`) takes quadratic time, 14.6 s for 320 KB, and 10 MB of spheres take 1.0 s and 1.4 GB,
//!   here .15 s and 126 MB. It is the judge of ours in `tests/files/scene_syntax.rs`: both must read the same trees.
//! - `ron` 0.12.3 with serde fails at `background: Gradient(...)` where a colour may stand as well: where the type is chosen
//!   by what is written, the name `Gradient` is not passed on; 6 of the 12 shipped scenes are refused. It stops at the first
//!   fault, where 31 of the 79 faulty scenes of the tests have several.

mod fault;
#[cfg(feature = "ron")]
mod parser;
#[cfg(feature = "ron")]
mod tokens;
#[cfg(feature = "ron")]
mod whole;

pub use fault::{Fault, Faults, Report, SceneError, line_and_column};
pub(crate) use fault::{clipped, quoted};
#[cfg(feature = "ron")]
pub use parser::parse;
#[cfg(feature = "ron")]
pub(crate) use whole::read_or_cancel;
#[cfg(feature = "ron")]
pub use whole::{read, text_from};

/// The bytes of the text that something was written in: from `start` up to, and without, `end`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// The first byte.
    pub start: u32,
    /// The byte after the last one.
    pub end: u32,
}

impl Span {
    /// The bytes from `start` up to `end`. A text is at most 16 MiB, so that 32 bits hold every place in it.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, end: end as u32 }
    }

    /// No bytes, at that place.
    pub fn at(place: usize) -> Self {
        Self::new(place, place)
    }
}

/// The largest text that is read: 16 MiB. A scene of 200,000 spheres fits in.
pub const MAX_BYTES: usize = 16 << 20;

/// How deep values may lie in each other.
pub const MAX_DEPTH: usize = 128;

/// A value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Node<'a> {
    /// All of it, brackets included.
    pub span: Span,
    /// What it is.
    pub value: Value<'a>,
}

/// What RON can say. `Some(x)` is read as x.
#[derive(Clone, Debug, PartialEq)]
pub enum Value<'a> {
    /// `true` or `false`.
    Bool(bool),
    /// A number of any notation, `inf` and `NaN` among them.
    Number(f64),
    /// A string, its escapes resolved.
    String(Box<str>),
    /// `[a, b]`.
    List(Vec<Node<'a>>),
    /// `{a: b}`.
    Map(Vec<(Node<'a>, Node<'a>)>),
    /// `Name`, `Name(...)` or `(...)`.
    Group(Box<Group<'a>>),
}

/// A name, a pair of parentheses, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Group<'a> {
    /// What stands before the parentheses.
    pub name: Option<Name<'a>>,
    /// What stands in them.
    pub body: Body<'a>,
}

/// A word that is not in quotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name<'a> {
    /// The word.
    pub text: &'a str,
    /// Where it stands.
    pub span: Span,
}

/// What follows a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Body<'a> {
    /// Nothing: `InverseSquare`.
    Nothing,
    /// Values: `(1, 2, 3)`; also `()`.
    Values(Vec<Node<'a>>),
    /// Values with names: `(radius: 1)`.
    Fields(Vec<Field<'a>>),
}

/// `name: value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'a> {
    /// Before the colon.
    pub name: Name<'a>,
    /// After it.
    pub value: Node<'a>,
}

impl<'a> Node<'a> {
    /// The fields of `(name: value, ...)`, a group that has no name itself; none of `()`.
    pub fn fields(&self) -> Option<&[Field<'a>]> {
        match &self.value {
            Value::Group(group) if group.name.is_none() => match &group.body {
                Body::Fields(fields) => Some(fields),
                Body::Values(values) if values.is_empty() => Some(&[]),
                _ => None,
            },
            _ => None,
        }
    }

    /// The word, if it is one without quotes and brackets, such as `InverseSquare`.
    pub fn word(&self) -> Option<&'a str> {
        match &self.value {
            Value::Group(group) if group.body == Body::Nothing => group.name.map(|name| name.text),
            _ => None,
        }
    }

    /// Where to point when something is missing in this value: its name, or else its first bracket.
    pub fn head(&self) -> Span {
        match &self.value {
            Value::Group(group) => match group.name {
                Some(name) => name.span,
                None => first_byte(self.span),
            },
            Value::List(_) | Value::Map(_) => first_byte(self.span),
            _ => self.span,
        }
    }
}

fn first_byte(span: Span) -> Span {
    Span { end: span.start + 1, ..span }
}
