use super::*;
use crate::app::Tracer;
use crate::capabilities::Hints;
use crate::progress::Cancellation;
use crate::scene::Scene;
use std::cell::Cell;

const SECOND: Duration = Duration::from_secs(1);
const STAY: Stay = Stay { idle: Duration::from_secs(100), ends: Duration::from_secs(1000) };

/// A seat in a terminal of 20x6 cells that answers queries, with a clock that only the test sets.
struct Sitting {
    seat: Seat,
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

impl Sitting {
    fn new(stay: Stay) -> Self {
        let window = crate::serve::client_terminal::window([20, 6, 0, 0]);
        let variable = |name: &str| (name == "TERM").then(|| "xterm-256color".to_owned());
        let options = (Options::new(Hints::gather(&variable, &|_| None)), None);
        let mut bytes = Vec::new();
        let seat = Seat::new(scenes(), 0, options, window, stay, SECOND, &mut bytes).expect("there is memory");
        Self { seat, tracer: Tracer::default(), now: Cell::new(SECOND), traced: 0, bytes }
    }

    fn turn_for(&mut self, class: Class, arrived: Arrived) -> Next {
        let Self { seat, tracer, now, traced, bytes } = self;
        let mut trace = |job: &Job, may_interrupt: bool| {
            assert!(job.refines || !may_interrupt, "the frame of a new view is lost if it is interrupted");
            *traced += 1;
            tracer.trace_for_any(job, &Cancellation::default()).ok()
        };
        seat.take_turn(&arrived, (false, class), &|| now.get(), &mut trace, bytes)
    }

    fn turn(&mut self, input: &[u8]) -> Next {
        self.turn_for(Class::Refinement, Arrived { bytes: input.to_vec(), ..Arrived::default() })
    }

    /// Gives the seat turns and replies to all queries until it sleeps, and returns its wake-up
    /// time.
    fn rest(&mut self) -> Option<Duration> {
        loop {
            let answers = b"\x1b[?62c".repeat(self.bytes.windows(3).filter(|bytes| *bytes == b"\x1b[c").count());
            self.bytes.clear();
            match self.turn(&answers) {
                Next::Sleep(until) if self.bytes.is_empty() => return until,
                Next::Sleep(_) | Next::Turn(_) => {}
                Next::End => panic!("no viewer has left"),
            }
        }
    }

