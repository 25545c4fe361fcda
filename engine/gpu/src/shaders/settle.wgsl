// Settle: velocities from where the particles came to lie, limited. CPU reference: `cloth/step/settle.rs`.

@compute @workgroup_size(64)
fn settle(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let g = group.x;
    let own = state[i];
    let x = own.xyz;
    let before = previous(i);
    let velocity = 2u * op.particles + i;
    let foreseen = state[velocity].xyz;
    let dt = garments[g].dt;
    let per_dt = garments[g].per_dt;
    let farthest = garments[g].farthest;
    let moved = x - before;
    let distance2 = inner(moved, moved);
    // What the constraints changed, added to the velocity that was foreseen.
    var v = foreseen + (x - (before + foreseen * dt)) * per_dt;
    if (farthest * farthest < distance2 && 0.0 < own.w) {
        let held = moved * (farthest * reciprocal_root(distance2));
        state[i] = vec4<f32>(before + held, own.w);
        v = held * per_dt;
        atomicAdd(&reports[g].limited, 1u);
    }
    state[velocity] = vec4<f32>(v, 0.0);
}
