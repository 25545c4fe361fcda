//! The constraints of a garment: what is counted, what is walked through, and where indices end.

use glam::Vec3;

use super::bend_friction::{BendFriction, FrictionSlot};
use super::layout::{
    BundleRow, ConstraintRun, ConstraintSet, Diagonals, FiberLists, HubGroup, Hubs, Layout, OwnerShare, Tethers,
};
use super::link_curves::{CurveTable, ONE_SLOPE};
use super::{Direction, Garment, GarmentAppearance, GarmentData, LayoutError, Part};
use crate::fabric::Fabric;

fn zeros(count: usize) -> Box<[f32]> {
    vec![0.0; count].into()
}

/// One set whose only share has so many loose constraints.
fn loose_set(count: u32) -> Box<[ConstraintSet]> {
    let share = OwnerShare { loose: 0..count, ..OwnerShare::default() };
    [ConstraintSet { direction: Direction::Warp, crosses: false, shares: [share, OwnerShare::default()] }].into()
}

#[test]
fn the_memory_of_constraints_is_the_sum_of_their_columns() {
    let run = |len| ConstraintRun::<3> { first: [0; 3], len, at: 0, serial: 0, alike: false };
    let mut layout = Layout {
        diagonals: Diagonals { starts: [0; 3].into(), rest: zeros(5), compliance: zeros(5), ..Diagonals::default() },
        crossing: FiberLists { index: [0; 11].into(), rest: zeros(13), compliance: zeros(13), ..FiberLists::default() },
        hubs: Hubs {
            particles: [0; 5].into(),
            coefficients: zeros(6),
            groups: [HubGroup::default()].into(),
            ..Hubs::default()
        },
        friction: BendFriction { particles: [0; 4].into(), coefficients: zeros(4), ..BendFriction::default() },
        tethers: Tethers { anchor: [0; 2].into(), length: zeros(2) },
        spans: [vec![(0, 1)], vec![(1, 1), (2, 1)]],
        owner: [0; 9].into(),
        ..Layout::default()
    };
    (layout.shear.rest, layout.shear.compliance) = (zeros(7), zeros(7));
    layout.shear.tuples.loose = [[0; 2]; 2].into();
    layout.bends.tuples.runs = [run(1), run(1)].into();
    layout.bends.tuples.loose = [[0; 3]; 2].into();
    layout.bends.coefficients = std::array::from_fn(|_| zeros(3));
    layout.skewed.tuples.loose = [[0; 4]].into();
    layout.skewed.coefficients = std::array::from_fn(|_| zeros(2));
    layout.fibers.rows = [BundleRow { first: 0, lanes: 1 }; 2].into();
    (layout.fibers.rest, layout.fibers.compliance) = (zeros(3), zeros(3));
    layout.link_curves.weft = CurveTable::new(&std::iter::repeat_n(ONE_SLOPE, 3));

    let numbers_and_indices = |count: usize| 4 * count;
    let diagonals = numbers_and_indices(3 + 2 * 5);
    let shear = numbers_and_indices(2 * 2 + 2 * 7);
    let fibers = 2 * size_of::<BundleRow>() + numbers_and_indices(2 * 3);
    let crossing = numbers_and_indices(11 + 2 * 13);
    let bends = 2 * size_of::<ConstraintRun<3>>() + numbers_and_indices(2 * 3 + 3 * 3);
    let skewed = numbers_and_indices(4 + 4 * 2);
    let hubs = size_of::<HubGroup>() + numbers_and_indices(5 + 6);
    let friction = numbers_and_indices(2 * 4);
    let curves = numbers_and_indices(5 * 3);
    assert_eq!(layout.link_curves.bytes(), curves);
    let particles = numbers_and_indices(2 * 2 + 2 * 3) + 9;
    assert_eq!(
        layout.bytes(),
        diagonals + shear + fibers + crossing + bends + skewed + hubs + friction + curves + particles
    );
}

