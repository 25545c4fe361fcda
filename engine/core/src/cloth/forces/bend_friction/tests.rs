//! Friction in bending against its curve in f64, against itself at every width, and against the quantities that must stay.

use glam::{DVec3, Quat, Vec3};
use toile_assets::scene::skirt::{self, Stretch};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::fabric::friction_element::{FrictionElement, read_loop};
use toile_base::fabric::loop_widths::LoopWidths;
use toile_base::garment::bend_friction::FrictionSlot;
use toile_base::garment::layout::OWNERS;
use toile_base::garment::{Garment, Part};
use toile_base::mesh::SkinWeights;

use super::*;
use crate::cloth::state::State;
use crate::lanes::Width;

/// Cotton broad cloth, wool tropical, polyester faille as published (Matsudaira et al. 2015): B (uN m), 2HB (mN).
const PUBLISHED: [[f32; 2]; 3] = [[11.572, 1.21602], [6.5705, 0.32362], [1.86326, 0.0686466]];

/// Curvature to which the loops of bending are made (1/m), and between which they are read.
const LOOP: (f64, [f64; 2]) = (250.0, [50.0, 150.0]);

fn rubbing(fabric: &mut Fabric, [b, width]: [f32; 2]) {
    (fabric.bend_warp_un_m, fabric.bend_weft_un_m) = (b, b);
    fabric.hysteresis = LoopWidths { bend_warp_mn: width, bend_weft_mn: width, ..LoopWidths::default() };
}

/// A grid, whose slots are strips, and a mesh whose slots are blocks.
fn garments() -> Vec<Garment> {
    let shapes = [skirt::shape(32), skirt::irregular(23, 2)];
    let baked = |shape| {
        let mut fabric = skirt::fabric(&shape, Stretch::Inextensible);
        rubbing(&mut fabric, PUBLISHED[0]);
        bake("skirt", "one", &shape, &fabric).unwrap()
    };
    shapes.into_iter().map(baked).collect()
}

/// A strip of `rows` by 8 squares of 10 mm, hanging as it was cut.
fn strip(rows: u32, numbers: [f32; 2]) -> Garment {
    const ACROSS: u32 = 8;
    let mut shape = Shape::default();
    for (row, column) in (0..=rows).flat_map(|r| (0..=ACROSS).map(move |c| (r, c))) {
        let p = Vec3::new(0.01 * column as f32, -0.01 * row as f32, 0.0);
        shape.push(p, p, row == 0, Part::All);
        shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
    }
    let at = |r: u32, c: u32| r * (ACROSS + 1) + c;
    let cells = (0..rows).flat_map(|r| (0..ACROSS).map(move |c| (r, c)));
    shape.faces = cells.map(|(r, c)| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)]).collect();
    let mut fabric = toile_assets::fabric::built_in("wool-suiting").unwrap();
    rubbing(&mut fabric, numbers);
    bake("strip", "one", &shape, &fabric).unwrap()
}

/// What a garment's friction does, step after step.
struct Rubbed<'a> {
    garment: &'a Garment,
    friction: FrictionRows,
    state: FrictionState,
    width: Width,
}

impl<'a> Rubbed<'a> {
    fn new(garment: &'a Garment, width: Width) -> Self {
        let mut friction = FrictionRows::new(garment);
        friction.prepare(garment, 1e-4, 8, &mut vec![0.0; garment.start.len()]);
        Self { garment, state: FrictionState::new(&friction, garment.start.len()), friction, width }
    }

    /// Velocities that come of these places in a second.
    fn pushed(&mut self, places: &[Vec3]) -> Vec<Vec3> {
        let mut state = State::new(places, &self.garment.inverse_mass);
        let (c, f, friction) = (state.columns(), self.state.columns(), &self.friction);
        for owner in 0..OWNERS {
            self.width.run(FrictionMoments { friction, owner, from: c.x, state: f, turns: true });
        }
        for owner in 0..OWNERS {
            self.width.run(FrictionForces { friction, owner, kept: f.kept, to: c.v, by: 1.0 });
        }
        (0..places.len()).map(|i| Vec3::from_array(state.velocities().map(|a| a[i]))).collect()
    }
}

/// The normal and the signed sum of a slot in f64.
fn bent(garment: &Garment, slot: &FrictionSlot, places: &[Vec3]) -> (DVec3, f64) {
    let at = |i: u32| places[i as usize].as_dvec3();
    let [a, b, c, d] = slot.chords.map(at);
    let normal = (a - b).cross(c - d).normalize();
    let others = garment.layout().friction.entries(slot);
    (normal, others.map(|(i, c)| (at(i) - at(slot.centre)) * f64::from(c)).sum::<DVec3>().dot(normal))
}

/// The same pushes by the curve in f64, slot after slot.
fn exact(garment: &Garment, elements: &mut [FrictionElement], places: &[Vec3]) -> Vec<DVec3> {
    let mut out = vec![DVec3::ZERO; places.len()];
    let friction = &garment.layout().friction;
    for (slot, element) in friction.slots.iter().zip(elements) {
        let (normal, sum) = bent(garment, slot, places);
        let kept = normal * element.friction(sum);
        let mut push = |i: u32, c: f64| out[i as usize] -= kept * (c * f64::from(garment.inverse_mass[i as usize]));
        friction.entries(slot).for_each(|(i, c)| push(i, f64::from(c)));
        push(slot.centre, -friction.entries(slot).map(|(_, c)| f64::from(c)).sum::<f64>());
    }
    out
}

