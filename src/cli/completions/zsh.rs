//! The completions of zsh.
//!
//! The script is not made by `clap_complete`, whose scripts complete nothing after a scene in the place of a command.

use super::values::{Files, SCENE_ENDINGS, Values, Word, commands, first_line, options, spellings, takes_value};
use clap::{Arg, Command};
use std::fmt::Write;

const HEAD: &str = r#"#compdef termtrace
# Made by termtrace completions zsh.

_termtrace_first() {
    _alternative 'commands:command:_termtrace_commands' 'scenes:scene:_termtrace_scenes'
}

_termtrace() {
    local curcontext="$curcontext"
    local -a specs
    (( CURRENT > 2 )) && case $words[2] in
"#;

const TAIL: &str = r#"    )
    _arguments -s -S : $specs
}

if [ "$funcstack[1]" = _termtrace ]; then
    _termtrace "$@"
else
    compdef _termtrace termtrace
fi
"#;

/// Returns the script: the options and their values of each command, then those of the live view.
pub(super) fn script(program: &Command) -> String {
    let mut script = HEAD.replacen("_termtrace_first", &(list_functions(program) + "_termtrace_first"), 1);
    for command in program.get_subcommands() {
        let _ = writeln!(script, "        {}) specs=(", command.get_name());
        for spec in argument_specs(command, program) {
            let _ = writeln!(script, "            {spec}");
        }
        script.push_str("            ) ;;\n");
    }
    script.push_str(
        "    esac\n    if (( $#specs )); then\n        curcontext=\"${curcontext%:*:*}:termtrace-$words[2]:\"\n",
    );
    script.push_str(
        "        shift words\n        (( CURRENT-- ))\n        _arguments -s -S : $specs\n        return\n    fi\n",
    );
    script.push_str("    specs=(\n");
    for spec in options(program).map(|arg| option_spec(arg, program)) {
        let _ = writeln!(script, "        {spec}");
    }
    script.push_str("        '1: :_termtrace_first'\n        '*:scene:_termtrace_scenes'\n");
    script + TAIL
}

/// Returns the zsh functions that offer commands and scenes.
fn list_functions(program: &Command) -> String {
    let scene = program.get_positionals().next().map(|arg| Values::for_arg(arg, program));
    let scenes = scene.map(|values| values.words).unwrap_or_default();
    let mut text = String::new();
    for (name, what, words) in [("commands", "command", commands(program)), ("names", "built-in scene", scenes)] {
        let _ = writeln!(text, "_termtrace_{name}() {{\n    local -a list=(");
        for (word, help) in words {
            let _ = writeln!(text, "        {}", quoted(&format!("{word}:{help}")));
        }
        let _ = writeln!(text, "    )\n    _describe -t {name} '{what}' list\n}}\n");
    }
    let endings = SCENE_ENDINGS.join("|");
    let _ = writeln!(text, "_termtrace_scenes() {{\n    _alternative 'names:built-in scene:_termtrace_names' \\");
    let _ = writeln!(text, "        'files:scene or mesh:_files -g \"*.(#i)({endings})(-.)\"'\n}}\n");
    text
}

fn argument_specs(command: &Command, program: &Command) -> Vec<String> {
    let places = command.get_positionals().map(|arg| {
        let place = arg.get_index().map_or_else(|| "*".to_owned(), |index| index.to_string());
        quoted(&format!("{place}:{}:{}", arg.get_id(), value_action(&Values::for_arg(arg, program))))
    });
    options(command).map(|arg| option_spec(arg, program)).chain(places).collect()
}

/// Returns an option as a spec of zsh's `_arguments`: its spellings, description and value.
fn option_spec(arg: &Arg, program: &Command) -> String {
    let names = spellings(arg);
    let help = first_line(arg.get_help()).replace('\\', "\\\\").replace('[', "\\[").replace(']', "\\]");
    let value = value_spec(arg, program);
    // For `_arguments`, the value of `--name=` or `-n+` may be the next word, that of `--name=-` may not.
    let named = |name: &str| match (takes_value(arg), name.starts_with("--"), arg.is_require_equals_set()) {
        (false, ..) => name.to_owned(),
        (_, _, true) => format!("{name}=-"),
        (_, true, _) => format!("{name}="),
        (_, false, _) => format!("{name}+"),
    };
    if let [only] = &names[..] {
        return quoted(&format!("{}[{help}]{value}", named(only)));
    }
    let list: Vec<_> = names.iter().map(|name| named(name)).collect();
    format!("'({})'{{{}}}{}", names.join(" "), list.join(","), quoted(&format!("[{help}]{value}")))
}

fn value_spec(arg: &Arg, program: &Command) -> String {
    if !takes_value(arg) {
        return String::new();
    }
    let name = arg.get_value_names().and_then(<[_]>::first).map(|name| name.replace(':', "\\:")).unwrap_or_default();
    // Two colons: the value is optional.
    let colons = if arg.is_require_equals_set() { "::" } else { ":" };
    format!("{colons}{name}:{}", value_action(&Values::for_arg(arg, program)))
}

fn value_action(values: &Values) -> String {
    match (values.files, &values.words[..]) {
        (Files::Scenes, _) => "_termtrace_scenes".to_owned(),
        (Files::Any, []) => "_files".to_owned(),
        (Files::Any, _) => format!("{{compadd - {}; _files}}", values.names()),
        (Files::None, []) => " ".to_owned(),
        (Files::None, words) => format!("(({}))", words.iter().map(described).collect::<Vec<_>>().join(" ")),
    }
}

fn described((word, help): &Word) -> String {
    let help: String =
        // All but letters and digits are escaped, because zsh parses this text as shell words.
        help.chars().flat_map(|c| ['\\', c].into_iter().skip(usize::from(c.is_alphanumeric()))).collect();
    format!("{word}\\:{help}")
}

fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}
