//! Tests that every mannequin keeps.

use std::collections::BTreeMap;
use std::f32::consts::TAU;

use glam::{DVec3, Vec3};

use super::*;
use toile_base::body::{Body, Measures, Region, Sex};
use toile_base::mesh::Mesh;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::{BONES, JOINTS, Joint, TWISTS, bone_joint};

/// A person like those of ANSUR II: girths that follow one another, by its deviations.
fn random_person(sex: Sex, random: &mut SplitMix64) -> Measures {
    let mean = Measures::average(sex);
    let [stature, shoulder, chest, waist, hip] = match sex {
        Sex::Female => [0.0642, 0.0183, 0.0827, 0.0999, 0.0759],
        Sex::Male => [0.0686, 0.0192, 0.0874, 0.1117, 0.0767],
    };
    let stout = random.gaussian().clamp(-3.5, 3.5);
    let mut like = || 0.8 * stout + 0.6 * random.gaussian().clamp(-3.5, 3.5);
    Measures {
        chest_girth: mean.chest_girth + chest * like(),
        waist_girth: (mean.waist_girth + waist * like()).max(0.5),
        hip_girth: mean.hip_girth + hip * like(),
        stature: mean.stature + stature * random.gaussian().clamp(-3.5, 3.5),
        shoulder_breadth: mean.shoulder_breadth + shoulder * random.gaussian().clamp(-3.5, 3.5),
    }
}

fn average(sex: Sex) -> Body {
    build(sex, &Measures::average(sex)).unwrap()
}

fn small_and_large() -> [Body; 4] {
    let of = |sex, [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth]: [f32; 5]| {
        build(sex, &Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth }).unwrap()
    };
    [
        of(Sex::Female, [1.50, 0.33, 0.76, 0.60, 0.84]),
        of(Sex::Female, [1.65, 0.38, 1.25, 1.15, 1.30]),
        of(Sex::Male, [1.65, 0.37, 0.82, 0.68, 0.84]),
        of(Sex::Male, [1.95, 0.45, 1.30, 1.30, 1.25]),
    ]
}

fn worst(wanted: &Measures, read: &Measures) -> f32 {
    let five = |m: &Measures| [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth];
    five(wanted).iter().zip(five(read)).map(|(w, r)| (w - r).abs()).fold(0.0, f32::max)
}

