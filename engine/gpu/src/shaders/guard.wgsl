// Guard: whether every number of a garment is finite and within reach; those that are next to nothing become nothing.
// Twin of `Sound` in `cloth/guard.rs`.

// What happened to a garment, counted since it was made.
struct Report {
    // Particle substeps held at the speed limit.
    limited: atomic<u32>,
    // Not 0 where something in this step is not sound.
    unsound: atomic<u32>,
    // Steps in a row that were rolled back.
    rolled: u32,
    // All that were.
    rolled_back: u32,
    // Particles that were put back when a step began.
    repaired: u32,
}

@group(1) @binding(0) var<storage, read_write> reports: array<Report>;

fn sound(v: vec3<f32>) -> bool {
    return finite(v) && within_reach(v);
}

@compute @workgroup_size(64)
fn guard(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let velocity = 2u * op.particles + i;
    let own = state[i];
    let v = state[velocity].xyz;
    if (!sound(own.xyz) || !sound(v)) {
        atomicOr(&reports[group.x].unsound, 1u);
    }
    state[i] = vec4<f32>(calm(own.xyz), own.w);
    state[velocity] = vec4<f32>(calm(v), 0.0);
}
