//! The difference of a lossy way's screens from the wanted pictures, and the cost until all is
//! exact.
//!
//! By the screens of an emulator, not by the encoder's own account.

use crate::send::{self, Lossy, encoder, time_of};
use std::num::NonZeroU16;
use std::time::Duration;
use termtrace::internals::cell::grid_from_picture;
use termtrace::internals::color::Oklab;
use termtrace::{CellMode, Order, Picture, Quality, Srgb8};

/// The result of a sequence.
pub(crate) struct Outcome {
    /// Bytes a frame after the first, in the mean, those that made the last one exact counted in.
    pub(crate) mean: f64,
    /// Peak signal-to-noise ratio of the worst frame, in decibels.
    pub(crate) psnr_of_worst: f64,
    /// The PSNR of all frames together.
    pub(crate) psnr: f64,
    /// The largest distance of any half cell in any frame, in `OKLab`.
    pub(crate) distance: f32,
    /// The bytes from the last change to rest, in frames drawn whole and exactly.
    pub(crate) rest_in_frames: f64,
    /// The part of them that was sent after the frame of the last change.
    pub(crate) due_in_frames: f64,
    /// The time from the last change until no more is sent.
    pub(crate) rest: Duration,
    /// Whether the screen is exact then.
    pub(crate) is_exact: bool,
}

/// Sends the sequence, and its last frame again for as long as anything is due.
pub(crate) fn outcome(quality: Quality, frames: &[Picture]) -> Outcome {
    let (mut lossy, mut screen, mut errors) = (Lossy::new(quality), Screen::new(&frames[0]), Errors::default());
    let mut sizes = Vec::new();
    for (k, picture) in frames.iter().enumerate() {
        let bytes = lossy.send(picture, time_of(k));
        sizes.push(bytes.len());
        screen.feed(bytes);
        errors.note(&screen.pixels(), picture.pixels());
    }
    let (last, end) = (&frames[frames.len() - 1], time_of(frames.len() - 1));
    let mut rest = end;
    let mut after_last = 0;
    for _ in 0..MOST_DUE {
        let Some(due) = lossy.due() else { break };
        rest = due;
        let bytes = lossy.send(last, due);
        after_last += bytes.len();
        screen.feed(bytes);
    }
    let last_size = sizes.last_mut().expect("there are frames");
    *last_size += after_last;
    let whole = whole(last) as f64;
    Outcome {
        rest_in_frames: *last_size as f64 / whole,
        due_in_frames: after_last as f64 / whole,
        mean: send::mean(&sizes),
        psnr_of_worst: psnr(errors.worst),
        psnr: psnr(errors.sum / errors.frames),
        distance: errors.distance,
        rest: rest.saturating_sub(end),
        is_exact: lossy.due().is_none() && screen.pixels() == last.pixels(),
    }
}

/// More often than this nothing should be due: 30 times in the second that it may take.
const MOST_DUE: usize = 30;

/// The bytes of a picture where nothing is known of the screen.
fn whole(picture: &Picture) -> usize {
    let mut bytes = Vec::new();
    encoder(Order::Color).encode(&grid_from_picture(CellMode::HALF_BLOCK, picture), &mut bytes);
    bytes.len()
}

/// Mean squares of the differences of 8-bit bands, and the largest distance.
#[derive(Default)]
struct Errors {
    frames: f64,
    sum: f64,
    worst: f64,
    distance: f32,
}

impl Errors {
    fn note(&mut self, shown: &[Srgb8], wanted: &[Srgb8]) {
        let differing = || shown.iter().zip(wanted).filter(|(shown, wanted)| shown != wanted);
        let bands = |a: Srgb8, b: Srgb8| [a.r.abs_diff(b.r), a.g.abs_diff(b.g), a.b.abs_diff(b.b)];
        let squares = differing().flat_map(|(&a, &b)| bands(a, b)).map(|band| f64::from(u32::from(band).pow(2)));
        let mean = squares.sum::<f64>() / (3 * wanted.len()) as f64;
        self.frames += 1.0;
        self.sum += mean;
        self.worst = self.worst.max(mean);
        for (&a, &b) in differing() {
            self.distance = self.distance.max(Oklab::from_srgb8(a).distance(Oklab::from_srgb8(b)));
        }
    }
}

/// Returns the PSNR in decibels; infinite for equal pictures.
pub(crate) fn psnr(mean_square: f64) -> f64 {
    10.0 * libm::log10(255.0 * 255.0 / mean_square)
}

/// The screen of a terminal.
pub(crate) struct Screen(vt100::Parser);

impl Screen {
    pub(crate) fn new(picture: &Picture) -> Self {
        let side = |cells: u32| NonZeroU16::new(cells as u16).expect("a screen has cells");
        Self(vt100::Parser::new(side(picture.height() / 2), side(picture.width()), 0))
    }

    pub(crate) fn feed(&mut self, bytes: &[u8]) {
        self.0.process(bytes);
    }

    /// Returns the pixels in the picture's order: row by row from the top.
    pub(crate) fn pixels(&self) -> Vec<Srgb8> {
        let (rows, columns) = self.0.screen().size();
        let line = |row, half: usize| (0..columns.get()).map(move |column| self.halves(column, row)[half]);
        (0..rows.get()).flat_map(|row| line(row, 0).chain(line(row, 1))).collect()
    }

    fn halves(&self, column: u16, row: u16) -> [Srgb8; 2] {
        let cell = self.0.screen().cell(row, column).expect("the cell is on the screen");
        let color = |color| match color {
            vt100::Color::Rgb(r, g, b) => Srgb8::new(r, g, b),
            other => panic!("({column}, {row}) is {other:?}"),
        };
        match cell.contents() {
            " " => [color(if cell.inverse() { cell.fgcolor() } else { cell.bgcolor() }); 2],
            "▄" => [color(cell.bgcolor()), color(cell.fgcolor())],
            "▀" => [color(cell.fgcolor()), color(cell.bgcolor())],
            other => panic!("({column}, {row}) is {other:?}"),
        }
    }
}
