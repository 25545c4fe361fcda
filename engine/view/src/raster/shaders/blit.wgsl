// Brings a finished picture onto its part of the target, texel for pixel.

@group(0) @binding(0) var finished: texture_2d<f32>;

struct BlitVarying {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec2<f32>,
}

@vertex
fn vertex_main(@builtin(vertex_index) number: u32) -> BlitVarying {
    let at = vec2(f32(number & 1u) * 4.0 - 1.0, f32(number >> 1u) * 4.0 - 1.0);
    return BlitVarying(vec4(at, 0.0, 1.0), at * vec2(0.5, -0.5) + 0.5);
}

@fragment
fn fragment_main(v: BlitVarying) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(finished));
    return textureLoad(finished, vec2<i32>(clamp(v.at, vec2(0.0), vec2(0.9999)) * size), 0);
}