#[test]
fn mesh_is_one_closed_surface() {
    for body in [average(Sex::Female), average(Sex::Male)].iter().chain(&small_and_large()) {
        let mesh = &body.mesh;
        assert!((12_000..=20_000).contains(&mesh.triangles.len()), "{}", mesh.triangles.len());
        let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for t in &mesh.triangles {
            for k in 0..3 {
                *sides.entry((t[k], t[(k + 1) % 3])).or_default() += 1;
            }
        }
        assert!(sides.iter().all(|(&(a, b), &n)| n == 1 && sides.contains_key(&(b, a))), "each edge once each way");
        let edges = sides.len() / 2;
        assert_eq!(mesh.positions.len() + mesh.triangles.len(), edges + 2, "a sphere's topology");
        let volume: f32 = mesh.triangles.iter().map(|t| tetrahedron(mesh, t)).sum();
        assert!(volume > 0.02 && volume < 0.25, "{volume} m^3");
        assert!(mesh.positions.iter().all(|p| p.is_finite() && p.y >= 0.0));
        assert!(mesh.positions.iter().any(|p| p.y < 1e-3), "the feet touch the floor");
        assert!(body.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
    }
}

fn tetrahedron(mesh: &Mesh, t: &[u32; 3]) -> f32 {
    let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
    a.dot(b.cross(c)) / 6.0
}

#[test]
fn average_weighs_what_ansur_weighs() {
    // ANSUR II: 67.8 and 85.5 kg at about 1,010 kg/m^3; our waists are slimmer than its navels.
    for (sex, kilograms) in [(Sex::Female, 67.8), (Sex::Male, 85.5)] {
        let body = average(sex);
        let weight = 1010.0 * body.mesh.triangles.iter().map(|t| tetrahedron(&body.mesh, t)).sum::<f32>();
        assert!((weight / kilograms - 1.0).abs() < 0.12, "{sex:?}: {weight} kg");
    }
}

#[test]
fn topology_does_not_depend_on_size_or_sex() {
    let first = average(Sex::Female);
    for body in small_and_large() {
        assert_eq!(body.mesh.triangles, first.mesh.triangles);
        assert_eq!(body.mesh.positions.len(), first.mesh.positions.len());
        assert_eq!(body.regions, first.regions);
    }
}

/// The same bone on the other side: twist bones of the left side come before those of the right.
fn bone_mirror(bone: usize) -> usize {
    let side = (BONES - JOINTS) / 2;
    match bone {
        0..JOINTS => Joint::ALL[bone].mirror().index(),
        _ if bone < JOINTS + side => bone + side,
        _ => bone - side,
    }
}

#[test]
fn body_is_symmetric_with_its_weights() {
    for body in [average(Sex::Female), average(Sex::Male)] {
        let mirror = mirrors(&body);
        let share = |v: usize, bone: usize| -> f32 {
            let w = &body.weights[v];
            (0..4).filter(|&k| usize::from(w.bones[k]) == bone).map(|k| w.weights[k]).sum()
        };
        for (v, &other) in mirror.iter().enumerate() {
            for bone in 0..BONES {
                let mirrored = share(other, bone_mirror(bone));
                assert!((share(v, bone) - mirrored).abs() < 1e-3, "vertex {v} bone {bone}");
            }
        }
    }
}

/// Each vertex's mirror image.
fn mirrors(body: &Body) -> Vec<usize> {
    let positions = &body.mesh.positions;
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|&a, &b| positions[a].y.total_cmp(&positions[b].y));
    let find = |p: &Vec3| {
        let wanted = Vec3::new(-p.x, p.y, p.z);
        let from = order.partition_point(|&v| positions[v].y < p.y - 1e-5);
        let near = order[from..].iter().take_while(|&&v| positions[v].y < p.y + 1e-5);
        near.copied().find(|&v| positions[v].distance(wanted) < 1e-5).expect("a mirror image")
    };
    positions.iter().map(find).collect()
}

#[test]
fn tape_reads_the_measures_wanted_on_a_grid() {
    for sex in [Sex::Female, Sex::Male] {
        let mean = Measures::average(sex);
        for stature in [0.88, 1.0, 1.12] {
            for [chest, waist, hip] in
                [[1.0, 1.0, 1.0], [0.8, 0.8, 0.85], [1.2, 1.3, 1.25], [0.9, 1.1, 1.0], [1.1, 0.9, 0.9]]
            {
                for shoulder in [0.92, 1.08] {
                    let wanted = Measures {
                        stature: mean.stature * stature,
                        shoulder_breadth: mean.shoulder_breadth * shoulder,
                        chest_girth: mean.chest_girth * chest,
                        waist_girth: mean.waist_girth * waist,
                        hip_girth: mean.hip_girth * hip,
                    };
                    let body = build(sex, &wanted).unwrap();
                    assert!(worst(&wanted, &body.measures) < TOLERANCE, "{wanted:?} {:?}", body.measures);
                    let chest = tape::girth(&body, body.levels.chest);
                    assert!((chest - wanted.chest_girth).abs() < TOLERANCE, "the public tape agrees");
                }
            }
        }
    }
}

#[test]
fn measures_like_those_of_ansur_are_met() {
    let mut random = SplitMix64::new(2012);
    for sex in [Sex::Female, Sex::Male] {
        for _ in 0..50 {
            let wanted = random_person(sex, &mut random);
            let body = build(sex, &wanted).unwrap();
            assert!(worst(&wanted, &body.measures) < TOLERANCE, "{wanted:?} {:?}", body.measures);
        }
    }
}

