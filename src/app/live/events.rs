//! What the loop hears: keys, answers, and signals to stop.

use super::moving::ZOOM;
use super::{Live, pointing};
use crate::app::dialog::Dialog;
use crate::app::shown::Shown;
use crate::control::Command;
use crate::input::{Input, Reply};
use crate::terminal::{Signals, Stopped, Terminal};
use crate::view::View;
use crossterm::event::{Event, KeyEvent, KeyEventKind, KeyModifiers};
use std::io;
use std::time::Duration;

/// How long the rest of a key's escape sequence may take before a lone Escape is taken for the key.
const ESCAPE_WAIT: Duration = Duration::from_millis(50);
/// The same while answers are on their way: the first byte of one may come alone.
const ANSWER_WAIT: Duration = Duration::from_secs(1);

/// The flags of the kitty keyboard protocol without which keys are taken as a plain terminal tells of them: no ambiguity
/// (1), releases (2), every key as a sequence (8).
const KEYBOARD: u16 = 1 | 2 | 8;

impl Live {
    /// Whether the terminal knows the kitty keyboard protocol.
    pub(super) fn knows_keyboard(&self) -> bool {
        !self.questions.is_open() && self.questions.answers().kitty_keyboard == Some(true)
    }

    /// The terminal says which flags of the kitty keyboard protocol are on.
    fn take_keyboard(&mut self, flags: u16) {
        let hears_releases = self.knows_keyboard() && flags & KEYBOARD == KEYBOARD;
        self.stale |= self.eye.set_hears_releases(hears_releases, self.now());
        self.parser.set_keys_are_sequences(hears_releases);
    }

    /// Answers to the questions change things all at once, when the last is there.
    fn take_reply(&mut self, reply: &Reply) -> io::Result<()> {
        if let &Reply::KeyboardFlags(flags) = reply {
            self.take_keyboard(flags);
        }
        match reply {
            // Terminals answer in order: first the questions of the start, then what ends each frame.
            Reply::DeviceAttributes(_) if !self.questions.is_open() => self.link.answer(self.now()),
            &Reply::Mode { mode, .. } if self.link.answer_mode(mode, self.now()) => {
                let was_open = self.questions.close();
                if was_open {
                    self.learn()?;
                }
            }
            reply if self.questions.take(reply) => self.learn()?,
            _ => {}
        }
        Ok(())
    }

    /// When half a sequence is taken for all that there is of it, if there is one.
    pub(super) fn escape_due(&self, terminal: &Terminal) -> Option<Duration> {
        let is_no_key = terminal.awaits_answers() || self.eye.hears_releases();
        let wait = if is_no_key { ANSWER_WAIT } else { ESCAPE_WAIT };
        self.parser.is_waiting().then_some(self.read + wait)
    }

    /// What signals want, or keys if there are any. At a stop these are left to be read with the terminal's last answers.
    pub(super) fn next(&mut self, keys: bool, terminal: &mut Terminal, signals: &Signals) -> io::Result<Next> {
        if signals.take_stop() {
            return Ok(Next::Suspend(Some(Stopped::Process)));
        }
        if signals.take_continued() {
            // Stopped unasked, and whoever had the terminal since then left it as he liked.
            return Ok(Next::Suspend(None));
        }
        if keys {
            return self.read_keys(terminal);
        }
        let mut inputs = Vec::new();
        if self.escape_due(terminal).is_some_and(|due| due <= self.now()) {
            self.read = self.now();
            self.parser.give_up_waiting(&mut inputs);
        }
        self.take_inputs(&inputs)
    }

    fn read_keys(&mut self, terminal: &mut Terminal) -> io::Result<Next> {
        let mut buffer = [0; 4096];
        let bytes = terminal.read(&mut buffer)?;
        if bytes.is_empty() {
            return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
        }
        let mut inputs = Vec::new();
        self.parser.feed(bytes, &mut inputs);
        self.read = self.now();
        self.take_inputs(&inputs)
    }

