//! What a key can mean, with a name for it and words for the help.

use crate::export::Format;

/// What a key can mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// The eye moves while the key is held, and what it looks at with it.
    Move(Direction),
    /// The view turns while the key is held.
    Look(Toward),
    /// The eye goes around the target while the key is held.
    Around(Toward),
    /// The eye comes nearer to the target while the key is held.
    Nearer,
    /// The eye goes away from the target while the key is held.
    Farther,
    /// From flying to going around the target, or back.
    ChangeMode,
    /// All of the scene is seen.
    FrameAll,
    /// The field of view becomes narrower.
    Narrower,
    /// The field of view becomes wider.
    Wider,
    /// The eye goes around the target by itself, or no more.
    Turntable,
    /// To a view of the scene file, or one that was saved: from 1 to 9.
    View(u8),
    /// The view is saved under the number that follows.
    SaveView,
    /// Back to the view at the start.
    Reset,
    /// The next map of the scene.
    NextMap,
    /// The map before.
    LastMap,
    /// Two maps side by side, with a line between them, or one again.
    Compare,
    /// The line between two maps moves.
    Wipe(Side),
    /// The next of several scenes.
    NextScene,
    /// The one before.
    LastScene,
    /// The picture into a file.
    Export,
    /// The camera, as a line for a scene file, into the clipboard.
    CopyCamera,
    /// The view into the scene file's list of them.
    KeepView,
    /// The explanation of a pixel on or off.
    Explain,
    /// A light is taken hold of, the nearest to the pointer; or the next one.
    Light,
    /// It moves as the screen has it, at the same depth.
    MoveLight(Toward),
    /// It comes nearer to the eye.
    LightNearer,
    /// It goes away from the eye.
    LightFarther,
    /// It goes back to where the scene has it.
    LightBack,
    /// The status line on or off.
    Status,
    /// The help on or off.
    Help,
    /// What lies over the picture goes, the topmost first.
    Close,
    /// The whole screen again, in case something else wrote on it.
    Redraw,
    /// Back to the shell, to come again.
    Suspend,
    /// Out.
    Quit,
    /// The cursor to another pixel.
    Point(Toward),
    /// Earlier lines of a text.
    ScrollUp,
    /// Later lines of a text.
    ScrollDown,
    /// The picture is to be written in that format.
    Write(Format),
    /// What was asked is to be done.
    Yes,
    /// It is not.
    No,
}

/// A direction as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along the view.
    Forward,
    /// Against it.
    Back,
    /// Against u.
    Left,
    /// Along u.
    Right,
    /// Along up.
    Up,
    /// Against up.
    Down,
}

/// A direction on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toward {
    /// To its left edge.
    Left,
    /// To its right edge.
    Right,
    /// To its upper edge.
    Up,
    /// To its lower edge.
    Down,
}

/// A side of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

/// Writes the table below as the list of all commands and as a `match` over them: a command without a row does not
/// compile. Those that write the picture are named by the [`Format`].
macro_rules! commands {
    ($([$($command:tt)+] $name:literal, $does:expr;)*) => {
        /// All commands but those that write the picture in a format.
        const COMMANDS: &[Command] = &[$($($command)+),*];

        /// The name where a person binds keys to the command, and what the help says of it.
        const fn words(command: Command) -> (&'static str, &'static str) {
            match command {
                $($($command)+ => ($name, $does),)*
                Command::Write(format) => (format.command(), format.title()),
                // No key can mean it: views have the numbers above.
                Command::View(_) => ("View", A_VIEW),
            }
        }
    };
}

