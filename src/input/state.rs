//! The states of the parser.

/// The state of the parser, named as in the VT500 parser of Paul Williams.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ParserState {
    /// Between characters: nothing is incomplete.
    #[default]
    Ground,
    /// Inside a multi-byte character.
    Character,
    /// After `ESC`.
    Escape,
    /// After `ESC O`.
    Ss3,
    /// After `ESC [`.
    Csi,
    /// After `ESC [ [`, with which F1 to F5 begin on the Linux console.
    LinuxFunction,
    /// After `ESC [ M`: three bytes of an X10 mouse report follow.
    OldMouse,
    /// Inside a string.
    ControlString(ControlString),
    /// After an `ESC` inside a string; a `\` then ends the string.
    ControlStringEscape(ControlString),
    /// Inside a bracketed paste.
    Paste,
}

/// A kind of control string that a terminal may send.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ControlString {
    /// Operating system command, `ESC ]`: colours, titles.
    Osc,
    /// Device control string, `ESC P`: settings, terminfo, the terminal's name.
    Dcs,
    /// Application program command, `ESC _`: replies of the kitty graphics protocol.
    Apc,
    /// Start of string and privacy message, `ESC X` and `ESC ^`: never used for replies.
    Other,
}

impl ControlString {
    /// Returns whether the contents of a reply of this kind may begin with `byte`.
    pub(super) fn may_begin_with(self, byte: u8) -> bool {
        match self {
            Self::Osc => byte.is_ascii_digit(),
            Self::Dcs => (0x20..=0x3f).contains(&byte),
            Self::Apc => byte == b'G',
            Self::Other => false,
        }
    }
}
