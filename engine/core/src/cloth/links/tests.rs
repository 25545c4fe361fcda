//! Links against their lengths, against each other at every width, and against f64.

use super::*;
use crate::cloth::state::State;
use crate::lanes::Width;
use glam::Vec3;
use toile_base::garment::Direction;
use toile_base::garment::layout::{ConstraintRun, OwnerShare, Tuples};

/// Links between particles i and i + n.
fn parallel_links(n: u32, rest: f32, compliance: f32) -> Links {
    let share = OwnerShare { zigzags: 0..0, runs: 0..1, loose: 0..0, loose_at: n, loose_serial: n };
    let set = ConstraintSet { direction: Direction::Weft, crosses: false, shares: [share, OwnerShare::default()] };
    let runs = [ConstraintRun { first: [0, n], len: n, at: 0, serial: 0, alike: false }].into();
    Links {
        tuples: Tuples {
            zigzags: [].into(),
            runs,
            loose: [].into(),
            sets: [set].into(),
            count: n as usize,
            places: n as usize,
        },
        rest: vec![rest; n as usize].into(),
        compliance: vec![compliance; n as usize].into(),
    }
}

fn prepared(links: &Links, weights: &[f32], gamma: f32) -> LinkGains {
    let mut gains = LinkGains::new(links);
    gains.prepare(links, weights, [1.0, gamma], Passes::Many);
    gains
}

fn solved(width: Width, positions: &[Vec3], weights: &[f32], links: &Links, gamma: f32) -> Vec<Vec3> {
    let mut state = State::new(positions, weights);
    let gains = prepared(links, weights, gamma);
    let set = &links.tuples.sets[0];
    let parameters = LinkColumns::baked(links, &gains, gamma > 0.0);
    width.run(SolveLinks { columns: state.columns(), links, parameters, set, owner: 0, gamma, tension: None });
    (0..positions.len()).map(|i| Vec3::from_array(state.positions().map(|a| a[i]))).collect()
}

#[test]
fn a_stiff_link_reaches_its_length_and_keeps_the_centre_of_mass() {
    let (weights, link) = ([1.0, 3.0], parallel_links(1, 1.0, 0.0));
    // What is drawn out by a five-hundredth is there in a pass; what is twice or a hundred times as long, or half, in a few.
    for (length, passes) in [(1.002, 1), (0.998, 1), (1.02, 2), (2.0, 9), (100.0, 40), (0.5, 6)] {
        let mut p = vec![Vec3::ZERO, Vec3::X * length];
        for _ in 0..passes {
            let before = (p[1] - p[0]).length();
            p = solved(Width::widest(), &p, &weights, &link, 0.0);
            let after = (p[1] - p[0]).length();
            assert!((after - 1.0).abs() <= (before - 1.0).abs(), "{length}: from {before} to {after}");
        }
        assert!(((p[1] - p[0]).length() - 1.0).abs() < 3e-6, "{length}: {}", (p[1] - p[0]).length());
        assert!((p[0].x + p[1].x / 3.0 - length / 3.0).abs() < 1e-5 * length);
    }
}

/// The share of the vector that a link is drawn in by, whatever the lanes.
#[test]
fn a_length_that_is_no_number_is_held_the_same_way_at_every_width() {
    let numbers = [0.0, 1e-30, 0.5, 1.0, 1.4, 30.0, 1e30, f32::INFINITY, f32::NAN, -f32::NAN];
    for x in numbers {
        let positions = [Vec3::ZERO, Vec3::new(x, 0.25, 0.0)];
        let bits = |width| solved(width, &positions, &[1.0, 2.0], &parallel_links(1, 1.0, 0.0), 0.0);
        let plain: Vec<[f32; 3]> = bits(Width::One).iter().map(|p| p.to_array()).collect();
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            let got: Vec<[f32; 3]> = bits(width).iter().map(|p| p.to_array()).collect();
            let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
            assert!(got.iter().flatten().zip(plain.iter().flatten()).all(|(a, b)| same(*a, *b)), "{x} at {width}");
        }
        // y is a number, and stays one where the length is none, drawn in by the most there is.
        let pull = |e: f32| e * (0.5 - e * 0.375) / 3.0;
        if x.is_nan() || x == 1e30 {
            assert!((plain[0][1] - 0.25 * pull(MOST_EXCESS)).abs() < 1e-8, "{x}: {}", plain[0][1]);
        }
    }
}

#[test]
fn collapsed_and_fixed_links_do_nothing() {
    for (w, b) in [([1.0, 1.0], Vec3::ZERO), ([0.0, 0.0], Vec3::X * 3.0)] {
        assert_eq!(solved(Width::widest(), &[Vec3::ZERO, b], &w, &parallel_links(1, 1.0, 0.0), 0.0), [Vec3::ZERO, b]);
    }
}

