//! The shopper is found in everything that a depth camera sees, and no other person is ever in the mask.

use glam::{Quat, Vec3};
use toile_base::body::{Body, Measures, Sex};
use toile_base::clock::SECOND_NS;
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_sensors::depth::{Clean, Validity};
use toile_sensors::segment::{Segmenter, Zone};
use toile_sensors::source::synthetic::room::{self, PERSON, RoomView};
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};
use toile_sensors::source::{OpenOptions, open};

use crate::common::data;

fn camera() -> SyntheticCamera {
    SyntheticCamera::looking_at(Intrinsics::KINECT_V1, Vec3::new(0.0, 1.2, 2.5), Vec3::new(0.0, 0.9, 0.0))
}

/// Two people of other sizes.
struct Two([Body; 2]);

impl Two {
    fn new() -> Self {
        Self([Sex::Female, Sex::Male].map(|sex| toile_assets::body::build(sex, &Measures::average(sex)).unwrap()))
    }

    /// Both where they stand (m) and how they are turned about the vertical (rad).
    fn seen(&self, at: &[(Vec3, f32)]) -> RoomView {
        let placed: Vec<Vec<Vec3>> = at
            .iter()
            .zip(&self.0)
            .map(|((to, turn), body)| {
                body.mesh.positions.iter().map(|p| Quat::from_rotation_y(*turn) * *p + *to).collect()
            })
            .collect();
        let surfaces: Vec<room::RoomSurface<'_>> =
            placed.iter().zip(&self.0).map(|(p, body)| (&p[..], &body.mesh.triangles[..])).collect();
        room::view(&camera(), -0.9, &surfaces)
    }
}

fn noisy(view: &RoomView, frame: u64) -> DepthFrame {
    let camera = camera();
    let depth = KinectNoise::new(17 + frame).apply(&camera.intrinsics, &view.z);
    camera.frame(frame * SECOND_NS / 30, depth)
}

/// Of a mask: pixels of anything but the first person, farther than 4 px from them (the noise shifts outlines by up to 3), and the share of them that is missed.
fn errors(view: &RoomView, frame: &DepthFrame, mask: &[u8]) -> (usize, f32) {
    let k = frame.intrinsics;
    let (width, height) = (k.width as isize, k.height as isize);
    let near = |i: usize| {
        let (u, v) = (i as isize % width, i as isize / width);
        (-4..=4).any(|dv| {
            (-4..=4).any(|du| {
                let (x, y) = (u + du, v + dv);
                x >= 0 && y >= 0 && x < width && y < height && view.label[(y * width + x) as usize] == PERSON
            })
        })
    };
    let leaked = (0..mask.len()).filter(|i| mask[*i] == 1 && !near(*i)).count();
    let shown: Vec<usize> = (0..mask.len()).filter(|i| view.label[*i] == PERSON && frame.depth_mm[*i] != 0).collect();
    let missed = shown.iter().filter(|i| mask[**i] == 0).count();
    (leaked, missed as f32 / shown.len().max(1) as f32)
}

#[test]
fn only_the_shopper_is_found_and_completely() {
    let two = Two::new();
    let behind = |x: f32, z: f32| (Vec3::new(x, 0.0, z), 0.3);
    let shopper = (Vec3::ZERO, 0.0);
    let cases: [(&str, &[(Vec3, f32)]); 8] = [
        ("alone", &[shopper]),
        ("turned", &[(Vec3::ZERO, 1.2)]),
        ("behind", &[shopper, behind(0.3, -0.55)]),
        ("beside", &[shopper, behind(1.0, 0.0)]),
        ("hands touching", &[shopper, (Vec3::new(1.0, 0.0, 0.0), 0.0)]),
        ("arms crossing", &[shopper, (Vec3::new(0.85, 0.0, 0.0), 0.0)]),
        ("hands crossing", &[shopper, (Vec3::new(0.92, 0.0, 0.0), 0.0)]),
        ("nearer, outside the zone", &[shopper, behind(0.9, 0.5)]),
    ];
    for (name, people) in cases {
        let view = two.seen(people);
        let frame = noisy(&view, 0);
        let mut segmenter = Segmenter::default();
        let found = segmenter.push(&frame);
        let (leaked, missed) = errors(&view, &frame, found.mask);
        let pixels = found.mask.iter().filter(|m| **m == 1).count();
        println!(
            "{name}: {pixels} px, {leaked} leaked, {:.2} % missed, {} others, floor {:?}, {:?}",
            missed * 100.0,
            found.others,
            found.floor,
            found.shopper
        );
        assert!(found.shopper.is_some(), "{name}");
        assert_eq!(found.others, people.len() - 1, "{name}");
        // Known to fall short: where hands cross, a few pixels of the other's fingertips lie beyond what is given up.
        assert!(leaked <= if name == "hands crossing" { 20 } else { 0 }, "{name}: {leaked}");
        // Turned, the far arm shows behind the chest and apart from it, as an arm of a person hidden there would; and
        // an arm that touches another person's is given up altogether. Beside each other, the two have their hands a few
        // centimetres apart.
        let most = match name {
            "turned" => 0.09,
            "beside" => 0.05,
            "hands touching" => 0.13,
            "hands crossing" => 0.17,
            "arms crossing" => 0.24,
            _ => 0.04,
        };
        assert!(missed < most, "{name}: {missed}");
        let floor = found.floor.unwrap();
        assert!((floor.height - 1.2).abs() < 0.01, "{name}: {floor:?}");
    }
}

