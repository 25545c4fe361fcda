//! Contact with the body's capsules and the floor, with Coulomb friction.
//!
//! Positions are projected out of the signed distance field of each round cone that is near; what a push moves beyond
//! the approach of this substep is taken out of the velocity again, so that nothing is shot out of a body that it was
//! found in. Friction acts on the motion relative to the moving surface (Mueller et al. 2007, section 3.5, with the
//! Coulomb bound of the push): up to mu times the push it holds, beyond that it slides.

use glam::Vec3A;
use toile_assets::garment::Part;
use toile_assets::limits::{MAX_CAPSULES, STEP_SECONDS};
use toile_assets::skeleton::{Joint, TWIST_BONES};

use super::state::{self, Columns};
use crate::colliders::{Colliders, RoundCone};

// A set bit of `Cloth::near` names a capsule.
const _: () = assert!(MAX_CAPSULES <= 32);

/// Particles this much farther away than they can travel in a step are still looked at (m).
const SLACK_M: f32 = 0.004;

/// The capsules that cloth on a part of the body can touch, a bit each.
pub fn reach(part: Part, colliders: &Colliders) -> u32 {
    let mut bits = 0;
    for (c, ends) in colliders.capsules().iter().enumerate() {
        let limb = ends.iter().map(|&s| limb(colliders.bone(s))).max_by_key(|l| *l as u8).unwrap_or(Part::Trunk);
        let touches = match part {
            Part::All => true,
            Part::Hollow => false,
            Part::Trunk => !matches!(limb, Part::LeftArm | Part::RightArm),
            Part::LeftArm | Part::RightArm => limb == part,
            Part::LeftLeg | Part::RightLeg => limb == part || limb == Part::Trunk,
        };
        bits |= u32::from(touches) << c;
    }
    bits
}

/// The limb that a bone belongs to; the shoulder girdle and the pelvis are the trunk's.
fn limb(bone: u8) -> Part {
    use Joint::*;
    const SIDES: [(Part, [Joint; 4]); 4] = [
        (Part::LeftArm, [LeftShoulder, LeftElbow, LeftWrist, LeftHand]),
        (Part::RightArm, [RightShoulder, RightElbow, RightWrist, RightHand]),
        (Part::LeftLeg, [LeftHip, LeftKnee, LeftAnkle, LeftToe]),
        (Part::RightLeg, [RightHip, RightKnee, RightAnkle, RightToe]),
    ];
    let joint = TWIST_BONES.iter().find(|(b, ..)| *b == usize::from(bone)).map_or(usize::from(bone), |t| t.1.index());
    SIDES
        .into_iter()
        .find(|(_, joints)| joints.iter().any(|j| j.index() == joint))
        .map_or(Part::Trunk, |(part, _)| part)
}

