// Normals: unit normals for drawing, from the areas of `faces`, a particle an invocation. CPU reference: the second half
// of `vertex_normals` in `assets/base/src/mesh.rs`.

// Where each particle's faces begin [particles + 1].
@group(1) @binding(0) var<storage, read> starts: array<u32>;
// The triangles at each particle, in the CPU's order.
@group(1) @binding(1) var<storage, read> incident: array<u32>;
@group(1) @binding(2) var<storage, read> areas: array<vec4<f32>>;
@group(1) @binding(3) var<storage, read_write> unit: array<vec4<f32>>;

@compute @workgroup_size(64)
fn normals(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    var n = vec3<f32>(0.0);
    for (var f = starts[i]; f < starts[i + 1u]; f += 1u) {
        n = n + areas[incident[f]].xyz;
    }
    let length2 = inner(n, n);
    // Without area there is no direction.
    var of_one = 0.0;
    if (0.0 < length2) {
        of_one = 1.0 / sqrt(length2);
    }
    unit[i] = vec4<f32>(n * of_one, 0.0);
}
