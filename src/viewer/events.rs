//! The viewer's actions on input from the terminal, parsed by `input`: keys, mouse and replies.

use super::camera_commands::ZOOM_FACTOR;
use super::dialog::Dialog;
use super::explain::ExplainPanel;
use super::help::HelpPanel;
use super::metadata::Metadata;
use super::note::Note;
use super::orders::BuildPace;
use super::status::StatusLine;
use super::warnings::Warnings;
use super::{Request, Viewer, mouse_actions};
use crate::control::Command;
use crate::input::{Input, Reply};
use crate::maps::Map;
use crate::memory::OutOfMemory;
use crossterm::event::{Event, KeyEvent, KeyEventKind, KeyModifiers, MouseEventKind};
use std::time::Duration;

/// Flags of the kitty keyboard protocol that a terminal must confirm before its keys are read as
/// sequences.
///
/// Disambiguation (1), releases (2) and every key as an escape sequence (8).
const KEYBOARD: u16 = 1 | 2 | 8;

/// Returns whether an input presses a key or a mouse button, or turns the wheel.
// The release of a key that has entered a tour must not leave the tour.
fn is_press(input: &Input) -> bool {
    match input {
        Input::Event(Event::Key(key)) => key.kind == KeyEventKind::Press,
        Input::Event(Event::Mouse(mouse)) => !matches!(mouse.kind, MouseEventKind::Up(_) | MouseEventKind::Moved),
        _ => false,
    }
}

impl Viewer {
    /// Handles bytes that have arrived from the terminal; empty `bytes` report only that time has
    /// passed.
    ///
    /// # Errors
    /// If there is not enough memory for pictures of the size that the replies imply.
    pub(crate) fn receive(&mut self, bytes: &[u8], now: Duration) -> Result<(), OutOfMemory> {
        let inputs = self.receiver.receive(bytes, now);
        self.take_inputs(&inputs, now)
    }

    /// Releases all keys and buttons and forgets the outstanding queries, before another program
    /// gets the terminal.
    pub(crate) fn lose_terminal(&mut self, now: Duration) {
        self.set_now(now);
        self.eye.stop(now);
        self.eye.set_reports_releases(false, now);
        self.pointer.release();
        self.pacing.forget_replies();
    }

    /// Handles the input that was typed while another program had the terminal.
    ///
    /// Replies among it are dropped, because the queries are sent again.
    ///
    /// # Errors
    /// As for [`receive`](Self::receive).
    pub(crate) fn receive_type_ahead(&mut self, mut typed: Vec<Input>, now: Duration) -> Result<(), OutOfMemory> {
        // The other program may have reset the keyboard flags, so keys are read in the legacy encoding until the reply
        // to the new query.
        self.receiver.set_keys_are_sequences(false);
        typed.retain(|input| !matches!(input, Input::Reply(_)));
        self.take_inputs(&typed, now)
    }

    /// Handles inputs in order. Those after a request to leave or to suspend are dropped.
    fn take_inputs(&mut self, inputs: &[Input], now: Duration) -> Result<(), OutOfMemory> {
        self.set_now(now);
        for (at, input) in inputs.iter().enumerate() {
            if matches!(input, Input::Event(Event::Key(_) | Event::Mouse(_))) {
                self.record_input_time(now, is_press(input));
            }
            match input {
                input if mouse_actions::is_superseded(input, inputs.get(at + 1)) => {}
                Input::Event(Event::Mouse(event)) => self.take_mouse(*event),
                Input::Event(Event::Key(key)) => self.take_key(key),
                // Without the focus, the terminal will not report the release of keys that are held now.
                Input::Event(Event::FocusLost) => {
                    self.pointer.release();
                    self.eye.release_keys(now);
                }
                Input::Reply(reply) => self.take_reply(reply)?,
                Input::Event(_) => {}
            }
            // Keys typed after Ctrl-Z are meant for the shell, so the program does not act on them.
            if matches!(self.requests.back(), Some(Request::Leave | Request::Suspend)) {
                break;
            }
        }
        Ok(())
    }

