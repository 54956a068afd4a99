use super::*;
use crate::app::Tracer;
use crate::capabilities::Hints;
use crate::control::{Command, Key, KeyMode};
use crate::progress::Cancellation;
use crate::scene::Scene;
use crate::serve::roster::Roster;
use std::cell::Cell;

const SECOND: Duration = Duration::from_secs(1);
const LIMITS: VisitLimits = VisitLimits { idle: Duration::from_secs(100), ends: Duration::from_secs(1000) };

/// A session in a terminal of 20x6 cells that answers queries, with a clock that the test sets.
struct Harness {
    roster: Roster,
    session: ViewerSession,
    tracer: Tracer,
    now: Cell<Duration>,
    traced: u32,
    bytes: Vec<u8>,
}

fn scenes() -> Arc<[HostedScene]> {
    // The sphere is beside the target, so that the picture changes when the view turns about the target.
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, \
                objects: [Sphere(center: (1, 0, 0), radius: 1)])";
    let scene = |name: &str| HostedScene {
        name: name.to_owned(),
        file: format!("{name}.ron"),
        title: String::new(),
        scene: Scene::from_ron(name, text).expect("a scene"),
        orbits: false,
    };
    [scene("one"), scene("two")].into()
}

impl Harness {
    fn new(limits: VisitLimits) -> Self {
        let window = crate::serve::client_terminal::window([20, 6, 0, 0]);
        let variable = |name: &str| (name == "TERM").then(|| "xterm-256color".to_owned());
        let mut viewer = Options::new(Hints::gather(&variable, &|_| None));
        viewer.keymap.bind(KeyMode::Always, Key::letter('T'), Some(Command::Tour));
        let options = SessionOptions { viewer, link: None, follows_tour: false, may_lead: false };
        let mut bytes = Vec::new();
        let session =
            ViewerSession::new(scenes(), 0, options, window, limits, SECOND, &mut bytes).expect("there is memory");
        Self { roster: Roster::default(), session, tracer: Tracer::new(1), now: Cell::new(SECOND), traced: 0, bytes }
    }

    fn turn_for(&mut self, kind: WorkKind, input: &PendingInput) -> AfterTurn {
        let Self { roster, session, tracer, now, traced, bytes } = self;
        let company = Company { roster, id: 0 };
        let mut trace = |job: &Job, may_interrupt: bool| {
            assert!(job.refines || !may_interrupt, "the frame of a new view is lost if it is interrupted");
            *traced += 1;
            // On a busy machine the time that tracing takes would change the samples, and with them the bytes.
            let frame = tracer.trace_for(0, job, &Cancellation::default()).ok()?;
            Some(Frame { trace: Duration::ZERO, interval: Duration::ZERO, ..frame })
        };
        session.take_turn((input, &company), (false, kind), &|| now.get(), &mut trace, bytes)
    }

    fn turn(&mut self, input: &[u8]) -> AfterTurn {
        self.turn_for(WorkKind::Refinement, &PendingInput { bytes: input.to_vec(), ..PendingInput::default() })
    }

    /// Gives the session turns and replies to all queries until it sleeps, and returns its wake-up
    /// time.
    fn rest(&mut self) -> Option<Duration> {
        loop {
            let answers = b"\x1b[?62c".repeat(self.bytes.windows(3).filter(|bytes| *bytes == b"\x1b[c").count());
            self.bytes.clear();
            match self.turn(&answers) {
                AfterTurn::Sleep(until) if self.bytes.is_empty() => return until,
                AfterTurn::Sleep(_) | AfterTurn::Turn(_) => {}
                AfterTurn::End => panic!("no viewer has left"),
            }
        }
    }

    fn sent(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }
}

