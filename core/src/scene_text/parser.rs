//! The parser: tokens to a syntax tree.
//!
//! It stops at the first fault, because after a missing bracket the meaning of the rest is unknown.

use super::fault::{clipped, line_and_column, quoted};
use super::tokens::{RonToken, RonTokens};
use super::{Body, Fault, Field, Group, MAX_NESTING, Name, Span, SyntaxNode, Value};
use crate::progress::{Meter, Reporter, Unfinished};

/// Parses the single value of a text.
///
/// # Errors
/// The first fault, if the text is not RON.
pub fn parse(text: &str) -> Result<SyntaxNode<'_>, Fault> {
    parse_or_cancel(text, Meter::new(&Reporter::silent(), "", text.len())).map_err(Unfinished::failure)
}

/// Parses as [`parse`] does, and reports progress to `meter`, whose callback may cancel the work.
pub(super) fn parse_or_cancel<'a>(text: &'a str, meter: Meter<'_>) -> Parsed<SyntaxNode<'a>> {
    let mut tokens = RonTokens::new(text);
    tokens.skip_attributes()?;
    let (next, span) = tokens.next()?;
    let mut parser = RonParser { text, tokens, next, span, previous_end: 0, open: Vec::new(), misaligned: None, meter };
    if parser.next == RonToken::End {
        let message = "there is nothing here but comments or white space".to_owned();
        return Err(Fault { message, span: Span::empty_at(text.len()) }.into());
    }
    let root = parser.parse_value()?;
    match parser.next {
        RonToken::End => Ok(root),
        _ => Err(parser.fault_here(format!("unexpected {} where the file should end", parser.describe_next()))),
    }
}

struct RonParser<'a, 'm> {
    text: &'a str,
    meter: Meter<'m>,
    tokens: RonTokens<'a>,
    /// The next token; `span` is its range.
    next: RonToken<'a>,
    span: Span,
    previous_end: u32,
    /// The open brackets and their spans.
    open: Vec<(char, Span)>,
    /// The first bracket whose closing bracket starts a line, with another indentation than the
    /// opening bracket's line.
    ///
    /// If a closing bracket is missing at the end of the text, it is most likely that of this bracket. The bracket that
    /// is still open gives no hint: each closing bracket closes the innermost open one, so an outermost bracket is left
    /// open.
    misaligned: Option<(char, Span)>,
}

type Parsed<T> = Result<T, Unfinished<Fault>>;

