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
