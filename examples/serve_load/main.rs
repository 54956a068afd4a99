//! Visits a running `termtrace serve` many times, and prints how well the visitors are served.
//!
//! ```sh
//! termtrace serve three_spheres --max-viewers 5000 --max-per-address 5000 &
//! cargo run --release --features serve --example serve_load -- 127.0.0.1:2222 --viewers 200 --moving 200 --pid $!
//! ```
//!
//! `--moving` visitors turn the scene all the time. Of the others ten press a key twice a second, from which the time
//! to the end of the next frame is taken; the rest only looks. All answer the queries that a terminal answers.
//!
//! Frames are counted for `--seconds`, from `--settle` seconds after the first frame of the last visitor on: until then
//! the pictures of those at rest are refined.
//!
//! `--colors 256` gives all visitors 256 colours. `--sample SCENE` compares the screen of the first moving one with the
//! pictures of that scene, and prints the PSNR in decibels; it takes time from this client, which has one thread.
//!
//! `--followers N` visitors follow the tour of the server (`--tour`, and `--moving 0`), in `--classes N` kinds of
//! terminals (up to 8: four sizes, of which that of `--size` is the largest, and two numbers of colours). One more, in
//! a window of 80x24 cells, leaves the tour and comes back twice a second.
//!
//! `--at-once true` lets all followers press a key at the same time at the end, and come back by another one; windows
//! of 40 columns have room for the notices by which both are seen. `--drain true` then ends the server (`--pid`), and
//! counts the visitors who are told before their sessions end.
//!
//! `--odd KIND:N` adds visitors of another kind, whose frames are not counted: `big` ones turn in windows of 500x200
//! cells, `late` ones turn and answer after 400 ms, `slow` ones press keys behind a link of 50 KB/s with a round trip
//! of 200 ms, `slow-turning` ones turn behind such a link. `--seed N` makes visitors come, go, stall and resize, and
//! prints the server's memory, threads and files every ten seconds.

mod arguments;
mod link;
mod report;
mod sample;
mod soak;

use arguments::{Arguments, Odd, USAGE, arguments};
use link::link_to;
use report::{Shares, cpu_of, own_cpu, report};
use russh::client::{self, Handle, Msg};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelMsg};
use sample::Sample;
use soak::soak;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use termtrace::Scene;
use tokio::io::BufReader;
use tokio::net::TcpStream;
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
    /// From a key of a follower to the frame of a view of their own, in milliseconds.
    left: Vec<f64>,
    /// From the key that enters the tour to its frame, in milliseconds.
    entered: Vec<f64>,
    /// Frames of each moving visitor or follower while all are there.
    frames: Vec<u32>,
    /// Whether all followers are to press a key.
    at_once: bool,
    /// From that key to a view of their own, and from the key that enters the tour to its frame.
    left_at_once: Vec<f64>,
    entered_at_once: Vec<f64>,
    /// The sessions that ended with and without a notice before.
    told: usize,
    untold: usize,
    bytes: u64,
    /// Bytes that came for those who only look.
    idle_bytes: u64,
    /// The PSNR of frames of the sample, in decibels.
    psnr: Vec<f64>,
    counts: bool,
    failed: usize,
    visits: usize,
}

