// Lines: a quad for each, so many pixels wide for every driver.

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) colour: vec3<f32>,
}

@vertex
fn vertex_main(
    @location(0) start: vec3<f32>,
    @location(1) end: vec3<f32>,
    @location(2) colour: vec3<f32>,
    @builtin(vertex_index) corner: u32,
) -> Varying {
    let from_end = frame.clip * vec4(start, 1.0);
    let to_end = frame.clip * vec4(end, 1.0);
    let half = 0.5 * frame.size.xy;
    let run = (to_end.xy / max(to_end.w, 1e-4) - from_end.xy / max(from_end.w, 1e-4)) * half;
    let along = select(vec2(1.0, 0.0), normalize(run), dot(run, run) > 1e-12);
    let across = vec2(-along.y, along.x) * LINE_HALF_WIDTH / half;
    var here = select(from_end, to_end, corner > 1u);
    // A line before the lens is not drawn at all.
    if min(from_end.w, to_end.w) < 1e-3 {
        here = vec4(2.0, 2.0, 2.0, 1.0);
    }
    here = vec4(here.xy + across * select(-1.0, 1.0, (corner & 1u) == 1u) * here.w, here.zw);
    // A little nearer, so that a line on a surface is not half in it.
    here.z -= 2e-4 * here.w;
    return Varying(here, colour);
}

@fragment
fn shown(v: Varying) -> @location(0) vec4<f32> {
    return encode_output(v.colour, v.clip.xy);
}

// What lies behind a surface shines through a little.
@fragment
fn hidden(v: Varying) -> @location(0) vec4<f32> {
    return vec4(encode_output(v.colour, v.clip.xy).xyz, 0.22);
}
