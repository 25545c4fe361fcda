// Diagonals: fibers along the bias, each solved directly (tridiagonal), one invocation a fiber of a family.
// CPU reference: `cloth/links/diagonals.rs`, which goes row by row instead; no two fibers of a family share a
// particle, so that both give the same.

// First particle of each fiber, its first slot, its links, how far apart its slots are [fibers].
@group(1) @binding(0) var<storage, read> heads: array<vec4<u32>>;
// The particle that each link leads to [slots].
@group(1) @binding(1) var<storage, read> leads: array<u32>;
// Rest length (m), compliance (m/N), weights of both ends [slots].
@group(1) @binding(2) var<storage, read> measures: array<vec4<f32>>;
// Direction and 1 / pivot [slots].
@group(1) @binding(3) var<storage, read_write> kept: array<vec4<f32>>;
// Tension as if nothing followed, less what the length makes of it [slots].
@group(1) @binding(4) var<storage, read_write> lengths: array<f32>;

@compute @workgroup_size(64)
fn diagonals(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    if (lane >= group.z || now.substep % garments[g].shear_every != 0u) {
        return;
    }
    let head = heads[group.y + lane];
    let gamma = garments[g].gamma;
    let more = 1.0 + gamma;
    let per_dt2 = garments[g].shear_per_dt2;
    var a = head.x;
    var pa = place(a);
    var normal = vec3<f32>(0.0);
    var pivot = 0.0;
    var tension = 0.0;
    for (var link = 0u; link < head.z; link += 1u) {
        let slot = head.y + link * head.w;
        let b = leads[slot];
        let m = measures[slot];
        let pb = place(b);
        let d = pb - pa;
        let length2 = inner(d, d);
        let inverse = reciprocal_root(length2);
        let next = d * inverse;
        let length = length2 * inverse;
        var stretch = length - m.x;
        if (gamma > 0.0) {
            let moved = (pb - previous(b)) - (pa - previous(a));
            stretch = stretch + inner(next, moved) * gamma;
        }
        // L D L^T: `beside` is minus the entry beside the diagonal.
        let beside = m.z * inner(next, normal) * more;
        let diagonal = (m.z + m.w) * more + m.y * per_dt2;
        let left = more_of(diagonal - beside * beside * pivot, more_of(diagonal * LEAST_PIVOT, NO_PIVOT));
        pivot = 1.0 / left;
        tension = (stretch + beside * tension) * pivot;
        kept[slot] = vec4<f32>(next, pivot);
        lengths[slot] = tension - pivot * more * length;
        a = b;
        pa = pb;
        normal = next;
    }
    for (var up = head.z; up > 0u; up -= 1u) {
        let slot = head.y + (up - 1u) * head.w;
        let b = leads[slot];
        var other = head.x;
        if (up > 1u) {
            other = leads[slot - head.w];
        }
        let m = measures[slot];
        let own = kept[slot];
        let p = place(other);
        let q = place(b);
        let pull = lengths[slot] + own.w * more * inner(own.xyz, q - p);
        // No end moves farther than half the link, beyond which the directions mean nothing.
        let reach = m.x * FARTHEST;
        put(other, p + own.xyz * more_of(less_of(pull * m.z, reach), -reach));
        put(b, q - own.xyz * more_of(less_of(pull * m.w, reach), -reach));
    }
}
