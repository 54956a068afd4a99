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
//! `--followers N` visitors follow the tour of the server (`--tour`, and `--moving 0`), in `--classes N` kinds of terminals
//! (up to 8: four sizes, of which that of `--size` is the largest, and two numbers of colours). One more, in a window of
//! 80x24 cells, leaves the tour and comes back twice a second.
//!
//! `--at-once true` lets all followers press a key at the same time at the end, and come back by another one; windows of
//! 40 columns have room for the notices by which both are seen. `--drain true`
//! then ends the server (`--pid`), and counts the visitors who are told before their sessions end.
//!
//! `--odd KIND:N` adds visitors of another kind, whose frames are not counted: `big` ones turn in windows of 500x200
//! cells, `late` ones turn and answer after 400 ms, `slow` ones press keys behind a link of 50 KB/s with a round trip of
//! 200 ms, `slow-turning` ones turn behind such a link. `--seed N` makes visitors come, go, stall and resize, and prints
//! the server's memory, threads and files every ten seconds.

use russh::client::{self, Handle, Msg};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelMsg};
use rustix::time::{ClockId, clock_gettime};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt, AsyncWriteExt, BufReader, DuplexStream};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio::task::LocalSet;
use tokio::time::{sleep, sleep_until, timeout};

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
    counts: bool,
    failed: usize,
    visits: usize,
}

/// A kind of visitors besides those who are counted.
#[derive(Clone, Copy, PartialEq)]
enum Odd {
    Big,
    Late,
    Slow,
    SlowTurning,
}

struct Arguments {
    address: String,
    viewers: usize,
    moving: usize,
    followers: usize,
    classes: usize,
    seconds: u64,
    size: (u32, u32),
    pid: Option<u32>,
    odd: Option<(Odd, usize)>,
    seed: Option<u64>,
    at_once: bool,
    drain: bool,
}

