use super::*;
use crate::terminal::Signals;
use std::convert::Infallible;
use std::fs;
use std::sync::atomic::AtomicUsize;

fn loader() -> Loader<Infallible> {
    let waker = Signals::catch().and_then(|signals| signals.waker()).expect("pipes can be made");
    Loader::start(None, waker).expect("a thread can be started")
}

fn draft(reporter: &Reporter<'_>) -> Draft {
    let text = b"(camera: (eye: (0, 0, 5), target: (0, 0, 0)))";
    Draft::from_bytes("x", text, reporter).expect("the scene is fine")
}

/// Waits until the load has ended and returns whether it gave a scene.
fn has_scene(loading: &Loading<Infallible>) -> bool {
    loading.events.iter().any(|event| matches!(event, LoadEvent::Scene(_)))
}

/// At most one scene is read at a time, and loads that are cancelled in the queue are never
/// started.
#[test]
fn scenes_are_read_one_at_a_time_and_the_newest_next() {
    let (begun, at_work, most) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)), Arc::default());
    let source = |is_last: bool| {
        let (begun, at_work, most) = (Arc::clone(&begun), Arc::clone(&at_work), Arc::<AtomicUsize>::clone(&most));
        Source::new("x", move |reporter| {
            begun.fetch_add(1, Ordering::SeqCst);
            most.fetch_max(1 + at_work.fetch_add(1, Ordering::SeqCst), Ordering::SeqCst);
            while !is_last && !reporter.is_cancelled() {
                thread::yield_now();
            }
            at_work.fetch_sub(1, Ordering::SeqCst);
            Ok(draft(reporter))
        })
    };
    let loader = loader();
    let mut loading = loader.load(source(false)).expect("the thread lives");
    while begun.load(Ordering::SeqCst) == 0 {
        thread::yield_now();
    }
    let later: Vec<_> = (0..30).map(|at| loader.load(source(at == 29)).expect("the thread lives")).collect();
    for next in later {
        loading = next;
    }
    assert!(has_scene(&loading));
    assert_eq!(most.load(Ordering::SeqCst), 1, "at a time");
    assert_eq!(begun.load(Ordering::SeqCst), 2, "the first and the last");
}

/// A load that waits for a writer to open a pipe does not block the next load.
#[test]
fn a_load_that_waits_on_a_pipe_is_left_behind() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()), "a pipe with a name can be made");
    let (told, opens) = channel();
    let path = pipe.clone();
    let waiting = Source::new("pipe", move |reporter| {
        reporter.report_dependency(&path);
        let _ = told.send(());
        let _ = fs::read(&path);
        Ok(draft(reporter))
    });
    let loader = loader();
    let first = loader.load(waiting).expect("the thread lives");
    opens.recv().expect("it begins");
    drop(first);
    let second = loader.load(Source::new("x", |reporter| Ok(draft(reporter)))).expect("the thread lives");
    assert!(has_scene(&second));
    // Opens the writing end, so that the waiting thread ends.
    drop(fs::OpenOptions::new().write(true).open(&pipe));
}

#[test]
fn a_panic_ends_its_load_alone() {
    let loader = loader();
    let panics = loader.load(Source::new("x", |_| panic!("a test"))).expect("the thread lives");
    assert!(panics.events.iter().any(|event| matches!(event, LoadEvent::Panic(_))));
    assert!(has_scene(&loader.load(Source::new("x", |reporter| Ok(draft(reporter)))).expect("the thread lives")));
}
