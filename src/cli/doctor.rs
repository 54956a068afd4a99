//! `termtrace doctor`: shows what was detected about this terminal, and a test card to check it by
//! eye.

mod card;
mod report;

use super::json;
use super::outcome::{CommandResult, Failure, reason, write_stdout};
use super::settings::{NoConfig, Settings, TerminalArgs};
use clap::{ArgMatches, Args};
use report::{DoctorReport, QueryOutcome};
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};
use termtrace::internals::capabilities::{CellShape, Findings, SafeQueries};
use termtrace::internals::input::Input;
use termtrace::internals::protocol::{InitialQueries, Receiver};
use termtrace::internals::terminal::{Terminal, die_of};
use termtrace::live::Signals;

#[derive(Args)]
pub(super) struct DoctorArgs {
    // Present only for parsing and the help: `Settings::gather` reads clap's matches, which also say which flags were
    // given.
    #[command(flatten)]
    _terminal: TerminalArgs,
    #[command(flatten)]
    _no_config: NoConfig,
    /// Print JSON
    ///
    /// The fields are "verdict", "term", "version" and "capabilities", each with "name", "value" and "source".
    #[arg(long = "json", id = "json", help_heading = None)]
    _json: bool,
}

/// Time limit for the terminal's replies. It is long because the command should also show the
/// replies of a slow terminal; the live view does not wait for replies.
const QUERY_TIMEOUT: Duration = Duration::from_secs(2);

pub(super) fn run(given: &ArgMatches) -> CommandResult {
    let settings = Settings::gather(given)?;
    let hints = settings.args.terminal.detection_hints();
    let mut questions = InitialQueries::all_safe(&hints);
    let mut cell = CellShape::default();
    let is_terminal = io::stdout().is_terminal();
    let outcome = match hints.safe_queries() {
        _ if !is_terminal => QueryOutcome::NoTerminal,
        // No query is sent to a terminal that would print it instead of replying.
        SafeQueries::None => QueryOutcome::Answered(Duration::ZERO),
        _ => match query_terminal(&mut questions, &mut cell) {
            // No query was possible: replies arrive on standard input, which is not the terminal.
            Err(_) if !io::stdin().is_terminal() => QueryOutcome::NoTerminal,
            outcome => outcome.map_err(|error| Failure::runtime("terminal", reason(&error)))?,
        },
    };
    let findings = Findings::new(&hints, cell, questions.replies());
    let report =
        DoctorReport { settings: &settings, hints: &hints, findings: &findings, replies: questions.replies(), outcome };
    if given.get_flag("json") {
        return json::print(&report::as_json(&report));
    }
    write_stdout(report::text(&report).as_bytes())?;
    // The test card consists of escape sequences, which only a terminal draws.
    if is_terminal { write_stdout(&card::bytes(&findings.capabilities(), &hints)) } else { Ok(()) }
}

/// Puts the terminal into raw mode, sends the queries, waits for the replies, and restores the
/// terminal.
fn query_terminal(questions: &mut InitialQueries, cell: &mut CellShape) -> io::Result<QueryOutcome> {
    let mut signals = Signals::catch()?;
    let mut terminal = Terminal::take(&signals).inspect_err(|_| {
        // A deadly signal may have arrived while the program waited to be brought to the foreground.
        if let Some(signal) = signals.deadly() {
            die_of(signal);
        }
    })?;
    let mut receiver = Receiver::default();
    let asked = Instant::now();
    let outcome = terminal.window().and_then(|window| {
        *cell = window.cell;
        terminal.send(questions.bytes())?;
        receiver.sent(questions.bytes(), Duration::ZERO);
        await_replies(&mut terminal, &mut receiver, &mut signals, questions, asked)
    });
    terminal.restore(&mut receiver, asked.elapsed());
    // The program dies only after the terminal is restored, and by the signal itself: the shell must see the signal,
    // not an exit code.
    if let Some(signal) = signals.deadly() {
        die_of(signal);
    }
    outcome
}

/// Waits until the last reply has arrived, [`QUERY_TIMEOUT`] is over, or a deadly signal arrives.
fn await_replies(
    terminal: &mut Terminal,
    receiver: &mut Receiver,
    signals: &mut Signals,
    questions: &mut InitialQueries,
    asked: Instant,
) -> io::Result<QueryOutcome> {
    while questions.is_open() {
        let Some(left) = QUERY_TIMEOUT.checked_sub(asked.elapsed()) else { return Ok(QueryOutcome::TimedOut) };
        let woken = terminal.wait(signals.wake_pipe(), Some(left))?;
        if woken.wake {
            signals.drain();
        }
        if signals.deadly().is_some() {
            return Ok(QueryOutcome::TimedOut);
        }
        if woken.keys {
            take_replies(terminal, receiver, questions, asked.elapsed())?;
        }
    }
    Ok(QueryOutcome::Answered(asked.elapsed()))
}

/// Reads the replies that have arrived. Key presses among them are discarded.
fn take_replies(
    terminal: &mut Terminal,
    receiver: &mut Receiver,
    questions: &mut InitialQueries,
    now: Duration,
) -> io::Result<()> {
    let mut buffer = [0; 4096];
    let bytes = terminal.read(&mut buffer)?;
    if bytes.is_empty() {
        return Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the terminal is gone"));
    }
    for input in receiver.receive(bytes, now) {
        if let Input::Reply(reply) = input {
            questions.take_and_check_end(&reply);
        }
    }
    Ok(())
}
