// Contact: which capsules and planes each particle may touch in a step (`near`, CPU reference `cloth/contact/body/near.rs`), and the
// push of touching particles along the whole of a substep (`contact`, CPU reference `solve.rs`, `touch.rs`, `sweep.rs`).
//
// A particle is tried against its capsules in their order, as on the CPU, whose blocks of particles only take turns.

// A capsule at the end of a substep, as `cones.rs` prepares it.
struct Cone {
    // First centre (m), length of the axis (m).
    a: vec4<f32>,
    // Unit axis, inverse of the length.
    axis: vec4<f32>,
    // Unit vector across, radius at the first centre and offset (m).
    across: vec4<f32>,
    // How far the first centre moves in the substep (m), radius gained a metre.
    carried: vec4<f32>,
    // How much farther the second moves (m), tangent of the slope.
    turned: vec4<f32>,
    // 1 / cosine^2, sine / cosine^2, square of what is quick (m2).
    slope: vec4<f32>,
}

// Both ends of a capsule at the start of the step, centre and radius, and what they add until its end.
struct Ends {
    start: array<vec4<f32>, 2>,
    travel: array<vec4<f32>, 2>,
}

// Of each garment: what the step sweeps, then a set of capsules a substep.
@group(1) @binding(0) var<storage, read> cones: array<Cone>;
@group(1) @binding(1) var<storage, read> ends: array<Ends>;
// Unit normals and offsets (m).
@group(1) @binding(2) var<storage, read> planes: array<vec4<f32>>;
// The capsules that each particle can touch at all, a bit each.
@group(1) @binding(3) var<storage, read> reach: array<u32>;
// Those that it may touch in this step, and the planes.
@group(1) @binding(4) var<storage, read_write> near_bits: array<vec2<u32>>;

const CAPSULES = 32u;
const SLACK_M = 0.004;
const JERK = 1.5;
const FALL_M_S2 = 10.0;
const ON_M = 1e-6;
const FARTHEST2_M2 = 1e8;
const QUICK = 0.25;
const STEPS = 32u;

// The garment's constants of contact: offset (m), static and kinetic friction, length of the step (s).
var<private> how: vec4<f32>;
// First capsule of this substep, and of the step; the substep's part of the step.
var<private> substep_set: u32;
var<private> first_end: u32;
var<private> span: vec2<f32>;
// The particle.
var<private> px: vec3<f32>;
var<private> pp: vec3<f32>;

fn rough_reciprocal_root(x: f32) -> f32 {
    let y = bitcast<f32>(0x5F1FFFF9u - (bitcast<u32>(x) >> 1u));
    return y * 0.70395225 * (2.3892446 - x * y * y);
}

// From the axis to the particle, and how far along the axis.
struct Place {
    out: vec3<f32>,
    out2: f32,
    reach: f32,
    height: f32,
}

fn around(c: u32, v: vec3<f32>, height: f32, far: f32) -> Place {
    var p: Place;
    p.height = more_of(less_of(height, cones[c].a.w), 0.0);
    p.out = v - cones[c].axis.xyz * p.height;
    p.reach = far + cones[c].across.w + p.height * cones[c].carried.w;
    p.out2 = inner(p.out, p.out);
    return p;
}

fn close(c: u32, x: vec3<f32>, far: f32) -> bool {
    let v = x - cones[c].a.xyz;
    let y = inner(v, cones[c].axis.xyz);
    let height = y * cones[c].slope.x - (far + cones[c].across.w) * cones[c].slope.y;
    let p = around(c, v, height, far);
    return p.out2 < p.reach * p.reach;
}

fn depth_behind(plane: vec4<f32>, x: vec3<f32>) -> f32 {
    return (plane.w + how.x) - (x.x * plane.x + x.y * plane.y + x.z * plane.z);
}

