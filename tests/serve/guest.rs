//! A client in this process: it reads, answers queries as a terminal does, and keeps all bytes.

use crate::Place;
use crate::pty::{Modes, Screen};
use russh::client::{self, AuthResult, Handle, Msg};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelMsg};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::AsyncWriteExt;
use tokio::task::JoinHandle;
use tokio::time::{Instant, timeout_at};

/// A client that trusts every server, and keeps its banner.
#[derive(Clone, Default)]
pub(crate) struct Anybody {
    pub(crate) banner: Arc<Mutex<String>>,
}

impl client::Handler for Anybody {
    type Error = russh::Error;

    async fn check_server_key(&mut self, _key: &PublicKeyOrCertificate) -> Result<bool, russh::Error> {
        Ok(true)
    }

    async fn auth_banner(&mut self, banner: &str, _session: &mut client::Session) -> Result<(), russh::Error> {
        self.banner.lock().expect("no holder of this lock panics").push_str(banner);
        Ok(())
    }
}

/// Connects without logging in.
pub(crate) async fn connect(place: &impl Place) -> Handle<Anybody> {
    connect_as(place, Anybody::default()).await
}

pub(crate) async fn connect_as(place: &impl Place, client: Anybody) -> Handle<Anybody> {
    let config = Arc::new(client::Config { nodelay: true, ..client::Config::default() });
    client::connect(config, place.address(), client).await.expect("the server accepts a connection")
}

/// Connects and logs in.
pub(crate) async fn log_in(place: &impl Place) -> Handle<Anybody> {
    let mut session = connect(place).await;
    let auth = session.authenticate_none("anybody").await.expect("an answer");
    assert!(matches!(auth, AuthResult::Success), "everybody is let in");
    session
}

/// A visitor with a terminal.
pub(crate) struct Guest {
    pub(crate) session: Handle<Anybody>,
    pub(crate) channel: Channel<Msg>,
    /// All bytes that have come.
    pub(crate) bytes: Vec<u8>,
    /// The bytes of error messages.
    pub(crate) errors: Vec<u8>,
    /// The exit status.
    pub(crate) status: Option<u32>,
    /// Whether it answers queries.
    pub(crate) answers: bool,
    /// The time after which it answers.
    pub(crate) delay: Duration,
    /// The times at which answers are due.
    owed: VecDeque<Instant>,
    answered: usize,
    screen: Screen,
}

impl Guest {
    /// Opens the view of the first scene in a terminal of 80x24 cells.
    pub(crate) async fn enter(place: &impl Place) -> Self {
        Self::enter_with(place, (80, 24), None).await
    }

    /// Opens a view in a terminal of this size, by a command if there is one.
    pub(crate) async fn enter_with(place: &impl Place, (columns, rows): (u16, u16), command: Option<&str>) -> Self {
        let mut guest = Self::without_terminal(place, (columns, rows)).await;
        let (columns, rows) = (columns.into(), rows.into());
        guest.channel.request_pty(true, "xterm-256color", columns, rows, 0, 0, &[]).await.expect("a terminal");
        guest.ask(command).await;
        guest
    }

    /// Opens the view by a client that grants room for few bytes.
    pub(crate) async fn enter_with_little_room(place: &impl Place) -> Self {
        let config = client::Config { window_size: 32 * 1024, channel_buffer_size: 1, ..client::Config::default() };
        let mut session =
            client::connect(Arc::new(config), place.address(), Anybody::default()).await.expect("a connection");
        assert!(session.authenticate_none("anybody").await.expect("an answer").success());
        let mut guest = Self::on(session, (80, 24)).await;
        guest.channel.request_pty(true, "xterm-256color", 80, 24, 0, 0, &[]).await.expect("a terminal");
        guest.ask(None).await;
        guest
    }

    /// Opens a channel without a terminal.
    pub(crate) async fn without_terminal(place: &impl Place, size: (u16, u16)) -> Self {
        Self::on(log_in(place).await, size).await
    }

    /// Opens a channel of a session.
    pub(crate) async fn on(session: Handle<Anybody>, (columns, rows): (u16, u16)) -> Self {
        let channel = session.channel_open_session().await.expect("a channel");
        let (bytes, errors, screen) = (Vec::new(), Vec::new(), Screen::new(columns, rows));
        let (delay, owed) = (Duration::ZERO, VecDeque::new());
        Self { session, channel, bytes, errors, status: None, answers: true, delay, owed, answered: 0, screen }
    }

    /// Asks for a shell, or for a command.
    pub(crate) async fn ask(&mut self, command: Option<&str>) {
        match command {
            Some(command) => self.channel.exec(true, command).await,
            None => self.channel.request_shell(true).await,
        }
        .expect("the request is sent");
    }

    pub(crate) async fn send(&self, bytes: &[u8]) {
        self.channel.data(bytes).await.expect("the connection is open");
    }

    /// Starts sending input, while the caller reads.
    ///
    /// A client whose channel is not read sends nothing either.
    pub(crate) fn start_sending(&self, bytes: Vec<u8>) -> JoinHandle<std::io::Result<()>> {
        let mut writer = self.channel.make_writer();
        tokio::spawn(async move { writer.write_all(&bytes).await })
    }