    /// Handles a reply. Those to the initial queries take effect together, with the last one.
    fn take_reply(&mut self, reply: &Reply) -> Result<(), OutOfMemory> {
        if let &Reply::KeyboardFlags(flags) = reply {
            self.take_keyboard_flags(flags);
        }
        let (size, capabilities) = (self.picture_size(), *self.display.capabilities());
        match reply {
            // Terminals reply in order, so once the initial queries are answered this is a reply to a frame's query.
            Reply::DeviceAttributes(_) if !self.display.queries().is_open() => self.pacing.take_reply(self.now),
            // The initial queries were sent before any frame. So a reply to a frame's query shows that the reply to
            // their last query is lost.
            &Reply::Mode { mode, .. } if self.pacing.match_mode_reply(mode, self.now) => {
                self.display.close_queries();
            }
            reply => drop(self.display.record_initial_reply(reply)),
        }
        self.update_screen_capabilities(&capabilities)?;
        // The picture's size in cells may have changed, because its limit is in pixels and the pixels per cell depend
        // on the glyphs.
        if self.picture_size() != size {
            self.forget_screen();
        }
        Ok(())
    }

    /// Handles a reply with the flags of the kitty keyboard protocol.
    fn take_keyboard_flags(&mut self, flags: u16) {
        let reports_releases = self.display.supports_kitty_keyboard() && flags & KEYBOARD == KEYBOARD;
        self.eye.set_reports_releases(reports_releases, self.now);
        self.receiver.set_keys_are_sequences(reports_releases);
    }

    fn take_key(&mut self, key: &KeyEvent) {
        let is_press = key.kind == KeyEventKind::Press;
        // Only a press closes a note: otherwise the release of the key that opened the note would close it at once.
        if is_press {
            self.screen.close::<Note>();
            self.screen.close::<Warnings>();
        }
        let meant = self.keymap().command(&self.screen.active_modes(self.picture_size()), key);
        // The help takes all keys without Ctrl. It takes no releases, because their keys may have been pressed before
        // it was opened.
        let is_ctrl = key.modifiers.contains(KeyModifiers::CONTROL);
        if key.kind != KeyEventKind::Release && !is_ctrl && self.take_help_key(key, meant) {
            return;
        }
        // An open question takes all keys, except keys with Ctrl that do not answer it, such as Ctrl-C.
        let answer = meant.map(|(command, _)| command).filter(|command| command.answers_dialog() || !is_ctrl);
        if is_press && (answer.is_some() || !is_ctrl) && self.take_answer(answer) {
            return;
        }
        // The eye comes first, so that the motion up to now happens before the command changes the camera.
        self.eye.take_key(key, meant, self.now);
        if let Some((command, more)) = meant
            && (is_press || key.kind == KeyEventKind::Repeat && command.repeats())
        {
            self.execute(command, more);
        }
    }

