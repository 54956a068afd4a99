//! The shares of viewers in time, bytes and memory.
//!
//! These are rows 5, 8, 12, 13, 21, 22 and 24 of the table in docs/serve.md.
//! Only ratios are tested: how many frames a machine makes, `examples/serve_load` tells.

use crate::abuse::dial_from;
use crate::counter::{Counter, run_all};
use crate::guest::Guest;
use crate::program::Program;
use crate::run;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::io::AsyncWriteExt;

const AT_ONCE: Duration = Duration::ZERO;

/// The number of periods in one of which shares must be right.
///
/// Other work on this machine may delay a client or the server in any one of them.
pub(crate) const TRIES: usize = 5;

/// Held by tests that count frames, so that one does not take time from another.
static COUNTING: Mutex<()> = Mutex::new(());

pub(crate) fn counting() -> MutexGuard<'static, ()> {
    COUNTING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns whether the least of some shares is at least half of the greatest.
pub(crate) fn are_alike(shares: &[usize]) -> bool {
    shares.iter().min().zip(shares.iter().max()).is_some_and(|(least, most)| 2 * least >= *most)
}

async fn enter_all(program: &Program, count: usize, size: (u32, u32), delay: Duration) -> Vec<Counter> {
    let mut counters = Vec::new();
    for _ in 0..count {
        counters.push(Counter::enter(program, size, delay).await);
    }
    counters
}

/// Asserts that ten viewers of 80x24 cells keep at least nine tenths of their frames beside others.
async fn assert_ten_keep_frames(others: usize, size: (u32, u32), delay: Duration) {
    let mut seen = Vec::new();
    // On a machine too slow for all frames, fair shares are smaller than those of ten alone: it gets a lower rate.
    for fps in [15, 8, 4] {
        let wanted = 10 * 2 * fps;
        let mut keeps_up = false;
        // Other work on this machine may take time from one period and not from the other.
        for _ in 0..TRIES {
            let fps = fps.to_string();
            let flags = ["three_spheres", "--max-per-address", "100", "--threads", "2", "--fps", &fps];
            let program = Program::start(&flags);
            let mut ten = enter_all(&program, 10, (80, 24), AT_ONCE).await;
            run_all(&mut ten, Duration::from_secs(2)).await;
            let alone: usize = run_all(&mut ten, Duration::from_secs(2)).await.iter().sum();
            let mut all = enter_all(&program, others, size, delay).await;
            all.append(&mut ten);
            run_all(&mut all, Duration::from_secs(1)).await;
            let frames = run_all(&mut all, Duration::from_secs(2)).await;
            let (others, ten) = frames.split_at(others);
            let beside: usize = ten.iter().sum();
            seen.push((fps, alone, beside, others.to_vec()));
            if 10 * beside >= 9 * alone && others.iter().all(|&count| count > 0) {
                println!("{seen:?}");
                return;
            }
            keeps_up |= 10 * alone >= 9 * wanted;
        }
        assert!(!keeps_up, "frames a second, frames of ten alone and beside others, and of the others: {seen:?}");
    }
    panic!("this machine is too slow: {seen:?}");
}

#[test]
fn row_13_a_huge_window_takes_nothing_from_others() {
    let _counting = counting();
    run(assert_ten_keep_frames(1, (500, 200), AT_ONCE));
}

#[test]
fn row_21_late_answers_take_nothing_from_others() {
    let _counting = counting();
    run(assert_ten_keep_frames(10, (80, 24), Duration::from_millis(400)));
}

#[test]
fn row_08_clients_that_do_not_read_cost_no_memory_and_no_frames() {
    let _counting = counting();
    let program = Program::start(&["three_spheres", "--max-per-address", "100", "--threads", "2", "--fps", "10"]);
    run(async {
        let mut readers = enter_all(&program, 15, (80, 24), AT_ONCE).await;
        let mut stalled = Vec::new();
        for _ in 0..5 {
            let guest = Guest::enter_with_little_room(&program).await;
            guest.send(b"t").await;
            stalled.push(guest);
        }
        run_all(&mut readers, Duration::from_secs(3)).await;
        let before = program.memory();
        let mut seen: Vec<Vec<usize>> = Vec::new();
        while !seen.last().is_some_and(|frames| are_alike(frames)) {
            assert!(seen.len() < TRIES, "{seen:?}");
            seen.push(run_all(&mut readers, Duration::from_secs(4)).await);
            let grown = program.memory().zip(before).map(|(after, before)| after.saturating_sub(before));
            assert!(grown.is_none_or(|kilobytes| kilobytes < 1024), "it grew by {grown:?} kB");
        }
    });
}

