// Bending forces: what the curvatures that `bending` has found do to each particle, a particle an invocation. The second half of the
// twin of `cloth/bending.rs` and `cloth/hubs.rs`.

// Where each particle's entries begin [particles + 1].
@group(1) @binding(0) var<storage, read> starts: array<u32>;
// A curvature, in the upper two bits how many sums of a hub (0 for a stencil); the bits of coefficient times weight, or for
// a hub the particle's place among its terms.
@group(1) @binding(1) var<storage, read> entries: array<vec2<u32>>;
@group(1) @binding(2) var<storage, read> items: array<vec2<u32>>;
@group(1) @binding(3) var<storage, read> terms: array<vec2<u32>>;
@group(1) @binding(4) var<storage, read> curvatures: array<vec4<f32>>;

// What pushes particle `i`, taken from what lies at a part of the state.
fn push(part: u32, i: u32) {
    let w = state[i].w;
    var v = state[part + i].xyz;
    for (var e = starts[i]; e < starts[i + 1u]; e += 1u) {
        let entry = entries[e];
        let curvature = entry.x & 0x3FFFFFFFu;
        let sums = entry.x >> 30u;
        if (sums == 0u) {
            v = v - curvatures[curvature].xyz * bitcast<f32>(entry.y);
        } else {
            var shove = curvatures[curvature].xyz * bitcast<f32>(terms[items[curvature].x + entry.y].y);
            for (var s = 1u; s < sums; s += 1u) {
                let c = bitcast<f32>(terms[items[curvature + s].x + entry.y].y);
                shove = shove + curvatures[curvature + s].xyz * c;
            }
            v = v - shove * w;
        }
    }
    state[part + i] = vec4<f32>(v, 0.0);
}

@compute @workgroup_size(64)
fn bending_forces(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    if (lane >= group.z || 1u < garments[g].stages || now.substep % garments[g].bend_every != 0u) {
        return;
    }
    push(2u * op.particles, group.y + lane);
}

// The same in a stage: what is pushed is r, then the newest change of velocity.
@compute @workgroup_size(64)
fn stage_forces(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let last = garments[group.x].stages;
    if (lane >= group.z || last < 2u || last <= now.stage) {
        return;
    }
    push(select(after_stage(now.stage + 1u), room(0u), now.stage == 0u), group.y + lane);
}
