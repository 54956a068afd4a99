//! The commands that keys run, with their names in the keymap and their descriptions in the help.

use crate::export::Format;

/// A command that a key runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Moves eye and target while the key is held.
    Move(Direction),
    /// Turns the view about the eye while the key is held.
    Look(Toward),
    /// Orbits the eye about the target while the key is held.
    Around(Toward),
    /// Moves the eye towards the target while the key is held.
    Nearer,
    /// Moves the eye away from the target while the key is held.
    Farther,
    /// Switches between the modes in which keys fly the eye and orbit it about the target.
    ChangeMode,
    /// Moves the eye, but does not turn it, so that all objects except planes fill the picture.
    FrameAll,
    /// Narrows the field of view.
    Narrower,
    /// Widens the field of view.
    Wider,
    /// Shifts the view rectangle to the left.
    ShiftLeft,
    /// Shifts the view rectangle to the right.
    ShiftRight,
    /// Shifts the view rectangle down.
    ShiftDown,
    /// Shifts the view rectangle up.
    ShiftUp,
    /// Tilts the view rectangle to the left.
    TiltLeft,
    /// Tilts the view rectangle to the right.
    TiltRight,
    /// Tilts the view rectangle down, to face lower than the camera looks.
    TiltDown,
    /// Tilts the view rectangle up, to face higher than the camera looks.
    TiltUp,
    /// Starts or stops the turntable, which orbits the target without a key.
    Turntable,
    /// Pauses a scene that moves, or lets it go on.
    Pause,
    /// Enters or leaves the tour that a server gives.
    ///
    /// No key is bound to it by default.
    Tour,
    /// Starts or stops leading the tour of a server.
    ///
    /// No key is bound to it by default.
    Lead,
    /// Opens the list of a server's viewers, turns its page, or closes it.
    ///
    /// No key is bound to it by default.
    ListViewers,
    /// Shows or hides the number of a server's viewers, and marks at their cameras.
    ///
    /// No key is bound to it by default.
    MarkViewers,
    /// Moves the camera to view 1 to 9: one saved by the user, otherwise one of the scene file.
    View(u8),
    /// Asks for a number from 1 to 9 and saves the camera as that view.
    SaveView,
    /// Returns to the scene's own camera.
    Reset,
    /// Returns to the view before the last jump.
    ViewBack,
    /// Returns to the view that [`ViewBack`](Self::ViewBack) left.
    ViewForward,
    /// Shows the next map.
    NextMap,
    /// Shows the previous map.
    LastMap,
    /// Switches from one map to two side by side, to a wipe (two maps with a movable line between),
    /// and back.
    Compare,
    /// Moves the line between the two maps of a wipe.
    Wipe(ScreenSide),
    /// Shows the next scene.
    NextScene,
    /// Shows the previous scene.
    LastScene,
    /// Asks for a format and exports the picture to a file.
    Export,
    /// Exports a large, smooth picture to a file in the background.
    ExportLarge,
    /// Starts or stops recording the session to a file.
    Record,
    /// Copies the camera to the clipboard, as a line of a scene file.
    CopyCamera,
    /// Asks whether to save the view to the `views` of the scene file.
    KeepView,
    /// Opens or closes the explanation of a pixel.
    Explain,
    /// Selects the light nearest to the pointer for moving or, if one is selected, the next light
    /// in the scene file.
    Light,
    /// Moves the selected light in a direction of the screen, at constant depth.
    MoveLight(Toward),
    /// Moves the selected light towards the eye.
    LightNearer,
    /// Moves the selected light away from the eye.
    LightFarther,
    /// Returns the selected light to its position in the scene.
    LightBack,
    /// Opens or closes the status line.
    Status,
    /// Opens the help, turns its page, or closes it.
    Help,
    /// Closes the topmost panel or deselects the selected light.
    Close,
    /// Looks at all bounded objects from the front, along -z.
    Front,
    /// Looks at all bounded objects from the right, along -x.
    FromRight,
    /// Looks at all bounded objects from above.
    FromAbove,
    /// Switches between the edges of triangles and the shaded picture.
    Wireframe,
    /// Shows or hides the drawing of the x, y and z axes in the corner.
    Axes,
    /// Shows the next of four views.
    ///
    /// In the first two, a second camera shows the first one and its rays from outside, and keys move the second or the
    /// first camera. Then come the ordinary view with vanishing points, and the ordinary view alone.
    Outside,
    /// Starts or ends the comparison of ray tracing (image order) and rasterization (object order).
    Orders,
    /// Pauses or continues the build-up of both pictures of [`Orders`](Self::Orders).
    BuildPause,
    /// Doubles the speed at which both pictures of [`Orders`](Self::Orders) are built up.
    BuildFaster,
    /// Halves the speed at which both pictures of [`Orders`](Self::Orders) are built up.
    BuildSlower,
    /// Restarts the build-up of both pictures of [`Orders`](Self::Orders).
    BuildAgain,
    /// Shows or hides the name, the format and the size of the scene.
    Metadata,
    /// Shows the picture with the next kind of cells, such as half blocks or characters.
    NextGlyphs,
    /// Turns a mesh so that the next axis of its file points up.
    TurnMesh,
    /// Shows the scene's caption, then its next page; hides it after the last page.
    Caption,
    /// Redraws the whole screen, in case another program has written on it.
    Redraw,
    /// Suspends the program; the shell's `fg` continues it.
    Suspend,
    /// Quits the program.
    Quit,
    /// Moves the cursor that selects the pixel to explain.
    Point(Toward),
    /// Shows the previous page of the explanation.
    ScrollUp,
    /// Shows the next page of the explanation.
    ScrollDown,
    /// Answers the dialog of the export: write this format.
    Write(Format),
    /// Answers a dialog: yes.
    Yes,
    /// Answers a dialog: no.
    No,
}

