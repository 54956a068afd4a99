use super::*;

#[test]
fn ignored_signals_are_read_from_proc_self_status() {
    let ignored =
        ignored_in("Name:\tsh\nSigBlk:\t0000000000000002\nSigIgn:\t0000000000000001\nSigCgt:\t0000000000000002\n");
    assert_eq!(ignored, 1 << (SIGHUP - 1));
    assert_eq!(ignored_in("no such line"), 0);
}