#[test]
fn every_width_gives_the_same_bits_and_f64_agrees() {
    let n = 37;
    let place = |i: u32| Vec3::new((i as f32 * 0.37).sin(), 0.1 * (i / n) as f32, (i as f32 * 0.71).cos()) * 0.3;
    let positions: Vec<Vec3> = (0..2 * n).map(place).collect();
    let weights: Vec<f32> = (0..2 * n).map(|i| if i % 5 == 0 { 0.0 } else { 1.0 + i as f32 }).collect();
    let links = parallel_links(n, 0.12, 2.0);
    let plain = solved(Width::One, &positions, &weights, &links, 0.25);
    for width in Width::ALL.into_iter().filter(|w| w.available()) {
        assert_eq!(solved(width, &positions, &weights, &links, 0.25), plain, "{width} lanes");
    }
    for i in 0..n as usize {
        let (a, b) = (positions[i].as_dvec3(), positions[i + n as usize].as_dvec3());
        let (wa, wb) = (f64::from(weights[i]), f64::from(weights[i + n as usize]));
        if wa + wb == 0.0 {
            continue;
        }
        let d = b - a;
        // Nothing has moved yet in this substep: damping only weakens the pull.
        let lambda = (d.length() - f64::from(0.12f32)) / (1.25 * (wa + wb) + 2.0);
        let expected = b - d.normalize() * lambda * wb;
        let error = (expected - plain[i + n as usize].as_dvec3()).length();
        assert!(error < 1e-6, "link {i}: {error} m");
    }
}

/// A zigzag of `n` straights, closed or not, straights and slants alike or not, between rails that lie one behind the other.
fn zigzag(n: u32, closed: bool, [straights, slants]: [bool; 2]) -> Links {
    let long = if closed { n } else { n - 1 };
    let places = if straights { 1 } else { n };
    let count = places + if slants { 1 } else { long };
    let straights = ConstraintRun { first: [0, n], len: n, at: 0, serial: 0, alike: straights };
    let slants = ConstraintRun { first: [n, 1], len: long, at: places, serial: n, alike: slants };
    let share = OwnerShare { zigzags: 0..1, ..OwnerShare::default() };
    let set = ConstraintSet { direction: Direction::Weft, crosses: false, shares: [share, OwnerShare::default()] };
    Links {
        tuples: Tuples {
            zigzags: [Zigzag { straights, slants }].into(),
            sets: [set].into(),
            count: (n + slants.len) as usize,
            places: count as usize,
            ..Tuples::default()
        },
        rest: (0..count).map(|i| 0.1 + 0.01 * (i % 7) as f32).collect(),
        compliance: vec![0.0; count as usize].into(),
    }
}

/// The particles of a zigzag, and their weights: the same but for what the rounding of a bake leaves, or not.
fn rails(n: u32, same: bool) -> (Vec<Vec3>, Vec<f32>) {
    let place = |i: u32| Vec3::new((i as f32 * 0.61).sin(), 0.3 * (i as f32).cos(), (i as f32 * 0.23).sin()) * 0.2;
    let weight = |i: u32| if same { 2.0 + 1e-6 * (i % 5) as f32 } else { (i % 4) as f32 };
    ((0..2 * n).map(place).collect(), (0..2 * n).map(weight).collect())
}

/// All lengths up to some vectors of the widest lanes, closed and open, with straights and slants alike and not.
fn zigzags() -> impl Iterator<Item = (u32, bool, [bool; 2])> {
    let alike = [[true, true], [true, false], [false, true], [false, false]];
    let forms = move |n| [true, false].into_iter().flat_map(move |closed| alike.map(|alike| (n, closed, alike)));
    (2..70).flat_map(forms)
}

