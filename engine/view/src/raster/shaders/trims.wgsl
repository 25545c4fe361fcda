// What is put on cloth: buttons, stitches, edges, strips, zips; as trim_look.rs has it.

struct Trim {
    // Its ends on the cloth (m).
    ends: vec4<f32>,
    // Half of its width (m); its kind.
    shape: vec4<f32>,
    colour: vec4<f32>,
}

const BUTTON = 0u;
const STITCHES = 1u;
const EDGE = 2u;
const STRIP = 3u;

// How much of a line of this half width a pixel so wide sees at a distance (m).
fn line(distance: f32, half: f32, pixel: f32) -> f32 {
    let seen = clamp((half + 0.5 * pixel - distance) / pixel, 0.0, 1.0);
    return seen * min(2.0 * half / pixel, 1.0);
}

fn inside_of(distance: f32, reach: f32, pixel: f32) -> f32 {
    return clamp((reach - distance) / pixel + 0.5, 0.0, 1.0);
}

// A direction, or up where there is none.
fn direction(v: vec2<f32>) -> vec2<f32> {
    let length_squared = dot(v, v);
    return select(vec2(0.0, 1.0), v * inverseSqrt(max(length_squared, 1e-20)), length_squared > 1e-18);
}

// Distance from a trim, and on which side: positive is to the left of its way.
fn beside(trim: Trim, at: vec2<f32>) -> vec2<f32> {
    let along = trim.ends.zw - trim.ends.xy;
    let off = at - trim.ends.xy;
    let t = clamp(dot(off, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    return vec2(distance(at, trim.ends.xy + along * t), along.x * off.y - along.y * off.x);
}

// How much of the seams beneath it a trim hides.
fn trim_cover(trim: Trim, at: vec2<f32>, pixel: f32) -> f32 {
    let side = beside(trim, at);
    let kind = u32(trim.shape.y);
    let hides = kind >= STRIP || (kind == EDGE && side.y > 0.0);
    return select(0.0, inside_of(side.x, trim.shape.x, pixel), hides);
}

fn shadow(far: f32) -> f32 {
    return 1.0 - SHADOW_DARK * clamp(1.0 - far / TRIM_SHADOW, 0.0, 1.0);
}

fn button(trim: Trim, at: vec2<f32>, pixel: f32, colour: vec3<f32>) -> vec3<f32> {
    let radius = trim.shape.x;
    let along = direction(trim.ends.zw - trim.ends.xy);
    let off = at - trim.ends.xy;
    let far = length(off);
    let below = max(length(off + along * 0.25 * radius) - radius, 0.0);
    let beneath = colour * (1.0 - SHADOW_DARK * 1.6 * clamp(1.0 - below / (0.5 * radius), 0.0, 1.0));
    let up = dot(off, along) / max(radius, 1e-6);
    var face = trim.colour.xyz * (0.92 + 0.16 * up);
    face *= 1.0 - RIM_DARK * line(abs(far - (1.0 - RIM) * radius), 0.1 * radius, pixel);
    let own = abs(vec2(dot(off, vec2(-along.y, along.x)), dot(off, along)));
    let hole = distance(own, vec2(HOLE_AWAY * radius));
    face *= 1.0 - HOLE_DARK * inside_of(hole, HOLE * radius, pixel) * min(2.0 * HOLE * radius / pixel, 1.0);
    return mix(beneath, face, inside_of(far, radius, pixel));
}

fn zip(trim: Trim, at: vec2<f32>, pixel: f32, distance: f32, colour: vec3<f32>) -> vec3<f32> {
    let tape = colour * (1.0 - EDGE_DARK * line(abs(distance - trim.shape.x), EDGE_HALF, pixel));
    let along = direction(trim.ends.zw - trim.ends.xy);
    let place = dot(at - trim.ends.xy, along) / TOOTH;
    let tooth = select(0.35, 1.0, fract(place) < 0.6);
    let seen = mix(tooth, 0.75, min(pixel / TOOTH, 1.0));
    return mix(tape, trim.colour.xyz * seen, inside_of(distance, min(TEETH_HALF, trim.shape.x), pixel));
}

// The colour with a trim on it.
fn with_trim(trim: Trim, at: vec2<f32>, pixel: f32, colour: vec3<f32>) -> vec3<f32> {
    let side = beside(trim, at);
    let far = side.x;
    let half = trim.shape.x;
    switch u32(trim.shape.y) {
        case BUTTON: {
            return button(trim, at, pixel, colour);
        }
        case STITCHES: {
            return colour * (1.0 - TRIM_STITCH_DARK * line(far, half, pixel));
        }
        case EDGE: {
            let beneath = select(shadow(far), 1.0, side.y > 0.0);
            return colour * beneath * (1.0 - EDGE_DARK * line(far, EDGE_HALF, pixel));
        }
        case STRIP: {
            let beneath = select(shadow(far - half), 1.0, far < half);
            let sewn = line(abs(half - STRIP_STITCH - far), TRIM_STITCH_HALF, pixel);
            let edged = 1.0 - EDGE_DARK * line(abs(far - half), EDGE_HALF, pixel);
            return colour * beneath * edged * (1.0 - 0.6 * TRIM_STITCH_DARK * sewn);
        }
        default: {
            return zip(trim, at, pixel, far, colour);
        }
    }
}
