//! Any number of viewers over SSH, each with a view of its own, in one process.
//!
//! A client gets a terminal with the view of a scene, and nothing else. One thread owns the sockets ([`tokio`],
//! `russh`); it never traces. The other threads are the `worker_pool`: each turn of a `viewer_session` runs on one of
//! them, from its input to its bytes, and the `run_queue` shares their time fairly. Between a connection and its
//! session are the `session_buffers`, with at most one frame. `limits` counts connections and places for viewers; `ssh`
//! and `client_command` define what a client may ask for; `visit` leads a client through the queue to its session.
//! Viewers who follow the `tour` or another viewer get the frames of an `audience` instead of their session's; the
//! `roster` knows who sees what.
//!
//! The modules `run_queue`, `viewer_session`, `leave_reason`, `limits`, `total_rate`, `tour`, `guide`, `roster`,
//! `network`, `log_line`, `client_command` and `client_terminal` are pure: they do no I/O, and the time is a parameter.

use crate::camera_path::CameraPath;
use crate::scene::Scene;
use crate::terminal::{Signals, without_signals};
use limits::{Admission, Refusal, anonymized};
use lock::locked;
use log_line::LogLine;
pub use network::Network;
use proxy_header::ReadHeader;
use russh::keys::{PrivateKey, PublicKey};
use russh::server::{Config, run_stream};
use russh::{MethodKind, MethodSet, Preferred, SshId, mac};
use rustix::event::{PollFd, PollFlags, poll};
use session_buffers::SessionBuffers;
use shared_state::{Setup, SharedState};
use socket::Socket;
use ssh::Client;
use std::borrow::Cow;
use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{sleep, timeout};
use worker_pool::WorkerPool;

mod audience;
mod client_command;
mod client_terminal;
mod frame_window;
mod guide;
mod host_key;
mod leave_reason;
mod limits;
mod lock;
mod log_line;
mod metrics;
mod network;
mod pictures;
mod proxy_header;
mod roster;
mod run_queue;
mod scrape;
mod session_buffers;
mod shared_state;
mod socket;
mod ssh;
mod total_rate;
mod tour;
mod viewer_session;
mod visit;
mod worker_pool;

/// Pause after a failed `accept`, such as with too many open files.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// The largest number of connections of load balancers whose header has not arrived yet.
const MAX_HEADERS: usize = 256;

const NO_SCENE: &str = "there is no scene to show";

/// A scene that the server shows to its viewers.
#[derive(Clone, Debug)]
pub struct HostedScene {
    /// The name by which clients ask for the scene, as in `ssh HOST NAME`.
    pub name: String,
    /// The scene's file in the command that is printed when a viewer leaves: `termtrace FILE ...`.
    pub file: String,
    /// One line that says what the scene shows, for the list of scenes.
    pub title: String,
    /// The scene.
    pub scene: Scene,
    /// Whether the view starts in orbit mode.
    pub orbits: bool,
}

/// The settings of a server.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The address to listen at.
    pub listen: SocketAddr,
    /// The file of the host key, which is made if there is none.
    pub host_key: PathBuf,
    /// The largest number of viewers at a time. More clients wait in a queue.
    pub max_viewers: usize,
    /// The most connections from one address.
    pub max_per_address: usize,
    /// The longest time without a key press. After it, the viewer is disconnected.
    pub idle: Duration,
    /// The longest time that a visit may last.
    pub session_max: Duration,
    /// The most bytes per second for one viewer.
    pub max_rate: Option<u32>,
    /// The most bytes per second for all viewers together.
    pub max_rate_total: Option<u32>,
    /// The most frames per second for one viewer.
    pub max_frames: f32,
    /// The threads that draw; `None` for one per core.
    pub threads: Option<usize>,
    /// The public keys of the users who may log in; `None` if every user may.
    pub authorized_keys: Option<Vec<PublicKey>>,
    /// The public keys of the users who may lead the tour.
    pub leaders: Option<Vec<PublicKey>>,
    /// Whether viewers see the login names of one another.
    pub show_names: bool,
    /// The text that clients print before the login.
    pub banner: Option<String>,
    /// The URL that is shown in the welcome line and printed when a viewer leaves.
    pub link: Option<String>,
    /// The address at which the server's counts can be read, in the text format of Prometheus.
    pub metrics: Option<SocketAddr>,
    /// The camera path of the tour through the first scene, if there is one.
    pub tour: Option<CameraPath>,
    /// The networks of load balancers, which tell the address of each client by the PROXY protocol.
    pub proxies: Vec<Network>,
    /// The longest time that a client may take to log in.
    pub login_time: Duration,
    /// The longest time in which a client takes no bytes. After it, the connection is closed.
    pub patience: Duration,
    /// The time that viewers have for leaving when the server ends.
    pub drain: Duration,
}

