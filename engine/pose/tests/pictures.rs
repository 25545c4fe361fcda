//! Pictures other than one person who stands before a webcam: the result of each is defined, and never a stretched body.
//!
//! The network's files are no part of the repository: where they are not fetched, these tests say so and do not run.

use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};
use toile_base::body::Sex;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::Joint;
use toile_base::skeleton::Joint::*;
use toile_pose::joints::JointPlacer;
use toile_pose::landmarks::Landmarks;
use toile_pose::scale::WebcamMount;
use toile_pose::tracker::{PoseModel, PoseTracker};
use toile_sensors::source::live::ColourImage;

use crate::common::network_folder;

const STANDING: &[u8] = include_bytes!("data/standing.png");

/// Time between two pictures (ns).
const PERIOD_NS: u64 = 33_000_000;

/// Grey of the wall behind the person of the data.
const WALL: Rgb<u8> = Rgb([184, 183, 180]);

/// The person with some wall around, so many pixels tall.
fn person(side: u32) -> RgbImage {
    let person = image::load_from_memory(STANDING).unwrap().to_rgb8();
    imageops::resize(&person, side * person.width() / person.height(), side, FilterType::Triangle)
}

fn wall(width: u32, height: u32) -> RgbImage {
    RgbImage::from_pixel(width, height, WALL)
}

fn with(mut picture: RgbImage, who: &RgbImage, x: i64, y: i64) -> RgbImage {
    imageops::overlay(&mut picture, who, x, y);
    picture
}

fn picture(image: RgbImage) -> ColourImage {
    ColourImage { width: image.width(), height: image.height(), rgb: image.into_raw() }
}

fn tracker() -> Option<PoseTracker> {
    Some(PoseTracker::load(&network_folder()?, PoseModel::Lite, false).unwrap())
}

/// What is seen in so many pictures, one after the other.
fn seen(tracker: &mut PoseTracker, shown: &ColourImage, count: u64) -> Vec<Option<Landmarks>> {
    (0..count).map(|i| tracker.push(shown, i * PERIOD_NS).unwrap()).collect()
}

/// Middle of the hips (px).
fn hips(landmarks: &Landmarks) -> [f32; 2] {
    ((landmarks.points[23].pixel + landmarks.points[24].pixel) * 0.5).to_array()
}

/// No limb of what would be shown is longer or shorter than it is in a body.
fn is_whole(landmarks: &Landmarks, size: [u32; 2]) {
    let limbs: [([Joint; 2], [f32; 2]); 8] = [
        ([LeftShoulder, LeftElbow], [0.22, 0.36]),
        ([RightShoulder, RightElbow], [0.22, 0.36]),
        ([LeftElbow, LeftWrist], [0.18, 0.32]),
        ([RightElbow, RightWrist], [0.18, 0.32]),
        ([LeftHip, LeftKnee], [0.30, 0.50]),
        ([RightHip, RightKnee], [0.30, 0.50]),
        ([LeftKnee, LeftAnkle], [0.30, 0.50]),
        ([RightKnee, RightAnkle], [0.30, 0.50]),
    ];
    let joints = JointPlacer::new(Sex::Female, WebcamMount::default()).joints(landmarks, size, 1.68, 0);
    assert!(joints.is_valid());
    for ([from, to], [least, most]) in limbs {
        if let (Some(a), Some(b)) = (joints.believed(from), joints.believed(to)) {
            assert!((least..=most).contains(&a.distance(b)), "{from:?} to {to:?}: {} m", a.distance(b));
        }
    }
}

#[test]
fn a_person_is_found_once_and_then_followed() {
    let Some(mut tracker) = tracker() else { return };
    let shown = picture(with(wall(640, 480), &person(440), 200, 20));
    let all = seen(&mut tracker, &shown, 10);
    assert!(all.iter().all(Option::is_some));
    assert_eq!((tracker.counts.searched, tracker.counts.followed), (1, 10));
    let [x, y] = hips(all[9].as_ref().unwrap());
    assert!((x - 337.0).abs() < 20.0 && (y - 245.0).abs() < 30.0, "{x} {y}");
    is_whole(all[9].as_ref().unwrap(), [640, 480]);
    // They leave, and come back elsewhere.
    assert!(seen(&mut tracker, &picture(wall(640, 480)), 3).iter().all(Option::is_none));
    let all = seen(&mut tracker, &picture(with(wall(640, 480), &person(440), 20, 20)), 3);
    assert!(hips(all[2].as_ref().unwrap())[0] < 200.0);
}

