use super::*;

#[test]
fn a_mutable_borrow_counts_as_a_change() {
    let mut list = Tracked::new_changed(vec![1]);
    assert!(list.is_changed());
    list.mark_unchanged();
    list.quietly().push(2);
    assert!(list.len() == 2 && !list.is_changed());
    list.push(3);
    assert!(list.is_changed());
}
