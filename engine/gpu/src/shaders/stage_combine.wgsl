// Stage combine: what comes before the forces of a stage of stiff bending, and behind the last.
// CPU reference: `ApplyStiffBending` in `cloth/forces/stiff_bending.rs`.
//
// Three more parts of the state are its scratch columns: r, the sum of all else that changes the velocity, and two changes of
// velocity.

// Accelerations besides gravity (m/s2) [particles].
@group(1) @binding(0) var<storage, read> pushed: array<vec4<f32>>;
// See `ChebyshevStage` in `cloth/forces/stiff_bending.rs`: ahead, behind, forced, and what the forces are multiplied by [garments * MOST_STAGES].
@group(1) @binding(1) var<storage, read> stages: array<vec4<f32>>;

@compute @workgroup_size(64)
fn stage_combine(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    let last = garments[g].stages;
    if (lane >= group.z || last < 2u || last < now.stage) {
        return;
    }
    let i = group.y + lane;
    let own = state[i];
    let velocity = 2u * op.particles + i;
    let v = state[velocity].xyz;
    let rest = scratch(0u) + i;
    let first = scratch(1u) + i;
    let second = scratch(2u) + i;
    let stage = stages[g * MOST_STAGES + min(now.stage, last - 1u)];
    if (now.stage == 0u) {
        var change = garments[g].fall;
        if ((garments[g].bits & (WIND | COMPENSATE)) != 0u) {
            change = change + pushed[i].xyz * garments[g].dt;
        }
        state[rest] = vec4<f32>(select(vec3<f32>(0.0), change, 0.0 < own.w), 0.0);
        // The place ahead.
        state[first] = vec4<f32>(own.xyz + v * garments[g].dt, 0.0);
    } else if (now.stage == last) {
        state[velocity] = vec4<f32>(v + state[after_stage(last) + i].xyz, 0.0);
    } else if (now.stage == 1u) {
        let r = state[rest].xyz;
        let begun = r * stages[g * MOST_STAGES].z;
        state[first] = vec4<f32>(begun, 0.0);
        state[second] = vec4<f32>(begun * stage.x + r * stage.z, 0.0);
    } else {
        let newest = state[after_stage(now.stage) + i].xyz;
        let to = after_stage(now.stage + 1u) + i;
        let sum = newest * stage.x + state[to].xyz * stage.y + state[rest].xyz * stage.z;
        state[to] = vec4<f32>(sum, 0.0);
    }
}
