//! The man pages, as roff: the sections of `clap_mangen`, then others, such as keys and files.

use clap::Command;
use clap_mangen::Man;
use std::fmt::Write;
use std::io;
use termtrace::internals::control::{KeyMode, Keymap};

const FILES: &str = "\
$XDG_CONFIG_HOME/termtrace/config.ron
    permanent settings, as in (fps: 30, color: 256)
$XDG_CONFIG_HOME/termtrace/keys.ron
    own keys; termtrace config --keys prints a file to edit
Without XDG_CONFIG_HOME both are in ~/.config/termtrace.";

const ENVIRONMENT: &str = "\
TERMTRACE_FPS, TERMTRACE_COLOR, TERMTRACE_REDUCED_MOTION and so on
    the setting of that name; termtrace config lists all settings
NO_COLOR
    no colours, if not empty
CLICOLOR_FORCE, FORCE_COLOR
    at least 16 colours
COLORTERM, TERM, TERM_PROGRAM
    what the terminal supports
LC_ALL, LC_CTYPE, LANG
    whether the locale is UTF-8, which half blocks need";

/// Returns the man page of a built command: `Command::build` adds the arguments that clap defers.
/// `exit_status` is the text of its section "Exit status".
pub(super) fn page(command: Command, exit_status: &str) -> io::Result<Vec<u8>> {
    let has_commands = command.has_subcommands();
    let text = command.get_after_long_help().map(ToString::to_string).unwrap_or_default();
    let mut page = Vec::new();
    let man = Man::new(command);
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if has_commands {
        man.render_subcommands_section(&mut page)?;
    }
    let mut sections = String::new();
    for part in text.split("\n\n") {
        // The section on exit codes is added after all others, as the last one of every page.
        let (heading, body) =
            part.split_once(":\n").filter(|(heading, _)| !heading.contains('\n')).unwrap_or(("Notes", part));
        if !exit_status.starts_with(heading) && !heading.starts_with("Keys") {
            section(&mut sections, heading, body);
        }
    }
    if has_commands {
        section(&mut sections, "Keys", &keys_section());
        section(&mut sections, "Files", FILES);
        section(&mut sections, "Environment", ENVIRONMENT);
    }
    let (heading, body) = exit_status.split_once(":\n").unwrap_or_default();
    section(&mut sections, heading, body);
    page.extend(sections.bytes());
    Ok(page)
}

/// Adds a section whose lines roff keeps as they are, instead of joining them to paragraphs.
fn section(page: &mut String, heading: &str, body: &str) {
    let _ = writeln!(page, ".SH {}\n.nf", heading.to_uppercase());
    for line in body.lines() {
        // `\&` (no width) before a full stop or apostrophe, which would otherwise start a roff request.
        let _ = writeln!(page, "\\&{}", line.replace('\\', "\\e").replace('-', "\\-").replace('\'', "\\(aq"));
    }
    page.push_str(".fi\n");
}

/// Returns the text of the section on keys: the built-in bindings of each mode.
fn keys_section() -> String {
    let keymap = Keymap::default();
    let mut text = String::from("The mouse: a drag turns the view, the wheel moves towards the pointer.");
    for mode in KeyMode::ALL {
        let _ = write!(text, "\n\n{}:", mode.name());
        for binding in keymap.of(mode).filter(|binding| !binding.keys.is_empty()) {
            let _ = write!(text, "\n  {:<16}  {}", binding.key_names(), binding.command.description());
        }
    }
    text
}
