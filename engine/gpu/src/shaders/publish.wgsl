// Publish: a sound garment's places are the last good ones; one that is not sound goes back to them, at rest, and drawn to
// where it was dressed when that happens again and again. CPU reference: `roll_back` in `cloth/step/guard.rs`.

// Last good places [particles].
@group(1) @binding(1) var<storage, read_write> good: array<vec4<f32>>;
// Where each particle starts, in the rest pose [particles].
@group(1) @binding(2) var<storage, read> start: array<vec4<f32>>;

@compute @workgroup_size(64)
fn publish(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let g = group.x;
    if (atomicLoad(&reports[g].unsound) == 0u) {
        good[i] = vec4<f32>(place(i), 1.0);
        return;
    }
    var goal = good[i].xyz;
    let towards = less_of(f32(reports[g].rolled) * 0.25, 1.0);
    if (towards > 0.0) {
        let s = start[i].xyz;
        let root = garments[g].root;
        let dressed = root[0].xyz * s.x + root[1].xyz * s.y + root[2].xyz * s.z + root[3].xyz;
        if (within_reach(dressed)) {
            goal = goal * (1.0 - towards) + dressed * towards;
        }
    }
    put(i, goal);
    state[op.particles + i] = vec4<f32>(goal, 0.0);
    state[2u * op.particles + i] = vec4<f32>(0.0);
    good[i] = vec4<f32>(goal, 1.0);
}

// After all particles: counts the roll-backs and clears the report for the next step. A garment an invocation.
@compute @workgroup_size(64)
fn update_reports(@builtin(global_invocation_id) at: vec3<u32>) {
    let g = at.x;
    if (g >= arrayLength(&reports)) {
        return;
    }
    if (atomicLoad(&reports[g].unsound) == 0u) {
        reports[g].rolled = 0u;
    } else {
        reports[g].rolled += 1u;
        reports[g].rolled_back += 1u;
        atomicStore(&reports[g].unsound, 0u);
    }
}