#[test]
fn people_of_the_survey_are_met() {
    let Some(folder) = crate::recordings::folder() else { return };
    for (sex, file) in [(Sex::Female, "ANSUR_II_FEMALE.csv"), (Sex::Male, "ANSUR_II_MALE.csv")] {
        let path = folder.join("anthropometry/ansur2").join(file);
        let bytes = std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        // One name has a letter that is not UTF-8; the measures are plain digits.
        let text = String::from_utf8_lossy(&bytes);
        let mut lines = text.lines().map(|l| l.split(';').collect::<Vec<_>>());
        let names = lines.next().expect("a header");
        let column = |name: &str| names.iter().position(|n| *n == name).expect("a known measure");
        let columns =
            ["stature", "biacromialbreadth", "chestcircumference", "waistcircumference", "buttockcircumference"];
        let [stature, shoulder, chest, waist, hip] = columns.map(column);
        let mut met = 0;
        for row in lines.step_by(50) {
            let metres = |c: usize| row[c].parse::<f32>().expect("millimetres") * 1e-3;
            let wanted = Measures {
                stature: metres(stature),
                shoulder_breadth: metres(shoulder),
                chest_girth: metres(chest),
                waist_girth: metres(waist),
                hip_girth: metres(hip),
            };
            let body = build(sex, &wanted).unwrap();
            assert!(worst(&wanted, &body.measures) < TOLERANCE, "{wanted:?} {:?}", body.measures);
            met += 1;
        }
        assert!(met >= 39, "{met}");
    }
}

#[test]
fn corners_of_the_range_are_met_or_refused() {
    let mut met = 0;
    for corner in 0..32u32 {
        let pick = |bit: u32, least: f32, most: f32| if corner >> bit & 1 == 0 { least } else { most };
        let wanted = Measures {
            stature: pick(0, 1.2, 2.2),
            shoulder_breadth: pick(1, 0.25, 0.55),
            chest_girth: pick(2, 0.5, 1.8),
            waist_girth: pick(3, 0.5, 1.8),
            hip_girth: pick(4, 0.5, 1.8),
        };
        match build(Sex::Female, &wanted) {
            Ok(body) => {
                assert!(worst(&wanted, &body.measures) < TOLERANCE);
                assert!(body.mesh.positions.iter().all(|p| p.is_finite()));
                met += 1;
            }
            Err(BodyError::Unreachable { value, reached, .. }) => assert!((value - reached).abs() > TOLERANCE),
            Err(other) => panic!("{other}"),
        }
    }
    assert!(met >= 4, "only {met} corners");
}

#[test]
fn impossible_measures_are_refused_in_one_sentence() {
    let mean = Measures::average(Sex::Female);
    for (wanted, name) in [
        (Measures { stature: 1.19, ..mean }, "stature"),
        (Measures { stature: f32::NAN, ..mean }, "stature"),
        (Measures { shoulder_breadth: 0.56, ..mean }, "shoulder breadth"),
        (Measures { chest_girth: 95.0, ..mean }, "chest girth"),
        (Measures { waist_girth: f32::INFINITY, ..mean }, "waist girth"),
        (Measures { hip_girth: -1.0, ..mean }, "hip girth"),
    ] {
        let message = build(Sex::Female, &wanted).unwrap_err().to_string();
        assert!(
            message.contains(name)
                && (message.contains("check") || message.contains("give metres"))
                && !message.contains('\n'),
            "{message}"
        );
    }
}