@compute @workgroup_size(64)
fn contact_candidates(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let g = group.x;
    how = garments[g].how;
    let touch = garments[g].touch;
    near_bits[i] = vec2<u32>(0u);
    // What is not free comes near nothing.
    if (!(0.0 < state[i].w)) {
        return;
    }
    let x = place(i);
    let v = state[2u * op.particles + i].xyz;
    let ahead = JERK * how.w;
    let fall = (FALL_M_S2 / (JERK * JERK)) * ahead * ahead;
    let speed2 = inner(v, v);
    let far = SLACK_M + fall + speed2 * reciprocal_root(speed2) * ahead;
    var found = vec2<u32>(0u);
    var bits = touch.y & reach[i];
    while (bits != 0u) {
        let c = firstTrailingBit(bits);
        bits = bits & (bits - 1u);
        if (close(touch.x * CAPSULES + c, x, far)) {
            found.x |= 1u << c;
        }
    }
    for (var p = 0u; p < touch.z; p += 1u) {
        if (-far < depth_behind(planes[touch.w + p], x)) {
            found.y |= 1u << p;
        }
    }
    near_bits[i] = found;
}

// Moves the particle out of a surface: only the approach of this substep turns into load and speed.
fn push(normal: vec3<f32>, depth: f32, carried: vec3<f32>) {
    let relative = px - pp - carried;
    let normal_motion = inner(relative, normal);
    let approach = more_of(-normal_motion, 0.0);
    let load = less_of(depth, approach);
    let sliding = relative - normal * normal_motion;
    let slid2 = inner(sliding, sliding);
    let held = how.y * load;
    var slows = less_of(how.z * load * rough_reciprocal_root(slid2), 1.0);
    slows = select(slows, 1.0, slid2 < held * held);
    let far2 = slid2 + normal_motion * normal_motion;
    if (far2 < FARTHEST2_M2) {
        px = px + normal * depth - sliding * slows;
        pp = pp + normal * (depth - load);
    }
}

// How far the point of a capsule at `along` of its axis, `radius` out along `normal`, moves in the substep.
fn carried_by(c: u32, along: f32, normal: vec3<f32>, radius: f32) -> vec3<f32> {
    let axis = cones[c].axis.xyz;
    let turned = cones[c].turned.xyz;
    let lever = radius * cones[c].axis.w;
    return cones[c].carried.xyz + turned * (along + lever * inner(axis, normal)) - axis * (lever * inner(turned, normal));
}

fn push_out(c: u32) {
    let v = px - cones[c].a.xyz;
    let y = inner(v, cones[c].axis.xyz);
    let away2 = more_of(inner(v, v) - y * y, 0.0);
    let height = y - away2 * rough_reciprocal_root(away2) * cones[c].turned.w;
    let at = around(c, v, height, 0.0);
    let nothing = 1e-18;
    let inverse = reciprocal_root(more_of(at.out2, nothing));
    var normal = at.out * inverse;
    if (at.out2 < nothing) {
        // A particle on the axis leaves it sideways.
        normal = cones[c].across.xyz;
    }
    let along = at.height * cones[c].axis.w;
    let depth = more_of(at.reach - at.out2 * inverse, 0.0);
    push(normal, depth, carried_by(c, along, normal, at.reach));
}

// One end of a capsule at `t` of the substep, centre and radius.
fn sphere(end: u32, c: u32, t: f32) -> vec4<f32> {
    let at = span.x + t * (span.y - span.x);
    return ends[first_end + c].start[end] + ends[first_end + c].travel[end] * at;
}

// A capsule at a moment, and the particle's place from it.
struct Moment {
    out: vec3<f32>,
    out2: f32,
    axis: vec3<f32>,
    distance: f32,
    along: f32,
}

fn moment(c: u32, x: vec3<f32>, t: f32) -> Moment {
    let a = sphere(0u, c, t);
    let b = sphere(1u, c, t);
    let gap = b.xyz - a.xyz;
    let d = a.w - b.w;
    let length2 = inner(gap, gap);
    let cone = d * d * 1.00002 + 1e-18 < length2;
    let inverse = select(0.0, reciprocal_root(length2), cone);
    // One sphere inside of the other: the larger alone, at an axis without length.
    let second = a.w < b.w;
    let first = select(select(a.xyz, b.xyz, second), a.xyz, cone);
    let radius = select(more_of(a.w, b.w), a.w, cone);
    var m: Moment;
    m.axis = gap * inverse;
    let sine = d * inverse;
    let cosine = sqrt(more_of(1.0 - sine * sine, 0.0));
    let v = x - first;
    let y = inner(v, m.axis);
    let away = sqrt(more_of(inner(v, v) - y * y, 0.0));
    let foot = more_of(less_of(y * cosine - away * sine, length2 * inverse * cosine), 0.0);
    let climb = select(0.0, foot / more_of(cosine, 1e-9), cone);
    let along = climb * inverse;
    m.out = v - m.axis * climb;
    m.out2 = inner(m.out, m.out);
    m.distance = m.out2 * reciprocal_root(m.out2) - (radius + (b.w - a.w) * along);
    m.along = select(select(0.0, 1.0, second), along, cone);
    return m;
}

