//! Spheres, the tapered capsules between them, and the floor: where they stand at the start and end of a step.
//!
//! A step of 51 spheres and 32 capsules takes under 1 us; a distance to one capsule takes 10 ns. The step runs on the physics thread,
//! between skin and cloth.

use glam::{Affine3A, Vec3, Vec4, Vec4Swizzles};
use thiserror::Error;
use toile_base::limits::{MAX_CAPSULES, MAX_PLANES, MAX_SPHERES, STEP_SECONDS};
use toile_base::skeleton::BONES;

use crate::body_surface::BodySurface;
use crate::jump_filter::JumpFilter;
use crate::skin::Posed;

pub use crate::cone::{Contact, PARKED, RestSphere, RoundCone};

/// When more than half of the spheres move further than this in a step (m), the body has been teleported.
const TELEPORT_M: f32 = 0.5;

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
        /// Index of the sphere.
        sphere: usize,
        /// Index of the bone that it names.
        bone: u8,
    },
    /// A centre or radius that is not finite, or a radius below 0.
    #[error("collision sphere {0} has a centre that is not finite or a radius that is not 0 m or more; correct it")]
    BadSphere(usize),
    /// A capsule between spheres that do not exist.
    #[error("capsule {capsule} joins spheres {ends:?}, but there are {spheres}; use indices below that")]
    NoSuchSphere {
        /// Index of the capsule.
        capsule: usize,
        /// Indices of the spheres that it names.
        ends: [u8; 2],
        /// How many spheres there are.
        spheres: usize,
    },
    /// More planes than [`MAX_PLANES`].
    #[error("{0} planes are more than MAX_PLANES = {MAX_PLANES}; leave out those that nothing can reach")]
    TooManyPlanes(usize),
    /// A plane without a direction.
    #[error("plane {0} has a normal that is not of unit length or an offset that is not finite; correct it")]
    BadPlane(usize),
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
    planes: heapless::Vec<Vec4, MAX_PLANES>,
    /// Length of a step (s): what can move how far in it.
    pub step_seconds: f32,
    placed: bool,
    root: Affine3A,
    hold: JumpFilter,
    skin: Option<Box<BodySurface>>,
}

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
            planes: heapless::Vec::new(),
            step_seconds: STEP_SECONDS,
            placed: false,
            root: Affine3A::IDENTITY,
            hold: JumpFilter::default(),
            skin: None,
        })
    }

    /// The same with the skin of the body, which cloth then lies on where it is near. At load.
    #[must_use]
    pub fn with_skin(self, skin: BodySurface) -> Self {
        Self { skin: Some(Box::new(skin)), ..self }
    }

    /// The skin of the body, where there is one.
    pub fn skin(&self) -> Option<&BodySurface> {
        self.skin.as_deref()
    }

    /// Moves the skin to where it was posed for the end of this step.
    pub fn place_skin(&mut self, posed: &Posed) {
        if let Some(skin) = &mut self.skin {
            skin.place(posed);
        }
    }

    /// Walls, tables and slopes that stop the cloth besides the floor; they do not move. Each is a unit normal and the
    /// offset of the plane along it (m): outside is where `normal . p >= offset`. At load.
    pub fn set_planes(&mut self, planes: &[Vec4]) -> Result<(), ColliderError> {
        let sound = |p: &Vec4| (p.xyz().length() - 1.0).abs() < 1e-3 && p.w.is_finite();
        if let Some(plane) = planes.iter().position(|p| !sound(p)) {
            return Err(ColliderError::BadPlane(plane));
        }
        self.planes = heapless::Vec::from_slice(planes).map_err(|_| ColliderError::TooManyPlanes(planes.len()))?;
        Ok(())
    }

    /// The planes besides the floor: unit normal, and offset along it (m) `[planes]`.
    pub fn planes(&self) -> &[Vec4] {
        &self.planes
    }

    /// Moves the end of the last step to the start of this one, and the end to where the bones now are. The first
    /// placement sets both: a body that appears does not sweep.
    pub fn place(&mut self, palette: &[Affine3A; BONES]) {
        self.start = self.end;
        for (sphere, end) in self.rest.iter().zip(&mut self.end) {
            // Below BONES: checked by `new`.
            let bone = palette[usize::from(sphere.bone)];
            *end = bone.transform_point3(sphere.centre).extend(sphere.radius);
        }
        let motion = palette[0] * self.root.inverse();
        let motion = if self.placed && motion.is_finite() { motion } else { Affine3A::IDENTITY };
        if palette[0].is_finite() {
            self.root = palette[0];
        }
        self.believe(&motion);
    }

    /// The same for a body whose spheres are given in the world (m), centre and radius: a scene's track. Spheres past
    /// the rig's count are passed over, and those not given stay where they are.
    pub fn place_spheres(&mut self, spheres: &[Vec4]) {
        self.start = self.end;
        self.end[..self.rest.len()].iter_mut().zip(spheres).for_each(|(end, sphere)| *end = *sphere);
        self.believe(&Affine3A::IDENTITY);
    }

    /// Takes the new places as far as a body can have got there, carried by `motion`: single spheres that jump are held;
    /// a body that is somewhere else altogether has not swept what lies between.
    fn believe(&mut self, motion: &Affine3A) {
        let count = self.rest.len();
        let moved = |(start, end): (&Vec4, &Vec4)| (end.xyz() - start.xyz()).length();
        let far = self.start[..count].iter().zip(&self.end[..count]).filter(|pair| moved(*pair) > TELEPORT_M).count();
        if !self.placed || far * 2 > count {
            self.hold.reset();
        }
        self.hold.filter(motion, &mut self.end[..count], self.step_seconds);
        if !self.placed || far * 2 > count {
            self.start = self.end;
            self.placed = true;
        }
    }

    /// Sphere steps in which a sphere was not where it was said to be, because it had jumped or was not finite.
    pub fn held(&self) -> u64 {
        self.hold.held + self.hold.followed
    }

    /// Forgets where the body was: the next placement sets start and end alike.
    pub fn reset(&mut self) {
        self.placed = false;
        self.skin.iter_mut().for_each(|skin| skin.reset());
    }

    /// Puts the spheres where no motion would bring them: for tests of what has to bear it.
    #[cfg(test)]
    pub(crate) fn force(&mut self, start: &[Vec4], end: &[Vec4]) {
        self.start[..start.len()].copy_from_slice(start);
        self.end[..end.len()].copy_from_slice(end);
    }

    /// Spheres at the start of the step `[spheres]`.
    pub fn start(&self) -> &[Vec4] {
        &self.start[..self.rest.len()]
    }

    /// Spheres at the end of the step `[spheres]`.
    pub fn end(&self) -> &[Vec4] {
        &self.end[..self.rest.len()]
    }

    /// The bone that a sphere follows.
    pub fn bone(&self, sphere: u8) -> u8 {
        self.rest[usize::from(sphere)].bone
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

#[cfg(test)]
mod tests {
    use super::*;

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
    fn spheres_given_in_the_world_are_placed_alike() {
        let mut colliders = two();
        let at = |x: f32| [Vec4::new(x, 1.0, 0.0, 0.1), Vec4::new(x, 2.0, 0.0, 0.2), Vec4::splat(9.0)];
        colliders.place_spheres(&at(0.0));
        assert_eq!(colliders.start(), &at(0.0)[..2], "the first placement does not sweep, and a third is passed over");
        assert_eq!(colliders.start(), colliders.end());
        colliders.place_spheres(&at(0.2));
        assert_eq!(colliders.start(), &at(0.0)[..2]);
        assert_eq!(colliders.end(), &at(0.2)[..2]);
        assert_eq!(colliders.cone(0, 1.0).rb, 0.2);
    }

    #[test]
    fn planes_are_kept_and_bad_ones_refused() {
        let mut colliders = two();
        let wall = Vec4::new(0.0, 0.6, 0.8, -2.0);
        assert!(colliders.planes().is_empty());
        assert_eq!(colliders.set_planes(&[wall, Vec4::new(1.0, 0.0, 0.0, 0.0)]), Ok(()));
        assert_eq!(colliders.planes()[0], wall);
        assert_eq!(colliders.set_planes(&[wall, wall * 2.0]), Err(ColliderError::BadPlane(1)));
        assert_eq!(colliders.set_planes(&[Vec4::NAN]), Err(ColliderError::BadPlane(0)));
        assert_eq!(colliders.set_planes(&[wall; 5]), Err(ColliderError::TooManyPlanes(5)));
    }

    #[test]
    fn bad_rigs_are_refused_with_the_place() {
        let good = RestSphere { bone: 0, centre: Vec3::ZERO, radius: 0.1 };
        let refuse = |s: RestSphere| Colliders::new(&[good, s], &[], false).unwrap_err().to_string();
        let message = refuse(RestSphere { bone: BONES as u8, ..good });
        assert!(message.contains(&format!("sphere 1 follows bone {BONES}")), "{message}");
        assert!(refuse(RestSphere { radius: f32::NAN, ..good }).contains("sphere 1"));
        assert!(refuse(RestSphere { radius: -0.1, ..good }).contains("sphere 1"));
        let error = Colliders::new(&[good], &[[0, 1]], false).unwrap_err();
        assert!(error.to_string().contains("[0, 1]"));
        assert_eq!(
            Colliders::new(&[good; MAX_SPHERES + 1], &[], false),
            Err(ColliderError::TooManySpheres(MAX_SPHERES + 1))
        );
        assert_eq!(
            Colliders::new(&[good], &[[0, 0]; MAX_CAPSULES + 1], false),
            Err(ColliderError::TooManyCapsules(MAX_CAPSULES + 1))
        );
    }
}
