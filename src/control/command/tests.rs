use super::*;

/// Checks that each command's name is unique, and that the command is found by it.
#[test]
fn each_command_has_a_name() {
    for command in Command::all() {
        assert_eq!(Command::from_name(command.name()), Some(command));
        assert!(command.description().len() <= 24, "too long for a help of 40 columns: {command:?}");
    }
    assert_eq!(Command::from_name("movE"), None);
}
