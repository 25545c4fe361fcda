//! The geometry of the collision body: spheres that follow bones, and the tapered capsule between two of them.
//!
//! A distance may take 10 ns.

use glam::{Vec3, Vec4, Vec4Swizzles};
use toile_base::skeleton::Skeleton;

/// Where unused spheres wait: far below, without radius, so that a loop over all of them stays finite.
pub const PARKED: Vec4 = Vec4::new(0.0, -1000.0, 0.0, 0.0);

/// A sphere that follows a bone, where it stands in the rest pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestSphere {
    /// The bone it follows, below [`toile_base::skeleton::BONES`].
    pub bone: u8,
    /// Centre in the rest pose, world (m).
    pub centre: Vec3,
    /// Radius (m).
    pub radius: f32,
}

impl RestSphere {
    /// A sphere given from its bone's origin in the rest pose (m). A bone that does not exist is refused by
    /// [`Colliders::new`](crate::colliders::Colliders::new).
    pub fn on_bone(skeleton: &Skeleton, bone: u8, offset: Vec3, radius: f32) -> Self {
        let origin = skeleton.bone_origins().get(usize::from(bone)).copied().unwrap_or_default();
        Self { bone, centre: origin + offset, radius }
    }
}

/// A tapered capsule, the convex hull of two spheres, with what its distance needs worked out once.
///
/// In the half plane through its axis, `y` along it from the first centre and `x` away from it, the slanted side has
/// the normal `(cosine, sine)`, sine = (ra - rb) / length; a point belongs to the side while its foot
/// `t = y cosine - x sine` lies between 0 and `side`, and to one of the spheres beyond. One sphere inside the other
/// leaves the larger sphere alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoundCone {
    /// First centre (m).
    pub a: Vec3,
    /// Radius at the first centre (m).
    pub ra: f32,
    /// Unit vector from the first centre to the second.
    pub axis: Vec3,
    /// Distance between the centres (m); 0 if one sphere holds the other.
    pub length: f32,
    /// Second centre (m).
    pub b: Vec3,
    /// Radius at the second centre (m).
    pub rb: f32,
    /// Cosine of the side's slope.
    pub cosine: f32,
    /// Sine of the side's slope, positive where the capsule narrows from `a` to `b`.
    pub sine: f32,
    /// Length of the slanted side (m).
    pub side: f32,
    /// Unit vector across the axis: the way out for a point on the axis.
    pub across: Vec3,
    /// Where one sphere holds the other, which is left: 0 the first, 1 the second.
    pub larger: f32,
}

/// Where a point lies from a [`RoundCone`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Distance to the surface (m), negative inside.
    pub distance: f32,
    /// Gradient of the distance: the unit outward normal.
    pub normal: Vec3,
    /// Which point of the axis the surface there belongs to, 0 the first sphere to 1 the second.
    pub along: f32,
}

impl RoundCone {
    /// A point without radius, far below: nothing ever touches it.
    pub const PARKED: Self = Self {
        a: Vec3::new(0.0, -1000.0, 0.0),
        ra: 0.0,
        axis: Vec3::Y,
        length: 0.0,
        b: Vec3::new(0.0, -1000.0, 0.0),
        rb: 0.0,
        cosine: 1.0,
        sine: 0.0,
        side: 0.0,
        across: Vec3::X,
        larger: 0.0,
    };

    /// The capsule of two spheres (m). Values that are not finite give a sphere without radius far below.
    pub fn new(a: Vec3, ra: f32, b: Vec3, rb: f32) -> Self {
        let finite = a.is_finite() && b.is_finite() && ra.is_finite() && rb.is_finite();
        let parked = (PARKED.xyz(), 0.0);
        let ((a, ra), (b, rb)) = if finite { ((a, ra), (b, rb)) } else { (parked, parked) };
        let span = b - a;
        let length = span.length();
        // The narrowest cone kept: beyond it the side is shorter than the rounding of its own length.
        if length <= (ra - rb).abs() * 1.000_01 || length < 1e-9 {
            return Self::sphere(a, ra, b, rb);
        }
        let axis = span / length;
        let sine = (ra - rb) / length;
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let across = axis.any_orthonormal_vector();
        Self { a, ra, axis, length, b, rb, cosine, sine, side: length * cosine, across, larger: 0.0 }
    }

    /// The larger of two spheres as a cone without length.
    fn sphere(a: Vec3, ra: f32, b: Vec3, rb: f32) -> Self {
        let (centre, radius, larger) = if ra >= rb { (a, ra, 0.0) } else { (b, rb, 1.0) };
        Self {
            a: centre,
            ra: radius,
            axis: Vec3::Y,
            length: 0.0,
            b: centre,
            rb: radius,
            cosine: 1.0,
            sine: 0.0,
            side: 0.0,
            across: Vec3::X,
            larger,
        }
    }

    /// Whether a point can lie inside: no point of the capsule is farther from its axis than its larger radius. The margin
    /// is beyond all rounding, so that a point for which this is false has no negative [`distance`](Self::distance).
    pub fn may_contain(&self, p: Vec3) -> bool {
        let v = p - self.a;
        let out = v - self.axis * (v.dot(self.axis));
        let r = self.ra.max(self.rb) + 1e-3;
        self.length == 0.0 || out.length_squared() <= r * r
    }

