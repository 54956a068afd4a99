//! One viewer of the server: its view, the modes of its terminal, and the end of its visit.
//!
//! Pure: the time and the function that traces are parameters, and the bytes to send are returned.

mod guidance;

use super::HostedScene;
use super::guide::Guide;
use super::leave_reason::LeaveReason;
use super::run_queue::{AfterTurn, SessionId, WorkKind};
use super::tour::{AudienceClass, Tour};
use crate::grid::{Grid, Window};
use crate::memory::OutOfMemory;
use crate::protocol::{FENCE, TerminalMode, TerminalModes};
use crate::viewer::{DriverState, Frame, Job, Options, Request, Viewer, ViewerStep};
use base64::Engine;
pub(super) use guidance::Company;
use guidance::{Following, left_text, over_text};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

/// The time before the end of a visit during which the remaining seconds are shown.
const COUNTDOWN: Duration = Duration::from_secs(30);
/// The longest time that a leaving viewer waits for the terminal's last replies.
const LAST_REPLIES: Duration = Duration::from_secs(1);
/// The largest number of steps of the viewer in one turn, such as tracing a frame and drawing it.
// Most turns have two steps, a trace and a draw. The limit ends the turn of a viewer that never waits.
const MAX_STEPS: usize = 8;

/// The limits on the duration of a visit.
#[derive(Clone, Copy, Debug)]
pub(super) struct VisitLimits {
    /// The longest time without a key, after which the visit ends.
    pub(super) idle: Duration,
    /// The time at which the visit ends.
    pub(super) ends: Duration,
}

/// The input that has arrived for a session since its last turn.
#[derive(Debug, Default)]
pub(super) struct PendingInput {
    pub(super) bytes: Vec<u8>,
    /// The time at which the last of the bytes arrived.
    pub(super) at: Duration,
    pub(super) window: Option<Window>,
    /// The scenes that replace those of the session.
    pub(super) scenes: Option<Arc<[HostedScene]>>,
    /// The time at which the server ends, if it does.
    pub(super) drain_deadline: Option<Duration>,
    /// The tour that the server gives, if any.
    pub(super) tour: Option<Arc<Tour>>,
}

/// The parts of a new session that depend on the client and the settings.
pub(super) struct SessionOptions {
    pub(super) viewer: Options,
    pub(super) link: Option<String>,
    /// Whether the viewer starts in the tour.
    pub(super) follows_tour: bool,
    /// Whether the viewer may lead the tour.
    pub(super) may_lead: bool,
}

/// A change of what a viewer's screen shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AudienceChange {
    /// The frames for the audience of this class.
    Follow(AudienceClass),
    /// The view of the viewer's own camera.
    Leave,
}

/// A function that traces the frame of a job, or returns `None` if it was interrupted.
///
/// The flag allows an interruption; it is only set for refinements.
pub(super) type Trace<'a> = dyn FnMut(&Job, bool) -> Option<Frame> + 'a;

/// The state of one viewer on the server: the viewer's view, terminal modes and remaining time.
pub(super) struct ViewerSession {
    viewer: Viewer,
    modes: TerminalModes,
    scenes: Arc<[HostedScene]>,
    shown: usize,
    /// The name of the shown scene, for the other viewers.
    name: Arc<str>,
    link: Option<String>,
    limits: VisitLimits,
    drain_deadline: Option<Duration>,
    /// The seconds in the last note of the countdown; `None` before the countdown.
    counted: Option<u64>,
    /// The time at which the viewer began to leave and its terminal was restored, and the reason;
    /// `None` before.
    leaving: Option<(Duration, LeaveReason)>,
    /// The guide that the viewer follows; `None` in a view of their own camera.
    following: Option<Following>,
    /// The time at which the viewer last stopped following a guide; the idle time counts from it.
    own_since: Duration,
    may_lead: bool,
    /// Whether the viewer leads the tour, as far as they know.
    leads: bool,
    /// The sessions that have to be told of what this one has done.
    told: Vec<SessionId>,
    /// The class of the viewer's audience at the last call of `take_audience_change`.
    audience: Option<AudienceClass>,
    /// The time from which the viewer may join another audience.
    joins_from: Duration,
    /// The time at which the last turn ended.
    latest: Duration,
    /// The number of frames drawn since the last call of `take_drawn`.
    drawn: u64,
}

