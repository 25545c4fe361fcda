// What every shader begins with: the functions that the CPU's lanes have.
//
// Sums of products are written out in the CPU's order. Nothing here asks for a fused multiply-add; a driver may still
// make one (WGSL allows it), and then a result is within a bound instead of bit for bit: docs/gpu.md.

// Inner product, summed from x to z.
fn inner(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Cross product, written out in the CPU's order.
fn cross_product(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// a > b ? a : b, as the lanes have it: the built-in does not define the result for NaN.
fn more_of(a: f32, b: f32) -> f32 {
    return select(b, a, a > b);
}

// a < b ? a : b.
fn less_of(a: f32, b: f32) -> f32 {
    return select(b, a, a < b);
}

// 1 / sqrt(x) to 8e-7 (Walczyk, Moroz, Cieslinski 2021): the CPU's, operation by operation.
fn reciprocal_root(x: f32) -> f32 {
    var y = bitcast<f32>(0x5F1FFFF9u - (bitcast<u32>(x) >> 1u));
    y = y * 0.70395225 * (2.3892446 - x * y * y);
    return y * (1.5 - 0.5 * x * y * y);
}

// A vector no longer than `reach`.
fn limited(by: vec3<f32>, reach: f32) -> vec3<f32> {
    let size2 = inner(by, by);
    if (reach * reach < size2) {
        return by * (reach * reciprocal_root(size2));
    }
    return by;
}
