//! Tests of motion that every cloth obeys, whatever it is made of.

use glam::{Vec3, Vec3A};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Solver};
use toile_base::limits::{STEP_HZ, STEP_SECONDS};
use toile_engine::cloth::{Quality, Settings};
use toile_perf::oracle::{Problem, measure};
use toile_workspace::cloth::{Alone, plain_fabric, ripple, sheet, swing};
use toile_workspace::tolerance;

/// Half a second.
const STEPS: u32 = STEP_HZ / 2;

/// Cells of the sheet each way, and their length (m).
const CELLS: [u32; 2] = [8, 12];
const CELL_M: f32 = 0.04;

/// Lawn without air.
fn lawn() -> Fabric {
    Fabric { damping_per_s: 0.0, ..toile_assets::fabric::built_in("cotton-lawn").expect("a fabric that is built in") }
}

fn baked(shape: &Shape, fabric: &Fabric) -> Garment {
    bake("motion", "one", shape, fabric).expect("a sheet can be baked")
}

/// A sheet about the origin, where f32 is finest.
fn flat(pinned: bool) -> Shape {
    let [columns, rows] = CELLS.map(|n| n as f32 * CELL_M * 0.5);
    sheet(CELLS[0], CELLS[1], CELL_M, Vec3::new(-columns, rows, 0.0), pinned)
}

fn weightless(quality: Quality) -> Settings {
    Settings { gravity: Vec3A::ZERO, quality, ..Settings::default() }
}

/// Momentum and angular momentum that half a second adds to a cloth that flies, turns and ripples, over the sums of all
/// particles' own (1).
fn added(garment: &Garment, settings: &Settings) -> [f64; 2] {
    let mut alone = Alone::new(garment);
    alone.disturb(|_, p| (p, ripple(p, 1.0) + Vec3::new(0.4, 0.1, -0.2) + Vec3::new(0.3, 1.5, 0.4).cross(p)));
    let (before, size) = alone.momenta();
    (0..STEPS).for_each(|_| alone.step(settings));
    let (after, _) = alone.momenta();
    [0, 1].map(|k| (after[k] - before[k]).length() / size[k])
}

#[test]
fn momentum_is_kept_where_nothing_acts_from_outside() {
    let garment = baked(&flat(false), &lawn());
    for quality in Quality::ALL {
        let [linear, angular] = added(&garment, &weightless(quality));
        eprintln!("{quality}: momentum off by {linear:.1e}, angular momentum by {angular:.1e}");
        assert!(linear < tolerance::MOMENTUM, "{quality}: momentum changed by {linear:e}");
        assert!(angular < tolerance::ANGULAR_MOMENTUM, "{quality}: angular momentum changed by {angular:e}");
    }
}

#[test]
fn what_is_wrong_with_angular_momentum_goes_with_the_substep() {
    let garment = baked(&flat(false), &lawn());
    let of = |substeps| added(&garment, &Settings { substeps: Some(substeps), ..weightless(Quality::Shop) })[1];
    let [coarse, fine] = [of(4), of(32)];
    eprintln!("angular momentum off by {coarse:.1e} with 4 substeps, {fine:.1e} with 32");
    assert!(fine < 0.5 * coarse, "{coarse:e} with 4 substeps, {fine:e} with 32");
}

#[test]
fn what_is_at_rest_stays_at_rest() {
    for (pinned, quality) in [false, true].into_iter().flat_map(|pinned| Quality::ALL.map(|q| (pinned, q))) {
        let garment = baked(&flat(pinned), &lawn());
        let mut alone = Alone::new(&garment);
        (0..2 * STEPS).for_each(|_| alone.step(&weightless(quality)));
        let moved = |(p, start): (&Vec3A, &Vec3)| Vec3::from(*p).distance(*start);
        let off = alone.cloth.positions.iter().zip(&garment.start).map(moved).fold(0.0, f32::max);
        let strain = measure::strain(&Problem::of(&garment), &alone.state().x).max;
        eprintln!("{quality}, pinned {pinned}: strayed by {off:.1e} m, strain {strain:.1e}");
        assert!(off < if pinned { tolerance::REST_M } else { tolerance::DRIFT_M }, "{quality}: strayed by {off} m");
        assert!(strain < tolerance::REST_STRAIN, "{quality}, pinned {pinned}: strained by {strain}");
    }
}

