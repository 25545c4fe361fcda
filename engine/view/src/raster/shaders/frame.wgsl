// What one view is drawn with: `view_uniforms.rs` writes the same fields in the same order.

struct Beam {
    // Position in the depth maps' texture, 0..1: dot with (p, 1).
    u: vec4<f32>,
    v: vec4<f32>,
    // Depth in the map, 0 nearest to the light .. 1.
    depth: vec4<f32>,
    toward: vec4<f32>,
}

struct Frame {
    clip: mat4x4<f32>,
    // w: distance of the eye from the target.
    eye: vec4<f32>,
    // w: least cosine between a shading normal and the eye.
    forward: vec4<f32>,
    // Half of the picture's width and height at distance one.
    right: vec4<f32>,
    up: vec4<f32>,
    // w: tangent of the lamp's apparent radius.
    key: vec4<f32>,
    key_colour: vec4<f32>,
    rim: vec4<f32>,
    rim_colour: vec4<f32>,
    sky: vec4<f32>,
    ground: vec4<f32>,
    fill: vec4<f32>,
    // w: reach of ambient occlusion (m).
    fill_toward: vec4<f32>,
    // w: the subject's height (m).
    backdrop_centre: vec4<f32>,
    // w: where the backdrop begins to curve (m).
    backdrop_away: vec4<f32>,
    // w: the backdrop's radius (m).
    backdrop_colour: vec4<f32>,
    // w: where the pool of light has fallen to half (m).
    subject_min: vec4<f32>,
    // w: 1 where there is a subject.
    subject_max: vec4<f32>,
    // Beams of the key lamp, of the rim lamp, of the sky.
    counts: vec4<f32>,
    // Scale of the picture behind; 1 where there is one.
    picture: vec4<f32>,
    // Width and height (pixels), of the depth maps' texture (texels).
    size: vec4<f32>,
    // Width of the depth maps (m), gap to a surface (m), square of how far from the middle they reach (m2),
    // a texel (m).
    shadow_map: vec4<f32>,
    beams: array<Beam, MOST_BEAMS>,
}

@group(0) @binding(0) var<uniform> frame: Frame;
