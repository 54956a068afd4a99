//! The server's command line.

use crate::cli::encoding::parse_rate;
use crate::cli::folder;
use crate::cli::outcome::{CommandResult, Failure, print_error, reason, usage, warn, write_stdout};
use crate::cli::scene_args::CameraArgs;
use crate::cli::scene_source::SceneSource;
use crate::cli::settings::{parse_fps, read_as_flags};
use crate::cli::shipped::ShippedScene;
use clap::{ArgMatches, Args, FromArgMatches};
use listenfd::ListenFd;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use termtrace::CameraPath;
use termtrace::internals::serve::{self, HostedScene, Network, Settings};
use termtrace::internals::terminal::die_of;
use termtrace::internals::text::visible;
use termtrace::live::Signals;

const EXAMPLES: &str = "\
Without a scene all built-in ones are shown. Whoever connects sees the first
one; n shows the next one. The keys of the live view work, but for those that
write a file.

Examples:
  termtrace serve
  ssh -p 2222 127.0.0.1                    look; q leaves
  ssh -t -p 2222 127.0.0.1 corridor        one of the scenes
  ssh -p 2222 127.0.0.1 --list             their names
  termtrace serve scenes --listen 0.0.0.0:2222 --public

SIGTERM tells all viewers that they have 30 seconds, and ends; a second one
ends at once. SIGHUP reads the scenes and the settings again.";

/// Limits on the link, in characters, and on the banner, in bytes.
// The short welcome has 19 columns. With two blanks before the link and one at each side of the note, the line fills 80
// columns.
const MAX_LINK: usize = 57;
const MAX_BANNER: u64 = 4096;