impl Settings {
    /// Returns the default settings, with the host key in this file.
    pub fn new(host_key: PathBuf) -> Self {
        Self {
            listen: SocketAddr::from(([127, 0, 0, 1], 2222)),
            host_key,
            // On two cores, 200 moving views of 80x24 cells were measured at 12 to 28 frames per second each.
            max_viewers: 200,
            max_per_address: 10,
            idle: Duration::from_secs(600),
            session_max: Duration::from_secs(3600),
            max_rate: Some(200_000),
            max_rate_total: None,
            max_frames: 30.0,
            threads: None,
            authorized_keys: None,
            leaders: None,
            show_names: false,
            banner: None,
            link: None,
            metrics: None,
            tour: None,
            proxies: Vec::new(),
            // `russh` does not limit the time for the login: 500 of 500 connections that sent nothing were still open
            // after 20 seconds.
            login_time: Duration::from_secs(10),
            patience: Duration::from_secs(20),
            drain: Duration::from_secs(30),
        }
    }
}

impl Settings {
    /// Returns the name of the first setting that differs and cannot change while a server runs.
    fn first_fixed_change(&self, before: &Self) -> Option<&'static str> {
        let changes = [
            ("listen", self.listen != before.listen),
            ("host_key", self.host_key != before.host_key),
            ("threads", self.threads != before.threads),
            ("metrics", self.metrics != before.metrics),
        ];
        changes.into_iter().find_map(|(name, has_changed)| has_changed.then_some(name))
    }
}

/// Reads the public keys of a file as `sshd` does, but does not accept options before a key.
///
/// # Errors
/// If the file cannot be read, or a line is no public key.
pub fn authorized_keys(path: &Path) -> io::Result<Vec<PublicKey>> {
    let text = std::fs::read_to_string(path)?;
    let lines = (1..).zip(text.lines().map(str::trim)).filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let parsed = lines.map(|(number, line)| {
        PublicKey::from_openssh(line)
            .map_err(|error| io::Error::other(format!("line {number}: no public key: {error}")))
    });
    parsed.collect()
}

/// A running server of views over SSH.
pub struct Server {
    state: Arc<SharedState>,
    key: PrivateKey,
    address: SocketAddr,
    metrics: Option<SocketAddr>,
    fingerprint: String,
    sockets: Option<JoinHandle<()>>,
    threads: Vec<JoinHandle<()>>,
    ended: Arc<AtomicBool>,
}

/// A function that receives the lines of a server's log, such as `event=drain viewers=12`.
pub type Log = Arc<dyn Fn(&str) + Send + Sync>;

impl Server {
    /// Starts a server, which shows the first scene unless a client names another one.
    ///
    /// `on_end` is called when the server has ended after [`drain`](Self::drain).
    ///
    /// # Errors
    /// If there is no scene, the host key cannot be read or made, or the address cannot be used. The error names the
    /// file or the address.
    pub fn start(
        scenes: Vec<HostedScene>,
        settings: Settings,
        log: Log,
        on_end: impl FnOnce() + Send + 'static,
    ) -> io::Result<Self> {
        Self::start_on(None, scenes, settings, log, on_end)
    }

