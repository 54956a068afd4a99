use super::*;
use std::collections::BTreeMap;

const MS: Duration = Duration::from_millis(1);

/// Returns the CPU time that each session gets if all always want a picture, with one worker for
/// `time`.
///
/// `cost` is the CPU time of a turn of each session.
fn shares(cost: &[Duration], time: Duration) -> Vec<Duration> {
    let (mut queue, mut used) = (RunQueue::default(), vec![Duration::ZERO; cost.len()]);
    (0..cost.len()).for_each(|id| queue.add(id as SessionId));
    let mut now = Duration::ZERO;
    while now < time {
        let id = queue.take(now).expect("all are ready");
        let cost = cost[id as usize];
        now += cost;
        used[id as usize] += cost;
        queue.finish(id, cost, AfterTurn::Turn(WorkKind::Picture));
    }
    used
}

#[test]
fn sessions_get_equal_time_whatever_their_turns_cost() {
    let costs = [MS / 4, MS, 20 * MS, MS / 2, 3 * MS];
    let used = shares(&costs, Duration::from_secs(10));
    for time in used {
        let share = time.as_secs_f64() / 2.0;
        assert!((0.95..=1.05).contains(&share), "{share}");
    }
}

#[test]
fn a_session_that_rested_is_served_first_and_gains_no_share() {
    let mut queue = RunQueue::default();
    (0..10).for_each(|id| queue.add(id));
    let mut turns = BTreeMap::<SessionId, u32>::new();
    let mut now = Duration::ZERO;
    for round in 0..1000 {
        let id = queue.take(now).expect("all but one are always ready");
        *turns.entry(id).or_default() += 1;
        now += MS;
        // Session 9 sleeps after each turn, and is woken at once.
        let next = if id == 9 { AfterTurn::Sleep(None) } else { AfterTurn::Turn(WorkKind::Picture) };
        queue.finish(id, MS, next);
        queue.wake(9);
        assert!(round < 20 || turns.len() == 10, "no session starves");
    }
    let (most, least) = (turns.values().max().unwrap(), turns.values().min().unwrap());
    assert!(most - least <= 2, "{turns:?}");

    // After a long rest, session 9 goes before all sessions that have been running.
    let mut queue = RunQueue::default();
    (0..10).for_each(|id| queue.add(id));
    while let Some(id) = queue.take(Duration::ZERO) {
        queue.finish(id, MS, if id == 9 { AfterTurn::Sleep(None) } else { AfterTurn::Turn(WorkKind::Picture) });
        if queue.virtual_time > 50 * MS {
            break;
        }
    }
    queue.wake(9);
    assert_eq!(queue.take(Duration::ZERO), Some(9));
}

#[test]
fn refinements_run_only_when_nothing_else_is_ready() {
    let mut queue = RunQueue::default();
    queue.add(1);
    queue.add(2);
    assert_eq!(queue.take(Duration::ZERO), Some(1));
    queue.finish(1, MS, AfterTurn::Turn(WorkKind::Refinement));
    assert_eq!((queue.take(Duration::ZERO), queue.load()), (Some(2), 1));
    queue.finish(2, 100 * MS, AfterTurn::Turn(WorkKind::Picture));
    assert_eq!(queue.take(Duration::ZERO), Some(2));
    queue.finish(2, MS, AfterTurn::Sleep(None));
    assert_eq!(queue.take(Duration::ZERO), Some(1));
    // A session that waits for a refinement and gets a key press is served like the others.
    queue.finish(1, MS, AfterTurn::Turn(WorkKind::Refinement));
    queue.wake(1);
    assert_eq!(queue.load(), 1);
}

#[test]
fn a_session_sleeps_until_its_time_or_until_it_is_woken() {
    let mut queue = RunQueue::default();
    queue.add(7);
    assert_eq!(queue.take(Duration::ZERO), Some(7));
    queue.finish(7, MS, AfterTurn::Sleep(Some(10 * MS)));
    assert_eq!((queue.take(9 * MS), queue.next_timer()), (None, Some(10 * MS)));
    assert_eq!((queue.take(10 * MS), queue.next_timer()), (Some(7), None));
    // A session that is woken during its turn gets another turn.
    queue.wake(7);
    queue.finish(7, MS, AfterTurn::Sleep(None));
    assert_eq!(queue.take(10 * MS), Some(7));
    queue.finish(7, MS, AfterTurn::End);
    queue.wake(7);
    assert_eq!(queue.take(Duration::MAX), None);
}

#[test]
fn ten_thousand_sessions_are_cheap() {
    let started = std::time::Instant::now();
    let mut queue = RunQueue::default();
    (0..10_000).for_each(|id| queue.add(id));
    for turn in 0..100_000_u64 {
        let now = Duration::from_micros(100 * turn);
        let Some(id) = queue.take(now) else { continue };
        queue.finish(id, MS / 10, AfterTurn::Sleep(Some(now + 33 * MS)));
    }
    // A turn of a viewer costs some 300 µs; 100,000 entries of the queue take well below one second even in a debug
    // build.
    assert!(started.elapsed() < Duration::from_secs(5), "{:?}", started.elapsed());
}
