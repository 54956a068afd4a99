//! What is wrong with a scene, at the bottom of the picture, until it is mended.

use super::layers::{Canvas, Layer, Level};
use super::look::Look;
use crate::text::visible;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Clear, Paragraph, Widget};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// A fault takes so many rows at most, and a third of the screen.
const MOST_ROWS: u16 = 8;

/// Faults of a scene: the first one is shown, with its line of the file and a caret.
pub(super) struct Fault {
    message: String,
    /// The line of the file, and the one with the caret below it.
    excerpt: Option<[String; 2]>,
    /// How many lines tell of other faults.
    has_more: bool,
}

impl Layer for Fault {
    fn level(&self) -> Level {
        Level::Fault
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if canvas.has_room() {
            let has_legends = canvas.frame.is_some_and(|frame| !frame.legends.is_empty());
            let area = self.area(canvas.screen(), canvas.status_rows + u16::from(has_legends));
            canvas.lay(area, |look, area, buffer| self.paint(look, area, buffer));
        }
    }
}

impl Fault {
    /// As an error tells it.
    pub(super) fn new(error: &str) -> Self {
        let mut lines = error.lines().map(visible).peekable();
        let message = lines.next().unwrap_or_default();
        let excerpt = lines.next_if(|line| line.starts_with(' ')).and_then(|line| Some([line, lines.next()?]));
        Self { message, excerpt, has_more: lines.next().is_some() }
    }

    /// What fits into that many columns.
    fn lines(&self, width: usize) -> Vec<String> {
        let mut lines = wrapped(&self.message, width);
        if let Some(excerpt) = &self.excerpt {
            let [_, caret] = excerpt;
            // So far to the left that the caret can be seen.
            let cut = caret.width().saturating_sub(width).min(caret.find('^').unwrap_or(0));
            lines.extend(excerpt.iter().map(|line| part(line, cut, width)));
        }
        if self.has_more {
            lines.push("more is wrong: termtrace check tells all".chars().take(width).collect());
        }
        lines
    }

    /// The lowest rows, above that many others.
    fn area(&self, screen: Rect, below: u16) -> Rect {
        let lines = self.lines(inner(screen.width)).len() as u16;
        let height = lines.min(MOST_ROWS).min(screen.height / 3);
        Rect { y: (screen.bottom() - height).saturating_sub(below), height, ..screen }
    }

    fn paint(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        let lines: Vec<_> =
            self.lines(inner(area.width)).into_iter().map(|line| Line::from(format!(" {line}"))).collect();
        Paragraph::new(lines).style(look.style()).render(area, buffer);
    }
}

/// With a blank on both sides.
fn inner(width: u16) -> usize {
    usize::from(width.saturating_sub(2)).max(1)
}

/// In lines of at most so many columns, between words where there are some.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_inclusive([' ', '/']) {
        let mut word = word.to_owned();
        if lines.last().is_some_and(|line| !line.is_empty() && line.width() + word.trim_end().width() > width) {
            lines.push(String::new());
        }
        while word.trim_end().width() > width {
            let head = part(&word, 0, width);
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

/// The columns from that one on, at most so many.
fn part(text: &str, from: usize, width: usize) -> String {
    let mut column = 0;
    let within = text.chars().filter(|c| {
        let start = column;
        column += c.width().unwrap_or(0);
        start >= from && column <= from + width
    });
    within.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ERROR: &str = "my.ron:3:35: unknown field \"radus\"; did you mean \"radius\"?
  3 |         Sphere(center: (0, 1, 0), radus: 1),
    |                                   ^^^^^
my.ron:9:1: another";

    #[test]
    fn a_fault_fits_any_width() {
        let fault = Fault::new(ERROR);
        let wide = fault.lines(78);
        assert_eq!(wide[..3], *ERROR.lines().take(3).collect::<Vec<_>>());
        assert_eq!(wide[3..], ["more is wrong: termtrace check tells all"]);
        for width in 1..100 {
            let lines = fault.lines(width);
            assert!(lines.iter().all(|line| line.trim_end().width() <= width), "{width}: {lines:?}");
            let caret = lines.iter().position(|line| line.contains('^')).expect("a caret");
            let column = lines[caret].find('^').expect("a caret");
            assert_eq!(lines[caret - 1].chars().nth(column), Some('r'), "{width}: {lines:?}");
        }
        assert_eq!(wrapped("a bird in the hand", 9), ["a bird in ", "the hand"].map(str::to_owned));
        assert_eq!(wrapped("abcdefgh ij", 3), ["abc", "def", "gh ", "ij"].map(str::to_owned));
    }

    #[test]
    fn errors_of_one_line_have_no_excerpt() {
        assert_eq!(Fault::new("x.ron: there is no such file").lines(40), ["x.ron: there is no such file"]);
        assert_eq!(Fault::new("").lines(40), [""]);
    }
}