    /// Signed distance of a point (m), and the unit outward normal, which is its gradient.
    pub fn distance(&self, p: Vec3) -> (f32, Vec3) {
        let contact = self.contact(p);
        (contact.distance, contact.normal)
    }

    /// Signed distance, normal, and place along the axis. Exact everywhere, inside too.
    pub fn contact(&self, p: Vec3) -> Contact {
        let v = p - self.a;
        if self.length == 0.0 {
            return ball(v, self.ra, Vec3::Y, self.larger);
        }
        let y = v.dot(self.axis);
        let out = v - self.axis * y;
        let x = out.length();
        let foot = y * self.cosine - x * self.sine;
        if foot <= 0.0 {
            return ball(v, self.ra, -self.axis, 0.0);
        }
        if foot >= self.side {
            return ball(p - self.b, self.rb, self.axis, 1.0);
        }
        let outwards = if x > 1e-9 { out / x } else { self.across };
        Contact {
            distance: x * self.cosine + y * self.sine - self.ra,
            normal: outwards * self.cosine + self.axis * self.sine,
            along: foot / self.side,
        }
    }
}

/// The distance from a sphere, `v` from its centre; `pole` is the way out of the very centre.
fn ball(v: Vec3, radius: f32, pole: Vec3, along: f32) -> Contact {
    let length = v.length();
    let normal = if length > 1e-9 { v / length } else { pole };
    Contact { distance: length - radius, normal, along }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Distance to the union of the balls that the two spheres sweep, by trying many of them; outside it is the
    /// distance to the capsule, up to the sampling.
    fn swept(a: Vec3, ra: f32, b: Vec3, rb: f32, p: Vec3) -> f32 {
        let ball = |t: f32| p.distance(a.lerp(b, t)) - (ra + (rb - ra) * t);
        // The distance is convex along the axis: halve the bracket around the least sample.
        let best = (0..=64).min_by(|i, j| ball(*i as f32 / 64.0).total_cmp(&ball(*j as f32 / 64.0))).unwrap();
        let (mut low, mut high) = ((best as f32 - 1.0).max(0.0) / 64.0, (best as f32 + 1.0).min(64.0) / 64.0);
        for _ in 0..40 {
            let (x, y) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if ball(x) < ball(y) { high = y } else { low = x }
        }
        ball(0.5 * (low + high))
    }

    fn point() -> impl Strategy<Value = Vec3> {
        (-0.6_f32..0.6, -0.6_f32..0.6, -0.6_f32..0.6).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn distance_is_that_to_the_swept_spheres_and_the_normal_its_gradient(
            a in point(), b in prop_oneof![4 => point(), 1 => Just(Vec3::ZERO)], p in point(),
            ra in 0.0_f32..0.3, rb in 0.0_f32..0.3, alike in any::<bool>(),
        ) {
            let rb = if alike { ra } else { rb };
            let cone = RoundCone::new(a, ra, b, rb);
            let (distance, normal) = cone.distance(p);
            let truth = swept(a, ra, b, rb, p);
            prop_assert!((distance - truth).abs() < 2e-5, "{distance} against {truth}");
            prop_assert!(distance >= 0.0 || cone.may_contain(p));
            prop_assert!((normal.length() - 1.0).abs() < 1e-4);
            // One step of the length of the distance lands on the surface.
            let surface = p - normal * distance;
            prop_assert!(cone.distance(surface).0.abs() < 2e-5, "{} off the surface", cone.distance(surface).0);
            let along = cone.contact(p).along;
            prop_assert!((0.0..=1.0).contains(&along));
            let foot = a.lerp(b, along);
            let radius = ra + (rb - ra) * along;
            prop_assert!((p.distance(foot) - radius - distance).abs() < 5e-5);
        }

        #[test]
        fn no_spheres_make_a_normal_that_is_not_finite(
            n in proptest::collection::vec(any::<f32>(), 8), p in point(),
        ) {
            let cone = RoundCone::new(Vec3::new(n[0], n[1], n[2]), n[3], Vec3::new(n[4], n[5], n[6]), n[7]);
            let near = n.iter().all(|v| !v.is_finite() || v.abs() < 1e9);
            let (distance, normal) = cone.distance(p);
            prop_assert!(!near || (distance.is_finite() && normal.is_finite()), "{cone:?} {distance} {normal}");
        }
    }

    #[test]
    fn centres_and_axis_have_a_way_out() {
        let (a, b) = (Vec3::ZERO, Vec3::Y);
        for (ra, rb) in [(0.2, 0.2), (0.3, 0.1), (1.5, 0.2), (0.0, 0.0)] {
            for p in [a, b, Vec3::Y * 0.5] {
                let (distance, normal) = RoundCone::new(a, ra, b, rb).distance(p);
                assert!((normal.length() - 1.0).abs() < 1e-5, "{ra} {rb} {p}");
                assert!(distance <= 0.0);
            }
        }
        let same = RoundCone::new(a, 0.1, a, 0.2).distance(Vec3::X);
        assert_eq!(same, (0.8, Vec3::X));
    }
}