commands! {
    [Command::Move(Direction::Forward)] "MoveForward", "move forward";
    [Command::Move(Direction::Back)] "MoveBack", "move back";
    [Command::Move(Direction::Left)] "MoveLeft", "move left";
    [Command::Move(Direction::Right)] "MoveRight", "move right";
    [Command::Move(Direction::Up)] "MoveUp", "move up";
    [Command::Move(Direction::Down)] "MoveDown", "move down";
    [Command::Look(Toward::Left)] "LookLeft", "look left";
    [Command::Look(Toward::Right)] "LookRight", "look right";
    [Command::Look(Toward::Up)] "LookUp", "look up";
    [Command::Look(Toward::Down)] "LookDown", "look down";
    [Command::Around(Toward::Left)] "AroundLeft", "around to the left";
    [Command::Around(Toward::Right)] "AroundRight", "around to the right";
    [Command::Around(Toward::Up)] "AroundUp", "around upwards";
    [Command::Around(Toward::Down)] "AroundDown", "around downwards";
    [Command::Nearer] "Nearer", "nearer";
    [Command::Farther] "Farther", "farther away";
    [Command::ChangeMode] "ChangeMode", "orbit, or fly again";
    [Command::FrameAll] "Frame", "see everything";
    [Command::Narrower] "Narrower", "narrower field of view";
    [Command::Wider] "Wider", "wider field of view";
    [Command::Turntable] "Turntable", "turntable";
    [Command::View(1)] "View1", A_VIEW;
    [Command::View(2)] "View2", A_VIEW;
    [Command::View(3)] "View3", A_VIEW;
    [Command::View(4)] "View4", A_VIEW;
    [Command::View(5)] "View5", A_VIEW;
    [Command::View(6)] "View6", A_VIEW;
    [Command::View(7)] "View7", A_VIEW;
    [Command::View(8)] "View8", A_VIEW;
    [Command::View(9)] "View9", A_VIEW;
    [Command::SaveView] "SaveView", "save the view as 1 to 9";
    [Command::Reset] "Reset", "back to the first view";
    [Command::NextMap] "NextMap", "next map: depth ...";
    [Command::LastMap] "LastMap", "the map before";
    [Command::Compare] "Compare", "compare two maps";
    [Command::Wipe(Side::Left)] "WipeLeft", "their line to the left";
    [Command::Wipe(Side::Right)] "WipeRight", "their line to the right";
    [Command::NextScene] "NextScene", "next scene";
    [Command::LastScene] "LastScene", "scene before";
    [Command::Export] "Export", "picture to a file";
    [Command::CopyCamera] "CopyCamera", "copy the camera";
    [Command::KeepView] "KeepView", "view into the scene file";
    [Command::Explain] "Explain", "explain a pixel's ray";
    [Command::Light] "Light", "move a light";
    [Command::MoveLight(Toward::Left)] "LightLeft", "light to the left";
    [Command::MoveLight(Toward::Right)] "LightRight", "light to the right";
    [Command::MoveLight(Toward::Up)] "LightUp", "light up";
    [Command::MoveLight(Toward::Down)] "LightDown", "light down";
    [Command::LightNearer] "LightNearer", "light nearer to the eye";
    [Command::LightFarther] "LightFarther", "light farther away";
    [Command::LightBack] "LightBack", "light back to its place";
    [Command::Status] "Status", "status line";
    [Command::Help] "Help", "this help";
    [Command::Close] "Close", "close it";
    [Command::Redraw] "Redraw", "draw the screen again";
    [Command::Suspend] "Suspend", "to the shell; fg returns";
    [Command::Quit] "Quit", "leave";
    [Command::Point(Toward::Left)] "PointLeft", "cursor to the left";
    [Command::Point(Toward::Right)] "PointRight", "cursor to the right";
    [Command::Point(Toward::Up)] "PointUp", "cursor up";
    [Command::Point(Toward::Down)] "PointDown", "cursor down";
    [Command::ScrollUp] "ScrollUp", "earlier lines";
    [Command::ScrollDown] "ScrollDown", "later lines";
    [Command::Yes] "Yes", "yes";
    [Command::No] "No", "no";
}

/// The help has them in one row.
const A_VIEW: &str = "a saved view";

impl Command {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        COMMANDS.iter().copied().chain(Format::ALL.iter().copied().map(Self::Write))
    }

    /// The command of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|command| command.name() == name)
    }

    /// What it is called where a person binds keys to it. Names stay: people's files have them.
    pub fn name(self) -> &'static str {
        words(self).0
    }

    /// What the help says of it, in a few words.
    pub fn description(self) -> &'static str {
        words(self).1
    }

    /// Whether it goes on as long as its key is held.
    pub fn moves(self) -> bool {
        matches!(self, Self::Move(_) | Self::Look(_) | Self::Around(_) | Self::Nearer | Self::Farther)
    }

    /// Whether it answers a question.
    pub fn answers(self) -> bool {
        matches!(self, Self::Write(_) | Self::Yes | Self::No)
    }

    /// Whether the key's own repeats do it again.
    pub fn repeats(self) -> bool {
        let of_panels = matches!(self, Self::Point(_) | Self::ScrollUp | Self::ScrollDown | Self::Wipe(_));
        of_panels || self.moves_light() || matches!(self, Self::Narrower | Self::Wider)
    }

    /// Whether Shift with the key does more of it.
    pub fn has_faster(self) -> bool {
        self.moves() || self.moves_light() || matches!(self, Self::Point(_))
    }

    fn moves_light(self) -> bool {
        matches!(self, Self::MoveLight(_) | Self::LightNearer | Self::LightFarther)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Its own, and by it the command is found.
    #[test]
    fn each_command_has_a_name() {
        for command in Command::all() {
            assert_eq!(Command::from_name(command.name()), Some(command));
            assert!(command.description().len() <= 24, "too long for a help of 40 columns: {command:?}");
        }
        assert_eq!(Command::from_name("movE"), None);
    }
}
