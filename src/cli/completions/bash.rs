//! The completions of bash.

use super::values::{Files, SCENE_ENDINGS, Values, commands, options, spellings, takes_value};
use clap::Command;
use std::collections::BTreeMap;
use std::fmt::Write;

// bash 3.2, which macOS has, lacks `compopt` and `nosort`. Without them only marks of folders and the order are
// missing.
const HEAD: &str = r#"# Made by termtrace completions bash.

_termtrace_words() {
    COMPREPLY+=($(compgen -W "$1" -- "$cur"))
}

_termtrace_files() {
    local IFS=$'\n'
    COMPREPLY+=($(compgen -f -- "$cur"))
    compopt -o filenames 2>/dev/null
}

_termtrace_scenes() {
    local file IFS=$'\n'
    COMPREPLY+=($(compgen -d -- "$cur"))
    for file in $(compgen -f -- "$cur"); do
        case $file in ENDINGS) COMPREPLY+=("$file") ;; esac
    done
    compopt -o filenames 2>/dev/null
}

_termtrace() {
    local cur=${COMP_WORDS[COMP_CWORD]} flag=${COMP_WORDS[COMP_CWORD-1]} command=
    COMPREPLY=()
    # bash cuts --flag=value into three words.
    if [[ $cur == = ]]; then
        cur=
    elif [[ $flag == = ]]; then
        flag=${COMP_WORDS[COMP_CWORD-2]}
    fi
    if ((COMP_CWORD > 1)); then
        case ${COMP_WORDS[1]} in COMMANDS) command=${COMP_WORDS[1]} ;; esac
    fi
    case $flag in
"#;

/// Returns the script: first the values of the options of all commands, then the options and
/// positional arguments of each command.
pub(super) fn script(program: &Command) -> String {
    let endings = SCENE_ENDINGS.map(|ending| format!("*.{ending}|*.{}", ending.to_uppercase())).join("|");
    let names: Vec<_> = commands(program).into_iter().map(|(name, _)| name).collect();
    let mut script = HEAD.replace("ENDINGS", &endings).replace("COMMANDS", &names.join("|"));
    let mut values = BTreeMap::new();
    for command in program.get_subcommands().chain([program]) {
        // An optional value follows a `=`. `HEAD` sets `$cur` to the part after it.
        for arg in options(command).filter(|arg| takes_value(arg)) {
            values.insert(spellings(arg).join("|"), completion_commands(&Values::for_arg(arg, program)));
        }
    }
    for (flag, action) in values {
        let _ = writeln!(script, "        {flag}) {action}return ;;");
    }
    script.push_str("    esac\n    case $command in\n");
    for command in program.get_subcommands() {
        let _ = writeln!(script, "        {}) {} ;;", command.get_name(), argument_commands(command, program));
    }
    let first = format!("((COMP_CWORD > 1)) || _termtrace_words \"{}\"", names.join(" "));
    let _ = writeln!(script, "        *) {}\n            {first} ;;", argument_commands(program, program));
    script
        + "    esac\n}\n\ncomplete -F _termtrace -o nosort termtrace 2>/dev/null || complete -F _termtrace termtrace\n"
}

/// Returns the shell commands that complete a word other than the value of an option: a flag or a
/// positional argument.
fn argument_commands(command: &Command, program: &Command) -> String {
    let flags: Vec<_> = options(command).flat_map(spellings).collect();
    let place = command
        .get_positionals()
        .next()
        .map(|arg| completion_commands(&Values::for_arg(arg, program)))
        .unwrap_or_default();
    format!("if [[ $cur == -* ]]; then _termtrace_words \"{}\"; else {place}:; fi", flags.join(" "))
}

fn completion_commands(values: &Values) -> String {
    let words =
        if values.words.is_empty() { String::new() } else { format!("_termtrace_words \"{}\"; ", values.names()) };
    let files = match values.files {
        Files::None => "",
        Files::Any => "_termtrace_files; ",
        Files::Scenes => "_termtrace_scenes; ",
    };
    words + files
}
