//! The state that all connections share: scenes, settings, limits, and the threads that draw.

use super::client_terminal::ClientTerminal;
use super::limits::{ConnectionLimiter, Places, Refusal, anonymized};
use super::lock::locked;
use super::log_line::LogLine;
use super::total_rate::TotalRate;
use super::tour::{AudienceLimits, Tour};
use super::worker_pool::WorkerPool;
use super::{HostedScene, Log, Settings};
use crate::camera_path::PathError;
use crate::capabilities::{Colors, terminfo_colors};
use crate::control::{Command, Key, KeyMode, Keymap};
use crate::export::text_frame;
use crate::grid::Size;
use crate::viewer::Options;
use russh::server::Config;
use std::collections::HashMap;
use std::fmt::Write;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;
use tokio::sync::watch;

/// The commands that no key is bound to on the server.
///
/// They would write to the server's disk, read a mesh file again, or stop the server.
const LEFT_OUT: [Command; 6] =
    [Command::Export, Command::ExportLarge, Command::Record, Command::KeepView, Command::TurnMesh, Command::Suspend];

/// The keys that only a server has: for the tour, its lead, and the list and the marks of viewers.
const TOUR_KEY: Key = Key::letter('T');
const LEAD_KEY: Key = Key::letter('G');
const LIST_KEY: Key = Key::letter('u');
const MARKS_KEY: Key = Key::letter('U');

/// The largest number of bytes in one SSH message to a client.
// The buffer of a connection never shrinks: it keeps the size of the largest message.
const MAX_MESSAGE: usize = 8 * 1024;

/// The largest number of terminal names whose colours are cached.
// Clients choose the names, so without a limit the map would grow for ever.
const MAX_TERMINALS: usize = 256;

/// The settings and the scenes of the server, which a reload replaces as a whole.
pub(super) struct Setup {
    pub(super) settings: Settings,
    pub(super) scenes: Arc<[HostedScene]>,
    pub(super) tour: Option<Arc<Tour>>,
    keymap: Keymap,
    /// The keymap of those who may lead the tour.
    leaders_keymap: Keymap,
    /// The configuration of SSH that follows from the settings.
    pub(super) ssh: Arc<Config>,
    /// One frame of each scene as text, made when it is first asked for.
    // Kept, because otherwise a client could make the server trace a frame with each request.
    text_frames: Vec<OnceLock<String>>,
}

impl Setup {
    /// Returns the settings, the scenes and the configuration of SSH as one value.
    ///
    /// # Errors
    /// If a camera of the tour is invalid.
    pub(super) fn new(settings: Settings, scenes: Vec<HostedScene>, ssh: Config) -> Result<Self, PathError> {
        let text_frames = scenes.iter().map(|_| OnceLock::new()).collect();
        let tour = settings.tour.as_ref().zip(scenes.first()).map(|(path, scene)| Tour::new(path, scene));
        let tour = tour.transpose()?.map(Arc::new);
        let mut keymap = Keymap::default();
        keymap.remove(&LEFT_OUT);
        keymap.bind(KeyMode::Always, LIST_KEY, Some(Command::ListViewers));
        keymap.bind(KeyMode::Always, MARKS_KEY, Some(Command::MarkViewers));
        if tour.is_some() || settings.leaders.is_some() {
            keymap.bind(KeyMode::Always, TOUR_KEY, Some(Command::Tour));
        }
        let mut leaders_keymap = keymap.clone();
        leaders_keymap.bind(KeyMode::Always, LEAD_KEY, Some(Command::Lead));
        Ok(Self { settings, scenes: scenes.into(), tour, keymap, leaders_keymap, ssh: Arc::new(ssh), text_frames })
    }

    /// Returns the largest number of connections.
    fn max_connections(&self) -> usize {
        // There may be more connections than viewers, because some only ask for text, and some wait for a place.
        2 * self.settings.max_viewers + 64
    }

