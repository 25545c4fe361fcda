// Lists: fibers by index list, hoops among them, each solved directly (tridiagonal), one invocation a fiber.
// CPU reference: `cloth/links/lists.rs`.
//
// In a hoop the first link shares a particle with the last: the last tension is bordered, and found first on the way back.
// An open fiber is a hoop whose corner is 0.

struct Head {
    // Where its indices begin; how far apart the rows are; rows; 1 where it closes, 2 where it must not lengthen.
    index: u32,
    apart: u32,
    rows: u32,
    bits: u32,
    // Where its measures begin, and what is kept of it.
    at: u32,
    slot: u32,
    spare: vec2<u32>,
}

@group(1) @binding(0) var<storage, read> heads: array<Head>;
@group(1) @binding(1) var<storage, read> index: array<u32>;
// Rest length (m) and compliance (m/N).
@group(1) @binding(2) var<storage, read> measures: array<vec2<f32>>;
// Three a row: direction and right-hand side; factor, last column; tension so far in the substep.
@group(1) @binding(3) var<storage, read_write> kept: array<vec4<f32>>;

const ENDED = 1e20;
const CLOSED = 1u;
const ZERO_STRETCH = 2u;
const PASSES = 3u;

var<private> head: Head;
var<private> garment: u32;

fn particle(row: u32) -> u32 {
    return index[head.index + row * head.apart];
}

fn weight(row: u32) -> f32 {
    return state[particle(row)].w;
}

fn measure(link: u32) -> vec2<f32> {
    return measures[head.at + link * head.apart];
}

fn slot(row: u32) -> u32 {
    return 3u * (head.slot + row * head.apart);
}

fn after(row: u32) -> u32 {
    return select(row + 1u, 0u, row + 1u == head.rows);
}

fn remembers() -> bool {
    return (garments[garment].bits & SOFT_CROSSING) != 0u;
}

fn tension(link: u32, fresh: bool) -> f32 {
    if (fresh) {
        return 0.0;
    }
    return kept[slot(link) + 2u].x;
}

fn count(link: u32, by: f32, fresh: bool) {
    if (remembers()) {
        kept[slot(link) + 2u].x = tension(link, fresh) + by;
    }
}

fn normals(links: u32, zero: bool, fresh: bool) {
    let per_dt2 = garments[garment].per_dt2;
    var p = place(particle(0u));
    for (var link = 0u; link < links; link += 1u) {
        let q = place(particle(after(link)));
        let d = q - p;
        let length2 = inner(d, d);
        let inverse = reciprocal_root(length2);
        let m = measure(link);
        var stretch = length2 * inverse - m.x;
        if (remembers() && !zero) {
            let soft = m.y * per_dt2;
            stretch = stretch - tension(link, fresh) * soft;
        }
        if (zero) {
            stretch = more_of(stretch, 0.0);
        }
        kept[slot(link)] = vec4<f32>(d * inverse, stretch);
        p = q;
    }
}

fn diagonal(link: u32, zero: bool) -> f32 {
    var soft = measure(link).y;
    if (zero) {
        soft = select(0.0, soft, 0.1 * ENDED < soft);
    } else {
        soft = soft * garments[garment].per_dt2;
    }
    return weight(link) + weight(after(link)) + soft;
}

fn beside(link: u32, before: u32) -> f32 {
    return weight(link) * inner(kept[slot(link)].xyz, kept[slot(before)].xyz);
}

// L D L^T with the last tension bordered; gives that tension.
fn eliminate(links: u32, zero: bool) -> f32 {
    let end = links - 1u;
    var last = 0.0;
    if ((head.bits & CLOSED) != 0u && end > 0u) {
        last = beside(0u, end);
    }
    let full = diagonal(end, zero);
    var corner = full;
    var side = kept[slot(end)].w;
    var pivot = 0.0;
    var y = 0.0;
    for (var link = 0u; link < end; link += 1u) {
        var b = 0.0;
        if (link > 0u) {
            b = beside(link, link - 1u);
        }
        let factor = b * pivot;
        let whole = diagonal(link, zero);
        let left = more_of(more_of(whole - factor * b, whole * LEAST_PIVOT), NO_PIVOT);
        pivot = 1.0 / left;
        y = kept[slot(link)].w + factor * y;
        if (link > 0u) {
            last = factor * last;
        }
        if (link + 1u == end) {
            last = last + beside(end, link);
        }
        let share = last * pivot;
        corner = corner - share * last;
        side = side + share * y;
        kept[slot(link) + 1u] = vec4<f32>(factor, share, 0.0, 0.0);
        kept[slot(link)].w = y * pivot;
    }
    return side / more_of(more_of(corner, full * LEAST_PIVOT), NO_PIVOT);
}

// Moves a row by `pull` times its weight.
fn shift(row: u32, pull: vec3<f32>, link: u32) {
    let i = particle(row);
    put(i, place(i) + limited(pull * weight(row), measure(link).x * FARTHEST));
}

fn move_back(links: u32, last: f32, fresh: bool) {
    let end = links - 1u;
    let closed = (head.bits & CLOSED) != 0u;
    count(end, last, fresh);
    let outer = kept[slot(end)].xyz * last;
    var below = outer;
    if (!closed) {
        shift(head.rows - 1u, vec3<f32>(0.0) - outer, end);
    }
    var lambda = 0.0;
    var factor = 0.0;
    for (var up = end; up > 0u; up -= 1u) {
        let link = up - 1u;
        let own = kept[slot(link)];
        let more = kept[slot(link) + 1u];
        lambda = own.w + more.y * last + factor * lambda;
        factor = more.x;
        count(link, lambda, fresh);
        let pull = own.xyz * lambda;
        shift(link + 1u, below - pull, link);
        below = pull;
    }
    if (closed) {
        below = below - outer;
    }
    shift(0u, below, 0u);
}

@compute @workgroup_size(64)
fn lists(@builtin(workgroup_id) at: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let group = groups[op.first + at.x];
    if (lane >= group.z) {
        return;
    }
    garment = group.x;
    head = heads[group.y + lane];
    let zero = (head.bits & ZERO_STRETCH) != 0u;
    let links = select(head.rows - 1u, head.rows, (head.bits & CLOSED) != 0u);
    var passes = 1u;
    if (zero) {
        passes = PASSES;
    }
    for (var turn = 0u; turn < passes; turn += 1u) {
        let fresh = op.fresh != 0u && turn == 0u;
        normals(links, zero, fresh);
        move_back(links, eliminate(links, zero), fresh);
    }
}
