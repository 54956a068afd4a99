use super::*;

#[test]
fn warnings_are_wrapped_and_never_repeated() {
    let mut warnings = Warnings::default();
    warnings.add("materials missing: a.mtl".to_owned());
    warnings.add("materials missing: a.mtl".to_owned());
    assert_eq!(warnings.lines(80).len(), 1);
    assert_eq!(warnings.lines(14), ["materials ", "missing: ", "a.mtl"]);
    warnings.add("word ".repeat(100));
    assert_eq!(warnings.lines(40).len(), MAX_ROWS);
}
