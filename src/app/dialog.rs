//! What the user is asked: a question, and the keys that answer it.

use super::keeping::Asked;
use super::panels::Look;
use crate::export::Format;
use crossterm::event::KeyCode;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Rect};
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Paragraph, Widget};
use unicode_width::UnicodeWidthStr;

/// A question; until it is answered, keys are answers.
pub(super) enum Dialog {
    /// What the picture is to be written as.
    Export,
    /// Whether a view is to be written into the scene's file.
    Keep(Asked),
}

/// What is to be done.
pub(super) enum Answer {
    Export(Format),
    Keep(Asked),
    /// Nothing: he leaves the question.
    Nothing,
}

const FORMATS: [(char, &str, Format); 5] = [
    ('p', "PNG picture", Format::Png),
    ('a', "ANSI text in colour", Format::Ansi),
    ('t', "plain text", Format::Text),
    ('s', "SVG drawing", Format::Svg),
    ('h', "HTML page", Format::Html),
];

impl Dialog {
    /// What the key answers. Any key but those that are offered leaves the question.
    pub(super) fn answer(self, key: KeyCode) -> Answer {
        let KeyCode::Char(key) = key else { return Answer::Nothing };
        match self {
            Self::Export => FORMATS
                .iter()
                .find(|(offered, ..)| *offered == key.to_ascii_lowercase())
                .map_or(Answer::Nothing, |&(.., format)| Answer::Export(format)),
            Self::Keep(asked) if key.eq_ignore_ascii_case(&'y') => Answer::Keep(asked),
            Self::Keep(_) => Answer::Nothing,
        }
    }

    fn title(&self) -> &'static str {
        match self {
            Self::Export => " write the picture as ",
            Self::Keep(_) => " write this view into the scene's file? ",
        }
    }

    fn lines(&self) -> Vec<String> {
        match self {
            Self::Export => {
                let formats = FORMATS.iter().map(|(key, what, _)| format!("{key}    {what}"));
                formats.chain(["Esc  nothing".to_owned()]).collect()
            }
            Self::Keep(asked) => {
                let name = asked.file().file_name().unwrap_or_default().to_string_lossy().into_owned();
                vec![crate::scene_text::visible(&name), "y  yes    n  no".to_owned()]
            }
        }
    }

    /// In the lower left corner, above the lowest row: most of the picture can be seen.
    pub(super) fn area(&self, screen: Rect) -> Rect {
        let lines = self.lines();
        let text = lines.iter().map(|line| line.width() + 4).max().unwrap_or(0);
        let width = (text.max(self.title().width() + 2) as u16).min(screen.width);
        let height = (lines.len() as u16 + 2).min(screen.height);
        Rect { x: screen.x, y: (screen.bottom() - height).saturating_sub(1), width, height }
    }

    pub(super) fn draw(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        Block::bordered().border_set(look.border()).title(self.title()).style(look.style()).render(area, buffer);
        let lines: Vec<_> = self.lines().into_iter().map(Line::from).collect();
        Paragraph::new(lines).style(look.style()).render(area.inner(Margin::new(2, 1)), buffer);
    }
}
