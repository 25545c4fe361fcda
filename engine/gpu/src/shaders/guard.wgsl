// Guard: whether every number of a garment is finite and within reach; those that are next to nothing become nothing.
// CPU reference: `AllFinite` in `cloth/step/guard.rs`.

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