fn arguments() -> Option<Arguments> {
    let mut words = std::env::args().skip(1);
    let mut arguments = Arguments {
        address: words.next()?,
        viewers: 50,
        moving: 50,
        followers: 0,
        classes: 1,
        seconds: 10,
        size: (80, 24),
        pid: None,
        odd: None,
        seed: None,
        at_once: false,
        drain: false,
    };
    while let (Some(flag), Some(value)) = (words.next(), words.next()) {
        match flag.as_str() {
            "--viewers" => arguments.viewers = value.parse().ok()?,
            "--moving" => arguments.moving = value.parse().ok()?,
            "--followers" => arguments.followers = value.parse().ok()?,
            "--classes" => arguments.classes = value.parse().ok().filter(|classes| (1..=8).contains(classes))?,
            "--seconds" => arguments.seconds = value.parse().ok()?,
            "--at-once" => arguments.at_once = value.parse().ok()?,
            "--drain" => arguments.drain = value.parse().ok()?,
            "--seed" => arguments.seed = Some(value.parse().ok()?),
            "--odd" => {
                let (kind, count) = value.split_once(':')?;
                let kind = match kind {
                    "big" => Odd::Big,
                    "late" => Odd::Late,
                    "slow" => Odd::Slow,
                    "slow-turning" => Odd::SlowTurning,
                    _ => return None,
                };
                arguments.odd = Some((kind, count.parse().ok()?));
            }
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

impl Arguments {
    /// Returns the number of visitors whose frames are counted.
    fn counted(&self) -> usize {
        self.moving + self.followers
    }

    /// Returns the size of a visitor's window, and whether it has all colours.
    fn terminal(&self, number: usize) -> ((u32, u32), bool) {
        if self.followers > 0 && number >= self.counted() {
            // Its notices have to fit into a row.
            return ((80, 24), true);
        }
        if number < self.moving {
            return (self.size, true);
        }
        let class = number % self.classes;
        let ((columns, rows), smaller) = (self.size, class as u32 % 4);
        ((columns.saturating_sub(smaller / 2), rows.saturating_sub(smaller % 2)), class < 4)
    }
}

fn main() {
    let Some(arguments) = arguments() else {
        println!(
            "serve_load ADDRESS:PORT [--viewers N] [--moving N] [--followers N] [--classes N] [--seconds S] [--size COLUMNSxROWS] [--pid SERVER] \
             [--odd big|late|slow|slow-turning:N] [--at-once true] [--drain true] [--seed N]"
        );
        return;
    };
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
    sleep(Duration::from_secs(2)).await;
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

fn report(arguments: &Arguments, measured: &mut Measured, up: Duration, seconds: f64, [server, client]: [f64; 2]) {
    let Arguments { viewers, moving, followers, size: (columns, rows), .. } = *arguments;
    let failed = measured.failed;
    println!("{viewers} viewers of {columns}x{rows}, {moving} moving, {followers} followers, {failed} failed");
    println!("| figure | value |\n|---|---|");
    let first = Shares::of(&mut measured.first);
    println!("| all connected | {:.2} s, {:.0} a second |", up.as_secs_f64(), viewers as f64 / up.as_secs_f64());
    println!("| first frame, p50, p95, max | {first} ms |");
    let mut rates: Vec<_> = measured.frames.iter().map(|&frames| f64::from(frames) / seconds).collect();
    if !rates.is_empty() {
        let rates = Shares::of(&mut rates);
        println!("| frames a second, least, p50, most | {:.1}, {:.1}, {:.1} |", rates.least, rates.median, rates.most);
        println!("| fastest to slowest | {:.2} |", rates.most / rates.least);
        let still = measured.frames.iter().filter(|&&frames| frames == 0).count();
        println!("| without a frame | {still} |");
        println!(
            "| bytes a second, one viewer | {:.0} |",
            measured.bytes as f64 / seconds / arguments.counted() as f64
        );
        let frames: u64 = measured.frames.iter().map(|&frames| u64::from(frames)).sum();
        println!("| bytes a frame | {:.0} |", measured.bytes as f64 / frames.max(1) as f64);
    }
    println!("| bytes for those at rest | {} |", measured.idle_bytes);
    if !measured.keys.is_empty() {
        let keys = Shares::of(&mut measured.keys);
        println!(
            "| key to frame, p50, p95, p99, max | {:.1}, {:.1}, {:.1}, {:.1} ms |",
            keys.median, keys.p95, keys.p99, keys.most
        );
    }
    for (what, times) in [("leaving the tour", &mut measured.left), ("entering the tour", &mut measured.entered)] {
        if !times.is_empty() {
            println!("| {what}, p50, p95, max | {} ms |", Shares::of(times));
        }
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
    p99: f64,
    most: f64,
}

impl Shares {
    fn of(figures: &mut [f64]) -> Self {
        figures.sort_by(f64::total_cmp);
        let at = |share: f64| figures.get(((figures.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f64::NAN);
        Self { least: at(0.0), median: at(0.5), p95: at(0.95), p99: at(0.99), most: at(1.0) }
    }
}

impl std::fmt::Display for Shares {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.1}, {:.1}, {:.1}", self.median, self.p95, self.most)
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
    let (mut at_once, mut has_left) = (None::<(bool, Instant)>, false);
    let (mut owed, mut opens, mut is_following, mut kept) =
        (VecDeque::<(Instant, Vec<u8>)>::new(), false, true, Vec::new());
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
        let pressed_at_once = at_once.filter(|_| is_counted && arguments.at_once && arguments.followers > 0);
        match pressed_at_once {
            Some((is_back, pressed)) if has_across(&kept, &data, notice(is_back)) => {
                let time = 1e3 * Instant::elapsed(&pressed).as_secs_f64();
                if is_back {
                    measured.borrow_mut().entered_at_once.push(time);
                } else {
                    measured.borrow_mut().left_at_once.push(time);
                }
                at_once = (!is_back).then(|| (true, Instant::now()));
                if !is_back {
                    channel.data(&b"T"[..]).await.ok()?;
                }
            }
            None if is_counted && !has_left && measured.borrow().at_once => {
                has_left = true;
                channel.data(&b"w"[..]).await.ok()?;
                at_once = Some((false, Instant::now()));
            }
            _ => {}
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
                channel.data(&b"t"[..]).await.ok()?;
            }
        }
        frames += ended;
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

/// Bytes per second of a slow link, each way.
const LINK_RATE: f64 = 50_000.0;
/// The time that a byte takes through it, each way.
const LINK_DELAY: Duration = Duration::from_millis(100);
/// The size of a packet, and how many wait for the link.
const PACKET: (usize, usize) = (1024, 48);

/// Connects through a slow link.
async fn link_to(address: &str) -> Option<DuplexStream> {
    let (near, far) = tokio::io::duplex(16 * 1024);
    let (from_server, to_server) = TcpStream::connect(address).await.ok()?.into_split();
    let (from_client, to_client) = tokio::io::split(far);
    tokio::task::spawn_local(pass(from_server, to_client));
    tokio::task::spawn_local(pass(from_client, to_server));
    Some(near)
}

/// Passes bytes on at the rate of the link and after its delay.
async fn pass(mut from: impl AsyncReadExt + Unpin + 'static, mut to: impl AsyncWriteExt + Unpin + 'static) {
    let (under_way, mut arriving) = mpsc::unbounded_channel::<(Instant, Vec<u8>)>();
    let (queue, mut queued) = mpsc::channel::<Vec<u8>>(PACKET.1);
    tokio::task::spawn_local(async move {
        let mut free_at = Instant::now();
        while let Some(packet) = queued.recv().await {
            free_at = free_at.max(Instant::now()) + Duration::from_secs_f64(packet.len() as f64 / LINK_RATE);
            sleep_until(free_at.into()).await;
            let _ = under_way.send((free_at + LINK_DELAY, packet));
        }
    });
    tokio::task::spawn_local(async move {
        while let Some((due, packet)) = arriving.recv().await {
            sleep_until(due.into()).await;
            if to.write_all(&packet).await.is_err() {
                return;
            }
        }
    });
    let mut packet = [0; PACKET.0];
    while let Ok(count @ 1..) = from.read(&mut packet).await {
        if queue.send(packet[..count].to_vec()).await.is_err() {
            return;
        }
    }
}

/// Random numbers of a seed (a linear congruential generator).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }
}

/// Lets visitors come, go, stall and resize, and prints what the server takes.
async fn soak(arguments: Arguments, seed: u64) {
    let measured = Rc::new(RefCell::new(Measured::default()));
    let arguments = Rc::new(arguments);
    for number in 0..arguments.viewers as u64 {
        let (arguments, measured) = (Rc::clone(&arguments), Rc::clone(&measured));
        tokio::task::spawn_local(async move {
            let mut random = Random(seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            sleep(Duration::from_millis(random.below(5000))).await;
            loop {
                if short_visit(&arguments, &mut random).await.is_none() {
                    measured.borrow_mut().failed += 1;
                    sleep(Duration::from_secs(1)).await;
                }
                measured.borrow_mut().visits += 1;
            }
        });
    }
    println!(
        "| s | visits | failed | memory, kB | threads | files | CPU of the server, s |\n|--:|--:|--:|--:|--:|--:|--:|"
    );
    let began = Instant::now();
    while began.elapsed().as_secs() < arguments.seconds {
        sleep(Duration::from_secs(10)).await;
        let pid = arguments.pid.unwrap_or(0);
        let count = |folder: &str| std::fs::read_dir(format!("/proc/{pid}/{folder}")).map_or(0, Iterator::count);
        let Measured { visits, failed, .. } = *measured.borrow();
        let (seconds, memory) = (began.elapsed().as_secs(), memory_of(pid).unwrap_or(0));
        let (threads, files, cpu) = (count("task"), count("fd"), cpu_of(arguments.pid));
        println!("| {seconds} | {visits} | {failed} | {memory} | {threads} | {files} | {cpu:.1} |");
    }
}

/// Visits for some seconds, and leaves by a key or by closing the connection.
///
/// The visitor turns the scene or only looks, may resize the window, and may stop reading.
async fn short_visit(arguments: &Arguments, random: &mut Random) -> Option<()> {
    let (mut channel, _session, asked) = enter(&arguments.address, arguments.size, (false, true)).await?;
    let end = asked + Duration::from_millis(2000 + random.below(18_000));
    let stalls_at = (random.below(4) == 0).then(|| asked + Duration::from_millis(random.below(10_000)));
    if random.below(2) == 0 {
        channel.data(&b"t"[..]).await.ok()?;
    }
    let (mut tail, mut resize_at) = (Vec::new(), asked + Duration::from_millis(random.below(20_000)));
    while Instant::now() < end {
        if stalls_at.is_some_and(|at| at <= Instant::now()) {
            sleep_until(end.into()).await;
            break;
        }
        if resize_at <= Instant::now() {
            resize_at = Instant::now() + Duration::from_millis(200 + random.below(5000));
            let size = (20 + random.below(100), 6 + random.below(40));
            channel.window_change(size.0 as u32, size.1 as u32, 0, 0).await.ok()?;
        }
        let until = end.min(resize_at);
        let Ok(message) = timeout(until.saturating_duration_since(Instant::now()), channel.wait()).await else {
            continue;
        };
        let ChannelMsg::Data { data } = message? else { continue };
        let (_, replies) = answer(&mut tail, &data);
        if !replies.is_empty() {
            channel.data(&*replies).await.ok()?;
        }
    }
    if stalls_at.is_none() && random.below(2) == 0 {
        channel.data(&b"q"[..]).await.ok()?;
        let _ = timeout(Duration::from_secs(2), async { while channel.wait().await.is_some() {} }).await;
    }
    Some(())
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
