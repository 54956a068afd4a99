//! The outcome of a command: its error message and its exit code.

use super::style;
use std::fmt::{self, Display};
use std::io::{self, Write};
use std::process::ExitCode;
use termtrace::SceneError;
use termtrace::internals::text::{Notice, visible_lines};

/// The reason why a command failed.
pub(super) enum Failure {
    /// An operation of the operating system failed: exit code 1.
    Runtime(String),
    /// The command line or a file is wrong: exit code 2.
    Usage(String),
    /// The scene is wrong: exit code 2.
    Scene(SceneError),
    /// The message has already been printed; only this exit code is to be returned.
    Reported(u8),
}

impl Failure {
    /// Returns a [`Failure::Runtime`] with the message `what: why`, such as a file's name and the
    /// system's reason.
    pub(super) fn runtime(what: impl Display, why: impl Display) -> Self {
        Self::Runtime(format!("{what}: {why}"))
    }
}

/// Converts an error about the command line or a file to [`Failure::Usage`].
pub(super) fn usage(error: impl Display) -> Failure {
    Failure::Usage(error.to_string())
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Runtime(message) | Self::Usage(message) => f.write_str(message),
            Self::Scene(error) => error.fmt(f),
            Self::Reported(_) => Ok(()),
        }
    }
}

impl From<Failure> for Notice {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Scene(error) => error.notice(),
            failure => failure.to_string().into(),
        }
    }
}

pub(super) type CommandResult = Result<(), Failure>;

/// Prints the error message, if any, and returns the exit code.
pub(super) fn exit_code(done: CommandResult) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Reported(code)) => ExitCode::from(code),
        Err(Failure::Runtime(message)) => report_failure(&message, 1),
        Err(Failure::Usage(message)) => report_failure(&message, 2),
        Err(Failure::Scene(error)) => report_failure(&error.to_string(), 2),
    }
}

/// Prints a message of clap: an error, the help or the version. Returns the exit code.
pub(super) fn print_clap_message(message: &clap::Error) -> ExitCode {
    // The message quotes arguments, which may contain escape sequences.
    let text = visible_lines(&message.render().to_string());
    if message.use_stderr() {
        print_error(&text);
        return ExitCode::from(2);
    }
    // An error of writing is ignored: printing help into a closed pipe counts as a success, as in other programs.
    let _ = write_help(&text);
    ExitCode::SUCCESS
}

/// Writes a help text to standard output, coloured if that is a terminal.
pub(super) fn write_help(text: &str) -> CommandResult {
    let text = if style::is_colored(&io::stdout()) { style::colored_help(text) } else { text.to_owned() };
    write_stdout(text.as_bytes())
}

fn report_failure(message: &str, code: u8) -> ExitCode {
    print_error(&format!("error: {}\n", visible_lines(message)));
    ExitCode::from(code)
}

/// Prints a warning to standard error.
pub(super) fn warn(message: impl Display) {
    print_error(&format!("warning: {}\n", visible_lines(&message.to_string())));
}

/// Prints a message to standard error, coloured if that is a terminal, unless the write could block
/// the program or suspend it.
pub(super) fn print_error(text: &str) {
    // With `stty tostop`, SIGTTOU suspends a background process that writes to the terminal. A failed write is ignored:
    // there is no other place for the message, and the exit code reports the failure.
    if termtrace::internals::terminal::stderr_accepts_message() {
        let text = if style::is_colored(&io::stderr()) { style::colored_error(text) } else { text.to_owned() };
        let _ = io::stderr().write_all(text.as_bytes());
    }
}

/// Returns the system's message without the "(os error N)" that Rust appends.
pub(super) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let number = error.raw_os_error().map(|number| format!(" (os error {number})"));
    number.and_then(|number| text.strip_suffix(&number)).unwrap_or(&text).to_owned()
}

/// Prints the panic messages held back while the terminal was in use, and exits with 101, the code
/// of a panic.
pub(super) fn report_panic_and_exit() -> ! {
    // Several threads may have panicked; the first message is the cause.
    let messages = termtrace::internals::terminal::take_panic_messages();
    for message in messages {
        print_error(&(visible_lines(&message) + "\n"));
    }
    // The exit code of a Rust program that panics.
    std::process::exit(101)
}

/// Writes to standard output. A closed pipe, as after `| head`, is not an error.
pub(super) fn write_stdout(bytes: &[u8]) -> CommandResult {
    let mut stdout = io::stdout().lock();
    // Flushed here, because the error of a flush at exit is lost.
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::runtime("standard output", reason(&error)))
        }
        _ => Ok(()),
    }
}
