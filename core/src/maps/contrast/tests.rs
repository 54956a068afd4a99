use super::*;

#[test]
fn lines_separate_objects_of_the_same_colour() {
    let [light, dark] = [Srgb8::new(200, 200, 200), Srgb8::new(90, 90, 90)];
    let picture =
        Picture { width: 4, height: 2, pixels: [[light, light, light, dark], [light, light, dark, dark]].concat() };
    let outlined = bilevel_with_outlines(&picture, &[1, 1, 2, 3, 1, 1, 3, 3]);
    let rows: Vec<String> = outlined
        .pixels
        .chunks(4)
        .map(|row| row.iter().map(|&pixel| if pixel == WHITE { '@' } else { ' ' }).collect())
        .collect();
    assert_eq!(rows, ["@ @ ", "@@  "]);
}
