//! `frame --check`: compares the frame with a file and prints a diff if they differ.

use crate::cli::outcome::{CommandResult, Failure, write_stdout};
use crate::cli::outputs;
use std::io;
use std::path::Path;
use termtrace::export::Format;
use termtrace::internals::export::GoldenDifference;
use termtrace::internals::named_file::{self, Accepted};
use termtrace::internals::progress::Reporter;
use termtrace::internals::text::visible;

/// Limit on the bytes of a golden frame, as for a scene file; or four times the size of the frame
/// to
/// compare, if that is larger. A larger file shows another picture, and the diff would be as long as the file.
const MAX_GOLDEN_BYTES: usize = 16 << 20;

/// Returns `Ok` if the file contains exactly the bytes `frame`; otherwise prints a diff to standard
/// output and fails.
pub(super) fn check(path: &Path, format: Format, frame: &[u8]) -> CommandResult {
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
    write_stdout(format!("{name}: the frame differs\n{text}").as_bytes())?;
    Err(Failure::Reported(1))
}
