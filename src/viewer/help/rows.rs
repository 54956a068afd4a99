//! The rows of the help, by group: the keys in force and what they do.

use crate::control::{Command, Direction, Key, KeyMode, Keymap, ScreenSide, Toward};
use crossterm::event::KeyCode;
use std::collections::HashSet;
use unicode_width::UnicodeWidthStr;

/// A group of rows, in the order of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    Move,
    Look,
    Views,
    Maps,
    Light,
    Files,
    Program,
    Mouse,
}

impl Group {
    const ALL: [Self; 8] =
        [Self::Move, Self::Look, Self::Views, Self::Maps, Self::Light, Self::Files, Self::Program, Self::Mouse];

    fn for_command(command: Command) -> Self {
        use Command as C;
        match command {
            C::Move(_) | C::Around(_) | C::Nearer | C::Farther | C::ChangeMode | C::Turntable | C::Pause => Self::Move,
            C::Look(_)
            | C::Narrower
            | C::Wider
            | C::ShiftLeft
            | C::ShiftRight
            | C::ShiftDown
            | C::ShiftUp
            | C::TiltLeft
            | C::TiltRight
            | C::TiltDown
            | C::TiltUp => Self::Look,
            C::Front
            | C::FromRight
            | C::FromAbove
            | C::TurnMesh
            | C::Axes
            | C::FrameAll
            | C::View(_)
            | C::SaveView
            | C::Reset
            | C::ViewBack
            | C::ViewForward
            | C::Tour
            | C::Lead
            | C::ListViewers
            | C::MarkViewers => Self::Views,
            C::NextMap
            | C::LastMap
            | C::Compare
            | C::Wipe(_)
            | C::Wireframe
            | C::NextGlyphs
            | C::Explain
            | C::Outside
            | C::Orders
            | C::BuildPause
            | C::BuildFaster
            | C::BuildSlower
            | C::BuildAgain
            | C::Point(_)
            | C::ScrollUp
            | C::ScrollDown => Self::Maps,
            C::Light | C::MoveLight(_) | C::LightNearer | C::LightFarther | C::LightBack => Self::Light,
            C::NextScene
            | C::LastScene
            | C::Export
            | C::ExportLarge
            | C::Record
            | C::CopyCamera
            | C::KeepView
            | C::Write(_)
            | C::Yes
            | C::No => Self::Files,
            C::Caption | C::Metadata | C::Status | C::Help | C::Close | C::Redraw | C::Suspend | C::Quit => {
                Self::Program
            }
        }
    }
}

/// The directions in the order of the keys `h` `j` `k` `l`.
const HJKL: [Toward; 4] = [Toward::Left, Toward::Down, Toward::Up, Toward::Right];

/// Returns groups of commands, each with a description. The commands of a group share a row of the
/// help if all have the same number of keys.
fn shared_rows() -> Vec<(Vec<Command>, &'static str)> {
    use Direction::{Back, Down, Forward, Left, Right, Up};
    let toward = |command: fn(Toward) -> Command| HJKL.map(command).to_vec();
    vec![
        // The directions are in the order in which their keys are usually named: W A S D.
        ([Forward, Left, Back, Right].map(Command::Move).to_vec(), "move"),
        ([Left, Right].map(Command::Move).to_vec(), "left, right"),
        ([Up, Down].map(Command::Move).to_vec(), "up, down"),
        (vec![Command::Nearer, Command::Farther], "closer, farther"),
        (toward(Command::Around), "orbit"),
        (toward(Command::Look), "look around"),
        (vec![Command::Narrower, Command::Wider], "zoom in, out"),
        (vec![Command::ShiftLeft, Command::ShiftRight, Command::ShiftDown, Command::ShiftUp], "shift rectangle"),
        (vec![Command::TiltLeft, Command::TiltRight, Command::TiltDown, Command::TiltUp], "tilt rectangle"),
        ((1..=9).map(Command::View).collect(), "go to view 1-9"),
        (vec![Command::NextMap, Command::LastMap], "next, previous map"),
        (vec![Command::Wipe(ScreenSide::Left), Command::Wipe(ScreenSide::Right)], "divider left, right"),
        (vec![Command::Wireframe, Command::NextGlyphs], "wireframe, kind of cells"),
        (vec![Command::BuildFaster, Command::BuildSlower], "build faster, slower"),
        (toward(Command::Point), "move the cursor"),
        (vec![Command::ScrollUp, Command::ScrollDown], "turn pages"),
        (toward(Command::MoveLight), "move the light"),
        (vec![Command::LightNearer, Command::LightFarther], "closer, farther"),
        (vec![Command::NextScene, Command::LastScene], "next, previous scene"),
    ]
}