#[test]
fn every_sum_that_bends_is_visited_with_its_own_coefficients() {
    let mut layout = Layout::default();
    layout.bends.tuples.loose = [[4, 5, 6]].into();
    layout.bends.tuples.sets = loose_set(1);
    layout.bends.coefficients = [1.0, -2.0, 1.0].map(|c| [c].into());
    // A hub of two sums over three particles: the coefficients of one particle lie together.
    layout.hubs = Hubs {
        particles: [7, 8, 9].into(),
        coefficients: [1.0, 10.0, 2.0, 20.0, 3.0, 30.0].into(),
        groups: [HubGroup { points: 3, sums: 2, count: 1, ..HubGroup::default() }].into(),
        ..Hubs::default()
    };
    let mut seen = Vec::new();
    layout.for_each_bend(|particles, coefficient| {
        seen.push((particles.to_vec(), (0..particles.len()).map(coefficient).collect::<Vec<_>>()));
    });
    let expected: [([u32; 3], [f32; 3]); 3] =
        [([4, 5, 6], [1.0, -2.0, 1.0]), ([7, 8, 9], [1.0, 2.0, 3.0]), ([7, 8, 9], [10.0, 20.0, 30.0])];
    assert_eq!(seen, expected.map(|(particles, coefficients)| (particles.to_vec(), coefficients.to_vec())));
}

/// A slot of two particles that begins at the second of `particles`.
fn slot(len: u32) -> FrictionSlot {
    FrictionSlot { centre: 0, kind: 2, chords: [0; 4], limit: 1.0, first: 1, len }
}

#[test]
fn a_slot_that_rubs_has_its_own_particles() {
    let friction =
        BendFriction { slots: [slot(2)].into(), particles: [3, 4, 5].into(), coefficients: [0.1, 0.2, 0.3].into() };
    assert_eq!(friction.entries(&friction.slots[0]).collect::<Vec<_>>(), [(4, 0.2), (5, 0.3)]);
    assert_eq!((friction.kinds(), BendFriction::default().kinds()), (3, 0));
}

/// One particle with such constraints.
fn one_particle(layout: Layout) -> Result<Garment, LayoutError> {
    let data = GarmentData {
        name: "one".into(),
        size: "one".into(),
        layer: 0,
        tuck: None,
        fabric: Fabric::cotton_lawn(),
        source: [0].into(),
        start: [Vec3::ZERO].into(),
        inverse_mass: [1.0].into(),
        parts: [Part::All].into(),
        triangles: Box::default(),
        look: GarmentAppearance::default(),
        fixed: Box::default(),
        fixed_weights: Box::default(),
        substeps: 1,
        strain_edges: Box::default(),
        hoop_edges: Box::default(),
    };
    Garment::new(data, Layout { spans: [vec![(0, 1)], Vec::new()], owner: [0].into(), ..layout })
}

#[test]
fn a_slot_ends_within_the_particles_of_all_slots() {
    let rubbing = |len| {
        let friction = BendFriction { slots: [slot(len)].into(), particles: [0; 2].into(), coefficients: zeros(2) };
        one_particle(Layout { friction, ..Layout::default() })
    };
    assert!(rubbing(1).is_ok(), "from the second on, one");
    assert_eq!(rubbing(2).unwrap_err(), LayoutError::Bounds { what: "friction", found: 2, count: 2 });
}

#[test]
fn a_hub_ends_within_the_coefficients_of_all_hubs() {
    let hub = |first| {
        let group = HubGroup { points: 1, sums: 2, count: 1, coefficients: first, ..HubGroup::default() };
        let hubs =
            Hubs { particles: [0].into(), coefficients: zeros(3), groups: [group].into(), count: 1, ..Hubs::default() };
        one_particle(Layout { hubs, ..Layout::default() })
    };
    assert!(hub(1).is_ok());
    assert_eq!(hub(2).unwrap_err(), LayoutError::Bounds { what: "hubs", found: 3, count: 3 });
}
