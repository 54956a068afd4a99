//! Any bytes give a scene or faults inside the text: no panic, no stack overflow, no quadratic
//! time.
//!
//! What is valid RON to the RON project's own reader is so to ours.

use proptest::prelude::*;
use std::fmt::Write;
use std::time::{Duration, Instant};
use termtrace::internals::scene_text::{Body, MAX_TEXT_BYTES, SyntaxNode, Value, parse};
use termtrace::{Scene, SceneError};

const SCENE: &str = r##"// A scene with one of everything.
Scene(
    camera: (eye: (0, 1.5, 6), target: [0, 0.7, 0], up: (0, 1, 0), focal_length: 2, width: 3, height: 2, shift: (0, 0.1), tilt: (5, -10)),
    views: [(eye: (1, 2, 3), target: (0, 0, 0)), (eye: [0, 9, 0], target: [0, 0, 0], up: (0, 0, 1), vertical_fov: 30)],
    background: Gradient(bottom: "#fff", top: "SteelBlue"), ambient: (0.1, 1e-2, 0x1),
    lights: [
        Point(position: (4, 6, 5), color: Some("white"), intensity: 60_0, falloff: InverseSquare),
        Spot(position: (4, 6, 5), target: [0, 1, 0], angle: 30, softness: None), Sun(direction: (1, 2, 3)),
    ],
    materials: {
        "floor": Checker(a: "#dddddd", b: 0.2, size: 1), r#"ball"#: Diffuse(reflectance: (1, 0.5, 0)),
        "planks": Stripes(width: 2), "wall": Gradient(from: "red", to: 0.5), "moss": Noise(a: "olive", size: 0.5),
    },
    objects: (
        Sphere(center: (0, 1, 0), radius: 1, material: "ball"), /* a /* nested */ comment */
        Plane(point: (0, 0, 0), normal: (0, 2, 0), material: "floor"),
    ),
    shadows: true, exposure: 1.5, tone_curve: Filmic,
)
"##;

fn read(bytes: &[u8]) -> Result<Scene, SceneError> {
    let result = Scene::from_bytes("x.ron", bytes);
    if let Err(error) = &result {
        assert!(!error.reports().is_empty());
        let lines = bytes.split(|&byte| byte == b'\n').count();
        for report in error.reports() {
            let (start, end) = (report.span.start as usize, report.span.end as usize);
            assert!(start <= end && end <= bytes.len(), "{report:?} of {} bytes", bytes.len());
            assert!(report.line >= 1 && report.line <= lines && report.column >= 1);
        }
        let message = error.to_string();
        assert!(!message.contains(|c: char| c.is_control() && c != '\n'), "{message:?}");
    }
    result
}

#[test]
fn the_scene_is_valid() {
    read(SCENE.as_bytes()).unwrap();
}

#[test]
fn every_beginning_of_a_scene_gives_a_fault() {
    for length in 0..SCENE.trim_end().len() {
        assert!(read(&SCENE.as_bytes()[..length]).is_err(), "{length}");
    }
}

/// Deep nesting is a fault within the 2 MiB of a usual thread's stack.
#[test]
fn deep_nesting_is_a_fault() {
    for opening in ["(", "[", "{", "a(", "a(b:", "Some(", "{1:", "[(", "(a:[", "/*", "#![", "r#", "\"\\"] {
        let text = opening.repeat(1_000_000);
        let error = std::thread::Builder::new()
            .stack_size(2 << 20)
            .spawn(move || read(text.as_bytes()).unwrap_err())
            .unwrap()
            .join()
            .unwrap();
        assert_eq!(error.count(), 1, "{opening}: {error}");
    }
}

