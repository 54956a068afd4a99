//! The tables: what each sequence takes, beside what is wanted. What misses it is bold.

use crate::Measured;
use crate::scenes::Kind;
use crate::seen::Outcome;
use std::iter;
use std::time::Duration;

/// The wanted bytes, as fractions of ratatui's: by size, then by kind.
struct Wanted([[f64; 4]; 2]);

const COLOR: Wanted = Wanted([[0.56, 0.52, 0.82, 0.63], [0.48, 0.45, 0.67, 0.49]]);
const RASTER: Wanted = Wanted([[0.71, 0.68, 0.92, 0.81], [0.64, 0.62, 0.90, 0.68]]);
const RASTER_ZLIB: Wanted = Wanted([[0.80, 0.80, 0.98, 0.88], [0.80, 0.78, 0.98, 0.95]]);
const EQUAL: Wanted = Wanted([[0.26, 0.16, 0.45, 0.24], [0.20, 0.12, 0.30, 0.17]]);
const FAST: Wanted = Wanted([[0.25, 0.11, 0.38, 0.18], [0.15, 0.09, 0.27, 0.12]]);

impl Wanted {
    /// For a sequence: a tenth more where it is not one of the four.
    fn of(&self, measured: &Measured) -> Option<f64> {
        let size = crate::SIZES.iter().position(|&size| size == measured.size)?;
        let kind = Kind::ALL.iter().position(|&kind| Some(kind) == measured.kind)?;
        Some(self.0[size][kind] * if measured.is_drawn { 1.1 } else { 1.0 })
    }
}

/// Prints the tables of some sequences of one size.
pub(crate) fn print(title: &str, sequences: &[Measured]) {
    bytes(title, sequences);
    times(title, sequences);
    qualities(title, sequences);
}

fn bytes(title: &str, sequences: &[Measured]) {
    head(&format!("{title}: bytes, of ratatui's (wanted)"), sequences);
    row("ratatui, bytes a frame", sequences, |m| format!("{:.0}", m.ratatui.raw));
    row("ratatui after zlib", sequences, |m| format!("{:.0}", m.ratatui.zlib));
    fractions("`color`", sequences, &COLOR, |m| m.color.raw / m.ratatui.raw);
    fractions("`raster`", sequences, &RASTER, |m| m.raster.raw / m.ratatui.raw);
    fractions("`raster` after zlib", sequences, &RASTER_ZLIB, |m| m.raster.zlib / m.ratatui.zlib);
    fractions("`equal`", sequences, &EQUAL, |m| m.equal.mean / m.ratatui.raw);
    fractions("`fast`", sequences, &FAST, |m| m.fast.mean / m.ratatui.raw);
}

fn times(title: &str, sequences: &[Measured]) {
    head(&format!("{title}: CPU time, of ratatui's (at most)"), sequences);
    row("ratatui, us a frame", sequences, |m| format!("{:.0}", m.times[0]));
    for (at, name, limit) in [(1, "`color`", 3.3), (2, "`raster`", 1.0), (3, "`equal`", 6.0), (4, "`fast`", 6.0)] {
        row(&format!("{name} ({limit})"), sequences, |m| {
            let time = m.times[at] / m.times[0];
            marked(format!("{time:.2}"), time <= limit)
        });
    }
}

fn qualities(title: &str, sequences: &[Measured]) {
    head(&format!("{title}: what is seen"), sequences);
    quality("`equal`", sequences, (44.0, 0.01), |m| &m.equal);
    quality("`fast`", sequences, (41.0, 0.02), |m| &m.fast);
}

fn quality(name: &str, sequences: &[Measured], caps: (f64, f32), of: impl Fn(&Measured) -> &Outcome) {
    let (psnr, distance) = caps;
    row(&format!("{name}: PSNR, worst frame (at least {psnr} dB)"), sequences, |m| {
        marked(format!("{:.2}", of(m).psnr_of_worst), of(m).psnr_of_worst >= psnr)
    });
    row(&format!("{name}: PSNR, all frames"), sequences, |m| format!("{:.2}", of(m).psnr));
    row(&format!("{name}: OKLab distance (at most {distance})"), sequences, |m| {
        marked(format!("{:.4}", of(m).distance), of(m).distance <= distance)
    });
    row(&format!("{name}: last change to rest, in full frames (at most 1.5)"), sequences, |m| {
        marked(format!("{:.2}", of(m).rest_in_frames), of(m).rest_in_frames <= 1.5)
    });
    row(&format!("{name}: of these, after the last frame"), sequences, |m| format!("{:.2}", of(m).due_in_frames));
    row(&format!("{name}: last change to rest (at most 1 s)"), sequences, |m| {
        marked(format!("{:.2} s", of(m).rest.as_secs_f64()), of(m).rest <= Duration::from_secs(1))
    });
    row(&format!("{name}: exact then"), sequences, |m| yes(of(m).is_exact));
}

fn head(title: &str, sequences: &[Measured]) {
    let names = sequences.iter().map(|measured| measured.name.as_str());
    println!("\n| {} |", iter::once(title).chain(names).collect::<Vec<_>>().join(" | "));
    println!("|---|{}", "--:|".repeat(sequences.len()));
}

fn row(name: &str, sequences: &[Measured], value: impl Fn(&Measured) -> String) {
    let values = sequences.iter().map(value);
    println!("| {} |", iter::once(name.to_owned()).chain(values).collect::<Vec<_>>().join(" | "));
}

/// Fractions, each judged by its first two decimals, rounded.
fn fractions(name: &str, sequences: &[Measured], wanted: &Wanted, value: impl Fn(&Measured) -> f64) {
    row(name, sequences, |measured| limited(value(measured), wanted.of(measured).unwrap_or(f64::INFINITY)));
}

/// A fraction with what is wanted of it, if anything is.
pub(crate) fn limited(value: f64, wanted: f64) -> String {
    if wanted.is_infinite() {
        return format!("{value:.3}");
    }
    marked(format!("{value:.3} ({wanted:.2})"), (value * 100.0).round() <= wanted * 100.0 + 1e-9)
}

/// Returns "yes" or "no", the latter marked as a fault.
pub(crate) fn yes(is_so: bool) -> String {
    marked(if is_so { "yes" } else { "no" }.into(), is_so)
}

fn marked(text: String, is_within: bool) -> String {
    if is_within { text } else { format!("**{text}**") }
}
