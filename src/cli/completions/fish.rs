//! The completions of fish.

use super::values::{Files, SCENE_ENDINGS, Values, Word, commands, first_line, options, takes_value};
use clap::{Arg, Command};
use std::fmt::Write;

const HEAD: &str = r#"# Made by termtrace completions fish.

function __termtrace_is
    set -l words (commandline -opc)
    set -l command ''
    contains -- "$words[2]" COMMANDS; and set command $words[2]
    test "$command" = "$argv[1]"
end

function __termtrace_first
    test (count (commandline -opc)) -eq 1
end

function __termtrace_scenes
    complete -C "'' "(commandline -ct) | string match -ri '^[^\t]*(?:/|\.(?:ENDINGS))(?:\t.*)?$'
end

complete -c termtrace -f
"#;

/// Returns the script: the commands, then the arguments of each command and of the live view.
pub(super) fn script(program: &Command) -> String {
    let names: Vec<_> = commands(program).into_iter().map(|(name, _)| name).collect();
    let mut script = HEAD.replace("COMMANDS", &names.join(" ")).replace("ENDINGS", &SCENE_ENDINGS.join("|"));
    for word in commands(program) {
        let _ = writeln!(script, "complete -c termtrace -n __termtrace_first -a {}", candidate_list(&[word]));
    }
    for command in program.get_subcommands().chain([program]) {
        let name = if std::ptr::eq(command, program) { "''" } else { command.get_name() };
        let start = format!("complete -c termtrace -n \"__termtrace_is {name}\"");
        for arg in options(command) {
            let _ = writeln!(script, "{start}{}", option_flags(arg, program));
        }
        for place in command.get_positionals() {
            let values = Values::for_arg(place, program);
            let _ = writeln!(script, "{start}{}", value_flags(&values));
            if values.files == Files::Scenes {
                let _ = writeln!(script, "{start} -a '(__termtrace_scenes)'");
            }
        }
    }
    script
}

fn option_flags(arg: &Arg, program: &Command) -> String {
    let short = arg.get_short().map(|short| format!(" -s {short}")).unwrap_or_default();
    let long = arg.get_long().map(|long| format!(" -l {long}")).unwrap_or_default();
    let value = if takes_value(arg) { value_flags(&Values::for_arg(arg, program)) } else { String::new() };
    // The value of an option with an optional value follows a `=`, never in the next word.
    let required = if takes_value(arg) && !arg.is_require_equals_set() { " -r" } else { "" };
    let no_files = if takes_value(arg) && !value.contains(" -F") { " -f" } else { "" };
    format!("{short}{long}{required}{no_files}{value} -d {}", quoted(&first_line(arg.get_help())))
}

fn value_flags(values: &Values) -> String {
    let files = if values.files == Files::Any { " -F" } else { "" };
    if values.words.is_empty() { files.to_owned() } else { format!("{files} -a {}", candidate_list(&values.words)) }
}

/// Returns words in fish's syntax for candidates: one a line, with a tab before its description.
fn candidate_list(words: &[Word]) -> String {
    // fish unquotes the text twice: first as a string, then as a list of quoted words.
    let line = |(word, help): &Word| format!("{word}\\t'{}'", help.replace(['"', '$', '\\'], "").replace('\'', "\\'"));
    format!("\"{}\"", words.iter().map(line).collect::<Vec<_>>().join("\n"))
}

fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\\', "\\\\").replace('\'', "\\'"))
}