    /// Returns a frame of 80x24 cells of a scene as text, for clients without a terminal.
    pub(super) fn text_frame(&self, scene: usize) -> &str {
        self.text_frames[scene].get_or_init(|| text_frame(&self.scenes[scene].scene, Size::new(80, 24)))
    }

    /// Returns the list of scenes.
    pub(super) fn scene_list(&self) -> String {
        let width = self.scenes.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
        self.scenes.iter().fold(String::new(), |mut list, HostedScene { name, title, .. }| {
            let _ = write!(list, "{}\r\n", format!("{name:width$}  {title}").trim_end());
            list
        })
    }
}

/// The state that all connections share.
pub(super) struct SharedState {
    setup: Mutex<Arc<Setup>>,
    pub(super) pool: Arc<WorkerPool>,
    pub(super) limiter: Mutex<ConnectionLimiter>,
    places: Mutex<Places>,
    /// The queue that limits the bytes per second of all viewers together; `None` for no limit.
    total_rate: Mutex<Option<TotalRate>>,
    /// A signal without a value: notifies receivers when a place is freed, a visitor leaves the
    /// queue, or the server begins to drain.
    pub(super) changes: watch::Sender<()>,
    drain_deadline: OnceLock<Duration>,
    log: Log,
    /// The colours of terminals according to terminfo, which is read once for each name.
    terminals: Mutex<HashMap<String, Option<Colors>>>,
}

impl SharedState {
    pub(super) fn new(setup: Setup, pool: Arc<WorkerPool>, log: Log) -> Self {
        let settings = &setup.settings;
        pool.set_tour(setup.tour.clone(), AudienceLimits::new(settings));
        Self {
            limiter: Mutex::new(ConnectionLimiter::new(setup.max_connections(), settings.max_per_address)),
            places: Mutex::new(Places::new(settings.max_viewers)),
            total_rate: Mutex::new(settings.max_rate_total.map(TotalRate::new)),
            changes: watch::Sender::new(()),
            drain_deadline: OnceLock::new(),
            terminals: Mutex::default(),
            setup: Mutex::new(Arc::new(setup)),
            pool,
            log,
        }
    }

    /// Returns the current settings and scenes.
    pub(super) fn setup(&self) -> Arc<Setup> {
        Arc::clone(&locked(&self.setup))
    }

    /// Replaces the settings and the scenes.
    ///
    /// Open views get the scenes; the limits on all viewers together count at once.
    pub(super) fn replace_setup(&self, setup: Setup) {
        let Settings { max_viewers, max_per_address, max_rate_total, .. } = setup.settings;
        locked(&self.limiter).set_limits(setup.max_connections(), max_per_address);
        locked(&self.places).set_most(max_viewers);
        *locked(&self.total_rate) = max_rate_total.map(TotalRate::new);
        let scenes = Arc::clone(&setup.scenes);
        self.pool.set_tour(setup.tour.clone(), AudienceLimits::new(&setup.settings));
        *locked(&self.setup) = Arc::new(setup);
        self.pool.replace_scenes(&scenes);
        // There may be more places now.
        self.changes.send_replace(());
    }

    /// Returns the most bytes of a message to a client.
    pub(super) fn max_message(&self) -> usize {
        if locked(&self.total_rate).is_some() { TotalRate::MAX_PART } else { MAX_MESSAGE }
    }

    /// Returns how long a message has to wait for the limit on the bytes of all viewers together.
    pub(super) fn reserve_wait(&self, bytes: usize) -> Duration {
        let now = self.pool.now();
        locked(&self.total_rate).as_mut().map_or(Duration::ZERO, |rate| rate.reserve_wait(bytes, now))
    }

    /// Writes a line into the log.
    pub(super) fn log(&self, line: &LogLine) {
        (self.log)(line.text());
    }

    /// Counts and logs a connection from `address` that is refused.
    pub(super) fn refuse(&self, address: IpAddr, refusal: Refusal) {
        self.pool.metrics.refuse(refusal);
        let line = LogLine::event("refused").with("from", anonymized(address));
        self.log(&line.with("reason", refusal.name()));
    }

