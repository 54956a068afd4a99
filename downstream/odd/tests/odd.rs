//! Every call ends as its documentation says.

use std::process::Command;

#[test]
fn every_call_ends_as_documented() {
    let output = Command::new(env!("CARGO_BIN_EXE_odd")).output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}");
    assert!(said.lines().count() > 70, "{said}");
}