#[test]
fn a_forearm_before_the_hips_makes_no_two_people_of_one() {
    let two = Two::new();
    // From the side, legs alone are too slim to be a person.
    for turn in [0.0, 0.5 * std::f32::consts::PI] {
        both_halves_are_kept(noisy(&two.seen(&[(Vec3::ZERO, turn)]), 0));
    }
}

fn both_halves_are_kept(mut frame: DepthFrame) {
    let (k, to_world) = (frame.intrinsics, frame.camera_to_world);
    let width = k.width as usize;
    let world = |i: usize, mm: u16| {
        to_world.transform_point3(k.unproject((i % width) as f32, (i / width) as f32, f32::from(mm) * 1e-3))
    };
    // Across the whole breadth of the body and 35 cm before it, so that it parts what is above from what is below.
    let before = Vec3::new(0.0, 0.0, 0.35);
    for i in 0..frame.depth_mm.len() {
        let place = world(i, frame.depth_mm[i]);
        if frame.depth_mm[i] != 0 && (0.84..0.93).contains(&place.y) && place.x.abs() < 0.5 && place.z > -0.4 {
            frame.depth_mm[i] -= (before.z * 1e3) as u16;
        }
    }
    let mut segmenter = Segmenter::default();
    let found = segmenter.push(&frame);
    assert!(found.shopper.is_some() && found.others == 0, "{:?}, {} others", found.shopper, found.others);
    let kept = |from: f32, to: f32| {
        let shown = (0..frame.depth_mm.len()).filter(|i| (from..to).contains(&world(*i, frame.depth_mm[*i]).y));
        shown.filter(|i| found.mask[*i] == 1).count()
    };
    assert!(kept(1.1, 1.4) > 1_500 && kept(0.3, 0.7) > 1_500, "{} above, {} below", kept(1.1, 1.4), kept(0.3, 0.7));
}

#[test]
fn a_passer_by_does_not_become_the_shopper() {
    let two = Two::new();
    for z in [-0.6, 0.9] {
        let mut segmenter = Segmenter::default();
        let (mut seen, mut leaks) = (0, 0);
        for step in 0..14u64 {
            let x = 1.6 - 0.25 * step as f32;
            let view = two.seen(&[(Vec3::ZERO, 0.0), (Vec3::new(x, 0.0, z), 0.3)]);
            let frame = noisy(&view, step);
            let found = segmenter.push(&frame);
            let (leaked, missed) = errors(&view, &frame, found.mask);
            println!(
                "z {z} x {x:.2}: {leaked} leaked, {:.1} % missed, {:?}",
                missed * 100.0,
                found.shopper.map(|s| s.place)
            );
            seen += usize::from(found.shopper.is_some());
            leaks += leaked;
        }
        assert_eq!(leaks, 0, "the other at z = {z}");
        // Passing in front hides the shopper for a while; behind, never.
        assert!(seen >= if z < 0.0 { 14 } else { 7 }, "z {z}: seen in {seen} frames");
    }
}

#[test]
fn an_empty_room_shows_only_its_floor() {
    let two = Two::new();
    let view = two.seen(&[]);
    let found_in = |zone: Zone| {
        let mut segmenter = Segmenter::new(zone);
        let found = segmenter.push(&noisy(&view, 0));
        (found.shopper, found.others, found.floor, found.mask.iter().all(|m| *m == 0))
    };
    let (shopper, others, floor, empty) = found_in(Zone::default());
    assert!(shopper.is_none() && others == 0 && floor.is_some() && empty);
}

#[test]
fn a_person_outside_the_zone_is_no_shopper() {
    let two = Two::new();
    let view = two.seen(&[(Vec3::new(1.0, 0.0, 0.0), 0.0)]);
    let mut segmenter = Segmenter::new(Zone { half_width: 0.5, ..Zone::default() });
    let found = segmenter.push(&noisy(&view, 0));
    assert!(
        found.shopper.is_none() && found.others == 1 && found.mask.iter().all(|m| *m == 0),
        "{:?} {}",
        found.shopper,
        found.others
    );
}