/// A row of the help: keys and what they do.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) group: Group,
    pub(super) keys: String,
    pub(super) does: String,
}

/// Returns the rows of all groups that contain `filter`, ignoring case.
///
/// A key that a mode binds is left out for the modes after it in `modes`. `states` has words on the current state,
/// which follow the descriptions.
pub(super) fn rows(keymap: &Keymap, modes: &[KeyMode], states: &[(Command, String)], filter: &str) -> Vec<Row> {
    let rows = [key_rows(keymap, modes, states), mouse_rows(modes)].concat();
    let filter = filter.to_lowercase();
    // The name of the group counts too, so that the filter `views` finds all rows of that group.
    let contains = |row: &&Row| format!("{:?} {} {}", row.group, row.keys, row.does).to_lowercase().contains(&filter);
    let rows: Vec<_> = rows.iter().filter(contains).collect();
    let of_group = |group| rows.iter().filter(move |row| row.group == group);
    Group::ALL.into_iter().flat_map(of_group).map(|&row| row.clone()).collect()
}

fn key_rows(keymap: &Keymap, modes: &[KeyMode], states: &[(Command, String)]) -> Vec<Row> {
    let bound = bound_commands(keymap, modes);
    let keys_of = |command| bound.iter().find(|(bound, _)| *bound == command).map_or(&[][..], |(_, keys)| keys);
    let row = |commands: &[Command], keys, does: &str| {
        let state = states.iter().find(|(command, _)| commands.contains(command));
        let does = state.map_or_else(|| does.to_owned(), |(_, state)| format!("{does} ({state})"));
        Row { group: Group::for_command(commands[0]), keys, does }
    };
    let (mut listed, mut rows) = (HashSet::new(), Vec::new());
    // Shift has a row although the keymap does not bind it: it makes the movement keys faster.
    rows.push(Row { group: Group::Move, keys: "Shift".to_owned(), does: "hold: 4x faster".to_owned() });
    let shared = shared_rows();
    for (command, keys) in &bound {
        let is_new = |commands: &[Command]| commands.iter().all(|command| !listed.contains(command.name()));
        let shares = |(commands, _): &&(Vec<Command>, _)| {
            let count = keys.len();
            commands.contains(command) && is_new(commands) && commands.iter().all(|&of| keys_of(of).len() == count)
        };
        if !is_new(&[*command]) {
            continue;
        }
        if let Some((commands, does)) = shared.iter().find(shares) {
            let keys: Vec<_> = commands.iter().map(|&command| keys_of(command)).collect();
            rows.push(row(commands, shared_label(&keys), does));
            listed.extend(commands.iter().map(|command| command.name()));
        } else {
            let names = keys.iter().map(Key::to_string).collect::<Vec<_>>().join(" ");
            listed.insert(command.name());
            // Other commands with the same description share a row too, such as the digits if one is bound to another
            // command.
            match rows.iter_mut().find(|row| row.does == command.description()) {
                Some(same) => same.keys = format!("{} {names}", same.keys),
                None => rows.push(row(&[*command], names, command.description())),
            }
        }
    }
    // The row of Shift is moved behind those of the keys that it makes faster.
    let last = rows.iter().rposition(|row| row.group == Group::Move).unwrap_or(0);
    rows[..=last].rotate_left(1);
    rows
}

