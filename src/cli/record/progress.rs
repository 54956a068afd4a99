//! The progress bar of a recording, on standard error if that is a terminal.

use console::Term;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle, TermLike};
use std::io;

/// Returns a progress bar over `frames` frames, which is shown from its first tick until it is
/// dropped.
pub(super) fn bar(frames: u64) -> ProgressBar {
    let terminal = Term::buffered_stderr();
    let is_dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb");
    // A terminal with TERM=dumb would show each update on a line of its own.
    if !terminal.is_term() || is_dumb {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("[{wide_bar}] {pos}/{len} frames, {eta}");
    let style = style.map_or_else(|_| ProgressStyle::default_bar(), |style| style.progress_chars("=> "));
    // Ten updates a second are smooth, and cost little beside the frames themselves.
    let target = ProgressDrawTarget::term_like_with_hz(Box::new(NarrowTerm(terminal)), 10);
    let bar = ProgressBar::with_draw_target(Some(frames), target).with_style(style);
    bar.with_finish(ProgressFinish::AndClear)
}

/// The terminal without its last four columns.
///
/// The echo of Ctrl-C (`^C`) then stays on the bar's line and is erased with it. On a full line the echo would wrap,
/// and the bar would be left on the screen.
#[derive(Debug)]
struct NarrowTerm(Term);

impl TermLike for NarrowTerm {
    fn width(&self) -> u16 {
        TermLike::width(&self.0).saturating_sub(4)
    }

    fn move_cursor_up(&self, n: usize) -> io::Result<()> {
        self.0.move_cursor_up(n)
    }

    fn move_cursor_down(&self, n: usize) -> io::Result<()> {
        self.0.move_cursor_down(n)
    }

    fn move_cursor_right(&self, n: usize) -> io::Result<()> {
        self.0.move_cursor_right(n)
    }

    fn move_cursor_left(&self, n: usize) -> io::Result<()> {
        self.0.move_cursor_left(n)
    }

    fn write_line(&self, text: &str) -> io::Result<()> {
        self.0.write_line(text)
    }

    fn write_str(&self, text: &str) -> io::Result<()> {
        self.0.write_str(text)
    }

    fn clear_line(&self) -> io::Result<()> {
        self.0.clear_line()
    }

    fn flush(&self) -> io::Result<()> {
        self.0.flush()
    }
}
