// The depth maps of all beams in one pass: an instance for each, placed on its tile. The tiles hold the whole subject,
// so nothing spills into a neighbour's.

@vertex
fn project(@location(0) position: vec3<f32>, @builtin(instance_index) number: u32) -> @builtin(position) vec4<f32> {
    let place = vec4(position, 1.0);
    let u = dot(frame.beams[number].u, place);
    let v = dot(frame.beams[number].v, place);
    return vec4(2.0 * u - 1.0, 1.0 - 2.0 * v, dot(frame.beams[number].depth, place), 1.0);
}
