//! A layout that kernels could not trust is refused, with what is wrong in it.

use toile_base::garment::layout::{FiberBundle, FiberList, OwnerShare};
use toile_base::garment::{Direction, Garment, GarmentData, Layout, LayoutError, Solver};

use crate::cloth;

/// The garment after a change to its parts.
fn changed(change: impl FnOnce(&mut GarmentData, &mut Layout)) -> Result<Garment, LayoutError> {
    let (mut data, mut layout) = cloth().into_parts();
    change(&mut data, &mut layout);
    Garment::new(data, layout)
}

#[test]
fn a_garment_taken_apart_goes_together_again() {
    assert_eq!(changed(|_, _| ()).unwrap(), cloth());
}

#[test]
fn one_particle_has_one_owner() {
    let twice = changed(|_, layout| {
        let (first, len) = layout.spans[0][0];
        layout.spans[1].push((first, len.min(1)));
    });
    assert!(matches!(twice, Err(LayoutError::Owner { .. })), "{twice:?}");
    let other = changed(|_, layout| layout.owner[0] ^= 1);
    assert!(matches!(other, Err(LayoutError::Owner { .. })), "{other:?}");
    let unowned = changed(|_, layout| layout.spans[0].clear());
    assert!(matches!(unowned, Err(LayoutError::Owner { .. })), "{unowned:?}");
}

#[test]
fn no_two_constraints_of_a_set_share_a_particle() {
    let merged = changed(|_, layout| {
        // All sets of links solved as one: neighbours meet at their common particle.
        let sets = &mut layout.weft.tuples.sets;
        let all: Vec<_> = sets.iter().flat_map(|set| set.shares.clone()).collect();
        let (runs, zigzags) = (layout.weft.tuples.runs.len() as u32, layout.weft.tuples.zigzags.len() as u32);
        let mut whole = sets[0].clone();
        whole.shares = Default::default();
        whole.shares[0] = all[0].clone();
        (whole.shares[0].runs, whole.shares[0].zigzags) = (0..runs, 0..zigzags);
        whole.shares[0].loose = 0..layout.weft.tuples.loose.len() as u32;
        whole.shares[0].loose_at = 0;
        *sets = [whole].into();
    });
    assert!(matches!(merged, Err(LayoutError::Shared { what: "weft", .. })), "{merged:?}");
    let fibers = changed(|_, layout| {
        let rows = &mut layout.fibers.rows;
        rows[1] = rows[0];
        let last = layout.fibers.bundles.len() - 1;
        layout.fibers.bundles[last].owner ^= 1;
        let row = layout.fibers.rows[0];
        let at = layout.fibers.bundles[last].rows.start as usize;
        layout.fibers.rows[at].first = row.first;
    });
    assert!(matches!(fibers, Err(LayoutError::Shared { what: "fibers", .. })), "{fibers:?}");
}

#[test]
fn indices_lead_to_particles_and_parameters() {
    let far = changed(|data, _| data.triangles[0][0] = 10_000);
    assert_eq!(far.unwrap_err(), LayoutError::Bounds { what: "triangles", found: 10_000, count: 144 });
    let run = changed(|_, layout| layout.fibers.rows[0].first = 10_000);
    assert!(matches!(run, Err(LayoutError::Bounds { what: "fibers", .. })), "{run:?}");
    let rest = changed(|_, layout| layout.fibers.rest = Box::default());
    assert!(matches!(rest, Err(LayoutError::Length { what: "fibers", .. })), "{rest:?}");
    let short = changed(|data, _| data.inverse_mass = Box::default());
    let error = short.unwrap_err();
    assert_eq!(error.to_string(), "inverse_mass has 0 entries and needs 144; bake the garment again");
}

#[test]
fn anchors_hold_still() {
    let held = cloth();
    let tethered = held.layout().tethers.length.iter().position(|length| *length > 0.0).unwrap();
    let moving = held.inverse_mass.iter().position(|w| *w > 0.0).unwrap() as u32;
    let loose = changed(|_, layout| layout.tethers.anchor[tethered] = moving);
    assert_eq!(loose.unwrap_err(), LayoutError::Anchor { particle: tethered });
}

#[test]
fn a_fiber_has_a_link() {
    for rows in [0, 1] {
        let list = FiberList {
            solver: Solver::SemiImplicit,
            direction: Direction::Warp,
            closed: false,
            lanes: 1,
            rows,
            first: 0,
            at: 0,
        };
        assert_eq!(list.links(), 0, "{rows} particles");
        let short = changed(|_, layout| {
            layout.crossing.lists = [list].into();
            layout.crossing.sets = [[0..1, 0..0]].into();
        });
        let found = rows as usize;
        assert_eq!(short.unwrap_err(), LayoutError::Length { what: "a fiber of crossing", found, needed: 2 });
    }
}

#[test]
fn two_owners_have_no_tension_in_common() {
    let shared = changed(|_, layout| {
        let shares = &mut layout.weft.tuples.sets[0].shares;
        let full = shares.iter().position(|share| *share != OwnerShare::default()).unwrap();
        shares[1 - full] = shares[full].clone();
    });
    assert!(matches!(shared, Err(LayoutError::Place { what: "weft", .. })), "{shared:?}");
    let fibers = changed(|_, layout| {
        let bundle = layout.fibers.bundles[0].clone();
        let twice = [bundle.clone(), FiberBundle { owner: 1 - bundle.owner, ..bundle }];
        layout.fibers.bundles = twice.into();
    });
    assert!(matches!(fibers, Err(LayoutError::Place { what: "fibers", .. })), "{fibers:?}");
}
