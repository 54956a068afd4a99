//! The error panel at the bottom of the picture.

use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::Theme;
use crate::text::Notice;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Greatest height of the panel in rows; it also takes at most a third of the screen.
// Five rows are for the message, two for the excerpt and one for the hint at more errors. The last good picture above
// the panel should stay recognisable.
const MAX_ERROR_ROWS: u16 = 8;

/// The first error of a scene, with its source line and a caret.
pub(super) struct ErrorPanel(pub(super) Notice);

impl Layer for ErrorPanel {
    fn level(&self) -> LayerLevel {
        LayerLevel::Error
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if canvas.has_room() {
            let has_legends = canvas.frame.is_some_and(|frame| !frame.legends.is_empty());
            let area = self.area(canvas.screen(), canvas.status_rows + u16::from(has_legends));
            canvas.lay(area, |theme, area, buffer| self.paint(theme, area, buffer));
        }
    }
}

impl ErrorPanel {
    /// Returns the error's message, excerpt and hint as lines of at most `width` columns.
    fn lines(&self, width: usize) -> Vec<String> {
        let mut lines = wrapped(&self.0.message, width);
        if let Some(excerpt) = &self.0.excerpt {
            let [_, caret] = excerpt;
            // Both lines of the excerpt are cut on the left, just far enough to show the caret: the source line may be
            // long, and its start says nothing about the error.
            let cut = caret.width().saturating_sub(width).min(caret.find('^').unwrap_or(0));
            lines.extend(excerpt.iter().map(|line| columns_of(line, cut, width)));
        }
        if self.0.has_more {
            lines.push("more errors: termtrace check lists them all".chars().take(width).collect());
        }
        lines
    }

    /// Returns the panel's area, above the lowest `rows_below` rows of the screen.
    fn area(&self, screen: Rect, rows_below: u16) -> Rect {
        let lines = self.lines(text_columns(screen.width)).len() as u16;
        // On a low screen the panel takes at most a third of the rows, and the picture keeps the rest.
        let height = lines.min(MAX_ERROR_ROWS).min(screen.height / 3);
        Rect { y: (screen.bottom() - height).saturating_sub(rows_below), height, ..screen }
    }

    fn paint(&self, theme: Theme, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        let lines: Vec<_> =
            self.lines(text_columns(area.width)).into_iter().map(|line| Line::from(format!(" {line}"))).collect();
        Paragraph::new(lines).style(theme.style()).render(area, buffer);
    }
}

/// Returns the columns for text in a panel of this width, which leaves one blank on each side.
fn text_columns(panel_width: u16) -> usize {
    usize::from(panel_width.saturating_sub(2)).max(1)
}

/// Wraps the text to lines of at most `width` columns, between words where possible.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    // Lines break after slashes too, because paths are the longest words of messages.
    for word in text.split_inclusive([' ', '/']) {
        let mut word = word.to_owned();
        if lines.last().is_some_and(|line| !line.is_empty() && line.width() + word.trim_end().width() > width) {
            lines.push(String::new());
        }
        while word.trim_end().width() > width {
            let head = columns_of(&word, 0, width);
            word = word[head.len()..].to_owned();
            lines.last_mut().unwrap_or(&mut String::new()).push_str(&head);
            lines.push(String::new());
            if head.is_empty() {
                break;
            }
        }
        lines.last_mut().unwrap_or(&mut String::new()).push_str(&word);
    }
    lines
}

/// Returns at most `width` columns of the text, starting at column `from`.
fn columns_of(text: &str, from: usize, width: usize) -> String {
    let mut column = 0;
    let within = text.chars().filter(|c| {
        let start = column;
        column += c.width().unwrap_or(0);
        start >= from && column <= from + width
    });
    within.collect()
}

#[cfg(all(test, unit_tests))]
mod tests;
