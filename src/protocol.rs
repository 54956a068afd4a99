//! The protocol with a terminal: modes that are on, queries, and outstanding replies.
//!
//! All functions are pure: they take bytes and times, and return bytes.
//!
//! ```
//! use std::time::Duration;
//! use termtrace::internals::input::Reply;
//! use termtrace::internals::protocol::{FENCE, TerminalMode, TerminalModes, Outstanding};
//!
//! let (mut modes, mut bytes) = (TerminalModes::default(), Vec::new());
//! modes.switch_on(TerminalMode::AlternateScreen, &mut bytes);
//! modes.switch_on(TerminalMode::HiddenCursor, &mut bytes);
//! assert_eq!(bytes, b"\x1b[?1049h\x1b[?25l");
//! bytes.clear();
//! modes.switch_all_off(&mut bytes);
//! assert_eq!(bytes, b"\x1b[?25h\x1b[?1049l");
//!
//! let mut outstanding = Outstanding::default();
//! outstanding.sent(FENCE, Duration::ZERO);
//! assert!(outstanding.time_left(Duration::from_millis(20)).is_some());
//! outstanding.take(&Reply::DeviceAttributes(vec![62]));
//! assert_eq!(outstanding.time_left(Duration::from_millis(30)), None);
//! ```

mod modes;
mod outstanding;
mod query;
mod initial_queries;
mod receiver;

pub use initial_queries::InitialQueries;
pub use modes::{TerminalMode, TerminalModes};
pub use outstanding::Outstanding;
pub use query::{FENCE, Tag};
pub use receiver::Receiver;