    /// Starts a server as [`start`](Self::start) does, on a socket that listens already, if given.
    ///
    /// `settings.listen` then has no effect.
    ///
    /// # Errors
    /// As for [`start`](Self::start).
    pub fn start_on(
        socket: Option<TcpListener>,
        scenes: Vec<HostedScene>,
        settings: Settings,
        log: Log,
        on_end: impl FnOnce() + Send + 'static,
    ) -> io::Result<Self> {
        if scenes.is_empty() {
            return Err(io::Error::other(NO_SCENE));
        }
        let named = |what: String| move |error: io::Error| io::Error::new(error.kind(), format!("{what}: {error}"));
        let key = host_key::load_or_make(&settings.host_key).map_err(named(settings.host_key.display().to_string()))?;
        // The address is bound here and not by the thread of the sockets, so that `start` reports an address in use.
        let bind = |address: SocketAddr| TcpListener::bind(address).map_err(named(address.to_string()));
        // tokio's `TcpListener::from_std` needs a non-blocking socket.
        let prepared =
            |socket: TcpListener| socket.set_nonblocking(true).and_then(|()| Ok((socket.local_addr()?, socket)));
        let (address, listener) = prepared(socket.map_or_else(|| bind(settings.listen), Ok)?)?;
        let (metrics, counts) = settings.metrics.map(bind).transpose()?.map(prepared).transpose()?.unzip();
        let cores = || thread::available_parallelism().map_or(1, usize::from);
        let (pool, threads) = WorkerPool::start(settings.threads.unwrap_or_else(cores))?;
        let fingerprint = host_key::fingerprint(&key);
        let ssh = ssh_config(&settings, key.clone());
        let setup = Setup::new(settings, scenes, ssh).map_err(|error| io::Error::other(format!("tour: {error}")))?;
        let state = Arc::new(SharedState::new(setup, pool, log));
        let (ended, shared) = (Arc::new(AtomicBool::new(false)), Arc::clone(&state));
        let flag = Arc::clone(&ended);
        // One thread suffices for the sockets, and leaves the cores to the threads that draw.
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let sockets = thread::Builder::new().name("sockets".to_owned()).spawn(move || {
            runtime.block_on(async {
                if let Some(Ok(listener)) = counts.map(tokio::net::TcpListener::from_std) {
                    tokio::spawn(scrape::serve(Arc::clone(&shared), listener));
                }
                serve_until_drained(shared, listener).await;
            });
            flag.store(true, Ordering::SeqCst);
            on_end();
        })?;
        Ok(Self { state, key, address, metrics, fingerprint, sockets: Some(sockets), threads, ended })
    }

    /// Returns the address that the server listens at.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Returns the address at which the server's counts can be read, if there is one.
    pub fn metrics_address(&self) -> Option<SocketAddr> {
        self.metrics
    }

    /// Returns the host key's fingerprint: `SHA256:...`.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }

    /// Returns the number of viewers.
    pub fn viewers(&self) -> usize {
        self.state.pool.session_count()
    }

    /// Makes a session's turn on a drawing thread panic if its input contains `byte`, for tests.
    #[cfg(feature = "test-hooks")]
    pub fn panic_at(&self, byte: u8) {
        let _ = self.state.pool.panics.set(byte);
    }

    /// Replaces the scenes and the settings.
    ///
    /// New views have all new settings. Open views keep the times and rates of their beginning, and get the new scenes:
    /// each shows the scene of the same name. The settings that cannot change while the server runs are `listen`,
    /// `host_key`, `threads` and `metrics`. If there is no scene, or the tour is invalid, nothing changes.
    pub fn reload(&self, scenes: Vec<HostedScene>, settings: Settings) {
        if scenes.is_empty() {
            return self.state.log(&LogLine::event("reload_failed").with("error", NO_SCENE));
        }
        let line = LogLine::event("reload").with("scenes", scenes.len());
        let unchanged = settings.first_fixed_change(&self.state.setup().settings);
        let line = unchanged.into_iter().fold(line, |line, name| line.with("needs_restart", name));
        let ssh = ssh_config(&settings, self.key.clone());
        match Setup::new(settings, scenes, ssh) {
            Ok(setup) => {
                self.state.replace_setup(setup);
                self.state.log(&line);
            }
            Err(error) => self.state.log(&LogLine::event("reload_failed").with("error", format!("tour: {error}"))),
        }
    }

    /// Accepts no more connections, and tells all viewers that they have to leave.
    pub fn drain(&self) {
        let (viewers, time) = (self.viewers(), self.state.setup().settings.drain);
        self.state.log(&LogLine::event("drain").with("viewers", viewers).with("seconds", time.as_secs()));
        self.state.drain(self.state.pool.now() + time);
    }

