//! Names of numbered files: `frame-%04d.png`.

use crate::cli::outcome::Failure;
use std::path::{Path, PathBuf};

/// A pattern for file names: the text before and after the number, and the number's least count of
/// digits.
#[derive(Debug, PartialEq)]
pub(super) struct NumberedFiles {
    before: String,
    digits: usize,
    after: String,
}

impl NumberedFiles {
    /// Parses a `printf` pattern with one `%d` or, padded with zeros, `%04d`; `%%` is a percent
    /// sign.
    ///
    /// All other directives, such as `%s`, are refused, and so is a width without a leading 0: the names would not sort
    /// by number.
    pub(super) fn parse(path: &Path) -> Result<Self, Failure> {
        let name = path.to_str().ok_or_else(|| wrong(path, "the name is not UTF-8"))?;
        let (mut before, mut after, mut digits) = (String::new(), String::new(), None);
        let mut rest = name;
        while let Some((text, sign)) = rest.split_once('%') {
            let part = if digits.is_none() { &mut before } else { &mut after };
            part.push_str(text);
            if let Some(behind) = sign.strip_prefix('%') {
                part.push('%');
                rest = behind;
            } else if let (None, Some((width, behind))) = (digits, sign.split_once('d')) {
                digits = Some(least_digits(width).ok_or_else(|| wrong(path, NUMBER))?);
                rest = behind;
            } else {
                return Err(wrong(path, NUMBER));
            }
        }
        let Some(digits) = digits else { return Err(wrong(path, &message_for_missing_number(path))) };
        after.push_str(rest);
        Ok(Self { before, digits, after })
    }

    /// Returns the name of file `number`.
    pub(super) fn file(&self, number: usize) -> PathBuf {
        let Self { before, digits, after } = self;
        format!("{before}{number:0digits$}{after}").into()
    }
}

const NUMBER: &str = "one %d or %04d must show where the frame's number goes; a percent sign is %%";

/// Parses the width between `%` and `d` as the least number of digits; `None` if it is not allowed.
fn least_digits(width: &str) -> Option<usize> {
    let is_number = width.bytes().all(|byte| byte.is_ascii_digit());
    match width.strip_prefix('0') {
        // The largest 64-bit number has 20 digits.
        Some(width) if is_number => width.parse().ok().filter(|digits| (1..=20).contains(digits)),
        _ => width.is_empty().then_some(1),
    }
}

fn message_for_missing_number(path: &Path) -> String {
    let stem = path.with_extension("");
    format!("each frame is a separate file; show where its number goes, as in {}-%04d.png", stem.display())
}

fn wrong(path: &Path, why: &str) -> Failure {
    Failure::Usage(format!("{}: {why}", path.display()))
}

#[cfg(all(test, unit_tests))]
mod tests;