#[test]
fn the_mask_of_who_stands_still_does_not_flicker() {
    let two = Two::new();
    let view = two.seen(&[(Vec3::ZERO, 0.0)]);
    let inside: Vec<usize> = (0..view.label.len()).filter(|i| view.label[*i] == PERSON).collect();
    let mut segmenter = Segmenter::default();
    let mut masks: Vec<Vec<u8>> = Vec::new();
    let mut frames = Vec::new();
    for i in 0..6 {
        let frame = noisy(&view, i);
        masks.push(segmenter.push(&frame).mask.to_vec());
        frames.push(frame);
    }
    // Where both frames measured the shopper, the mask changes at less than 1 % of their pixels.
    for (masks, frames) in masks.windows(2).zip(frames.windows(2)).skip(1) {
        let both = |i: &&usize| frames.iter().all(|f| (f32::from(f.depth_mm[**i]) * 1e-3 - view.z[**i]).abs() < 0.05);
        let changed = inside.iter().filter(both).filter(|i| masks[0][**i] != masks[1][**i]).count();
        println!("{changed} of {} pixels changed", inside.len());
        assert!((changed as f32) < 0.01 * inside.len() as f32);
    }
    // The same frames give the same masks.
    let mut again = Segmenter::default();
    assert!(frames.iter().zip(&masks).all(|(f, m)| again.push(f).mask == m));
}

#[test]
fn the_cloud_lies_on_the_body_and_faces_the_camera() {
    let two = Two::new();
    let view = two.seen(&[(Vec3::ZERO, 0.0)]);
    let frame = noisy(&view, 0);
    let mut clean = Clean::default();
    let (shopper, cloud) = clean.push(&frame);
    assert!(shopper.is_some());
    let truth = camera();
    let (mut squares, mut raw, mut count, mut facing) = (0.0f64, 0.0f64, 0.0, 0);
    for (i, point, normal) in cloud.known() {
        let z = truth.camera_to_world.inverse().transform_point3(point).z;
        if view.label[i] != PERSON || cloud.validity[i] != Validity::Measured || (z - view.z[i]).abs() > 0.05 {
            continue;
        }
        squares += f64::from(z - view.z[i]).powi(2);
        raw += f64::from(f32::from(frame.depth_mm[i]) * 1e-3 - view.z[i]).powi(2);
        count += 1.0;
        facing += usize::from(normal.dot(truth.camera_to_world.translation.into()) > 0.0 || normal == Vec3::ZERO);
    }
    let [rms, before] = [squares, raw].map(|s| (s / count).sqrt() * 1e3);
    println!("{count} points: {before:.2} mm before, {rms:.2} mm after");
    assert!(count > 22_000.0 && rms < 0.55 * before, "{count} {rms} {before}");
    assert!(facing as f64 > 0.97 * count, "{facing} of {count}");
}

#[test]
fn real_frames_show_the_person_in_front_alone() {
    let Some(folder) = data() else { return };
    let mut seen = 0;
    for entry in std::fs::read_dir(folder.join("depth/skeltrack")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "u16le") {
            continue;
        }
        let session = open(&path, &OpenOptions::default()).unwrap();
        let frame = &session.depth[0];
        let mut segmenter = Segmenter::default();
        let found = segmenter.push(frame);
        let masked: Vec<u16> =
            frame.depth_mm.iter().zip(found.mask).filter(|(_, m)| **m == 1).map(|(d, _)| *d).collect();
        let far = masked.iter().max().copied().unwrap_or(0);
        let share = masked.len() as f32 / frame.valid_pixels() as f32;
        println!(
            "{}: {:.1} % kept, to {far} mm, others {}, {:?}",
            session.name,
            share * 100.0,
            found.others,
            found.shopper
        );
        assert!(found.shopper.is_some() && found.floor.is_none(), "{}", session.name);
        // The one behind stands beyond 1.9 m; all others are alone.
        let behind = session.name.contains("1399145206");
        assert!(far < 1_900 && if behind { share < 0.95 } else { share > 0.97 }, "{}: {far} {share}", session.name);
        seen += 1;
    }
    assert_eq!(seen, 8);
}

#[test]
fn a_mug_is_not_a_person() {
    let Some(folder) = data() else { return };
    let session = open(&folder.join("depth/pyk4a-azure-mkv/recording.mkv"), &OpenOptions::default()).unwrap();
    let mut clean = Clean::default();
    let (shopper, cloud) = clean.push(&session.depth[0]);
    assert!(shopper.is_none() && cloud.known().count() == 0, "{shopper:?}");
}

#[test]
fn the_standing_woman_is_the_shopper() {
    let Some(folder) = data() else { return };
    let folder = folder.join("depth/depthkit-chae/derived");
    let options = OpenOptions { camera: Some(folder.join("chae_depth_camera.json")) };
    let session = open(&folder.join("chae_depth_mm_1024x512.u16le"), &options).unwrap();
    let frame = &session.depth[0];
    let mut segmenter = Segmenter::default();
    let found = segmenter.push(frame);
    let kept = found.mask.iter().filter(|m| **m == 1).count();
    println!("{kept} of {} pixels, {:?} {:?}", frame.valid_pixels(), found.shopper, found.floor);
    assert!(found.shopper.is_some_and(|s| (1.7..1.9).contains(&s.top)), "{:?}", found.shopper);
    assert!(kept as f32 > 0.98 * frame.valid_pixels() as f32);
}
