//! Parsing of ANSI text: the characters of a row and their styles.

use std::fmt;
use std::iter::Peekable;
use std::str::{Chars, Split};

/// The colours and attributes of a character, as SGR parameters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
// Strings instead of typed colours, so that unknown parameters are compared and shown too.
pub(super) struct TextStyle {
    fg: String,
    bg: String,
    others: Vec<String>,
}

/// Returns the characters of a row of ANSI text, with the style of each.
// Other sequences than SGR stay characters, so that a comparison with a golden frame shows them.
pub(super) fn parse_row(text: &str) -> Vec<(char, TextStyle)> {
    let mut row = Vec::new();
    let mut style = TextStyle::default();
    let mut characters = text.chars();
    loop {
        if let Some(numbers) = take_sgr(&mut characters) {
            style.apply_parameters(numbers);
        } else if let Some(character) = characters.next() {
            // The ESC of any other sequence counts as a character; `visible_char` replaces it in the output.
            row.push((character, style.clone()));
        } else {
            return row;
        }
    }
}

/// If the characters start with an SGR sequence, skips it and returns its parameters.
fn take_sgr<'a>(characters: &mut Chars<'a>) -> Option<&'a str> {
    let rest = characters.as_str().strip_prefix("\x1b[")?;
    let (numbers, after) = rest.split_at(rest.find(|c: char| !matches!(c, '0'..='9' | ';' | ':'))?);
    *characters = after.strip_prefix('m')?.chars();
    Some(numbers)
}

impl TextStyle {
    fn apply_parameters(&mut self, numbers: &str) {
        let mut numbers = numbers.split(';').peekable();
        while let Some(number) = numbers.next() {
            match number {
                "" | "0" => *self = Self::default(),
                "38" => self.fg = color_parameters("38", &mut numbers),
                "48" => self.bg = color_parameters("48", &mut numbers),
                "39" => self.fg.clear(),
                "49" => self.bg.clear(),
                // Reverse video is the only attribute that the encoder switches off without a reset.
                "27" => self.others.retain(|other| other != "7"),
                _ if matches!(number.as_bytes(), [b'3' | b'9', b'0'..=b'7']) => number.clone_into(&mut self.fg),
                _ if matches!(number.as_bytes(), [b'4', b'0'..=b'7'] | [b'1', b'0', b'0'..=b'7']) => {
                    number.clone_into(&mut self.bg);
                }
                _ => self.others.push(number.to_owned()),
            }
        }
    }
}

/// Returns the SGR parameters of a palette colour or a 24-bit colour, starting with `first`.
fn color_parameters(first: &str, numbers: &mut Peekable<Split<'_, char>>) -> String {
    let count = match numbers.peek() {
        Some(&"5") => 2,
        Some(&"2") => 4,
        _ => 0,
    };
    numbers.take(count).fold(first.to_owned(), |color, number| color + ";" + number)
}

/// Writes the SGR parameters of the style, or `default` if there are none.
impl fmt::Display for TextStyle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [&self.fg, &self.bg].into_iter().chain(&self.others).filter(|part| !part.is_empty());
        let parts: Vec<&str> = parts.map(String::as_str).collect();
        f.write_str(if parts.is_empty() { "default".to_owned() } else { parts.join(";") }.as_str())
    }
}
