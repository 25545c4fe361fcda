//! How full everything was that has a bound: the queues, the schedule, the frame's capacities.

use toile_base::limits::{MAX_CAPSULES, MAX_PLANES, MAX_SPHERES};
use toile_engine::bounded::Fill;
use toile_engine::cloth::contact::garments::{GarmentContact, MOST_CROSSINGS};
use toile_engine::cloth::step::settings::MAX_SUBSTEPS;
use toile_engine::cloth::{Cloth, forces::stiff_bending};
use toile_engine::frame_loop::loop_meters::LoopMeters;
use toile_engine::frame_loop::queue::Capacity;
use toile_engine::frame_loop::schedule::MOST_CATCH_UP;
use toile_engine::meter::PERIOD_NS;
use toile_engine::world::World;
use toile_fitting::scene::contact::{CROSSINGS_NAME, ContactReport, PAIRS_NAME};

/// The bounds of the loop and of the frame.
pub fn capacities(queues: &[Capacity], gauges: &LoopMeters, world: &World) -> Vec<Capacity> {
    let late = gauges.late.histogram().max() / PERIOD_NS;
    let most = |count: fn(&Cloth) -> usize| world.cloths().iter().map(count).max().unwrap_or(0);
    let filled = |constant, bound, high_water| Capacity { constant, bound, high_water, lost: 0 };
    let colliders = world.colliders();
    let mut all = queues.to_vec();
    all.push(Capacity {
        constant: "MOST_CATCH_UP (steps made up for after a late wake-up)",
        bound: MOST_CATCH_UP as usize,
        high_water: late.min(MOST_CATCH_UP) as usize,
        lost: gauges.dropped,
    });
    all.extend([
        filled("MAX_SPHERES (spheres of the body)", MAX_SPHERES, colliders.start().len()),
        filled("MAX_CAPSULES (capsules of the body)", MAX_CAPSULES, colliders.capsules().len()),
        filled("MAX_PLANES (planes among the colliders)", MAX_PLANES, colliders.planes().len()),
        filled("MAX_SUBSTEPS (substeps of a step)", MAX_SUBSTEPS as usize, most(|c| c.substeps() as usize)),
        filled(
            "MAX_BENDING_STAGES (stages of bending a substep)",
            stiff_bending::MAX_BENDING_STAGES as usize,
            most(|c| c.bend_pace().stages as usize),
        ),
    ]);
    let pairs = world.cloths().iter().map(|c| c.contact_counts().most_pairs);
    all.extend(pairs.map(|[most, capacity]| {
        filled("pairs (blocks of particles near a capsule)", capacity as usize, most as usize)
    }));
    let lists = world.cloths().iter().map(Cloth::lists).chain(world.layers().map(GarmentContact::lists));
    let lists = lists.fold(Fill::default(), Fill::and);
    all.push(Capacity {
        constant: "lists of a step (the fullest of those that it fills)",
        bound: lists.capacity as usize,
        high_water: lists.most as usize,
        lost: lists.lost,
    });
    if let Some(ContactReport { pairs_most, pairs_room, crowded, crossings_most, left_out, .. }) = contact(world) {
        let full = |constant, bound, most: u64, lost| Capacity { constant, bound, high_water: most as usize, lost };
        all.push(full(PAIRS_NAME, pairs_room as usize, pairs_most, crowded));
        all.push(full(CROSSINGS_NAME, MOST_CROSSINGS, crossings_most, left_out));
    }
    all
}

fn contact(world: &World) -> Option<ContactReport> {
    world.layers().map(|layers| ContactReport::from(layers.counts()))
}

/// What was full, with the cure. Spheres, capsules and planes that are too many are refused at load.
pub fn warnings(capacities: &[Capacity], world: &World) -> Vec<String> {
    // Contact has words of its own.
    let queues = capacities.iter().filter(|c| ![PAIRS_NAME, CROSSINGS_NAME].contains(&c.constant));
    let mut all: Vec<String> = queues.filter_map(Capacity::warning).collect();
    all.extend(contact(world).iter().flat_map(ContactReport::warnings));
    for (cloth, garment) in world.cloths().iter().zip(world.garments()) {
        let pace = cloth.bend_pace();
        if pace.stages == stiff_bending::MAX_BENDING_STAGES && pace.least < 1.0 {
            all.push(format!(
                "{} bends with {:.0} % of its stiffness at some particles, for a substep has at most {} stages of bending; ask for \
                 more substeps, a coarser mesh or a softer fabric",
                garment.name,
                pace.least * 100.0,
                stiff_bending::MAX_BENDING_STAGES
            ));
        }
    }
    all
}