#[test]
fn empty_black_and_noisy_pictures_show_no_person() {
    let Some(mut tracker) = tracker() else { return };
    let mut random = SplitMix64::new(4);
    let noise = RgbImage::from_fn(640, 480, |_, _| Rgb([0; 3].map(|_: u8| random.next_u64() as u8)));
    let stripes = RgbImage::from_fn(640, 480, |x, _| Rgb([if x / 20 % 2 == 0 { 230 } else { 30 }; 3]));
    for empty in [wall(640, 480), RgbImage::new(640, 480), noise, stripes, wall(1, 1), wall(4096, 2)] {
        assert!(seen(&mut tracker, &picture(empty), 3).iter().all(Option::is_none));
    }
}

#[test]
fn of_three_people_only_the_nearest_is_followed() {
    let Some(mut tracker) = tracker() else { return };
    let (large, small) = (person(460), person(300));
    let three = with(with(with(wall(960, 480), &small, 40, 150), &large, 330, 10), &small, 720, 150);
    let shown = picture(three);
    for landmarks in seen(&mut tracker, &shown, 10).into_iter().skip(2) {
        let landmarks = landmarks.expect("a person is seen");
        assert!((400.0..560.0).contains(&hips(&landmarks)[0]), "{:?}", hips(&landmarks));
        is_whole(&landmarks, [960, 480]);
    }
    assert!(tracker.counts.searched <= 3, "{:?}", tracker.counts);
}

#[test]
fn a_photograph_on_a_shirt_is_not_who_wears_it() {
    let Some(mut tracker) = tracker() else { return };
    let worn = with(person(460), &person(80), 119, 130);
    let shown = picture(with(wall(640, 480), &worn, 190, 10));
    for landmarks in seen(&mut tracker, &shown, 10) {
        let landmarks = landmarks.expect("a person is seen");
        let tall = landmarks.points[27].pixel.y - landmarks.points[0].pixel.y;
        assert!(tall > 280.0, "who is {tall} pixels tall is the photograph");
        is_whole(&landmarks, [640, 480]);
    }
}

#[test]
fn of_a_cut_person_only_seen_parts_count() {
    let Some(mut tracker) = tracker() else { return };
    let large = person(800);
    // The legs, the head, one half are outside of the picture.
    for (x, y) in [(120, 10), (120, -330), (-230, -20)] {
        let shown = picture(with(wall(640, 480), &large, x, y));
        for landmarks in seen(&mut tracker, &shown, 6).iter().flatten() {
            is_whole(landmarks, [640, 480]);
            let outside =
                |p: &toile_pose::landmarks::PoseLandmark| !(0.0..=640.0).contains(&p.pixel.x) || p.pixel.y < 0.0;
            for point in landmarks.points.iter().filter(|p| outside(p)) {
                assert!(point.confidence < 0.5, "{point:?}");
            }
        }
    }
}

#[test]
fn a_picture_that_changes_its_size_is_searched_anew() {
    let Some(mut tracker) = tracker() else { return };
    let small = picture(with(wall(640, 480), &person(440), 200, 20));
    let large = picture(with(wall(1280, 720), &person(660), 800, 30));
    seen(&mut tracker, &small, 3);
    let all = seen(&mut tracker, &large, 3);
    assert_eq!(tracker.counts.searched, 2);
    let landmarks = all[0].as_ref().unwrap();
    assert!(hips(landmarks)[0] > 900.0, "{:?}", hips(landmarks));
    is_whole(landmarks, [1280, 720]);
}

#[test]
fn pictures_of_no_size_too_many_pixels_or_other_bytes_are_refused() {
    let Some(mut tracker) = tracker() else { return };
    let refused = |tracker: &mut PoseTracker, width: u32, height: u32, bytes: usize| {
        let shown = ColourImage { width, height, rgb: vec![0; bytes] };
        tracker.push(&shown, 0).unwrap_err().to_string()
    };
    assert!(refused(&mut tracker, 0, 480, 0).starts_with("a picture has no pixels; choose"));
    let large = refused(&mut tracker, 16_000, 16_000, 0);
    assert!(large.starts_with("a picture of 16000 x 16000 pixels is larger than 8192 a side"), "{large}");
    assert!(refused(&mut tracker, 8_000, 8_000, 0).contains("12000000 in all"));
    assert!(refused(&mut tracker, 4, 4, 47).contains("has 47 bytes"));
}
