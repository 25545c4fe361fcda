// Wind: once a step, first what presses each triangle, then what that does to each particle, in the CPU's order of sums.
// CPU reference: `cloth/forces/wind.rs`, where the equations are.

// Corners, and the bits of the mass that moves with the triangle (kg) [triangles].
@group(1) @binding(0) var<storage, read> faces: array<vec4<u32>>;
// A third of the force on each triangle (N) [triangles].
@group(1) @binding(1) var<storage, read_write> forces: array<vec4<f32>>;
// Where each particle's triangles begin [particles + 1].
@group(1) @binding(2) var<storage, read> starts: array<u32>;
// The triangles around each particle, in order.
@group(1) @binding(3) var<storage, read> around: array<u32>;
// Accelerations besides gravity (m/s2) [particles].
@group(1) @binding(4) var<storage, read_write> pushed: array<vec4<f32>>;

// A quarter of the density of dry air (kg/m3).
const AIR = 0.301;
const THIRD = 0.33333334;

fn speed(i: u32) -> vec3<f32> {
    return state[2u * op.particles + i].xyz;
}

@compute @workgroup_size(64)
fn wind(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let g = group.x;
    if (lane >= group.z || (garments[g].bits & WIND) == 0u) {
        return;
    }
    let face = faces[group.y + lane];
    let air = garments[g].air;
    let drag = air.w;
    let lift = garments[g].blow.x;
    let corner = place(face.x);
    let u = air.xyz - (speed(face.x) + speed(face.y) + speed(face.z)) * THIRD;
    let normal = cross_product(place(face.y) - corner, place(face.z) - corner);
    let uu = inner(u, u);
    let un = inner(u, normal);
    let square = uu * inner(normal, normal);
    let inverse = reciprocal_root(square);
    let lee = un * inverse;
    let c = less_of(more_of(lee, -lee), 1.0);
    let pressed = less_of(AIR * square * inverse, bitcast<f32>(face.w) * garments[g].blow.y);
    let k = pressed * THIRD;
    let force = u * (k * c * (drag - lift * c)) + normal * (k * lee * lift * uu * inverse);
    forces[group.y + lane] = vec4<f32>(force, 0.0);
}

// A particle an invocation. What `root_compensation` has found is added.
@compute @workgroup_size(64)
fn wind_forces(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    let bits = garments[group.x].bits;
    if (lane >= group.z || (bits & WIND) == 0u) {
        return;
    }
    let i = group.y + lane;
    let w = state[i].w;
    var sum = vec3<f32>(0.0);
    for (var t = starts[i]; t < starts[i + 1u]; t += 1u) {
        sum = sum + forces[around[t]].xyz * w;
    }
    if ((bits & COMPENSATE) != 0u) {
        sum = sum + pushed[i].xyz;
    }
    pushed[i] = vec4<f32>(sum, 0.0);
}
