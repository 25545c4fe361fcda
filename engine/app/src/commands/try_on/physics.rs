//! Report of the physics of a try-on: times, strain, contact, and faults.

use toile_base::garment::Garment;
use toile_base::limits::STEP_HZ;
use toile_engine::cloth::Cloth;
use toile_engine::cloth::contact::garments::GarmentContact;
use toile_engine::world::World;
use toile_fitting::scene::StepTimes;
use toile_fitting::scene::contact::ContactReport;

use crate::report;

/// What contact of cloth with cloth did, dressing included.
pub fn contact(world: &World) -> Option<ContactReport> {
    world.layers().map(|layers| ContactReport::from(layers.counts()))
}

/// Settings, times and errors.
pub fn physics(world: &World) -> report::PhysicsReport {
    let meters = world.meters();
    let us = |quantile: f64| meters.step_ns.value_at_quantile(quantile) as f64 * 1e-3;
    let strain = meters.strain();
    let mut warnings = Vec::new();
    for (cloth, garment) in world.cloths().iter().zip(world.garments()) {
        let events = cloth.events;
        if events.rolled_back > 0 {
            warnings
                .push(format!("{}: {} steps were not finite and were rolled back", garment.name, events.rolled_back));
        }
        if events.speed_limited > 0 {
            warnings.push(format!(
                "{}: particles were held at the speed limit {} times",
                garment.name, events.speed_limited
            ));
        }
    }
    warnings.extend(contact(world).iter().flat_map(ContactReport::warnings));
    let lists = world.cloths().iter().map(Cloth::lists).chain(world.layers().map(GarmentContact::lists));
    let lost = lists.map(|lists| lists.lost).sum::<u64>();
    if lost > 0 {
        warnings.push(format!(
            "lists of a step were full and lost {lost} entries, which is a fault of the program; report it"
        ));
    }
    let held = world.colliders().held();
    if held > 0 {
        warnings.push(format!("collision spheres jumped or were not finite and were held {held} times"));
    }
    if world.broken() > 0 {
        warnings.push(format!("{} steps broke off in a worker; the garments kept their last places", world.broken()));
    }
    report::PhysicsReport {
        hz: STEP_HZ,
        quality: world.settings().quality.name(),
        lanes: world.settings().width.lanes(),
        workers: world.settings().workers,
        substeps: world.cloths().iter().map(|c| c.substeps()).max().unwrap_or(0),
        particles: world.garments().iter().map(Garment::particles).sum(),
        steps: world.tick(),
        step_us: StepTimes { p50: us(0.5), p99: us(0.99), p999: us(0.999), max: meters.step_ns.max() as f64 * 1e-3 },
        strain: report::StrainReport {
            mean: f64::from(strain.mean),
            p99: f64::from(strain.p99),
            max: f64::from(strain.max),
        },
        penetration_mm: report::Penetration { max: f64::from(meters.penetration_max) * 1e3 },
        nonfinite: world.cloths().iter().map(|c| c.events.rolled_back).sum(),
        warnings,
    }
}
