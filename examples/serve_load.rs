//! Visits a running `termtrace serve` many times, and prints how well the visitors are served.
//!
//! ```sh
//! termtrace serve three_spheres --max-viewers 5000 --max-per-address 5000 &
//! cargo run --release --features serve --example serve_load -- 127.0.0.1:2222 --viewers 200 --moving 200 --pid $!
//! ```
//!
//! `--moving` visitors turn the scene all the time. Of the others ten press a key twice a second, from which the time
//! to the end of the next frame is taken; the rest only looks. All answer the queries that a terminal answers.

use russh::client::{self, Handle, Msg};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelMsg};
use rustix::time::{ClockId, clock_gettime};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::task::LocalSet;
use tokio::time::{sleep, timeout};

const KEYED: usize = 10;
/// The end of a synchronized frame.
const FRAME_END: &[u8] = b"\x1b[?2026l";

struct Anybody;

impl client::Handler for Anybody {
    type Error = russh::Error;

    async fn check_server_key(&mut self, _key: &PublicKeyOrCertificate) -> Result<bool, russh::Error> {
        Ok(true)
    }
}

/// The measurements of all visitors.
#[derive(Default)]
struct Measured {
    /// From the shell request to the end of the first frame, in milliseconds.
    first: Vec<f64>,
    /// From a key to the end of the next frame, in milliseconds.
    keys: Vec<f64>,
    /// Frames of each moving visitor while all are there.
    frames: Vec<u32>,
    bytes: u64,
    /// Bytes that came for those who only look.
    idle_bytes: u64,
    counts: bool,
    failed: usize,
}

struct Arguments {
    address: String,
    viewers: usize,
    moving: usize,
    seconds: u64,
    size: (u32, u32),
    pid: Option<u32>,
}

fn arguments() -> Option<Arguments> {
    let mut words = std::env::args().skip(1);
    let mut arguments =
        Arguments { address: words.next()?, viewers: 50, moving: 50, seconds: 10, size: (80, 24), pid: None };
    while let (Some(flag), Some(value)) = (words.next(), words.next()) {
        match flag.as_str() {
            "--viewers" => arguments.viewers = value.parse().ok()?,
            "--moving" => arguments.moving = value.parse().ok()?,
            "--seconds" => arguments.seconds = value.parse().ok()?,
            "--pid" => arguments.pid = Some(value.parse().ok()?),
            "--size" => {
                let (columns, rows) = value.split_once('x')?;
                arguments.size = (columns.parse().ok()?, rows.parse().ok()?);
            }
            _ => return None,
        }
    }
    Some(arguments)
}

