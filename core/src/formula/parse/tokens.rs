//! The tokens of a formula.

use super::FormulaFault;
use crate::text::visible_char;
use std::ops::Range;

/// A token, without its text, whose range in the formula is in [`FormulaTokens`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FormulaToken {
    Number(f64),
    Name,
    /// An operator or a bracket.
    Sign(char),
    End,
}

/// The tokens of a formula, and a position among them.
pub(super) struct FormulaTokens<'t> {
    text: &'t str,
    all: Vec<(FormulaToken, Range<usize>)>,
    at: usize,
}

impl<'t> FormulaTokens<'t> {
    pub(super) fn new(text: &'t str) -> Result<Self, FormulaFault> {
        let (mut tokens, mut at) = (Vec::new(), 0);
        while let Some(c) = text[at..].chars().next() {
            let start = at;
            let token = match c {
                _ if c.is_whitespace() => {
                    at += c.len_utf8();
                    continue;
                }
                '0'..='9' | '.' => {
                    at += number_length(&text[at..]);
                    FormulaToken::Number(number(&text[start..at], start..at)?)
                }
                'a'..='z' | 'A'..='Z' | '_' => {
                    at += length_while(&text[at..], |c| c.is_ascii_alphanumeric() || c == '_');
                    FormulaToken::Name
                }
                '+' | '-' | '*' | '/' | '^' | '(' | ')' | '|' | ',' | ';' | '=' => {
                    at += 1;
                    FormulaToken::Sign(c)
                }
                _ => {
                    let message = format!("`{}` is not part of a formula", visible_char(c));
                    return FormulaFault::new(at..at + c.len_utf8(), message);
                }
            };
            tokens.push((token, start..at));
        }
        tokens.push((FormulaToken::End, text.len()..text.len()));
        Ok(Self { text, all: tokens, at: 0 })
    }

    pub(super) fn token(&self) -> FormulaToken {
        self.all[self.at].0
    }

    pub(super) fn range(&self) -> Range<usize> {
        self.all[self.at].1.clone()
    }

    pub(super) fn text(&self) -> &'t str {
        &self.text[self.range()]
    }

    /// Returns the text of the token before the current one; `None` at the first.
    pub(super) fn before(&self) -> Option<&'t str> {
        let (_, range) = self.all.get(self.at.checked_sub(1)?)?;
        Some(&self.text[range.clone()])
    }

    pub(super) fn is_sign(&self, sign: char) -> bool {
        self.token() == FormulaToken::Sign(sign)
    }

    /// Goes to the next token, unless the current one is the end.
    pub(super) fn advance(&mut self) {
        self.at = (self.at + 1).min(self.all.len() - 1);
    }

    /// Returns whether a definition `name = ...;` starts at the current token.
    pub(super) fn starts_definition(&self) -> bool {
        let mut rest = self.all[self.at..].iter().map(|&(token, _)| token);
        rest.next() == Some(FormulaToken::Name)
            && rest.next() == Some(FormulaToken::Sign('='))
            // Without a semicolon `x = 1` is an equation.
            && rest.any(|token| token == FormulaToken::Sign(';'))
    }
}

fn length_while(text: &str, belongs: impl Fn(char) -> bool) -> usize {
    text.find(|c| !belongs(c)).unwrap_or(text.len())
}

/// Returns the length of the number at the start of the text, with its exponent.
fn number_length(text: &str) -> usize {
    let digits = length_while(text, |c| c.is_ascii_digit() || c == '.');
    let exponent = text[digits..].strip_prefix(['e', 'E']).map(|rest| rest.strip_prefix(['+', '-']).unwrap_or(rest));
    match exponent {
        // In `2e` and `2exp(x)` the `e` begins a name: the fault is the missing operator.
        Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit()) => {
            text.len() - rest.len() + length_while(rest, |c| c.is_ascii_digit())
        }
        _ => digits,
    }
}

fn number(text: &str, range: Range<usize>) -> Result<f64, FormulaFault> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => FormulaFault::new(range, "this number is too large"),
        Err(_) => FormulaFault::new(range, format!("`{text}` is not a number")),
    }
}
