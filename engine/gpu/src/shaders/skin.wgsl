// Skin: rest vertices, weights and a palette become a posed surface, a vertex an invocation, by linear blending or dual
// quaternions. CPU reference: `skin/kernel.rs`.
//
// Bones are blended as base + w1 (bone1 - base) + ...; a run of vertices follows the same bones, so neighbours among the
// invocations read the same numbers of the palette.

// A vertex at rest.
struct Vertex {
    // Its place (m), and its run.
    position: vec3<f32>,
    run: u32,
    // Its unit normal, or zero, and its number among the vertices of all bodies.
    normal: vec3<f32>,
    place: u32,
}

// A workgroup's body, first vertex as laid, number of vertices, first weight.
@group(0) @binding(0) var<storage, read> groups: array<vec4<u32>>;
// Eight bones of a byte each, the base first; their number; the first bone of the body in the palette.
@group(0) @binding(1) var<storage, read> runs: array<vec4<u32>>;
// As laid [vertices].
@group(0) @binding(2) var<storage, read> vertices: array<Vertex>;
// What the bones but the base weigh: 64 numbers a bone for each workgroup, an invocation a number.
@group(0) @binding(3) var<storage, read> weights: array<f32>;
// Of each bone three rows of its matrix, or its dual quaternion: real, dual.
@group(0) @binding(4) var<storage, read> palette: array<vec4<f32>>;
// Places (m) in the order of the meshes, 1 behind each [vertices].
@group(0) @binding(5) var<storage, read_write> positions: array<vec4<f32>>;
// Unit normals likewise, 0 behind each [vertices].
@group(0) @binding(6) var<storage, read_write> normals: array<vec4<f32>>;

const WIDTH = 64u;
// Square of the length below which a normal, or a blend of rotations, is taken for collapsed.
const COLLAPSED = 1e-24;

// Where the palette has the kth bone of a run, in bones.
fn bone(run: vec4<u32>, k: u32) -> u32 {
    let four = select(run.x, run.y, k >= 4u);
    return run.w + ((four >> (8u * (k & 3u))) & 255u);
}

// 1, which no compiler knows: the factor that makes a product of a sum. Of (a b + c d) + e Mesa makes (a b + e) + c d, but
// not where e is a product.
fn one(run: vec4<u32>) -> f32 {
    return f32(min(run.z, 1u));
}

// A coordinate of a point that a row of a matrix moves.
fn moved_by(row: vec4<f32>, p: vec3<f32>, by: f32) -> f32 {
    return (row.x * p.x + row.y * p.y) + (row.z * p.z + row.w) * by;
}

@compute @workgroup_size(64)
fn skin_linear(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[at.x];
    if (lane >= group.z) {
        return;
    }
    let own = vertices[group.y + lane];
    let run = runs[own.run];
    let base = 3u * bone(run, 0u);
    let base_x = palette[base];
    let base_y = palette[base + 1u];
    let base_z = palette[base + 2u];
    var x = base_x;
    var y = base_y;
    var z = base_z;
    for (var k = 1u; k < run.z; k++) {
        let more = 3u * bone(run, k);
        let weight = weights[group.w + (k - 1u) * WIDTH + lane];
        x = x + (palette[more] - base_x) * weight;
        y = y + (palette[more + 1u] - base_y) * weight;
        z = z + (palette[more + 2u] - base_z) * weight;
    }
    let p = own.position;
    let n = own.normal;
    let by = one(run);
    let normal = vec3<f32>(inner(x.xyz, n), inner(y.xyz, n), inner(z.xyz, n));
    let squared = inner(normal, normal);
    let scale = select(0.0, reciprocal_root(squared), COLLAPSED < squared);
    positions[own.place] = vec4<f32>(moved_by(x, p, by), moved_by(y, p, by), moved_by(z, p, by), 1.0);
    normals[own.place] = vec4<f32>(normal * scale, 0.0);
}

// With the blend r + e d, r = (v, w), d = (u, s), a point p goes to p + 2 / |r|^2 (v x (v x p + w p + u) + w u - s v), a
// direction n to n + 2 / |r|^2 v x (v x n + w n) (Kavan et al. 2008, equation 6).
@compute @workgroup_size(64)
fn skin_dual(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[at.x];
    if (lane >= group.z) {
        return;
    }
    let own = vertices[group.y + lane];
    let run = runs[own.run];
    let base = 2u * bone(run, 0u);
    let base_real = palette[base];
    let base_dual = palette[base + 1u];
    var real = base_real;
    var dual = base_dual;
    for (var k = 1u; k < run.z; k++) {
        let more = 2u * bone(run, k);
        let weight = weights[group.w + (k - 1u) * WIDTH + lane];
        real = real + (palette[more] - base_real) * weight;
        dual = dual + (palette[more + 1u] - base_dual) * weight;
    }
    let v = real.xyz;
    let w = real.w;
    let squared = inner(v, v) + w * w;
    // Bones that cancel each other leave no rotation; the lower bound keeps the result finite.
    let factor = 2.0 / more_of(squared, COLLAPSED);
    let p = own.position;
    let n = own.normal;
    let along = (dual.xyz * w - v * dual.w) * one(run);
    let moved = cross_product(v, cross_product(v, p) + p * w + dual.xyz) + along;
    let turned = cross_product(v, cross_product(v, n) + n * w);
    positions[own.place] = vec4<f32>(p + moved * factor, 1.0);
    normals[own.place] = vec4<f32>(n + turned * factor, 0.0);
}