fn main() {
    let Some(arguments) = arguments() else {
        println!("{USAGE}");
        return;
    };
    if let Some(Err(error)) = arguments.sample.as_deref().map(Scene::load) {
        println!("{error}");
        return;
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    LocalSet::new().block_on(&runtime, async {
        match arguments.seed {
            Some(seed) => soak(arguments, seed).await,
            None => load(arguments).await,
        }
    });
}

async fn load(arguments: Arguments) {
    let measured = Rc::new(RefCell::new(Measured::default()));
    measured.borrow_mut().frames = vec![0; arguments.counted()];
    let arguments = Rc::new(arguments);
    let began = Instant::now();
    let all = arguments.viewers + arguments.odd.map_or(0, |(_, count)| count);
    for number in 0..all {
        let (of_all, all_measured) = (Rc::clone(&arguments), Rc::clone(&measured));
        tokio::task::spawn_local(async move {
            let mut is_told = false;
            let has_failed = visit(number, &of_all, &all_measured, &mut is_told).await.is_none();
            let measured = &mut *all_measured.borrow_mut();
            measured.failed += usize::from(has_failed);
            let ended = if is_told { &mut measured.told } else { &mut measured.untold };
            *ended += 1;
        });
        // Sixteen at a time.
        while number >= 15 + measured.borrow().first.len() + measured.borrow().failed {
            sleep(Duration::from_millis(1)).await;
        }
    }
    let are_in = || measured.borrow().first.len() + measured.borrow().failed >= all;
    let _ = timeout(Duration::from_secs(60), async {
        while !are_in() {
            sleep(Duration::from_millis(1)).await;
        }
    })
    .await;
    let up = began.elapsed();
    sleep(Duration::from_secs(arguments.settle)).await;
    let before = (cpu_of(arguments.pid), own_cpu());
    let entered = measured.take();
    measured.replace(Measured {
        first: entered.first,
        failed: entered.failed,
        frames: vec![0; arguments.counted()],
        counts: true,
        ..Measured::default()
    });
    let counted = Instant::now();
    sleep(Duration::from_secs(arguments.seconds)).await;
    let seconds = counted.elapsed().as_secs_f64();
    let cpu = [cpu_of(arguments.pid) - before.0, own_cpu() - before.1].map(|time| 100.0 * time / seconds);
    report(&arguments, &mut measured.borrow_mut(), up, seconds, cpu);
    if arguments.at_once {
        measured.borrow_mut().at_once = true;
        let _ = timeout(Duration::from_secs(60), async {
            while measured.borrow().entered_at_once.len() < arguments.followers {
                sleep(Duration::from_millis(10)).await;
            }
        })
        .await;
        let Measured { left_at_once, entered_at_once, .. } = &mut *measured.borrow_mut();
        for (what, times) in [("left", left_at_once), ("came back", entered_at_once)] {
            println!("| {} {what} at once, p50, p95, max | {} ms |", times.len(), Shares::of(times));
        }
    }
    if let Some(pid) = arguments.pid.filter(|_| arguments.drain) {
        let (told, untold) = (measured.borrow().told, measured.borrow().untold);
        let pid = i32::try_from(pid).ok().and_then(rustix::process::Pid::from_raw).expect("a process");
        rustix::process::kill_process(pid, rustix::process::Signal::TERM).expect("it runs");
        let all = || measured.borrow().told + measured.borrow().untold >= all;
        let _ = timeout(Duration::from_secs(60), async {
            while !all() {
                sleep(Duration::from_millis(10)).await;
            }
        })
        .await;
        let Measured { told: after, untold: without, .. } = *measured.borrow();
        println!("| ended after a notice, without one | {}, {} |", after - told, without - untold);
    }
}

/// The keys that all followers press at the same time: one leaves the tour, one enters it.
#[derive(Default)]
struct AtOnce {
    has_left: bool,
    /// Whether the last key enters the tour, and its time, until its frame has come.
    pressed: Option<(bool, Instant)>,
}

impl AtOnce {
    /// Records the time to the frame of the last key if `data` shows it, and presses the next key.
    async fn take(
        &mut self,
        channel: &Channel<Msg>,
        kept: &[u8],
        data: &[u8],
        measured: &RefCell<Measured>,
    ) -> Option<()> {
        match self.pressed {
            Some((is_back, pressed)) if has_across(kept, data, notice(is_back)) => {
                let Measured { left_at_once, entered_at_once, .. } = &mut *measured.borrow_mut();
                let times = if is_back { entered_at_once } else { left_at_once };
                times.push(1e3 * pressed.elapsed().as_secs_f64());
                self.pressed = (!is_back).then(|| (true, Instant::now()));
            }
            None if !self.has_left && measured.borrow().at_once => {
                (self.has_left, self.pressed) = (true, Some((false, Instant::now())));
            }
            _ => return Some(()),
        }
        match self.pressed {
            Some((is_back, _)) => channel.data(if is_back { &b"T"[..] } else { b"w" }).await.ok(),
            None => Some(()),
        }
    }
}

/// Enters, and reads for ever.
///
/// Sets `is_told` when the server tells that it ends.
async fn visit(number: usize, arguments: &Arguments, measured: &RefCell<Measured>, is_told: &mut bool) -> Option<()> {
    let odd = arguments.odd.map(|(kind, _)| kind).filter(|_| number >= arguments.viewers);
    let is_counted = number < arguments.counted();
    let is_leaving = arguments.followers > 0 && number == arguments.counted();
    let turns = number < arguments.moving || odd.is_some_and(|odd| odd != Odd::Slow);
    let is_keyed = odd == Some(Odd::Slow)
        || odd.is_none()
            && (arguments.counted()..arguments.counted() + KEYED).contains(&number)
            && arguments.odd.is_none()
            && arguments.followers == 0;
    let pause = Duration::from_millis(if odd.is_some() { 1500 } else { 500 });
    let delay = Duration::from_millis(if odd == Some(Odd::Late) { 400 } else { 0 });
    let (size, has_all_colors) = arguments.terminal(number);
    let size = if odd == Some(Odd::Big) { (500, 200) } else { size };
    let slow = matches!(odd, Some(Odd::Slow | Odd::SlowTurning));
    let (mut channel, _session, asked) = enter(&arguments.address, size, (slow, has_all_colors)).await?;
    let (mut tail, mut frames, mut pressed, mut next_key, mut painted) = (Vec::new(), 0_u32, None, asked, false);
    let mut at_once = AtOnce::default();
    let (mut owed, mut opens, mut is_following, mut kept) =
        (VecDeque::<(Instant, Vec<u8>)>::new(), false, true, Vec::new());
    let sampled = arguments.sample.as_ref().filter(|_| number == 0 && arguments.moving > 0);
    let mut sample = sampled.and_then(|scene| Sample::new(scene, size));
    loop {
        if is_leaving && painted && Instant::now() >= next_key && pressed.is_none() {
            next_key = Instant::now() + pause;
            channel.data(if is_following { &b"w"[..] } else { &b"T"[..] }).await.ok()?;
            pressed = Some(Instant::now());
        }
        if is_keyed && painted && Instant::now() >= next_key && pressed.is_none() {
            next_key = Instant::now() + pause;
            // Behind a slow link frames of before are under way: the first one with the status is waited for.
            opens = slow && !opens;
            let key = if slow { b"i" } else { [b"[", b"]"][frames as usize % 2] };
            channel.data(&key[..]).await.ok()?;
            pressed = (opens || !slow).then(Instant::now);
        }
        while owed.front().is_some_and(|(due, _)| *due <= Instant::now())
            && let Some((_, replies)) = owed.pop_front()
        {
            channel.data(&*replies).await.ok()?;
        }
        let wait = if is_keyed || is_leaving { Duration::from_millis(50) } else { Duration::from_secs(3600) };
        let wait = owed.front().map_or(wait, |(due, _)| due.saturating_duration_since(Instant::now()).min(wait));
        let Ok(message) = timeout(wait, channel.wait()).await else { continue };
        let ChannelMsg::Data { data } = message? else { continue };
        *is_told |= arguments.drain && has_across(&kept, &data, b"the server restarts");
        if is_counted && arguments.followers > 0 {
            at_once.take(&channel, &kept, &data, measured).await?;
        }
        keep(&mut kept, &data);
        let (ended, replies) = answer(&mut tail, &data);
        if !replies.is_empty() {
            owed.push_back((Instant::now() + delay, replies));
        }
        // The first frame is sent before the reply about synchronized ones, so its end has no mark.
        if !painted && data.windows(2).filter(|pair| pair == b"\xe2\x96").count() > 20 {
            painted = true;
            measured.borrow_mut().first.push(1e3 * asked.elapsed().as_secs_f64());
            if turns {
                channel.data(if sample.is_some() { &b"ti"[..] } else { &b"t"[..] }).await.ok()?;
            }
        }
        frames += ended;
        if let Some(sample) = &mut sample {
            sample.take(&data);
            measured.borrow_mut().psnr.append(&mut sample.psnr);
        }
        let mut measured = measured.borrow_mut();
        let shows = if slow { has(&data, b"three_spheres") } else { ended > 0 };
        if is_leaving {
            let shown = notice(!is_following);
            if let Some(pressed) = pressed.take_if(|_| has(&data, shown)) {
                let time = 1e3 * Instant::elapsed(&pressed).as_secs_f64();
                let Measured { left, entered, .. } = &mut *measured;
                let times = if is_following { left } else { entered };
                times.push(time);
                is_following = !is_following;
            }
        } else if let Some(pressed) = pressed.take_if(|_| shows) {
            let time: Duration = Instant::elapsed(&pressed);
            measured.keys.push(1e3 * time.as_secs_f64());
        }
        if is_counted {
            measured.frames[number] += ended;
            measured.bytes += data.len() as u64;
        } else if !is_keyed && odd.is_none() && measured.counts {
            measured.idle_bytes += data.len() as u64;
        }
    }
}

async fn enter(
    address: &str,
    (columns, rows): (u32, u32),
    (slow, has_all_colors): (bool, bool),
) -> Option<(Channel<Msg>, Handle<Anybody>, Instant)> {
    let config = Arc::new(client::Config { nodelay: true, ..client::Config::default() });
    let mut session = if slow {
        client::connect_stream(config, link_to(address).await?, Anybody).await.ok()?
    } else {
        let stream = TcpStream::connect(address).await.ok()?;
        stream.set_nodelay(true).ok()?;
        // `russh` reads the length of a packet and the packet by themselves, each with a system call. With a buffer both
        // come at once, which leaves more of the machine to the server.
        client::connect_stream(config, BufReader::with_capacity(16 * 1024, stream), Anybody).await.ok()?
    };
    session.authenticate_none("load").await.ok()?.success().then_some(())?;
    let channel = session.channel_open_session().await.ok()?;
    if has_all_colors {
        channel.set_env(false, "COLORTERM", "truecolor").await.ok()?;
    }
    channel.request_pty(false, "xterm-256color", columns, rows, 0, 0, &[]).await.ok()?;
    let asked = Instant::now();
    channel.request_shell(false).await.ok()?;
    Some((channel, session, asked))
}

/// The bytes of earlier messages in which a notice may begin: more than any notice has.
const MAX_KEPT: usize = 32;

/// Returns a text that a viewer sees after coming back to the tour, or after leaving it.
fn notice(is_back: bool) -> &'static [u8] {
    if is_back { b"watching" } else { b"left the tour" }
}

fn keep(kept: &mut Vec<u8>, data: &[u8]) {
    kept.extend_from_slice(data);
    kept.drain(..kept.len().saturating_sub(MAX_KEPT));
}

/// Returns whether the data has a text, which may begin in the bytes that were kept.
fn has_across(kept: &[u8], data: &[u8], text: &[u8]) -> bool {
    let before = &kept[kept.len().saturating_sub(text.len() - 1)..];
    has(&[before, data].concat(), text)
}

fn has(data: &[u8], text: &[u8]) -> bool {
    data.windows(text.len()).any(|window| window == text)
}

/// Returns how many frames end in `tail` and `data`, and the replies to the queries in them.
fn answer(tail: &mut Vec<u8>, data: &[u8]) -> (u32, Vec<u8>) {
    const QUERIES: [(&[u8], &[u8]); 2] = [(b"\x1b[c", b"\x1b[?62;22c"), (b"\x1b[?2026$p", b"\x1b[?2026;2$y")];
    tail.extend_from_slice(data);
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
    (ended, replies)
}
