use super::*;

#[test]
fn more_memory_than_any_machine_has_is_an_error() {
    assert!(check(1 << 20).is_ok());
    for bytes in [1 << 60, usize::MAX] {
        let error = io::Error::from(check(bytes).expect_err("no machine has it").with_purpose("for a test"));
        assert_eq!(error.kind(), io::ErrorKind::OutOfMemory);
        assert_eq!(error.to_string(), "there is not enough memory for a test");
    }
}