/// TEMPORARY
#[derive(Debug, Clone)]
pub struct Contacts {
    near: std::cell::RefCell<Vec<u32>>,
    reach: Vec<u32>,
    spans: [Vec<(u32, u32)>; 2],
    limited: std::cell::Cell<u64>,
}
pub struct ContactSettings {
    pub offset_m: f32,
    pub friction_static: f32,
    pub friction_kinetic: f32,
    pub substep_seconds: f32,
}
impl Contacts {
    pub fn new(spans: &[Vec<(u32, u32)>; 2], parts: &[Part], colliders: &Colliders) -> Self {
        Self {
            near: vec![0; parts.len()].into(),
            reach: parts.iter().map(|&p| reach(p, colliders)).collect(),
            spans: spans.clone(),
            limited: 0.into(),
        }
    }
    pub fn bytes(&self) -> usize {
        0
    }
    pub fn take_limited(&self) -> u64 {
        self.limited.take()
    }
    pub fn add_limited(&self, _: usize, n: u32) {
        self.limited.set(self.limited.get() + u64::from(n));
    }
    pub fn find(
        &self,
        share: usize,
        _: crate::lanes::Width,
        c: Columns<'_>,
        colliders: &Colliders,
        s: &ContactSettings,
    ) {
        let reaches = Reaches::new(colliders);
        let offset = s.offset_m + SLACK_M;
        let fall = 9.81 * STEP_SECONDS;
        for &(first, len) in &self.spans[share] {
            for i in first as usize..(first + len) as usize {
                let (p, v, w, reach) = (state::get(c.x, i), state::get(c.v, i), c.w.get(i), self.reach[i]);
                let mut bits = 0u32;
                if w > 0.0 {
                    let margin = offset + 2.0 * (v.length() + fall) * STEP_SECONDS;
                    let mut asked = reach & reaches.all;
                    while asked != 0 {
                        let c = asked.trailing_zeros() as usize;
                        asked &= asked - 1;
                        let inside = (p.cmpge(reaches.low[c] - margin) & p.cmple(reaches.high[c] + margin)).all();
                        if inside && reaches.cones[c].touch(p, margin + reaches.travel[c]).is_some() {
                            bits |= 1 << c;
                        }
                    }
                }
                self.near.borrow_mut()[i] = bits;
            }
        }
    }
    pub fn solve(
        &self,
        share: usize,
        _: crate::lanes::Width,
        cols: Columns<'_>,
        colliders: &Colliders,
        span: [f32; 2],
        s: &ContactSettings,
    ) {
        let cones = colliders.cones_at(span[1]).map(Cone::from);
        let part = span[1] - span[0];
        for &(first, len) in &self.spans[share] {
            for i in first as usize..(first + len) as usize {
                let mut bits = self.near.borrow()[i];
                if cols.w.get(i) <= 0.0 {
                    continue;
                }
                let (mut position, mut previous) = (state::get(cols.x, i), state::get(cols.previous, i));
                while bits != 0 {
                    let c = bits.trailing_zeros() as usize;
                    bits &= bits - 1;
                    if let Some(touch) = cones[c].touch(position, s.offset_m) {
                        let carried = Vec3A::from(colliders.travel(c, touch.along)) * part;
                        push(&mut position, &mut previous, touch.normal, touch.depth, s.friction_static, carried);
                    }
                }
                if colliders.floor && position.y < s.offset_m {
                    let depth = s.offset_m - position.y;
                    push(&mut position, &mut previous, Vec3A::Y, depth, s.friction_static, Vec3A::ZERO);
                }
                state::set(cols.x, i, position);
                state::set(cols.previous, i, previous);
            }
        }
    }
}

/// Where each capsule is at the start of the step and how far it reaches during it.
struct Reaches {
    /// A bit for each capsule.
    all: u32,
    cones: [Cone; MAX_CAPSULES],
    low: [Vec3A; MAX_CAPSULES],
    high: [Vec3A; MAX_CAPSULES],
    travel: [f32; MAX_CAPSULES],
}

impl Reaches {
    fn new(colliders: &Colliders) -> Self {
        let mut this = Self {
            all: ((1u64 << colliders.capsules().len()) - 1) as u32,
            cones: colliders.cones_at(0.0).map(Cone::from),
            low: [Vec3A::INFINITY; MAX_CAPSULES],
            high: [Vec3A::NEG_INFINITY; MAX_CAPSULES],
            travel: [0.0; MAX_CAPSULES],
        };
        for (c, ends) in colliders.capsules().iter().enumerate() {
            for s in ends.map(usize::from) {
                for sphere in [colliders.start()[s], colliders.end()[s]] {
                    let (centre, radius) = (Vec3A::from_vec4(sphere), sphere.w);
                    this.low[c] = this.low[c].min(centre - radius);
                    this.high[c] = this.high[c].max(centre + radius);
                }
            }
            this.travel[c] = colliders.travel(c, 0.0).length().max(colliders.travel(c, 1.0).length());
        }
        this
    }
}

/// A round cone as the inner loop wants it: 16-byte vectors, and the way out worked out only for what is inside.
/// [`RoundCone::contact`] is its plain twin.
#[derive(Clone, Copy)]
struct Cone {
    a: Vec3A,
    b: Vec3A,
    axis: Vec3A,
    across: Vec3A,
    ra: f32,
    rb: f32,
    cosine: f32,
    sine: f32,
    side: f32,
}

/// Where a particle is inside of a cone and its offset.
struct Touch {
    depth: f32,
    normal: Vec3A,
    along: f32,
}

impl From<RoundCone> for Cone {
    fn from(c: RoundCone) -> Self {
        Self {
            a: c.a.into(),
            b: c.b.into(),
            axis: c.axis.into(),
            across: c.across.into(),
            ra: c.ra,
            rb: c.rb,
            cosine: c.cosine,
            sine: c.sine,
            side: c.side,
        }
    }
}

