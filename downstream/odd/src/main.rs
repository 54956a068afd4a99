//! Calls of the public functions with odd arguments. Each call runs in a process of its own with 5 s of CPU time and 4 GB
//! of memory: it returns a value or an error, or it panics where its documentation says so. It never aborts, and it ends.
//!
//! `odd` makes all calls; `odd NAME` makes one and prints its result.

mod calls;

use calls::{CALLS, Ends};
use std::env;
use std::process::{Command, ExitCode};

/// The exit code of a process that panicked.
const PANICKED: i32 = 101;

fn main() -> ExitCode {
    let Some(name) = env::args().nth(1) else { return all() };
    let Some((_, _, call)) = CALLS.iter().find(|(called, _, _)| *called == name) else {
        eprintln!("there is no call {name:?}");
        return ExitCode::from(2);
    };
    println!("{}", call());
    ExitCode::SUCCESS
}

/// Makes each call in a process of its own.
fn all() -> ExitCode {
    let wrong = CALLS.iter().filter(|(name, ends, _)| !is_right(name, *ends)).count();
    println!("{} calls, {wrong} of which end otherwise than documented", CALLS.len());
    ExitCode::from(u8::from(wrong > 0))
}

fn is_right(name: &str, ends: Ends) -> bool {
    let me = env::current_exe().expect("the program has a path");
    let limited = r#"ulimit -t 5 && ulimit -v 4000000 && exec "$0" "$1""#;
    let output = Command::new("sh").args(["-c", limited]).arg(me).arg(name).output().expect("there is a shell");
    let is_right = match ends {
        Ends::Returning => output.status.success(),
        Ends::Panicking => output.status.code() == Some(PANICKED),
    };
    let said = if output.status.success() { output.stdout } else { output.stderr };
    let said: String = String::from_utf8_lossy(&said).replace('\n', " ").chars().take(100).collect();
    println!("{} {name}: {}, {said}", if is_right { "ok   " } else { "WRONG" }, output.status);
    is_right
}
