use super::*;
use crate::cloth::state::State;
use crate::lanes::Shared;
use crate::workers::WorkerPool;

const DT: f32 = 1.0 / 120.0;
const SKIRT: Wind = Wind { velocity: Vec3A::new(1.0, 0.0, 0.5), drag: 0.1, lift: 0.05 };

/// Numbers in -1..1.
fn noise(seed: u32) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 8_388_608.0 - 1.0
    }
}

/// A tube of `rows` hoops of `n` particles, a hoop in a row; the triangles across the seam are loose.
fn tube(rows: u32, n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let place = |row: u32, k: u32| {
        let (sin, cos) = (k as f32 / n as f32 * std::f32::consts::TAU).sin_cos();
        let r = 0.15 + 0.2 * row as f32 / rows as f32;
        Vec3::new(r * cos, 1.0 - 0.7 * row as f32 / rows as f32, r * sin)
    };
    let points = (0..rows).flat_map(|row| (0..n).map(move |k| place(row, k))).collect();
    let quad = |row: u32, k: u32| {
        let (a, b) = (row * n + k, row * n + (k + 1) % n);
        [[a, b, a + n], [b, b + n, a + n]]
    };
    (points, (0..rows - 1).flat_map(|row| (0..n).flat_map(move |k| quad(row, k))).collect())
}

/// A flat square of two triangles, edge 1 m, 100 g; two corners touch both triangles and weigh twice the others.
fn square(normal: Vec3A) -> (State, Faces) {
    let (a, b) = Vec3::from(normal).any_orthonormal_pair();
    let (corners, w) = ([Vec3::ZERO, a, b, a + b], [60.0, 30.0, 30.0, 60.0]);
    (State::new(&corners, &w), Faces::new(&[[0, 1, 2], [1, 3, 2]], &corners, &w, &[0; 4]))
}

fn accelerations(faces: &Faces, width: Width, wind: &Wind, state: &mut State) -> Vec<Vec3A> {
    let mut out = Accelerations::new(state.weights().len());
    let to = out.columns();
    WindPart::ALL.into_iter().for_each(|part| faces.blow(width, part, wind, DT, state.columns(), to));
    (0..state.weights().len()).map(|i| out.of(i)).collect()
}

/// A crumpled tube in motion, some of it pinned, and which worker owns what.
fn crumpled(rows: u32, n: u32) -> (State, Vec<Vec3>, Vec<[u32; 3]>, Vec<u8>) {
    let (rest, triangles) = tube(rows, n);
    let mut noise = noise(5);
    let moved: Vec<Vec3> = rest.iter().map(|p| *p + Vec3::new(noise(), noise(), noise()) * 0.005).collect();
    let w: Vec<f32> = (0..rest.len()).map(|i| if i < n as usize { 0.0 } else { 8_000.0 + 500.0 * noise() }).collect();
    let mut state = State::new(&moved, &w);
    state.velocities_mut(|column| column.fill_with(|| 2.0 * noise()));
    let owner = (0..rest.len()).map(|i| u8::from(i % n as usize > n as usize / 2)).collect();
    (state, rest, triangles, owner)
}

#[test]
fn every_width_and_both_ways_to_share_give_the_same_bits() {
    for (rows, n) in [(2, 3), (5, 19), (9, 100), (12, 150)] {
        let (mut state, rest, triangles, owner) = crumpled(rows, n);
        let faces = Faces::new(&triangles, &rest, state.weights(), &owner);
        assert_eq!(faces.count().iter().sum::<usize>(), triangles.len());
        let plain = accelerations(&faces, Width::One, &SKIRT, &mut state);
        assert!(plain.iter().any(|a| a.length() > 0.01));
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            assert_eq!(accelerations(&faces, width, &SKIRT, &mut state), plain, "{width} lanes, {rows} x {n}");
            for workers in [1, 2] {
                let mut out = Accelerations::new(rest.len());
                let (at, to) = (state.columns(), out.columns());
                (0..rest.len()).for_each(|i| state::set(to, i, Vec3A::NAN));
                let shared = Shared::new((at, to));
                let blow = |part| {
                    let (at, to) = shared.open_in_test();
                    faces.blow(width, part, &SKIRT, DT, at, to);
                };
                let job = |phase, share| match (phase, share) {
                    (0, 0) => blow(WindPart::First),
                    (0, _) => blow(WindPart::Second),
                    (_, 0) => blow(WindPart::Crossing),
                    _ => (),
                };
                WorkerPool::new(workers).unwrap().run(2, job).unwrap();
                for (i, a) in plain.iter().enumerate() {
                    assert_eq!(out.of(i), *a, "{workers} workers, particle {i}");
                }
            }
        }
    }
}

