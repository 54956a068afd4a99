//! Questions to the user, and the keys that answer them.

use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::Theme;
use crate::control::{Binding, Command, KeyMode, Keymap};
use crate::export::Format;
use crate::text::visible;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use unicode_width::UnicodeWidthStr;

/// An open question. Keys answer it until it is closed.
pub(super) enum Dialog {
    /// Asks in which format to export the picture.
    Export,
    /// Asks whether to write a view into the scene file of this name.
    SaveToFile(String),
    /// Asks whether to write a new scene file of this name, with the mesh and this view.
    NewScene(String),
    /// Asks under which number to save the view.
    Save,
}

/// The answer that a key press gives to an open question.
pub(super) enum Answer {
    Save(u8),
    Export(Format),
    SaveToFile,
    /// The question was dismissed, and nothing is to be done.
    Nothing,
}

impl Layer for Dialog {
    fn level(&self) -> LayerLevel {
        LayerLevel::Question
    }

    fn mode(&self, _screen: Rect) -> Option<KeyMode> {
        Some(self.key_mode())
    }

    fn takes_all_keys(&self) -> bool {
        true
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let keymap = canvas.keymap;
        // Unlike other panels, a question is shown even on the smallest screen, because it takes all keys.
        if canvas.has_room() {
            let area = self.area(keymap, canvas.screen());
            canvas.lay(area, |theme, area, buffer| self.paint(keymap, theme, area, buffer));
        } else {
            canvas.write_line(&self.line(keymap, canvas.screen().width.into()), canvas.row_from_bottom(0));
        }
    }
}

impl Dialog {
    /// Returns the mode of the keymap that is in force while the question is open.
    fn key_mode(&self) -> KeyMode {
        match self {
            Self::Export => KeyMode::Export,
            Self::SaveToFile(_) | Self::NewScene(_) => KeyMode::Keep,
            // The mode `Always` binds each digit to a view, so that the same digit saves a view and returns to it.
            Self::Save => KeyMode::Always,
        }
    }

    /// Returns the answer that the command of the pressed key gives to the question.
    ///
    /// A key without a command, or with one that is no answer, dismisses the question.
    pub(super) fn answer(self, meant: Option<Command>) -> Answer {
        match (self, meant) {
            (Self::Export, Some(Command::Write(format))) => Answer::Export(format),
            (Self::SaveToFile(_) | Self::NewScene(_), Some(Command::Yes)) => Answer::SaveToFile,
            (Self::Save, Some(Command::View(number))) => Answer::Save(number),
            // Users who opened the question by mistake can press any other key, and need not know a key for that.
            _ => Answer::Nothing,
        }
    }

    fn title(&self) -> &'static str {
        match self {
            Self::Export => " save picture as ",
            Self::SaveToFile(_) => " save this view to the scene file? ",
            Self::NewScene(_) => " write a scene with this mesh and view? ",
            Self::Save => " save this view as ",
        }
    }

    /// Returns the bindings of the keys that answer the question.
    fn answers<'b>(&self, keymap: &'b Keymap) -> impl Iterator<Item = &'b Binding> {
        let saves = matches!(self, Self::Save);
        keymap.of(self.key_mode()).filter(move |row| !saves || matches!(row.command, Command::View(_)))
    }

    fn lines(&self, keymap: &Keymap) -> Vec<String> {
        let name = match self {
            Self::Export => None,
            // A file name may contain escape sequences.
            Self::SaveToFile(name) | Self::NewScene(name) => Some(visible(name)),
            Self::Save => return vec![self.keys(keymap)],
        };
        let answers: Vec<_> = self.answers(keymap).map(|row| (row.key_names(), row.command.description())).collect();
        let width = answers.iter().map(|(label, _)| label.width()).max().unwrap_or(0);
        name.into_iter().chain(answers.iter().map(|(label, does)| format!("{label:width$}  {does}"))).collect()
    }

    fn keys(&self, keymap: &Keymap) -> String {
        self.answers(keymap).map(Binding::key_names).collect::<Vec<_>>().join(" ")
    }

    /// Returns the question as one line for small screens: a word and the keys that answer it, with
    /// their meanings if they fit into `width` columns.
    fn line(&self, keymap: &Keymap, width: usize) -> String {
        let word = match self {
            Self::Export => "save:",
            Self::SaveToFile(_) => "save view to file?",
            Self::NewScene(_) => "write scene?",
            Self::Save => return "save view as 1-9?".to_owned(),
        };
        let meaning = |row: &Binding| match row.command {
            Command::Write(format) => format.name().to_owned(),
            command => command.description().to_owned(),
        };
        // Any other key dismisses the question, so the key of `Command::No` need not be shown.
        let answers = self.answers(keymap).filter(|row| row.command != Command::No);
        let answers: Vec<_> =
            answers.filter_map(|row| Some(format!("{} {}", row.keys.first()?, meaning(row)))).collect();
        let line = format!("{word} {}", answers.join(" "));
        if line.width() <= width { line } else { format!("{word} {}", self.keys(keymap)) }
    }

    /// Returns the panel's area: the lower left corner, above the lowest row, where it hides little
    /// of the picture.
    fn area(&self, keymap: &Keymap, screen: Rect) -> Rect {
        let lines = self.lines(keymap);
        let text = lines.iter().map(|line| line.width() + 4).max().unwrap_or(0);
        let width = (text.max(self.title().width() + 2) as u16).min(screen.width);
        let height = (lines.len() as u16 + 2).min(screen.height);
        Rect { x: screen.x, y: (screen.bottom() - height).saturating_sub(1), width, height }
    }

    fn paint(&self, keymap: &Keymap, theme: Theme, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        Block::bordered().border_set(theme.border()).title(self.title()).style(theme.style()).render(area, buffer);
        let lines: Vec<_> = self.lines(keymap).into_iter().map(Line::from).collect();
        Paragraph::new(lines).style(theme.style()).render(area.inner(Margin::new(2, 1)), buffer);
    }
}