    fn sent(&self) -> String {
        String::from_utf8_lossy(&self.bytes).into_owned()
    }
}

#[test]
fn it_rests_until_the_countdown() {
    let mut sitting = Sitting::new(STAY);
    sitting.turn(&[]);
    assert!(sitting.sent().contains("\x1b[?1049h") && sitting.traced > 0);
    // The seat starts at 1 s and, without a key press, ends 100 s later. The countdown begins 30 s before the end.
    assert_eq!(sitting.rest(), Some(71 * SECOND));
    sitting.now.set(71 * SECOND);
    sitting.turn(&[]);
    assert!(sitting.sent().contains("30 s") || !sitting.bytes.is_empty());
    assert_eq!(sitting.rest(), Some(72 * SECOND));
    // A terminal's reply does not count as a key, but `i` does.
    sitting.turn(b"\x1b[?62c");
    assert_eq!(sitting.rest(), Some(72 * SECOND));
    sitting.turn(b"i");
    assert_eq!(sitting.rest(), Some(141 * SECOND));
    sitting.now.set(171 * SECOND);
    assert_eq!((sitting.turn(&[]), sitting.sent().contains("no key for a while; come back")), (Next::End, true));
}

#[test]
fn an_end_that_nears_wins() {
    let mut sitting = Sitting::new(Stay { ends: 50 * SECOND, ..STAY });
    assert_eq!(sitting.rest(), Some(20 * SECOND));
    let arrived = Arrived { drained_at: Some(10 * SECOND), ..Arrived::default() };
    sitting.turn_for(Class::Picture, arrived);
    assert_eq!(sitting.rest(), Some(2 * SECOND));
    sitting.now.set(10 * SECOND);
    assert_eq!((sitting.turn(&[]), sitting.sent().contains("the server restarts")), (Next::End, true));
}

#[test]
fn leaving_waits_for_the_last_reply() {
    let mut sitting = Sitting::new(STAY);
    sitting.turn(&[]);
    // No query has been answered yet.
    sitting.bytes.clear();
    assert_eq!(sitting.turn(b"q"), Next::Sleep(Some(2 * SECOND)));
    let sent = sitting.sent();
    assert!(sent.contains("\x1b[?1049l") && sent.contains("\x1b[c"), "{sent:?}");
    assert!(sent.contains("this view at home: termtrace one.ron\r\n"), "{sent:?}");
    // Keys do not end the wait for the terminal's last replies.
    assert_eq!(sitting.turn(b"qqq"), Next::Sleep(Some(2 * SECOND)));
    let replies = b"\x1b[?62c".repeat(20);
    assert_eq!(sitting.turn(&replies), Next::End);

    let mut silent = Sitting::new(STAY);
    silent.turn(&[]);
    assert_eq!(silent.turn(b"q"), Next::Sleep(Some(2 * SECOND)));
    silent.now.set(2 * SECOND);
    assert_eq!(silent.turn(&[]), Next::End);
}

#[test]
fn a_refinement_waits_for_its_class() {
    let mut sitting = Sitting::new(STAY);
    sitting.rest();
    let before = sitting.traced;
    // The key `]` zooms by a step: the frame of the new view is traced, but its refinement has to wait.
    let key = Arrived { bytes: b"]".to_vec(), ..Arrived::default() };
    let mut next = sitting.turn_for(Class::Picture, key);
    for _ in 0..20 {
        match next {
            Next::Turn(Class::Refinement) => break,
            Next::Sleep(Some(until)) => sitting.now.set(until),
            _ => {}
        }
        next = sitting.turn_for(Class::Picture, Arrived::default());
    }
    assert_eq!(next, Next::Turn(Class::Refinement));
    assert!(sitting.traced > before);
    let before = sitting.traced;
    sitting.turn_for(Class::Refinement, Arrived::default());
    assert!(sitting.traced > before);
}

#[test]
fn scenes_are_switched_in_a_ring() {
    let mut sitting = Sitting::new(STAY);
    sitting.rest();
    for expected in [1, 0, 1] {
        sitting.turn(b"n");
        assert_eq!((sitting.seat.shown, sitting.seat.viewer.shown_scene()), (expected, Some(expected)));
        sitting.rest();
    }
    sitting.turn(b"p");
    assert_eq!(sitting.seat.shown, 0);
}

#[test]
fn after_a_panic_all_modes_are_off() {
    let mut sitting = Sitting::new(STAY);
    sitting.rest();
    let mut bytes = Vec::new();
    sitting.seat.abandon(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("\x1b[?25h") && text.contains("\x1b[?1049l"), "{text:?}");
    // A mode that was not switched on is not switched off: the keyboard's flags may have been set by the shell.
    assert!(!text.contains("\x1b[<1u"), "{text:?}");
}

/// With any input, in parts of any size, a seat soon sleeps and restores the terminal at the end.
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
        let mut sitting = Sitting::new(STAY);
        for _ in 0..60 {
            let words: Vec<u8> = (0..random(8)).flat_map(|_| WORDS[random(WORDS.len())].to_vec()).collect();
            let part = words.get(..random(words.len() + 1)).unwrap_or_default().to_vec();
            let window = (random(10) == 0).then(|| {
                let (columns, rows) = (random(60) as u32, random(20) as u32);
                crate::serve::client_terminal::window([columns, rows, 0, 0])
            });
            let mut next = sitting.turn_for(Class::Refinement, Arrived { bytes: part, window, ..Arrived::default() });
            sitting.now.set(sitting.now.get() + Duration::from_millis(random(40) as u64));
            for _ in 0..40 {
                if !matches!(next, Next::Turn(_)) {
                    break;
                }
                next = sitting.turn(&[]);
            }
            assert!(
                matches!(next, Next::Sleep(_)),
                "no key that leaves was pressed, and the seat soon sleeps: {next:?}"
            );
        }
        let mut all = std::mem::take(&mut sitting.bytes);
        sitting.seat.leave(Parting::Quit, sitting.now.get(), &mut all);
        let text = String::from_utf8_lossy(&all);
        assert!(text.contains("\x1b[?1049l") && text.contains("\x1b[?25h"));
    }
}

/// A busy server is no slow link: the time that a reply waits for its turn does not count.
#[test]
fn a_reply_counts_from_its_arrival() {
    // Each turn comes 300 ms after the last one. Returns the number of bytes sent for a view that turns.
    let bytes_if_replies_arrive_after = |time: Duration| {
        let mut sitting = Sitting::new(STAY);
        let window = Some(crate::serve::client_terminal::window([80, 24, 0, 0]));
        sitting.turn_for(Class::Refinement, Arrived { window, ..Arrived::default() });
        sitting.rest();
        sitting.turn(b"t");
        let mut sum = 0;
        for _ in 0..40 {
            let queries = sitting.bytes.windows(3).filter(|bytes| *bytes == b"\x1b[c").count();
            sum += sitting.bytes.len();
            sitting.bytes.clear();
            let at = sitting.now.get() + time;
            sitting.now.set(sitting.now.get() + Duration::from_millis(300));
            let bytes = b"\x1b[?62c".repeat(queries);
            sitting.turn_for(Class::Refinement, Arrived { bytes, at, ..Arrived::default() });
        }
        sum
    };
    let [early, late] = [1, 300].map(|time| bytes_if_replies_arrive_after(Duration::from_millis(time)));
    assert!(early > 2 * late, "{early} bytes with early replies, {late} with late ones");
}