impl Cone {
    #[inline(always)]
    fn touch(&self, p: Vec3A, offset: f32) -> Option<Touch> {
        let v = p - self.a;
        let y = v.dot(self.axis);
        let across2 = (v.length_squared() - y * y).max(0.0);
        let x = across2.sqrt();
        let foot = y * self.cosine - x * self.sine;
        if foot <= 0.0 {
            return ball(v, self.ra + offset, -self.axis, 0.0);
        }
        if foot >= self.side {
            return ball(p - self.b, self.rb + offset, self.axis, 1.0);
        }
        let depth = offset + self.ra - x * self.cosine - y * self.sine;
        if depth <= 0.0 {
            return None;
        }
        let out = v - self.axis * y;
        let outwards = if x > 1e-9 { out / x } else { self.across };
        Some(Touch { depth, normal: outwards * self.cosine + self.axis * self.sine, along: foot / self.side })
    }
}

#[inline(always)]
fn ball(v: Vec3A, reach: f32, pole: Vec3A, along: f32) -> Option<Touch> {
    let length2 = v.length_squared();
    if length2 >= reach * reach {
        return None;
    }
    let length = length2.sqrt();
    let normal = if length > 1e-9 { v / length } else { pole };
    Some(Touch { depth: reach - length, normal, along })
}

/// Moves a particle out by `depth` along `normal`; `carried` is how far the surface itself moved in the substep.
#[inline]
fn push(position: &mut Vec3A, previous: &mut Vec3A, normal: Vec3A, depth: f32, friction: f32, carried: Vec3A) {
    let relative = *position - *previous - carried;
    let approach = -relative.dot(normal);
    *position += normal * depth;
    let sliding = relative + normal * approach;
    let slid = sliding.length();
    if slid > 1e-9 {
        *position -= sliding * (friction * depth / slid).min(1.0);
    }
    // Only the approach may turn into speed: a deeper push moves the start of the substep along.
    let excess = depth - approach.max(0.0);
    if excess > 0.0 {
        *previous += normal * excess;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fast_cone_agrees_with_its_plain_twin() {
        let cone = RoundCone::new(glam::vec3(0.1, 0.9, 0.0), 0.12, glam::vec3(0.13, 0.5, 0.02), 0.07);
        let mut inside = 0;
        for i in 0..4_096u32 {
            let grid = |k: u32| ((i >> (4 * k)) & 15) as f32 / 15.0;
            let p = Vec3A::new(grid(0) * 0.4 - 0.1, 0.3 + grid(1) * 0.8, grid(2) * 0.4 - 0.2);
            let plain = cone.contact(p.into());
            match Cone::from(cone).touch(p, 0.003) {
                Some(touch) => {
                    inside += 1;
                    assert!((touch.depth - (0.003 - plain.distance)).abs() < 1e-5, "{p}");
                    assert!((touch.normal - Vec3A::from(plain.normal)).length() < 1e-3, "{p}");
                    assert!((touch.along - plain.along).abs() < 1e-3, "{p}");
                }
                None => assert!(plain.distance > 0.003 - 1e-5, "{p}"),
            }
        }
        assert!(inside > 200, "{inside}");
    }

    #[test]
    fn a_particle_found_inside_comes_out_without_speed() {
        let mut p = Vec3A::new(0.0, -0.05, 0.0);
        let mut before = p;
        push(&mut p, &mut before, Vec3A::Y, 0.05, 0.3, Vec3A::ZERO);
        assert!(p.y.abs() < 1e-7 && (p - before).length() < 1e-7);
    }

    #[test]
    fn friction_holds_below_the_cone_and_slides_beyond() {
        for (dx, left) in [(0.002, 0.0), (0.02, 0.02 - 0.3 * 0.01)] {
            let mut before = Vec3A::ZERO;
            let mut p = Vec3A::new(dx, -0.01, 0.0);
            push(&mut p, &mut before, Vec3A::Y, 0.01, 0.3, Vec3A::ZERO);
            assert!((p.x - left).abs() < 1e-6 && p.y.abs() < 1e-7, "{p}");
        }
    }

    #[test]
    fn a_moving_surface_carries_what_rests_on_it() {
        let mut before = Vec3A::ZERO;
        let mut p = Vec3A::new(0.0, -0.001, 0.0);
        push(&mut p, &mut before, Vec3A::Y, 0.001, 1.0, Vec3A::new(0.0005, 0.0, 0.0));
        assert!((p.x - 0.0005).abs() < 1e-7, "{p}");
    }
}
