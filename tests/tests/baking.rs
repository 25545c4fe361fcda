//! Tests of baking, on any mesh that can be baked.

use std::collections::BTreeSet;

use glam::{Quat, Vec2, Vec3};
use proptest::prelude::*;
use toile_bake::bake;
use toile_bake::{Shape, check};
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;
use toile_base::garment::layout::{FiberList, OwnerShare, Tuples};
use toile_perf::oracle::{Problem, State, measure};
use toile_workspace::meshes::{Cell, Plan, area, folded};
use toile_workspace::tolerance;

fn cell() -> impl Strategy<Value = Cell> {
    prop_oneof![1 => Just(Cell::Hole), 5 => Just(Cell::Quad), 3 => Just(Cell::Rising), 3 => Just(Cell::Falling)]
}

fn plan() -> impl Strategy<Value = Plan> {
    (1usize..14, 1usize..14).prop_flat_map(|(columns, rows)| {
        let cells = proptest::collection::vec(cell(), columns * rows);
        let vertices = (columns + 1) * (rows + 1);
        let off =
            proptest::collection::vec((-1.0f32..1.0, -1.0f32..1.0).prop_map(|(x, y)| Vec2::new(x, y)), 0..=vertices);
        let fixed = proptest::collection::vec(proptest::bool::weighted(0.15), 0..=vertices);
        let turn = (-3.0f32..3.0, -3.0f32..3.0, -3.0f32..3.0)
            .prop_map(|(x, y, z)| Quat::from_euler(glam::EulerRot::XYZ, x, y, z));
        (cells, off, fixed, turn).prop_map(move |(cells, off, fixed, turn)| Plan { columns, cells, off, fixed, turn })
    })
}

fn fabric() -> Fabric {
    toile_assets::fabric::built_in("cotton-lawn").expect("a fabric that is built in")
}