    /// Reads the next message, and answers meanwhile. Returns `false` once the channel is closed.
    async fn read(&mut self) -> bool {
        let message = loop {
            let Some(&due) = self.owed.front() else { break self.channel.wait().await };
            if let Ok(message) = timeout_at(due, self.channel.wait()).await {
                break message;
            }
            self.answer().await;
        };
        match message {
            Some(ChannelMsg::Data { data }) => {
                self.bytes.extend_from_slice(&data);
                self.screen.feed(&data);
                self.hear_queries();
                while self.delay.is_zero() && !self.owed.is_empty() {
                    self.answer().await;
                }
            }
            Some(ChannelMsg::ExtendedData { data, .. }) => self.errors.extend_from_slice(&data),
            Some(ChannelMsg::ExitStatus { exit_status }) => self.status = Some(exit_status),
            Some(ChannelMsg::Close) | None => return false,
            Some(_) => {}
        }
        true
    }

    async fn answer(&mut self) {
        self.owed.pop_front();
        // The server may have ended meanwhile.
        let _ = self.channel.data(&b"\x1b[?62;22c"[..]).await;
    }

    fn hear_queries(&mut self) {
        const DA1: &[u8] = b"\x1b[c";
        let unread = &self.bytes[self.answered..];
        let queries = unread.windows(DA1.len()).filter(|window| *window == DA1).count();
        self.answered = self.bytes.len() - unread.len().min(DA1.len() - 1);
        if unread.ends_with(DA1) {
            self.answered = self.bytes.len();
        }
        if self.answers {
            self.owed.extend(std::iter::repeat_n(Instant::now() + self.delay, queries));
        }
    }

    /// Returns the number of queries whose answer has not been sent.
    pub(crate) fn unanswered(&self) -> usize {
        self.owed.len()
    }

    /// Reads for this time.
    pub(crate) async fn read_for(&mut self, time: Duration) {
        let end = Instant::now() + time;
        while let Ok(is_open) = timeout_at(end, self.read()).await {
            assert!(is_open, "the server closed the channel");
        }
    }

    /// Reads until nothing has come for a while.
    pub(crate) async fn rest(&mut self) {
        for _ in 0..100 {
            let before = self.bytes.len();
            self.read_for(Duration::from_millis(300)).await;
            if self.bytes.len() == before {
                return;
            }
        }
        panic!("it does not rest: {:#?}", self.text());
    }

    /// Returns what the cells of the screen look like: two colours, or a character.
    pub(crate) fn cells(&self) -> String {
        let (rows, columns) = self.screen.second_opinion().size();
        let (rows, columns) = (rows.get(), columns.get());
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let looks = cells.map(|(column, row)| {
            let cell = self.screen.cell(column.into(), row.into());
            let (fg, bg) = (cell.foreground, cell.background);
            match cell.glyph {
                ' ' => format!("{bg:?} {bg:?}\n"),
                '▄' => format!("{bg:?} {fg:?}\n"),
                '▀' => format!("{fg:?} {bg:?}\n"),
                '█' => format!("{fg:?} {fg:?}\n"),
                glyph => format!("{glyph} {fg:?} {bg:?}\n"),
            }
        });
        looks.collect()
    }

    /// Reads until the bytes and the screen are as wanted.
    pub(crate) async fn see(&mut self, what: &str, wanted: impl Fn(&Self) -> bool) {
        let end = Instant::now() + crate::PATIENCE;
        while !wanted(self) {
            let is_open = timeout_at(end, self.read()).await;
            let is_open = is_open.unwrap_or_else(|_| panic!("{what} is not on the screen: {:#?}", self.text()));
            assert!(is_open || wanted(self), "the server closed the channel before {what}: {:?}", self.text());
        }
    }

    /// Reads until this text is on the screen.
    pub(crate) async fn see_text(&mut self, text: &str) {
        self.see(text, |guest| guest.text().iter().any(|row| row.contains(text))).await;
    }

    /// Reads until a picture in colour is on the screen.
    pub(crate) async fn see_picture(&mut self) {
        let is_coloured = |guest: &Self| guest.has("38;") && guest.text().iter().any(|row| row.contains(['▀', '▄']));
        self.see("a picture", is_coloured).await;
    }

    pub(crate) fn has(&self, text: &str) -> bool {
        self.bytes.windows(text.len()).any(|window| window == text.as_bytes())
    }

    pub(crate) fn text(&self) -> Vec<String> {
        self.screen.text()
    }

    pub(crate) fn resize_screen(&mut self, columns: u16, rows: u16) {
        self.screen.resize(columns, rows);
    }

    /// Reads until the channel is closed. Returns the exit status.
    pub(crate) async fn leave(&mut self) -> Option<u32> {
        while self.read().await {}
        self.status
    }

    /// Asserts that the terminal is as it was.
    pub(crate) fn assert_clean(&self) {
        let left = Modes::after(&self.bytes).left_on();
        assert!(left.is_empty(), "left on: {left:?}");
        assert!(!self.screen.is_alternate());
    }
}
