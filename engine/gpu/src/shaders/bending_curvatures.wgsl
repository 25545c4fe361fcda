// Bending curvatures: first the curvature of every stencil and hub, then what they do to each particle, in the CPU's order of sums.
// Twin of `cloth/bending.rs` and `cloth/hubs.rs`. What is stiffer than a substep bends the room of `stage_combine.wgsl` instead of the
// places.

// First term and number of terms of each curvature [curvatures].
@group(1) @binding(0) var<storage, read> items: array<vec2<u32>>;
// Particle and bits of its coefficient (sqrt(N/m)).
@group(1) @binding(1) var<storage, read> terms: array<vec2<u32>>;
// Share of each curvature's stiffness that the substep carries [curvatures].
@group(1) @binding(2) var<storage, read> scales: array<f32>;
// The curvatures, times that and the time that bending acts for [curvatures].
@group(1) @binding(3) var<storage, read_write> curvatures: array<vec4<f32>>;

// See `stage_combine.wgsl`.
@group(1) @binding(4) var<storage, read> stages: array<vec4<f32>>;

// The curvature of what lies at a part of the state.
fn bend(part: u32, k: u32, by: f32) {
    let item = items[k];
    let first = terms[item.x];
    var d = place(part + first.x) * bitcast<f32>(first.y);
    for (var t = 1u; t < item.y; t += 1u) {
        let term = terms[item.x + t];
        d = d + place(part + term.x) * bitcast<f32>(term.y);
    }
    curvatures[k] = vec4<f32>(d * (by * scales[k]), 0.0);
}

@compute @workgroup_size(64)
fn bending_curvatures(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    if (lane >= group.z || 1u < garments[g].stages || now.substep % garments[g].bend_every != 0u) {
        return;
    }
    bend(0u, group.y + lane, garments[g].bend_by);
}

// The same in a stage.
@compute @workgroup_size(64)
fn stage_curvatures(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    let last = garments[g].stages;
    if (lane >= group.z || last < 2u || last <= now.stage) {
        return;
    }
    // The first bends the place ahead, which lies where the first change of velocity will be.
    bend(after_stage(max(now.stage, 1u)), group.y + lane, stages[g * MOST_STAGES + now.stage].w);
}