#[test]
fn it_rests_until_the_countdown() {
    let mut harness = Harness::new(LIMITS);
    harness.turn(&[]);
    assert!(harness.sent().contains("\x1b[?1049h") && harness.traced > 0);
    // The session starts at 1 s and, without a key press, ends 100 s later. The countdown begins 30 s before the end.
    assert_eq!(harness.rest(), Some(71 * SECOND));
    harness.now.set(71 * SECOND);
    harness.turn(&[]);
    assert!(harness.sent().contains("30 s") || !harness.bytes.is_empty());
    assert_eq!(harness.rest(), Some(72 * SECOND));
    // A terminal's reply does not count as a key, but `i` does.
    harness.turn(b"\x1b[?62c");
    assert_eq!(harness.rest(), Some(72 * SECOND));
    harness.turn(b"i");
    assert_eq!(harness.rest(), Some(141 * SECOND));
    harness.now.set(171 * SECOND);
    assert_eq!((harness.turn(&[]), harness.sent().contains("no key for a while; come back")), (AfterTurn::End, true));
}

#[test]
fn an_end_that_nears_wins() {
    let mut harness = Harness::new(VisitLimits { ends: 50 * SECOND, ..LIMITS });
    assert_eq!(harness.rest(), Some(20 * SECOND));
    let input = PendingInput { drain_deadline: Some(10 * SECOND), ..PendingInput::default() };
    harness.turn_for(WorkKind::Picture, &input);
    assert_eq!(harness.rest(), Some(2 * SECOND));
    harness.now.set(10 * SECOND);
    assert_eq!((harness.turn(&[]), harness.sent().contains("the server restarts")), (AfterTurn::End, true));
}

#[test]
fn leaving_waits_for_the_last_reply() {
    let mut harness = Harness::new(LIMITS);
    harness.turn(&[]);
    // No query has been answered yet.
    harness.bytes.clear();
    assert_eq!(harness.turn(b"q"), AfterTurn::Sleep(Some(2 * SECOND)));
    let sent = harness.sent();
    assert!(sent.contains("\x1b[?1049l") && sent.contains("\x1b[c"), "{sent:?}");
    assert!(sent.contains("this view at home: termtrace one.ron\r\n"), "{sent:?}");
    // Keys do not end the wait for the terminal's last replies.
    assert_eq!(harness.turn(b"qqq"), AfterTurn::Sleep(Some(2 * SECOND)));
    let replies = b"\x1b[?62c".repeat(20);
    assert_eq!(harness.turn(&replies), AfterTurn::End);

    let mut silent = Harness::new(LIMITS);
    silent.turn(&[]);
    assert_eq!(silent.turn(b"q"), AfterTurn::Sleep(Some(2 * SECOND)));
    silent.now.set(2 * SECOND);
    assert_eq!(silent.turn(&[]), AfterTurn::End);
}

#[test]
fn a_refinement_waits_for_its_kind() {
    let mut harness = Harness::new(LIMITS);
    harness.rest();
    let before = harness.traced;
    // The key `]` zooms by a step: the frame of the new view is traced, but its refinement has to wait.
    let key = PendingInput { bytes: b"]".to_vec(), ..PendingInput::default() };
    let mut next = harness.turn_for(WorkKind::Picture, &key);
    for _ in 0..20 {
        match next {
            AfterTurn::Turn(WorkKind::Refinement) => break,
            AfterTurn::Sleep(Some(until)) => harness.now.set(until),
            _ => {}
        }
        next = harness.turn_for(WorkKind::Picture, &PendingInput::default());
    }
    assert_eq!(next, AfterTurn::Turn(WorkKind::Refinement));
    assert!(harness.traced > before);
    let before = harness.traced;
    harness.turn_for(WorkKind::Refinement, &PendingInput::default());
    assert!(harness.traced > before);
}

#[test]
fn scenes_are_switched_in_a_ring() {
    let mut harness = Harness::new(LIMITS);
    harness.rest();
    for expected in [1, 0, 1] {
        harness.turn(b"n");
        assert_eq!((harness.session.shown, harness.session.viewer.shown_scene()), (expected, Some(expected)));
        harness.rest();
    }
    harness.turn(b"p");
    assert_eq!(harness.session.shown, 0);
}