/// A direction relative to the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along the view direction, -w.
    Forward,
    /// Against the view direction, along w.
    Back,
    /// Against the camera's u, to the left.
    Left,
    /// Along the camera's u, to the right.
    Right,
    /// Along the camera's up vector.
    Up,
    /// Against the camera's up vector.
    Down,
}

/// A direction on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Toward {
    /// Towards the left edge.
    Left,
    /// Towards the right edge.
    Right,
    /// Towards the upper edge.
    Up,
    /// Towards the lower edge.
    Down,
}

/// A side of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScreenSide {
    /// The left side of the screen.
    Left,
    /// The right side of the screen.
    Right,
}

/// Expands the table below to the list of commands and a `match` over them, so that a command
/// without a row does not compile. Commands that write a [`Format`] are not rows: their names come from the format.
macro_rules! commands {
    ($([$($command:tt)+] $name:literal, $does:expr;)*) => {
        /// All commands except `Write`, which exists once for each format.
        const COMMANDS: &[Command] = &[$($($command)+),*];

        /// Returns the command's name in the keymap and its description in the help.
        const fn name_and_description(command: Command) -> (&'static str, &'static str) {
            match command {
                $($($command)+ => ($name, $does),)*
                Command::Write(format) => (format.command(), format.title()),
                // Unreachable: the table has rows for views 1 to 9, but the compiler expects all values of a u8.
                Command::View(_) => ("View", A_VIEW),
            }
        }
    };
}

