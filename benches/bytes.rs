//! What the encoder sends, against ratatui's own backend in the same run. By hand:
//! `cargo bench --bench bytes -- FOLDER`, where FOLDER holds frames as `NAME_COLSxROWS.rgb`: all frames of a sequence
//! one after another, COLS x 2 ROWS sRGB pixels each, 3 bytes a pixel, row by row from the top.

use flate2::{Compress, Compression, FlushCompress};
use ratatui::Terminal;
use ratatui::TerminalOptions;
use ratatui::Viewport;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui_crossterm::CrosstermBackend;
use std::cell::RefCell;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Instant;
use termtrace::capabilities::CellMode;
use termtrace::cell::grid_from_picture;
use termtrace::color::Srgb8;
use termtrace::encode::{Encoder, Order};
use termtrace::tone::Picture;

/// Bytes per frame after one streaming zlib window, level 6, with a sync flush after each frame (as `ssh -C`).
#[derive(Default)]
struct Zlib(Option<Compress>);

impl Zlib {
    fn len(&mut self, bytes: &[u8]) -> usize {
        let z = self.0.get_or_insert_with(|| Compress::new(Compression::new(6), true));
        let before = z.total_out();
        let mut out = Vec::with_capacity(bytes.len() + 1024);
        z.compress_vec(bytes, &mut out, FlushCompress::Sync).expect("memory");
        (z.total_out() - before) as usize
    }
}

/// The bytes of each frame, and the best time for all of them in microseconds a frame.
struct Sent {
    frames: Vec<usize>,
    zlib: f64,
    micros: f64,
}

impl Sent {
    /// The mean of all frames but the first.
    fn mean(&self) -> f64 {
        self.frames.iter().skip(1).sum::<usize>() as f64 / (self.frames.len() - 1) as f64
    }
}

/// The best of five runs.
fn measured(frames: usize, run: impl Fn(&mut dyn FnMut(&[u8]) -> usize) -> Vec<usize>) -> Sent {
    let mut z = Zlib::default();
    let zlib = run(&mut |bytes| z.len(bytes));
    let zlib = zlib.iter().skip(1).sum::<usize>() as f64 / (frames - 1) as f64;
    let runs = (0..5).map(|_| {
        let start = Instant::now();
        let sent = run(&mut |bytes| bytes.len());
        (start.elapsed().as_secs_f64() * 1e6 / frames as f64, sent)
    });
    let (micros, frames) = runs.min_by(|a, b| a.0.total_cmp(&b.0)).expect("five runs");
    Sent { frames, zlib, micros }
}

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

fn by_ratatui(frames: &[Picture], len: &mut dyn FnMut(&[u8]) -> usize) -> Vec<usize> {
    let sink = Sink::default();
    let (columns, rows) = (frames[0].width as u16, (frames[0].height / 2) as u16);
    let options = TerminalOptions { viewport: Viewport::Fixed(Rect::new(0, 0, columns, rows)) };
    let mut terminal = Terminal::with_options(CrosstermBackend::new(sink.clone()), options).expect("memory");
    let send = |picture: &Picture| {
        sink.0.borrow_mut().clear();
        terminal.draw(|frame| fill(frame.buffer_mut(), picture)).expect("memory");
        len(&sink.0.borrow())
    };
    frames.iter().map(send).collect()
}

fn fill(buffer: &mut ratatui::buffer::Buffer, picture: &Picture) {
    let color = |p: Srgb8| Color::Rgb(p.r, p.g, p.b);
    let width = picture.width as usize;
    for (row, pair) in picture.pixels.chunks_exact(2 * width).enumerate() {
        for column in 0..width {
            let cell = &mut buffer[(column as u16, row as u16)];
            cell.set_symbol("▀").set_fg(color(pair[column])).set_bg(color(pair[width + column]));
        }
    }
}

fn by_us(frames: &[Picture], order: Order, len: &mut dyn FnMut(&[u8]) -> usize) -> Vec<usize> {
    let mut encoder = Encoder::new().with_order(order).with_upper_half(true);
    let mut bytes = Vec::new();
    let send = |picture: &Picture| {
        bytes.clear();
        encoder.encode(&grid_from_picture(CellMode::HalfBlock, picture), &mut bytes);
        len(&bytes)
    };
    frames.iter().map(send).collect()
}

/// The frames of a file, by the size in its name.
fn frames(path: &Path) -> Option<Vec<Picture>> {
    let (columns, rows) = path.file_stem()?.to_str()?.rsplit_once('_')?.1.split_once('x')?;
    let (width, height): (usize, usize) = (columns.parse().ok()?, 2 * rows.parse::<usize>().ok()?);
    let bytes = fs::read(path).ok()?;
    let picture = |frame: &[u8]| Picture {
        width: width as u32,
        height: height as u32,
        pixels: frame.chunks_exact(3).map(|p| Srgb8::new(p[0], p[1], p[2])).collect(),
    };
    Some(bytes.chunks_exact(3 * width * height).map(picture).collect())
}

fn main() {
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let Some(folder) = folder.map(PathBuf::from) else { return println!("name a folder of frames") };
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    println!(
        "| sequence | ratatui | us | raster | x | zlib x | time x | color | x | zlib x | time x |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
    );
    for file in files {
        let Some(frames) = frames(&file) else { continue };
        let base = measured(frames.len(), |len| by_ratatui(&frames, len));
        print!("| {} | {:.0} | {:.0} |", file.file_stem().expect("a name").display(), base.mean(), base.micros);
        for order in [Order::Raster, Order::Color] {
            let ours = measured(frames.len(), |len| by_us(&frames, order, len));
            print!(
                " {:.0} | {:.3} | {:.3} | {:.2} |",
                ours.mean(),
                ours.mean() / base.mean(),
                ours.zlib / base.zlib,
                ours.micros / base.micros
            );
        }
        println!();
    }
}
