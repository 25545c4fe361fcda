use glam::{DVec2, DVec3};

use super::*;

/// Two cameras three metres away, looking at the origin from the front and the left; z up.
pub const TWO: &str = "
[metadata]
frame_rate = 50
[b]
size = [1000.0, 1000.0]
matrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]
distortions = [-0.1, 0.02, 0.001, -0.001]
rotation = [1.2091995761561452, -1.2091995761561452, 1.2091995761561452]
translation = [0.0, 1.0, 3.0]
[a]
size = [1000.0, 1000.0]
matrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]
rotation = [1.5707963267948966, 0.0, 0.0]
translation = [0.0, 1.0, 3.0]
";

/// The first of them as OpenCV writes it.
const YAML: &str = "%YAML:1.0
---
calibration_time: \"Mon 01 Jan\"
image_width: 1000
image_height: 1000
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1000., 0., 500., 0., 1000.,
       500., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -1.0e-01, 0.02, 0.001, -0.001, 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0., -1., 0., 0., 0., -1., 1., 0., 0. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ 0., 1., 3. ]
";

/// The pixel at which a camera sees a point, distortion and all.
pub fn pixel(camera: &CalibratedCamera, point: DVec3) -> DVec2 {
    camera.pixel(point).unwrap()
}

pub(crate) use super::read_toml as read;

#[test]
fn cameras_come_by_name_and_rays_lead_back_through_the_lens() {
    let rig = read(TWO.as_bytes()).unwrap();
    assert_eq!(rig.frame_rate, Some(50.0));
    assert!(!rig.cameras[0].is_bent() && rig.cameras[1].is_bent());
    for camera in &rig.cameras {
        for point in [DVec3::new(0.3, 0.2, 1.1), DVec3::new(-0.9, 0.8, 0.1)] {
            let ray = camera.ray(pixel(camera, point));
            assert!(ray.distance(camera.project(point).unwrap()) < 1e-9);
        }
    }
}

#[test]
fn what_is_no_calibration_is_refused() {
    for (from, to) in [
        ("size = [1000.0", "size = [-1.0"),
        ("[[1000.0", "[[nan"),
        ("[[1000.0", "[[0.0"),
        ("translation = [0.0", "translation = [1e9"),
        ("rotation = [1.57", "rotation = [inf, 1.57"),
        ("-0.1, 0.02", "1e300, 0.02"),
        ("0.001, -0.001", "1.0, 1.0, 1.0, 1.0"),
        ("frame_rate = 50", "frame_rate = 0"),
        ("[b]", "[b"),
        ("matrix = [[1000.0, 0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]]\ndist", "dist"),
    ] {
        assert!(TWO.contains(from) && read(TWO.replacen(from, to, 1).as_bytes()).is_err(), "{to}");
    }
    assert!(read(b"").is_err() && read(b"\xff").is_err());
}

#[test]
fn the_usual_mistakes_are_named() {
    let rows = "rotation = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]";
    let plain = "rotation = [1.5707963267948966, 0.0, 0.0]";
    let tall = TWO.replace("size = [1000.0, 1000.0]", "size = [1000.0, 2000.0]").replace(", 500.0]", ", 900.0]");
    let right =
        tall.replace("[1000.0, 0.0, 900.0], [0.0, 1000.0, 900.0]", "[1000.0, 0.0, 500.0], [0.0, 1000.0, 1000.0]");
    assert!(read(right.as_bytes()).is_ok());
    assert!(read(TWO.replace(plain, rows).as_bytes()).is_ok());
    let said = |text: &str| read(text.as_bytes()).unwrap_err().problem;
    for (text, words) in [
        (TWO.replace(plain, &rows.replace("-1.0", "1.0")), "left-handed or two columns are exchanged"),
        (TWO.replace(plain, &rows.replace("-1.0", "-1.1")), "no rotation"),
        (TWO.replace("[0.0, 1.0, 3.0]", "[0.0, 1000.0, 3000.0]"), "3.2 m in millimetres; give metres"),
        (right.replace("500.0], [0.0, 1000.0, 1000.0]", "1000.0], [0.0, 1000.0, 500.0]"), "columns are exchanged"),
        (
            TWO.replace(
                "0.0, 500.0], [0.0, 1000.0, 500.0], [0.0, 0.0, 1.0]",
                "0.0, 0.0], [0.0, 1000.0, 0.0], [500.0, 500.0, 1.0]",
            ),
            "transposed",
        ),
    ] {
        assert!(said(&text).contains(words), "{} / {words}", said(&text));
    }
}

#[test]
fn a_camera_of_opencv_is_the_same_camera() {
    let toml = read(TWO.as_bytes()).unwrap().cameras.remove(1);
    let yaml = opencv::read(YAML.as_bytes(), "b").unwrap().remove(0);
    assert_eq!((yaml.name.as_str(), yaml.size), ("b", [1000, 1000]));
    for point in [DVec3::new(0.3, 0.2, 1.1), DVec3::new(-0.9, 0.8, 0.1)] {
        assert!(pixel(&toml, point).distance(pixel(&yaml, point)) < 1e-9);
    }
    let rodrigues = YAML.replace(
        "[ 0., -1., 0., 0., 0., -1., 1., 0., 0. ]",
        "[ 1.2091995761561452, -1.2091995761561452, 1.2091995761561452 ]",
    );
    let (head, tail) = rodrigues.split_once("R: ").unwrap();
    let rodrigues = format!("{head}R: {}", tail.replacen("cols: 3", "cols: 1", 1));
    let again = opencv::read(rodrigues.as_bytes(), "b").unwrap().remove(0);
    assert!(pixel(&again, DVec3::X).distance(pixel(&yaml, DVec3::X)) < 1e-6);
}

#[test]
fn a_stereo_pair_of_opencv_has_its_first_camera_as_the_world() {
    let lens = |n: u8, body: &str| {
        body.replace("camera_matrix", &format!("M{n}")).replace("distortion_coefficients", &format!("D{n}"))
    };
    let (lens_part, pose) = YAML.split_once("R: ").unwrap();
    let text =
        format!("{}{}R: {pose}", lens(1, lens_part), lens(2, lens_part.split_once("image_height: 1000\n").unwrap().1));
    let pair = opencv::read(text.as_bytes(), "pair").unwrap();
    assert_eq!(pair.len(), 2);
    assert_eq!(pair[0].position(), DVec3::ZERO);
    assert_eq!(pair[1], opencv::read(YAML.as_bytes(), "2").unwrap().remove(0));
}

#[test]
fn yaml_that_is_no_calibration_is_refused_with_its_line() {
    for (from, to, words) in [
        ("1000., 0., 500.", "1000., x, 500.", "'x' is no number"),
        ("rows: 5", "rows: 4", "where 4 x 1 are stated"),
        ("camera_matrix", "camera", "it has no camera_matrix"),
        ("0., 0., -1., 1.", "0., 0., 1., 1.", "left-handed"),
        ("[ 0., 1., 3. ]", "[ 0., 900., 3000. ]", "millimetres"),
    ] {
        assert!(YAML.contains(from));
        let error = opencv::read(YAML.replacen(from, to, 1).as_bytes(), "b").unwrap_err();
        assert!(error.problem.contains(words), "{} / {words}", error.problem);
    }
}
