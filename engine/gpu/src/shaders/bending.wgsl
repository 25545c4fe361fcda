// Bending: first the curvature of every stencil and hub, then what they do to each particle, in the CPU's order of sums.
// Twin of `cloth/bending.rs` and `cloth/hubs.rs`.

// First term and number of terms of each curvature [curvatures].
@group(1) @binding(0) var<storage, read> items: array<vec2<u32>>;
// Particle and bits of its coefficient (sqrt(N/m)).
@group(1) @binding(1) var<storage, read> terms: array<vec2<u32>>;
// Share of each curvature's stiffness that the substep carries [curvatures].
@group(1) @binding(2) var<storage, read> scales: array<f32>;
// The curvatures, times that and the time that bending acts for [curvatures].
@group(1) @binding(3) var<storage, read_write> curvatures: array<vec4<f32>>;

@compute @workgroup_size(64)
fn bending(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    if (lane >= group.z || now.substep % garments[g].bend_every != 0u) {
        return;
    }
    let k = group.y + lane;
    let item = items[k];
    let first = terms[item.x];
    var d = place(first.x) * bitcast<f32>(first.y);
    for (var t = 1u; t < item.y; t += 1u) {
        let term = terms[item.x + t];
        d = d + place(term.x) * bitcast<f32>(term.y);
    }
    curvatures[k] = vec4<f32>(d * (garments[g].bend_by * scales[k]), 0.0);
}
