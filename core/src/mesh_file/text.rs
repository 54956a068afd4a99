//! A cursor over a text file's bytes that reads words, numbers and line ends in one pass.
//!
//! In OBJ, MTL, STL and PLY words are separated by blanks and a line is a statement. Comments after `#` and lines
//! continued by `\` are part of OBJ only, but no valid file of the others contains either sign.

use super::fault::{MeshFault, shown};
use std::borrow::Cow;
use std::ops::Range;

/// A position in a text, from which words and numbers are read.
///
/// Works on bytes, not `str`: checking for UTF-8 would take a second pass, and comments in Latin-1 would be refused.
#[derive(Clone)]
pub(super) struct TextCursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> TextCursor<'a> {
    /// Returns a cursor at the beginning of a text, after its byte order mark if it has one.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at }
    }

    /// Returns a cursor at byte `offset` of a text.
    pub(super) fn starting_at(bytes: &'a [u8], offset: usize) -> Self {
        Self { bytes, at: offset }
    }

    /// Returns a cursor over a piece of a text, with the positions of the whole text.
    pub(super) fn of_piece(bytes: &'a [u8], piece: &Range<usize>) -> Self {
        Self { bytes: &bytes[..piece.end], at: piece.start }
    }

    /// Returns the position in bytes.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Returns the number of bytes left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Skips blanks and line continuations (a backslash and a line end).
    pub(super) fn skip_blanks(&mut self) {
        loop {
            match self.peek() {
                Some(b' ' | b'\t') => self.at += 1,
                Some(b'\\') => match line_ending_len(&self.bytes[self.at + 1..]) {
                    0 => return,
                    end => self.at += 1 + end,
                },
                _ => return,
            }
        }
    }

    /// Returns whether the end of the text is reached.
    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Returns whether only blanks or a comment are left on the line.
    pub(super) fn is_at_line_end(&mut self) -> bool {
        self.skip_blanks();
        matches!(self.peek(), None | Some(b'\n' | b'\r' | b'#'))
    }

    /// Moves to the start of the next line.
    pub(super) fn skip_line(&mut self) {
        self.rest_of_line();
        self.at += line_ending_len(&self.bytes[self.at..]);
    }

    /// Moves to the start of the next line that does not continue this one.
    pub(super) fn skip_continued_line(&mut self) {
        loop {
            let from = self.at;
            self.at = find(self.bytes, from, [b'\n', b'\r', b'\\', b'#']);
            match self.peek() {
                Some(b'\\') => self.at += 1 + line_ending_len(&self.bytes[self.at + 1..]),
                // Within a word it begins no comment.
                Some(b'#') if !self.bytes[..self.at].last().is_none_or(|byte| b" \t\n\r".contains(byte)) => {
                    self.at += 1;
                }
                _ => return self.skip_line(),
            }
        }
    }

    /// Moves past blank lines and comments to the next statement. Returns whether there is one.
    pub(super) fn go_to_statement(&mut self) -> bool {
        while self.is_at_line_end() {
            if self.is_at_end() {
                return false;
            }
            self.skip_line();
        }
        true
    }

    /// Skips the end of the line; a fault if the statement goes on here.
    pub(super) fn end_line(&mut self) -> Result<(), MeshFault> {
        if self.is_at_line_end() {
            self.skip_line();
            return Ok(());
        }
        Err(self.expected("the end of the line"))
    }

    /// Returns the rest of the line without surrounding blanks, and moves to the line's end.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        self.at = find(self.bytes, start, [b'\n', b'\r']);
        self.bytes[start..self.at].trim_ascii_end()
    }

    /// Returns the next word of the line; empty at its end.
    pub(super) fn word(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        while !self.is_word_end(self.at) {
            self.at += 1;
        }
        &self.bytes[start..self.at]
    }

    fn is_word_end(&self, offset: usize) -> bool {
        match self.bytes.get(offset) {
            None | Some(b' ' | b'\t' | b'\n' | b'\r') => true,
            // A backslash that is not before a line end is part of the word, as in a Windows path.
            Some(b'\\') => line_ending_len(&self.bytes[offset + 1..]) > 0,
            _ => false,
        }
    }

    /// Returns whether a word would end at the cursor.
    #[inline]
    pub(super) fn is_at_word_end(&self) -> bool {
        self.is_word_end(self.at)
    }

    /// Returns whether the next byte is a slash.
    #[inline]
    pub(super) fn is_at_slash(&self) -> bool {
        self.peek() == Some(b'/')
    }

    /// Returns a cursor at byte `offset` of the same text.
    pub(super) fn cursor_at(&self, offset: usize) -> Self {
        Self { bytes: self.bytes, at: offset }
    }

    /// Reads a word that must be a finite number, correctly rounded.
    // `#[inline]` on each function that is called per number: a mesh of a million vertices has ten million numbers.
    #[inline]
    pub(super) fn number(&mut self) -> Result<f32, MeshFault> {
        let start = self.at;
        let value = self.any_number()?;
        if value.is_finite() {
            return Ok(value);
        }
        self.at = start;
        Err(self.number_fault())
    }

    /// Reads a word that must be a number; infinity and NaN are numbers too.
    #[inline]
    pub(super) fn any_number(&mut self) -> Result<f32, MeshFault> {
        self.skip_blanks();
        // `fast_float2` rounds correctly, as the standard library does, but parses bytes and stops at the first one
        // that is not part of a number: no search for the word's end, no check for UTF-8.
        if let Ok((value, length)) = fast_float2::parse_partial::<f32, _>(&self.bytes[self.at..])
            && self.is_word_end(self.at + length)
        {
            self.at += length;
            return Ok(value);
        }
        Err(self.number_fault())
    }

    #[cold]
    fn number_fault(&mut self) -> MeshFault {
        self.skip_blanks();
        let start = self.at;
        let word = self.word();
        match fast_float2::parse::<f64, _>(word) {
            Ok(value) if value.is_finite() => {
                MeshFault::in_text(start, format!("{} is too large: numbers go up to 3.4e38", shown(word)))
            }
            Ok(_) => MeshFault::in_text(start, format!("{} is not a finite number", shown(word))),
            Err(_) => {
                self.at = start;
                self.expected("a number")
            }
        }
    }

    /// Reads a word that must be an integer.
    #[inline]
    pub(super) fn integer(&mut self) -> Result<i64, MeshFault> {
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

    /// Reads an integer of at most 18 digits, which cannot overflow. Other characters may follow in
    /// the same word, as in `3/1`.
    #[inline]
    pub(super) fn digits(&mut self) -> Option<i64> {
        let negative = self.skip_byte(b'-');
        if !negative {
            self.skip_byte(b'+');
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

    /// Skips the next byte if it is `byte`. Returns whether it was.
    #[inline]
    pub(super) fn skip_byte(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    /// Returns a fault at the cursor: "expected `wanted`, found" the next word.
    #[cold]
    pub(super) fn expected(&mut self, wanted: &str) -> MeshFault {
        let is_line_end = self.is_at_line_end();
        let start = self.at;
        let found = match self.word() {
            _ if start >= self.bytes.len() => "the end of the file".to_owned(),
            _ if is_line_end => "the end of the line".to_owned(),
            word => shown(word),
        };
        MeshFault::in_text(start, format!("expected {wanted}, found {found}"))
    }
}

/// Returns the length of the line ending at the start of the bytes; 0 if there is none.
fn line_ending_len(bytes: &[u8]) -> usize {
    match bytes {
        [b'\r', b'\n', ..] => 2,
        [b'\n' | b'\r', ..] => 1,
        _ => 0,
    }
}

/// Returns the position of the first of some bytes from `start` on; the length if there is none.
#[inline]
fn find<const N: usize>(bytes: &[u8], start: usize, wanted: [u8; N]) -> usize {
    const LOWEST: u64 = 0x0101_0101_0101_0101;
    const HIGHEST: u64 = 0x8080_8080_8080_8080;
    let (blocks, rest) = bytes[start..].as_chunks::<8>();
    for (number, &block) in blocks.iter().enumerate() {
        let block = u64::from_le_bytes(block);
        // The highest bit of each byte that is 0, and maybe those of bytes behind it.
        let zeros = |bytes: u64| bytes.wrapping_sub(LOWEST) & !bytes & HIGHEST;
        let found = wanted.iter().fold(0, |found, &byte| found | zeros(block ^ (LOWEST * u64::from(byte))));
        if found != 0 {
            return start + 8 * number + found.trailing_zeros() as usize / 8;
        }
    }
    let at = rest.iter().position(|byte| wanted.contains(byte)).unwrap_or(rest.len());
    start + 8 * blocks.len() + at
}

/// Cuts a text from `start` on into pieces of about `size` bytes, each of which is whole lines.
///
/// Each but the first begins with a line for which `may_begin` is true, and which does not continue another.
pub(super) fn pieces(
    bytes: &[u8],
    start: usize,
    size: usize,
    may_begin: impl Fn(&mut TextCursor<'_>) -> bool,
) -> Vec<Range<usize>> {
    let mut pieces = Vec::new();
    let mut first = start;
    while first < bytes.len() {
        let mut end = first.saturating_add(size.max(1)).min(bytes.len());
        loop {
            end = find(bytes, end, [b'\n', b'\r']);
            // The search may begin between the two bytes of a line ending.
            let line_end = if bytes[..end].ends_with(b"\r") && bytes[end..].starts_with(b"\n") { end - 1 } else { end };
            let is_continued = bytes[..line_end].ends_with(b"\\");
            end += line_ending_len(&bytes[end..]);
            if end == bytes.len() || (!is_continued && may_begin(&mut TextCursor::starting_at(bytes, end))) {
                break;
            }
        }
        pieces.push(first..end);
        first = end;
    }
    pieces
}

/// Returns a text as UTF-8, if it begins with the byte order mark of UTF-16; other bytes unchanged.
///
/// Some programs on Windows write UTF-16. Lines and columns stay the same.
pub(super) fn without_utf16(bytes: &[u8]) -> Cow<'_, [u8]> {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return Cow::Borrowed(bytes),
    };
    let (units, _) = bytes[2..].as_chunks();
    let characters = char::decode_utf16(units.iter().map(|&bytes| unit(bytes)));
    let text: String = characters.map(|character| character.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Cow::Owned(text.into_bytes())
}