#[test]
fn sums_in_the_order_that_is_told_are_the_same_bits() {
    for (rows, n) in [(2, 3), (9, 100), (12, 150)] {
        let (mut state, rest, triangles, owner) = crumpled(rows, n);
        let faces = Faces::new(&triangles, &rest, state.weights(), &owner);
        let blown = accelerations(&faces, Width::widest(), &SKIRT, &mut state);
        let (columns, air) = (state.columns(), Air::<f32>::new(&SKIRT, DT));
        let three = |from, corners: [u32; 3]| corners.map(|i| V3::<f32>::load(from, i as usize, 1));
        let force = |(t, mass)| {
            let V3 { x, y, z } = air.force(three(columns.x, t), three(columns.v, t), mass);
            Vec3A::new(x, y, z)
        };
        let forces: Vec<Vec3A> = faces.triangles().map(force).collect();
        assert_eq!(forces.len(), triangles.len());
        let mut sums = vec![Vec3A::ZERO; rest.len()];
        faces.sums(|t, i| sums[i as usize] += forces[t as usize] * columns.w.get(i as usize));
        assert_eq!(sums, blown, "{rows} x {n}");
    }
}

#[test]
fn a_plain_f64_version_gives_the_same_to_five_digits() {
    let (mut state, rest, triangles, owner) = crumpled(9, 100);
    let faces = Faces::new(&triangles, &rest, state.weights(), &owner);
    let got = accelerations(&faces, Width::widest(), &SKIRT, &mut state);
    let at =
        |columns: [&[f32]; 3], i: u32| glam::DVec3::from_array([0, 1, 2].map(|k| f64::from(columns[k][i as usize])));
    let mut want = vec![glam::DVec3::ZERO; rest.len()];
    for t in &triangles {
        let [a, b, c] = t.map(|i| at(state.positions(), i));
        let mean = t.map(|i| at(state.velocities(), i)).into_iter().sum::<glam::DVec3>() / 3.0;
        let u = SKIRT.velocity.as_dvec3() - mean;
        let area = 0.5 * (b - a).cross(c - a).length();
        let normal = (b - a).cross(c - a).normalize();
        let lee = if normal.dot(u) < 0.0 { -normal } else { normal };
        let (s, cos) = (u.length(), u.normalize().dot(lee));
        let pressure = 0.5 * f64::from(AIR_DENSITY) * s * s;
        // Drag along u; lift in the plane of u and n, at right angles to u, of size sin cos.
        let across = lee - u / s * cos;
        let force = area * pressure * cos * (f64::from(SKIRT.drag) * u / s + f64::from(SKIRT.lift) * across);
        for &i in t {
            want[i as usize] += force / 3.0 * f64::from(state.weights()[i as usize]);
        }
    }
    let largest = want.iter().map(|a| a.length()).fold(0.0, f64::max);
    let worst = got.iter().zip(&want).map(|(g, w)| g.as_dvec3().distance(*w)).fold(0.0, f64::max);
    assert!(worst < 1e-5 * largest, "{worst} of {largest} m/s2");
}

#[test]
fn both_sides_of_a_triangle_are_alike() {
    let (mut state, rest, mut triangles, owner) = crumpled(6, 40);
    let faces = |triangles: &[[u32; 3]], state: &State| Faces::new(triangles, &rest, state.weights(), &owner);
    let before = accelerations(&faces(&triangles, &state), Width::widest(), &SKIRT, &mut state);
    triangles.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
    triangles.iter_mut().step_by(5).for_each(|t| t.rotate_left(1));
    assert_eq!(accelerations(&faces(&triangles, &state), Width::widest(), &SKIRT, &mut state), before);
}

/// The acceleration of a flat square of 100 g/m2.
fn on_square(normal: Vec3A, wind: &Wind) -> Vec3A {
    let (mut state, faces) = square(normal);
    accelerations(&faces, Width::widest(), wind, &mut state).iter().sum::<Vec3A>() / 4.0
}