impl<'a> RonParser<'a, '_> {
    fn advance(&mut self) -> Parsed<RonToken<'a>> {
        let (next, span) = self.tokens.next()?;
        self.previous_end = self.span.end;
        self.span = span;
        Ok(std::mem::replace(&mut self.next, next))
    }

    /// Returns whether the token after `next` is a colon, so that `next` is a field's name.
    fn colon_follows(&self) -> bool {
        // Looks ahead with a copy of the lexer, which is only a position in the text.
        let mut tokens = self.tokens;
        matches!(tokens.next(), Ok((RonToken::Colon, _)))
    }

    fn parse_value(&mut self) -> Parsed<SyntaxNode<'a>> {
        let start = self.span.start;
        self.meter.advance_to(start as usize)?;
        let value = match self.next {
            RonToken::Word(word) => return self.parse_word(word),
            RonToken::Open('(') => Value::Group(Box::new(Group { name: None, body: self.parse_body()? })),
            RonToken::Open('[') => {
                self.open_bracket()?;
                let items = self.parse_items()?;
                self.close_bracket()?;
                Value::List(items)
            }
            RonToken::Open(_) => {
                self.open_bracket()?;
                let entries = self.parse_entries()?;
                self.close_bracket()?;
                Value::Map(entries)
            }
            RonToken::Number(number) => {
                self.advance()?;
                Value::Number(number)
            }
            // `advance` returns the token itself, so that the string is not copied.
            RonToken::String(_) => match self.advance()? {
                RonToken::String(string) => Value::String(string),
                _ => Value::String(Box::default()),
            },
            _ => return Err(self.fault_here(self.no_value_message())),
        };
        Ok(self.node(start, value))
    }

    fn node(&self, start: u32, value: Value<'a>) -> SyntaxNode<'a> {
        let span = Span { start, end: self.previous_end };
        SyntaxNode { span, value }
    }

    fn parse_word(&mut self, word: &'a str) -> Parsed<SyntaxNode<'a>> {
        let span = self.span;
        self.advance()?;
        let value = match (word, &self.next) {
            ("true", _) => Value::Bool(true),
            ("false", _) => Value::Bool(false),
            (_, RonToken::Open('{')) => {
                return Err(self.fault_here(format!("expected `(` after {}, found `{{`", quoted_word(word))));
            }
            (_, RonToken::Open('(')) => return self.parse_named_group(Name { text: word, span }),
            _ => Value::Group(Box::new(Group { name: Some(Name { text: word, span }), body: Body::Nothing })),
        };
        Ok(self.node(span.start, value))
    }

    /// Parses `Name(...)`. `Some(x)` becomes x, as with RON's extension `implicit_some`.
    fn parse_named_group(&mut self, name: Name<'a>) -> Parsed<SyntaxNode<'a>> {
        let body = self.parse_body()?;
        if let ("Some", Body::Values(values)) = (name.text, &body)
            && let [inner] = &values[..]
        {
            // The value is copied, because `body` is only borrowed here. The cost does not matter: `Some(...)` is rare
            // in scenes.
            return Ok(inner.clone());
        }
        let group = Group { name: Some(name), body };
        Ok(self.node(name.span.start, Value::Group(Box::new(group))))
    }

    /// Parses `(...)`: fields if the first entry is a field, otherwise values.
    fn parse_body(&mut self) -> Parsed<Body<'a>> {
        self.open_bracket()?;
        let body = if matches!(self.next, RonToken::Word(_)) && self.colon_follows() {
            Body::Fields(self.parse_fields()?)
        } else {
            Body::Values(self.parse_items()?)
        };
        self.close_bracket()?;
        Ok(body)
    }

    fn parse_items(&mut self) -> Parsed<Vec<SyntaxNode<'a>>> {
        let mut items = Vec::new();
        while !self.at_end() {
            items.push(self.parse_value()?);
            // A name after items without names. Without this check, the message would be that a comma is missing.
            if matches!(self.next, RonToken::Colon) {
                return Err(
                    self.fault_here("unexpected `:`; all values in these brackets have names, or none has".to_owned())
                );
            }
            if !self.skip_comma()? {
                break;
            }
        }
        Ok(items)
    }

    fn parse_entries(&mut self) -> Parsed<Vec<(SyntaxNode<'a>, SyntaxNode<'a>)>> {
        let mut entries = Vec::new();
        while !self.at_end() {
            let key = self.parse_value()?;
            if self.next != RonToken::Colon {
                return Err(self.fault_here(format!("expected `:` and a value, found {}", self.describe_next())));
            }
            self.advance()?;
            entries.push((key, self.parse_value()?));
            if !self.skip_comma()? {
                break;
            }
        }
        Ok(entries)
    }

    fn parse_fields(&mut self) -> Parsed<Vec<Field<'a>>> {
        let mut fields = Vec::new();
        while !self.at_end() {
            let RonToken::Word(text) = self.next else {
                let hint = if self.next == RonToken::Comma { "; is it one comma too many?" } else { "" };
                return Err(
                    self.fault_here(format!("expected the name of a field, found {}{hint}", self.describe_next()))
                );
            };
            let name = Name { text, span: self.span };
            self.advance()?;
            if self.next != RonToken::Colon {
                return Err(self.no_colon_fault(name));
            }
            self.advance()?;
            fields.push(Field { name, value: self.parse_value()? });
            if !self.skip_comma()? {
                break;
            }
        }
        Ok(fields)
    }

    fn at_end(&self) -> bool {
        matches!(self.next, RonToken::Close(_) | RonToken::End)
    }

    /// Skips a comma and returns whether there was one.
    fn skip_comma(&mut self) -> Parsed<bool> {
        let comma = self.next == RonToken::Comma;
        if comma {
            self.advance()?;
        }
        Ok(comma)
    }

    fn open_bracket(&mut self) -> Parsed<()> {
        // The depth is checked where brackets open, so that every path of the recursion is bounded.
        if self.open.len() == MAX_NESTING {
            return Err(self.fault_here(format!("brackets are nested more than {MAX_NESTING} deep")));
        }
        if let RonToken::Open(bracket) = self.next {
            self.open.push((bracket, self.span));
        }
        self.advance()?;
        Ok(())
    }

    /// Moves past the bracket that closes the innermost open one.
    fn close_bracket(&mut self) -> Parsed<()> {
        let Some(&(bracket, opened)) = self.open.last() else {
            return Ok(());
        };
        if self.next != RonToken::Close(closing_bracket(bracket)) {
            return Err(self.not_closed_fault(bracket, opened));
        }
        if self.misaligned.is_none() && self.is_misaligned(opened) {
            self.misaligned = Some((bracket, opened));
        }
        self.open.pop();
        self.advance()?;
        Ok(())
    }

    /// Returns whether the next token starts a line, with another indentation than the line of the
    /// bracket `opened`.
    fn is_misaligned(&self, opened: Span) -> bool {
        let line_before = |at: u32| self.text[..at as usize].rsplit('\n').next().unwrap_or_default();
        // More than 1000 bytes of white space do not count as indentation: scanning them for every token would take
        // quadratic time.
        if self.span.start - opened.end < 2 || self.span.start - self.previous_end > 1000 {
            return false;
        }
        let between = &self.text[self.previous_end as usize..self.span.start as usize];
        if !between.contains('\n') || !line_before(self.span.start).trim().is_empty() {
            return false;
        }
        let opening_line = line_before(opened.start);
        let indentation = opening_line.len() - opening_line.trim_start().len();
        indentation != line_before(self.span.start).len()
    }

    // Messages --------------------------------------------------------------------------------------------------------

    /// Returns a fault at the next token.
    fn fault_here(&self, message: String) -> Unfinished<Fault> {
        Fault { message, span: self.span }.into()
    }

    fn describe_next(&self) -> String {
        match &self.next {
            RonToken::Open(c) | RonToken::Close(c) | RonToken::Other(c) => format!("`{c}`"),
            RonToken::Comma => "`,`".to_owned(),
            RonToken::Colon => "`:`".to_owned(),
            RonToken::Word(word) => quoted_word(word),
            RonToken::Number(_) => "a number".to_owned(),
            RonToken::String(string) => format!("the string {}", quoted(string)),
            RonToken::End => "the end of the file".to_owned(),
        }
    }

    fn no_value_message(&self) -> String {
        match self.next {
            RonToken::Other('#') => "unexpected `#`; a colour is written in quotes, as in \"#ff8800\"".to_owned(),
            RonToken::Comma if !self.text[..self.previous_end as usize].ends_with(':') => {
                "expected a value, found `,`; is it one comma too many?".to_owned()
            }
            _ => format!("expected a value, found {}", self.describe_next()),
        }
    }

    /// Returns a fault: a colon is missing after a field's name, or a closing bracket before the
    /// name.
    fn no_colon_fault(&self, name: Name<'_>) -> Unfinished<Fault> {
        let word = quoted_word(name.text);
        match (&self.next, self.open.last()) {
            (RonToken::Other('='), _) => self.fault_here(format!("expected `:` after {word}, found `=`")),
            (RonToken::Open(_), Some(&(bracket, opened))) => {
                let message = format!(
                    "expected a field, found {word}; is a `{}` missing before it, for the `{bracket}` at {}?",
                    closing_bracket(bracket),
                    self.line_and_column_text(opened),
                );
                Fault { message, span: name.span }.into()
            }
            _ => self.fault_here(format!("expected `:` after {word}, found {}", self.describe_next())),
        }
    }

    /// Returns a fault: the next token is neither a comma nor the bracket that closes `bracket`.
    fn not_closed_fault(&self, bracket: char, opened: Span) -> Unfinished<Fault> {
        let right = closing_bracket(bracket);
        match self.next {
            RonToken::End => {
                let (bracket, span) = self.misaligned.unwrap_or((bracket, opened));
                let message = format!("this `{bracket}` is never closed by a `{}`", closing_bracket(bracket));
                Fault { message, span }.into()
            }
            RonToken::Close(wrong) => {
                let opened = self.line_and_column_text(opened);
                self.fault_here(format!(
                    "expected `{right}`, found `{wrong}`; the `{bracket}` at {opened} is still open"
                ))
            }
            RonToken::Other(other) => self.fault_here(format!("expected `,` or `{right}`, found `{other}`")),
            _ => {
                let message = format!("expected `,` or `{right}` before {}", self.describe_next());
                Fault { message, span: Span::empty_at(self.previous_end as usize) }.into()
            }
        }
    }

    fn line_and_column_text(&self, span: Span) -> String {
        let (line, column) = line_and_column(self.text, span.start as usize);
        format!("{line}:{column}")
    }
}

fn closing_bracket(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// Returns a word of the file's text for a message, [`clipped`] and in backticks.
fn quoted_word(word: &str) -> String {
    format!("`{}`", clipped(word))
}