// Descriptions have at most 24 characters. As in other programs' help, each is an imperative, such as `move left`, or
// names the result, such as `next map`.
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
    [Command::Around(Toward::Left)] "AroundLeft", "orbit to the left";
    [Command::Around(Toward::Right)] "AroundRight", "orbit to the right";
    [Command::Around(Toward::Up)] "AroundUp", "orbit upwards";
    [Command::Around(Toward::Down)] "AroundDown", "orbit downwards";
    [Command::Nearer] "Nearer", "closer to the target";
    [Command::Farther] "Farther", "away from the target";
    [Command::ChangeMode] "ChangeMode", "switch fly and orbit";
    [Command::FrameAll] "Frame", "frame all (when lost)";
    [Command::Narrower] "Narrower", "zoom in (field of view)";
    [Command::Wider] "Wider", "zoom out (field of view)";
    [Command::ShiftLeft] "ShiftLeft", "shift rectangle left";
    [Command::ShiftRight] "ShiftRight", "shift rectangle right";
    [Command::ShiftDown] "ShiftDown", "shift rectangle down";
    [Command::ShiftUp] "ShiftUp", "shift rectangle up";
    [Command::TiltLeft] "TiltLeft", "tilt rectangle left";
    [Command::TiltRight] "TiltRight", "tilt rectangle right";
    [Command::TiltDown] "TiltDown", "tilt rectangle down";
    [Command::TiltUp] "TiltUp", "tilt rectangle up";
    [Command::Turntable] "Turntable", "turntable on or off";
    [Command::Pause] "Pause", "pause a moving scene";
    [Command::Tour] "Tour", "enter or leave the tour";
    [Command::Lead] "Lead", "lead the tour or stop";
    [Command::ListViewers] "ListViewers", "list of viewers";
    [Command::MarkViewers] "MarkViewers", "mark other viewers";
    [Command::View(1)] "View1", A_VIEW;
    [Command::View(2)] "View2", A_VIEW;
    [Command::View(3)] "View3", A_VIEW;
    [Command::View(4)] "View4", A_VIEW;
    [Command::View(5)] "View5", A_VIEW;
    [Command::View(6)] "View6", A_VIEW;
    [Command::View(7)] "View7", A_VIEW;
    [Command::View(8)] "View8", A_VIEW;
    [Command::View(9)] "View9", A_VIEW;
    [Command::SaveView] "SaveView", "save view as 1-9";
    [Command::Reset] "Reset", "first view";
    [Command::ViewBack] "ViewBack", "view before";
    [Command::ViewForward] "ViewForward", "view after";
    [Command::NextMap] "NextMap", "next map (depth, ...)";
    [Command::LastMap] "LastMap", "previous map";
    [Command::Compare] "Compare", "compare two maps";
    [Command::Wipe(ScreenSide::Left)] "WipeLeft", "divider left";
    [Command::Wipe(ScreenSide::Right)] "WipeRight", "divider right";
    [Command::NextScene] "NextScene", "next scene";
    [Command::LastScene] "LastScene", "previous scene";
    [Command::Export] "Export", "save picture";
    [Command::ExportLarge] "ExportLarge", "save large picture";
    [Command::Record] "Record", "record session or stop";
    [Command::CopyCamera] "CopyCamera", "copy camera";
    [Command::KeepView] "KeepView", "save view to scene file";
    [Command::Explain] "Explain", "explain a pixel";
    [Command::Light] "Light", "move a light";
    [Command::MoveLight(Toward::Left)] "LightLeft", "light to the left";
    [Command::MoveLight(Toward::Right)] "LightRight", "light to the right";
    [Command::MoveLight(Toward::Up)] "LightUp", "light up";
    [Command::MoveLight(Toward::Down)] "LightDown", "light down";
    [Command::LightNearer] "LightNearer", "light closer";
    [Command::LightFarther] "LightFarther", "light farther";
    [Command::LightBack] "LightBack", "reset light position";
    [Command::Status] "Status", "status line on or off";
    [Command::Help] "Help", "this help";
    [Command::Close] "Close", "close panel";
    [Command::Front] "Front", A_SIDE;
    [Command::FromRight] "FromRight", A_SIDE;
    [Command::FromAbove] "FromAbove", A_SIDE;
    [Command::Wireframe] "Wireframe", "wireframe on or off";
    [Command::Axes] "Axes", "axes on or off";
    [Command::Outside] "Outside", "tracer from outside";
    [Command::Orders] "Orders", "image and object order";
    [Command::BuildPause] "BuildPause", "pause or go on";
    [Command::BuildFaster] "BuildFaster", "build faster";
    [Command::BuildSlower] "BuildSlower", "build slower";
    [Command::BuildAgain] "BuildAgain", "build again";
    [Command::Metadata] "Metadata", "name, format and size";
    [Command::NextGlyphs] "NextGlyphs", "next kind of cells";
    [Command::TurnMesh] "TurnMesh", "mesh: next axis up";
    [Command::Caption] "Caption", "caption on or off";
    [Command::Redraw] "Redraw", "redraw";
    [Command::Suspend] "Suspend", "suspend (fg returns)";
    [Command::Quit] "Quit", "quit";
    [Command::Point(Toward::Left)] "PointLeft", "cursor to the left";
    [Command::Point(Toward::Right)] "PointRight", "cursor to the right";
    [Command::Point(Toward::Up)] "PointUp", "cursor up";
    [Command::Point(Toward::Down)] "PointDown", "cursor down";
    [Command::ScrollUp] "ScrollUp", "previous page";
    [Command::ScrollDown] "ScrollDown", "next page";
    [Command::Yes] "Yes", "yes";
    [Command::No] "No", "cancel";
}

