// Faces: each triangle's normal, twice its area long, a triangle an invocation. CPU reference: the first half of
// `vertex_normals` in `assets/base/src/mesh.rs`. `normals` sums them, which in one kernel drivers may do in another order.

// Particles of each triangle [3 * triangles].
@group(1) @binding(0) var<storage, read> corners: array<u32>;
// Last good places [particles].
@group(1) @binding(1) var<storage, read> good: array<vec4<f32>>;
@group(1) @binding(2) var<storage, read_write> areas: array<vec4<f32>>;

@compute @workgroup_size(64)
fn faces(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let face = group.y + lane;
    let a = good[corners[3u * face]].xyz;
    let b = good[corners[3u * face + 1u]].xyz;
    let c = good[corners[3u * face + 2u]].xyz;
    areas[face] = vec4<f32>(cross_product(b - a, c - a), 0.0);
}
