//! The reader of RON: text to a syntax tree with spans; faults with line, column and caret.
//!
//! Scenes are written in RON (Rusty Object Notation). The grammar of scenes is in [`scene_file`](crate::scene_file);
//! here any RON is parsed. Two things are guaranteed. Every [`SyntaxNode`] has its byte range, so that a later check
//! can report it, and a program can replace it without changing the comments around it. No text, however large, deep or
//! broken, causes more than a [`Fault`]: nesting is limited, memory is bounded by a small multiple of the text, and
//! time is linear.
//!
//! # Crates that were tried
//!
//! - `ron2` 0.3 keeps names and positions, but a text of 2 KB (`a(a(a(...`) passes its depth limit and overflows the
//!   stack, a map of bare names (`{a,a,a,...`) takes quadratic time (14.6 s for 320 KB), and 10 MB of spheres take 1.0
//!   s and 1.4 GB instead of .15 s and 126 MB here. The tests use it as a reference (`tests/files/scene_syntax.rs`):
//!   both readers must give the same trees.
//! - `ron` 0.12.3 with serde fails at `background: Gradient(...)`, where a colour is allowed as well: it does not pass
//!   the name `Gradient` to a type that is chosen by its contents. It rejected 6 of the 12 scenes that were
//!   shipped when it was tried. It also stops at the first fault, while 31 of the 79 faulty scenes of the tests had
//!   several.

mod fault;
#[cfg(feature = "ron")]
mod foreign;
#[cfg(feature = "ron")]
mod parser;
#[cfg(feature = "ron")]
mod tokens;
#[cfg(feature = "ron")]
mod document;

#[cfg(feature = "ron")]
pub(crate) use document::read_or_cancel;
#[cfg(feature = "ron")]
pub use document::{read, text_from};
pub use fault::{Fault, FaultReport, Faults, SceneError, line_and_column};
pub use fault::{clipped, quoted};
#[cfg(feature = "ron")]
pub use parser::parse;

/// A range of bytes in the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// The index of the span's first byte.
    pub start: u32,
    /// The index after the span's last byte.
    pub end: u32,
}

impl Span {
    /// Returns the range from `start` up to, but not including, `end`.
    // A text has at most 16 MiB, so 32 bits are enough for every index.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, end: end as u32 }
    }

    /// Returns the empty range at an index.
    pub fn empty_at(offset: usize) -> Self {
        Self::new(offset, offset)
    }
}

/// The largest size of a text: 16 MiB, enough for a scene of 200,000 spheres.
pub const MAX_TEXT_BYTES: usize = 16 << 20;

/// The largest depth of nested brackets. A scene needs 5.
// The parser is recursive, and a deeper text could overflow the stack.
pub const MAX_NESTING: usize = 128;

/// A value and its span.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntaxNode<'a> {
    /// The span of the whole value, including brackets.
    pub span: Span,
    /// The value.
    pub value: Value<'a>,
}

/// A RON value. `Some(x)` is read as x.
#[derive(Clone, Debug, PartialEq)]
pub enum Value<'a> {
    /// `true` or `false`.
    Bool(bool),
    /// A number in any notation, including `inf` and `NaN`.
    Number(f64),
    /// A string with its escapes resolved.
    String(Box<str>),
    /// A list: `[a, b]`.
    List(Vec<SyntaxNode<'a>>),
    /// A map: `{a: b}`.
    Map(Vec<(SyntaxNode<'a>, SyntaxNode<'a>)>),
    /// A name, parentheses or both: `Name`, `(...)` or `Name(...)`.
    Group(Box<Group<'a>>),
}

/// A name, a pair of parentheses, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Group<'a> {
    /// The name before the parentheses.
    pub name: Option<Name<'a>>,
    /// The contents of the parentheses.
    pub body: Body<'a>,
}

/// An unquoted word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name<'a> {
    /// The word.
    pub text: &'a str,
    /// The range of the word's bytes in the text.
    pub span: Span,
}

/// The part after the name of a group.
#[derive(Clone, Debug, PartialEq)]
pub enum Body<'a> {
    /// No parentheses: `InverseSquare`.
    Nothing,
    /// Values: `(1, 2, 3)`; also `()`.
    Values(Vec<SyntaxNode<'a>>),
    /// Named values: `(radius: 1)`.
    Fields(Vec<Field<'a>>),
}

/// A field `name: value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'a> {
    /// The name before the colon.
    pub name: Name<'a>,
    /// The value after the colon.
    pub value: SyntaxNode<'a>,
}

impl<'a> SyntaxNode<'a> {
    /// Returns the fields of a group without a name, `(name: value, ...)`; an empty slice for `()`.
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

    /// Returns the word if the value is an unquoted word without brackets, such as `InverseSquare`.
    pub fn word(&self) -> Option<&'a str> {
        match &self.value {
            Value::Group(group) if group.body == Body::Nothing => group.name.map(|name| name.text),
            _ => None,
        }
    }

    /// Returns the span at which a missing part of the value is reported: the value's name or first
    /// bracket.
    // The span of the whole value is not used, because it may be a thousand lines long.
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
