//! The phases of a child: it reports each before it goes on, and is told what shall fail there.

use std::{
    io::{BufRead, BufReader, Write},
    os::unix::net::{UnixListener, UnixStream},
    path::PathBuf,
    time::Duration,
};

use rustix::event::{PollFd, PollFlags, poll};
use tempfile::TempDir;

use super::{Deadline, SOON, Seen, Session, rest::bytes_read};

/// The action of a child at a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Goes on.
    GoOn,
    /// An error.
    Error,
    /// A panic in the thread that runs the loop.
    Panic,
    /// A panic in a thread that traces.
    WorkerPanic,
}

/// A child's phases, reported through a socket that its test-only hooks connect to.
pub(crate) struct Phases {
    listener: UnixListener,
    path: PathBuf,
    _folder: TempDir,
    child: Option<BufReader<UnixStream>>,
    /// The number of bytes that the child had read, if its last phase was a rest.
    rested: Option<u64>,
}

impl Phases {
    /// A socket for one child.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = folder.path().join("phases");
        let listener = UnixListener::bind(&path).expect("a socket can be had");
        Self { listener, path, _folder: folder, child: None, rested: None }
    }

    /// Returns the path of the socket that the child connects to.
    pub(crate) fn path(&self) -> &PathBuf {
        &self.path
    }

    /// Waits until the child reaches this phase, where it stays. It passes through all others.
    #[track_caller]
    pub(crate) fn wait_for(&mut self, phase: &str) {
        loop {
            let reached = self.next();
            if reached == phase {
                return;
            }
            self.send(Answer::GoOn);
        }
    }

    /// Waits for a phase while the terminal is read and answers.
    #[track_caller]
    pub(crate) fn wait_for_on(&mut self, phase: &str, session: &mut Session) {
        let mut deadline = Deadline::after(SOON);
        loop {
            while !self.is_told() {
                session.seen();
                assert!(!deadline.has_passed(), "the child does not reach {phase:?}");
            }
            if self.next() == phase {
                return;
            }
            self.send(Answer::GoOn);
        }
    }

    /// Lets the child go on until its terminal fulfils a condition or the limit has passed.
    ///
    /// Returns how often the child reached `phase`.
    pub(crate) fn count_on(
        &mut self,
        phase: &str,
        session: &mut Session,
        limit: Duration,
        mut done: impl FnMut(&Seen) -> bool,
    ) -> usize {
        let mut deadline = Deadline::after(limit);
        let mut count = 0;
        while !done(session.seen()) && !deadline.has_passed() {
            if self.is_told() {
                count += usize::from(self.next() == phase);
                self.send(Answer::GoOn);
            }
        }
        count
    }

    /// Lets the child go on until it rests with all input read, after which nothing happens by
    /// itself.
    ///
    /// Returns how often the child reached `phase`.
    #[track_caller]
    pub(crate) fn count_until_rest(&mut self, phase: &str, session: &mut Session) -> usize {
        let mut deadline = Deadline::after(SOON);
        let mut count = 0;
        loop {
            session.seen();
            if self.is_told() {
                count += usize::from(self.next() == phase);
                self.send(Answer::GoOn);
            }
            if self.rested.is_some_and(|read| session.has_nothing_under_way(read)) {
                return count;
            }
            assert!(!deadline.has_passed(), "the child does not come to rest");
        }
    }

    /// Returns whether the child reports a phase now or within a moment.
    fn is_told(&self) -> bool {
        let moment = super::POLL_INTERVAL.try_into().expect("it is short");
        let told = match &self.child {
            Some(child) => poll(&mut [PollFd::new(child.get_ref(), PollFlags::IN)], Some(&moment)),
            None => poll(&mut [PollFd::new(&self.listener, PollFlags::IN)], Some(&moment)),
        };
        matches!(told, Ok(1..))
    }

    /// Lets the child go on with that action, and reads no later phase.
    pub(crate) fn answer(mut self, answer: Answer) {
        self.send(answer);
    }

    /// Lets the child go on to its next phase.
    pub(crate) fn send(&mut self, answer: Answer) {
        let byte = match answer {
            Answer::GoOn => b'g',
            Answer::Error => b'e',
            Answer::Panic => b'p',
            Answer::WorkerPanic => b'w',
        };
        let child = self.child.as_mut().expect("the child has said where it is");
        child.get_mut().write_all(&[byte]).expect("the child listens");
    }

    #[track_caller]
    fn next(&mut self) -> String {
        let mut deadline = Deadline::after(SOON);
        while !self.is_told() {
            assert!(!deadline.has_passed(), "the child reaches no phase");
        }
        let child = match &mut self.child {
            Some(child) => child,
            none => none.insert(accept(&self.listener)),
        };
        let mut line = String::new();
        child.read_line(&mut line).expect("the child reaches its phases soon");
        assert!(line.ends_with('\n'), "the child reaches no more phases");
        self.rested = bytes_read(line.trim_end());
        line.trim_end().to_owned()
    }
}

fn accept(listener: &UnixListener) -> BufReader<UnixStream> {
    let (child, _) = listener.accept().expect("the child connects");
    child.set_read_timeout(Some(SOON)).expect("a socket has timeouts");
    BufReader::new(child)
}