#[test]
fn large_files_take_linear_time() {
    for (opening, unit, closing) in [
        ("(objects: [", "1,", "])"),
        ("(objects: [", "Spere(),", "])"),
        ("(objects: [", "Sphere(material:\"x\"),", "])"),
        ("(materials: {", "\"a\": 1,", "})"),
        ("(", "a: 1, ", ")"),
        ("(camera: (", "fov: 1, ", "))"),
        ("{", "a,", ""),
        ("[", "1 ", ""),
        ("", "@", ""),
        ("[", "/**/", "]"),
        ("[", "\n", "]"),
        ("(a: \"", "é", "\")"),
        ("", "(\n)", ""),
    ] {
        let mut text = opening.to_owned();
        while text.len() < 2_000_000 {
            text += unit;
        }
        text += closing;
        let start = Instant::now();
        let _ = read(text.as_bytes());
        // Linear: tenths of a second at most. Square: minutes.
        assert!(start.elapsed() < Duration::from_secs(20), "{opening}{unit}");
    }
}

#[test]
fn files_beyond_the_limit_are_not_read() {
    let error = read(&vec![b' '; MAX_TEXT_BYTES + 1]).unwrap_err();
    assert_eq!(error.to_string(), "x.ron:1:1: the file is larger than 16 MiB, too large to be read");
}

/// Returns our tree in a notation of the test's own.
fn ours(node: &SyntaxNode<'_>) -> String {
    let many = |nodes: &[SyntaxNode<'_>]| nodes.iter().map(ours).collect::<Vec<_>>().join(" ");
    match &node.value {
        Value::Bool(value) => value.to_string(),
        Value::Number(value) => format!("{value:?}"),
        Value::String(value) => format!("{value:?}"),
        Value::List(items) => format!("[{}]", many(items)),
        Value::Map(entries) => {
            let entry = |(key, value): &(SyntaxNode<'_>, SyntaxNode<'_>)| format!("{}={}", ours(key), ours(value));
            format!("{{{}}}", entries.iter().map(entry).collect::<Vec<_>>().join(" "))
        }
        Value::Group(group) => {
            let mut text = group.name.map_or("", |name| name.text).to_owned();
            match &group.body {
                Body::Nothing => {}
                Body::Values(values) => write!(text, "({})", many(values)).unwrap(),
                Body::Fields(fields) => {
                    let field = |field: &termtrace::internals::scene_text::Field<'_>| {
                        format!("{}:{}", field.name.text, ours(&field.value))
                    };
                    write!(text, "({})", fields.iter().map(field).collect::<Vec<_>>().join(" ")).unwrap();
                }
            }
            text
        }
    }
}

