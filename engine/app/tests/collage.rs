//! `toile collage` as a script meets it.

use std::fs;

use crate::common::{Scratch, object, sentence};

const SKIRT: &str = "name = \"Skirt\"\nlayer = \"shirts\"\nlevel = \"waist\"\n[front]\npicture = \"skirt.png\"\n\
                     points = [[20, 10], [80, 10]]\ndistance_mm = 300\n[stretches]\nwaist = [650, 800]\n";

/// A PNG of a cloth with nothing around it, made by the encoder of the tests' own.
fn cloth(scratch: &Scratch) {
    let mut bytes = Vec::new();
    let mut png = png::Encoder::new(&mut bytes, 100, 120);
    png.set_color(png::ColorType::Rgba);
    png.set_depth(png::BitDepth::Eight);
    let inside = |i: usize| (20..80).contains(&(i % 100)) && (10..110).contains(&(i / 100));
    let pixels: Vec<u8> = (0..12_000).flat_map(|i| if inside(i) { [30, 60, 200, 255] } else { [0; 4] }).collect();
    png.write_header().unwrap().write_image_data(&pixels).unwrap();
    fs::write(scratch.path().join("skirt.png"), bytes).unwrap();
    fs::write(scratch.path().join("skirt.toml"), SKIRT).unwrap();
}

#[test]
fn a_photograph_is_laid_on_a_body_and_its_limits_are_kept() {
    let scratch = Scratch::new("collage");
    cloth(&scratch);
    let line = ["collage", "skirt.toml", "--size", "38", "--rows", "240", "--out", "shown", "--json"];
    let report = object(&scratch.toile(&line));
    assert_eq!((&report["schema"], &report["body"]), (&"toile.collage/1".into(), &"size 38".into()));
    assert_eq!(report["garments"][0]["layer"], "shirts");
    let bytes = fs::read(scratch.path().join("shown/collage-front.png")).expect("the picture is written");
    let picture = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    // As wide as half raised arms reach.
    assert_eq!(picture.info().height, 240);
    assert!((180..260).contains(&picture.info().width), "{} columns", picture.info().width);
    let large = scratch.toile(&["collage", "skirt.toml", "--size", "50", "--rows", "240"]);
    assert_eq!(large.status.code(), Some(4));
    assert!(sentence(&large).contains("its waist is for girths of 650 to 800 mm"));
}

#[test]
fn what_cannot_be_shown_is_one_sentence() {
    let scratch = Scratch::new("collage-bad");
    cloth(&scratch);
    let write = |name: &str, text: String| fs::write(scratch.path().join(name), text).unwrap();
    write("gone.toml", SKIRT.replace("skirt.png", "gone.png"));
    write("wide.toml", SKIRT.replace("[80, 10]", "[800, 10]"));
    write("layer.toml", SKIRT.replace("shirts", "shirt"));
    write("text.toml", SKIRT.replace("skirt.png", "skirt.toml"));
    for (line, code, wanted) in [
        (vec!["collage", "absent.toml"], 4, "absent.toml"),
        (vec!["collage", "gone.toml"], 4, "gone.png"),
        (vec!["collage", "wide.toml"], 4, "points lie outside of skirt.png"),
        (vec!["collage", "layer.toml"], 4, "line 2"),
        (vec!["collage", "text.toml"], 4, "no picture in PNG or JPEG"),
        (vec!["collage", "skirt.toml", "--side", "back"], 4, "no garment has a picture from the back"),
        (vec!["collage", "skirt.toml", "--size", "999"], 4, "999"),
        (vec!["collage"], 2, "required"),
    ] {
        let output = scratch.toile(&line);
        let said = sentence(&output);
        assert!(output.status.code() == Some(code) && said.contains(wanted), "{line:?}: {said}");
    }
}