#[test]
fn a_zigzag_is_its_straights_and_then_its_slants_at_every_width() {
    for (n, closed, alike) in zigzags() {
        let links = zigzag(n, closed, alike);
        let (positions, weights) = rails(n, alike.contains(&true));
        // What is alike counts with the masses of the first of its run.
        let counted = |serial: u32, ends: [u32; 2]| match (serial < n, alike) {
            (true, [true, _]) => [0, n],
            (false, [_, true]) => [n, 1],
            _ => ends,
        };
        // One after the other, each as a zigzag of one straight link.
        let mut expected = State::new(&positions, &weights);
        let gains = prepared(&links, &weights, 0.0);
        let mut serial = 0;
        links.tuples.for_each(|at, [a, b]| {
            let columns = expected.columns();
            let [pa, pb] = [a, b].map(|i| state::get(columns.x, i as usize));
            let d = V3::<f32> { x: pb.x - pa.x, y: pb.y - pa.y, z: pb.z - pa.z };
            let counted = counted(serial, [a, b]).map(|i| weights[i as usize]);
            let [by_a, by_b] = stiff(d, gains.per_rest2[at], gains.gain[at], counted);
            let vector = |v: V3<f32>| glam::Vec3A::new(v.x, v.y, v.z);
            state::set(columns.x, a as usize, pa + vector(by_a));
            state::set(columns.x, b as usize, pb - vector(by_b));
            serial += 1;
        });
        let expected: Vec<Vec3> =
            (0..2 * n as usize).map(|i| Vec3::from_array(expected.positions().map(|a| a[i]))).collect();
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            let got = solved(width, &positions, &weights, &links, 0.0);
            assert_eq!(got, expected, "{width} lanes, {n} straights, closed {closed}, alike {alike:?}");
        }
    }
}

/// Where links are alike the masses differ in their last bits; which ones count must not depend on the lanes.
#[test]
fn damped_zigzags_have_the_same_bits_at_every_width() {
    for (n, closed, alike) in zigzags() {
        let links = zigzag(n, closed, alike);
        let (positions, weights) = rails(n, alike.contains(&true));
        let plain = solved(Width::One, &positions, &weights, &links, 0.25);
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            let got = solved(width, &positions, &weights, &links, 0.25);
            assert_eq!(got, plain, "{width} lanes, {n} straights, closed {closed}, alike {alike:?}");
        }
    }
}

/// The links of a garment in both forms, from the same start.
#[test]
fn by_records_links_have_the_bits_that_they_have_in_columns() {
    use crate::cloth::links::record_links::{RecordLinks, SolveRecordLinks};
    use crate::cloth::links::records::{FillRecords, ReadRecords};
    use crate::lanes::{RECORD, Store};
    use toile_assets::scene::skirt::{self, Stretch};
    use toile_bake::bake;

    for (shape, stretch) in [
        (skirt::shape(24), Stretch::Inextensible),
        (skirt::irregular(17, 3), Stretch::Inextensible),
        (skirt::irregular(17, 3), Stretch::Physical),
        (skirt::shape(24), Stretch::Physical),
    ] {
        let garment = bake("skirt", "one", &shape, &skirt::fabric(&shape, stretch)).unwrap();
        let (layout, weights) = (garment.layout(), &garment.inverse_mass);
        let place = |(i, p): (usize, &Vec3)| *p + 0.004 * Vec3::new((i as f32).sin(), (1.7 * i as f32).cos(), 0.3);
        let positions: Vec<Vec3> = garment.start.iter().enumerate().map(place).collect();
        let soft = layout.weft.compliance.iter().any(|c| *c > 1e-6);
        for (links, soft) in [(&layout.weft, soft), (&layout.shear, false)] {
            let gains = prepared(links, weights, 0.0);
            let mut records = RecordLinks::new(links, weights);
            records.prepare(links, &gains, soft);
            let per_dt2 = 3e5;
            for width in Width::ALL.into_iter().filter(|w| w.available()) {
                let (mut one, mut other) = (State::new(&positions, weights), State::new(&positions, weights));
                let mut tensions = [links.tuples.count, records.len()].map(Store::zeros);
                let mut store = Store::zeros(RECORD * (positions.len() + 2));
                let (c, records_column, spans) = (other.columns(), store.column(), [(0, positions.len() as u32)]);
                let [in_columns, in_records] = tensions.each_mut().map(|t| soft.then(|| (t.column(), per_dt2)));
                width.run(FillRecords { from: c.x, w: c.w, spans: &spans, records: records_column });
                for ((number, set), owner) in links
                    .tuples
                    .sets
                    .iter()
                    .enumerate()
                    .flat_map(|s| [(s, 0), (s, 1)])
                    .cycle()
                    .take(6 * links.tuples.sets.len())
                {
                    let (columns, gamma) = (one.columns(), 0.0);
                    let parameters = LinkColumns::baked(links, &gains, soft);
                    width.run(SolveLinks { columns, links, parameters, set, owner, gamma, tension: in_columns });
                    width.run(SolveRecordLinks {
                        links: &records,
                        set: number,
                        owner,
                        records: records_column,
                        tension: in_records,
                    });
                }
                width.run(ReadRecords { columns: c, spans: &spans, records: records_column });
                assert_eq!(one.positions(), other.positions(), "{width} lanes, soft {soft}");
            }
        }
    }
}
