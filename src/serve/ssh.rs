//! The handler of a client's SSH requests: grants one terminal with the view of a scene, nothing
//! else.
//!
//! Everything that is not named here is refused by default in `russh`: forwarding of ports, sockets and agents, X11,
//! subsystems, and passwords. The channel's own queue of messages is dropped, because a channel that is not read blocks
//! its whole connection after some messages; input comes by [`Handler::data`], output goes by [`Handle::data`], which
//! waits while the client takes nothing.
//!
//! Clients ask first whether they get in without a key (the method `none`), and one that does shows no key. So a client
//! with the user name [`LEADER`] is told that a key is wanted, and one without a leader's key that it gets in by
//! `keyboard-interactive`, without any question. All others are not told of keys: their own public keys would tell who
//! they are.

use super::client_command::{self, ClientCommand};
use super::client_terminal::{self, ClientTerminal};
use super::limits::Admission;
use super::lock::locked;
use super::metrics::Counter;
use super::roster::shown_name;
use super::session_buffers::SessionBuffers;
use super::shared_state::SharedState;
use super::socket::SocketCloser;
use super::visit::{User, Visit};
use russh::keys::PublicKey;
use russh::server::{Auth, ChannelOpenHandle, Handler, Msg, PublicKeyOffer, Response, Session, VerifiedPublicKey};
use russh::{Channel, ChannelId, Error, MethodKind, MethodSet, Pty};
use std::sync::Arc;

/// The user name with which a client is asked for the key of a leader.
const LEADER: &str = "leader";

/// The state of one client's connection.
pub(super) struct Client {
    pub(super) state: Arc<SharedState>,
    pub(super) buffers: Arc<SessionBuffers>,
    pub(super) closer: SocketCloser,
    /// The connection's entry in the `ConnectionLimiter`; taken when the connection ends.
    pub(super) entry: Option<Admission>,
    /// The network that the client's address is in, for the log.
    pub(super) from: String,
    pub(super) user: User,
    pub(super) terminal: ClientTerminal,
    /// The one channel of the connection.
    pub(super) channel: Option<ChannelId>,
    /// Whether the client has already requested a visit (`shell` or `exec`).
    pub(super) asked: bool,
}

impl Drop for Client {
    fn drop(&mut self) {
        if let Some(entry) = self.entry.take() {
            locked(&self.state.limiter).leave(entry);
        }
        self.buffers.hang_up();
        self.wake();
    }
}

impl Client {
    /// Wakes the session, or the connection's task if it still waits for a session.
    fn wake(&self) {
        match self.buffers.session() {
            Some(id) => self.state.pool.wake(id),
            None => self.buffers.wake_task(),
        }
    }

    fn log_in(&mut self, user: &str, may_lead: bool) -> Auth {
        let name = self.state.setup().settings.show_names.then(|| shown_name(user)).flatten();
        self.user = User { name, may_lead };
        if let Some(entry) = &mut self.entry {
            locked(&self.state.limiter).log_in(entry);
        }
        self.state.pool.metrics.logins.add(1);
        self.buffers.logged_in.notify_one();
        Auth::Accept
    }

    /// Returns whether the holder of a key may lead; `None` if the key does not let its holder in.
    fn key_holder(&self, user: &str, key: &PublicKey) -> Option<bool> {
        let setup = self.state.setup();
        let settings = &setup.settings;
        let has = |keys: &Option<Vec<PublicKey>>| {
            keys.as_ref().map(|keys| keys.iter().any(|known| known.key_data() == key.key_data()))
        };
        let may_lead = has(&settings.leaders) == Some(true);
        // Another key does not let a user in who wants to lead: the next key of the client may be the right one.
        let wants_lead = settings.leaders.is_some() && user == LEADER;
        let is_wanted = !wants_lead && has(&settings.authorized_keys).unwrap_or(true);
        (may_lead || is_wanted).then_some(may_lead)
    }

    /// Starts the visit that the client's first request asks for, and refuses later requests.
    fn start_visit(&mut self, channel: ChannelId, command: &[u8], session: &mut Session) -> Result<(), Error> {
        // SSH allows one `shell`, `exec` or subsystem for a channel.
        if std::mem::replace(&mut self.asked, true) {
            return session.channel_failure(channel);
        }
        session.channel_success(channel)?;
        self.buffers.asked.notify_one();
        let setup = self.state.setup();
        let command = client_command::parse_command(command, setup.scenes.iter().map(|scene| scene.name.as_str()));
        let visit = Visit {
            state: Arc::clone(&self.state),
            setup,
            buffers: Arc::clone(&self.buffers),
            closer: self.closer.clone(),
            from: std::mem::take(&mut self.from),
            user: self.user.clone(),
            sent: Counter::default(),
            handle: session.handle(),
            channel,
        };
        let terminal = std::mem::take(&mut self.terminal);
        tokio::spawn(async move {
            match (command, terminal.window) {
                (Ok(ClientCommand::Scene(scene)), Some(window)) => visit.show(scene, &terminal, window).await,
                (Ok(ClientCommand::Scene(scene)), None) => visit.print(visit.setup.text_frame(scene)).await,
                (Ok(ClientCommand::List), _) => visit.print(&visit.setup.scene_list()).await,
                (Err(message), _) => visit.refuse(&message).await,
            }
        });
        Ok(())
    }
}

