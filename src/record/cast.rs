//! Recording of asciicasts.

use crate::encode::{Allowance, Encoder, Quality};
use crate::grid::{Grid, Size};
use std::fmt;
use std::io::{self, Write};
use std::time::Duration;

/// An asciicast (version 2, the format of asciinema) of an encoder's bytes.
///
/// Each frame is one output event, empty if there is nothing to send. Its time is the frame's number divided by the
/// frame rate. The last frame, which stays on the screen, is exact with every quality. The first frame hides the
/// viewer's cursor, and the last one shows it again. The cast contains nothing else: it switches no other modes, and
/// sends no queries to the viewer's terminal.
///
/// ```
/// use termtrace::{Cast, Encoder, Grid, Size};
///
/// let size = Size::new(80, 24);
/// let mut cast = Cast::begin(Vec::new(), size, Encoder::new(), 30)?;
/// cast.frame(Grid::new(size))?;
/// let file = cast.end()?;
/// assert!(file.starts_with(br#"{"version":2,"width":80,"height":24}"#));
/// assert!(file.ends_with(b"\\u001b[?25h\"]\n"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct Cast<W: Write> {
    out: W,
    encoder: Encoder,
    quality: Quality,
    /// The limit on the bytes per second of playback; `None` for no limit.
    max_rate: Option<u32>,
    frames_per_second: u32,
    frame: u64,
    /// The time in the film at which a link with the rate `max_rate` has delivered all frames so
    /// far.
    free_at: Duration,
    /// The latest frame, and its encoded bytes, which may show the frame inexactly.
    // A frame is written when the next one arrives, because the film's last frame has to be encoded exactly, and only
    // `end` knows which frame is the last.
    last: Option<(Grid, Vec<u8>)>,
}

// `HIDE_CURSOR` and `SHOW_CURSOR` belong to the first and the last frame, so that a film has one event per frame.
/// Hides the cursor, which would blink in the picture (DECTCEM).
const HIDE_CURSOR: &[u8] = b"\x1b[?25l";
/// Shows the cursor.
const SHOW_CURSOR: &[u8] = b"\x1b[?25h";

/// Shows the frame rate and the number of frames, so that `W` need not implement `Debug`.
impl<W: Write> fmt::Debug for Cast<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames_per_second, frame, .. } = self;
        let mut cast = f.debug_struct("Cast");
        cast.field("frames_per_second", frames_per_second).field("frame", frame).finish_non_exhaustive()
    }
}

impl<W: Write> Cast<W> {
    /// Starts a film for a terminal of this size in cells.
    ///
    /// # Errors
    /// If writing fails.
    pub fn begin(mut out: W, size: Size, encoder: Encoder, frames_per_second: u32) -> io::Result<Self> {
        write_header(&mut out, size)?;
        Ok(Self {
            out,
            encoder,
            quality: Quality::Exact,
            max_rate: None,
            frames_per_second: frames_per_second.max(1), // times are divided by it
            frame: 0,
            free_at: Duration::ZERO,
            last: None,
        })
    }

    /// Sets the quality of all frames but the last.
    #[doc(hidden)]
    pub fn with_quality(self, quality: Quality) -> Self {
        Self { quality, ..self }
    }

    /// Sets the rate of the link over which the film is played, in bytes per second; `None` for no
    /// limit.
    ///
    /// Frames are dropped (their events are empty) until a link of this rate has delivered the bytes before them. The
    /// last frame is always sent.
    #[doc(hidden)]
    pub fn with_max_rate(self, max_rate: Option<u32>) -> Self {
        Self { max_rate, ..self }
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If writing fails.
    pub fn frame(&mut self, grid: Grid) -> io::Result<()> {
        self.write_last()?;
        let mut bytes = if self.frame == 0 { HIDE_CURSOR.to_vec() } else { Vec::new() };
        let now = Duration::from_secs_f64(self.time());
        // If the link is still busy, the frame is dropped, as in the live view. Queued frames would be delayed more and
        // more.
        if self.free_at <= now {
            let max_bytes = self.max_rate.map(|rate| (rate / self.frames_per_second) as usize);
            let allowance = Allowance { quality: self.quality, now, max_bytes };
            self.encoder.encode_within(&grid, allowance, &mut bytes);
        }
        if let Some(rate) = self.max_rate.filter(|_| !bytes.is_empty()) {
            self.free_at = now + Duration::from_secs_f64(bytes.len() as f64 / f64::from(rate.max(1)));
        }
        self.last = Some((grid, bytes));
        Ok(())
    }

    /// Finishes the film and returns the writer.
    ///
    /// # Errors
    /// If writing fails.
    pub fn end(mut self) -> io::Result<W> {
        if let Some((grid, bytes)) = &mut self.last {
            self.encoder.encode(grid, bytes);
            bytes.extend_from_slice(SHOW_CURSOR);
        }
        self.write_last()?;
        self.out.flush()?;
        Ok(self.out)
    }

    /// Returns the time of the current frame in seconds since the start of the film.
    fn time(&self) -> f64 {
        self.frame as f64 / f64::from(self.frames_per_second)
    }

    fn write_last(&mut self) -> io::Result<()> {
        let Some((_, bytes)) = self.last.take() else { return Ok(()) };
        let time = self.time();
        self.frame += 1;
        write_event(&mut self.out, time, "o", &String::from_utf8_lossy(&bytes))
    }
}

/// Writes the first line of an asciicast of a terminal of this size.
pub(crate) fn write_header(out: &mut impl Write, Size { columns, rows }: Size) -> io::Result<()> {
    writeln!(out, r#"{{"version":2,"width":{columns},"height":{rows}}}"#)
}

/// Writes a line with an event: its time, its kind and its text.
///
/// The kind is `o` for output and `r` for a new size.
pub(crate) fn write_event(out: &mut impl Write, seconds: f64, kind: &str, text: &str) -> io::Result<()> {
    let mut line = serde_json::to_vec(&(seconds, kind, text))?;
    line.push(b'\n');
    out.write_all(&line)
}
