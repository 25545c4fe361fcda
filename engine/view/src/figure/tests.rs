//! Tests of heads and hair.

use glam::{Quat, Vec3};
use toile_base::body::{Body, Measures, Region, Sex};
use toile_base::mesh::vertex_normals;

use super::head_space::{HEIGHT_MM, HeadSpace};
use super::{Appearance, Figure, Hair, SkinTone};
use crate::bvh::{Bvh, Ray};

/// Smallest and largest usual bodies, and the averages.
fn bodies() -> Vec<Body> {
    let sizes = |sex| {
        let average = Measures::average(sex);
        let scaled = |k: f32, g: f32| Measures {
            stature: average.stature * k,
            shoulder_breadth: average.shoulder_breadth * k,
            chest_girth: average.chest_girth * g,
            waist_girth: average.waist_girth * g,
            hip_girth: average.hip_girth * g,
        };
        [scaled(1.0, 1.0), scaled(0.93, 0.92), scaled(1.08, 1.12)].map(|m| toile_assets::body::build(sex, &m).unwrap())
    };
    Sex::ALL.into_iter().flat_map(sizes).collect()
}

fn figure(body: &Body, hair: Hair) -> Figure {
    Figure::of(body, Appearance { hair, ..Appearance::default() })
}

#[test]
fn nothing_moves_but_the_head_and_no_body_becomes_taller() {
    for body in bodies() {
        let figure = figure(&body, Hair::None);
        assert_eq!(figure.rest.len(), body.mesh.positions.len());
        assert_eq!(figure.triangles, body.mesh.triangles);
        let below = |v: &usize| body.regions[*v] != Region::Head;
        for v in (0..figure.rest.len()).filter(below) {
            assert_eq!(figure.rest[v].to_array(), body.mesh.positions[v].to_array(), "vertex {v}");
        }
        let stature = |points: &[Vec3]| points.iter().map(|p| p.y).fold(f32::MIN, f32::max);
        assert_eq!(stature(&figure.rest).to_bits(), stature(&body.mesh.positions).to_bits());
        let lowest = |points: &[Vec3]| {
            let head = points.iter().zip(&body.regions).filter(|(_, r)| **r == Region::Head);
            head.map(|(p, _)| p.y).fold(f32::MAX, f32::min)
        };
        let chin = lowest(&figure.rest) - lowest(&body.mesh.positions);
        assert!(chin.abs() < 0.005, "the chin is {chin} m off");
    }
}

#[test]
fn a_head_is_a_smooth_egg_with_a_hint_of_a_nose() {
    for body in bodies() {
        let (figure, space) = (figure(&body, Hair::None), HeadSpace::of(&body).unwrap());
        assert!(figure.rest.iter().chain(&figure.normals).all(|p| p.is_finite()));
        let at: Vec<Vec3> = figure.rest.iter().map(|p| space.inwards(*p)).collect();
        let shape = Bvh::build(body.mesh.triangles.iter().map(|t| t.map(|v| at[v as usize])));
        // Rays in a plane across the head meet it once a side, and the outline is hollow nowhere.
        for level in [-70.0_f32, -100.0, -115.0, -130.0, -150.0, -175.0, -200.0] {
            let middle = Vec3::new(0.0, level, if level < -160.0 { 45.0 } else { 20.0 });
            let around = |i: usize| {
                let turn = (i as f32 - 20.0) * 0.06;
                let toward = Vec3::new(turn.sin(), 0.0, turn.cos());
                let out = shape.closest(&Ray::new(middle, toward), 200.0).expect("the head is closed").distance;
                let back = shape.closest(&Ray::new(middle + toward * 200.0, -toward), 200.0).unwrap().distance;
                assert!((200.0 - back - out).abs() < 0.05, "a fold at {level}, {turn}: {out} and {}", 200.0 - back);
                middle + toward * out
            };
            let outline: Vec<Vec3> = (0..41).map(around).collect();
            let deep = hollow(&outline);
            assert!(deep < 2.0, "{deep} mm deep at {level}");
        }
        let ahead = |y: f32| shape.closest(&Ray::new(Vec3::new(0.0, y, 300.0), Vec3::NEG_Z), 300.0).unwrap().distance;
        let nose = ahead(-172.0) - ahead(-147.0);
        assert!((2.0..16.0).contains(&nose), "the nose stands out {nose} mm");
    }
}

