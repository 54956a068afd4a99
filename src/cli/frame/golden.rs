//! `frame --check`: is the frame the one in the file, and if not, where do they differ?

use super::Format;
use crate::cli::outcome::{Done, Failure, write_stdout};
use similar::TextDiff;
use std::fmt::Write;
use std::io;
use std::path::Path;
use termtrace::named_file::{self, Accepted};
use termtrace::progress::Watcher;
use termtrace::text::{visible, visible_lines};

/// The most bytes that a golden frame has: 16 MiB, as any text that is read, or four times as many as the frame that it is
/// compared with. A larger one is of another picture, and its diff would be as long.
const MAX_BYTES: usize = 16 << 20;

/// Done if the file holds exactly this frame; else a diff goes to standard output.
pub(super) fn check(path: &Path, format: Format, frame: &[u8]) -> Done {
    let most = MAX_BYTES.max(4 * frame.len());
    let golden = named_file::read(path, Accepted::FilesAndPipes, |_| most, &Watcher::patient()).map_err(|error| {
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
    let difference = match format {
        Format::Text | Format::Svg | Format::Html => text_difference(&golden, frame, &name),
        Format::Ansi => ansi_difference(&golden, frame),
        Format::Png => png_difference(&golden, frame),
    };
    write_stdout(format!("{name}: the frame differs\n{difference}").as_bytes())?;
    Err(Failure::Said(1))
}

/// Line by line, as `diff -u`.
fn text_difference(golden: &[u8], frame: &[u8], name: &str) -> String {
    let [golden, frame] = [golden, frame].map(String::from_utf8_lossy);
    let difference = TextDiff::from_lines(&*golden, &*frame);
    // A golden file may be anything.
    visible_lines(&difference.unified_diff().context_radius(1).header(name, "this frame").to_string())
}

/// The rows that differ, and where each begins to.
fn ansi_difference(golden: &[u8], frame: &[u8]) -> String {
    let rows = |bytes: &[u8]| -> Vec<Vec<u8>> { bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect() };
    let (golden, frame) = (rows(golden), rows(frame));
    let mut difference = String::new();
    for row in 0..golden.len().max(frame.len()) {
        let line = match (golden.get(row), frame.get(row)) {
            (Some(a), Some(b)) if a == b => continue,
            (Some(a), Some(b)) => format!("row {row}: differs from column {} on", column_of_difference(a, b)),
            (Some(_), None) => format!("row {row}: only in the golden frame"),
            _ => format!("row {row}: only in this frame"),
        };
        let _ = writeln!(difference, "{line}");
    }
    difference
}

/// How many characters, escape sequences not counted, stand before the first difference.
fn column_of_difference(a: &[u8], b: &[u8]) -> usize {
    let same = a.iter().zip(b).take_while(|(a, b)| a == b).count();
    // Characters may have their first bytes in common.
    let same = (0..=same).rfind(|&at| a.get(at).is_none_or(|byte| byte & 0xc0 != 0x80)).unwrap_or(0);
    let mut columns = 0;
    let mut in_escape = false;
    for &byte in &a[..same] {
        match byte {
            0x1b => in_escape = true,
            b'm' if in_escape => in_escape = false,
            // Only the first byte of each character counts.
            _ if !in_escape && byte & 0xc0 != 0x80 => columns += 1,
            _ => {}
        }
    }
    columns
}

/// How many pixels differ, by how much, and the first of them.
fn png_difference(golden: &[u8], frame: &[u8]) -> String {
    let (golden, frame) = match (decoded(golden), decoded(frame)) {
        (Ok(golden), Ok(frame)) => (golden, frame),
        (Err(error), _) | (_, Err(error)) => return format!("the golden frame is not a PNG of 8-bit RGB: {error}\n"),
    };
    if (golden.width, golden.height) != (frame.width, frame.height) {
        return format!(
            "the golden frame has {}x{} pixels, this frame {}x{}\n",
            golden.width, golden.height, frame.width, frame.height
        );
    }
    let pixels = || golden.rgb.chunks_exact(3).zip(frame.rgb.chunks_exact(3)).enumerate();
    let count = pixels().filter(|(_, (a, b))| a != b).count();
    let largest = golden.rgb.iter().zip(&frame.rgb).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    let Some((first, (a, b))) = pixels().find(|(_, (a, b))| a != b) else {
        return "the pixels are equal; only what the files say beside them differs\n".to_owned();
    };
    let (x, y) = (first % golden.width, first / golden.width);
    format!(
        "{count} of {} pixels differ, by at most {largest} of 255\nfirst: pixel ({x}, {y}) was {a:?}, is {b:?}\n",
        golden.width * golden.height
    )
}

struct Decoded {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

fn decoded(bytes: &[u8]) -> Result<Decoded, String> {
    let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().map_err(|error| error.to_string())?;
    let mut rgb = vec![0; reader.output_buffer_size().ok_or("too large")?];
    let info = reader.next_frame(&mut rgb).map_err(|error| error.to_string())?;
    if (info.color_type, info.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
        return Err(format!("it has {:?} of {:?}", info.color_type, info.bit_depth));
    }
    Ok(Decoded { width: info.width as usize, height: info.height as usize, rgb })
}
