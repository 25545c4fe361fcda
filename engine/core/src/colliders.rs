//! Spheres, the tapered capsules between them, and the floor: where they stand at the start and end of a step.
//!
//! Reads: the rig's spheres in the rest pose and the palette. Writes: [`Colliders`].
//! Budget: 16 spheres and 28 capsules, under 1 us a step; a distance to one capsule is 10 ns.
//! Thread: physics, between skin and cloth.

use glam::{Affine3A, Vec3, Vec4, Vec4Swizzles};
use thiserror::Error;
use toile_assets::limits::{MAX_CAPSULES, MAX_SPHERES};
use toile_assets::skeleton::{BONES, Skeleton};

/// A sphere that follows a bone, where it stands in the rest pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestSphere {
    /// The bone it follows, below [`BONES`].
    pub bone: u8,
    /// Centre in the rest pose, world (m).
    pub centre: Vec3,
    /// Radius (m).
    pub radius: f32,
}

impl RestSphere {
    /// A sphere given from its bone's origin in the rest pose (m). A bone that does not exist is refused by
    /// [`Colliders::new`].
    pub fn on_bone(skeleton: &Skeleton, bone: u8, offset: Vec3, radius: f32) -> Self {
        let origin = skeleton.bone_origins().get(usize::from(bone)).copied().unwrap_or_default();
        Self { bone, centre: origin + offset, radius }
    }
}

/// Why a set of colliders cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ColliderError {
    /// More spheres than [`MAX_SPHERES`].
    #[error("{0} collision spheres are more than MAX_SPHERES = {MAX_SPHERES}; merge spheres that overlap most")]
    TooManySpheres(usize),
    /// More capsules than [`MAX_CAPSULES`].
    #[error("{0} capsules are more than MAX_CAPSULES = {MAX_CAPSULES}; leave out those inside others")]
    TooManyCapsules(usize),
    /// A bone that the skeleton lacks.
    #[error("collision sphere {sphere} follows bone {bone}, but there are {BONES} bones; use an index below that")]
    NoSuchBone {
        /// The sphere.
        sphere: usize,
        /// What it names.
        bone: u8,
    },
    /// A centre or radius that is no number, or a radius below 0.
    #[error("collision sphere {0} has a centre that is not finite or a radius that is not 0 m or more; correct it")]
    BadSphere(usize),
    /// A capsule between spheres that do not exist.
    #[error("capsule {capsule} joins spheres {ends:?}, but there are {spheres}; use indices below that")]
    NoSuchSphere {
        /// The capsule.
        capsule: usize,
        /// What it names.
        ends: [u8; 2],
        /// How many spheres there are.
        spheres: usize,
    },
}

/// The colliders of one body at the start and the end of a step.
///
/// Spheres are `(x, y, z, radius)`, world (m). Places past the count hold [`PARKED`].
#[derive(Debug, Clone, PartialEq)]
pub struct Colliders {
    start: [Vec4; MAX_SPHERES],
    end: [Vec4; MAX_SPHERES],
    capsules: heapless::Vec<[u8; 2], MAX_CAPSULES>,
    rest: heapless::Vec<RestSphere, MAX_SPHERES>,
    /// Whether the floor at y = 0 stops the cloth.
    pub floor: bool,
    placed: bool,
}

/// Where unused spheres wait: far below, without radius, so that a loop over all of them stays finite.
pub const PARKED: Vec4 = Vec4::new(0.0, -1000.0, 0.0, 0.0);

impl Colliders {
    /// Colliders of a rig: its spheres, and the pairs of them that capsules join. At load.
    pub fn new(spheres: &[RestSphere], capsules: &[[u8; 2]], floor: bool) -> Result<Self, ColliderError> {
        for (i, s) in spheres.iter().enumerate() {
            if usize::from(s.bone) >= BONES {
                return Err(ColliderError::NoSuchBone { sphere: i, bone: s.bone });
            }
            if !s.centre.is_finite() || !s.radius.is_finite() || s.radius < 0.0 {
                return Err(ColliderError::BadSphere(i));
            }
        }
        for (i, ends) in capsules.iter().enumerate() {
            if ends.iter().any(|e| usize::from(*e) >= spheres.len()) {
                return Err(ColliderError::NoSuchSphere { capsule: i, ends: *ends, spheres: spheres.len() });
            }
        }
        Ok(Self {
            start: [PARKED; MAX_SPHERES],
            end: [PARKED; MAX_SPHERES],
            capsules: heapless::Vec::from_slice(capsules)
                .map_err(|_| ColliderError::TooManyCapsules(capsules.len()))?,
            rest: heapless::Vec::from_slice(spheres).map_err(|_| ColliderError::TooManySpheres(spheres.len()))?,
            floor,
            placed: false,
        })
    }