/// How far an outline lies beneath the chords of its points at most (mm); it runs from right to left around the front.
fn hollow(outline: &[Vec3]) -> f32 {
    let mut deepest = 0.0f32;
    for (i, a) in outline.iter().enumerate() {
        for (k, b) in outline.iter().enumerate().skip(i + 2) {
            let across = (*b - *a).normalize();
            let out = across.cross(Vec3::Y);
            let over = || outline[i + 1..k].iter().map(|p| (*p - *a).dot(out));
            if over().all(|d| d < 0.0) {
                deepest = over().map(|d| -d).fold(deepest, f32::max);
            }
        }
    }
    deepest
}

#[test]
fn no_face_of_a_head_lies_upside_down() {
    for body in bodies() {
        let figure = figure(&body, Hair::None);
        let mut normals = vec![Vec3::ZERO; figure.rest.len()];
        vertex_normals(&figure.rest, &figure.triangles, &mut normals);
        let is_head = |t: &&[u32; 3]| t.iter().all(|v| body.regions[*v as usize] == Region::Head);
        let flipped = body.mesh.triangles.iter().filter(is_head).filter(|t| {
            let [a, b, c] = t.map(|v| figure.rest[v as usize]);
            (b - a).cross(c - a).dot(t.iter().map(|v| figure.normals[*v as usize]).sum()) < 0.0
        });
        assert_eq!(flipped.count(), 0);
    }
}

#[test]
fn both_sides_of_a_head_are_alike() {
    for body in bodies() {
        let (plain, space) = (figure(&body, Hair::None), HeadSpace::of(&body).unwrap());
        let drawn = Bvh::build(plain.triangles.iter().map(|t| t.map(|v| space.inwards(plain.rest[v as usize]))));
        for i in 0..200 {
            let (turn, y) = (0.1 + i as f32 * 0.015, -20.0 - i as f32 * 0.9);
            let out = |side: f32| {
                let toward = Vec3::new(side * turn.sin(), 0.0, turn.cos());
                drawn.closest(&Ray::new(Vec3::new(0.0, y, 20.0), toward), 300.0).map(|hit| hit.distance)
            };
            let (Some(left), Some(right)) = (out(1.0), out(-1.0)) else { panic!("a hole at {turn}, {y}") };
            assert!((left - right).abs() < 0.3, "{left} and {right} mm at {turn}, {y}");
        }
    }
}

#[test]
fn hair_covers_the_scalp_and_not_the_face_and_ends_above_the_shoulders() {
    for body in bodies() {
        let space = HeadSpace::of(&body).unwrap();
        for hair in [Hair::Short, Hair::Bob, Hair::Bun] {
            let figure = figure(&body, hair);
            let first = body.mesh.positions.len();
            let (skin, cap) = figure.triangles.split_at(body.mesh.triangles.len());
            assert!(
                cap.iter().flatten().all(|v| *v as usize >= first)
                    && figure.look.corners.len() == figure.triangles.len()
            );
            assert!(figure.rest.iter().chain(&figure.normals).all(|p| p.is_finite()));
            let mesh = |faces: &[[u32; 3]]| {
                Bvh::build(faces.iter().map(|t| t.map(|v| space.inwards(figure.rest[v as usize]))))
            };
            let (skin, cap) = (mesh(skin), mesh(cap));
            // From above and behind, hair is met before the scalp; from before, the face is.
            for (from, covered) in SCALP.into_iter().map(|p| (p, true)).chain(FACE.into_iter().map(|p| (p, false))) {
                let toward = (from - Vec3::new(0.0, -95.0, 4.0)).normalize();
                let ray = Ray::new(Vec3::new(0.0, -95.0, 4.0) + toward * 300.0, -toward);
                let distance = |mesh: &Bvh| mesh.closest(&ray, 300.0).map_or(f32::MAX, |hit| hit.distance);
                assert_eq!(distance(&cap) < distance(&skin), covered, "{hair}: {from}");
            }
            let lowest = figure.rest[first..].iter().map(|p| space.inwards(*p).y).fold(f32::MAX, f32::min);
            assert!(lowest > -HEIGHT_MM, "{hair} hangs down to {lowest} mm, onto the shoulders");
        }
    }
}

