//! The settings in `config.ron`, each as text for the parser of its flag.

use super::files::UserFile;
use super::values::check;
use crate::cli::tips;
use clap::Command;
use termtrace::SceneError;
use termtrace::internals::scene_text::{self, Faults, Field, Name, Value, line_and_column};
use termtrace::internals::text::closest;

/// A setting in `config.ron`.
pub(super) struct SettingEntry {
    pub(super) name: String,
    /// The value as it would be written after the setting's flag.
    pub(super) text: String,
    /// The line of the setting, counted from 1.
    pub(super) line: usize,
}

/// Returns the settings in `file`, or all faults of the file.
pub(super) fn read(file: &UserFile, command: &Command) -> Result<Vec<SettingEntry>, SceneError> {
    let name = file.path.to_string_lossy();
    scene_text::read(&name, &file.text, "file of settings is ()", |root, faults| {
        let mut entries = Vec::new();
        let Some(fields) = root.fields() else {
            let expected = "expected named settings, as in (fps: 30, color: 256)";
            faults.add(root.head(), || expected.to_owned());
            return None;
        };
        for (i, field) in fields.iter().enumerate() {
            let Name { text: name, span } = field.name;
            // The search for duplicates is quadratic in the number of fields, which is small: there are a dozen
            // settings, and a file has at most 64 KiB.
            if fields[..i].iter().any(|before| before.name.text == name) {
                faults.add(span, || format!("duplicate setting \"{name}\""));
            } else if let Some(text) = value_text(field, command, faults) {
                let (line, _) = line_and_column(&file.text, span.start as usize);
                entries.push(SettingEntry { name: name.to_owned(), text, line });
            }
        }
        faults.is_empty().then_some(entries)
    })
}

/// Returns a field's value as it would be written after the flag; `None` if it is faulty or is
/// `None` in the file, which counts as unset.
fn value_text(field: &Field<'_>, command: &Command, faults: &mut Faults) -> Option<String> {
    let Field { name, value } = field;
    let Some(setting) = command.get_arguments().find(|setting| setting.get_id() == name.text) else {
        faults.add(name.span, || unknown(name.text, command));
        return None;
    };
    let text = match (&value.value, value.word()) {
        (_, Some("None")) => return None,
        (_, Some(word)) => word.to_owned(),
        (Value::Bool(value), _) => value.to_string(),
        (Value::Number(value), _) => value.to_string(),
        (Value::String(value), _) => value.to_string(),
        _ => {
            faults.add(value.head(), || "expected one value: a word, a number, true or false".to_owned());
            return None;
        }
    };
    match check(command, setting, &text) {
        Ok(()) => Some(text),
        Err(wrong) => {
            faults.add(value.span, || wrong);
            None
        }
    }
}

fn unknown(name: &str, command: &Command) -> String {
    if let Some(new) = tips::renamed_setting(name) {
        return format!("unknown setting \"{name}\"; the name is now \"{new}\"");
    }
    let known: Vec<_> = command.get_arguments().map(|setting| setting.get_id().as_str()).collect();
    match closest(name, known.iter().copied()) {
        Some(meant) => format!("unknown setting \"{name}\"; did you mean \"{meant}\"?"),
        None => format!("unknown setting \"{name}\"; there are {}", known.join(", ")),
    }
}