impl ViewerSession {
    /// Returns a session that shows the scene with index `shown`, or the tour.
    ///
    /// Appends its first bytes to `out`.
    ///
    /// # Errors
    /// If there is not enough memory for the window.
    pub(super) fn new(
        scenes: Arc<[HostedScene]>,
        shown: usize,
        options: SessionOptions,
        window: Window,
        limits: VisitLimits,
        now: Duration,
        out: &mut Vec<u8>,
    ) -> Result<Self, OutOfMemory> {
        let SessionOptions { viewer: options, link, follows_tour, may_lead } = options;
        let mut viewer = Viewer::new(options, window)?;
        viewer.set_names(scenes.iter().map(|scene| scene.name.clone()).collect());
        let mut modes = TerminalModes::default();
        for mode in TerminalMode::ALL_TERMINALS {
            modes.switch_on(mode, out);
        }
        out.extend(viewer.queries(now));
        let (drain_deadline, counted, leaving) = (None, None, None);
        let mut session = Self {
            viewer,
            modes,
            scenes,
            shown,
            name: Arc::default(),
            link,
            limits,
            drain_deadline,
            counted,
            leaving,
            following: follows_tour.then_some(Following { guide: Guide::Tour, since: now }),
            own_since: now,
            may_lead,
            leads: false,
            told: Vec::new(),
            audience: None,
            joins_from: now,
            latest: now,
            drawn: 0,
        };
        session.show(shown);
        Ok(session)
    }

    fn show(&mut self, index: usize) {
        if let Some(scene) = self.scenes.get(index) {
            self.viewer.show(scene.scene.clone(), index, scene.orbits);
            self.name = scene.name.as_str().into();
            self.shown = index;
        }
    }

    /// Replaces the scenes, and shows the one of the same name, or else the first one.
    ///
    /// The camera stays if the scene has the same own camera and the same place in the list.
    fn replace_scenes(&mut self, scenes: Arc<[HostedScene]>) {
        let before = std::mem::replace(&mut self.scenes, scenes);
        let name = &before[self.shown].name;
        let found = self.scenes.iter().position(|scene| scene.name == *name);
        self.viewer.set_names(self.scenes.iter().map(|scene| scene.name.clone()).collect());
        self.show(found.unwrap_or(0));
        if found.is_none() {
            self.viewer.show_note(format!("the scene {name} is no longer shown"));
        }
    }