    /// Carries out a command that takes effect at once; `more` (Shift) makes its step larger.
    ///
    /// Commands of continuous motion do nothing here, because `Eye::take_key` handles them.
    pub(super) fn execute(&mut self, command: Command, more: bool) {
        match command {
            Command::Quit => self.requests.push_back(Request::Leave),
            Command::Suspend => self.requests.push_back(Request::Suspend),
            Command::ChangeMode => self.change_mode(),
            Command::FrameAll => self.frame_everything(),
            // Zooming works in steps, not continuously as motion does: a field of view is set once and then left alone.
            Command::Narrower => self.zoom(1.0 / ZOOM_FACTOR),
            Command::Wider => self.zoom(ZOOM_FACTOR),
            Command::ShiftLeft => self.shift_rectangle([-1.0, 0.0]),
            Command::ShiftRight => self.shift_rectangle([1.0, 0.0]),
            Command::ShiftDown => self.shift_rectangle([0.0, -1.0]),
            Command::ShiftUp => self.shift_rectangle([0.0, 1.0]),
            Command::TiltLeft => self.tilt_rectangle([-1.0, 0.0]),
            Command::TiltRight => self.tilt_rectangle([1.0, 0.0]),
            Command::TiltDown => self.tilt_rectangle([0.0, -1.0]),
            Command::TiltUp => self.tilt_rectangle([0.0, 1.0]),
            Command::Turntable => self.toggle_turntable(),
            Command::Pause => self.toggle_playback(),
            Command::Tour => self.requests.push_back(Request::Tour),
            Command::Lead => self.requests.push_back(Request::Lead),
            Command::ListViewers => self.requests.push_back(Request::ListViewers),
            Command::MarkViewers => self.requests.push_back(Request::MarkViewers),
            #[cfg(feature = "serve")]
            Command::View(number) if self.follow_listed(number) => {}
            Command::View(number) => self.go_to_view(number),
            Command::SaveView => self.screen.open(Dialog::Save),
            Command::Reset => self.reset_eye(),
            Command::ViewBack => self.retrace_views(false),
            Command::ViewForward => self.retrace_views(true),
            Command::NextScene => self.requests.push_back(Request::SwitchScene(1)),
            Command::LastScene => self.requests.push_back(Request::SwitchScene(-1)),
            Command::CopyCamera => self.copy_camera(),
            Command::Export => self.ask_export(),
            Command::ExportLarge => self.ask_large_picture(),
            Command::Record => self.toggle_recording(),
            Command::KeepView => self.propose_view(),
            Command::Status => self.toggle_status(),
            Command::Help => self.open_help(),
            #[cfg(feature = "serve")]
            Command::Close if self.close_viewer_list() => {}
            Command::Close => self.close_topmost(),
            Command::Light => self.take_light(),
            Command::MoveLight(toward) => self.step_light(toward, more),
            Command::LightFarther => self.wheel_light(1.0),
            Command::LightNearer => self.wheel_light(-1.0),
            Command::LightBack => self.put_light_back(),
            Command::NextMap => self.layout.change_map(Map::next),
            Command::LastMap => self.layout.change_map(Map::previous),
            Command::Compare => self.layout.compare(),
            Command::Wipe(side) => self.move_wipe(side),
            Command::Explain => self.toggle_explaining(),
            Command::Point(toward) => self.point(toward, more),
            Command::ScrollUp => self.turn_explanation(-1),
            Command::ScrollDown => self.turn_explanation(1),
            Command::Redraw => self.forget_screen(),
            Command::Caption => self.cycle_caption(),
            Command::NextGlyphs => self.change_glyphs(),
            Command::TurnMesh => self.turn_mesh(),
            Command::Front | Command::FromRight | Command::FromAbove => self.look_from(command),
            Command::Wireframe => self.layout.toggle_wire(),
            Command::Outside => self.show_next_outside_view(),
            Command::Orders => self.toggle_orders(),
            Command::BuildPause => self.change_pace(BuildPace::pause_or_step),
            Command::BuildFaster => self.change_pace(BuildPace::faster),
            Command::BuildSlower => self.change_pace(BuildPace::slower),
            Command::BuildAgain => self.change_pace(BuildPace::restart),
            Command::Axes => self.toggle_axes(),
            Command::Metadata => self.toggle_metadata(),
            // Keys of motion have been passed to the eye, and answers do nothing without an open question.
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

    /// Closes the help if it is open; otherwise releases the held light, if any; otherwise closes
    /// the view from outside, the explanation, the metadata, the comparison of orders or the vanishing points;
    /// otherwise cancels the large picture.
    fn close_topmost(&mut self) {
        // The help comes first, because it lies over everything else.
        if self.screen.close::<HelpPanel>().is_none()
            && !self.release_light()
            && !(self.second_camera().is_some() && self.end_outside_view())
            && self.screen.close::<ExplainPanel>().is_none()
            && self.screen.close::<Metadata>().is_none()
            && !self.close_orders()
            && !self.end_outside_view()
        {
            self.cancel_large_picture();
        }
    }
}
