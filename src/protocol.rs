//! What a terminal is told and asked, without a terminal: the modes that are switched on, the queries, what it sends, and
//! the replies that are outstanding. Pure: bytes and replies in, bytes out, and the time is told.
//!
//! ```
//! use std::time::Duration;
//! use termtrace::internals::input::Reply;
//! use termtrace::internals::protocol::{FENCE, Mode, Modes, Outstanding};
//!
//! let (mut modes, mut bytes) = (Modes::default(), Vec::new());
//! modes.switch_on(Mode::AlternateScreen, &mut bytes);
//! modes.switch_on(Mode::HiddenCursor, &mut bytes);
//! assert_eq!(bytes, b"\x1b[?1049h\x1b[?25l");
//! bytes.clear();
//! modes.switch_all_off(&mut bytes);
//! assert_eq!(bytes, b"\x1b[?25h\x1b[?1049l");
//!
//! let mut outstanding = Outstanding::default();
//! outstanding.sent(FENCE, Duration::ZERO);
//! assert!(outstanding.patience(Duration::from_millis(20)).is_some());
//! outstanding.take(&Reply::DeviceAttributes(vec![62]));
//! assert_eq!(outstanding.patience(Duration::from_millis(30)), None);
//! ```

mod modes;
mod outstanding;
mod query;
mod questions;
mod receiver;

pub use modes::{Mode, Modes};
pub use outstanding::Outstanding;
pub use query::{FENCE, Tag};
pub use questions::Questions;
pub use receiver::Receiver;
