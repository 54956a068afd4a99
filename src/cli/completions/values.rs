//! The words and files that a shell offers to complete the value of an argument.

use crate::cli::shipped::ShippedScene;
use clap::builder::{PossibleValue, StyledStr};
use clap::{Arg, ArgAction, Command};

/// The extensions of the scene and mesh files that are offered as completions.
pub(super) const SCENE_ENDINGS: [&str; 6] = ["ron", "obj", "stl", "ply", "gltf", "glb"];

/// A word and its description, which may be empty.
pub(super) type Word = (String, String);

/// The kind of files that are offered as the value of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Files {
    None,
    Any,
    /// Scenes and meshes.
    Scenes,
}

/// The words and files that are offered as the value of an argument.
pub(super) struct Values {
    pub(super) words: Vec<Word>,
    pub(super) files: Files,
}

impl Values {
    /// Returns the completions of the value of `arg`: its possible values, or else those that
    /// follow from the value's name in the help, such as `orbit|FILE`.
    pub(super) fn for_arg(arg: &Arg, program: &Command) -> Self {
        let (mut words, mut files) = (Vec::new(), Files::None);
        let possible = arg.get_possible_values();
        words.extend(
            possible.iter().map(|value| (value.get_name().to_owned(), first_line(PossibleValue::get_help(value)))),
        );
        let name = arg.get_value_names().and_then(<[_]>::first).map(ToString::to_string).unwrap_or_default();
        for part in name.split('|').filter(|_| possible.is_empty()) {
            match part {
                "SCENE" => {
                    words.extend(ShippedScene::titles().map(|(name, title)| (name.to_owned(), title.to_owned())));
                    files = Files::Scenes;
                }
                "COMMAND" => words.extend(commands(program)),
                "FILE" | "GOLDEN" => files = Files::Any,
                word if word.starts_with(|c: char| c.is_ascii_lowercase()) => {
                    words.push((word.to_owned(), String::new()));
                }
                // No words can be offered for other values, such as numbers, vectors and formulas.
                _ => (),
            }
        }
        Self { words, files }
    }

    /// Returns the words without descriptions, separated by spaces.
    pub(super) fn names(&self) -> String {
        self.words.iter().map(|(word, _)| word.as_str()).collect::<Vec<_>>().join(" ")
    }
}

/// Returns the names of the program's commands with their descriptions.
pub(super) fn commands(program: &Command) -> Vec<Word> {
    program.get_subcommands().map(|command| (command.get_name().to_owned(), first_line(command.get_about()))).collect()
}

/// Returns the options of a command, in the order of its help.
pub(super) fn options(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_opts().chain(flags(command)).filter(|arg| !arg.is_hide_set())
}

fn flags(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|arg| !arg.is_positional() && !takes_value(arg))
}

/// Returns whether an option is followed by a value.
pub(super) fn takes_value(arg: &Arg) -> bool {
    matches!(arg.get_action(), ArgAction::Set | ArgAction::Append)
}

/// Returns the option as it is typed: its short form, if it has one, and its long form.
pub(super) fn spellings(arg: &Arg) -> Vec<String> {
    let short = arg.get_short().map(|short| format!("-{short}"));
    short.into_iter().chain(arg.get_long().map(|long| format!("--{long}"))).collect()
}

/// Returns the first line of a help text.
pub(super) fn first_line(help: Option<&StyledStr>) -> String {
    help.map(ToString::to_string).unwrap_or_default().lines().next().unwrap_or_default().to_owned()
}
