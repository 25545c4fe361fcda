// What happened to a garment, counted since it was made. Several kernels write it: `REPORT` of `cloth/buffers.rs` words.
struct Report {
    // Particle substeps held at the speed limit.
    limited: atomic<u32>,
    // Not 0 where a particle of this step is not finite or out of reach.
    unsound: atomic<u32>,
    // Consecutive steps that were rolled back.
    rolled: u32,
    // All steps that were rolled back.
    rolled_back: u32,
    // Particles that were put back at the beginning of a step.
    repaired: atomic<u32>,
}

// Reports [garments].
@group(1) @binding(0) var<storage, read_write> reports: array<Report>;