    /// Returns whether the server has ended after [`drain`](Self::drain).
    pub fn has_ended(&self) -> bool {
        self.ended.load(Ordering::SeqCst)
    }

    /// Waits until the server has ended after [`drain`](Self::drain), and ends its threads.
    pub fn join(mut self) {
        if let Some(sockets) = self.sockets.take() {
            let _ = sockets.join();
        }
        self.state.pool.close();
        for thread in self.threads.drain(..) {
            // An error means a panic of the thread, which the panic hook has already reported.
            let _ = thread.join();
        }
    }
}

/// A function that reads the scenes and the settings of a server, or returns the text of an error.
pub type Reader<'a> = dyn FnMut() -> Result<(Vec<HostedScene>, Settings), String> + 'a;

/// Runs a server until a signal asks it to end and it has drained; a second signal ends it at once.
///
/// SIGHUP replaces the scenes and settings by those that `read` returns. But if the server's terminal has been closed,
/// which sends SIGHUP too, the server drains. `started` is told the address and the host key's fingerprint. `socket` is
/// one that listens already, if there is one.
///
/// # Errors
/// As for [`Server::start`].
pub fn run_until_drained(
    socket: Option<TcpListener>,
    (scenes, settings): (Vec<HostedScene>, Settings),
    read: &mut Reader<'_>,
    signals: &mut Signals,
    log: &Log,
    started: impl FnOnce(SocketAddr, &str),
) -> io::Result<Option<i32>> {
    let mut waker = signals.waker()?;
    let start = || Server::start_on(socket, scenes, settings, Arc::clone(log), move || waker.wake());
    let server = without_signals(start)?;
    started(server.address(), server.fingerprint());
    let mut draining = false;
    loop {
        // An error of `poll`, such as an interruption by a signal, is ignored: the code below checks the state itself.
        let _ = poll(&mut [PollFd::from_borrowed_fd(signals.wake_pipe(), PollFlags::IN)], None);
        signals.drain();
        let reloads = signals.take_reload();
        if server.has_ended() {
            server.join();
            return Ok(None);
        }
        if reloads && !draining {
            match read() {
                Ok((scenes, settings)) => server.reload(scenes, settings),
                Err(error) => server.state.log(&LogLine::event("reload_failed").with("error", error)),
            }
        }
        // Taken, as the loop also wakes for signals that do not ask the server to end, or twice for one signal.
        match signals.take_deadly() {
            Some(signal) if draining => return Ok(Some(signal)),
            Some(_) if !draining => {
                draining = true;
                server.drain();
            }
            _ => {}
        }
    }
}

/// Returns the configuration of SSH: the host key, the ways to log in, and the limits of a
/// connection.
fn ssh_config(settings: &Settings, key: PrivateKey) -> Config {
    let with_keys = settings.authorized_keys.is_some();
    let macs = [mac::HMAC_SHA256_ETM, mac::HMAC_SHA512_ETM, mac::HMAC_SHA256, mac::HMAC_SHA512];
    Config {
        server_id: SshId::Standard(Cow::Borrowed("SSH-2.0-termtrace")),
        methods: if with_keys { MethodSet::from(&[MethodKind::PublicKey][..]) } else { MethodSet::empty() },
        // A delay after each rejected login slows down guessing. The first request of an OpenSSH client only asks for
        // the methods, so its rejection is not delayed.
        auth_rejection_time: Duration::from_millis(500),
        auth_rejection_time_initial: Some(Duration::ZERO),
        keys: vec![key],
        // Small receive windows suffice, because clients only send keys; only the output is large.
        window_size: 16 * 1024,
        maximum_packet_size: 4 * 1024,
        channel_buffer_size: 4,
        event_buffer_size: 2,
        // The default of OpenSSH (`MaxAuthTries`) is 6. A visitor by the name of a leader may have more keys, all of
        // them of no use here.
        max_auth_attempts: if settings.leaders.is_some() { 16 } else { 6 },
        // Not needed here: `ViewerSession` limits the time without a key, and `Socket` the time in which a client takes
        // no bytes.
        inactivity_timeout: None,
        preferred: Preferred { mac: Cow::Owned(macs.to_vec()), ..Preferred::default() },
        ..Config::default()
    }
}

