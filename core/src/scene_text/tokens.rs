//! The lexer: characters to tokens.

use super::fault::quoted;
use super::{Fault, Span};

/// A token of RON.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RonToken<'a> {
    /// An opening bracket: `(`, `[` or `{`.
    Open(char),
    /// A closing bracket: `)`, `]` or `}`.
    Close(char),
    Comma,
    Colon,
    Word(&'a str),
    Number(f64),
    String(Box<str>),
    /// A character that is not part of RON.
    Other(char),
    /// The end of the text.
    End,
}

/// The lexer: a position in the text, which can be copied to look ahead.
#[derive(Clone, Copy, Debug)]
pub(super) struct RonTokens<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> RonTokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// Returns the next token and its range.
    pub(super) fn next(&mut self) -> Result<(RonToken<'a>, Span), Fault> {
        self.skip_trivia()?;
        let start = self.at;
        let token = self.read_token()?;
        Ok((token, Span::new(start, self.at)))
    }

    /// Skips attributes of the whole text, such as `#![enable(implicit_some)]`, which have no
    /// effect.
    pub(super) fn skip_attributes(&mut self) -> Result<(), Fault> {
        if self.rest().starts_with(BYTE_ORDER_MARK) {
            self.at += BYTE_ORDER_MARK.len_utf8();
        }
        loop {
            self.skip_trivia()?;
            let rest = self.rest();
            if !rest.starts_with("#![") {
                return Ok(());
            }
            let Some(end) = rest.find(']') else { return Ok(()) };
            self.at += end + 1;
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn read_token(&mut self) -> Result<RonToken<'a>, Fault> {
        let rest = self.rest();
        let Some(first) = rest.chars().next() else {
            return Ok(RonToken::End);
        };
        // Raw strings are recognized before words, because they start with the letter r.
        if let Some(hashes) = raw_string_hashes(rest) {
            return self.read_raw_string(hashes);
        }
        match first {
            '"' => return self.read_string(),
            '\'' => return Err(self.single_quote_fault()),
            '0'..='9' | '+' | '-' | '.' => return self.read_number(),
            _ if first == '_' || first.is_alphabetic() => return Ok(self.read_word()),
            _ => {}
        }
        self.at += first.len_utf8();
        Ok(match first {
            '(' | '[' | '{' => RonToken::Open(first),
            ')' | ']' | '}' => RonToken::Close(first),
            ',' => RonToken::Comma,
            ':' => RonToken::Colon,
            other => RonToken::Other(other),
        })
    }

    fn read_word(&mut self) -> RonToken<'a> {
        let word = self.take_while(|c| c == '_' || c.is_alphanumeric());
        match word {
            // RON has these two words as numbers. The later checks refuse them, with a message about the value.
            "inf" => RonToken::Number(f64::INFINITY),
            "NaN" => RonToken::Number(f64::NAN),
            _ => RonToken::Word(word),
        }
    }

    fn take_while(&mut self, belongs: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|c| !belongs(c)).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// Reads a number with all characters that may belong to it; a malformed one is reported as a
    /// whole.
    fn read_number(&mut self) -> Result<RonToken<'a>, Fault> {
        let start = self.at;
        self.at += 1;
        loop {
            let run = self.take_while(|c| c == '_' || c == '.' || c.is_alphanumeric());
            let so_far = &self.text[start..self.at];
            let exponent = run.ends_with(['e', 'E']) && !is_prefixed(so_far) && self.rest().starts_with(['+', '-']);
            if !exponent {
                break;
            }
            self.at += 1;
        }
        let text = &self.text[start..self.at];
        parse_number(text).map(RonToken::Number).ok_or_else(|| Fault {
            message: format!("{} is not a number", quoted(text)),
            span: Span::new(start, self.at),
        })
    }

    /// Reads a string in double quotes, which must end on its line.
    // RON allows line ends in strings. But a scene's strings are mostly names, colours and formulas, so a line end
    // means that the closing quote is missing. The fault is reported at the opening quote, and so on the right line.
    fn read_string(&mut self) -> Result<RonToken<'a>, Fault> {
        let start = self.at;
        let mut value = String::new();
        let mut chars = self.text[start + 1..].char_indices();
        while let Some((i, c)) = chars.next() {
            match c {
                '"' => {
                    self.at = start + 1 + i + 1;
                    return Ok(RonToken::String(value.into()));
                }
                '\n' => break,
                '\\' => value.push(read_escape(&mut chars).ok_or_else(|| Fault {
                    message: "unknown escape in this string; a backslash itself is written \\\\".to_owned(),
                    span: Span::new(start + 1 + i, start + 2 + i),
                })?),
                _ => value.push(c),
            }
        }
        Err(Fault {
            message: "this string has no closing quote on its line".to_owned(),
            span: Span::new(start, start + 1),
        })
    }

    fn read_raw_string(&mut self, hashes: usize) -> Result<RonToken<'a>, Fault> {
        let start = self.at;
        let begin = start + 2 + hashes;
        let closing = format!("\"{}", "#".repeat(hashes));
        let Some(length) = self.text[begin..].find(&closing) else {
            return Err(Fault { message: "this raw string is never closed".to_owned(), span: Span::new(start, begin) });
        };
        self.at = begin + length + closing.len();
        Ok(RonToken::String(self.text[begin..begin + length].into()))
    }

    fn single_quote_fault(&self) -> Fault {
        Fault {
            message: "a string is written in double quotes: \"...\"".to_owned(),
            span: Span::new(self.at, self.at + 1),
        }
    }

    /// Skips white space and comments.
    fn skip_trivia(&mut self) -> Result<(), Fault> {
        loop {
            self.take_while(is_space);
            let rest = self.rest();
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.at += block_comment_length(rest).ok_or_else(|| Fault {
                    message: "this comment is never closed".to_owned(),
                    span: Span::new(self.at, self.at + 2),
                })?;
            } else {
                return Ok(());
            }
        }
    }
}