#[test]
fn after_a_panic_all_modes_are_off() {
    let mut harness = Harness::new(LIMITS);
    harness.rest();
    let mut bytes = Vec::new();
    harness.session.abandon(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("\x1b[?25h") && text.contains("\x1b[?1049l"), "{text:?}");
    // A mode that was not switched on is not switched off: the keyboard's flags may have been set by the shell.
    assert!(!text.contains("\x1b[<1u"), "{text:?}");
}

/// With any input, in parts of any size, a session soon sleeps and at last restores the terminal.
#[test]
fn what_a_network_sends_breaks_nothing() {
    const WORDS: [&[u8]; 12] = [
        b"\x1b[?62;22c",
        b"\x1b[?2026;2$y",
        b"\x1b]4;3;rgb:12/34/56\x1b\\",
        b"\x1b[<35;7;3M",
        b"\x1b[<0;7;3M",
        b"\x1b[200~",
        b"\x1b[201~",
        b"\x1b",
        b"wasdt[]xVI?iBgn\x1a",
        b"\xe2\x96\x80\xff\x00",
        b"\x1b[1;1R",
        b"\x1b[?1u",
    ];
    let mut seed = 1_u64;
    let mut random = |limit: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % limit
    };
    for _ in 0..20 {
        let mut harness = Harness::new(LIMITS);
        for _ in 0..60 {
            let words: Vec<u8> = (0..random(8)).flat_map(|_| WORDS[random(WORDS.len())].to_vec()).collect();
            let part = words.get(..random(words.len() + 1)).unwrap_or_default().to_vec();
            let window = (random(10) == 0).then(|| {
                let (columns, rows) = (random(60) as u32, random(20) as u32);
                crate::serve::client_terminal::window([columns, rows, 0, 0])
            });
            let mut next = harness
                .turn_for(WorkKind::Refinement, &PendingInput { bytes: part, window, ..PendingInput::default() });
            harness.now.set(harness.now.get() + Duration::from_millis(random(40) as u64));
            for _ in 0..40 {
                if !matches!(next, AfterTurn::Turn(_)) {
                    break;
                }
                next = harness.turn(&[]);
            }
            assert!(
                matches!(next, AfterTurn::Sleep(_)),
                "no key that leaves was pressed, and the session soon sleeps: {next:?}"
            );
        }
        let mut all = std::mem::take(&mut harness.bytes);
        harness.session.leave(LeaveReason::Quit, harness.now.get(), &mut all);
        let text = String::from_utf8_lossy(&all);
        assert!(text.contains("\x1b[?1049l") && text.contains("\x1b[?25h"));
    }
}

/// A busy server is no slow link: the time that a reply waits for its turn does not count.
#[test]
fn a_reply_counts_from_its_arrival() {
    // Each turn comes 300 ms after the last one. Returns the number of bytes sent for a view that turns.
    let bytes_if_replies_arrive_after = |time: Duration| {
        let mut harness = Harness::new(LIMITS);
        let window = Some(crate::serve::client_terminal::window([80, 24, 0, 0]));
        harness.turn_for(WorkKind::Refinement, &PendingInput { window, ..PendingInput::default() });
        harness.rest();
        harness.turn(b"t");
        let mut sum = 0;
        for _ in 0..40 {
            let queries = harness.bytes.windows(3).filter(|bytes| *bytes == b"\x1b[c").count();
            sum += harness.bytes.len();
            harness.bytes.clear();
            let at = harness.now.get() + time;
            harness.now.set(harness.now.get() + Duration::from_millis(300));
            let bytes = b"\x1b[?62c".repeat(queries);
            harness.turn_for(WorkKind::Refinement, &PendingInput { bytes, at, ..PendingInput::default() });
        }
        sum
    };
    let [early, late] = [1, 300].map(|time| bytes_if_replies_arrive_after(Duration::from_millis(time)));
    assert!(early > 2 * late, "{early} bytes with early replies, {late} with late ones");
}

