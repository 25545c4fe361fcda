//! The round cone: the solid that bodies are drawn with, and that cloth meets.

use glam::Vec3;

/// Signed distance from `p` to a round cone (m), negative inside, and where along the axis (0 at `a`, 1 at `b`) the
/// sphere stands that the nearest surface point belongs to.
///
/// The cone is the union of spheres whose centres run from `a` to `b` while the radius r(s) = ra - k s shrinks with
/// slope k = (ra - rb) / |b - a|. With x along the axis and y across it, |p - c(s)| - r(s) is convex in s and least where
/// (x - s) / |p - c(s)| = k, that is at s = x - y k / sqrt(1 - k^2), held between the ends. (The same solid as in
/// I. Quilez, "Distance to a round cone"; the derivation is our own.) Where one sphere swallows the other, it is all.
pub fn round_cone(p: Vec3, (a, ra): (Vec3, f32), (b, rb): (Vec3, f32)) -> (f32, f32) {
    let axis = b - a;
    let length = axis.length();
    if length <= (ra - rb).abs() {
        return if ra >= rb { (p.distance(a) - ra, 0.0) } else { (p.distance(b) - rb, 1.0) };
    }
    let k = (ra - rb) / length;
    let x = (p - a).dot(axis) / length;
    let y = (p - a - axis * (x / length)).length();
    let s = (x - y * k / (1.0 - k * k).sqrt()).clamp(0.0, length);
    ((x - s).hypot(y) - (ra - k * s), s / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distance by walking the axis in small steps and testing every sphere.
    fn walked(p: Vec3, (a, ra): (Vec3, f32), (b, rb): (Vec3, f32)) -> f32 {
        let steps = 20_000;
        let at = |i: i32| i as f32 / steps as f32;
        (0..=steps).map(|i| p.distance(a.lerp(b, at(i))) - (ra + (rb - ra) * at(i))).fold(f32::MAX, f32::min)
    }

    #[test]
    fn round_cone_agrees_with_brute_force() {
        let cones = [
            ((Vec3::ZERO, 0.1), (Vec3::new(0.3, 0.1, -0.2), 0.05)),
            ((Vec3::ONE, 0.05), (Vec3::new(1.0, 1.4, 1.0), 0.05)),
            ((Vec3::ZERO, 0.2), (Vec3::new(0.05, 0.0, 0.0), 0.1)),
            ((Vec3::X, 0.01), (Vec3::X, 0.02)),
            ((Vec3::ZERO, 0.12), (Vec3::new(0.0, -0.1, 0.0), 0.03)),
        ];
        for (a, b) in cones {
            for i in 0..1000 {
                let spread = |k: f32| (i as f32 * k).fract() - 0.5;
                let p = a.0 + Vec3::new(spread(0.618_034), spread(0.414_214), spread(0.732_051)) * 0.8;
                let (found, t) = round_cone(p, a, b);
                assert!((found - walked(p, a, b)).abs() < 1e-5, "{p} {found}");
                assert!((0.0..=1.0).contains(&t));
            }
        }
    }

    #[test]
    fn round_cone_distance_inside_is_the_way_out() {
        let (a, b) = ((Vec3::ZERO, 0.1), (Vec3::new(0.4, 0.0, 0.0), 0.06));
        let p = Vec3::new(0.2, 0.03, 0.01);
        let depth = -round_cone(p, a, b).0;
        let directions = (0..20_000).map(|i| {
            let (s, c) = (i as f32 * 2.399_963).sin_cos();
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / 20_000.0;
            Vec3::new(c * (1.0 - z * z).sqrt(), s * (1.0 - z * z).sqrt(), z)
        });
        let mut reached = 0;
        for d in directions {
            assert!(round_cone(p + d * (depth - 1e-5), a, b).0 < 0.0, "a ball of that radius fits");
            reached += u32::from(round_cone(p + d * (depth + 2e-4), a, b).0 > 0.0);
        }
        assert!(reached > 0, "and touches");
    }
}