#[test]
fn pinned_particles_never_move_whatever_pulls_at_them() {
    let garment = baked(&flat(true), &lawn());
    let mut alone = Alone::new(&garment);
    alone.disturb(|_, p| (p * 4.0, ripple(p, 100.0)));
    for step in 0..STEPS {
        alone.step(&Settings::default());
        for &i in &garment.fixed {
            let (p, start) = (alone.cloth.positions[i as usize], Vec3A::from(garment.start[i as usize]));
            assert!(p == start, "step {step}: pin {i} is at {p}, not at {start}");
        }
    }
    assert!(garment.fixed.len() > 2);
}

#[test]
fn no_energy_comes_from_nothing() {
    for (pinned, gravity) in [(false, 0.0), (true, -9.81)] {
        let garment = baked(&flat(pinned), &lawn());
        let problem = Problem { gravity: Vec3::new(0.0, gravity, 0.0).as_dvec3(), ..Problem::of(&garment) };
        for quality in Quality::ALL {
            let settings = Settings { gravity: Vec3A::new(0.0, gravity, 0.0), ..weightless(quality) };
            let mut alone = Alone::new(&garment);
            alone.disturb(|_, p| (p, ripple(p, 2.0)));
            let push = measure::energies(&problem, &alone.state()).kinetic_j;
            // What links hold is left out: it is never negative, and what a solver leaves of a stiff link's length is
            // no energy that it would give back.
            let free = |alone: &Alone<'_>| {
                let e = measure::energies(&problem, &alone.state());
                e.kinetic_j + e.bending_j + e.gravity_j
            };
            let begin = free(&alone);
            let mut half_second = || {
                let energy = |_| {
                    alone.step(&settings);
                    (free(&alone) - begin) / push
                };
                (0..STEPS).map(energy).fold(f64::MIN, f64::max)
            };
            let most = [(); 8].map(|()| half_second());
            eprintln!("{quality}, gravity {gravity}: {most:.4?} of the push above the begin, in each half second");
            assert!(most[0] < tolerance::ENERGY, "{quality}: {} of the energy came from nothing", most[0]);
            assert!(most.windows(2).all(|w| w[1] < w[0] + tolerance::ENERGY), "{quality}: energy grows: {most:?}");
        }
    }
}

#[test]
fn a_fiber_that_must_not_stretch_is_never_longer_than_it_was_cut() {
    let mut shape = flat(true);
    shape.solver.warp = Some(Solver::ZeroStretch);
    let garment = baked(&shape, &plain_fabric(0.2, 1_000.0, 0.5));
    let warp = |[a, b]: [u32; 2]| (garment.start[a as usize].x - garment.start[b as usize].x).abs() < 0.1 * CELL_M;
    let warp: Vec<_> = garment.strain_edges.iter().filter(|(ends, _)| warp(*ends)).collect();
    let mut alone = Alone::new(&garment);
    alone.disturb(|_, p| (p, ripple(p, 3.0)));
    let mut longest = 0.0f32;
    for _ in 0..4 * STEPS {
        alone.step(&Settings::default());
        let at = |i: u32| alone.cloth.positions[i as usize];
        let over = warp.iter().map(|([a, b], rest)| at(*a).distance(at(*b)) / rest - 1.0);
        longest = over.fold(longest, f32::max);
    }
    eprintln!("longest by {longest:.2e} of its length");
    assert!(longest < tolerance::ZERO_STRETCH, "a link was longer than cut by {longest} of its length");
    assert_eq!(warp.len() as u32, (CELLS[0] + 1) * CELLS[1]);
}

