// The backdrop: a floor that curves up into a wall, or a picture that the subject's shadow falls on.

@group(2) @binding(0) var behind: texture_2d<f32>;
@group(2) @binding(1) var linear: sampler;

struct Ray {
    @builtin(position) clip: vec4<f32>,
    // -1..1 across the picture, y up.
    @location(0) at: vec2<f32>,
}

// One triangle that covers the view, as far off as can be.
@vertex
fn vertex_main(@builtin(vertex_index) number: u32) -> Ray {
    let at = vec2(f32(number & 1u) * 4.0 - 1.0, f32(number >> 1u) * 4.0 - 1.0);
    return Ray(vec4(at, 1.0, 1.0), at);
}

// Where a ray meets the backdrop: distance, and the normal that faces into the room.
fn meet(origin: vec3<f32>, direction: vec3<f32>) -> vec4<f32> {
    let depth = frame.backdrop_away.w;
    let radius = frame.backdrop_colour.w;
    let away = frame.backdrop_away.xyz;
    let w = dot(origin - frame.backdrop_centre.xyz, away);
    let dw = dot(direction, away);
    let dy = direction.y;
    let down = -origin.y / dy;
    if dy < 0.0 && down > 0.0 && w + down * dw <= depth {
        return vec4(0.0, 1.0, 0.0, down);
    }
    let c = vec2(w - depth, origin.y - radius);
    let d = vec2(dw, dy);
    let a = dot(d, d);
    let b = dot(c, d);
    let root = b * b - a * (dot(c, c) - radius * radius);
    let curve = (sqrt(max(root, 0.0)) - b) / a;
    let met = c + curve * d;
    if root >= 0.0 && curve > 0.0 && met.x >= 0.0 && met.y <= 0.0 {
        return vec4((-away * met.x - vec3(0.0, met.y, 0.0)) / radius, curve);
    }
    let wall = (depth + radius - w) / dw;
    return vec4(-away, select(1e3 * frame.backdrop_centre.w, wall, dw > 0.0 && wall > 0.0));
}

// True for a point that no shadow of the subject can touch.
fn clear(point: vec3<f32>) -> bool {
    if frame.subject_max.w < 0.5 {
        return true;
    }
    let least = frame.subject_min.xyz - point;
    let most = frame.subject_max.xyz - point;
    let breadth = frame.key.w * length(max(abs(least), abs(most)));
    let inverse = 1.0 / frame.key.xyz;
    let a = (least - breadth) * inverse;
    let b = (most + breadth) * inverse;
    let enter = min(a, b);
    let leave = max(a, b);
    let shaded = max(max(enter.x, max(enter.y, enter.z)), 0.0) <= min(leave.x, min(leave.y, leave.z));
    let gap = length(max(max(least, -most), vec3(0.0)));
    return !shaded && gap > frame.fill_toward.w;
}

fn pool(point: vec3<f32>) -> f32 {
    let offset = point - frame.backdrop_centre.xyz - vec3(0.0, 0.5 * frame.backdrop_centre.w, 0.0);
    let level = offset - frame.backdrop_away.xyz * dot(offset, frame.backdrop_away.xyz);
    let far = (dot(level, level) + 0.15 * dot(offset, offset)) / (frame.subject_min.w * frame.subject_min.w);
    return 1.0 / (1.0 + far);
}

@fragment
fn fragment_main(ray: Ray) -> @location(0) vec4<f32> {
    let direction = normalize(frame.forward.xyz + frame.right.xyz * ray.at.x + frame.up.xyz * ray.at.y);
    let met = meet(frame.eye.xyz, direction);
    var point: SurfacePoint;
    point.position = frame.eye.xyz + direction * met.w;
    point.normal = met.xyz;
    point.colour = frame.backdrop_colour.xyz;
    point.kind = DIFFUSE;
    point.sheen = 0.0;
    point.eye = -direction;
    point.grain = 4.0 * HALF_PI * noise(ray.clip.yx);
    // The backdrop stands out of the rim lamp's beam.
    let by_key = reflected(point, frame.key.xyz) * frame.key_colour.xyz;
    let around = ambient_reflection(point);
    let shaded = !clear(point.position);
    let light = by_key * light_visibility(0u, u32(frame.counts.x), point, shaded)
        + around * mix(point.colour * BOUNCE, vec3(1.0), ambient_visibility(point, shaded));
    if frame.picture.z > 0.5 {
        let at = ray.at * vec2(0.5, -0.5) * frame.picture.xy + 0.5;
        let seen = textureSampleLevel(behind, linear, at, 0.0).xyz;
        // Only the floor takes a shadow: the distance of the picture's walls is unknown.
        let dimmed = select(vec3(1.0), light / (by_key + around), met.y > 0.999);
        return encode_output(seen * dimmed, ray.clip.xy);
    }
    return encode_output(compress(light * pool(point.position)), ray.clip.xy);
}