#[test]
fn weights_are_shares_and_change_gently() {
    for body in [average(Sex::Female), average(Sex::Male)] {
        for w in &body.weights {
            assert!((w.weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            assert!(w.weights.iter().all(|&x| (0.0..=1.0).contains(&x)));
            assert!(w.bones.iter().all(|&b| usize::from(b) < BONES));
        }
        let dense = |v: u32| {
            let mut all = [0.0f32; BONES];
            for (bone, w) in body.weights[v as usize].iter() {
                // A vertex that follows a twist bone follows, as far as it twists, the two ends of its limb.
                let twist = TWISTS.iter().find(|t| t.bones().contains(&usize::from(bone)));
                let share = twist.map_or(0.0, |t| t.share(usize::from(bone) - t.first + 1));
                all[bone_joint(bone.into()).unwrap().index()] += w * (1.0 - share);
                all[twist.map_or(0, |t| t.to.index())] += w * share;
            }
            all
        };
        for t in &body.mesh.triangles {
            let (a, b) = (dense(t[0]), dense(t[1]));
            let step: f32 = a.iter().zip(&b).map(|(x, y)| (x - y).abs()).sum::<f32>() / 2.0;
            let length = body.mesh.positions[t[0] as usize].distance(body.mesh.positions[t[1] as usize]);
            assert!(step < 0.05 + 40.0 * length, "weights jump by {step} over {length} m");
        }
    }
}

/// Winding number of the surface around a point: 1 inside, 0 outside (Van Oosterom and Strackee 1983).
fn winding(mesh: &Mesh, p: Vec3) -> f32 {
    let solid = |t: &[u32; 3]| {
        let [a, b, c]: [DVec3; 3] = t.map(|v| (mesh.positions[v as usize] - p).as_dvec3());
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    mesh.triangles.iter().map(solid).sum::<f64>() as f32 / (2.0 * TAU)
}

#[test]
fn joints_lie_inside() {
    for body in [average(Sex::Female), average(Sex::Male)].iter().chain(&small_and_large()) {
        for joint in Joint::ALL {
            let around = winding(&body.mesh, body.skeleton.at(joint));
            assert!((around - 1.0).abs() < 1e-3, "{joint:?} of {:?}: {around}", body.measures);
        }
    }
}

#[test]
fn levels_climb_and_agree_with_the_survey() {
    // ANSUR II means (mm): buttock, bust point, acromion and crotch heights.
    for (sex, [hip, chest, shoulder, crotch]) in
        [(Sex::Female, [834.0, 1172.0, 1335.0, 782.0]), (Sex::Male, [888.0, 1291.0, 1441.0, 846.0])]
    {
        let l = average(sex).levels;
        let rising = [l.ankle, l.knee, l.crotch, l.hip, l.waist, l.underbust, l.chest, l.shoulder, l.neck];
        assert!(rising.windows(2).all(|w| w[0] < w[1]), "{l:?}");
        for (level, mean) in [(l.hip, hip), (l.chest, chest), (l.shoulder, shoulder), (l.crotch, crotch)] {
            assert!((level * 1e3 - mean).abs() < 20.0, "{level} {mean}");
        }
    }
}

#[test]
fn limbs_keep_clear_of_the_trunk() {
    for body in [average(Sex::Female), average(Sex::Male)].iter().chain(&small_and_large()) {
        let points = |region: Region| {
            let with = body.mesh.positions.iter().zip(&body.regions);
            with.filter(move |(_, r)| **r == region).map(|(p, _)| *p)
        };
        let elbow = body.skeleton.at(Joint::LeftElbow);
        let shoulder = body.skeleton.at(Joint::LeftShoulder);
        let beyond = points(Region::LeftArm)
            .filter(|p| (*p - shoulder).dot(elbow - shoulder) > 0.6 * (elbow - shoulder).length_squared());
        let trunk: Vec<Vec3> = points(Region::Torso).chain(points(Region::LeftLeg)).collect();
        let gap = beyond.map(|p| trunk.iter().map(|q| q.distance(p)).fold(f32::MAX, f32::min)).fold(f32::MAX, f32::min);
        assert!(gap > 0.02, "arm and trunk: {gap} m");
        let low = points(Region::LeftLeg).filter(|p| p.y < body.levels.crotch - 0.03);
        let inner = low.map(|p| p.x).fold(f32::MAX, f32::min);
        assert!(inner > 0.002, "thighs: {inner} m from the middle");
    }
}

#[test]
fn surface_does_not_cross_itself() {
    for body in [average(Sex::Female), average(Sex::Male)].iter().chain(&small_and_large()) {
        assert_eq!(sound::crossings(&body.mesh), [], "{:?}", body.measures);
    }
}

#[test]
fn crossings_are_seen() {
    let mut mesh = average(Sex::Female).mesh;
    let (top, aside) = (1.6285, Vec3::new(0.1, 0.013, 0.007));
    mesh.positions.iter_mut().filter(|p| p.y > 0.95 * top && p.x > 0.0).for_each(|p| *p -= aside);
    assert!(!sound::crossings(&mesh).is_empty());
}

#[test]
fn same_measures_give_the_same_bits() {
    assert_eq!(average(Sex::Male), average(Sex::Male));
}