    /// Returns the options of a new viewer, whose window has this number of columns.
    pub(super) fn viewer_options(
        &self,
        setup: &Setup,
        terminal: &ClientTerminal,
        columns: u16,
        may_lead: bool,
    ) -> Options {
        let Setup { settings, scenes, keymap, leaders_keymap, .. } = setup;
        let keymap = if may_lead { leaders_keymap } else { keymap };
        let mut options = Options::new(terminal.hints(&|name| self.terminal_colors(name)));
        options.max_rate = settings.max_rate;
        options.max_frames = Some(settings.max_frames);
        // A picture in finer glyphs takes several times as much of the time and memory that viewers share.
        options.finer_at_rest = false;
        options.keymap = keymap.clone();
        options.welcome = Some(welcome_line(scenes.len(), settings.link.as_deref(), columns));
        options
    }

    fn terminal_colors(&self, name: &str) -> Option<Colors> {
        let mut known = locked(&self.terminals);
        if let Some(colors) = known.get(name) {
            return *colors;
        }
        let colors = terminfo_colors(name);
        if known.len() < MAX_TERMINALS {
            known.insert(name.to_owned(), colors);
        }
        colors
    }

    /// Returns the server's counts in the text format of Prometheus.
    pub(super) fn metrics_text(&self) -> String {
        self.pool.metrics.text(&[
            ("viewers", "Views that are open", self.pool.session_count()),
            ("followers", "Views of the tour or of another viewer", self.pool.follower_count()),
            ("waiting", "Visitors who wait for a place", locked(&self.places).waiting()),
            ("draining", "Whether the server ends soon", usize::from(self.drain_deadline().is_some())),
        ])
    }

    /// Begins to drain: the viewers have to leave by this time.
    pub(super) fn drain(&self, at: Duration) {
        if self.drain_deadline.set(at).is_ok() {
            self.pool.drain(at);
            self.changes.send_replace(());
        }
    }

    /// Returns the time by which the viewers have to leave; `None` unless the server drains.
    pub(super) fn drain_deadline(&self) -> Option<Duration> {
        self.drain_deadline.get().copied()
    }

    /// Adds a visitor at the end of the queue for a place; `None` if too many visitors wait.
    pub(super) fn queue_up(self: &Arc<Self>) -> Option<VisitorDetails> {
        let number = locked(&self.places).join()?;
        Some(VisitorDetails { state: Arc::clone(self), number })
    }
}

/// Returns the line shown until the first key press: the main keys, or fewer if they do not fit.
fn welcome_line(scene_count: usize, link: Option<&str>, columns: u16) -> String {
    let next = if scene_count > 1 { ", n next scene" } else { "" };
    let link = link.map(|link| format!("  {link}")).unwrap_or_default();
    let line = format!("drag or WASD moves, t turns{next}, ? all keys, q quits{link}");
    // The line is drawn with a blank at each side.
    if line.chars().count() + 2 <= usize::from(columns) { line } else { format!("? all keys, q quits{link}") }
}

/// A visitor in the queue for a place, which leaves it when it is dropped.
pub(super) struct VisitorDetails {
    state: Arc<SharedState>,
    number: u64,
}

impl VisitorDetails {
    /// Takes a place; if none is free, returns how many visitors are ahead.
    pub(super) fn take_place(&self) -> Result<ViewerSlot, usize> {
        locked(&self.state.places).take(self.number)?;
        Ok(ViewerSlot(Arc::clone(&self.state)))
    }
}

impl Drop for VisitorDetails {
    fn drop(&mut self) {
        locked(&self.state.places).give_up(self.number);
        self.state.changes.send_replace(());
    }
}

/// A viewer's place, which is freed when it is dropped.
pub(super) struct ViewerSlot(Arc<SharedState>);

impl Drop for ViewerSlot {
    fn drop(&mut self) {
        locked(&self.0.places).free();
        self.0.changes.send_replace(());
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
