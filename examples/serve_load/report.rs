//! The table of a load test.

use crate::{Arguments, Measured};
use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

pub(crate) fn report(
    arguments: &Arguments,
    measured: &mut Measured,
    up: Duration,
    seconds: f64,
    [server, client]: [f64; 2],
) {
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
    if !measured.psnr.is_empty() {
        let psnr = Shares::of(&mut measured.psnr);
        println!(
            "| frames of one moving viewer, least, p50, most | {:.1}, {:.1}, {:.1} dB |",
            psnr.least, psnr.median, psnr.most
        );
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
pub(crate) struct Shares {
    least: f64,
    median: f64,
    p95: f64,
    p99: f64,
    most: f64,
}

impl Shares {
    pub(crate) fn of(figures: &mut [f64]) -> Self {
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

/// Returns the seconds of CPU time that a process has taken.
pub(crate) fn cpu_of(pid: Option<u32>) -> f64 {
    let stat = pid.and_then(|pid| std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()).unwrap_or_default();
    let fields: Vec<_> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |at: usize| fields.get(at).and_then(|field| field.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) / 100.0
}

pub(crate) fn own_cpu() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 / 1e9
}

pub(crate) fn memory_of(pid: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?.split_whitespace().next()?.parse().ok()
}
