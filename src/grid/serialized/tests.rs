use super::*;

#[test]
fn sizes_and_attributes_survive_a_round_trip() {
    let size = Size::new(80, 24);
    let text = serde_json::to_string(&size).expect("it is written");
    assert_eq!((text.as_str(), serde_json::from_str(&text).ok()), (r#"{"columns":80,"rows":24}"#, Some(size)));
    let attributes = Attributes::BOLD | Attributes::CROSSED_OUT;
    let text = serde_json::to_string(&attributes).expect("it is written");
    assert_eq!(serde_json::from_str(&text).ok(), Some(attributes), "{text}");
}

#[test]
fn unknown_attributes_are_an_error() {
    let error = serde_json::from_str::<Attributes>("512").expect_err("it is wrong").to_string();
    assert!(error.contains("nine bits"), "{error}");
}