    pub(super) fn take_inputs(&mut self, inputs: &[Input]) -> io::Result<Next> {
        for (at, input) in inputs.iter().enumerate() {
            let next = match input {
                input if pointing::is_outdated(input, inputs.get(at + 1)) => Next::Stay,
                Input::Event(Event::Mouse(event)) => {
                    self.take_mouse(*event);
                    Next::Stay
                }
                Input::Event(Event::Key(key)) => self.take_key(key),
                // Nobody says when the keys held now are let go.
                Input::Event(Event::FocusLost) => {
                    self.pointer.let_go();
                    self.stale |= self.eye.let_go(self.now());
                    Next::Stay
                }
                Input::Reply(reply) => {
                    self.take_reply(reply)?;
                    Next::Stay
                }
                Input::Event(_) => Next::Stay,
            };
            if next != Next::Stay {
                return Ok(next);
            }
        }
        Ok(Next::Stay)
    }

    fn take_key(&mut self, key: &KeyEvent) -> Next {
        let is_press = key.kind == KeyEventKind::Press;
        if is_press {
            self.screen.unsay();
        }
        let meant = self.options.bindings.command(&self.screen.modes(self.size()), key);
        // A question takes all keys but those with Ctrl, which may leave, unless they answer it.
        let is_for_all = key.modifiers.contains(KeyModifiers::CONTROL);
        let answer = meant.map(|(command, _)| command).filter(|command| command.answers() || !is_for_all);
        if is_press && (answer.is_some() || !is_for_all) && self.take_answer(answer) {
            return Next::Stay;
        }
        self.stale |= self.eye.take_key(key, meant, self.now());
        match meant {
            Some((command, more)) if is_press || key.kind == KeyEventKind::Repeat && command.repeats() => {
                self.obey(command, more)
            }
            _ => Next::Stay,
        }
    }

    /// Does at once what is asked for; with Shift, more of it. What goes on while a key is held is the eye's.
    pub(super) fn obey(&mut self, command: Command, more: bool) -> Next {
        match command {
            Command::Quit => return Next::Leave,
            Command::Suspend => return Next::Suspend(Some(Stopped::Group)),
            Command::ChangeMode => self.change_mode(),
            Command::Frame => self.frame_everything(),
            Command::Narrower => self.zoom(1.0 / ZOOM),
            Command::Wider => self.zoom(ZOOM),
            Command::Turntable => self.toggle_turntable(),
            Command::View(number) => self.go_to_view(number),
            Command::SaveView => self.screen.ask(Dialog::Save),
            Command::Reset => self.stale |= self.eye.reset(self.now()),
            Command::NextScene => self.scenes_on += 1,
            Command::LastScene => self.scenes_on -= 1,
            Command::CopyCamera => self.copy_camera(),
            Command::Export => self.ask_export(),
            Command::KeepView => self.ask_keep(),
            Command::Status => self.screen.toggle_status(),
            Command::Help => self.screen.turn_help(self.size()),
            Command::Close => {
                if !self.screen.close_help() && !self.leave_light() {
                    self.screen.close_explaining();
                }
            }
            Command::Light => self.take_light(),
            Command::MoveLight(toward) => self.step_light(toward, more),
            Command::LightFarther => self.wheel_light(1.0),
            Command::LightNearer => self.wheel_light(-1.0),
            Command::LightBack => self.put_light_back(),
            Command::NextView => self.show_views(|shown| shown.go_on(View::next)),
            Command::LastView => self.show_views(|shown| shown.go_on(View::back)),
            Command::Compare => self.show_views(Shown::compare),
            Command::Wipe(side) => self.move_wipe(side),
            Command::Explain => self.screen.toggle_explaining(),
            Command::Point(toward) => self.point(toward, more),
            Command::ScrollUp => self.scroll(-1),
            Command::ScrollDown => self.scroll(1),
            Command::Redraw => self.redraw(),
            // The eye has heard of it; or it is an answer, and nothing was asked.
            Command::Move(_)
            | Command::Look(_)
            | Command::Around(_)
            | Command::Nearer
            | Command::Farther
            | Command::Write(_)
            | Command::Yes
            | Command::No => {}
        }
        Next::Stay
    }
}

/// What the loop does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    Stay,
    /// With the terminal given back; by a stop, or after one that was not ours.
    Suspend(Option<Stopped>),
    Leave,
}