/// The byte order mark, with which some editors begin a file.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Returns whether RON treats a character as white space.
fn is_space(c: char) -> bool {
    matches!(
        c,
        ' ' | '\t' | '\n' | '\r' | '\x0B' | '\x0C' | '\u{85}' | '\u{200E}' | '\u{200F}' | '\u{2028}' | '\u{2029}'
    )
}

/// Returns the length of the block comment at the start of the text, including nested comments.
///
/// Returns `None` if the comment never ends.
fn block_comment_length(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = 0;
    // A loop instead of a recursion, because comments may nest a million deep.
    while let Some(step) = text[at..].find(['/', '*']) {
        at += step;
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return Some(at);
            }
        } else {
            at += 1;
        }
    }
    None
}

/// Returns the number of hashes if the text starts with a raw string: `r"`, `r#"`, `r##"`...
fn raw_string_hashes(text: &str) -> Option<usize> {
    let after = text.strip_prefix('r')?;
    let unhashed = after.trim_start_matches('#');
    unhashed.starts_with('"').then(|| after.len() - unhashed.len())
}

/// Reads the rest of an escape sequence after its backslash, and returns its character.
fn read_escape(chars: &mut std::str::CharIndices<'_>) -> Option<char> {
    let (_, kind) = chars.next()?;
    Some(match kind {
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        '0' => '\0',
        '\\' | '"' | '\'' => kind,
        'x' => {
            // `from_str_radix` accepts a sign as well, which is harmless.
            let digits: String = chars.by_ref().take(2).map(|(_, c)| c).collect();
            char::from(u8::from_str_radix(&digits, 16).ok()?)
        }
        'u' => {
            let (_, '{') = chars.next()? else { return None };
            let digits: String = chars.by_ref().map(|(_, c)| c).take_while(|&c| c != '}').take(7).collect();
            char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?
        }
        _ => return None,
    })
}

/// Returns whether a number is written in another base than 10.
fn is_prefixed(number: &str) -> bool {
    let digits = number.trim_start_matches(['+', '-']).as_bytes();
    matches!(digits, [b'0', b'x' | b'X' | b'o' | b'O' | b'b' | b'B', ..])
}

/// The suffixes for a number's type in Rust and RON.
const SUFFIXES: [&str; 12] = ["f32", "f64", "i8", "i16", "i32", "i64", "i128", "u8", "u16", "u32", "u64", "u128"];

/// Parses a number: decimal or with a base prefix, with underscores and Rust's suffixes.
fn parse_number(token: &str) -> Option<f64> {
    if is_prefixed(token) {
        return number_in_other_base(token);
    }
    let digits = SUFFIXES.iter().find_map(|suffix| token.strip_suffix(suffix)).unwrap_or(token);
    digits.replace('_', "").parse().ok()
}

/// Parses a number with one of the prefixes 0x, 0o and 0b, after an optional sign.
fn number_in_other_base(text: &str) -> Option<f64> {
    let digits = text.trim_start_matches(['+', '-']);
    let base = match digits.as_bytes()[1].to_ascii_lowercase() {
        b'x' => 16,
        b'o' => 8,
        _ => 2,
    };
    let digits = digits[2..].replace('_', "");
    // `from_str_radix` would accept a second sign, as in `-0x-1`.
    if digits.starts_with(['+', '-']) {
        return None;
    }
    let size = u128::from_str_radix(&digits, base).ok()? as f64;
    Some(if text.starts_with('-') { -size } else { size })
}
