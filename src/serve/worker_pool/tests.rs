use super::*;

#[test]
fn sessions_that_wait_or_drew_share_the_threads() {
    let per_thread = |pending, drawing, threads| Load { pending, drawing }.per_thread(threads);
    assert_eq!(per_thread(200, 6, 2), 100.0);
    assert_eq!(per_thread(6, 200, 2), 100.0);
    // A session alone has a thread, not more.
    assert_eq!(per_thread(1, 1, 8), 1.0);
}