/// Accepts connections until the server drains, and waits until the last viewer has left.
async fn serve_until_drained(state: Arc<SharedState>, listener: TcpListener) {
    let listener = match tokio::net::TcpListener::from_std(listener) {
        Ok(listener) => listener,
        Err(error) => return state.log(&LogLine::event("socket_failed").with("error", error)),
    };
    let mut changes = state.changes.subscribe();
    let accepting = tokio::spawn(accept_all(Arc::clone(&state), listener));
    while state.drain_deadline().is_none() && changes.changed().await.is_ok() {}
    accepting.abort();
    // Viewers get up to three seconds more, for the last replies of their terminals and the last bytes to them.
    let end = state.drain_deadline().unwrap_or_default() + Duration::from_secs(3);
    while state.pool.session_count() > 0 && state.pool.now() < end {
        let _ = timeout(Duration::from_millis(200), changes.changed()).await;
    }
    // The tasks of the connections run on this thread, and need time to send their last messages.
    sleep(Duration::from_millis(200)).await;
}

/// Accepts connections for ever.
// Used instead of the loop of `russh`, which ends at the first error of `accept`.
async fn accept_all(state: Arc<SharedState>, listener: tokio::net::TcpListener) {
    let headers = Arc::new(Semaphore::new(MAX_HEADERS));
    loop {
        match listener.accept().await {
            Ok((stream, address)) => {
                let (state, address) = (Arc::clone(&state), address.ip());
                if state.setup().settings.proxies.iter().any(|proxy| proxy.contains(address)) {
                    match Arc::clone(&headers).try_acquire_owned() {
                        Ok(place) => drop(tokio::spawn(admit_proxied(state, stream, (address, place)))),
                        Err(_) => state.refuse(address, Refusal::Busy),
                    }
                } else {
                    admit(state, stream, (address, Vec::new()));
                }
            }
            // The error may pass: if too many files are open, for example, other connections may end meanwhile.
            Err(error) => {
                state.log(&LogLine::event("accept_failed").with("error", error));
                sleep(ACCEPT_PAUSE).await;
            }
        }
    }
}

/// Reads the header of a load balancer at `address`, and admits its client.
async fn admit_proxied(state: Arc<SharedState>, stream: TcpStream, (address, place): (IpAddr, OwnedSemaphorePermit)) {
    let header = proxy_header::read(&stream).await;
    drop(place);
    match header {
        Some(ReadHeader { client, rest }) => admit(state, stream, (client.unwrap_or(address), rest)),
        None => state.refuse(address, Refusal::Header),
    }
}

/// Admits a connection of a client at `address`, or refuses it.
///
/// `first` is what has been read from the connection.
fn admit(state: Arc<SharedState>, stream: TcpStream, (address, first): (IpAddr, Vec<u8>)) {
    let entry = locked(&state.limiter).enter(address, state.pool.now());
    match entry {
        Ok(entry) => {
            state.pool.metrics.connections.add(1);
            let socket = Socket::new(stream, first, state.setup().settings.patience);
            tokio::spawn(connect(state, socket, (entry, anonymized(address))));
        }
        // Closing the connection costs the least; a message to the client would need the whole handshake.
        Err(refusal) => state.refuse(address, refusal),
    }
}

/// Serves one connection, and closes it if the client does not log in or request anything in time.
async fn connect(state: Arc<SharedState>, socket: Socket, (entry, from): (Admission, String)) {
    let setup = state.setup();
    let (login_time, idle) = (setup.settings.login_time, setup.settings.idle);
    let (closer, buffers) = (socket.closer(), Arc::new(SessionBuffers::default()));
    let client = Client {
        state,
        buffers: Arc::clone(&buffers),
        closer: closer.clone(),
        entry: Some(entry),
        from,
        user: visit::User::default(),
        terminal: client_terminal::ClientTerminal::default(),
        channel: None,
        asked: false,
    };
    let log_in = async {
        let session = run_stream(Arc::clone(&setup.ssh), socket, client).await.ok()?;
        buffers.logged_in.notified().await;
        Some(session)
    };
    match timeout(login_time, log_in).await {
        Ok(Some(_session)) => {
            if timeout(idle, buffers.asked.notified()).await.is_err() {
                closer.close();
            }
        }
        Ok(None) => {}
        Err(_) => closer.close(),
    }
}
