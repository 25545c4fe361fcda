//! Tests of the base bodies, and how they stand against the survey's means.

use std::collections::BTreeMap;

use glam::Vec2;

use super::super::landmarks::{LANDMARKS, Landmark};
use super::super::sound::crossings;
use super::super::tape::{hull, perimeter, slice};
use super::*;
use toile_base::mesh::Mesh;

fn both() -> [BaseBody; 2] {
    [BaseBody::new(Sex::Female), BaseBody::new(Sex::Male)]
}

fn mesh(base: &BaseBody) -> Mesh {
    Mesh { positions: base.positions.clone(), uvs: Vec::new(), triangles: base.triangles.clone() }
}

#[test]
fn bases_are_closed_manifolds_of_quads() {
    for base in both() {
        assert!((12_000..=20_000).contains(&base.triangles.len()), "{}", base.triangles.len());
        let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for q in &base.quads {
            (0..4).for_each(|k| *sides.entry((q[k], q[(k + 1) % 4])).or_default() += 1);
        }
        assert!(sides.iter().all(|(&(a, b), &n)| n == 1 && sides.contains_key(&(b, a))), "each edge once each way");
        assert_eq!(base.positions.len() + base.quads.len(), sides.len() / 2 + 2, "a sphere's topology");
        let volume: f32 = base
            .triangles
            .iter()
            .map(|t| t.map(|v| base.positions[v as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        assert!(volume > 0.05 && volume < 0.1, "wound outwards: {volume} m^3");
    }
}

#[test]
fn bases_share_all_but_their_shape() {
    let [woman, man] = both();
    assert_eq!(woman.triangles, man.triangles);
    assert_eq!((&woman.uvs, &woman.corners, &woman.regions), (&man.uvs, &man.corners, &man.regions));
}

#[test]
fn bases_are_symmetric_to_the_bit() {
    for base in both() {
        for (v, &t) in base.mirrors.iter().enumerate() {
            let (p, q) = (base.positions[v], base.positions[t as usize]);
            assert_eq!(
                (p.x.to_bits(), p.y.to_bits(), p.z.to_bits()),
                ((0.0 - q.x).to_bits(), q.y.to_bits(), q.z.to_bits())
            );
        }
        assert!(base.positions.iter().any(|p| p.y == 0.0) && base.positions.iter().all(|p| p.y >= 0.0), "flat soles");
    }
}

/// Smallest angle of a triangle (degrees).
fn smallest_angle(corners: [Vec3; 3]) -> f32 {
    let angle = |k: usize| (corners[(k + 1) % 3] - corners[k]).angle_between(corners[(k + 2) % 3] - corners[k]);
    angle(0).min(angle(1)).min(angle(2)).to_degrees()
}

#[test]
fn no_triangle_is_degenerate() {
    for base in both() {
        let mut angles: Vec<f32> =
            base.triangles.iter().map(|t| smallest_angle(t.map(|v| base.positions[v as usize]))).collect();
        angles.sort_by(f32::total_cmp);
        println!(
            "{:?}: smallest angle {:.1}, 1 % {:.1}, median {:.1} degrees",
            base.sex,
            angles[0],
            angles[angles.len() / 100],
            angles[angles.len() / 2]
        );
        assert!(angles[0] > 2.0, "{} degrees", angles[0]);
    }
}

#[test]
fn bases_do_not_cross_themselves() {
    for base in both() {
        assert_eq!(crossings(&mesh(&base)), [], "{:?}", base.sex);
    }
}

/// Side of the raster on which the atlas is checked.
const RASTER: usize = 1024;

#[test]
fn atlas_has_no_overlap_and_little_stretch() {
    let [woman, man] = both();
    let mut taken = vec![u32::MAX; RASTER * RASTER];
    let corners = woman.triangle_corners();
    let mut doubled = 0;
    for (t, corner) in corners.iter().enumerate() {
        let [a, b, c] = corner.map(|k| woman.uvs[k as usize] * RASTER as f32);
        assert!([a, b, c].iter().all(|p| p.min_element() >= 0.0 && p.max_element() <= RASTER as f32));
        assert!((b - a).perp_dot(c - a) > 0.0, "triangle {t} is folded over in the atlas");
        let (low, high) = (a.min(b).min(c).floor(), a.max(b).max(c).ceil());
        for y in low.y as usize..(high.y as usize).min(RASTER) {
            for x in low.x as usize..(high.x as usize).min(RASTER) {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                // Strictly inside: pixels on a common edge belong to both.
                let inside = [(a, b), (b, c), (c, a)].iter().all(|(u, v)| (*v - *u).perp_dot(p - *u) > 1e-2);
                if inside {
                    doubled += usize::from(taken[y * RASTER + x] != u32::MAX);
                    taken[y * RASTER + x] = t as u32;
                }
            }
        }
    }
    assert_eq!(doubled, 0, "pixels that two triangles cover");
    let filled = taken.iter().filter(|&&t| t != u32::MAX).count() as f32 / taken.len() as f32;
    for base in [&woman, &man] {
        let (mean, worst) = stretch(base, &corners);
        println!("{:?}: atlas filled {:.0} %, stretch mean {mean:.2}, 99 % {worst:.2}", base.sex, filled * 100.0);
        assert!(filled > 0.4 && mean < 1.25 && worst < 2.5);
    }
}

/// How far lengths in the atlas differ from those on the surface, at one scale for all: the larger of the two singular
/// values or its inverse a triangle, weighted by area: mean, and the share that 99 % stay below.
fn stretch(base: &BaseBody, corners: &[[u32; 3]]) -> (f32, f32) {
    let sides = |t: usize| {
        let [a, b, c] = base.triangles[t].map(|v| base.positions[v as usize]);
        let [p, q, r] = corners[t].map(|k| base.uvs[k as usize]);
        let (e, f) = (b - a, c - a);
        let x = f.dot(e.normalize());
        let rest = glam::Mat2::from_cols(Vec2::new(e.length(), 0.0), Vec2::new(x, (f - e.normalize() * x).length()));
        (glam::Mat2::from_cols(q - p, r - p) * rest.inverse(), rest.determinant())
    };
    let all: Vec<(glam::Mat2, f32)> = (0..corners.len()).map(sides).collect();
    let area: f32 = all.iter().map(|a| a.1).sum();
    let scale = (all.iter().map(|(j, a)| j.determinant() * a).sum::<f32>() / area).sqrt();
    let mut worst: Vec<(f32, f32)> = all
        .iter()
        .map(|(j, a)| {
            let j = *j * (1.0 / scale);
            let (square, det) = (j.x_axis.length_squared() + j.y_axis.length_squared(), j.determinant());
            let large = (0.5 * (square + (square * square - 4.0 * det * det).max(0.0).sqrt())).sqrt();
            (large.max(large / det), *a)
        })
        .collect();
    let mean = worst.iter().map(|(s, a)| s * a).sum::<f32>() / area;
    worst.sort_by(|a, b| a.0.total_cmp(&b.0));
    (mean, worst[worst.len() * 99 / 100].0)
}

/// Breadth, depth and hull's perimeter (mm) of a slice through some parts.
fn section(base: &BaseBody, parts: &[Region], origin: Vec3, normal: Vec3) -> [f32; 3] {
    let keep = |t: usize| base.triangles[t].iter().any(|&v| parts.contains(&base.regions[v as usize]));
    let (u, v) = if normal == Vec3::Y { (Vec3::X, Vec3::Z) } else { normal.any_orthonormal_pair() };
    let cuts = slice(&mesh(base), keep, origin * 1e-3, normal);
    let points: Vec<Vec2> = cuts.iter().flatten().map(|p| Vec2::new(p.dot(u), p.dot(v))).collect();
    let outline = hull(&points);
    let low = outline.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high = outline.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    [high.x - low.x, high.y - low.y, perimeter(&outline)].map(|x| x * 1e3)
}

#[test]
fn sections_agree_with_the_survey() {
    for base in both() {
        let mut off = Vec::new();
        for row in survey(&base) {
            println!("{:?} {:<24} {:>7.1} survey {:>7.1} off {:>6.1}", base.sex, row.0, row.1, row.2, row.1 - row.2);
            if (row.1 - row.2).abs() > row.3 {
                off.push(row);
            }
        }
        assert!(off.is_empty(), "{:?}: {off:?}", base.sex);
    }
}

/// Name, the base's, the survey's mean, and how far they may differ (mm).
type Row = (&'static str, f32, f32, f32);

/// What the base and ANSUR II's means read. Girths are taken at the survey's levels, around the hull.
fn survey(base: &BaseBody) -> Vec<Row> {
    let woman = base.sex == Sex::Female;
    let pick = |w: f32, m: f32| if woman { w } else { m };
    let trunk = [Region::Torso, Region::LeftLeg, Region::RightLeg];
    let level = |parts: &[Region], y: f32| section(base, parts, Vec3::Y * y, Vec3::Y);
    let (chest, waist, hip) = (pick(1171.6, 1291.1), pick(980.1, 1056.5), pick(833.7, 887.9));
    let legs = [Region::LeftLeg];
    let head = [Region::Head];
    let [c, w, h] = [chest, waist, hip].map(|y| level(&trunk, y));
    let top = |y: f32| level(&head, y);
    let crown = base.positions.iter().map(|p| p.y).fold(0.0, f32::max) * 1e3;
    let widest = |low: f32, high: f32, read: &dyn Fn(f32) -> f32| {
        (0..=20).map(|k| read(low + (high - low) * k as f32 / 20.0)).fold(0.0, f32::max)
    };
    let thinnest = |low: f32, high: f32, read: &dyn Fn(f32) -> f32| {
        (0..=20).map(|k| read(low + (high - low) * k as f32 / 20.0)).fold(f32::MAX, f32::min)
    };
    let knee = pick(449.0, 488.4);
    let arm = |way: f32| {
        let at = |j: toile_base::skeleton::Joint| base.skeleton.at(j) * 1e3;
        use toile_base::skeleton::Joint::{LeftElbow, LeftShoulder, LeftWrist};
        let (a, b, t) =
            if way < 1.0 { (at(LeftShoulder), at(LeftElbow), way) } else { (at(LeftElbow), at(LeftWrist), way - 1.0) };
        section(base, &[Region::LeftArm], a.lerp(b, t), (b - a).normalize())[2]
    };
    let mark = |l: Landmark| base.landmarks.mark(l).on(&base.positions) * 1e3;
    let neck = |l: Landmark| section(base, &[Region::Torso, Region::Head], mark(l), Vec3::new(0.0, 0.94, 0.34))[2];
    let seat = extreme(base, hip, 40.0, |p| -p.z);
    let bust = extreme(base, chest, 50.0, |p| p.z);
    vec![
        ("stature", crown, pick(1628.5, 1756.2), 1.0),
        ("chest height", bust, chest, 5.0),
        ("buttock height", seat, hip, 5.0),
        ("crotch height", crotch(base), pick(782.3, 845.9), 5.0),
        // Missed, and not to be met: the survey's callipers press on the ribs under the arms. A section of its breadth and
        // depth has a girth of at most 2 (b + d), were it a rectangle, and about 812 and 854 mm as an ellipse; its tape
        // read 947 and 1,059. The girth is kept.
        ("chest breadth", c[0], pick(269.3, 289.4), pick(32.0, 76.0)),
        ("chest depth", c[1], pick(247.4, 253.8), 10.0),
        ("chest girth", c[2], pick(946.9, 1058.7), 10.0),
        ("waist breadth", w[0], pick(299.9, 326.4), 10.0),
        ("waist depth", w[1], pick(213.0, 237.8), 10.0),
        ("waist girth", w[2], pick(860.9, 940.6), 10.0),
        ("natural waist girth", level(&trunk, pick(1026.0, 1091.0))[2], pick(786.9, 938.7), 10.0),
        ("hip breadth", widest(hip - 40.0, hip + 40.0, &|y| level(&trunk, y)[0]), pick(353.8, 345.7), 10.0),
        ("buttock depth", h[1], pick(232.9, 245.8), 10.0),
        ("buttock girth", h[2], pick(1021.2, 1019.5), 10.0),
        ("thigh girth", level(&legs, pick(750.0, 812.0))[2], pick(616.1, 625.1), 10.0),
        ("lower thigh girth", level(&legs, knee + pick(48.0, 50.0))[2], pick(400.7, 409.3), 10.0),
        ("calf girth", widest(0.68 * knee, 0.86 * knee, &|y| level(&legs, y)[2]), pick(373.3, 392.3), 10.0),
        ("ankle girth", thinnest(0.2 * knee, 0.36 * knee, &|y| level(&legs, y)[2]), pick(215.7, 229.3), 10.0),
        // Our arm hangs relaxed; the survey's is flexed.
        ("biceps girth, flexed", widest(0.45, 0.75, &arm), pick(305.6, 358.1), 20.0),
        ("forearm girth, flexed", widest(1.15, 1.45, &arm), pick(264.1, 310.1), 15.0),
        ("wrist girth", thinnest(1.85, 2.0, &arm), pick(154.8, 175.9), 10.0),
        ("neck girth", neck(Landmark::Infrathyroid), pick(329.8, 397.6), 10.0),
        ("head breadth", widest(crown - 130.0, crown - 70.0, &|y| top_without_ears(base, y)), pick(147.8, 154.3), 5.0),
        ("head length", widest(crown - 130.0, crown - 60.0, &|y| top(y)[1]), pick(189.8, 199.5), 8.0),
        ("foot length", foot(base, |p| p.z), pick(246.3, 271.2), 5.0),
        ("foot breadth", foot(base, |p| p.x), pick(92.7, 101.9), 8.0),
        ("hand length", hand(base), pick(181.1, 193.3), 5.0),
    ]
}

/// Height (mm) of the most prominent point of the trunk near a height.
fn extreme(base: &BaseBody, near: f32, range: f32, prominence: impl Fn(&Vec3) -> f32) -> f32 {
    let with = base.positions.iter().zip(&base.regions);
    let trunk = with.filter(|(p, r)| **r == Region::Torso && (p.y * 1e3 - near).abs() < range).map(|(p, _)| p);
    trunk.max_by(|a, b| prominence(a).total_cmp(&prominence(b))).expect("a trunk").y * 1e3
}

/// Lowest point of the middle line between the legs (mm).
fn crotch(base: &BaseBody) -> f32 {
    base.positions.iter().filter(|p| p.x == 0.0).map(|p| p.y).fold(f32::MAX, f32::min) * 1e3
}

/// Breadth (mm) of the head at a height in front of the ears.
fn top_without_ears(base: &BaseBody, y: f32) -> f32 {
    let near = base.positions.iter().zip(base.charts_of_vertices());
    let breadth = near.filter(|(p, ear)| !ear && (p.y * 1e3 - y).abs() < 6.0).map(|(p, _)| p.x).fold(0.0, f32::max);
    2e3 * breadth
}

impl BaseBody {
    /// Whether a vertex belongs to an ear.
    fn charts_of_vertices(&self) -> Vec<bool> {
        let mut ear = vec![false; self.positions.len()];
        for (q, &chart) in self.quads.iter().zip(&self.charts) {
            q.iter().for_each(|&v| ear[v as usize] |= chart == 4 || chart == 5);
        }
        ear
    }
}

fn foot(base: &BaseBody, along: impl Fn(&Vec3) -> f32) -> f32 {
    let low = base.positions.iter().filter(|p| p.x > 0.0 && p.y < 0.05);
    let (least, most) = low.map(along).fold((f32::MAX, f32::MIN), |(a, b), x| (a.min(x), b.max(x)));
    (most - least) * 1e3
}

fn hand(base: &BaseBody) -> f32 {
    use toile_base::skeleton::Joint::{LeftElbow, LeftWrist};
    let (elbow, wrist) = (base.skeleton.at(LeftElbow), base.skeleton.at(LeftWrist));
    let way = (wrist - elbow).normalize();
    let arm = base.positions.iter().zip(&base.regions).filter(|(_, r)| **r == Region::LeftArm);
    arm.map(|(p, _)| (*p - wrist).dot(way)).fold(0.0, f32::max) * 1e3
}

#[test]
fn landmarks_lie_where_they_are_drawn() {
    for base in both() {
        let drawn = Landmarks::drawn(base.sex);
        let mut far = Vec::new();
        for l in Landmark::ALL {
            let at = base.landmarks.mark(l).on(&base.positions);
            let off = (at - drawn[l.index()]) * 1e3;
            println!(
                "{:?} {l:?} at {:.1} {:.1} {:.1} drawn off by {:.1}",
                base.sex,
                at.x * 1e3,
                at.y * 1e3,
                at.z * 1e3,
                off.length()
            );
            if off.length() > 12.0 {
                far.push((l, off));
            }
        }
        assert!(far.is_empty(), "{:?} {far:?} of {LANDMARKS}", base.sex);
    }
}

#[test]
fn damaged_files_are_refused_in_one_sentence() {
    let bytes = STORED.encode();
    assert_eq!(StoredBodies::decode(&bytes).as_ref(), Ok(&*STORED));
    for (broken, name) in [(&bytes[..40], "damaged"), (&bytes[..3], "version"), (&[0u8; 64][..], "version")] {
        let message = StoredBodies::decode(broken).unwrap_err().to_string();
        assert!(message.contains(name) && message.contains("toile-sculpt"), "{message}");
    }
    let mut flipped = bytes.clone();
    flipped[1000] ^= 1;
    assert!(StoredBodies::decode(&flipped).is_err());
}
