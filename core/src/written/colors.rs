//! Colours as written in a file.

use super::WrittenNumber;
use super::node_reader::{NodeReader, values};
use crate::color::{LinearRgb, Srgb8};
use crate::scene_text::{Body, Group, SyntaxNode, Value, quoted};
use crate::text::{ParseError, closest};
use std::str::FromStr;

/// A colour as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrittenColor {
    /// `"#rgb"`, `"#rrggbb"`, or the name of a CSS colour.
    Srgb(Srgb8),
    /// `(r, g, b)`, linear light.
    Linear([WrittenNumber; 3]),
    /// One number for all channels, linear light.
    Grey(WrittenNumber),
}

impl WrittenColor {
    /// Returns the written numbers of the colour; none for a string.
    pub fn numbers(&self) -> &[WrittenNumber] {
        match self {
            Self::Srgb(_) => &[],
            Self::Linear(channels) => channels,
            Self::Grey(channel) => std::slice::from_ref(channel),
        }
    }
}

impl NodeReader<'_> {
    pub(crate) fn color(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenColor> {
        const WANTED: &str = "a colour (\"#rrggbb\", a name, (r, g, b) or a number)";
        match &node.value {
            Value::String(string) => match color_from(string) {
                Ok(color) => Some(WrittenColor::Srgb(color)),
                Err(message) => {
                    self.fault(node.span, || message);
                    None
                }
            },
            Value::Number(_) => self.number(node).map(WrittenColor::Grey),
            Value::Group(group) if is_unquoted_color_name(group) => {
                let name = group.name.map_or("", |name| name.text);
                self.fault(node.span, || format!("a colour is written in quotes: {}", quoted(name)));
                None
            }
            _ if values(node).is_some() => self.numbers(node, WANTED).map(WrittenColor::Linear),
            _ => {
                self.mismatch(node, WANTED);
                None
            }
        }
    }
}

/// Parses `#rgb`, `#rrggbb`, or the name of a CSS colour, as in scene files.
///
/// ```
/// use termtrace::LinearRgb;
///
/// assert_eq!("#ffffff".parse(), Ok(LinearRgb::grey(1.0)));
/// let error = "stelblue".parse::<LinearRgb>().unwrap_err();
/// assert_eq!(error.to_string(), "\"stelblue\" is not the name of a colour; did you mean \"steelblue\"?");
/// ```
impl FromStr for LinearRgb {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        color_from(text).map(Self::from).map_err(ParseError::new)
    }
}

/// Returns whether a group is the name of a CSS colour without quotes.
fn is_unquoted_color_name(group: &Group<'_>) -> bool {
    group.body == Body::Nothing && group.name.is_some_and(|name| Srgb8::from_name(name.text).is_some())
}

fn color_from(string: &str) -> Result<Srgb8, String> {
    // Blanks around a name or a code are ignored.
    let name = string.trim();
    if let Some(digits) = name.strip_prefix('#') {
        return color_from_hex(digits).ok_or_else(|| bad_hex_message(string, digits));
    }
    Srgb8::from_name(name).ok_or_else(|| unknown_name_message(string, name))
}

fn color_from_hex(digits: &str) -> Option<Srgb8> {
    // Checks the digits, because `from_str_radix` would accept a sign.
    if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let number = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = number.to_be_bytes();
    match digits.len() {
        6 => Some(Srgb8::new(r, g, b)),
        // #f80 is short for #ff8800.
        3 => {
            let twice = |shift: u32| ((number >> shift & 15) * 17) as u8; // at most 255
            Some(Srgb8::new(twice(8), twice(4), twice(0)))
        }
        _ => None,
    }
}

fn bad_hex_message(string: &str, digits: &str) -> String {
    let quoted = quoted(string);
    match digits.chars().find(|c| !c.is_ascii_hexdigit()) {
        Some(_) => format!("{quoted} is not a colour; after `#` come hexadecimal digits, 0 to 9 and a to f"),
        None if matches!(digits.len(), 4 | 8) => {
            format!("{quoted} is not a colour; there is no transparency, write \"#rgb\" or \"#rrggbb\"")
        }
        None => format!("{quoted} is not a colour; after `#` come 3 or 6 digits"),
    }
}

fn unknown_name_message(string: &str, name: &str) -> String {
    let quoted = quoted(string);
    if let 3 | 6 = name.len()
        && color_from_hex(name).is_some()
    {
        return format!("{quoted} is not a colour; did you mean \"#{name}\"?");
    }
    match closest(name, Srgb8::names()) {
        Some(meant) => format!("{quoted} is not the name of a colour; did you mean \"{meant}\"?"),
        None => format!("{quoted} is not a colour; write \"#rrggbb\" or a name of CSS, such as \"steelblue\""),
    }
}