#[test]
fn edge_on_there_is_no_force_head_on_no_lift_and_still_air_does_nothing() {
    let wind = Wind { velocity: Vec3A::new(3.0, 0.0, 0.0), drag: 0.1, lift: 0.05 };
    assert_eq!(on_square(Vec3A::Y, &wind), Vec3A::ZERO);
    let head_on = on_square(Vec3A::X, &wind);
    // 0.1 kg, 1 m2.
    let drag = 0.5 * AIR_DENSITY * 9.0 * 0.1 / 0.1;
    assert!((head_on - Vec3A::X * drag).length() < 1e-5 * drag, "{head_on}");
    let oblique = on_square(Vec3A::new(1.0, 1.0, 0.0).normalize(), &wind);
    let lift = 0.5 * AIR_DENSITY * 9.0 * 0.05 * 0.5 / 0.1;
    assert!((oblique.y - lift).abs() < 1e-5 * lift && oblique.z.abs() < 1e-6, "{oblique}, lift {lift}");
    assert_eq!(on_square(Vec3A::X, &Wind { velocity: Vec3A::ZERO, ..wind }), Vec3A::ZERO);
    assert_eq!(on_square(Vec3A::X, &Wind { drag: 0.0, lift: 0.0, ..wind }), Vec3A::ZERO);
}

#[test]
fn a_falling_sheet_reaches_its_terminal_velocity() {
    let (mut state, faces) = square(Vec3A::Y);
    let wind = Wind { velocity: Vec3A::ZERO, ..SKIRT };
    for _ in 0..120 * 10 {
        let air = accelerations(&faces, Width::widest(), &wind, &mut state);
        for (i, a) in air.iter().enumerate() {
            let columns = state.columns();
            columns.v[1].set(i, columns.v[1].get(i) + (a.y - 9.81) * DT);
            columns.x[1].set(i, columns.x[1].get(i) + columns.v[1].get(i) * DT);
        }
    }
    let expected = -(2.0 * 0.1 * 9.81 / (AIR_DENSITY * 0.1f32)).sqrt();
    let got = state.velocities()[1][0];
    assert!((got / expected - 1.0).abs() < 0.002, "{got} m/s, expected {expected}");
    assert!(state.velocities()[0][0].abs() < 1e-3, "a level sheet falls straight");
}

#[test]
fn no_storm_turns_the_relative_velocity_round() {
    let mut noise = noise(3);
    let mut bounded = 0;
    for _ in 0..500 {
        let normal = Vec3A::new(noise(), noise(), noise()).normalize();
        let speed = 10f32.powf(3.0 + 3.0 * noise());
        let velocity = Vec3A::new(noise(), noise(), noise()).normalize() * speed;
        let wind = Wind { velocity, drag: 1.5, lift: 1.0 };
        let change = on_square(normal, &wind) * DT;
        let (before, after) = (velocity.dot(normal), (velocity - change).dot(normal));
        assert!(before * after >= -1e-5 * before * before, "across: {before} becomes {after}");
        let along = |v: Vec3A| v - normal * v.dot(normal);
        let (before, after) = (along(velocity), along(velocity - change));
        assert!(before.dot(after) >= -1e-5 * velocity.length_squared(), "along: {before} becomes {after}");
        let k = 0.5 * AIR_DENSITY * speed * 2.5 * DT / 0.1;
        bounded += usize::from(k > 1.0);
    }
    assert!(bounded > 100, "the bound was hardly met");
}

#[test]
fn a_collapsed_triangle_and_a_pinned_one_do_nothing() {
    let mut state = State::new(&[Vec3::ONE; 3], &[1.0; 3]);
    let faces = Faces::new(&[[0, 1, 2]], &[Vec3::ONE; 3], &[1.0; 3], &[0; 3]);
    assert_eq!(accelerations(&faces, Width::widest(), &SKIRT, &mut state), [Vec3A::ZERO; 3]);
    let rest = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mut state = State::new(&rest, &[0.0; 3]);
    let faces = Faces::new(&[[0, 1, 2]], &rest, &[0.0; 3], &[0; 3]);
    assert_eq!(accelerations(&faces, Width::widest(), &SKIRT, &mut state), [Vec3A::ZERO; 3]);
}
