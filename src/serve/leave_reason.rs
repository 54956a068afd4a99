//! The reasons why a viewer leaves, with their words.

/// The reason why a viewer leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LeaveReason {
    /// The user quit.
    Quit,
    /// No key was pressed for too long.
    Idle,
    /// The visit has lasted for the longest time that is allowed.
    TimeOver,
    /// The server ends.
    Drained,
    /// There is not enough memory for the window.
    OutOfMemory,
    /// A turn has panicked.
    Fault,
}

impl LeaveReason {
    /// Returns the note with the seconds that are left until the viewer has to leave for this
    /// reason.
    pub(super) fn countdown_text(self, seconds: u64) -> String {
        let what = match self {
            Self::Idle => "no key for a while: any key stays, else you leave",
            Self::TimeOver => "your time is over: you leave",
            _ => "the server restarts: you leave",
        };
        format!("{what} in {seconds} s")
    }

    /// Returns the name of the reason in the log.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Quit => "quit",
            Self::Idle => "idle",
            Self::TimeOver => "time_over",
            Self::Drained => "drained",
            Self::OutOfMemory => "out_of_memory",
            Self::Fault => "fault",
        }
    }

    /// Returns the exit status of a view that ends for this reason.
    pub(super) fn exit_status(self) -> u32 {
        u32::from(matches!(self, Self::OutOfMemory | Self::Fault))
    }

    /// Returns the sentence that is printed on leaving; empty if the user chose to leave.
    pub(super) fn farewell(self) -> &'static str {
        match self {
            Self::Quit => "",
            Self::Idle => "no key for a while; come back at any time\r\n",
            Self::TimeOver => "your time was over; come back at any time\r\n",
            Self::Drained => "the server restarts; come back soon\r\n",
            Self::OutOfMemory => "there is not enough memory for a window of this size\r\n",
            Self::Fault => "a fault of the server ended this view\r\n",
        }
    }
}
