// Light, materials and tone: the same arithmetic as the ray tracer's lighting, shading and tone_mapping.

@group(1) @binding(0) var depths: texture_depth_2d;
@group(1) @binding(1) var nearest: sampler;

const SKIN = 0.0;
const CLOTH = 1.0;
const DIFFUSE = 2.0;

struct SurfacePoint {
    position: vec3<f32>,
    // Faces the eye.
    normal: vec3<f32>,
    colour: vec3<f32>,
    kind: f32,
    // Strength of cloth's sheen.
    sheen: f32,
    eye: vec3<f32>,
    // A turn of each pixel's own (rad).
    grain: f32,
}

const HALF_PI = 1.5707964;

// The turn that never comes back to where it was (rad).
const GOLDEN_TURN = 2.3999632;

fn fifth(x: f32) -> f32 {
    return x * x * x * x * x;
}

fn diffuse_colour(colour: vec3<f32>) -> vec3<f32> {
    return mix(colour, vec3(1.0), FRESNEL);
}

fn sheen_colour(colour: vec3<f32>) -> vec3<f32> {
    let peak = max(max(colour.x, colour.y), max(colour.z, 1e-3));
    return mix(vec3(1.0), colour / peak, SHEEN_TINT);
}

// Share of a lamp's light that is sent to the eye, the cosine included.
fn reflected(point: SurfacePoint, toward: vec3<f32>) -> vec3<f32> {
    let cosine = dot(point.normal, toward);
    if cosine <= 0.0 {
        return vec3(0.0);
    }
    let half = normalize(toward + point.eye);
    let grazing = fifth(1.0 - clamp(dot(toward, half), 0.0, 1.0));
    if point.kind == SKIN {
        let fresnel = FRESNEL + (1.0 - FRESNEL) * grazing;
        let lobe = (GLOSS + 8.0) / 8.0 * pow(max(dot(point.normal, half), 1e-6), GLOSS);
        return (point.colour * (1.0 - fresnel) + fresnel * lobe) * cosine;
    }
    let sheen = sheen_colour(point.colour) * (point.sheen * grazing);
    return (diffuse_colour(point.colour) + sheen) * cosine;
}

// Ambient light that comes from around a direction.
fn ambient(normal: vec3<f32>) -> vec3<f32> {
    let facing = 0.5 + 0.5 * dot(normal, frame.fill_toward.xyz);
    return mix(frame.ground.xyz, frame.sky.xyz, 0.5 + 0.5 * normal.y) + frame.fill.xyz * (facing * facing);
}

// Ambient light sent to the eye.
fn ambient_reflection(point: SurfacePoint) -> vec3<f32> {
    let around = ambient(point.normal);
    let grazing = fifth(1.0 - clamp(dot(point.normal, point.eye), 0.0, 1.0));
    if point.kind == SKIN {
        let fresnel = FRESNEL + 0.3 * grazing;
        let mirrored = ambient(reflect(-point.eye, point.normal));
        return point.colour * around * (1.0 - fresnel) + mirrored * fresnel;
    }
    return mix(diffuse_colour(point.colour), sheen_colour(point.colour), point.sheen * grazing) * around;
}

// How much of one beam is stopped before a point: 0..1. What lies farther off than 1 / `fading` does not stop it, and
// what lies nearer stops the less of it the farther it is; 0 stops all.
fn occlusion(beam: u32, point: vec3<f32>, fading: f32) -> f32 {
    // Beyond the ball that the depth maps look at, nothing stops a beam; its tile would be a neighbour's.
    let toward = frame.beams[beam].toward.xyz;
    let arm = point - 0.5 * (frame.subject_min.xyz + frame.subject_max.xyz);
    let across = arm - toward * dot(arm, toward);
    let within = dot(across, across) < frame.shadow_map.z;
    let p = vec4(point, 1.0);
    let at = vec2(dot(frame.beams[beam].u, p), dot(frame.beams[beam].v, p)) * frame.size.zw - 0.5;
    let depth = dot(frame.beams[beam].depth, p);
    let corner = floor(at);
    let part = at - corner;
    let four = textureGather(depths, nearest, (corner + 1.0) / frame.size.zw);
    let behind = (vec4(depth) - four) * frame.shadow_map.x;
    // Where a map is empty nothing stops the beam, however far below the map the point is.
    let blocked = (behind > vec4(0.0)) & (four < vec4(1.0)) & vec4(within);
    let shade = select(vec4(0.0), clamp(1.0 - behind * fading, vec4(0.0), vec4(1.0)), blocked);
    // A gather's order: lower left, lower right, upper right, upper left, v down.
    return mix(mix(shade.w, shade.z, part.x), mix(shade.x, shade.y, part.x), part.y);
}

// Looks at a single beam.
const SOFT_LOOKS = 4u;