/// Returns the other reader's tree in the same notation, with its positions.
fn theirs(expr: &ron2::ast::Expr<'_>) -> String {
    use ron2::ast::{Expr, StructBody, StructField, TupleElement};
    let many = |elements: &[TupleElement<'_>]| elements.iter().map(|e| theirs(&e.expr)).collect::<Vec<_>>().join(" ");
    let fields = |fields: &[StructField<'_>]| {
        let field = |field: &StructField<'_>| format!("{}:{}", field.name.name, theirs(&field.value));
        fields.iter().map(field).collect::<Vec<_>>().join(" ")
    };
    match expr {
        Expr::Bool(e) => e.value.to_string(),
        Expr::Number(e) => format!("{:?}", e.raw.parse::<f64>().unwrap()),
        Expr::String(e) => format!("{:?}", e.value),
        Expr::Unit(_) => "()".to_owned(),
        Expr::Option(e) => e.value.as_ref().map_or("None".to_owned(), |inner| theirs(&inner.expr)),
        Expr::Seq(e) => {
            let items: Vec<_> = e.items.iter().map(|item| theirs(&item.expr)).collect();
            format!("[{}]", items.join(" "))
        }
        Expr::Map(e) => {
            let entry = |entry: &ron2::ast::MapEntry<'_>| format!("{}={}", theirs(&entry.key), theirs(&entry.value));
            format!("{{{}}}", e.entries.iter().map(entry).collect::<Vec<_>>().join(" "))
        }
        Expr::Tuple(e) => format!("({})", many(&e.elements)),
        Expr::AnonStruct(e) => format!("({})", fields(&e.fields)),
        Expr::Struct(e) => match &e.body {
            None => e.name.name.to_string(),
            Some(StructBody::Tuple(body)) => format!("{}({})", e.name.name, many(&body.elements)),
            Some(StructBody::Fields(body)) => format!("{}({})", e.name.name, fields(&body.fields)),
        },
        other => panic!("not generated: {other:?}"),
    }
}

/// Returns valid RON of the kinds that scenes use, with white space and comments anywhere.
fn ron() -> impl Strategy<Value = String> {
    let word = "[a-z_][a-zA-Z0-9_]{0,6}"
        .prop_filter("reserved", |word| !["true", "false", "r", "b", "br", "inf"].contains(&word.as_str()));
    let leaf = prop_oneof![
        any::<i32>().prop_map(|number| number.to_string()),
        any::<f32>().prop_filter("finite", |x| x.is_finite()).prop_map(|number| format!("{number:?}")),
        "[a-z #é地]{0,5}".prop_map(|text| format!("{text:?}")),
        any::<bool>().prop_map(|value| value.to_string()),
        word.clone().prop_map(String::from),
        Just("None".to_owned()),
    ];
    let space = prop_oneof![Just(""), Just(" "), Just("\n  "), Just(" // x\n"), Just("/* ( */")];
    leaf.prop_recursive(4, 40, 5, move |inner| {
        let named = (word.clone(), inner.clone()).prop_map(|(name, value)| format!("{name}: {value}"));
        let entry = (inner.clone(), inner.clone()).prop_map(|(key, value)| format!("{key}: {value}"));
        let listed = |item: BoxedStrategy<String>| {
            (prop::collection::vec(item, 1..4), space.clone(), any::<bool>())
                .prop_map(|(items, space, comma)| items.join(&format!(",{space}")) + if comma { "," } else { "" })
        };
        prop_oneof![
            listed(inner.clone().boxed()).prop_map(|items| format!("[{items}]")),
            listed(inner.boxed()).prop_map(|items| format!("({items})")),
            (word.clone(), listed(named.boxed())).prop_map(|(name, fields)| format!("{name}({fields})")),
            listed(entry.boxed()).prop_map(|entries| format!("{{{entries}}}")),
        ]
    })
}

proptest! {
    #[test]
    fn the_ron_projects_reader_sees_the_same_tree(text in ron()) {
        let document = ron2::ast::parse_document(&text).unwrap();
        let expected = document.value.as_ref().unwrap();
        let found = parse(&text).unwrap();
        prop_assert_eq!(ours(&found), theirs(expected));
        prop_assert_eq!(found.span.start as usize, expected.span().start_offset);
        prop_assert_eq!(found.span.end as usize, expected.span().end_offset);
    }

    #[test]
    fn any_bytes_give_a_scene_or_faults(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = read(&bytes);
    }

    #[test]
    fn any_ron_characters_give_a_scene_or_faults(text in "[-+.,:()\\[\\]{}\"'#!/*\\\\a-e0-9 \n\t\r_=é地\u{1b}]{0,120}") {
        let _ = read(text.as_bytes());
    }

    #[test]
    fn a_scene_with_changed_bytes_gives_a_scene_or_faults(
        changes in prop::collection::vec((0..SCENE.len(), prop_oneof![any::<u8>(), Just(b'"'), Just(b'('), Just(b')')]), 1..4)
    ) {
        let mut bytes = SCENE.as_bytes().to_vec();
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        let _ = read(&bytes);
    }

    #[test]
    fn a_scene_with_a_moved_piece_gives_a_scene_or_faults(from in 0..SCENE.len(), length in 0_usize..60, to in 0..SCENE.len()) {
        let mut bytes = SCENE.as_bytes().to_vec();
        let piece: Vec<_> = bytes.drain(from..(from + length).min(SCENE.len())).collect();
        let to = to.min(bytes.len());
        bytes.splice(to..to, piece);
        let _ = read(&bytes);
    }
}