/// The name of a passed socket in messages.
const SOCKET: &str = "the socket of systemd";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct ServeArgs {
    /// Scenes, meshes and folders of them
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Address to listen at [default: 127.0.0.1:2222]
    #[arg(long, value_name = "ADDRESS:PORT")]
    listen: Option<SocketAddr>,
    /// Allow an address that other machines can reach
    #[arg(long, value_name = "true|false", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    #[arg(hide_possible_values = true)]
    public: Option<bool>,
    /// File of the host key, made at the first start
    #[arg(long, value_name = "FILE")]
    host_key: Option<PathBuf>,
    /// Viewers at a time; others wait [default: 200]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    max_viewers: Option<u32>,
    /// Connections from one address [default: 10]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000), hide_short_help = true)]
    max_per_address: Option<u32>,
    /// Longest time without a key [default: 10m]
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    idle: Option<Duration>,
    /// Longest visit [default: 1h]
    #[arg(long, value_name = "TIME", value_parser = parse_time, hide_short_help = true)]
    session_max: Option<Duration>,
    /// Bytes per second for one viewer [default: 200k]
    #[arg(long, value_name = "RATE", value_parser = parse_rate)]
    max_rate: Option<u32>,
    /// Bytes per second for all viewers together
    #[arg(long, value_name = "RATE", value_parser = parse_rate, hide_short_help = true)]
    max_rate_total: Option<u32>,
    /// Frames per second for one viewer [default: 30]
    #[arg(long, value_name = "N", value_parser = parse_fps, hide_short_help = true)]
    fps: Option<f32>,
    /// Threads that draw [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    threads: Option<u16>,
    /// Only let in holders of the keys in this file
    #[arg(long, value_name = "FILE")]
    authorized_keys: Option<PathBuf>,
    /// Let the user `leader` with one of the public keys in this file lead the tour
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    leaders: Option<PathBuf>,
    /// Show viewers the login names of one another
    #[arg(long, value_name = "true|false", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    #[arg(hide_possible_values = true, hide_short_help = true)]
    show_names: Option<bool>,
    /// Text that is printed before the login
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    banner: Option<PathBuf>,
    /// Link that viewers see first, and on leaving
    #[arg(long, value_name = "URL")]
    link: Option<String>,
    /// Address of this machine with counts for Prometheus, and a health check
    #[arg(long, value_name = "ADDRESS:PORT", hide_short_help = true)]
    metrics: Option<SocketAddr>,
    /// Camera path that viewers follow until a key
    #[arg(long, value_name = "PATH")]
    tour: Option<PathBuf>,
    /// Networks of load balancers that send the PROXY protocol, such as 10.0.0.0/8
    #[arg(long, value_name = "CIDR,...", value_delimiter = ',', hide_short_help = true)]
    proxy_protocol: Vec<Network>,
    /// File of settings, such as (public: true)
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

/// Runs the server until a signal ends it.
pub(in crate::cli) fn run(_args: ServeArgs, given: &ArgMatches) -> CommandResult {
    let socket = socket_of_systemd()?;
    let address = socket.as_ref().map(TcpListener::local_addr).transpose();
    let address = address.map_err(|error| Failure::runtime(SOCKET, reason(&error)))?;
    let first = read(given, address)?;
    let mut read_again = || read(given, address).map_err(|failure| failure.to_string());
    let mut signals = Signals::catch_for_server().map_err(|error| Failure::runtime("signals", reason(&error)))?;
    let log: serve::Log = Arc::new(|line: &str| print_error(&format!("{}\n", visible(line))));
    let started = |address: SocketAddr, fingerprint: &str| {
        let (ip, port) = (address.ip(), address.port());
        let line = format!("listening on {address}: ssh -p {port} {ip}\nhost key {fingerprint}\n");
        // The server also runs if the reader of its output has gone.
        let _ = write_stdout(line.as_bytes());
    };
    let ended = serve::run_until_drained(socket, first, &mut read_again, &mut signals, &log, started);
    if let Some(signal) = ended.map_err(|error| Failure::Runtime(reason(&error)))? {
        die_of(signal);
    }
    Ok(())
}

/// Returns the socket that systemd has passed, if there is one.
fn socket_of_systemd() -> Result<Option<TcpListener>, Failure> {
    let mut passed = ListenFd::from_env();
    match passed.len() {
        0 => Ok(None),
        1 => passed.take_tcp_listener(0).map_err(|error| Failure::runtime(SOCKET, reason(&error))),
        count => Err(Failure::Runtime(format!("{SOCKET}: {count} sockets were passed, and one is wanted"))),
    }
}

/// Reads the scenes and the settings from the files that the command line names.
///
/// `address` is that of the socket that systemd has passed, if there is one.
fn read(given: &ArgMatches, address: Option<SocketAddr>) -> Result<(Vec<HostedScene>, Settings), Failure> {
    let mut args = ServeArgs::from_arg_matches(given).map_err(usage)?;
    if let Some(path) = args.config.take() {
        let command = ServeArgs::augment_args(clap::Command::new("serve").no_binary_name(true));
        args = ServeArgs::from_arg_matches(&read_as_flags(path, &command)?).map_err(usage)?;
        // Flags of the command line override the settings of the file.
        args.update_from_arg_matches(given).map_err(usage)?;
    }
    let (mut settings, scenes) = (settings(&args, address)?, scenes(&args.scenes)?);
    if let Some((path, first)) = args.tour.as_ref().zip(scenes.first()) {
        settings.tour = Some(CameraPath::load(path, first.scene.camera()).map_err(usage)?);
    }
    Ok((scenes, settings))
}

fn settings(args: &ServeArgs, address: Option<SocketAddr>) -> Result<Settings, Failure> {
    let host_key = args.host_key.clone().or_else(default_host_key).ok_or_else(|| {
        Failure::Usage("there is no home folder for the host key; --host-key names a file for it".to_owned())
    })?;
    let mut settings = Settings::new(host_key);
    settings.listen = address.or(args.listen).unwrap_or(settings.listen);
    if !settings.listen.ip().is_loopback() && args.public != Some(true) {
        let what = if address.is_some() { SOCKET } else { "--listen" };
        return Err(Failure::Usage(format!(
            "{what} {}: other machines can reach this address; --public allows that",
            settings.listen
        )));
    }
    settings.max_viewers = args.max_viewers.map_or(settings.max_viewers, |most| most as usize);
    settings.max_per_address = args.max_per_address.map_or(settings.max_per_address, |most| most as usize);
    settings.idle = args.idle.unwrap_or(settings.idle);
    settings.session_max = args.session_max.unwrap_or(settings.session_max);
    settings.max_rate = args.max_rate.or(settings.max_rate);
    settings.max_rate_total = args.max_rate_total;
    settings.max_frames = args.fps.unwrap_or(settings.max_frames);
    if let Some(address) = args.metrics.filter(|address| !address.ip().is_loopback()) {
        return Err(Failure::Usage(format!(
            "--metrics {address}: other machines could read the counts at this address; use one of this machine, such \
             as 127.0.0.1:{}",
            address.port()
        )));
    }
    settings.metrics = args.metrics;
    settings.proxies.clone_from(&args.proxy_protocol);
    settings.threads = args.threads.map(usize::from);
    let named = |path: &Path, error: &io::Error| Failure::runtime(path.display(), reason(error));
    if let Some(path) = &args.authorized_keys {
        settings.authorized_keys = Some(serve::authorized_keys(path).map_err(|error| named(path, &error))?);
    }
    if let Some(path) = &args.leaders {
        settings.leaders = Some(serve::authorized_keys(path).map_err(|error| named(path, &error))?);
    }
    settings.show_names = args.show_names == Some(true);
    if let Some(path) = &args.banner {
        settings.banner = Some(banner(path).map_err(|error| named(path, &error))?);
    }
    settings.link = args.link.as_deref().map(|link| visible(link).chars().take(MAX_LINK).collect());
    Ok(settings)
}

/// Returns the text of the banner file at `path`, with control characters replaced.
fn banner(path: &Path) -> io::Result<String> {
    if path.metadata()?.len() > MAX_BANNER {
        return Err(io::Error::other(format!("a banner has at most {MAX_BANNER} bytes")));
    }
    let text = std::fs::read_to_string(path)?;
    Ok(text.lines().fold(String::new(), |banner, line| banner + &visible(line) + "\r\n"))
}

/// Returns the default file of the host key, in the state folder of systemd or of the user.
fn default_host_key() -> Option<PathBuf> {
    // By the XDG specification, programs ignore variables with relative paths.
    let folder = |variable| std::env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute());
    let users = || folder("XDG_STATE_HOME").or_else(|| Some(folder("HOME")?.join(".local/state")));
    let state = folder("STATE_DIRECTORY").or_else(|| Some(users()?.join("termtrace")));
    state.map(|folder| folder.join("ssh_host_ed25519_key"))
}

