//! Visitors who come, go, stall and resize.

use crate::report::{cpu_of, memory_of};
use crate::{Arguments, Measured, answer, enter};
use russh::ChannelMsg;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::{Duration, Instant};
use tokio::time::{sleep, sleep_until, timeout};

/// Random numbers of a seed (a linear congruential generator).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }
}

/// Lets visitors come, go, stall and resize, and prints what the server takes.
pub(crate) async fn soak(arguments: Arguments, seed: u64) {
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
