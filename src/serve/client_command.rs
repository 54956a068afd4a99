//! The commands of clients: the name of a scene, or the list of scenes.

/// The largest length of a command in bytes; no scene has a longer name.
const MAX_COMMAND: usize = 256;

/// The request of a client: a scene, or the list of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClientCommand {
    /// The view of the scene with this index.
    Scene(usize),
    /// The list of scenes.
    List,
}

/// Returns the request that a command makes of a server with scenes of these names.
///
/// # Errors
/// The message for the client, of printable characters.
pub(super) fn parse_command<'a>(
    command: &[u8],
    scene_names: impl Iterator<Item = &'a str>,
) -> Result<ClientCommand, String> {
    let wrong = || "a command is the name of a scene, or --list, which prints their names".to_owned();
    let command = std::str::from_utf8(command).ok().filter(|command| command.len() <= MAX_COMMAND).ok_or_else(wrong)?;
    match command.trim() {
        "" => Ok(ClientCommand::Scene(0)),
        "--list" => Ok(ClientCommand::List),
        // The name is only compared and never used as a path or given to a shell.
        name => scene_names.into_iter().position(|known| known == name).map(ClientCommand::Scene).ok_or_else(wrong),
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
