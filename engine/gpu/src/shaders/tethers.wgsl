// Tethers: no particle gets farther from where the garment hangs than the cloth between them is long. CPU
// reference: `cloth/links/tethers.rs`. Anchors are skinned particles, which no invocation moves.

// Anchor of each particle, and bits of the length (m) of the way to it [particles].
@group(1) @binding(0) var<storage, read> tether_of: array<vec2<u32>>;

const SLACK = 1.02;

@compute @workgroup_size(64)
fn tethers(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z || (garments[group.x].bits & TETHERS) == 0u) {
        return;
    }
    let i = group.y + lane;
    let own = state[i];
    let tether = tether_of[i];
    let length = bitcast<f32>(tether.y) * SLACK;
    if (!(0.0 < own.w) || !(0.0 < length)) {
        return;
    }
    let anchor = place(tether.x);
    let d = own.xyz - anchor;
    let size2 = inner(d, d);
    if (length * length < size2) {
        state[i] = vec4<f32>(anchor + d * (length * reciprocal_root(size2)), own.w);
    }
}
