// Body and garments.

struct Surface {
    // Base colour; w: kind of material.
    colour: vec4<f32>,
    // Strength of the sheen; repeats of the weave a metre, along weft and warp; 1 where the fit map is shown.
    cloth: vec4<f32>,
    // 1 where there is a print; 1 where seams and hems are known; share of light that is held back; number of the surface.
    look: vec4<f32>,
    trims: array<Trim, MAX_TRIMS>,
}

@group(2) @binding(0) var<uniform> surface: Surface;
@group(2) @binding(1) var weave: texture_2d<f32>;
@group(2) @binding(2) var repeated: sampler;
@group(2) @binding(3) var tile: texture_2d<f32>;
// Of the surface's own vertices: a vertex that lies in several places of the print is drawn once for each.
@group(3) @binding(0) var<storage, read> positions: array<vec4<f32>>;
@group(3) @binding(1) var<storage, read> normals: array<vec4<f32>>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) rest: vec3<f32>,
    @location(3) rest_normal: vec3<f32>,
    @location(4) fit: f32,
    @location(5) opening: f32,
    // The point of the print, v upwards; how far from the nearest hem and seam (m).
    @location(6) point: vec2<f32>,
    @location(7) edges: vec2<f32>,
    // The trims that the triangle may show, a bit for each.
    @location(8) @interpolate(flat) near: u32,
}

@vertex
fn vertex_main(
    @builtin(instance_index) first: u32,
    @location(0) source: u32,
    @location(1) point: vec2<f32>,
    @location(2) edges: vec2<f32>,
    // The fit, -1 loose .. 1 tight; how much farther off it counts as than it is (m).
    @location(3) marks: vec2<f32>,
    @location(4) rest: vec3<f32>,
    @location(5) rest_normal: vec3<f32>,
    @location(6) near: u32,
) -> Varying {
    let position = positions[first + source].xyz;
    let normal = normals[first + source].xyz;
    var out: Varying;
    out.point = point;
    out.edges = edges;
    out.near = near;
    out.clip = frame.clip * vec4(position, 1.0);
    // Farther along the line of sight: the same point in the picture, another depth.
    let sight = normalize(position - frame.eye.xyz);
    let recessed = frame.clip * vec4(position + sight * marks.y, 1.0);
    out.clip.z = recessed.z / recessed.w * out.clip.w;
    out.position = position;
    out.normal = normal;
    out.rest = rest;
    out.rest_normal = rest_normal;
    out.fit = marks.x;
    out.opening = 1.0;
    if BY_VERTEX {
        var lit: SurfacePoint;
        lit.position = position;
        lit.normal = normal * select(1.0, -1.0, dot(normal, sight) > 0.0);
        out.opening = ambient_visibility(lit, true);
    }
    return out;
}

// The fit map's colour; mid grey for NaN.
fn fit_colour(fit: f32) -> vec3<f32> {
    // NaN is sent as a value far below the range.
    if fit < -8.0 {
        return vec3(0.2158605);
    }
    let step = u32(clamp((fit + 1.0) * 4.0, 0.0, 7.0));
    var steps = FIT_STEPS;
    return steps[step];
}

struct WeaveRelief {
    // Rise of the surface along the picture's x and y (m a pixel).
    rise: vec2<f32>,
    open: f32,
}

// The threads seen from one side of the rest shape.
fn threads(at: vec2<f32>, dx: vec2<f32>, dy: vec2<f32>, weight: f32) -> WeaveRelief {
    let scale = surface.cloth.yz;
    let texel = textureSampleGrad(weave, repeated, at * scale, dx * scale, dy * scale);
    let slope = (texel.xy * 255.0 - 128.0) / 127.0 * STEEPEST;
    return WeaveRelief(vec2(dot(slope, dx), dot(slope, dy)) * weight, texel.z * weight);
}

