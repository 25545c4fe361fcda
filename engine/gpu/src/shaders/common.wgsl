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
    // Farthest that a particle moves in a substep (m); substeps; see the bits below; nothing.
    farthest: f32,
    substeps: u32,
    bits: u32,
    spare: u32,
    // The root, by its axes and its place: where a garment is dressed again.
    root: array<vec4<f32>, 4>,
    // What a jump of the root moves along, likewise.
    motion: array<vec4<f32>, 4>,
    // Contact: offset (m), static and kinetic friction, length of the step (s).
    how: vec4<f32>,
    // Its first set of capsules, those to be believed, its planes, and where they begin.
    touch: vec4<u32>,
}

// Bits of a garment: which constraints remember their tension, whether fibers are calmed, whether tethers hold.
const SOFT_WEFT = 1u;
const SOFT_FIBERS = 2u;
const TAUT = 4u;
const TETHERS = 8u;
const SOFT_CROSSING = 64u;
// Bits of a step: the garment is dressed again; it is carried along.
const DRESS = 16u;
const CARRY = 32u;

@group(0) @binding(0) var<uniform> op: Op;
@group(0) @binding(1) var<storage, read> garments: array<Garment>;
// A workgroup's garment, first item, number of items, and what else the kernel wants to know.
@group(0) @binding(2) var<storage, read> groups: array<vec4<u32>>;
// Places and inverse masses, then where the substep began, then velocities: `particles` of each.
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