/// Sides of the faces, and both diagonals of quads, as particles, except what is held at both ends.
fn edges(shape: &Shape, garment: &Garment) -> BTreeSet<[u32; 2]> {
    let mut particle = vec![0; garment.particles()];
    garment.source.iter().zip(0..).for_each(|(&v, i)| particle[v as usize] = i);
    let mut found = BTreeSet::new();
    for face in &shape.faces {
        let ring = check::corners(face);
        let pairs = (0..ring.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        for (i, j) in pairs.filter(|(i, j)| !(shape.fixed[ring[*i] as usize] && shape.fixed[ring[*j] as usize])) {
            let [a, b] = [ring[i], ring[j]].map(|v| particle[v as usize]);
            found.insert([a.min(b), a.max(b)]);
        }
    }
    found
}

/// The particles of each set, owner after owner.
fn sets<const K: usize>(tuples: &Tuples<K>) -> Vec<Vec<u32>> {
    let of = |share: &OwnerShare| {
        let runs = &tuples.runs[share.runs.start as usize..share.runs.end as usize];
        let side_by_side = runs.iter().flat_map(|run| (0..run.len).flat_map(|t| run.first.map(|f| f + t)));
        let loose = &tuples.loose[share.loose.start as usize..share.loose.end as usize];
        side_by_side.chain(loose.iter().flatten().copied()).collect::<Vec<u32>>()
    };
    tuples.sets.iter().map(|set| set.shares.iter().flat_map(of).collect()).collect()
}

fn no_particle_twice(mut particles: Vec<u32>) -> bool {
    let count = particles.len();
    particles.sort_unstable();
    particles.dedup();
    particles.len() == count
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_edge_is_held_exactly_once(plan in plan()) {
        let shape = plan.shape();
        prop_assume!(!shape.faces.is_empty());
        let garment = bake("any", "one", &shape, &fabric()).unwrap();
        let mut held: Vec<[u32; 2]> =
            Problem::of(&garment).links.iter().map(|l| [l.ends[0].min(l.ends[1]), l.ends[0].max(l.ends[1])]).collect();
        held.sort_unstable();
        let wanted: Vec<[u32; 2]> = edges(&shape, &garment).into_iter().collect();
        prop_assert_eq!(held, wanted);
    }

    #[test]
    fn no_set_has_a_particle_twice_and_every_particle_has_one_owner(plan in plan()) {
        let shape = plan.shape();
        prop_assume!(!shape.faces.is_empty());
        let garment = bake("any", "one", &shape, &fabric()).unwrap();
        let layout = garment.layout();
        for set in sets(&layout.shear.tuples).into_iter().chain(sets(&layout.weft.tuples)) {
            prop_assert!(no_particle_twice(set));
        }
        let lists = &layout.crossing;
        let of = |l: &FiberList| (l.first..l.first + l.lanes * l.rows).map(|k| lists.index[k as usize]);
        for set in &lists.sets {
            let all = set.iter().flat_map(|r| lists.lists[r.start as usize..r.end as usize].iter().flat_map(of));
            prop_assert!(no_particle_twice(all.collect()));
        }
        for strands in &layout.diagonals.families {
            let (mut led_to, mut left) = (Vec::new(), Vec::new());
            for strand in strands {
                for run in &layout.diagonals.runs[strand.runs.start as usize..strand.runs.end as usize] {
                    let ends = run.first.map(|f| f..f + run.len);
                    prop_assert!(ends[1].clone().all(|p| !left.contains(&p)), "a link comes after what it leads on to");
                    let [a, b] = ends;
                    left.extend(a);
                    led_to.extend(b);
                }
            }
            prop_assert!(no_particle_twice(left) && no_particle_twice(led_to));
        }
        let rows = layout.fibers.bundles.iter().flat_map(|b| &layout.fibers.rows[b.rows.start as usize..b.rows.end as usize]);
        prop_assert!(no_particle_twice(rows.flat_map(|row| row.first..row.first + row.lanes).collect()));
        let spans = layout.spans.iter().flatten().flat_map(|(first, len)| *first..first + len);
        let mut all: Vec<u32> = spans.collect();
        all.sort_unstable();
        prop_assert!(all.into_iter().eq(0..garment.particles() as u32));
    }

    #[test]
    fn masses_are_the_area_times_the_density(plan in plan(), density in 0.02f32..1.0) {
        let plan = Plan { fixed: Vec::new(), ..plan };
        let shape = plan.shape();
        prop_assume!(!shape.faces.is_empty());
        let garment = bake("any", "one", &shape, &Fabric { density_kg_m2: density, ..fabric() }).unwrap();
        let sum: f64 = garment.inverse_mass.iter().map(|w| 1.0 / f64::from(*w)).sum();
        let expected = area(&shape) * f64::from(density);
        prop_assert!((sum / expected - 1.0).abs() < tolerance::MASS, "{} kg, not {} kg", sum, expected);
    }

    #[test]
    fn particles_are_the_vertices_in_another_order(plan in plan()) {
        let shape = plan.shape();
        prop_assume!(!shape.faces.is_empty());
        let garment = bake("any", "one", &shape, &fabric()).unwrap();
        let mut source = garment.source.to_vec();
        source.sort_unstable();
        prop_assert!(source.into_iter().eq(0..shape.cut.len() as u32));
        for (i, &v) in garment.source.iter().enumerate() {
            prop_assert_eq!(garment.start[i], shape.worn[v as usize]);
            prop_assert_eq!(garment.inverse_mass[i] == 0.0, shape.fixed[v as usize]);
        }
    }

    #[test]
    fn a_flat_garment_as_cut_has_no_energy(plan in plan()) {
        let shape = plan.shape();
        prop_assume!(!shape.faces.is_empty());
        let garment = bake("any", "one", &shape, &fabric()).unwrap();
        let problem = Problem::of(&garment);
        let rest: Vec<_> = garment.start.iter().map(|p| p.as_dvec3()).collect();
        prop_assert!(measure::strain(&problem, &rest).max < tolerance::REST_STRAIN);
        let bent = |x: &[glam::DVec3]| measure::energies(&problem, &State::at_rest(x)).bending_j;
        let middle = shape.cut.iter().sum::<Vec3>() / shape.cut.len() as f32;
        let across = plan.turn * Vec3::X;
        let half: Vec<_> = garment.start.iter().map(|p| folded(*p, middle, across).as_dvec3()).collect();
        let (flat, folded) = (bent(&rest), bent(&half));
        // What is held or a single face wide cannot be bent at all: what is left then is the rounding of positions.
        let most = tolerance::ROUNDING_BENDING_J.max(tolerance::REST_BENDING * folded);
        prop_assert!(flat <= most, "{} J flat, {} J folded", flat, folded);
    }
}
