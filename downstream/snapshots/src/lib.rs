//! A scene whose frames the tests compare with snapshots.

/// A small ball, with blank rows above and below it.
pub const BALL: &str = "(
    camera: (eye: (0, 0, 6), target: (0, 0, 0)),
    lights: [Point(position: (3, 4, 5), intensity: 40)],
    objects: [Sphere(center: (0, 0, 0), radius: 1)],
)";
