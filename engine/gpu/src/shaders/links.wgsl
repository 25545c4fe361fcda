// Links: stretch between two particles, one half of a set a dispatch, a link an invocation. CPU reference: `cloth/links/mod.rs`.
//
// No two links of a dispatch share a particle: their order changes no bit.

// Both ends, and the bits of the weights that they count with [links].
@group(1) @binding(0) var<storage, read> ends: array<vec4<u32>>;
// Rest length (m), compliance (m/N), gain, 1 over the square of the rest length (1/m2) [links].
@group(1) @binding(1) var<storage, read> measures: array<vec4<f32>>;
// Tension of each link so far in the substep [links].
@group(1) @binding(2) var<storage, read_write> tensions: array<f32>;

// Most that a pass is given of |d|^2 / rest^2 - 1.
const MOST_EXCESS = 0.6666667;

@compute @workgroup_size(64)
fn links(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let k = group.y + lane;
    let g = group.x;
    let ab = ends[k];
    let wa = bitcast<f32>(ab.z);
    let wb = bitcast<f32>(ab.w);
    let rest = measures[k].x;
    let gain = measures[k].z;
    let gamma = garments[g].gamma;
    // The fourth number is not 0 where these links may keep their tension.
    let soft = (garments[g].bits & group.w) != 0u;
    let a = state[ab.x];
    let b = state[ab.y];
    let d = b.xyz - a.xyz;
    let length2 = inner(d, d);
    var by_a: vec3<f32>;
    var by_b: vec3<f32>;
    if (gamma > 0.0 || soft) {
        let inverse = reciprocal_root(length2);
        var tension = 0.0;
        var slack = 0.0;
        if (soft) {
            if (op.fresh == 0u) {
                tension = tensions[k];
            }
            slack = tension * measures[k].y * garments[g].per_dt2;
        }
        var stretch = length2 * inverse - rest - slack;
        if (gamma > 0.0) {
            let moved = (b.xyz - previous(ab.y)) - (a.xyz - previous(ab.x));
            stretch = stretch + inner(d, moved) * inverse * gamma;
        }
        let by = stretch * gain;
        let pull = by * inverse;
        by_a = d * (pull * wa);
        by_b = d * (pull * wb);
        if (soft) {
            tensions[k] = tension + by;
        }
    } else {
        let e = less_of(length2 * measures[k].w - 1.0, MOST_EXCESS);
        let excess = e * (0.5 - e * 0.375);
        by_a = d * (excess * (gain * wa));
        by_b = d * (excess * (gain * wb));
    }
    state[ab.x] = vec4<f32>(a.xyz + by_a, a.w);
    state[ab.y] = vec4<f32>(b.xyz - by_b, b.w);
}
