use super::*;
use glam::{Vec2, Vec3};
use serde::de::DeserializeOwned;
use std::fmt::Debug;

fn camera() -> Camera {
    let rectangle = ViewRectangle::from_vertical_fov(0.7)
        .and_then(|r| r.with_shift(Vec2::new(0.1, 0.0))?.with_tilt(Vec2::new(0.0, -0.2)));
    let pose = Pose { eye: Vec3::new(0.0, 1.0, 5.0), target: Vec3::ZERO, up: Vec3::Y };
    Camera::new(pose, rectangle.expect("a rectangle")).expect("a camera")
}

#[track_caller]
fn assert_kept<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) {
    let text = serde_json::to_string(value).expect("it is written");
    assert_eq!(&serde_json::from_str::<T>(&text).expect("it is read"), value, "{text}");
}

fn error<T: DeserializeOwned + Debug>(text: &str) -> String {
    serde_json::from_str::<T>(text).expect_err("it is wrong").to_string()
}

#[test]
fn values_survive_a_round_trip() {
    assert_kept(&LinearRgb::new(0.1, 2.0, 1e-9));
    assert_kept(&Srgb8::new(1, 2, 255));
    assert_kept(&Map::ALL.to_vec());
    assert_kept(&[Sampling::BEST, Sampling::Coarse, Sampling::Each(NonZeroU32::MIN)]);
    assert_kept(&camera());
    assert_kept(&Resolution::square(3, 2).with_pixel_aspect(0.3).expect("a shape"));
}

#[test]
fn invariants_are_checked() {
    assert!(error::<Map>("\"dept\"").contains("did you mean \"depth\"?"));
    assert!(error::<Resolution>(r#"{"width": 1, "height": 1, "pixel_aspect": 0}"#).contains("height over its width"));
    assert!(error::<ViewRectangle>(r#"{"width": null, "height": -1, "shift": [0, 0]}"#).contains("greater than 0"));
    assert!(error::<Sampling>(r#"{"each": 0}"#).contains("nonzero"));
    let text = serde_json::to_string(&camera()).expect("it is written");
    let up = text.replace(r#""up":[0.0,1.0,0.0]"#, r#""up":[0.0,0.0,0.0]"#);
    assert!(error::<Camera>(&up).contains("the up vector must have a length"), "{up}");
}
