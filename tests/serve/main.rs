//! The server over SSH, on loopback: with clients in this process, and with OpenSSH's.
//!
//! The tests wait for events. Times that a server grants are shortened, so that they pass within a test.

mod abuse;
mod balancer;
mod counter;
mod guest;
mod openssh;
mod operator;
mod program;
#[path = "../pty/mod.rs"]
mod pty;
mod sharing;
mod together;
mod tour;
mod viewing;

use std::future::Future;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use termtrace::Scene;
use termtrace::internals::serve::{HostedScene, Server, Settings};

/// A server that clients connect to.
trait Place {
    fn address(&self) -> SocketAddr;
}

impl Place for Hosting {
    fn address(&self) -> SocketAddr {
        self.server.address()
    }
}

/// A server for one test. It lasts until the test program ends.
struct Hosting {
    server: Server,
    log: Arc<Mutex<Vec<String>>>,
    folder: TempDir,
}

impl Hosting {
    /// Starts a server with two scenes, whose settings are the default ones but for `change`.
    fn start(change: impl FnOnce(&mut Settings)) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut settings = Settings::new(folder.path().join("state/key"));
        settings.listen = SocketAddr::from(([127, 0, 0, 1], 0));
        settings.threads = Some(2);
        change(&mut settings);
        let log = Arc::new(Mutex::new(Vec::new()));
        let lines = Arc::clone(&log);
        let log_line = Arc::new(move |line: &str| lines.lock().expect("a log").push(line.to_owned()));
        let server = Server::start(scenes(), settings, log_line, || {}).expect("the server starts");
        Self { server, log, folder }
    }

    fn usual() -> Self {
        Self::start(|_| {})
    }

    fn key(&self) -> PathBuf {
        self.folder.path().join("state/key")
    }

    fn log(&self) -> Vec<String> {
        self.log.lock().expect("a log").clone()
    }
}

fn scenes() -> Vec<HostedScene> {
    let scene = |name: &str| {
        let path = format!("{}/scenes/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::load(path.as_ref()).expect("a scene");
        let title = format!("the scene {name}");
        HostedScene { name: name.to_owned(), file: name.to_owned(), title, scene, orbits: false }
    };
    vec![scene("three_spheres"), scene("corridor")]
}

/// The time after which an event is no longer expected.
// On a busy machine all tests wait for one another.
const PATIENCE: Duration = Duration::from_secs(120);

/// Waits until something holds that no event tells.
async fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "{what}");
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
}

/// Runs a test. An event that does not come fails it.
fn run<T>(test: impl Future<Output = T>) -> T {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    runtime.block_on(async { tokio::time::timeout(3 * PATIENCE, test).await.expect("it comes to its end") })
}
