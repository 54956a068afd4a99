//! Words, numbers and line ends of a text, in one pass over its bytes.
//!
//! OBJ, MTL, STL and PLY agree in this much: words stand between blanks, a line is a statement. What only OBJ knows, a
//! comment after `#` and a line that goes on after `\`, does not occur in the others.

use super::fault::{Fault, shown};

/// A place in a text, and what is read from there on.
pub(super) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Text<'a> {
    /// From the beginning of the text; its byte order mark, if it has one, is passed over.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at }
    }

    /// From that byte.
    pub(super) fn from(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    /// The place, in bytes.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// How many bytes are left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Passes over blanks, and over a line's end after a backslash.
    pub(super) fn skip_blanks(&mut self) {
        loop {
            match self.peek() {
                Some(b' ' | b'\t') => self.at += 1,
                Some(b'\\') => match line_end(&self.bytes[self.at + 1..]) {
                    0 => return,
                    end => self.at += 1 + end,
                },
                _ => return,
            }
        }
    }

    /// Whether the text is at its end.
    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Whether nothing but blanks or a comment is left of the line.
    pub(super) fn is_at_line_end(&mut self) -> bool {
        self.skip_blanks();
        matches!(self.peek(), None | Some(b'\n' | b'\r' | b'#'))
    }

    /// Goes to the beginning of the next line.
    pub(super) fn skip_line(&mut self) {
        self.rest_of_line();
        self.at += line_end(&self.bytes[self.at..]);
    }

    /// Goes to the next line that says something; false if there is none.
    pub(super) fn go_to_statement(&mut self) -> bool {
        while self.is_at_line_end() {
            if self.is_at_end() {
                return false;
            }
            self.skip_line();
        }
        true
    }

    /// The end of a statement.
    pub(super) fn end_line(&mut self) -> Result<(), Fault> {
        if self.is_at_line_end() {
            self.skip_line();
            return Ok(());
        }
        Err(self.expected("the end of the line"))
    }

    /// What is left of the line, without the blanks around it; the place is then the line's end.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        while !matches!(self.peek(), None | Some(b'\n' | b'\r')) {
            self.at += 1;
        }
        self.bytes[start..self.at].trim_ascii_end()
    }

    /// The next word of the line; empty at its end.
    pub(super) fn word(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        while !self.is_word_end(self.at) {
            self.at += 1;
        }
        &self.bytes[start..self.at]
    }

    fn is_word_end(&self, at: usize) -> bool {
        match self.bytes.get(at) {
            None | Some(b' ' | b'\t' | b'\n' | b'\r') => true,
            Some(b'\\') => line_end(&self.bytes[at + 1..]) > 0,
            _ => false,
        }
    }

    /// Whether a word ends here.
    #[inline]
    pub(super) fn is_at_word_end(&self) -> bool {
        self.is_word_end(self.at)
    }

    /// The same text at an earlier place.
    pub(super) fn back_at(&self, at: usize) -> Self {
        Self { bytes: self.bytes, at }
    }

    /// The next word, which must be a finite number. It is rounded correctly.
    #[inline]
    pub(super) fn number(&mut self) -> Result<f32, Fault> {
        self.skip_blanks();
        if let Ok((value, length)) = fast_float2::parse_partial::<f32, _>(&self.bytes[self.at..])
            && value.is_finite()
            && self.is_word_end(self.at + length)
        {
            self.at += length;
            return Ok(value);
        }
        Err(self.no_number())
    }

    #[cold]
    fn no_number(&mut self) -> Fault {
        let start = self.at;
        let word = self.word();
        match fast_float2::parse::<f64, _>(word) {
            Ok(value) if value.is_finite() => {
                Fault::in_text(start, format!("{} is too large: numbers go up to 3.4e38", shown(word)))
            }
            Ok(_) => Fault::in_text(start, format!("{} is not a finite number", shown(word))),
            Err(_) => {
                self.at = start;
                self.expected("a number")
            }
        }
    }

    /// The next word, which must be a whole number.
    #[inline]
    pub(super) fn integer(&mut self) -> Result<i64, Fault> {
        self.skip_blanks();
        let start = self.at;
        let value = self.digits();
        match value {
            Some(value) if self.is_word_end(self.at) => Ok(value),
            _ => {
                self.at = start;
                Err(self.expected("a whole number"))
            }
        }
    }

    /// A whole number that may end inside a word; at most 18 digits.
    #[inline]
    pub(super) fn digits(&mut self) -> Option<i64> {
        let negative = self.take(b'-');
        if !negative {
            self.take(b'+');
        }
        let start = self.at;
        let mut value = 0_i64;
        while let Some(digit @ b'0'..=b'9') = self.peek() {
            if self.at - start == 18 {
                return None;
            }
            value = value * 10 + i64::from(digit - b'0');
            self.at += 1;
        }
        (self.at > start).then_some(if negative { -value } else { value })
    }

    /// Passes over that byte, if it is the next one.
    #[inline]
    pub(super) fn take(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    /// The fault that something else stands here.
    #[cold]
    pub(super) fn expected(&mut self, wanted: &str) -> Fault {
        let is_line_end = self.is_at_line_end();
        let start = self.at;
        let found = match self.word() {
            _ if start >= self.bytes.len() => "the file ends".to_owned(),
            _ if is_line_end => "the line ends".to_owned(),
            word => format!("{} stands", shown(word)),
        };
        Fault::in_text(start, format!("{found} where {wanted} should be"))
    }
}

/// The length of the line's end that the bytes begin with; 0 if they begin with none.
fn line_end(bytes: &[u8]) -> usize {
    match bytes {
        [b'\r', b'\n', ..] => 2,
        [b'\n' | b'\r', ..] => 1,
        _ => 0,
    }
}
