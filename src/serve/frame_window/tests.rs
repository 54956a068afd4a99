use super::*;

#[test]
fn a_session_counts_once_and_until_its_last_frame_is_old() {
    let ms = Duration::from_millis;
    let mut window = FrameWindow::default();
    assert_eq!(window.session_count(ms(0)), 0);
    for (id, at) in [(7, 0), (7, 50), (9, 60), (7, 100)] {
        window.record(id, ms(at));
    }
    assert_eq!(window.session_count(ms(100)), 2);
    assert_eq!(window.session_count(ms(1060)), 2);
    assert_eq!(window.session_count(ms(1061)), 1);
    assert_eq!(window.session_count(ms(1101)), 0);
    assert!(window.counts.is_empty() && window.frames.is_empty());
}
