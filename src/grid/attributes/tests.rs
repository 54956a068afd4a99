use super::*;

#[test]
fn attributes_have_distinct_bits() {
    let apart: Vec<_> = Attributes::all().iter().collect();
    for (at, &one) in apart.iter().enumerate() {
        let before: Attributes = apart[..at].iter().copied().collect();
        assert!(!one.is_empty() && (before & one).is_empty(), "{one:?}");
    }
    assert_eq!(apart.into_iter().collect::<Attributes>(), Attributes::all());
    assert_eq!(Attributes::from_bits_truncate(u16::MAX), Attributes::all());
}

#[test]
fn set_operations_agree_with_the_bits() {
    let (bold, line) = (Attributes::BOLD, Attributes::UNDERLINED);
    let mut both = bold | line;
    assert!(both.contains(line) && !both.contains(line | Attributes::DIM));
    assert_eq!((both ^ bold, both.difference(line), both & line), (line, bold, line));
    assert_eq!(format!("{both:?}"), "BOLD | UNDERLINED");
    both.remove(bold);
    assert_eq!(both, line);
}
