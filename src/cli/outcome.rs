//! How a command ends: what it says, and its exit code.

use std::fmt::{self, Display};
use std::io::{self, Write};
use std::process::ExitCode;
use termtrace::SceneError;
use termtrace::internals::text::{Notice, visible_lines};

/// Why a command ends without having done what was asked.
pub(super) enum Failure {
    /// It could not be done: exit code 1.
    Runtime(String),
    /// The command line or a file is wrong: exit code 2.
    Usage(String),
    /// The scene is wrong: exit code 2.
    Scene(SceneError),
    /// All is said already, but for the exit code.
    Reported(u8),
}

impl Failure {
    /// It could not be done, with the reason after what it was about.
    pub(super) fn runtime(what: impl Display, why: impl Display) -> Self {
        Self::Runtime(format!("{what}: {why}"))
    }
}

/// The command line or the scene is wrong.
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

/// Says what went wrong, if anything did.
pub(super) fn exit_code(done: CommandResult) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Reported(code)) => ExitCode::from(code),
        Err(Failure::Runtime(message)) => report_failure(&message, 1),
        Err(Failure::Usage(message)) => report_failure(&message, 2),
        Err(Failure::Scene(error)) => report_failure(&error.to_string(), 2),
    }
}

/// Prints what clap says of the command line, which it may quote. Help and version are no errors; a closed pipe hides
/// either.
pub(super) fn print_clap_message(message: &clap::Error) -> ExitCode {
    let text = visible_lines(&message.render().to_string());
    if message.use_stderr() {
        print_error(&text);
        return ExitCode::from(2);
    }
    let _ = write_stdout(text.as_bytes());
    ExitCode::SUCCESS
}

fn report_failure(message: &str, code: u8) -> ExitCode {
    print_error(&format!("termtrace: {}\n", visible_lines(message)));
    ExitCode::from(code)
}

/// Prints it if that stops nobody. Where no one listens any more, the exit code says it too.
fn print_error(text: &str) {
    if termtrace::internals::terminal::stderr_accepts_message() {
        let _ = io::stderr().write_all(text.as_bytes());
    }
}

/// What the system says went wrong, without its number.
pub(super) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let number = error.raw_os_error().map(|number| format!(" (os error {number})"));
    number.and_then(|number| text.strip_suffix(&number)).unwrap_or(&text).to_owned()
}

/// Says what the threads said when they panicked, and ends as a panic does.
pub(super) fn exit_after_panic() -> ! {
    let messages = termtrace::internals::terminal::take_panic_messages();
    for message in messages {
        print_error(&(visible_lines(&message) + "\n"));
    }
    std::process::exit(101)
}

/// To standard output. A reader that has seen enough (`| head`) is no error.
pub(super) fn write_stdout(bytes: &[u8]) -> CommandResult {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::runtime("standard output", reason(&error)))
        }
        _ => Ok(()),
    }
}
