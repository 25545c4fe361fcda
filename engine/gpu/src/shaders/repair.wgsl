// Repair: at the start of a step a particle whose position or velocity is not finite, or that is out of reach, goes back to its last
// good place, at rest; what is next to nothing becomes nothing. CPU reference: `AllFinite` and `repair` in `cloth/step/guard.rs`, as
// `Cloth::begin` runs them.

// Last good places [particles].
@group(1) @binding(1) var<storage, read> good: array<vec4<f32>>;

@compute @workgroup_size(64)
fn repair(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let velocity = 2u * op.particles + i;
    let x = place(i);
    let v = state[velocity].xyz;
    // However fast: the speed limit is for that.
    if (finite(x) && finite(v) && within_reach(x)) {
        put(i, calm(x));
        state[velocity] = vec4<f32>(calm(v), 0.0);
        return;
    }
    let goal = good[i].xyz;
    put(i, goal);
    state[op.particles + i] = vec4<f32>(goal, 0.0);
    state[velocity] = vec4<f32>(0.0);
    atomicAdd(&reports[group.x].repaired, 1u);
}