impl Handler for Client {
    type Error = Error;

    async fn auth_none(&mut self, user: &str) -> Result<Auth, Error> {
        let setup = self.state.setup();
        Ok(if setup.settings.authorized_keys.is_some() {
            Auth::reject()
        } else if setup.settings.leaders.is_some() && user == LEADER {
            let methods = MethodSet::from(&[MethodKind::PublicKey, MethodKind::KeyboardInteractive][..]);
            Auth::Reject { proceed_with_methods: Some(methods), partial_success: false }
        } else {
            self.log_in(user, false)
        })
    }

    /// Refuses keys of no use before the client signs, for which it may ask its user for a
    /// passphrase.
    async fn auth_publickey_offered(&mut self, user: &str, offer: PublicKeyOffer<'_>) -> Result<Auth, Error> {
        Ok(if self.key_holder(user, offer.public_key).is_some() { Auth::Accept } else { Auth::reject() })
    }

    async fn auth_publickey(&mut self, user: &str, key: VerifiedPublicKey<'_>) -> Result<Auth, Error> {
        let holder = self.key_holder(user, key.public_key);
        Ok(holder.map_or_else(Auth::reject, |may_lead| self.log_in(user, may_lead)))
    }

    /// Accepts any user without a question, unless a key is needed.
    async fn auth_keyboard_interactive<'a>(
        &'a mut self,
        user: &str,
        _submethods: &str,
        _response: Option<Response<'a>>,
    ) -> Result<Auth, Error> {
        let needs_key = self.state.setup().settings.authorized_keys.is_some();
        Ok(if needs_key { Auth::reject() } else { self.log_in(user, false) })
    }

    async fn authentication_banner(&mut self) -> Result<Option<String>, Error> {
        Ok(self.state.setup().settings.banner.clone())
    }

    async fn channel_open_session(
        &mut self,
        channel: Channel<Msg>,
        reply: ChannelOpenHandle,
        _session: &mut Session,
    ) -> Result<(), Error> {
        // A second channel is refused by dropping `reply`.
        if self.channel.is_none() {
            self.channel = Some(channel.id());
            reply.accept().await;
        }
        Ok(())
    }

    async fn channel_close(&mut self, _channel: ChannelId, _session: &mut Session) -> Result<(), Error> {
        self.buffers.hang_up();
        self.wake();
        Ok(())
    }

    async fn data(&mut self, _channel: ChannelId, data: &[u8], _session: &mut Session) -> Result<(), Error> {
        // The session is woken after each part and not only at the end, because `push` waits for the session once two
        // parts of `MAX_INPUT` are queued.
        for part in data.chunks(1024) {
            self.buffers.push(part, self.state.pool.now()).await;
            self.wake();
        }
        Ok(())
    }

    async fn pty_request(
        &mut self,
        channel: ChannelId,
        term: &str,
        columns: u32,
        rows: u32,
        width: u32,
        height: u32,
        _modes: &[(Pty, u32)],
        session: &mut Session,
    ) -> Result<(), Error> {
        self.terminal.set_variable("TERM", term);
        self.terminal.window = Some(client_terminal::window([columns, rows, width, height]));
        session.channel_success(channel)
    }

    async fn window_change_request(
        &mut self,
        _channel: ChannelId,
        columns: u32,
        rows: u32,
        width: u32,
        height: u32,
        _session: &mut Session,
    ) -> Result<(), Error> {
        self.buffers.resize(client_terminal::window([columns, rows, width, height]));
        self.wake();
        Ok(())
    }

    async fn env_request(
        &mut self,
        channel: ChannelId,
        name: &str,
        value: &str,
        session: &mut Session,
    ) -> Result<(), Error> {
        self.terminal.set_variable(name, value);
        session.channel_success(channel)
    }

    async fn shell_request(&mut self, channel: ChannelId, session: &mut Session) -> Result<(), Error> {
        self.start_visit(channel, b"", session)
    }

    async fn exec_request(&mut self, channel: ChannelId, command: &[u8], session: &mut Session) -> Result<(), Error> {
        self.start_visit(channel, command, session)
    }

    async fn subsystem_request(&mut self, channel: ChannelId, _name: &str, session: &mut Session) -> Result<(), Error> {
        session.channel_failure(channel)
    }

    async fn x11_request(
        &mut self,
        channel: ChannelId,
        _single_connection: bool,
        _protocol: &str,
        _cookie: &str,
        _screen: u32,
        session: &mut Session,
    ) -> Result<(), Error> {
        session.channel_failure(channel)
    }
}
