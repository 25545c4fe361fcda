//! A kernel at a time, on what is disturbed.

use glam::Vec3A;
use toile_assets::scene::skirt::Stretch;
use toile_base::garment::Garment;
use toile_base::garment::layout::OWNERS;
use toile_base::numeric::portable;
use toile_engine::cloth::forces::bending;
use toile_engine::cloth::forces::root::{RootMotion, RootStep};
use toile_engine::cloth::forces::stiff_bending::{self, StiffBendingUpdate};
use toile_engine::cloth::forces::wind::{Accelerations, Faces, WindPart};
use toile_engine::cloth::state::pins::Pins;
use toile_engine::cloth::state::{self, State};
use toile_engine::cloth::step::prepared::Prepared;
use toile_engine::cloth::{
    RootSettings, Settings, Wind, centre,
    forces::predict,
    links::{self, diagonals, fibers, lists, records, tethers},
    step::settle,
};
use toile_engine::lanes::{RECORD, ReadColumn, Store, Width, WriteColumn};
use toile_gpu::cloth::Kernel;

use super::scene::{apart, around, disturbed, no_body, offload, skirt, stiffened, swaying, worn};

/// What a kernel may be off by on a device that fuses products and sums (m). A tenth of the f32 rounding of a metre, a
/// hundredfold: a fiber's system carries errors of its upper links down.
const BOUND: f32 = 1e-5;

/// The same of a velocity (m/s): a unit in the last place of a coordinate of 1 to 2 m, 1.2e-7 m, over a substep of 1/480 s.
const VELOCITY_BOUND: f32 = 6e-5;

/// A garment's CPU side of a substep.
struct Reference<'a> {
    garment: &'a Garment,
    settings: &'a Settings,
    prepared: Prepared,
    state: State,
    pins: Pins,
}

impl<'a> Reference<'a> {
    fn new(garment: &'a Garment, settings: &'a Settings, x: &[Vec3A], v: &[Vec3A]) -> Self {
        let mut prepared = Prepared::new(garment);
        prepared.make(garment, settings);
        let positions: Vec<_> = x.iter().map(|p| (*p).into()).collect();
        let mut state = State::new(&positions, &garment.inverse_mass);
        let columns = state.columns();
        v.iter().enumerate().for_each(|(i, v)| state::set(columns.v, i, *v));
        let mut pins = Pins::new(garment);
        pins.attach(garment, &swaying(3));
        Self { garment, settings, prepared, state, pins }
    }