/// Places on every scalp and on every face (mm, of the head's space).
const SCALP: [Vec3; 6] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(20.0, -15.0, 40.0),
    Vec3::new(-20.0, -15.0, 40.0),
    Vec3::new(60.0, -60.0, 0.0),
    Vec3::new(-60.0, -60.0, -30.0),
    Vec3::new(0.0, -110.0, -80.0),
];
const FACE: [Vec3; 4] = [
    Vec3::new(0.0, -110.0, 100.0),
    Vec3::new(30.0, -110.0, 90.0),
    Vec3::new(-30.0, -130.0, 90.0),
    Vec3::new(0.0, -185.0, 95.0),
];

#[test]
fn head_and_hair_follow_a_skin_that_turns() {
    let body = &bodies()[0];
    let figure = figure(body, Hair::Bob);
    let (turn, way) = (Quat::from_euler(glam::EulerRot::YXZ, 0.7, -0.4, 0.2), Vec3::new(0.3, -0.1, 1.2));
    let mut at: Vec<Vec3> = body.mesh.positions.iter().map(|p| turn * *p + way).collect();
    let mut normals: Vec<Vec3> = body.normals.iter().map(|n| turn * *n).collect();
    at.resize(figure.rest.len(), Vec3::ZERO);
    normals.resize(figure.rest.len(), Vec3::ZERO);
    figure.head.place(&mut at, &mut normals);
    for v in 0..at.len() {
        assert!(at[v].distance(turn * figure.rest[v] + way) < 2e-5, "vertex {v}");
        assert!(normals[v].distance(turn * figure.normals[v]) < 1e-3, "normal {v}");
    }
}

#[test]
fn a_body_by_others_keeps_its_head_and_takes_the_tone() {
    let mut body = bodies().remove(0);
    body.mesh.triangles.swap(0, 1);
    let figure = Figure::of(&body, Appearance { skin: SkinTone::Umber, hair: Hair::Bob });
    assert_eq!((&figure.rest, &figure.normals), (&body.mesh.positions, &body.normals));
    assert_eq!(figure.colour, SkinTone::Umber.colour());
    assert_eq!(figure.head.hair(), 0);
    let mut at = body.mesh.positions.clone();
    figure.head.place(&mut at, &mut body.normals.clone());
    assert_eq!(at, body.mesh.positions);
}

#[test]
fn tones_are_told_apart_and_lie_between_black_and_white() {
    let light = |tone: SkinTone| tone.colour().dot(Vec3::new(0.2126, 0.7152, 0.0722));
    let tones = &SkinTone::ALL[1..];
    assert!(tones.windows(2).all(|pair| light(pair[0]) > 1.25 * light(pair[1])));
    assert!(tones.iter().all(|tone| (0.03..0.75).contains(&light(*tone))));
}

#[test]
fn unknown_names_are_refused_with_the_nearest() {
    let sentence = "sandy".parse::<SkinTone>().unwrap_err().to_string();
    assert_eq!(sentence, "no skin tone is called \"sandy\"; did you mean \"sand\"?");
    let sentence = "mohawk".parse::<Hair>().unwrap_err().to_string();
    assert_eq!(sentence, "no hair is called \"mohawk\"; choose one of none, short, bob, bun");
    assert!(Hair::ALL.into_iter().all(|hair| hair.name().parse() == Ok(hair)));
    assert!(SkinTone::ALL.into_iter().all(|tone| tone.name().parse() == Ok(tone)));
}