/// Returns the commands with the keys that are in force, topmost mode first.
fn bound_commands(keymap: &Keymap, modes: &[KeyMode]) -> Vec<(Command, Vec<Key>)> {
    let mut taken = HashSet::new();
    let mut bound: Vec<(Command, Vec<Key>)> = Vec::new();
    for row in modes.iter().flat_map(|&mode| keymap.of(mode)) {
        let keys: Vec<_> = row.keys.iter().filter(|key| taken.insert(**key)).copied().collect();
        match bound.iter_mut().find(|(command, _)| *command == row.command) {
            _ if keys.is_empty() => {}
            Some((_, more)) => more.extend(keys),
            None => bound.push((row.command, keys)),
        }
    }
    bound
}

/// Returns the keys of several commands: the first key of each command, then the second of each,
/// and so on.
fn shared_label(keys: &[&[Key]]) -> String {
    let of = |at: usize| keys.iter().map(move |keys| keys[at]).collect::<Vec<_>>();
    (0..keys[0].len()).map(|at| joined(&of(at))).collect::<Vec<_>>().join(" ")
}

fn joined(keys: &[Key]) -> String {
    let names: Vec<_> = keys.iter().map(Key::to_string).collect();
    if is_arrows(keys) {
        return "arrows".to_owned();
    }
    // The nine digits of views would be 17 columns wide, more than `MAX_ALIGNED`.
    if let ([first, .., last], 5..) = (&names[..], names.len()) {
        return format!("{first}..{last}");
    }
    // Four letters are written as a word: WASD.
    let is_letter = |key: &Key| matches!(key.code, KeyCode::Char('a'..='z')) && !key.ctrl;
    if names.len() == 4 && keys.iter().all(is_letter) {
        return names.concat().to_uppercase();
    }
    names.join(" ")
}

/// Returns whether these are the four arrows, in any order.
pub(super) fn is_arrows(keys: &[Key]) -> bool {
    let arrows = [KeyCode::Left, KeyCode::Right, KeyCode::Up, KeyCode::Down].map(Key::named);
    keys.len() == arrows.len() && arrows.iter().all(|arrow| keys.contains(arrow))
}

/// Returns the rows about the mouse in these modes.
fn mouse_rows(modes: &[KeyMode]) -> Vec<Row> {
    let [drag, wheel] = if modes.contains(&KeyMode::Light) {
        ["move the light", "closer, farther"]
    } else if modes.contains(&KeyMode::Explain) {
        ["move the cursor", "closer, farther"]
    } else if modes.contains(&KeyMode::Orbit) {
        ["orbit", "closer, farther"]
    } else {
        ["look around", "closer, farther"]
    };
    let rows = [("drag", drag), ("right drag", "shift the view"), ("wheel", wheel), ("double click", "frame object")];
    rows.map(|(keys, does)| Row { group: Group::Mouse, keys: keys.to_owned(), does: does.to_owned() }).to_vec()
}

/// A line of the help: a heading, or keys with what they do.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Line {
    Heading(String),
    Row(String),
}

impl Line {
    pub(super) fn text(&self) -> &str {
        match self {
            Self::Heading(text) | Self::Row(text) => text,
        }
    }
}

/// Largest width of a row's keys, in columns, with which the row is aligned with the others of its
/// group.
// In a row with longer keys the description starts farther right, so that the other rows fit into 36 columns.
const MAX_ALIGNED: usize = 12;

/// Returns the rows as lines, each group under its heading, with its descriptions aligned.
pub(super) fn lines(rows: &[Row]) -> Vec<Line> {
    let mut lines = Vec::new();
    for rows in rows.chunk_by(|a, b| a.group == b.group) {
        lines.push(Line::Heading(format!("{:?}", rows[0].group)));
        let widths = rows.iter().map(|row| row.keys.width());
        let keys = widths.filter(|&width| width <= MAX_ALIGNED).max().unwrap_or(0);
        // The keys are padded by columns, whereas the width of a format counts characters.
        let pad = |row: &Row| " ".repeat(keys.saturating_sub(row.keys.width()));
        let text = |row: &Row| format!("{}{}  {}", row.keys, pad(row), row.does);
        lines.extend(rows.iter().map(|row| Line::Row(text(row))));
    }
    lines
}