    fn run(&mut self, kernel: Kernel) {
        let (garment, layout, p) = (self.garment, self.garment.layout(), &self.prepared);
        let columns = self.state.columns();
        let width = self.settings.width;
        let per_dt2 = (p.dt * p.dt).recip();
        let scratch_lens = [fibers::scratch_len(&layout.fibers), lists::scratch_len(&layout.crossing)];
        let mut scratch = Store::zeros(scratch_lens[0].max(scratch_lens[1]));
        let tensions = layout.weft.tuples.count.max(layout.fibers.links).max(layout.crossing.rest.len());
        let mut tension = Store::zeros(tensions);
        let mut scratch_columns = diagonals::DiagonalScratch::new(&layout.diagonals, garment.particles());
        let spans = |owner: usize| &layout.spans[owner][..];
        match kernel {
            Kernel::Bending => {
                let by = p.dt * p.bend.every as f32;
                bend(garment, p, columns.w, [columns.x, columns.v], by, width);
            }
            Kernel::Predict => {
                for owner in 0..OWNERS {
                    let damping_factor = portable::exp(-garment.fabric.damping_per_s * p.dt);
                    let (gravity_step, acceleration) = (self.settings.gravity * p.dt, None);
                    width.run(predict::Predict {
                        columns,
                        spans: spans(owner),
                        gravity_step,
                        acceleration,
                        damping_factor,
                        dt: p.dt,
                    });
                }
                let to = 1.0 / p.substeps as f32;
                for (k, &i) in garment.fixed.iter().enumerate() {
                    state::set(columns.x, i as usize, self.pins.start[k].lerp(self.pins.end[k], to));
                }
            }
            Kernel::Diagonals => {
                let (diagonals, gamma, per_dt2) = (&layout.diagonals, p.gamma, per_dt2 / p.shear_every as f32);
                for strand in diagonals.families.iter().flatten() {
                    let scratch_columns = scratch_columns.columns();
                    let links = [&diagonals.rest, &diagonals.compliance].map(|c| ReadColumn::new(c));
                    width.run(diagonals::SolveDiagonals {
                        columns,
                        diagonals,
                        links,
                        strand,
                        scratch_columns,
                        per_dt2,
                        gamma,
                    });
                }
            }
            Kernel::Shear | Kernel::Weft => {
                let weft = kernel == Kernel::Weft;
                let (links, gains) = if weft { (&layout.weft, &p.weft) } else { (&layout.shear, &p.shear) };
                for set in &links.tuples.sets {
                    for owner in 0..OWNERS {
                        let tension = (weft && p.soft[0]).then(|| (tension.column(), per_dt2));
                        let gamma = p.gamma;
                        let parameters = links::LinkColumns::baked(links, gains, gamma > 0.0 || tension.is_some());
                        width.run(links::SolveLinks { columns, links, parameters, set, owner, gamma, tension });
                    }
                }
            }
            Kernel::Fibers | Kernel::Cyclic => {
                for owner in 0..OWNERS {
                    width.run(fibers::SolveFibers {
                        columns,
                        fibers: &layout.fibers,
                        links: [&layout.fibers.rest, &layout.fibers.compliance].map(|c| ReadColumn::new(c)),
                        least: None,
                        owner,
                        scratch: scratch.column(),
                        per_dt2,
                        gamma: p.gamma,
                        taut: p.taut,
                        tension: p.soft[1].then(|| tension.column()),
                    });
                }
            }
            Kernel::Lists => {
                for (set, owner) in (0..layout.crossing.sets.len()).flat_map(|s| [(s, 0), (s, 1)]) {
                    let (lists, scratch) = (&layout.crossing, scratch.column());
                    let tension = p.soft[2].then(|| tension.column());
                    let links = [&lists.rest, &lists.compliance].map(|c| ReadColumn::new(c));
                    width.run(lists::SolveCrossing { columns, lists, links, set, owner, scratch, per_dt2, tension });
                }
            }
            Kernel::Tethers => {
                for owner in 0..OWNERS {
                    width.run(tethers::HoldTethers { columns, tethers: &layout.tethers, spans: spans(owner) });
                }
            }
            Kernel::Settle => {
                let max_speed = self.settings.max_speed;
                for owner in 0..OWNERS {
                    width.run(settle::Settle { columns, spans: spans(owner), max_speed, dt: p.dt });
                }
            }
            other => panic!("{other:?} has no reference of its own"),
        }
    }

    /// All stages of bending that is stiffer than a substep.
    fn run_stages(&mut self) {
        let (garment, p) = (self.garment, &self.prepared);
        let columns = self.state.columns();
        let (width, spans) = (self.settings.width, [(0, garment.particles() as u32)]);
        let mut scratch_columns = stiff_bending::StiffBendingScratch::new(garment.particles());
        let scratch_columns = scratch_columns.columns();
        let last = p.bending.stages;
        for stage in 0..=last {
            let turn = match stage {
                0 => StiffBendingUpdate::Begin {
                    gravity_step: self.settings.gravity * p.dt,
                    acceleration: None,
                    dt: p.dt,
                },
                j if j == last => StiffBendingUpdate::End(j),
                1 => StiffBendingUpdate::First([p.stages[0], p.stages[1]]),
                j => StiffBendingUpdate::Next(j + 1, p.stages[j as usize]),
            };
            width.run(stiff_bending::ApplyStiffBending { columns, spans: &spans, scratch_columns, turn });
            if stage == last {
                break;
            }
            let (from_to, by) = match stage {
                0 => ([scratch_columns[1], scratch_columns[0]], p.dt),
                j => (
                    [j, j + 1].map(|j| scratch_columns[stiff_bending::place(j)]),
                    p.stages[j as usize].forced * p.dt * p.dt,
                ),
            };
            bend(garment, p, columns.w, from_to, by, width);
        }
    }