// The normal bent by the threads (Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU"), and how open to
// light the point between them is.
fn woven(v: Varying, normal: vec3<f32>) -> vec4<f32> {
    let px = dpdx(v.position);
    let py = dpdy(v.position);
    let rx = dpdx(v.rest);
    let ry = dpdy(v.rest);
    var weights = pow(abs(normalize(v.rest_normal + vec3(0.0, 0.0, 1e-4))), vec3(6.0));
    weights /= weights.x + weights.y + weights.z;
    let front = threads(v.rest.xy, rx.xy, ry.xy, weights.z);
    let side = threads(v.rest.zy, rx.zy, ry.zy, weights.x);
    let top = threads(v.rest.xz, rx.xz, ry.xz, weights.y);
    let rise = front.rise + side.rise + top.rise;
    let r1 = cross(py, normal);
    let r2 = cross(normal, px);
    let det = dot(px, r1);
    let bent = abs(det) * normal - sign(det) * (rise.x * r1 + rise.y * r2);
    let whole = select(normal, normalize(bent), dot(bent, bent) > 1e-30);
    return vec4(whole, front.open + side.open + top.open);
}

// The colour with the print on it, the grooves of seams and the stitches of hems.
fn cloth_colour(v: Varying, base: vec3<f32>) -> vec3<f32> {
    var colour = base;
    if surface.look.x > 0.5 {
        // Pictures have their first row at the top.
        let texel = textureSample(tile, repeated, vec2(v.point.x, 1.0 - v.point.y));
        colour = mix(colour, texel.xyz, texel.w);
    }
    if surface.look.y > 0.5 {
        let pixel = max(length(dpdx(v.position)), 1e-6);
        let seam = 1.0 - SEAM_DARK * line(v.edges.y, SEAM_HALF, pixel);
        let hem = 1.0 - STITCH_DARK * line(abs(v.edges.x - HEM), STITCH_HALF, pixel);
        var covered = 0.0;
        for (var left = v.near; left != 0u; left &= left - 1u) {
            covered = max(covered, trim_cover(surface.trims[firstTrailingBit(left)], v.rest.xy, pixel));
        }
        colour *= mix(seam * hem, 1.0, covered);
        for (var left = v.near; left != 0u; left &= left - 1u) {
            colour = with_trim(surface.trims[firstTrailingBit(left)], v.rest.xy, pixel, colour);
        }
    }
    return colour;
}

@fragment
fn fragment_main(v: Varying, @builtin(front_facing) outside: bool) -> @location(0) vec4<f32> {
    // Between the threads of sheer cloth what lies behind is seen; each layer has gaps of its own.
    if surface.look.z < 1.0 && noise(v.clip.xy + 37.0 * surface.look.w) > surface.look.z && surface.cloth.w < 0.5 {
        discard;
    }
    let eye = normalize(frame.eye.xyz - v.position);
    let flat = cross(dpdx(v.position), dpdy(v.position));
    // The normal of the triangle towards the eye, for vertices without one.
    let facet = flat * select(1.0, -1.0, dot(flat, eye) < 0.0);
    var normal = v.normal * select(-1.0, 1.0, outside);
    normal = normalize(select(facet, normal, dot(normal, normal) > 1e-6));
    var point: SurfacePoint;
    point.position = v.position;
    point.colour = cloth_colour(v, surface.colour.xyz);
    point.kind = surface.colour.w;
    point.sheen = surface.cloth.x;
    point.eye = eye;
    point.grain = 4.0 * HALF_PI * noise(v.clip.yx);
    if WEAVE && surface.cloth.y > 0.0 {
        let bent = woven(v, normal);
        normal = bent.xyz;
        point.colour *= bent.w;
    }
    // Interpolated normals may turn away at the outline.
    let missing = max(frame.forward.w - dot(normal, eye), 0.0);
    point.normal = normalize(normal + eye * missing);
    if surface.cloth.w > 0.5 {
        point.colour = fit_colour(v.fit);
        point.kind = DIFFUSE;
        point.sheen = 0.0;
    }
    var opening = v.opening;
    if !BY_VERTEX {
        opening = ambient_visibility(point, true);
    }
    return encode_output(compress(subject_light(point, opening)), v.clip.xy);
}