// Share of a lamp's light that arrives, where it is wanted. Drivers on the processor run both sides of every branch but no
// turn of a loop that no pixel of a block takes, so what need not be looked up is left out by the loops' bounds.
//
// A single beam is looked up on a turned square, so that its edge is soft, as wide everywhere (Reeves, Salesin and Cook
// 1987, "Rendering antialiased shadows with depth maps"). The beams of a disc are spread over the gaps between them, each
// pixel its own way, as far as the subject is from where its shadow falls: grain in point of streaks.
fn light_visibility(first: u32, count: u32, point: SurfacePoint, wanted: bool) -> f32 {
    let single = count == 1u;
    let looks = select(count, SOFT_LOOKS, single);
    let turns = select(0u, looks, wanted);
    let start = point.position + point.normal * frame.shadow_map.y;
    let arm = dot(0.5 * (frame.subject_min.xyz + frame.subject_max.xyz) - start, frame.beams[first].toward.xyz);
    let gap = frame.key.w * max(arm - 0.25 * frame.shadow_map.x, 0.0) / sqrt(f32(max(count, 1u)));
    let spread = select(gap, SOFTNESS * frame.shadow_map.w, single);
    let a = normalize(frame.beams[first].u.xyz) * spread;
    let b = normalize(frame.beams[first].v.xyz) * spread;
    var turn = select(point.grain, 0.38, single);
    let step = select(GOLDEN_TURN, HALF_PI, single);
    var dark = 0.0;
    for (var i = 0u; i < turns; i++) {
        turn += step;
        dark += occlusion(first + select(i, 0u, single), start + a * cos(turn) + b * sin(turn), 0.0);
    }
    return 1.0 - dark / f32(max(looks, 1u));
}

// Share of ambient light that arrives, where it is wanted.
fn ambient_visibility(point: SurfacePoint, wanted: bool) -> f32 {
    let first = u32(frame.counts.x + frame.counts.y);
    let last = first + select(0u, u32(frame.counts.z), wanted);
    let start = point.position + point.normal * (1.6 * frame.shadow_map.y);
    var dark = 0.0;
    var all = 1e-4;
    for (var i = first; i < last; i++) {
        let cosine = max(dot(point.normal, frame.beams[i].toward.xyz), 0.0);
        all += cosine;
        for (var look = select(1u, 0u, cosine > 0.02); look < 1u; look++) {
            dark += cosine * occlusion(i, start, 1.0 / frame.fill_toward.w);
        }
    }
    return 1.0 - dark / all;
}

// Light that a point on the subject sends to the eye; `opening` is the share of ambient light that arrives.
fn subject_light(point: SurfacePoint, opening: f32) -> vec3<f32> {
    let key_count = u32(frame.counts.x);
    let by_key = reflected(point, frame.key.xyz) * frame.key_colour.xyz;
    let by_rim = reflected(point, frame.rim.xyz) * frame.rim_colour.xyz;
    return by_key * light_visibility(0u, key_count, point, dot(by_key, by_key) > 0.0)
        + by_rim * light_visibility(key_count, u32(frame.counts.y), point, dot(by_rim, by_rim) > 0.0)
        + ambient_reflection(point) * mix(point.colour * BOUNCE, vec3(1.0), opening);
}

// Scene light to display light (Khronos PBR Neutral).
fn compress(scene: vec3<f32>) -> vec3<f32> {
    let low = min(scene.x, min(scene.y, scene.z));
    let offset = select(FRESNEL, low - low * low / (4.0 * FRESNEL), low < 2.0 * FRESNEL);
    let light = scene - offset;
    let peak = max(light.x, max(light.y, light.z));
    let shoulder = 0.8 - FRESNEL;
    if peak < shoulder {
        return light;
    }
    let rest = 1.0 - shoulder;
    let pressed = 1.0 - rest * rest / (peak + rest - shoulder);
    let grey = 1.0 - 1.0 / (DESATURATION * (peak - pressed) + 1.0);
    return mix(light * (pressed / peak), vec3(pressed), grey);
}

// The sRGB curve by roots, which cost a processor less than powers (Chilliant 2012, "sRGB approximations for HLSL"): within
// a quarter of a byte.
fn srgb(light: vec3<f32>) -> vec3<f32> {
    let x = clamp(light, vec3(0.0), vec3(1.0));
    let s1 = sqrt(x);
    let s2 = sqrt(s1);
    let s3 = sqrt(s2);
    let high = 0.662002687 * s1 + 0.684122060 * s2 - 0.323583601 * s3 - 0.0225411470 * x;
    return select(high, 12.92 * x, x <= vec3(0.0031308));
}

// An integer hash that mixes all bits (Wellons 2018, "Prospecting for hash functions").
fn hash(n: u32) -> u32 {
    var x = (n ^ (n >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// Noise of a pixel, 0..1.
fn noise(pixel: vec2<f32>) -> f32 {
    return f32(hash(u32(pixel.x) ^ hash(u32(pixel.y))) >> 8u) / 16777216.0;
}

// What the target takes, with half a byte of noise that hides the steps of the backdrop's gradient.
fn encode_output(display: vec3<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let bytes = srgb(display) + (noise(pixel) - 0.5) / 255.0;
    if ENCODE {
        return vec4(bytes, 1.0);
    }
    let x = clamp(bytes, vec3(0.0), vec3(1.0));
    return vec4(select(pow((x + 0.055) / 1.055, vec3(2.4)), x / 12.92, x <= vec3(0.04045)), 1.0);
}
