// Teleport: the root has been put somewhere else. A garment is dressed again there, at rest, or carried along as it is. CPU
// reference: that case of `Cloth::begin`.

// Last good places [particles].
@group(1) @binding(0) var<storage, read_write> good: array<vec4<f32>>;
// Where each particle starts, in the rest pose [particles].
@group(1) @binding(1) var<storage, read> start: array<vec4<f32>>;

@compute @workgroup_size(64)
fn teleport(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let g = group.x;
    let bits = garments[g].bits;
    if ((bits & DRESS) != 0u) {
        let root = garments[g].root;
        let s = start[i].xyz;
        let dressed = root[0].xyz * s.x + root[1].xyz * s.y + root[2].xyz * s.z + root[3].xyz;
        put(i, dressed);
        state[op.particles + i] = vec4<f32>(dressed, 0.0);
        state[2u * op.particles + i] = vec4<f32>(0.0);
    }
    if ((bits & CARRY) != 0u) {
        let m = garments[g].motion;
        let x = place(i);
        let before = previous(i);
        let v = state[2u * op.particles + i].xyz;
        let last = good[i].xyz;
        put(i, m[0].xyz * x.x + m[1].xyz * x.y + m[2].xyz * x.z + m[3].xyz);
        let moved = m[0].xyz * before.x + m[1].xyz * before.y + m[2].xyz * before.z + m[3].xyz;
        state[op.particles + i] = vec4<f32>(moved, 0.0);
        state[2u * op.particles + i] = vec4<f32>(m[0].xyz * v.x + m[1].xyz * v.y + m[2].xyz * v.z, 0.0);
        good[i] = vec4<f32>(m[0].xyz * last.x + m[1].xyz * last.y + m[2].xyz * last.z + m[3].xyz, 1.0);
    }
}
