// Fibers: the tridiagonal system of each fiber's tensions, a fiber an invocation (`fibers`), or a workgroup where they are few
// and long (`cyclic`). CPU reference: `cloth/links/fibers.rs`.
//
// Neighbouring invocations are neighbouring fibers of a bundle: what one row holds of them lies side by side.

struct Bundle {
    // 0 Gauss-Seidel, 1 semi-implicit, 2 zero stretch.
    solver: u32,
    // Fibers.
    lanes: u32,
    // First of its rows, and how many.
    rows: u32,
    count: u32,
    // Where its measures begin; number of its first link; whether its fibers are alike.
    at: u32,
    serial: u32,
    alike: u32,
    spare: u32,
}

@group(1) @binding(0) var<storage, read> bundles: array<Bundle>;
// First particle of each row, and how many fibers reach so far.
@group(1) @binding(1) var<storage, read> rows: array<vec2<u32>>;
// Rest length (m) and compliance (m/N).
@group(1) @binding(2) var<storage, read> measures: array<vec2<f32>>;
// Direction of each link and its factor on the way down [links].
@group(1) @binding(3) var<storage, read_write> kept: array<vec4<f32>>;
// Its right-hand side over the pivot, and its tension so far in the substep [links].
@group(1) @binding(4) var<storage, read_write> sides: array<vec2<f32>>;

const GAUSS_SEIDEL = 0u;
const ZERO_STRETCH = 2u;
const ENDED = 1e20;
const ACROSS = 0.5;

var<private> bundle: Bundle;
var<private> fiber: u32;
// Links of this fiber.
var<private> links: u32;
var<private> garment: u32;

fn particle(row: u32) -> u32 {
    return rows[bundle.rows + row].x + fiber;
}

fn weight(row: u32) -> f32 {
    let first = rows[bundle.rows + row].x;
    return state[select(first + fiber, first, bundle.alike != 0u)].w;
}

fn measure(link: u32) -> vec2<f32> {
    if (bundle.alike != 0u) {
        return measures[bundle.at + link];
    }
    return measures[bundle.at + link * bundle.lanes + fiber];
}

fn number(link: u32) -> u32 {
    return bundle.serial + link * bundle.lanes + fiber;
}

fn tension(link: u32, fresh: bool) -> f32 {
    if (fresh || (garments[garment].bits & SOFT_FIBERS) == 0u) {
        return 0.0;
    }
    return sides[number(link)].y;
}

fn count(link: u32, by: f32, fresh: bool) {
    if ((garments[garment].bits & SOFT_FIBERS) != 0u) {
        sides[number(link)].y = tension(link, fresh) + by;
    }
}

// The way down: directions, factors, right-hand sides.
fn down(zero: bool, fresh: bool) {
    let gamma = garments[garment].gamma;
    let per_dt2 = garments[garment].per_dt2;
    let soften = !zero && (gamma > 0.0 || (garments[garment].bits & SOFT_FIBERS) != 0u);
    var at = particle(0u);
    var p = place(at);
    var moved = vec3<f32>(0.0);
    if (soften) {
        moved = p - previous(at);
    }
    var w = weight(0u);
    var normal = vec3<f32>(0.0);
    var pivot = 0.0;
    var y = 0.0;
    for (var link = 0u; link < links; link += 1u) {
        at = particle(link + 1u);
        let q = place(at);
        let w_q = weight(link + 1u);
        let m = measure(link);
        let d = q - p;
        let length2 = inner(d, d);
        let inverse = reciprocal_root(length2);
        let next = d * inverse;
        var stretch = length2 * inverse - m.x;
        var both = w + w_q;
        var beside = w * inner(next, normal);
        var stiff = m.y * per_dt2;
        if (zero) {
            stretch = more_of(stretch, 0.0);
            stiff = select(0.0, m.y, 0.1 * ENDED < m.y);
        }
        if (soften) {
            // What the link gives by its compliance under the tension that it has, and its damping.
            let moves = q - previous(at);
            stretch = stretch + gamma * inner(next, moves - moved) - tension(link, fresh) * stiff;
            moved = moves;
            both = both + gamma * both;
            beside = beside + gamma * beside;
        }
        // L D L^T: `beside` is minus the entry beside the diagonal.
        let diagonal = both + stiff;
        let factor = beside * pivot;
        let left = more_of(diagonal - factor * beside, more_of(diagonal * LEAST_PIVOT, NO_PIVOT));
        pivot = 1.0 / left;
        y = stretch + factor * y;
        let k = number(link);
        kept[k] = vec4<f32>(next, factor);
        sides[k].x = y * pivot;
        p = q;
        w = w_q;
        normal = next;
    }
}

