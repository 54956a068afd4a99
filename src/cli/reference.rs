//! `termtrace reference`: prints the reference of scene files.

use super::outcome::{CommandResult, Failure, write_stdout};
use clap::Args;
use std::fmt::Write;
use termtrace::internals::scene_file::reference;
use termtrace::internals::text::closest;
use termtrace::internals::written::ReferenceEntry;

const EXAMPLES: &str = "\
Examples:
  termtrace reference          all fields of a scene, its lights and objects
  termtrace reference Globe    those of one light, shape, material or finish";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct ReferenceArgs {
    /// Name to print alone, such as Sphere, Spot or camera
    #[arg(value_name = "NAME")]
    name: Option<String>,
}

pub(super) fn run(ReferenceArgs { name }: &ReferenceArgs) -> CommandResult {
    let reference = reference();
    let Some(name) = name else {
        let mut text = String::new();
        for (at, (title, entries)) in reference.iter().enumerate() {
            let _ = writeln!(text, "{}{title}", if at == 0 { "" } else { "\n" });
            for entry in entries {
                add(entry, &mut text);
            }
        }
        return write_stdout(text.as_bytes());
    };
    let entries = || reference.iter().flat_map(|(_, entries)| entries);
    let Some(entry) = entries().find(|entry| entry.name.eq_ignore_ascii_case(name)) else {
        let meant = closest(name, entries().map(|entry| entry.name));
        let meant = meant.map_or_else(
            || "termtrace reference prints all of them".to_owned(),
            |meant| format!("did you mean {meant}?"),
        );
        return Err(Failure::Usage(format!("scene files have no {name:?}; {meant}")));
    };
    let mut text = String::new();
    add(entry, &mut text);
    write_stdout(text.trim_start_matches('\n').as_bytes())
}

/// Adds an entry: its form, its summary, and a line for each field.
fn add(entry: &ReferenceEntry, text: &mut String) {
    let label = if entry.form.starts_with('(') { format!("{} ", entry.name) } else { String::new() };
    let _ = writeln!(text, "\n  {label}{}\n    {}", entry.form, entry.summary);
    let width = entry.fields.iter().map(|field| field.len()).max().unwrap_or(0);
    for (field, meaning) in entry.fields.iter().zip(entry.meanings) {
        let (meaning, default) = meaning.rsplit_once("; ").map_or((*meaning, None), |(text, end)| (text, Some(end)));
        let default = default.map_or_else(|| " [required]".to_owned(), |default| format!(" [default: {default}]"));
        let _ = writeln!(text, "    {field:width$}  {meaning}{default}");
    }
}
