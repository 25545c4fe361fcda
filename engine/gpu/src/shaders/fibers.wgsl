// Fibers: the tridiagonal system of each fiber's tensions, a fiber an invocation. Twin of `cloth/fibers.rs`.
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
