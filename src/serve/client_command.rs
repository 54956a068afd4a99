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
mod tests {
    use super::*;

    #[test]
    fn only_names_of_scenes_are_understood() {
        let parse = |command: &[u8]| parse_command(command, ["balls", "corridor"].into_iter());
        assert_eq!(parse(b"corridor"), Ok(ClientCommand::Scene(1)));
        assert_eq!(parse(b" corridor\n"), Ok(ClientCommand::Scene(1)));
        assert_eq!(parse(b""), Ok(ClientCommand::Scene(0)));
        assert_eq!(parse(b"--list"), Ok(ClientCommand::List));
        let long = vec![b'a'; 300 * 1024];
        let wrong: [&[u8]; 7] = [b"../../etc/passwd", b"x;id", b"corridor; id", b"/", b"\x1b[2J", &[0xff, 0xfe], &long];
        for command in wrong {
            let message = parse(command).expect_err("there is no such scene");
            assert!(message.chars().all(|c| (' '..='~').contains(&c)) && message.len() < 80, "{message}");
        }
    }
}
