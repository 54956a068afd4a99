//! Where in the stream of bytes the parser stands.

/// Where in the stream of bytes the parser stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Place {
    /// Between characters.
    #[default]
    Ground,
    /// Inside a character of several bytes.
    Character,
    /// After `ESC`.
    Escape,
    /// After `ESC O`.
    Ss3,
    /// After `ESC [`.
    Csi,
    /// After `ESC [ [`, by which the Linux console begins F1 to F5.
    LinuxFunction,
    /// After `ESC [ M`: three bytes of the oldest mouse report follow.
    OldMouse,
    /// Inside a string.
    Text(Text),
    /// After an `ESC` inside a string: `\` ends it.
    TextEscape(Text),
    /// Inside a bracketed paste.
    Paste,
}

/// The kinds of string a terminal may send.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Text {
    /// Operating system command, `ESC ]`: colours, titles.
    Osc,
    /// Device control string, `ESC P`: settings, terminfo, the terminal's name.
    Dcs,
    /// Application program command, `ESC _`: answers of the kitty graphics protocol.
    Apc,
    /// Start of string and privacy message, `ESC X` and `ESC ^`: nothing is answered in them.
    Other,
}

impl Text {
    /// Whether an answer of this kind may begin with `byte`.
    pub(super) fn begins_with(self, byte: u8) -> bool {
        match self {
            Self::Osc => byte.is_ascii_digit(),
            Self::Dcs => (0x20..=0x3f).contains(&byte),
            Self::Apc => byte == b'G',
            Self::Other => false,
        }
    }
}