/// The description of the three commands that look from a side, which share a row of the help.
const A_SIDE: &str = "front, right, top view";

/// The description of the nine commands that show a stored view, which share a row of the help.
const A_VIEW: &str = "go to view 1-9";

impl Command {
    /// Returns all commands.
    pub fn all() -> impl Iterator<Item = Self> {
        COMMANDS.iter().copied().chain(Format::ALL.iter().copied().map(Self::Write))
    }

    /// Returns the command with this name in the keymap.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|command| command.name() == name)
    }

    /// Returns the command's name in the keymap.
    ///
    /// Names never change, because users' files contain them.
    pub fn name(self) -> &'static str {
        name_and_description(self).0
    }

    /// Returns a description for the help, of at most 24 characters.
    ///
    /// With this limit, two lists of keys fit side by side on a screen of 80 columns.
    pub fn description(self) -> &'static str {
        name_and_description(self).1
    }

    /// Returns whether the command lasts as long as its key is held.
    pub fn is_motion(self) -> bool {
        matches!(self, Self::Move(_) | Self::Look(_) | Self::Around(_) | Self::Nearer | Self::Farther)
    }

    /// Returns whether the command answers a dialog.
    pub fn answers_dialog(self) -> bool {
        matches!(self, Self::Write(_) | Self::Yes | Self::No)
    }

    /// Returns whether repeats of a held key execute the command again.
    pub fn repeats(self) -> bool {
        // Toggles do not repeat: a key held too long would open and close a panel 25 times a second.
        let of_panels = matches!(self, Self::Point(_) | Self::ScrollUp | Self::ScrollDown | Self::Wipe(_));
        let shifts = matches!(self, Self::ShiftLeft | Self::ShiftRight | Self::ShiftDown | Self::ShiftUp);
        let tilts = matches!(self, Self::TiltLeft | Self::TiltRight | Self::TiltDown | Self::TiltUp);
        let of_build = matches!(self, Self::BuildFaster | Self::BuildSlower);
        of_panels || shifts || tilts || of_build || self.moves_light() || matches!(self, Self::Narrower | Self::Wider)
    }

    /// Returns whether Shift with the key makes the command faster.
    pub fn has_faster(self) -> bool {
        // Shift does not make the wipe and the zoom faster, because their steps are already coarse.
        self.is_motion() || self.moves_light() || matches!(self, Self::Point(_))
    }

    fn moves_light(self) -> bool {
        matches!(self, Self::MoveLight(_) | Self::LightNearer | Self::LightFarther)
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