    fn particles(&self) -> (Vec<Vec3A>, Vec<Vec3A>) {
        let three = |c: [&[f32]; 3]| (0..c[0].len()).map(|i| Vec3A::new(c[0][i], c[1][i], c[2][i])).collect();
        (three(self.state.positions()), three(self.state.velocities()))
    }
}

/// What bends one thing and pushes another.
fn bend(
    garment: &Garment,
    p: &Prepared,
    w: WriteColumn<'_>,
    [from, to]: [[WriteColumn<'_>; 3]; 2],
    by: f32,
    width: Width,
) {
    let mut records = Store::zeros(RECORD * garment.particles());
    let records = records.column();
    for owner in 0..OWNERS {
        let spans = &garment.layout().spans[owner];
        width.run(records::FillRecords { from, w, spans, records });
    }
    for owner in 0..OWNERS {
        width.run(bending::Bend { matrix: &p.matrix, owner, from, records, to, by });
    }
}

/// Holds one kernel against its reference; a software adapter, which fuses nothing, to the bit.
fn held(name: &str, garment: &Garment, settings: &Settings, kernel: Kernel) {
    let Some(mut gpu) = offload(&[garment], settings) else { return };
    let (mut x, v) = disturbed(garment);
    if kernel == Kernel::Tethers {
        // Drawn out by a tenth, so that tethers have something to hold.
        x.iter_mut().for_each(|p| p.y -= 0.1 * (1.2 - p.y));
    }
    let mut reference = Reference::new(garment, settings, &x, &v);
    reference.run(kernel);
    let (palette, colliders) = (swaying(3), no_body());
    let steps = [around(&palette, &colliders, settings)];
    gpu.disturb(0, &x, &v);
    gpu.only(kernel, 0, &[garment], &steps).expect("the kernel runs");
    let got = gpu.particles(0).expect("the state is read");
    let expected = reference.particles();
    let (same_x, all, most_x) = apart(&got.x, &expected.0);
    let (same_v, _, most_v) = apart(&got.v, &expected.1);
    let moved = apart(&expected.0, &x).2.max(apart(&expected.1, &v).2);
    println!("{name} {kernel:?}: {same_x} and {same_v} of {all} the same, {most_x} m and {most_v} m/s apart");
    assert!(most_x <= BOUND && most_v <= VELOCITY_BOUND, "{name} {kernel:?}: {most_x} m, {most_v} m/s");
    if gpu.device().adapter().kind == "software" {
        assert_eq!((same_x, same_v), (all, all), "{name} {kernel:?}: {most_x} m, {most_v} m/s");
    }
    let empty = match kernel {
        Kernel::Shear => garment.layout().shear.rest.is_empty(),
        Kernel::Lists => garment.layout().crossing.lists.is_empty(),
        Kernel::Diagonals => garment.layout().diagonals.families.is_empty(),
        _ => false,
    };
    assert!(empty || moved > 0.0 || kernel == Kernel::Settle, "{name} {kernel:?}: nothing was asked of the kernel");
}

const KERNELS: [Kernel; 9] = [
    Kernel::Bending,
    Kernel::Predict,
    Kernel::Diagonals,
    Kernel::Shear,
    Kernel::Weft,
    Kernel::Lists,
    Kernel::Fibers,
    Kernel::Tethers,
    Kernel::Settle,
];

/// What cyclic reduction may be off by (m): it rounds in another order, on a system whose errors add up along the fiber.
const CYCLIC_BOUND: f32 = 2e-5;

#[test]
fn few_long_fibers_come_out_as_one_by_one() {
    let tall = Settings { stretch_damping_s: 0.004, ..Settings::default() };
    for (n, settings) in [(98, Settings::default()), (130, tall)] {
        for stretch in [Stretch::Inextensible, Stretch::Physical] {
            let garment = skirt(n, stretch);
            let Some(mut gpu) = offload(&[&garment], &settings) else { return };
            let (mut x, v) = disturbed(&garment);
            // Millimetres are too much for links of as many: a tenth.
            x.iter_mut().zip(&garment.start).for_each(|(x, s)| *x = Vec3A::from(*s).lerp(*x, 0.1));
            let mut reference = Reference::new(&garment, &settings, &x, &v);
            reference.run(Kernel::Cyclic);
            let (palette, colliders) = (swaying(3), no_body());
            gpu.disturb(0, &x, &v);
            let steps = [around(&palette, &colliders, &settings)];
            gpu.only(Kernel::Fibers, 0, &[&garment], &steps).expect("nothing is left for it");
            gpu.only(Kernel::Cyclic, 0, &[&garment], &steps).expect("the kernel runs");
            let (got, expected) = (gpu.particles(0).expect("the state is read").x, reference.particles().0);
            let (most, moved) = (apart(&got, &expected).2, apart(&expected, &x).2);
            println!("{n} rows, {stretch:?}: {most} m apart, {moved} m moved");
            assert!(most <= CYCLIC_BOUND && moved > 20.0 * most, "{n} rows, {stretch:?}: {most} m apart of {moved} m");
        }
    }
}

/// Compares numbers with the reference's; a software adapter's to the bit.
fn alike(name: &str, software: bool, got: &[Vec3A], expected: &[Vec3A]) {
    let (same, all, most) = apart(got, expected);
    let size = expected.iter().map(|v| v.length()).fold(0.0, f32::max);
    println!("{name}: {same} of {all} the same, {most} apart of {size}");
    assert!(size > 0.0, "{name}: nothing was asked of the kernels");
    assert!(most <= BOUND * size.max(1.0), "{name}: {most} apart");
    assert!(!software || same == all, "{name}: {most} apart on an adapter that fuses nothing");
}

/// The wind's accelerations.
fn blow(garment: &Garment, settings: &Settings, wind: &Wind, reference: &mut Reference<'_>, to: &mut Accelerations) {
    let faces = Faces::new(&garment.triangles, &garment.start, &garment.inverse_mass, &garment.layout().owner);
    for part in WindPart::ALL {
        faces.blow(settings.width, part, wind, settings.step_seconds, reference.state.columns(), to.columns());
    }
}

#[test]
fn wind_agrees_with_its_reference() {
    let garments = [skirt(24, Stretch::Inextensible), worn("tee")];
    // Of moderate strength, and so strong that the bound holds it.
    for (garment, speed) in garments.iter().flat_map(|g| [(g, 3.0), (g, 900.0)]) {
        let wind = Wind { velocity: Vec3A::new(speed, 0.2, -0.5 * speed), drag: 0.8, lift: 0.3 };
        let settings = Settings { wind: Some(wind), ..Settings::default() };
        let Some(mut gpu) = offload(&[garment], &settings) else { return };
        let (x, v) = disturbed(garment);
        let mut reference = Reference::new(garment, &settings, &x, &v);
        let mut acceleration = Accelerations::new(garment.particles());
        blow(garment, &settings, &wind, &mut reference, &mut acceleration);
        gpu.disturb(0, &x, &v);
        let (palette, colliders) = (swaying(3), no_body());
        for kernel in [Kernel::Wind, Kernel::WindForces] {
            gpu.only(kernel, 0, &[garment], &[around(&palette, &colliders, &settings)]).expect("the kernel runs");
        }
        let expected: Vec<Vec3A> = (0..garment.particles()).map(|i| acceleration.of(i)).collect();
        let software = gpu.device().adapter().kind == "software";
        alike(&format!("{} in {speed} m/s", garment.name), software, &gpu.accelerations(0).expect("read"), &expected);
    }
}

/// Holds what of the root is not to be felt against its reference, beside wind or without.
fn carried(wind: Option<Wind>) {
    let root = RootSettings { linear: 0.3, angular: 0.1, centrifugal: 0.6, ..RootSettings::default() };
    let (garment, settings) = (skirt(24, Stretch::Inextensible), Settings { root, wind, ..Settings::default() });
    let Some(mut gpu) = offload(&[&garment], &settings) else { return };
    let (x, v) = disturbed(&garment);
    let mut reference = Reference::new(&garment, &settings, &x, &v);
    let mut acceleration = Accelerations::new(garment.particles());
    let mut motion = RootMotion::new(root);
    gpu.disturb(0, &x, &v);
    if let Some(wind) = wind {
        blow(&garment, &settings, &wind, &mut reference, &mut acceleration);
    }
    let (colliders, software) = (no_body(), gpu.device().adapter().kind == "software");
    // The root is new in the first, and starts in the second; `blown` goes last, as in a step.
    for (kernel, n) in [(Kernel::Wind, 3), (Kernel::RootCompensation, 7), (Kernel::WindForces, 7)] {
        let palette = swaying(n);
        gpu.only(kernel, 0, &[&garment], &[around(&palette, &colliders, &settings)]).expect("the kernel runs");
        let at = palette[0] * glam::Affine3A::from_translation(centre(&garment).into());
        let moved = motion.advance(&at, settings.step_seconds);
        if let (Kernel::RootCompensation, RootStep::Carried(carried)) = (kernel, moved) {
            let all = (0, garment.particles() as u32);
            carried.apply(settings.width, reference.state.columns(), all, acceleration.columns());
        }
    }
    let name = if wind.is_some() { "carry in the wind" } else { "carry" };
    let expected: Vec<Vec3A> = (0..garment.particles()).map(|i| acceleration.of(i)).collect();
    alike(name, software, &gpu.accelerations(0).expect("read"), &expected);
    alike(name, software, &gpu.particles(0).expect("read").v, &reference.particles().1);
}

#[test]
fn root_compensation_agrees_with_its_reference() {
    carried(None);
    carried(Some(Wind { velocity: Vec3A::new(4.0, 0.5, -3.0), drag: 0.6, lift: 0.2 }));
}

#[test]
fn bending_stages_agree_with_their_reference() {
    // No fabric of the wardrobe is so stiff that a garment needs stages.
    let garment = &stiffened("tee", 60.0);
    let mut seen = Vec::new();
    for (substeps, longer) in [(3, 1.0), (1, 1.0), (1, 2.0), (1, 2.3), (1, 8.0), (1, 60.0)] {
        let step_seconds = longer * Settings::default().step_seconds;
        let settings = Settings { substeps: Some(substeps), step_seconds, ..Settings::default() };
        let Some(mut gpu) = offload(&[garment], &settings) else { return };
        let (x, v) = disturbed(garment);
        let mut reference = Reference::new(garment, &settings, &x, &v);
        let last = reference.prepared.bending.stages;
        if last < 2 {
            continue;
        }
        seen.push(last);
        reference.run_stages();
        gpu.disturb(0, &x, &v);
        let (palette, colliders) = (swaying(3), no_body());
        for stage in 0..=last {
            let kernels = [Kernel::StageCombine, Kernel::StageBending];
            for kernel in kernels.into_iter().filter(|k| stage < last || *k == Kernel::StageCombine) {
                let step = around(&palette, &colliders, &settings);
                gpu.only(kernel, stage, &[garment], &[step]).expect("the kernel runs");
            }
        }
        let software = gpu.device().adapter().kind == "software";
        let name = format!("{} in {last} stages", garment.name);
        alike(&name, software, &gpu.particles(0).expect("read").v, &reference.particles().1);
    }
    // Odd and even numbers end in another scratch column; bending beyond the most stages is weakened.
    assert!(seen.iter().any(|m| m % 2 == 0) && seen.iter().any(|m| m % 2 == 1), "{seen:?}");
    assert_eq!(seen.iter().max(), Some(&stiff_bending::MAX_BENDING_STAGES));
}

#[test]
fn every_kernel_agrees_on_the_skirt() {
    let settings = Settings { tethers: true, ..Settings::default() };
    let damped = Settings { stretch_damping_s: 0.01, ..settings };
    let (rigid, soft) = (skirt(24, Stretch::Inextensible), skirt(19, Stretch::Physical));
    for kernel in KERNELS {
        held("skirt", &rigid, &settings, kernel);
        held("skirt that stretches", &soft, &settings, kernel);
        held("skirt that damps", &rigid, &damped, kernel);
    }
}

#[test]
fn every_kernel_agrees_on_a_wardrobe_garment() {
    let (shirt, settings) = (worn("tee"), Settings { tethers: true, ..Settings::default() });
    for kernel in KERNELS {
        held("shirt", &shirt, &settings, kernel);
    }
}
