use super::*;

#[test]
fn sizes_are_clamped() {
    let size = |columns, rows| window([columns, rows, 0, 0]).size;
    assert_eq!(size(80, 24), Size::new(80, 24));
    assert_eq!(size(u32::MAX, u32::MAX), MAX_WINDOW);
    assert_eq!(size(65_536, 1), Size::new(500, 1));
    assert_eq!(size(0, 0), Size::new(80, 24));
    assert_eq!(size(0, 50), Size::new(80, 24));
}

#[test]
fn pixels_give_the_shape_of_a_cell() {
    let seen = window([80, 24, 800, 480]);
    assert_eq!((seen.cell.aspect, seen.cell_pixels), (Some(2.0), Some((10, 20))));
    for pixels in [[0, 0], [u32::MAX, u32::MAX], [1, 1], [800, 0]] {
        let seen = window([80, 24, pixels[0], pixels[1]]);
        assert_eq!((seen.cell.aspect, seen.cell_pixels), (None, None), "{pixels:?}");
    }
}

#[test]
fn few_variables_are_accepted_and_none_that_could_be_a_path() {
    let mut terminal = ClientTerminal::default();
    for value in ["xterm-256color", "../../../etc/passwd", "..", ".", "a/b", "x\x1b[31m", &"x".repeat(65), "tmux"] {
        terminal.set_variable("TERM", value);
    }
    terminal.set_variable("LD_PRELOAD", "x.so");
    terminal.set_variable("TERMINFO", "x");
    for _ in 0..10_000 {
        terminal.set_variable("COLORTERM", "truecolor");
    }
    assert_eq!(terminal.variables, [("TERM", "tmux".to_owned()), ("COLORTERM", "truecolor".to_owned())]);
    let hints = terminal.hints(&|_| panic!("COLORTERM decides"));
    assert_eq!(hints.variable("TERM"), Some("tmux"));
}
