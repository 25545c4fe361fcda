// The depth maps of all beams in one pass: an instance for each, placed on its tile. The tiles hold the whole subject,
// so nothing spills into a neighbour's.

@vertex
fn vertex_main(@location(0) position: vec3<f32>, @builtin(instance_index) number: u32) -> @builtin(position) vec4<f32> {
    let point = vec4(position, 1.0);
    let u = dot(frame.beams[number].u, point);
    let v = dot(frame.beams[number].v, point);
    return vec4(2.0 * u - 1.0, 1.0 - 2.0 * v, dot(frame.beams[number].depth, point), 1.0);
}
