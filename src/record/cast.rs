//! Asciicasts.

use crate::encode::{Allowance, Encoder, Quality};
use crate::grid::{Grid, Size};
use std::fmt;
use std::io::{self, Write};
use std::time::Duration;

/// An asciicast (version 2, as asciinema plays it) of what an encoder sends to a terminal: one output event for each
/// frame, empty where nothing is to be sent, at the frame's number over the frames per second. The last frame, which stays,
/// is exact whatever the quality.
///
/// Only frames are in it: nothing that switches a mode or asks the viewer's terminal a question.
pub struct Cast<W: Write> {
    out: W,
    encoder: Encoder,
    quality: Quality,
    /// Bytes per second.
    max_rate: Option<u32>,
    frames_per_second: u32,
    frame: u64,
    /// When all that was sent is through, at the highest rate.
    free_at: Duration,
    /// The last frame and its bytes, which may not be all yet.
    last: Option<(Grid, Vec<u8>)>,
}

impl<W: Write> fmt::Debug for Cast<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames_per_second, frame, .. } = self;
        let mut cast = f.debug_struct("Cast");
        cast.field("frames_per_second", frames_per_second).field("frame", frame).finish_non_exhaustive()
    }
}

impl<W: Write> Cast<W> {
    /// For a terminal of that size.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn begin(mut out: W, size: Size, encoder: Encoder, frames_per_second: u32) -> io::Result<Self> {
        let Size { columns, rows } = size;
        writeln!(out, r#"{{"version":2,"width":{columns},"height":{rows}}}"#)?;
        Ok(Self {
            out,
            encoder,
            quality: Quality::Exact,
            max_rate: None,
            frames_per_second: frames_per_second.max(1),
            frame: 0,
            free_at: Duration::ZERO,
            last: None,
        })
    }

    /// Of that quality.
    #[doc(hidden)]
    pub fn with_quality(self, quality: Quality) -> Self {
        Self { quality, ..self }
    }

    /// For a link that takes so many bytes a second: while they are on their way, frames are left out (their events are
    /// empty). But for the last frame, which waits for nothing.
    #[doc(hidden)]
    pub fn with_max_rate(self, max_rate: Option<u32>) -> Self {
        Self { max_rate, ..self }
    }

    /// The next frame.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn frame(&mut self, grid: Grid) -> io::Result<()> {
        self.write_last()?;
        let mut bytes = Vec::new();
        let now = Duration::from_secs_f64(self.time());
        if self.free_at <= now {
            let most_bytes = self.max_rate.map(|rate| (rate / self.frames_per_second) as usize);
            let allowance = Allowance { quality: self.quality, now, most_bytes };
            self.encoder.encode_within(&grid, allowance, &mut bytes);
        }
        if let Some(rate) = self.max_rate.filter(|_| !bytes.is_empty()) {
            self.free_at = now + Duration::from_secs_f64(bytes.len() as f64 / f64::from(rate.max(1)));
        }
        self.last = Some((grid, bytes));
        Ok(())
    }

    /// Writes the rest after the last frame, and returns the writer.
    ///
    /// # Errors
    /// If the rest cannot be written.
    pub fn end(mut self) -> io::Result<W> {
        if let Some((grid, bytes)) = &mut self.last {
            self.encoder.encode(grid, bytes);
        }
        self.write_last()?;
        self.out.flush()?;
        Ok(self.out)
    }

    /// When the next frame is shown, in seconds.
    fn time(&self) -> f64 {
        self.frame as f64 / f64::from(self.frames_per_second)
    }

    fn write_last(&mut self) -> io::Result<()> {
        let Some((_, bytes)) = self.last.take() else { return Ok(()) };
        let mut line = serde_json::to_vec(&(self.time(), "o", String::from_utf8_lossy(&bytes)))?;
        line.push(b'\n');
        self.frame += 1;
        self.out.write_all(&line)
    }
}