/// Places that wander away from rest and back.
fn shaken(garment: &Garment, time: f32) -> Vec<Vec3> {
    let by = |i: usize| Vec3::new((1.3 * i as f32).sin(), (0.7 * i as f32).cos(), (2.1 * i as f32).sin());
    garment.start.iter().enumerate().map(|(i, p)| *p + 0.003 * time.sin() * by(i)).collect()
}

#[test]
fn rows_follow_the_curve_identically_at_every_width() {
    for garment in garments() {
        let widths: Vec<Width> = Width::ALL.into_iter().filter(|w| w.available()).collect();
        let mut rubbed: Vec<Rubbed<'_>> = widths.iter().map(|w| Rubbed::new(&garment, *w)).collect();
        let slots = &garment.layout().friction.slots;
        let stiff = |s: &FrictionSlot| f64::from(rubbed[0].friction.stick()[rubbed[0].friction.number(s)]);
        let element = |s: &FrictionSlot| FrictionElement {
            stiffness: 0.0,
            sticking: stiff(s),
            half_width: f64::from(s.limit),
            stuck: 0.0,
        };
        let mut elements: Vec<FrictionElement> = slots.iter().map(element).collect();
        assert!(slots.len() > garment.start.len());
        for step in 0..40 {
            let places = shaken(&garment, 0.4 * step as f32);
            let expected = exact(&garment, &mut elements, &places);
            let plain = rubbed[0].pushed(&places);
            let size = expected.iter().map(|v| v.length()).fold(0.0, f64::max);
            let off = plain.iter().zip(&expected).map(|(a, b)| a.as_dvec3().distance(*b)).fold(0.0, f64::max);
            assert!(size > 0.0 && off < 2e-3 * size, "step {step}: {off} of {size}");
            for (rubbed, width) in rubbed[1..].iter_mut().zip(&widths[1..]) {
                assert_eq!(rubbed.pushed(&places), plain, "{width} lanes, step {step}");
            }
        }
    }
}

#[test]
fn a_strip_rolled_up_and_down_gives_back_the_width_of_its_loop() {
    for numbers in PUBLISHED {
        let garment = strip(12, numbers);
        let mut rubbed = Rubbed::new(&garment, Width::widest());
        let slots = &garment.layout().friction.slots;
        let inner = |s: &&FrictionSlot| {
            s.kind == 0 && garment.start[s.centre as usize].distance(Vec3::new(0.04, -0.06, 0.0)) < 1e-4
        };
        let slot = *slots.iter().find(inner).unwrap();
        let number = rubbed.friction.number(&slot);
        let mut moment = |curvature: f64| {
            let chord = |s: f64| {
                let turn = 2.0 * (0.5 * 0.01 * curvature).asin() / 0.01 * s;
                if curvature.abs() < 1e-9 { (s, 0.0) } else { (turn.sin() / curvature, (1.0 - turn.cos()) / curvature) }
            };
            let place = |p: &Vec3| {
                let (down, out) = chord(-f64::from(p.y));
                Vec3::new(p.x, -down as f32, out as f32)
            };
            let places: Vec<Vec3> = garment.start.iter().map(place).collect();
            rubbed.pushed(&places);
            let [x, y, z] = rubbed.state.columns().kept.map(|k| f64::from(k.get(number)));
            let (normal, sum) = bent(&garment, &slot, &places);
            // Sums have the root of B A within: over that of A it is a moment, with B.
            let root = (f64::from(numbers[0]) * 1e-6 * 1e-4).sqrt();
            (sum + DVec3::new(x, y, z).dot(normal)) * root / 1e-4
        };
        let read = read_loop(LOOP.0 * 0.6, [LOOP.1[0] * 0.6, LOOP.1[1] * 0.6], &mut moment);
        let (stiffness, width) = (f64::from(numbers[0]) * 1e-6, f64::from(numbers[1]) * 1e-3);
        assert!((read.slope.abs() / stiffness - 1.0).abs() < 0.01, "{} of {stiffness}", read.slope);
        assert!((read.width.abs() / width - 1.0).abs() < 0.01, "{} of {width}", read.width);
    }
}

#[test]
fn turned_as_a_whole_it_keeps_what_it_kept() {
    for garment in garments() {
        let mut rubbed = Rubbed::new(&garment, Width::widest());
        let places = shaken(&garment, 1.0);
        let here = rubbed.pushed(&places);
        let turn = Quat::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 1.1);
        let turned: Vec<Vec3> = places.iter().map(|p| turn * *p + Vec3::new(0.2, -0.1, 0.3)).collect();
        let there = rubbed.pushed(&turned);
        let size = here.iter().map(|v| v.length()).fold(0.0, f32::max);
        let off = here.iter().zip(&there).map(|(a, b)| (turn * *a).distance(*b)).fold(0.0, f32::max);
        assert!(off < 1e-2 * size, "{off} of {size}");
    }
}

#[test]
fn a_fabric_without_numbers_has_no_slots_and_what_is_no_number_makes_nothing_slip() {
    let garment = strip(8, [10.0, 0.0]);
    assert!(garment.layout().friction.slots.is_empty() && !FrictionRows::new(&garment).acts());
    let garment = strip(8, PUBLISHED[0]);
    let mut rubbed = Rubbed::new(&garment, Width::widest());
    let mut places: Vec<Vec3> = garment.start.to_vec();
    places[30] = Vec3::NAN;
    rubbed.pushed(&places);
    assert!(rubbed.state.sticks().iter().all(|s| s.is_finite()));
}
