//! Opening of the help, and handling of keys while it is open.

use super::Viewer;
use super::help::{HelpKey, HelpPanel};
use super::status::StatusLine;
use super::theme;
use crate::control::{Command, KeyMode};
use crossterm::event::{KeyEvent, KeyEventKind};

impl Viewer {
    /// Opens the help, if there is room.
    pub(super) fn open_help(&mut self) {
        if theme::has_room(theme::area(self.picture_size())) {
            let states = self.states();
            self.screen.open(HelpPanel::new(states));
        } else {
            self.show_note(theme::needs_room("help"));
        }
    }

    /// Passes a key to the help if that is open, and returns whether it is.
    pub(super) fn take_help_key(&mut self, key: &KeyEvent, meant: Option<(Command, bool)>) -> bool {
        let Some(help) = self.screen.get::<HelpPanel>() else { return false };
        let mut effect = help.effect(key.code, meant.map(|(command, _)| command));
        // Repeats of the key that opens and closes the help would do so 25 times a second.
        if key.kind == KeyEventKind::Repeat && matches!(effect, HelpKey::Close | HelpKey::Turn | HelpKey::Clear) {
            effect = HelpKey::Nothing;
        }
        self.screen.take_help_key(effect, &self.options.keymap, self.display.picture_size());
        true
    }

    /// Returns words on the current state, each with the command that changes it.
    fn states(&self) -> Vec<(Command, String)> {
        let on = |is_on: bool| if is_on { "on" } else { "off" }.to_owned();
        let maps: Vec<_> = self.layout.maps().map(crate::maps::Map::name).collect();
        let moving = if self.eye.mode() == KeyMode::Orbit { "orbit" } else { "fly" };
        vec![
            (Command::ChangeMode, moving.to_owned()),
            (Command::Turntable, on(self.eye.is_on_turntable())),
            (Command::NextMap, maps.join(" | ")),
            (Command::Status, on(self.screen.get::<StatusLine>().is_some())),
        ]
    }
}
