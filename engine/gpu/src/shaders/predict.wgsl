// Predict: gravity, air and wind move every free particle; the skinned ones follow the body. CPU reference: `cloth/forces/predict.rs`.

// Which target each particle follows; NONE where it is free [particles].
@group(1) @binding(0) var<storage, read> pins: array<u32>;
// Where each skinned particle is at the start and at the end of the step [2 * pins].
@group(1) @binding(1) var<storage, read> targets: array<vec4<f32>>;
// Accelerations besides gravity (m/s2) [particles].
@group(1) @binding(2) var<storage, read> pushed: array<vec4<f32>>;

const NONE = 0xFFFFFFFFu;

@compute @workgroup_size(64)
fn predict(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let g = group.x;
    let particle = state[i];
    let x = particle.xyz;
    state[op.particles + i] = vec4<f32>(x, 0.0);
    let velocity = 2u * op.particles + i;
    // A skinned particle has no velocity of its own.
    let kept = select(0.0, garments[g].kept, 0.0 < particle.w);
    var v = state[velocity].xyz;
    // Stages have accelerated everything already.
    if (garments[g].stages < 2u) {
        v = v + garments[g].fall;
        if ((garments[g].bits & (WIND | COMPENSATE)) != 0u) {
            v = v + pushed[i].xyz * garments[g].dt;
        }
    }
    v = v * kept;
    state[velocity] = vec4<f32>(v, 0.0);
    var to = x + v * garments[g].dt;
    let pin = pins[i];
    if (pin != NONE) {
        let share = f32(now.substep + 1u) / f32(garments[g].substeps);
        to = targets[2u * pin].xyz * (1.0 - share) + targets[2u * pin + 1u].xyz * share;
    }
    state[i] = vec4<f32>(to, particle.w);
}