/// Loads the scenes.
fn scenes(paths: &[PathBuf]) -> Result<Vec<HostedScene>, Failure> {
    let sources = if paths.is_empty() {
        ShippedScene::all().map(SceneSource::Shipped).collect()
    } else {
        let paths = folder::expanded(paths)?;
        paths.iter().map(|path| SceneSource::from_path(path, None)).collect::<Result<Vec<_>, _>>()?
    };
    sources.iter().map(hosted).collect()
}

fn hosted(source: &SceneSource) -> Result<HostedScene, Failure> {
    let scene = CameraArgs::default().load_scene(source)?;
    if let Some(darkness) = scene.darkness_warning() {
        warn(darkness);
    }
    let title = scene.caption().and_then(|caption| caption.lines().next()).unwrap_or_default().to_owned();
    let path = source.to_string();
    let part = |part: Option<&std::ffi::OsStr>| visible(&part.unwrap_or_default().to_string_lossy());
    // The server's viewers see the names of files, but not their folders.
    let (name, file) = (part(Path::new(&path).file_stem()), part(Path::new(&path).file_name()));
    Ok(HostedScene { name, file, title, scene, orbits: source.is_mesh() })
}

/// Parses a time: a number with `s`, `m` or `h`.
fn parse_time(text: &str) -> Result<Duration, String> {
    let wrong = || "expected a time of at least one second, such as 90s, 10m or 1h".to_owned();
    let unit = [("s", 1), ("m", 60), ("h", 3600)]
        .into_iter()
        .find_map(|(unit, seconds)| text.strip_suffix(unit).map(|number| (number, seconds)));
    let (number, seconds) = unit.ok_or_else(wrong)?;
    let number: u32 = number.parse().map_err(|_| wrong())?;
    let time = Duration::from_secs(u64::from(number) * seconds);
    // The limit of a year keeps sums of times from overflowing.
    if number > 0 && time <= Duration::from_secs(366 * 24 * 3600) { Ok(time) } else { Err(wrong()) }
}
