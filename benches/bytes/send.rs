//! The ways to send a sequence, ratatui's own backend and ours: their bytes and CPU time.

use flate2::{Compress, Compression, FlushCompress};
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::{Terminal, TerminalOptions, Viewport};
use ratatui_crossterm::CrosstermBackend;
use rustix::time::{ClockId, clock_gettime};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;
use std::time::Duration;
use termtrace::internals::capabilities::Shifts;
use termtrace::internals::cell::grid_from_picture;
use termtrace::internals::encode::Allowance;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{CellMode, Encoder, Order, Picture, Quality, Srgb8};

/// A way to send pictures.
#[derive(Clone, Copy)]
pub(crate) enum Way {
    Ratatui,
    Exact(Order),
    Lossy(Quality),
}

impl Way {
    /// Hands every frame's bytes on, and nothing that is sent after the last.
    pub(crate) fn send(self, frames: &[Picture], mut take: impl FnMut(&[u8])) {
        match self {
            Self::Ratatui => by_ratatui(frames, take),
            Self::Exact(order) => {
                let mut encoder = encoder(order);
                let mut bytes = Vec::new();
                for picture in frames {
                    bytes.clear();
                    encoder.encode(&grid_from_picture(CellMode::HALF_BLOCK, picture), &mut bytes);
                    take(&bytes);
                }
            }
            Self::Lossy(quality) => {
                let mut lossy = Lossy::new(quality);
                for (k, picture) in frames.iter().enumerate() {
                    take(lossy.send(picture, time_of(k)));
                }
            }
        }
    }
}

/// Returns the time at which a frame is sent.
pub(crate) fn time_of(frame: usize) -> Duration {
    Duration::from_secs(frame as u64) / 30
}

pub(crate) fn encoder(order: Order) -> Encoder {
    Encoder::new().with_order(order).with_half_blocks(HalfBlocks::Either)
}

/// Sends pictures near the wanted ones, by colour.
pub(crate) struct Lossy {
    quality: Quality,
    encoder: Encoder,
    bytes: Vec<u8>,
}

impl Lossy {
    pub(crate) fn new(quality: Quality) -> Self {
        Self { quality, encoder: encoder(Order::Color), bytes: Vec::new() }
    }

    /// Lets the terminal shift what it shows.
    pub(crate) fn with_shifts(self, shifts: Shifts) -> Self {
        Self { encoder: self.encoder.with_shifts(shifts), ..self }
    }

    /// The bytes for that picture at that time.
    pub(crate) fn send(&mut self, picture: &Picture, now: Duration) -> &[u8] {
        self.send_within(picture, now, None)
    }

    /// The bytes for that picture at that time, under a limit.
    pub(crate) fn send_within(&mut self, picture: &Picture, now: Duration, max_bytes: Option<usize>) -> &[u8] {
        self.bytes.clear();
        let allowance = Allowance { quality: self.quality, now, max_bytes };
        self.encoder.encode_within(&grid_from_picture(CellMode::HALF_BLOCK, picture), allowance, &mut self.bytes);
        &self.bytes
    }

    /// Returns when the last picture is to be sent again.
    pub(crate) fn due(&self) -> Option<Duration> {
        self.encoder.due()
    }
}

/// The writer of ratatui's backend.
#[derive(Clone, Default)]
struct Sink(Rc<RefCell<Vec<u8>>>);

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn by_ratatui(frames: &[Picture], mut take: impl FnMut(&[u8])) {
    let sink = Sink::default();
    let (columns, rows) = (frames[0].width() as u16, (frames[0].height() / 2) as u16);
    let options = TerminalOptions { viewport: Viewport::Fixed(Rect::new(0, 0, columns, rows)) };
    let mut terminal = Terminal::with_options(CrosstermBackend::new(sink.clone()), options).expect("memory");
    for picture in frames {
        sink.0.borrow_mut().clear();
        terminal.draw(|frame| fill(frame.buffer_mut(), picture)).expect("memory");
        take(&sink.0.borrow());
    }
}

fn fill(buffer: &mut ratatui::buffer::Buffer, picture: &Picture) {
    let color = |p: Srgb8| Color::Rgb(p.r, p.g, p.b);
    let width = picture.width() as usize;
    for (row, pair) in picture.pixels().chunks_exact(2 * width).enumerate() {
        for column in 0..width {
            let cell = &mut buffer[(column as u16, row as u16)];
            cell.set_symbol("▀").set_fg(color(pair[column])).set_bg(color(pair[width + column]));
        }
    }
}

/// Bytes a frame after the first, in the mean.
#[derive(Clone, Copy)]
pub(crate) struct Sent {
    pub(crate) raw: f64,
    /// The bytes of one streaming zlib window, level 6, flushed after each frame, as `ssh -C` does
    /// it.
    pub(crate) zlib: f64,
}

pub(crate) fn sent(way: Way, frames: &[Picture]) -> Sent {
    let mut zlib = Compress::new(Compression::new(6), true);
    let (mut raw, mut compressed) = (Vec::new(), Vec::new());
    way.send(frames, |bytes| {
        let before = zlib.total_out();
        let mut out = Vec::with_capacity(bytes.len() + 1024);
        zlib.compress_vec(bytes, &mut out, FlushCompress::Sync).expect("memory");
        raw.push(bytes.len());
        compressed.push((zlib.total_out() - before) as usize);
    });
    Sent { raw: mean(&raw), zlib: mean(&compressed) }
}

/// Returns the mean of all frames but the first.
pub(crate) fn mean(frames: &[usize]) -> f64 {
    frames[1..].iter().sum::<usize>() as f64 / (frames.len() - 1) as f64
}

/// Returns the least CPU time of each way, in microseconds a frame.
///
/// The ways take turns, so that other load of the machine falls on all of them.
pub(crate) fn times<const N: usize>(ways: [Way; N], frames: &[Picture], rounds: usize) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..rounds {
        for (way, least) in ways.into_iter().zip(&mut least) {
            let start = cpu_time();
            way.send(frames, |bytes| {
                std::hint::black_box(bytes);
            });
            *least = least.min((cpu_time() - start) * 1e6 / frames.len() as f64);
        }
    }
    least
}

/// Returns the CPU time of this thread, in seconds.
pub(crate) fn cpu_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
