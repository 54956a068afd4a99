//! Handling of the terminal's bytes: keys, mouse and replies.

use super::dialog::Dialog;
use super::explain::Explaining;
use super::help::HelpPanel;
use super::moving::ZOOM;
use super::note::Note;
use super::status::StatusLine;
use super::{Ask, Viewer, pointing};
use crate::control::Command;
use crate::input::{Input, Reply};
use crate::maps::Map;
use crate::memory::OutOfMemory;
use crossterm::event::{Event, KeyEvent, KeyEventKind, KeyModifiers};
use std::time::Duration;

/// Flags of the kitty keyboard protocol that are required before keys are treated as sequences: disambiguation (1),
/// releases (2) and every key as a sequence (8).
const KEYBOARD: u16 = 1 | 2 | 8;

impl Viewer {
    /// Takes the bytes that have arrived; without any, the passing of time.
    ///
    /// # Errors
    /// If there is not enough memory for pictures of the size that the replies imply.
    pub(crate) fn hear(&mut self, bytes: &[u8], now: Duration) -> Result<(), OutOfMemory> {
        let inputs = self.receiver.receive(bytes, now);
        self.take_inputs(&inputs, now)
    }

    /// Prepares for another program having the terminal: releases all keys and forgets the outstanding queries.
    pub(crate) fn lose_terminal(&mut self, now: Duration) {
        self.set_time(now);
        self.eye.stand_still(now);
        self.eye.set_hears_releases(false, now);
        self.hand.let_go();
        self.pacing.forget_replies();
    }

    /// Takes the input that was typed while another program had the terminal. Replies among it are dropped, because the
    /// queries are sent again.
    ///
    /// # Errors
    /// As for [`hear`](Self::hear).
    pub(crate) fn hear_typed(&mut self, mut typed: Vec<Input>, now: Duration) -> Result<(), OutOfMemory> {
        self.receiver.set_keys_are_sequences(false);
        typed.retain(|input| !matches!(input, Input::Reply(_)));
        self.take_inputs(&typed, now)
    }

    /// Input after a request to leave or to stop is dropped.
    fn take_inputs(&mut self, inputs: &[Input], now: Duration) -> Result<(), OutOfMemory> {
        self.set_time(now);
        for (at, input) in inputs.iter().enumerate() {
            match input {
                input if pointing::is_outdated(input, inputs.get(at + 1)) => {}
                Input::Event(Event::Mouse(event)) => self.take_mouse(*event),
                Input::Event(Event::Key(key)) => self.take_key(key),
                // No event will report the release of keys held now.
                Input::Event(Event::FocusLost) => {
                    self.hand.let_go();
                    self.eye.let_go(now);
                }
                Input::Reply(reply) => self.take_reply(reply)?,
                Input::Event(_) => {}
            }
            if matches!(self.asks.back(), Some(Ask::Leave | Ask::Suspend)) {
                break;
            }
        }
        Ok(())
    }

    /// Replies to the initial queries take effect together, with the last one.
    fn take_reply(&mut self, reply: &Reply) -> Result<(), OutOfMemory> {
        if let &Reply::KeyboardFlags(flags) = reply {
            self.take_keyboard(flags);
        }
        let (size, capabilities) = (self.size(), *self.display.capabilities());
        match reply {
            // Terminals reply in order: first to the initial queries, then to those at the end of frames.
            Reply::DeviceAttributes(_) if !self.display.questions().is_open() => self.pacing.take_reply(self.now),
            &Reply::Mode { mode, .. } if self.pacing.take_mode(mode, self.now) => drop(self.display.close_questions()),
            reply => drop(self.display.take_reply(reply)),
        }
        self.heed_capabilities(&capabilities)?;
        if self.size() != size {
            self.redraw();
        }
        Ok(())
    }

    /// Handles a reply with the flags of the kitty keyboard protocol.
    fn take_keyboard(&mut self, flags: u16) {
        let hears_releases = self.display.knows_keyboard() && flags & KEYBOARD == KEYBOARD;
        self.eye.set_hears_releases(hears_releases, self.now);
        self.receiver.set_keys_are_sequences(hears_releases);
    }

    fn take_key(&mut self, key: &KeyEvent) {
        let is_press = key.kind == KeyEventKind::Press;
        if is_press {
            self.screen.close::<Note>();
        }
        let meant = self.bindings().command(&self.screen.modes(self.size()), key);
        // An open question takes all keys, except unrelated ones with Ctrl, which may leave.
        let is_for_all = key.modifiers.contains(KeyModifiers::CONTROL);
        let answer = meant.map(|(command, _)| command).filter(|command| command.answers() || !is_for_all);
        if is_press && (answer.is_some() || !is_for_all) && self.take_answer(answer) {
            return;
        }
        self.eye.take_key(key, meant, self.now);
        if let Some((command, more)) = meant
            && (is_press || key.kind == KeyEventKind::Repeat && command.repeats())
        {
            self.obey(command, more);
        }
    }

    /// Carries out a command that takes effect at once; `faster` (Shift) makes it larger. Continuous motion is the
    /// eye's.
    pub(super) fn obey(&mut self, command: Command, more: bool) {
        match command {
            Command::Quit => self.asks.push_back(Ask::Leave),
            Command::Suspend => self.asks.push_back(Ask::Suspend),
            Command::ChangeMode => self.change_mode(),
            Command::Frame => self.frame_everything(),
            Command::Narrower => self.zoom(1.0 / ZOOM),
            Command::Wider => self.zoom(ZOOM),
            Command::Turntable => self.toggle_turntable(),
            Command::View(number) => self.go_to_view(number),
            Command::SaveView => self.screen.open(Dialog::Save),
            Command::Reset => self.eye.reset(self.now),
            Command::NextScene => self.asks.push_back(Ask::GoOn(1)),
            Command::LastScene => self.asks.push_back(Ask::GoOn(-1)),
            Command::CopyCamera => self.copy_camera(),
            Command::Export => self.ask_export(),
            Command::KeepView => self.asks.extend(self.eye.camera().map(Ask::ProposeView)),
            Command::Status => self.toggle_status(),
            Command::Help => self.screen.turn_help(&self.options.bindings, self.display.size()),
            Command::Close => self.close_topmost(),
            Command::Light => self.take_light(),
            Command::MoveLight(toward) => self.step_light(toward, more),
            Command::LightFarther => self.wheel_light(1.0),
            Command::LightNearer => self.wheel_light(-1.0),
            Command::LightBack => self.put_light_back(),
            Command::NextMap => self.shown.go_on(Map::next),
            Command::LastMap => self.shown.go_on(Map::back),
            Command::Compare => self.shown.compare(),
            Command::Wipe(side) => self.move_wipe(side),
            Command::Explain => self.screen.toggle_explaining(),
            Command::Point(toward) => self.point(toward, more),
            Command::ScrollUp => self.scroll(-1),
            Command::ScrollDown => self.scroll(1),
            Command::Redraw => self.redraw(),
            // Motion has been passed to the eye; an answer without a question means nothing.
            Command::Move(_)
            | Command::Look(_)
            | Command::Around(_)
            | Command::Nearer
            | Command::Farther
            | Command::Write(_)
            | Command::Yes
            | Command::No => {}
        }
    }

    fn toggle_status(&mut self) {
        if self.screen.close::<StatusLine>().is_none() {
            self.screen.open(StatusLine);
        }
    }

    /// Closes the help; without it, releases a light; without one, closes the explanation.
    fn close_topmost(&mut self) {
        if self.screen.close::<HelpPanel>().is_none() && !self.leave_light() {
            self.screen.close::<Explaining>();
        }
    }
}
