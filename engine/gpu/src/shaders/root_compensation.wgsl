// Root compensation: the part of the root's motion that the cloth is not to feel.
// CPU reference: `Compensate` in `cloth/forces/root.rs`, where the equations are.
//
// The CPU has the wind's accelerations before it and adds to them; here `wind_forces` adds to these, because a compiler that
// sees all of the sum in one kernel may add its parts in another order, and llvmpipe's gave another last bit.

// Accelerations besides gravity (m/s2) [particles].
@group(1) @binding(0) var<storage, read_write> pushed: array<vec4<f32>>;

// The acceleration of what is at r from the root's origin and moves with v.
fn felt(carried: array<vec4<f32>, 5>, r: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    let turning = carried[2].xyz;
    let around = cross_product(turning, r);
    return cross_product(turning, v - carried[1].xyz - around) * carried[1].w + cross_product(turning, around) * carried[2].w;
}

@compute @workgroup_size(64)
fn root_compensation(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z || (garments[group.x].bits & COMPENSATE) == 0u) {
        return;
    }
    let i = group.y + lane;
    let velocity = 2u * op.particles + i;
    let carried = garments[group.x].carried;
    let half = carried[0].w;
    let r = place(i) - carried[0].xyz;
    let v = state[velocity].xyz + carried[3].xyz + cross_product(carried[4].xyz, r);
    // The midpoint rule.
    let a = felt(carried, r + (v - carried[1].xyz) * half, v + felt(carried, r, v) * half);
    state[velocity] = vec4<f32>(v, 0.0);
    pushed[i] = vec4<f32>(a, 0.0);
}
