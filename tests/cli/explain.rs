//! `termtrace explain`.

use super::Folder;

fn golden(name: &str) -> String {
    let path = format!("{}/tests/explained/{name}.txt", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("the golden is there")
}

/// `BLESS=1 cargo test --test cli explain` writes the goldens anew.
#[track_caller]
fn says(name: &str, arguments: &str) {
    let said = Folder::new().run(&format!("explain {arguments}")).text();
    if std::env::var_os("BLESS").is_some() {
        let path = format!("{}/tests/explained/{name}.txt", env!("CARGO_MANIFEST_DIR"));
        std::fs::write(path, &said).expect("the golden can be written");
    }
    assert_eq!(said, golden(name));
}

/// Pixels of the ball, the lit floor, its shadow, the sky and a mesh are explained.
#[test]
fn pixels_are_explained_in_the_lectures_symbols() {
    says("ball", "ball.ron --pixel 30,20");
    says("floor", "ball.ron --pixel 70,40 --pixels 80x48");
    says("shadow", "ball.ron --pixel 20,30 --pixels 80x48");
    says("sky", "ball.ron --pixel 0,0 --size 40x12 --eye 1,1.5,7");
    let teapots = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/teapots.ron");
    says("mesh", &format!("{teapots} --pixel 24,24"));
}

/// The last lines are the bytes of the frame there.
#[test]
fn the_bytes_are_the_frames() {
    let folder = Folder::new();
    let png = folder.frame("ball.ron --pixels 8x6 --samples 1 --format png");
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("it fits")];
    reader.next_frame(&mut rgb).expect("a picture");
    for (at, rgb) in rgb.chunks(3).enumerate() {
        let said = folder.run(&format!("explain ball.ron --pixels 8x6 --pixel {},{}", at % 8, at / 8)).text();
        let bytes = format!("\nsRGB {} {} {}  #", rgb[0], rgb[1], rgb[2]);
        assert!(said.contains(&bytes), "pixel {at} is {rgb:?}: {said}");
    }
}

#[test]
fn a_pixel_outside_the_picture_is_a_usage_error() {
    let folder = Folder::new();
    for outside in ["8,0", "0,6", "4000000000,0"] {
        let run = folder.run(&format!("explain ball.ron --pixels 8x6 --pixel {outside}"));
        run.fails_in_a_line(2, &format!("there is no pixel {outside} in a frame of 8x6 pixels"));
    }
    for wrong in ["", "8", "1,2,3", "1.5,0", "x,y", "-1,0", "99999999999,0"] {
        folder.run(&format!("explain ball.ron --pixel={wrong}")).is_misused("--pixel");
    }
    // A separate word that begins with a minus is a wrong pixel, not an option.
    folder.run("explain ball.ron --pixel -1,2").is_misused("expected two whole numbers");
    folder.run("explain ball.ron").is_misused("--pixel");
    folder.run("explain missing.ron --pixel 1,1").fails_in_a_line(2, "missing.ron");
    folder.run("explain ball.ron --pixel 1,1 --pixels 99999x99999").fails_in_a_line(2, "too large");
}