// A motion of which the part across a link is no more than half of the way back to the line.
fn calmed(by: vec3<f32>, normal: vec3<f32>, pull: f32) -> vec3<f32> {
    let along = normal * inner(by, normal);
    let share = ACROSS / more_of(pull, ACROSS);
    return along + (by - along) * share;
}

// The way up: tensions, and the motion that they cause.
fn back(fresh: bool) {
    let taut = (garments[garment].bits & TAUT) != 0u;
    var below = vec3<f32>(0.0);
    var lambda = 0.0;
    var factor = 0.0;
    var reach = 0.0;
    var held = 0.0;
    for (var up = links; up > 0u; up -= 1u) {
        let link = up - 1u;
        let k = number(link);
        let own = kept[k];
        lambda = sides[k].x + factor * lambda;
        factor = own.w;
        count(link, lambda, fresh);
        let pull = own.xyz * lambda;
        let rest = measure(link).x;
        reach = rest * FARTHEST;
        let w = weight(link + 1u);
        var by = (below - pull) * w;
        if (taut) {
            let holds = more_of(lambda, -lambda) / more_of(rest, NO_PIVOT);
            by = calmed(by, own.xyz, w * (held + holds));
            held = holds;
        }
        let at = particle(link + 1u);
        put(at, place(at) + limited(by, reach));
        below = pull;
    }
    let top = particle(0u);
    put(top, place(top) + limited(below * weight(0u), reach));
}

// Gauss-Seidel down the fiber, each link once.
fn sweep(fresh: bool) {
    let per_dt2 = garments[garment].per_dt2;
    var above = particle(0u);
    var p = place(above);
    var w = weight(0u);
    for (var link = 0u; link < links; link += 1u) {
        let at = particle(link + 1u);
        var q = place(at);
        let w_q = weight(link + 1u);
        let m = measure(link);
        let d = q - p;
        let length2 = inner(d, d);
        let inverse = reciprocal_root(length2);
        let heft = more_of(w + w_q + m.y * per_dt2, NO_PIVOT);
        let slack = tension(link, fresh) * m.y * per_dt2;
        let by = (length2 * inverse - m.x - slack) / heft;
        count(link, by, fresh);
        let pull = by * inverse;
        put(above, p + d * (pull * w));
        q = q - d * (pull * w_q);
        p = q;
        w = w_q;
        above = at;
    }
    put(above, p);
}

// From the support on, every particle whose link is too long is drawn to its length.
fn shorten() {
    var p = place(particle(0u));
    for (var link = 0u; link < links; link += 1u) {
        let at = particle(link + 1u);
        let q = place(at);
        let d = q - p;
        let share = less_of(measure(link).x * reciprocal_root(inner(d, d)), 1.0);
        p = select(q, p + d * share, 0.0 < weight(link + 1u));
        put(at, p);
    }
}

@compute @workgroup_size(64)
fn fibers(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    garment = group.x;
    fiber = group.y + lane;
    bundle = bundles[group.w];
    links = 0u;
    while (links + 1u < bundle.count && fiber < rows[bundle.rows + links + 1u].y) {
        links += 1u;
    }
    let fresh = op.fresh != 0u;
    if (bundle.solver == GAUSS_SEIDEL) {
        sweep(fresh);
    } else if (bundle.solver == ZERO_STRETCH) {
        down(true, fresh);
        back(fresh);
        down(true, false);
        back(false);
        shorten();
    } else {
        down(false, fresh);
        back(fresh);
    }
}

// Most links of a fiber that a workgroup solves, and how many of them an invocation has.
const CYCLIC_MOST = 512u;
const CYCLIC_EACH = 8u;
const CYCLIC_STEPS = 9u;

// First the direction and the stretch of each link; then its row: minus the entries to the links above and below, diagonal,
// right-hand side; in the end its direction and its tension.
var<workgroup> system: array<vec4<f32>, CYCLIC_MOST>;

// A row that is not there: no entry beside the diagonal, and no right-hand side.
fn row_of(link: i32) -> vec4<f32> {
    if (link < 0 || link >= i32(links)) {
        return vec4<f32>(0.0, 0.0, 1.0, 0.0);
    }
    return system[u32(link)];
}

// The motion of row `link + 1`, or of the first row for -1, of a system that is solved.
fn shift_of(link: i32) {
    let row = u32(link + 1);
    var below = vec3<f32>(0.0);
    var holds_below = 0.0;
    if (row < links) {
        let next = system[row];
        below = next.xyz * next.w;
        holds_below = more_of(next.w, -next.w) / more_of(measure(row).x, NO_PIVOT);
    }
    let w = weight(row);
    let at = particle(row);
    if (link < 0) {
        put(at, place(at) + limited(below * w, measure(0u).x * FARTHEST));
        return;
    }
    let own = system[u32(link)];
    let rest = measure(u32(link)).x;
    var by = (below - own.xyz * own.w) * w;
    if ((garments[garment].bits & TAUT) != 0u) {
        let holds = more_of(own.w, -own.w) / more_of(rest, NO_PIVOT);
        by = calmed(by, own.xyz, w * (holds_below + holds));
    }
    put(at, place(at) + limited(by, rest * FARTHEST));
}

