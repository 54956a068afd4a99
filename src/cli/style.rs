//! Colours of help texts and error messages on a terminal. Text for a pipe or a file stays plain.

use std::io::IsTerminal;

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const GREEN: &str = "\x1b[1;32m";
const CYAN: &str = "\x1b[1;36m";
const PLAIN: &str = "\x1b[0m";

/// Returns whether text on this stream is coloured: on a terminal, unless `NO_COLOR` or the
/// terminal's name forbids it.
pub(super) fn is_colored(stream: &impl IsTerminal) -> bool {
    let variable = |name| std::env::var_os(name).unwrap_or_default();
    stream.is_terminal() && variable("NO_COLOR").is_empty() && variable("TERM") != "dumb"
}

/// Returns an error message or warning with coloured `error:` or `warning:`, tips and carets.
///
/// `text` must contain no control characters: callers replace those of quoted arguments first.
pub(super) fn colored_error(text: &str) -> String {
    text.split_inclusive('\n').fold(String::new(), |colored, line| colored + &error_line(line))
}

fn error_line(line: &str) -> String {
    let text = line.trim();
    let tip = "did you mean ";
    if let Some(message) = line.strip_prefix("error:") {
        // The message may contain a suggestion, which has a colour of its own.
        format!("{RED}error:{PLAIN}{}", error_line(message))
    } else if let Some(message) = line.strip_prefix("warning:") {
        format!("{YELLOW}warning:{PLAIN}{message}")
    } else if text.starts_with('^') && text.trim_matches('^').is_empty() {
        line.replacen(text, &format!("{RED}{text}{PLAIN}"), 1)
    } else if text.starts_with("tip:") {
        line.replacen("tip:", &format!("{CYAN}tip:{PLAIN}"), 1)
    } else if let Some((before, meant)) = line.rsplit_once(tip) {
        let (meant, end) = meant.split_at(meant.trim_end().len());
        format!("{before}{tip}{CYAN}{meant}{PLAIN}{end}")
    } else {
        with_colored_heading(line)
    }
}

/// Returns a help text with coloured headings, flags and commands.
pub(super) fn colored_help(text: &str) -> String {
    let mut is_in_commands = false;
    text.split_inclusive('\n').fold(String::new(), |colored, line| {
        let text = line.trim_start();
        if text.len() == line.len() && !text.trim().is_empty() {
            is_in_commands = line.starts_with("Commands:");
        }
        let is_literal = text.starts_with('-') || is_in_commands && line.starts_with("  ");
        colored + &if is_literal { with_colored_column(line, text) } else { with_colored_heading(line) }
    })
}

/// Colours the first column of a help line: a flag or command, up to the first two spaces.
fn with_colored_column(line: &str, text: &str) -> String {
    let column = text.split("  ").next().unwrap_or_default().trim_end();
    line.replacen(column, &format!("{CYAN}{column}{PLAIN}"), 1)
}

/// Colours a heading at the start of a line: words up to a colon, such as `Usage:`.
fn with_colored_heading(line: &str) -> String {
    match line.split_once(':') {
        Some((head, rest)) if is_heading(head) && (rest.trim().is_empty() || matches!(head, "Usage" | "Keys")) => {
            format!("{GREEN}{head}:{PLAIN}{rest}")
        }
        _ => line.to_owned(),
    }
}

fn is_heading(head: &str) -> bool {
    head.len() < 30 && head.starts_with(|c: char| c.is_ascii_uppercase())
}

#[cfg(all(test, unit_tests))]
mod tests;