// Square of the farthest that the particle moves relative to any point of the capsule (m2).
fn relative2(k: u32, moved: vec3<f32>) -> f32 {
    let a = moved - cones[k].carried.xyz;
    let b = a - cones[k].turned.xyz;
    return more_of(inner(a, a), inner(b, b));
}

// Whether the particle has to be followed: it moved far, and not from farther away than it could have come.
fn asks(k: u32, c: u32, moved: vec3<f32>) -> bool {
    let speed2 = relative2(k, moved);
    let speed = speed2 * reciprocal_root(speed2) * (1.0 + 1e-3);
    let slow = (less_of(sphere(0u, c, 1.0).w, sphere(1u, c, 1.0).w) + how.x) * QUICK;
    return slow * slow < speed2 && speed2 < FARTHEST2_M2 && close(k, px, speed);
}

// Conservative advancement along the substep; pushes the particle where it hits.
fn follow(k: u32, c: u32) {
    let moved = px - pp;
    let pace = reciprocal_root(relative2(k, moved));
    var t = 0.0;
    var m = moment(c, pp, t);
    for (var turn = 0u; turn <= STEPS; turn += 1u) {
        if (!(0.0 < m.distance && t < 1.0)) {
            break;
        }
        t = t + more_of(m.distance * pace, 1.0 / f32(STEPS));
        let until = less_of(t, 1.0);
        m = moment(c, pp + moved * until, until);
    }
    if (!(m.distance < 0.0 && t < 1.0 && 1e-12 < m.out2)) {
        return;
    }
    // The tangent plane of the moment of impact as the capsule has carried and turned it by the end of the substep.
    var normal = m.out * reciprocal_root(m.out2);
    let axis = cones[k].axis.xyz;
    let lifted = inner(normal, m.axis);
    let flat_part = normal - m.axis * lifted;
    let turned = flat_part - axis * inner(flat_part, axis) + axis * lifted;
    if (0.0 < inner(m.axis, m.axis) && 0.0 < cones[k].axis.w) {
        normal = turned;
    }
    normal = normal * reciprocal_root(more_of(inner(normal, normal), 1e-12));
    let a = sphere(0u, c, 1.0);
    let b = sphere(1u, c, 1.0);
    let radius = more_of(a.w + (b.w - a.w) * m.along, 0.0) + how.x;
    let depth = radius - inner(px - (a.xyz + (b.xyz - a.xyz) * m.along), normal);
    if (0.0 < depth) {
        push(normal, depth, carried_by(k, m.along, normal, radius));
    }
}

@compute @workgroup_size(64)
fn contact(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    let i = group.y + lane;
    let found = near_bits[i];
    if (found.x == 0u && found.y == 0u) {
        return;
    }
    let g = group.x;
    how = garments[g].how;
    let touch = garments[g].touch;
    substep_set = (touch.x + 1u + now.substep) * CAPSULES;
    first_end = g * CAPSULES;
    let substeps = f32(garments[g].substeps);
    span = vec2<f32>(f32(now.substep) / substeps, f32(now.substep + 1u) / substeps);
    px = place(i);
    pp = previous(i);
    var bits = found.x;
    while (bits != 0u) {
        let c = firstTrailingBit(bits);
        bits = bits & (bits - 1u);
        let k = substep_set + c;
        let moved = px - pp;
        if (cones[k].slope.z < inner(moved, moved) && asks(k, c, moved)) {
            follow(k, c);
        }
        if (close(k, px, -ON_M)) {
            push_out(k);
        }
    }
    for (var p = 0u; p < touch.z; p += 1u) {
        if (((found.y >> p) & 1u) != 0u) {
            let plane = planes[touch.w + p];
            let depth = depth_behind(plane, px);
            if (0.0 < depth) {
                push(plane.xyz, depth, vec3<f32>(0.0));
            }
        }
    }
    put(i, px);
    state[op.particles + i] = vec4<f32>(pp, 0.0);
}