    /// Moves the end of the last step to the start of this one, and the end to where the bones now are. The first
    /// placement sets both: a body that appears does not sweep.
    pub fn place(&mut self, palette: &[Affine3A; BONES]) {
        self.start = self.end;
        for (sphere, end) in self.rest.iter().zip(&mut self.end) {
            let bone = palette[usize::from(sphere.bone) % BONES];
            *end = bone.transform_point3(sphere.centre).extend(sphere.radius);
        }
        if !self.placed {
            self.start = self.end;
            self.placed = true;
        }
    }

    /// Places the spheres where a track says, `(x, y, z, radius)` in world metres, instead of by bones.
    pub fn place_at(&mut self, spheres: &[Vec4]) {
        self.start = self.end;
        let count = self.rest.len();
        for (end, s) in self.end[..count].iter_mut().zip(spheres) {
            *end = *s;
        }
        if !self.placed {
            self.start = self.end;
            self.placed = true;
        }
    }

    /// Forgets where the body was: the next placement sets start and end alike.
    pub fn reset(&mut self) {
        self.placed = false;
    }

    /// Spheres at the start of the step `[spheres]`.
    pub fn start(&self) -> &[Vec4] {
        &self.start[..self.rest.len()]
    }

    /// Spheres at the end of the step `[spheres]`.
    pub fn end(&self) -> &[Vec4] {
        &self.end[..self.rest.len()]
    }

    /// Pairs of spheres that capsules join `[capsules]`.
    pub fn capsules(&self) -> &[[u8; 2]] {
        &self.capsules
    }

    /// One sphere at `t` of the step (0 start, 1 end).
    pub fn sphere(&self, sphere: usize, t: f32) -> Vec4 {
        self.start[sphere] + (self.end[sphere] - self.start[sphere]) * t
    }

    /// One capsule at `t` of the step, made ready for many distances.
    pub fn cone(&self, capsule: usize, t: f32) -> RoundCone {
        let [a, b] = self.capsules[capsule].map(|s| self.sphere(usize::from(s), t));
        RoundCone::new(a.xyz(), a.w, b.xyz(), b.w)
    }

    /// All capsules at `t` of the step; places past their count hold a point far below.
    pub fn cones_at(&self, t: f32) -> [RoundCone; MAX_CAPSULES] {
        std::array::from_fn(|c| if c < self.capsules.len() { self.cone(c, t) } else { RoundCone::PARKED })
    }

    /// How far the point of a capsule at `along` (0 its first sphere, 1 its second) moves in the step (m); over the
    /// step's length that is its velocity.
    pub fn travel(&self, capsule: usize, along: f32) -> Vec3 {
        let [a, b] = self.capsules[capsule].map(|s| {
            let s = usize::from(s);
            self.end[s].xyz() - self.start[s].xyz()
        });
        a + (b - a) * along
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

    fn two() -> Colliders {
        let sphere = |bone, x| RestSphere { bone, centre: Vec3::new(x, 1.0, 0.0), radius: 0.1 };
        Colliders::new(&[sphere(0, 0.0), sphere(3, 0.5)], &[[0, 1]], true).unwrap()
    }

    #[test]
    fn first_placement_does_not_sweep_and_the_next_starts_where_the_last_ended() {
        let mut colliders = two();
        let mut palette = [Affine3A::IDENTITY; BONES];
        palette[0] = Affine3A::from_translation(Vec3::Z);
        colliders.place(&palette);
        assert_eq!(colliders.start(), colliders.end());
        assert_eq!(colliders.end()[0], Vec4::new(0.0, 1.0, 1.0, 0.1));
        palette[3] = Affine3A::from_translation(Vec3::Y * 0.2);
        let ended = colliders.end().to_vec();
        colliders.place(&palette);
        assert_eq!(colliders.start(), ended);
        assert!(colliders.travel(0, 0.5).distance(Vec3::Y * 0.1) < 1e-6);
        assert!(colliders.cone(0, 0.5).b.distance(Vec3::new(0.5, 1.1, 0.0)) < 1e-6);
        colliders.reset();
        colliders.place(&[Affine3A::IDENTITY; BONES]);
        assert_eq!(colliders.start(), colliders.end());
    }

    #[test]
    fn bad_rigs_are_refused_with_the_place() {
        let good = RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.1 };
        let refuse = |s: RestSphere| Colliders::new(&[good, s], &[], false).unwrap_err().to_string();
        assert!(refuse(RestSphere { bone: 27, ..good }).contains("sphere 1 follows bone 27"));
        assert!(refuse(RestSphere { radius: f32::NAN, ..good }).contains("sphere 1"));
        assert!(refuse(RestSphere { radius: -0.1, ..good }).contains("sphere 1"));
        let error = Colliders::new(&[good], &[[0, 1]], false).unwrap_err();
        assert!(error.to_string().contains("[0, 1]"));
        assert_eq!(Colliders::new(&[good; 17], &[], false), Err(ColliderError::TooManySpheres(17)));
        assert_eq!(Colliders::new(&[good], &[[0, 0]; 29], false), Err(ColliderError::TooManyCapsules(29)));
    }
}