/// Returns a session in a tour that another viewer leads, in a terminal that reports releases.
fn in_a_tour() -> Harness {
    in_a_tour_with(b"")
}

/// Returns such a session in a terminal that sends these replies first.
fn in_a_tour_with(replies: &[u8]) -> Harness {
    let mut harness = Harness::new(LIMITS);
    Harness::new(LIMITS).session.enter(&Company { roster: &harness.roster, id: 1 }, None);
    harness.session.enter(&Company { roster: &harness.roster, id: 0 }, None);
    harness.roster.lead(1);
    harness.turn(&[replies, b"\x1b[?11u\x1b[?62c"].concat());
    harness.now.set(2 * SECOND);
    harness.turn(b"\x1b[116:84;2u");
    harness
}

#[test]
fn the_release_of_a_key_leaves_no_tour() {
    let mut harness = in_a_tour();
    assert!(matches!(harness.session.take_audience_change(), Some(AudienceChange::Follow(_))));
    harness.now.set(3 * SECOND);
    harness.turn(b"\x1b[116:84;2:3u");
    assert_eq!(harness.session.take_audience_change(), None);
    harness.now.set(4 * SECOND);
    harness.turn(b"\x1b[119u");
    assert_eq!(harness.session.take_audience_change(), Some(AudienceChange::Leave));
}

#[test]
fn terminals_with_and_without_finer_glyphs_at_rest_share_an_audience() {
    let joined = |name: &str| {
        let mut harness = in_a_tour_with(format!("\x1bP>|{name}\x1b\\").as_bytes());
        let Some(AudienceChange::Follow(class)) = harness.session.take_audience_change() else { panic!("{name}") };
        (harness.session.viewer.capabilities().resting_glyphs, class)
    };
    let [(glyphs, class), (other_glyphs, other_class)] = ["kitty(0.26.5)", "WezTerm 20240203"].map(joined);
    assert_ne!(glyphs, other_glyphs);
    assert_eq!(class.capabilities, other_class.capabilities);
}

/// A new audience costs a picture and a key frame.
#[test]
fn a_follower_who_resizes_on_and_on_joins_few_audiences() {
    let mut harness = in_a_tour();
    harness.session.take_audience_change();
    let (mut joined, mut last) = (0, None);
    for step in 1..=100_u64 {
        harness.now.set(2 * SECOND + Duration::from_millis(10 * step));
        let window = Some(crate::serve::client_terminal::window([20 + step as u32, 6, 0, 0]));
        harness.turn_for(WorkKind::Picture, &PendingInput { window, ..PendingInput::default() });
        if let Some(change) = harness.session.take_audience_change() {
            (joined, last) = (joined + 1, Some(change));
        }
    }
    assert_eq!(joined, 10);
    // The last size is that of the next audience, for which the session wakes.
    let window = Some(crate::serve::client_terminal::window([60, 20, 0, 0]));
    let next = harness.turn_for(WorkKind::Picture, &PendingInput { window, ..PendingInput::default() });
    assert_eq!(harness.session.take_audience_change(), None);
    let AfterTurn::Sleep(Some(at)) = next else { panic!("it sleeps: {next:?}") };
    assert!(at <= harness.now.get() + Duration::from_millis(100));
    harness.now.set(at);
    harness.turn(&[]);
    let change = harness.session.take_audience_change();
    assert!(matches!(change, Some(AudienceChange::Follow(class)) if class.size.columns == 60), "{change:?}");
    assert_ne!(change, last);
    // Leaving needs no wait.
    harness.turn(b"\x1b[119u");
    assert_eq!(harness.session.take_audience_change(), Some(AudienceChange::Leave));
}
