// Bending: a row of the garment's matrix an invocation, its entries in the CPU's order. CPU reference: `cloth/forces/bending.rs`.
// Bending that is stiffer than a substep writes to the scratch columns of `stage_combine.wgsl` instead of the places.

// Where each particle's entries begin [particles + 1].
@group(1) @binding(0) var<storage, read> starts: array<u32>;
// A neighbour, and the bits of its value (1/s2).
@group(1) @binding(1) var<storage, read> entries: array<vec2<u32>>;
// See `stage_combine.wgsl`.
@group(1) @binding(2) var<storage, read> stages: array<vec4<f32>>;

// Particle `i` is pushed at one part of the state by what lies at another.
fn bend(to: u32, part: u32, i: u32, by: f32) {
    let own = place(part + i);
    var sum = vec3<f32>(0.0);
    for (var e = starts[i]; e < starts[i + 1u]; e += 1u) {
        let entry = entries[e];
        sum = sum + (place(part + entry.x) - own) * bitcast<f32>(entry.y);
    }
    state[to + i] = vec4<f32>(state[to + i].xyz + sum * by, 0.0);
}

@compute @workgroup_size(64)
fn bending(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    if (lane >= group.z || 1u < garments[g].stages || now.substep % garments[g].bend_every != 0u) {
        return;
    }
    bend(2u * op.particles, 0u, group.y + lane, garments[g].bend_by);
}

// The same in a stage: what is pushed is r, then the newest change of velocity. The first bends the place ahead, which lies
// where the first change of velocity will be.
@compute @workgroup_size(64)
fn stage_bending(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    let last = garments[g].stages;
    if (lane >= group.z || last < 2u || last <= now.stage) {
        return;
    }
    let to = select(after_stage(now.stage + 1u), scratch(0u), now.stage == 0u);
    bend(to, after_stage(max(now.stage, 1u)), group.y + lane, stages[g * MOST_STAGES + now.stage].w);
}