// The same system by parallel cyclic reduction (Hockney and Jesshope 1981; Zhang, Cohen, Owens 2010): in each step a row
// loses its neighbours for those twice as far away, until it has none. The rounding is not that of the reference.
@compute @workgroup_size(64)
fn cyclic(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    garment = group.x;
    fiber = group.y;
    bundle = bundles[group.w];
    links = 0u;
    while (links + 1u < bundle.count && fiber < rows[bundle.rows + links + 1u].y) {
        links += 1u;
    }
    let fresh = op.fresh != 0u;
    let gamma = garments[garment].gamma;
    let per_dt2 = garments[garment].per_dt2;
    let soften = gamma > 0.0 || (garments[garment].bits & SOFT_FIBERS) != 0u;
    for (var k = 0u; k < CYCLIC_EACH; k += 1u) {
        let link = k * 64u + lane;
        if (link < links) {
            let a = particle(link);
            let b = particle(link + 1u);
            let d = place(b) - place(a);
            let length2 = inner(d, d);
            let inverse = reciprocal_root(length2);
            let normal = d * inverse;
            let m = measure(link);
            var stretch = length2 * inverse - m.x;
            if (soften) {
                let moved = (place(b) - previous(b)) - (place(a) - previous(a));
                stretch = stretch + gamma * inner(normal, moved) - tension(link, fresh) * (m.y * per_dt2);
            }
            system[link] = vec4<f32>(normal, stretch);
        }
    }
    workgroupBarrier();
    // The normals stay with the invocation, for the pulls.
    var normals: array<vec3<f32>, CYCLIC_EACH>;
    var own: array<vec4<f32>, CYCLIC_EACH>;
    var least: array<f32, CYCLIC_EACH>;
    for (var k = 0u; k < CYCLIC_EACH; k += 1u) {
        let link = k * 64u + lane;
        own[k] = vec4<f32>(0.0, 0.0, 1.0, 0.0);
        if (link < links) {
            let w = weight(link);
            let w_b = weight(link + 1u);
            normals[k] = system[link].xyz;
            let more = select(1.0, 1.0 + gamma, soften);
            let diagonal = (w + w_b) * more + measure(link).y * per_dt2;
            least[k] = more_of(diagonal * LEAST_PIVOT, NO_PIVOT);
            var above = 0.0;
            var below = 0.0;
            if (link > 0u) {
                above = w * more * inner(system[link].xyz, system[link - 1u].xyz);
            }
            if (link + 1u < links) {
                below = w_b * more * inner(system[link].xyz, system[link + 1u].xyz);
            }
            own[k] = vec4<f32>(above, below, more_of(diagonal, NO_PIVOT), system[link].w);
        }
    }
    for (var turn = 0u; turn < CYCLIC_STEPS; turn += 1u) {
        workgroupBarrier();
        for (var k = 0u; k < CYCLIC_EACH; k += 1u) {
            system[k * 64u + lane] = own[k];
        }
        workgroupBarrier();
        let stride = i32(1u << turn);
        for (var k = 0u; k < CYCLIC_EACH; k += 1u) {
            let link = i32(k * 64u + lane);
            let up = row_of(link - stride);
            let down = row_of(link + stride);
            let by_up = own[k].x / up.z;
            let by_down = own[k].y / down.z;
            let diagonal = own[k].z - by_up * up.y - by_down * down.x;
            let side = own[k].w + by_up * up.w + by_down * down.w;
            own[k] = vec4<f32>(by_up * up.x, by_down * down.y, more_of(diagonal, least[k]), side);
        }
    }
    workgroupBarrier();
    for (var k = 0u; k < CYCLIC_EACH; k += 1u) {
        let link = k * 64u + lane;
        if (link < links) {
            let lambda = own[k].w / own[k].z;
            count(link, lambda, fresh);
            system[link] = vec4<f32>(normals[k], lambda);
        }
    }
    // All places have been read.
    storageBarrier();
    workgroupBarrier();
    for (var k = 0u; k < CYCLIC_EACH; k += 1u) {
        let link = i32(k * 64u + lane);
        if (link < i32(links)) {
            shift_of(link);
        }
    }
    if (lane == 0u && links > 0u) {
        shift_of(-1);
    }
}