#[test]
fn row_22_floods_of_colours_cost_no_memory() {
    let program = Program::start(&["three_spheres", "--max-per-address", "100"]);
    run(async {
        let mut guests = Vec::new();
        for _ in 0..4 {
            let mut guest = Guest::without_terminal(&program, (80, 24)).await;
            guest.channel.request_pty(true, "xterm", 80, 24, 0, 0, &[]).await.expect("a terminal");
            guest.ask(None).await;
            guest.see_picture().await;
            guests.push(guest);
        }
        let mut before = None;
        for round in 0..3_u32 {
            for (guest, number) in guests.iter_mut().zip(0_u32..) {
                let palette = |at: u32| {
                    let [_, red, green, blue] = (at * 0x01_357 + round * 0x1234 + number).to_be_bytes();
                    format!("\x1b]4;{};rgb:{red:02x}/{green:02x}/{blue:02x}\x1b\\", at % 16)
                };
                let flood: String = (0..4000).map(palette).collect();
                guest.start_sending((flood + "i").into_bytes());
            }
            for guest in &mut guests {
                guest.see_text("three_spheres").await;
                guest.send(b"i").await;
                let is_closed = |guest: &Guest| !guest.text().iter().any(|row| row.contains("three_spheres"));
                guest.see("no status", is_closed).await;
            }
            let memory = program.memory();
            // The first round fills what each viewer has room for.
            let before = *before.get_or_insert(memory);
            let grown = memory.zip(before).map(|(after, before)| after.saturating_sub(before));
            assert!(grown.is_none_or(|kilobytes| kilobytes < 1024), "round {round}: it grew by {grown:?} kB");
        }
    });
}

#[test]
fn row_24_a_flood_of_input_does_not_stop_ctrl_c() {
    let program = Program::start(&["three_spheres"]);
    run(async {
        let mut guest = Guest::enter(&program).await;
        guest.see_picture().await;
        // An answer would wait for the flood, and meanwhile this client would not read.
        guest.answers = false;
        let before = program.memory();
        let mut flood = b"wasd[]\x1b[A\x1b[B".repeat(80_000);
        flood.push(0x03);
        let flood = guest.start_sending(flood);
        assert_eq!(guest.leave().await, Some(0));
        flood.await.expect("it does not panic").expect("the whole flood is taken");
        guest.assert_clean();
        let grown = program.memory().zip(before).map(|(after, before)| after.saturating_sub(before));
        assert!(grown.is_none_or(|kilobytes| kilobytes < 2048), "it grew by {grown:?} kB");
    });
}

#[test]
fn row_05_a_storm_costs_no_memory() {
    let program = Program::start(&["three_spheres"]);
    run(async {
        Guest::enter(&program).await.see_picture().await;
        let before = program.memory();
        for _ in 0..1000 {
            drop(dial_from([127, 0, 5, 1], &program).await);
        }
        Counter::enter(&program, (80, 24), AT_ONCE).await;
        let grown = program.memory().zip(before).map(|(after, before)| after.saturating_sub(before));
        assert!(grown.is_none_or(|kilobytes| kilobytes < 2048), "it grew by {grown:?} kB");
    });
}

#[test]
fn row_12_forged_replies_do_not_raise_the_rate() {
    let _counting = counting();
    let program = Program::start(&["three_spheres", "--fps", "10", "--max-rate", "60k"]);
    run(async {
        let mut counters = enter_all(&program, 2, (80, 24), AT_ONCE).await;
        run_all(&mut counters, Duration::from_secs(2)).await;
        let mut writer = counters[0].channel.make_writer();
        let flood = tokio::spawn(async move {
            while writer.write_all(&b"\x1b[?62;22c\x1b[?2026;2$y\x1b[1;1R".repeat(20)).await.is_ok() {
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
        });
        let mut seen = Vec::new();
        // Ten frames a second for three seconds, and what was on its way.
        let is_kept = |(frames, bytes): &(Vec<usize>, usize)| {
            frames.iter().all(|&count| (1..=34).contains(&count)) && *bytes < 3 * 60_000 * 12 / 10
        };
        while !seen.last().is_some_and(is_kept) {
            assert!(seen.len() < TRIES, "frames, and bytes of the one who forges: {seen:?}");
            let before = counters[0].bytes;
            let frames = run_all(&mut counters, Duration::from_secs(3)).await;
            seen.push((frames, counters[0].bytes - before));
        }
        flood.abort();
    });
}