fn main() {
    let Some(arguments) = arguments() else {
        println!(
            "serve_load ADDRESS:PORT [--viewers N] [--moving N] [--seconds S] [--size COLUMNSxROWS] [--pid SERVER]"
        );
        return;
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    LocalSet::new().block_on(&runtime, load(arguments));
}

async fn load(arguments: Arguments) {
    let measured = Rc::new(RefCell::new(Measured::default()));
    measured.borrow_mut().frames = vec![0; arguments.moving];
    let arguments = Rc::new(arguments);
    let began = Instant::now();
    for number in 0..arguments.viewers {
        let (of_all, all_measured) = (Rc::clone(&arguments), Rc::clone(&measured));
        tokio::task::spawn_local(async move {
            if visit(number, &of_all, &all_measured).await.is_none() {
                all_measured.borrow_mut().failed += 1;
            }
        });
        // Sixteen at a time.
        while number >= 15 + measured.borrow().first.len() + measured.borrow().failed {
            sleep(Duration::from_millis(1)).await;
        }
    }
    let all = || measured.borrow().first.len() + measured.borrow().failed >= arguments.viewers;
    let _ = timeout(Duration::from_secs(60), async {
        while !all() {
            sleep(Duration::from_millis(1)).await;
        }
    })
    .await;
    let up = began.elapsed();
    sleep(Duration::from_secs(2)).await;
    let before = (cpu_of(arguments.pid), own_cpu());
    let entered = measured.take();
    measured.replace(Measured {
        first: entered.first,
        failed: entered.failed,
        frames: vec![0; arguments.moving],
        counts: true,
        ..Measured::default()
    });
    let counted = Instant::now();
    sleep(Duration::from_secs(arguments.seconds)).await;
    let seconds = counted.elapsed().as_secs_f64();
    let cpu = [cpu_of(arguments.pid) - before.0, own_cpu() - before.1].map(|time| 100.0 * time / seconds);
    report(&arguments, &mut measured.borrow_mut(), up, seconds, cpu);
}

fn report(arguments: &Arguments, measured: &mut Measured, up: Duration, seconds: f64, [server, client]: [f64; 2]) {
    let Arguments { viewers, moving, size: (columns, rows), .. } = *arguments;
    println!("{viewers} viewers of {columns}x{rows}, {moving} moving, {} failed", measured.failed);
    println!("| figure | value |\n|---|---|");
    let first = Shares::of(&mut measured.first);
    println!("| all connected | {:.2} s, {:.0} a second |", up.as_secs_f64(), viewers as f64 / up.as_secs_f64());
    println!("| first frame, p50, p95, max | {first} ms |");
    let mut rates: Vec<_> = measured.frames.iter().map(|&frames| f64::from(frames) / seconds).collect();
    if !rates.is_empty() {
        let rates = Shares::of(&mut rates);
        println!("| frames a second, least, p50, most | {:.1}, {:.1}, {:.1} |", rates.least, rates.median, rates.most);
        println!("| fastest to slowest | {:.2} |", rates.most / rates.least);
        println!("| bytes a second, one viewer | {:.0} |", measured.bytes as f64 / seconds / moving as f64);
    }
    println!("| bytes for those at rest | {} |", measured.idle_bytes);
    if !measured.keys.is_empty() {
        println!("| key to frame, p50, p95, max | {} ms |", Shares::of(&mut measured.keys));
    }
    println!("| CPU of the server, of this client | {server:.0} %, {client:.0} % |");
    if let Some(kilobytes) = arguments.pid.and_then(memory_of) {
        println!("| memory of the server | {kilobytes} kB |");
    }
}

/// The order statistics of some figures.
struct Shares {
    least: f64,
    median: f64,
    p95: f64,
    most: f64,
}

impl Shares {
    fn of(figures: &mut [f64]) -> Self {
        figures.sort_by(f64::total_cmp);
        let at = |share: f64| figures.get(((figures.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f64::NAN);
        Self { least: at(0.0), median: at(0.5), p95: at(0.95), most: at(1.0) }
    }
}

impl std::fmt::Display for Shares {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.1}, {:.1}, {:.1}", self.median, self.p95, self.most)
    }
}

/// Enters, and reads for ever.
async fn visit(number: usize, arguments: &Arguments, measured: &RefCell<Measured>) -> Option<()> {
    let (mut channel, _session, asked) = enter(arguments).await?;
    let (mut tail, mut frames, mut pressed, mut next_key, mut painted) = (Vec::new(), 0_u32, None, asked, false);
    let is_keyed = number >= arguments.moving && number < arguments.moving + KEYED;
    loop {
        if is_keyed && painted && Instant::now() >= next_key && pressed.is_none() {
            next_key = Instant::now() + Duration::from_millis(500);
            channel.data(&(if frames.is_multiple_of(2) { b"[" } else { b"]" })[..]).await.ok()?;
            pressed = Some(Instant::now());
        }
        let wait = if is_keyed { Duration::from_millis(50) } else { Duration::from_secs(3600) };
        let Ok(message) = timeout(wait, channel.wait()).await else { continue };
        let ChannelMsg::Data { data } = message? else { continue };
        tail.extend_from_slice(&data);
        let ended = answer(&mut channel, &mut tail).await?;
        // The first frame is sent before the reply about synchronized ones, so its end has no mark.
        if !painted && data.windows(2).filter(|pair| pair == b"\xe2\x96").count() > 20 {
            painted = true;
            measured.borrow_mut().first.push(1e3 * asked.elapsed().as_secs_f64());
            if number < arguments.moving {
                channel.data(&b"t"[..]).await.ok()?;
            }
        }
        frames += ended;
        let mut measured = measured.borrow_mut();
        if let Some(pressed) = pressed.take_if(|_| ended > 0) {
            let time: Duration = Instant::elapsed(&pressed);
            measured.keys.push(1e3 * time.as_secs_f64());
        }
        if number < arguments.moving {
            measured.frames[number] += ended;
            measured.bytes += data.len() as u64;
        } else if !is_keyed && measured.counts {
            measured.idle_bytes += data.len() as u64;
        }
    }
}

async fn enter(arguments: &Arguments) -> Option<(Channel<Msg>, Handle<Anybody>, Instant)> {
    let config = Arc::new(client::Config { nodelay: true, ..client::Config::default() });
    let mut session = client::connect(config, &*arguments.address, Anybody).await.ok()?;
    session.authenticate_none("load").await.ok()?.success().then_some(())?;
    let channel = session.channel_open_session().await.ok()?;
    let (columns, rows) = arguments.size;
    channel.set_env(false, "COLORTERM", "truecolor").await.ok()?;
    channel.request_pty(false, "xterm-256color", columns, rows, 0, 0, &[]).await.ok()?;
    let asked = Instant::now();
    channel.request_shell(false).await.ok()?;
    Some((channel, session, asked))
}

/// Answers the queries in the bytes that have come, and returns how many frames end in them.
async fn answer(channel: &mut Channel<Msg>, tail: &mut Vec<u8>) -> Option<u32> {
    const QUERIES: [(&[u8], &[u8]); 2] = [(b"\x1b[c", b"\x1b[?62;22c"), (b"\x1b[?2026$p", b"\x1b[?2026;2$y")];
    let (mut ended, mut replies, mut at) = (0, Vec::new(), 0);
    while let Some(next) = tail[at..].iter().position(|&byte| byte == 0x1b) {
        at += next;
        let rest = &tail[at..];
        // The rest of what may be a longer query comes with the next bytes.
        if rest.len() < QUERIES[1].0.len() && !rest.starts_with(QUERIES[0].0) && !rest.starts_with(FRAME_END) {
            break;
        }
        ended += u32::from(rest.starts_with(FRAME_END));
        for (_, reply) in QUERIES.iter().filter(|(query, _)| rest.starts_with(query)) {
            replies.extend_from_slice(reply);
        }
        at += 1;
    }
    tail.drain(..at);
    if !replies.is_empty() {
        channel.data(&*replies).await.ok()?;
    }
    Some(ended)
}

/// Returns the seconds of CPU time that a process has taken.
fn cpu_of(pid: Option<u32>) -> f64 {
    let stat = pid.and_then(|pid| std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()).unwrap_or_default();
    let fields: Vec<_> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |at: usize| fields.get(at).and_then(|field| field.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) / 100.0
}

fn own_cpu() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 / 1e9
}

fn memory_of(pid: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?.split_whitespace().next()?.parse().ok()
}