/// Where a disturbed cloth's vertices are after half a second, with everything mirrored by `mirror` (m) `[vertices]`.
fn swung(garment: &Garment, mirror: Vec3) -> Vec<Vec3> {
    let mut alone = Alone::new(garment);
    alone.disturb(|_, p| (p, mirror * swing(p * mirror, 1.0)));
    (0..STEPS).for_each(|_| alone.step(&Settings::default()));
    let mut out = vec![Vec3::ZERO; garment.particles()];
    garment.source.iter().zip(&alone.cloth.positions).for_each(|(&v, p)| out[v as usize] = (*p).into());
    out
}

#[test]
fn the_mirror_image_of_a_cloth_moves_as_its_mirror_image() {
    let garment = baked(&flat(true), &lawn());
    let plain = swung(&garment, Vec3::ONE);
    // Front and back know of no order: the very same bits.
    let turned = swung(&garment, Vec3::new(1.0, 1.0, -1.0));
    assert!(plain.iter().zip(&turned).all(|(p, q)| *p == Vec3::new(q.x, q.y, -q.z)), "front and back differ");
    // Left and right are solved one after the other.
    let sides = swung(&garment, Vec3::new(-1.0, 1.0, 1.0));
    let columns = CELLS[0] as usize + 1;
    let mirrored = |v: usize| v / columns * columns + columns - 1 - v % columns;
    let off = |v: usize| (sides[mirrored(v)] * Vec3::new(-1.0, 1.0, 1.0)).distance(plain[v]);
    let off = (0..plain.len()).map(off).fold(0.0, f32::max) / (CELLS[1] as f32 * CELL_M);
    eprintln!("left and right differ by {off:.1e} of the length");
    assert!(off < tolerance::MIRROR, "left and right differ by {off} of the length");
}

/// Where a cloth `scale` times as large is after a time that is longer by the root of that, over the scale (m).
fn similar(scale: f32) -> Vec<Vec3> {
    let mut shape = flat(true);
    shape.cut.iter_mut().chain(&mut shape.worn).for_each(|p| *p *= scale);
    let lawn = lawn();
    // Strain by weight goes with length over stiffness, the bending length with the third root of the rigidity.
    let fabric = Fabric {
        stretch_warp_n_m: lawn.stretch_warp_n_m * scale,
        stretch_weft_n_m: lawn.stretch_weft_n_m * scale,
        shear_n_m: lawn.shear_n_m * scale,
        bend_warp_un_m: lawn.bend_warp_un_m * scale.powi(3),
        bend_weft_un_m: lawn.bend_weft_un_m * scale.powi(3),
        damping_per_s: 1.0 / scale.sqrt(),
        ..lawn
    };
    let garment = baked(&shape, &fabric);
    let settings = Settings {
        step_seconds: STEP_SECONDS * scale.sqrt(),
        substeps: Some(6),
        max_speed: 15.0 * scale.sqrt(),
        ..Settings::default()
    };
    let mut alone = Alone::new(&garment);
    alone.disturb(|_, p| (p, swing(p / scale, 1.0) * scale.sqrt()));
    (0..STEPS).for_each(|_| alone.step(&settings));
    assert_eq!(alone.cloth.events, Default::default(), "nothing had to be held");
    alone.cloth.positions.iter().map(|p| Vec3::from(*p) / scale).collect()
}

#[test]
fn a_garment_of_another_size_behaves_similarly() {
    let one = similar(1.0);
    for scale in [0.1, 10.0] {
        let other = similar(scale);
        let off = one.iter().zip(&other).map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
        let off = off / (CELLS[1] as f32 * CELL_M);
        eprintln!("{scale} times as large: {off:.1e} of the length off");
        assert!(off < tolerance::SCALE, "{scale} times as large: {off} of the length off");
    }
}
