//! `frame --check`: compares the frame with a file and prints a diff if they differ.

use crate::cli::outcome::{CommandResult, Failure, write_stdout};
use crate::cli::outputs;
use std::io;
use std::path::Path;
use termtrace::Glyphs;
use termtrace::export::Format;
use termtrace::internals::cell::RAMP;
use termtrace::internals::export::GoldenDifference;
use termtrace::internals::named_file::{self, Accepted};
use termtrace::internals::progress::Reporter;
use termtrace::internals::text::visible;

/// Limit on the bytes of a golden frame, as for a scene file.
///
/// For a large frame the limit is four times the size of the frame to compare. A larger file shows another picture, and
/// the diff would be as long as the file.
const MAX_GOLDEN_BYTES: usize = 16 << 20;

/// Returns `Ok` if the file contains exactly the bytes `frame`; otherwise prints a diff to standard
/// output and fails.
pub(super) fn check(path: &Path, format: Format, frame: &[u8]) -> CommandResult {
    // With a limit, a wrong path such as `/dev/zero` does not fill the memory.
    let most = MAX_GOLDEN_BYTES.max(4 * frame.len());
    let golden = named_file::read(path, Accepted::FilesAndPipes, |_| most, &Reporter::silent()).map_err(|error| {
        let reason = match error.kind() {
            io::ErrorKind::NotFound => "no such golden frame; --bless writes it".to_owned(),
            _ => named_file::reason(&error),
        };
        Failure::runtime(path.display(), reason)
    })?;
    if golden == frame {
        return Ok(());
    }
    let name = visible(&path.display().to_string());
    let GoldenDifference { mut text, picture } = format.difference(&golden, frame);
    if let Some(picture) = picture {
        let beside = path.with_extension(format!("diff.{}", format.extension()));
        outputs::write(&beside, &picture)?;
        text.push_str("a picture of the difference: ");
        text.push_str(&visible(&beside.display().to_string()));
        text.push('\n');
    }
    if let Some(hint) = glyphs_hint(&golden, frame).filter(|_| format == Format::Text) {
        text.push_str(&hint);
        text.push('\n');
    }
    write_stdout(format!("{name}: the frame differs\n{text}").as_bytes())?;
    Err(Failure::Reported(1))
}

/// The characters of [`RAMP`] in the order that text frames of earlier versions had.
const RAMP_BEFORE: &[u8; RAMP.len()] = b" .:-=+*#%@";

/// Returns whether a byte of an earlier version's ramp and one of today's can be equally light.
// The steps began at a lightness of 10, 20, ... 90, and begin at 8, 18, ... 88: a character is at the same place in the
// ramp, or at the next one. Another picture is seldom so everywhere.
fn can_be_equally_light(before: u8, now: u8) -> bool {
    let place = |ramp: &[u8; RAMP.len()], byte: u8| ramp.iter().position(|&of_ramp| of_ramp == byte);
    match (place(RAMP_BEFORE, before), place(RAMP, now)) {
        (Some(before), Some(now)) => (before..=before + 1).contains(&now),
        _ => before == now,
    }
}

/// Returns advice if the golden text frame seems to differ only by its glyphs: their kind, or the
/// characters of the ramp.
fn glyphs_hint(golden: &[u8], frame: &[u8]) -> Option<String> {
    let is_of_ramp = probable_glyphs(frame) == Some(Glyphs::Ramp);
    let can_be_same = || golden.iter().zip(frame).all(|(&before, &now)| can_be_equally_light(before, now));
    if is_of_ramp && golden.len() == frame.len() && can_be_same() {
        return Some("it seems that only the ramp's characters have changed; --bless writes the frame anew".to_owned());
    }
    let kind = probable_glyphs(golden).filter(|&kind| Some(kind) != probable_glyphs(frame))?;
    Some(format!("the golden frame has the characters of --glyphs {kind}: compare it with that flag"))
}

/// Returns the kind of glyphs that a text frame probably has, if its characters tell.
fn probable_glyphs(text: &[u8]) -> Option<Glyphs> {
    if text.iter().all(|byte| *byte == b'\n' || RAMP.contains(byte)) {
        Some(Glyphs::Ramp)
    } else if !text.is_ascii() {
        std::str::from_utf8(text).is_ok_and(|text| text.chars().all(|c| " ▀▄█\n".contains(c))).then_some(Glyphs::Half)
    } else {
        // The fills of `ascii` have the letters o, x and X, its outlines have none, and neither has digits.
        let is_of_shape = |byte: &u8| byte.is_ascii_alphanumeric() && !b"oxX".contains(byte);
        Some(if text.iter().any(is_of_shape) { Glyphs::Shape } else { Glyphs::Ascii })
    }
}