    /// Handles the input that has arrived, carries out the viewer's actions, and appends the bytes
    /// to send.
    ///
    /// `sending` tells whether earlier bytes still wait to be sent. `kind` is the kind of work that the turn may do.
    /// At most one frame of a new view is traced.
    pub(super) fn take_turn(
        &mut self,
        (input, company): (&PendingInput, &Company<'_>),
        (sending, kind): (bool, WorkKind),
        clock: &dyn Fn() -> Duration,
        trace: &mut Trace<'_>,
        out: &mut Vec<u8>,
    ) -> AfterTurn {
        let now = clock();
        self.drain_deadline = input.drain_deadline.or(self.drain_deadline);
        if self.leaving.is_some() {
            return self.await_last_replies(&input.bytes, now);
        }
        let tour = input.tour.as_deref();
        // A lone ESC becomes a key without further bytes.
        let may_have_key = !input.bytes.is_empty() || self.viewer.receiver().sequence_times_out_at(now).is_some();
        let view_of = |guide| company.roster.view(guide, tour, now);
        if let Some(view) = self.following.filter(|_| may_have_key).and_then(|following| view_of(following.guide)) {
            // A key that leaves a guide moves the camera from where the guide is.
            self.stand_at(&view, now);
        }
        if self.apply_input(input, now, out).is_err() {
            return self.leave(LeaveReason::OutOfMemory, now, out);
        }
        if self.carry_out_requests(company, tour.is_some(), now, out).is_break() {
            return self.leave(LeaveReason::Quit, now, out);
        }
        if self.leads && company.roster.leader() != Some(company.id) {
            self.leads = false;
            self.viewer.show_note("another viewer leads the tour now");
        }
        if let Some(Following { guide, since }) = self.following {
            if self.viewer.last_press_time() > since {
                self.leave_guide(company, &left_text(guide), now);
            } else if !company.roster.shows(guide, tour.is_some()) {
                if let Some(view) = company.roster.last_view(guide) {
                    self.stand_at(&view, now);
                }
                self.leave_guide(company, &over_text(guide, company.roster), now);
            }
        }
        let (end, reason) = self.next_end();
        if now >= end {
            return self.leave(reason, now, out);
        }
        let counted = self.count_down(end, reason, now);
        if let (Some(Following { guide, .. }), Some(seconds)) = (self.following, self.counted) {
            if let Some(view) = view_of(guide) {
                self.stand_at(&view, now);
            }
            // The frames of an audience have no room for the countdown of one viewer.
            self.leave_guide(company, &reason.countdown_text(seconds), now);
        }
        self.show_to_others(company);
        if self.following.is_some() {
            self.latest = clock();
            let sequence = self.viewer.receiver().sequence_times_out_at(now);
            let joins = Some(self.joins_from).filter(|&at| at > self.latest && self.audience_class() != self.audience);
            return AfterTurn::Sleep(sequence.into_iter().chain(joins).chain([counted]).min());
        }
        let next = self.carry_out_steps(company, (sending, kind), clock, trace, out);
        self.show_to_others(company);
        self.latest = clock();
        match next {
            AfterTurn::Sleep(until) => AfterTurn::Sleep(until.into_iter().chain([counted]).min()),
            next => next,
        }
    }

    fn apply_input(&mut self, input: &PendingInput, now: Duration, out: &mut Vec<u8>) -> Result<(), OutOfMemory> {
        if let Some(window) = input.window {
            self.viewer.resize(window)?;
        }
        if let Some(scenes) = &input.scenes {
            self.replace_scenes(Arc::clone(scenes));
        }
        // `receive` is called without bytes, too, so that a lone ESC becomes the Escape key after its timeout. It gets
        // the time at which the bytes arrived: their wait for this turn is not part of the link's round trip. With that
        // wait included, a busy server took each link for a slow one, and frames shrank to 540 bytes at 200 viewers.
        let at = if input.bytes.is_empty() { now } else { input.at.max(self.latest).min(now) };
        self.viewer.receive(&input.bytes, at)?;
        for mode in self.viewer.optional_modes() {
            self.modes.switch_on(mode, out);
        }
        Ok(())
    }

    /// Returns the time at which the visit ends if no key is pressed, and the reason: an idle user,
    /// the limit of the visit, or the end of the server.
    fn next_end(&self) -> (Duration, LeaveReason) {
        // Before the first key press, the idle time counts from the beginning of the visit, or from the end of a tour.
        let since = self.viewer.last_input_time().max(self.own_since);
        let idle = (since + self.limits.idle, LeaveReason::Idle);
        let time_over = (self.limits.ends, LeaveReason::TimeOver);
        let drained = self.drain_deadline.map(|at| (at, LeaveReason::Drained));
        // A follower presses no key.
        let idle = Some(idle).filter(|_| self.following.is_none());
        drained.into_iter().chain(idle).fold(time_over, |first, end| if end.0 < first.0 { end } else { first })
    }

    /// Shows the seconds left during the countdown, and returns the time of the next change of that
    /// note.
    fn count_down(&mut self, end: Duration, reason: LeaveReason, now: Duration) -> Duration {
        // At most half the idle limit: otherwise, with a short limit, the note would be on the screen nearly always.
        let countdown = if reason == LeaveReason::Idle { COUNTDOWN.min(self.limits.idle / 2) } else { COUNTDOWN };
        let left = end.saturating_sub(now);
        if left > countdown {
            self.counted = None;
            return end.saturating_sub(countdown);
        }
        // Rounded up, so that 0 is never shown.
        let seconds = left.as_secs() + u64::from(left.subsec_nanos() > 0);
        // The note is set only once a second, because each new note causes a redraw.
        if self.counted.replace(seconds) != Some(seconds) {
            self.viewer.show_note(reason.countdown_text(seconds));
        }
        end.saturating_sub(Duration::from_secs(seconds - 1))
    }

    /// Carries out steps of the viewer, at most two of which trace a frame, until the turn ends.
    fn carry_out_steps(
        &mut self,
        company: &Company<'_>,
        (mut sending, kind): (bool, WorkKind),
        clock: &dyn Fn() -> Duration,
        trace: &mut Trace<'_>,
        out: &mut Vec<u8>,
    ) -> AfterTurn {
        let mut traced = false;
        for _ in 0..MAX_STEPS {
            let now = clock();
            match self.viewer.next_step(DriverState { sending, tracing: None }, now) {
                ViewerStep::Wait(until) => return AfterTurn::Sleep(until),
                ViewerStep::CancelRefinement => {}
                ViewerStep::Draw => {
                    if self.viewer.shows_others() {
                        self.viewer.set_others(&self.others(company));
                    }
                    let mut bytes = Vec::new();
                    self.viewer.draw(clock(), &mut bytes);
                    self.viewer.add_frame_queries(&mut bytes, clock());
                    sending |= !bytes.is_empty();
                    self.drawn += u64::from(!bytes.is_empty());
                    out.append(&mut bytes);
                }
                // Refinements wait for a turn of their kind, except that of the first picture: it is refined before it
                // is shown, if that takes little time.
                ViewerStep::Trace(_, job) if job.refines && kind == WorkKind::Picture && self.viewer.has_shown() => {
                    return AfterTurn::Turn(WorkKind::Refinement);
                }
                ViewerStep::Trace(probe, job) => {
                    out.extend_from_slice(&probe);
                    // Only refinements may be interrupted: an interrupted frame of a new view is not traced again, so a
                    // moving view would stand still while other viewers interrupt it.
                    match trace(&job, job.refines && self.viewer.has_shown()) {
                        Some(frame) => self.viewer.take_frame(frame),
                        None => return AfterTurn::Turn(WorkKind::Refinement),
                    }
                    // The turn goes on after its first traced frame, to draw it, and ends after the second one.
                    if std::mem::replace(&mut traced, true) {
                        return AfterTurn::Turn(kind);
                    }
                }
            }
        }
        AfterTurn::Turn(kind)
    }

    /// Carries out the viewer's requests; breaks if the user leaves.
    ///
    /// Requests to write to the server's disk, to turn a mesh or to suspend do nothing; no key is bound to them.
    fn carry_out_requests(
        &mut self,
        company: &Company<'_>,
        has_path: bool,
        now: Duration,
        out: &mut Vec<u8>,
    ) -> ControlFlow<()> {
        let mut copied = None;
        while let Some(request) = self.viewer.next_request() {
            match request {
                Request::Leave => return ControlFlow::Break(()),
                Request::SwitchScene(steps) => {
                    let count = self.scenes.len();
                    let index = (self.shown + steps.rem_euclid(count.cast_signed()).cast_unsigned()) % count;
                    let note = if count == 1 {
                        "only one scene".to_owned()
                    } else {
                        self.show(index);
                        format!("{} ({} of {count})", self.scenes[index].name, index + 1)
                    };
                    self.viewer.show_note(note);
                }
                Request::Tour if self.following.is_some_and(|following| following.guide == Guide::Tour) => {}
                Request::Tour if self.leads => self.viewer.show_note("you lead the tour; G ends that"),
                Request::Tour if !company.roster.shows(Guide::Tour, has_path) => {
                    self.viewer.show_note("there is no tour now");
                }
                Request::Tour => self.follow(company, Guide::Tour, now),
                Request::Lead if self.may_lead => self.toggle_lead(company, has_path, now),
                Request::ListViewers => {
                    let others = self.others(company);
                    self.viewer.turn_viewer_list(others);
                }
                Request::MarkViewers => {
                    let others = self.others(company);
                    self.viewer.toggle_other_eyes(others);
                }
                Request::Follow(digit) => match self.viewer.listed_viewer(digit) {
                    Some(number) => self.follow(company, Guide::Viewer(number), now),
                    None => self.viewer.show_note(format!("the list has no viewer {digit}")),
                },
                Request::ShowMetadata => self.viewer.show_metadata(self.scenes[self.shown].name.clone()),
                // Only the last text is sent, because only that stays on the clipboard; sending all of them would take
                // many bytes for a few keys.
                Request::Copy(text) => copied = Some(text),
                _ => {}
            }
        }
        if let Some(text) = copied {
            let encoded = base64::engine::general_purpose::STANDARD.encode(text);
            out.extend_from_slice(format!("\x1b]52;c;{encoded}\x1b\\").as_bytes());
        }
        ControlFlow::Continue(())
    }

    /// Swaps the grid that frames are drawn in for another one.
    pub(super) fn swap_grid(&mut self, grid: &mut Grid) {
        self.viewer.swap_grid(grid);
    }

    /// Returns the number of frames drawn since the last call.
    pub(super) fn take_drawn(&mut self) -> u64 {
        std::mem::take(&mut self.drawn)
    }

    /// Returns the reason why the viewer leaves, if it does.
    pub(super) fn leave_reason(&self) -> Option<LeaveReason> {
        self.leaving.map(|(_, reason)| reason)
    }

    /// Restores the terminal, and prints the farewell and the command that shows this view.
    pub(super) fn leave(&mut self, reason: LeaveReason, now: Duration, out: &mut Vec<u8>) -> AfterTurn {
        self.modes_off(now, out);
        out.extend_from_slice(reason.farewell().as_bytes());
        let HostedScene { file, .. } = &self.scenes[self.shown];
        let camera = self.viewer.moved_camera().map(|camera| format!(" {}", camera.rounded().to_flags()));
        let command = format!("this view at home: termtrace {file}{}\r\n", camera.unwrap_or_default());
        out.extend_from_slice(command.as_bytes());
        if let Some(link) = &self.link {
            out.extend_from_slice(format!("{link}\r\n").as_bytes());
        }
        self.leaving = Some((now, reason));
        self.await_last_replies(&[], now)
    }

    /// Switches all modes off. If replies are outstanding, sends a last query.
    ///
    /// Terminals reply in order, so the reply to the last query is the last reply.
    fn modes_off(&mut self, now: Duration, out: &mut Vec<u8>) {
        let awaits = self.modes.is_on(TerminalMode::Keyboard) || self.viewer.receiver().reply_time_left(now).is_some();
        self.modes.switch_all_off(out);
        if awaits {
            out.extend_from_slice(FENCE);
            self.viewer.receiver().sent(FENCE, now);
        }
    }

    /// Reads and drops the terminal's replies until the last one has arrived.
    ///
    /// Otherwise the user's shell would take them for typed text.
    fn await_last_replies(&mut self, bytes: &[u8], now: Duration) -> AfterTurn {
        let receiver = self.viewer.receiver();
        receiver.receive(bytes, now);
        let due = self.leaving.map_or(now, |(since, _)| since + LAST_REPLIES);
        if receiver.reply_time_left(now).is_none() || now >= due { AfterTurn::End } else { AfterTurn::Sleep(Some(due)) }
    }

    /// Restores the terminal after a panic in a turn.
    pub(super) fn abandon(&mut self, out: &mut Vec<u8>) {
        self.modes.switch_all_off(out);
        out.extend_from_slice(LeaveReason::Fault.farewell().as_bytes());
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
