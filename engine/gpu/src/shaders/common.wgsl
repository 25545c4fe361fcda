// What every kernel of the cloth begins with, behind `lanes.wgsl`: the scene's bindings.

// One dispatch.
struct Op {
    // First of its workgroups in `groups`.
    first: u32,
    // 1 where tensions start from none.
    fresh: u32,
    // Particles of the scene: how far the three parts of `state` lie from each other.
    particles: u32,
    spare: u32,
}

// The moment of a dispatch.
struct Now {
    // Substep of the step.
    substep: u32,
    // Stage of bending that is stiffer than a substep.
    stage: u32,
}

// What the settings make of a garment: see `constants.rs`, which has the same fields in the same order.
struct Garment {
    // Gravity over a substep (m/s), and what the air leaves of a velocity.
    fall: vec3<f32>,
    kept: f32,
    // Length of a substep (s), its inverse, that squared, damping time over it.
    dt: f32,
    per_dt: f32,
    per_dt2: f32,
    gamma: f32,
    // Length of the time that bending acts for (s), every so many substeps; 1 / dt^2 of shear, every so many.
    bend_by: f32,
    bend_every: u32,
    shear_per_dt2: f32,
    shear_every: u32,
    // Farthest that a particle moves in a substep (m); substeps; see the bits below; stages of bending, 1 for a force.
    farthest: f32,
    substeps: u32,
    bits: u32,
    stages: u32,
    // The root, by its axes and its place: where a garment is dressed again.
    root: array<vec4<f32>, 4>,
    // What a jump of the root moves along, likewise.
    motion: array<vec4<f32>, 4>,
    // Contact: offset (m), static and kinetic friction, length of the step (s).
    how: vec4<f32>,
    // Its first set of capsules, those to be believed, its planes, and where they begin.
    touch: vec4<u32>,
    // Wind: velocity of the air (m/s) and drag coefficient; lift coefficient, 1 / ((Cd + Cl) dt) (1/s).
    air: vec4<f32>,
    blow: vec4<f32>,
    // What of the root's motion is not to be felt, as `Carried` of `cloth/forces/root.rs` has it: origin and half the step (s);
    // velocity and twice the share of Coriolis' force; angular velocity and the share of the pull to the axis; jolt; twist.
    carried: array<vec4<f32>, 5>,
}

// Bits of a garment: which constraints remember their tension, whether fibers are calmed, whether tethers hold.
const SOFT_WEFT = 1u;
const SOFT_FIBERS = 2u;
const TAUT = 4u;
const TETHERS = 8u;
const SOFT_CROSSING = 64u;
// Bits of a step: the garment is dressed again; it is carried along; there is wind; part of the root's motion is not felt.
const DRESS = 16u;
const CARRY = 32u;
const WIND = 128u;
const COMPENSATE = 256u;

// Most stages of bending.
const MOST_STAGES = 160u;

@group(0) @binding(0) var<uniform> op: Op;
@group(0) @binding(1) var<storage, read> garments: array<Garment>;
// A workgroup's garment, first item, number of items, and what else the kernel wants to know.
@group(0) @binding(2) var<storage, read> groups: array<vec4<u32>>;
// Places and inverse masses, then where the substep began, then velocities: `particles` of each; behind them, where bending
// can be stiffer than a substep, its scratch columns: see `stage_combine.wgsl`.
@group(0) @binding(3) var<storage, read_write> state: array<vec4<f32>>;
@group(0) @binding(4) var<uniform> now: Now;

fn place(i: u32) -> vec3<f32> {
    return state[i].xyz;
}

fn previous(i: u32) -> vec3<f32> {
    return state[op.particles + i].xyz;
}

fn put(i: u32, x: vec3<f32>) {
    state[i] = vec4<f32>(x, state[i].w);
}

// Least pivot as a share of its diagonal; a pivot where there is no link; farthest move of one solve, in links.
const LEAST_PIVOT = 1e-5;
const NO_PIVOT = 1e-12;
const FARTHEST = 0.5;

// Farthest from the origin that anything can be (m); what is next to nothing (m, m/s): `cloth/step/guard.rs`.
const FARTHEST_M = 10000.0;
const LEAST = 1e-12;

// What is next to nothing is nothing.
fn calm(v: vec3<f32>) -> vec3<f32> {
    return select(v, vec3<f32>(0.0), abs(v) < vec3<f32>(LEAST));
}

// Asked by the bits: a compiler may take every number for one.
fn finite(v: vec3<f32>) -> bool {
    let exponents = bitcast<vec3<u32>>(v) & vec3<u32>(0x7F800000u);
    return all(exponents != vec3<u32>(0x7F800000u));
}

fn within_reach(v: vec3<f32>) -> bool {
    return all(abs(v) <= vec3<f32>(FARTHEST_M));
}

// Where a scratch column of the stages begins, 0 to 2.
fn scratch(part: u32) -> u32 {
    return (3u + part) * op.particles;
}

// Where the change of velocity after stage `j` begins.
fn after_stage(j: u32) -> u32 {
    return scratch(1u + (j + 1u) % 2u);
}
