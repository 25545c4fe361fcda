//! The body that is seen: its skinned triangles at the start and the end of a step, for cloth to lie on.
//!
//! A step of 15,000 vertices may take 20 us, all of it copying. Nothing is allocated after load. It runs on the physics thread,
//! between skin and cloth.
//!
//! Each part of a garment meets a surface of its own, made of the limbs that it can touch: a nearest point that is walked to
//! then never lies on the wrong side of an armpit or on the other leg.

use glam::Vec3A;
use toile_base::body::Body;
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;
use toile_base::skeleton::{Joint, bone_joint};

use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, Store, V3, Width};
use crate::skin::Posed;
use crate::surface::{ClusterBoxes, Clusters, FillBoxes, SurfaceMesh};

/// A bone that weighs less than this at a vertex (1) does not make it a part of its limb.
const LEAST_WEIGHT: f32 = 0.02;

/// When a vertex has moved farther than this in a step (m), the body has been put somewhere else and has not swept what lies
/// between.
const TELEPORT_M: f32 = 0.5;

/// A limb: what capsules and triangles belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyPart {
    /// Head, trunk and pelvis.
    Trunk,
    /// Left upper arm.
    LeftArm,
    /// Right upper arm.
    RightArm,
    /// Left forearm and hand.
    LeftHand,
    /// Right forearm and hand.
    RightHand,
    /// Left leg.
    LeftLeg,
    /// Right leg.
    RightLeg,
}

impl BodyPart {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Trunk, Self::LeftArm, Self::RightArm, Self::LeftHand, Self::RightHand, Self::LeftLeg, Self::RightLeg];

    /// Its place in [`BodyPart::ALL`].
    fn index(self) -> usize {
        Self::ALL.iter().position(|limb| *limb == self).unwrap_or(0)
    }

    /// The limb that a bone belongs to; the shoulder girdle and the pelvis are the trunk's.
    pub fn of_bone(bone: u8) -> Self {
        use Joint::*;
        const SIDES: [(BodyPart, &[Joint]); 6] = [
            (BodyPart::LeftArm, &[LeftShoulder]),
            (BodyPart::RightArm, &[RightShoulder]),
            (BodyPart::LeftHand, &[LeftElbow, LeftWrist, LeftHand]),
            (BodyPart::RightHand, &[RightElbow, RightWrist, RightHand]),
            (BodyPart::LeftLeg, &[LeftHip, LeftKnee, LeftAnkle, LeftToe]),
            (BodyPart::RightLeg, &[RightHip, RightKnee, RightAnkle, RightToe]),
        ];
        let joint = bone_joint(bone.into());
        SIDES.into_iter().find(|(_, joints)| joints.iter().any(|j| Some(*j) == joint)).map_or(Self::Trunk, |(l, _)| l)
    }

    /// Whether cloth on a part of the body can touch it.
    pub fn touches(self, part: Part) -> bool {
        use BodyPart::{LeftArm, LeftHand, LeftLeg, RightArm, RightHand, RightLeg, Trunk};
        match part {
            // Forearms and hands that brush a skirt are met as capsules: fingers would catch cloth.
            Part::All => !matches!(self, LeftHand | RightHand),
            Part::Hollow => false,
            Part::Trunk => !matches!(self, LeftArm | RightArm | LeftHand | RightHand),
            Part::LeftArm => matches!(self, LeftArm | LeftHand),
            Part::RightArm => matches!(self, RightArm | RightHand),
            Part::LeftLeg => matches!(self, LeftLeg | Trunk),
            Part::RightLeg => matches!(self, RightLeg | Trunk),
        }
    }

    /// Whether this limb's surface goes on into another's, so that on either side of the joint both are the same body.
    pub fn joins(self, other: Self) -> bool {
        use BodyPart::{LeftArm, LeftHand, LeftLeg, RightArm, RightHand, RightLeg, Trunk};
        let one_way = |a, b| match a {
            Trunk => matches!(b, LeftArm | RightArm | LeftLeg | RightLeg),
            LeftArm => b == LeftHand,
            RightArm => b == RightHand,
            _ => false,
        };
        self == other || one_way(self, other) || one_way(other, self)
    }
}

/// What cloth on one part of the body meets.
#[derive(Debug, Clone, PartialEq)]
pub struct PartSurface {
    /// The part.
    pub part: Part,
    /// Its triangles, by the places of their vertices.
    pub mesh: SurfaceMesh,
    /// Its vertices in groups.
    pub clusters: Clusters,
    /// Where these are.
    pub boxes: ClusterBoxes,
    /// How far the fastest of its vertices moved in the step before (m); infinite where the body was put somewhere else.
    pub moved: f32,
}

/// The skinned triangles of one body. Vertices are counted by their places in what skinning writes.
#[derive(Debug, Clone, PartialEq)]
pub struct BodySurface {
    parts: Box<[PartSurface]>,
    /// The limb of each vertex `[places]`.
    limbs: Box<[BodyPart]>,
    /// Which limbs the vertices of each [`MOST`] places belong to, one bit each in the order of [`BodyPart::ALL`].
    limbs_at: Box<[u8]>,
    /// Square of how far the fastest vertex of each limb moved in the step before (m2).
    moved2: [f32; BodyPart::ALL.len()],
    start: [Store; 3],
    /// Positions (m) and normals at the end of the step.
    end: [Store; 6],
    width: Width,
    placed: bool,
}

impl BodySurface {
    /// The surface of a body for some parts of garments; `posed` is what its skinning writes. At load.
    pub fn new(body: &Body, posed: &Posed, parts: &[Part]) -> Self {
        let places = posed.places();
        let mut start = vec![glam::Vec3::ZERO; places];
        let mut limbs = vec![BodyPart::Trunk; places];
        for (v, (p, weights)) in body.mesh.positions.iter().zip(&body.weights).enumerate() {
            let place = posed.place(v) as usize;
            start[place] = *p;
            limbs[place] = heaviest(weights);
        }
        let surface = |part: Part| {
            let mine = |v: u32| {
                let Some(weights) = body.weights.get(v as usize) else { return false };
                let pairs = weights.bones.iter().zip(weights.weights);
                pairs.into_iter().any(|(b, w)| w > LEAST_WEIGHT && BodyPart::of_bone(*b).touches(part))
            };
            let kept = body.mesh.triangles.iter().filter(|t| t.iter().all(|&v| mine(v)));
            let triangles: Vec<[u32; 3]> = kept.map(|t| t.map(|v| posed.place(v as usize))).collect();
            let mesh = SurfaceMesh::new(&triangles, places);
            let clusters = Clusters::new(&mesh, &start);
            PartSurface { part, boxes: ClusterBoxes::new(&clusters), clusters, mesh, moved: f32::INFINITY }
        };
        let mut different: Vec<Part> = Vec::new();
        for &part in parts {
            if part != Part::Hollow && !different.contains(&part) {
                different.push(part);
            }
        }
        Self {
            parts: different.into_iter().map(surface).collect(),
            limbs_at: limbs.chunks(MOST).map(|l| l.iter().fold(0, |bits, l| bits | 1 << l.index())).collect(),
            limbs: limbs.into(),
            moved2: [f32::INFINITY; BodyPart::ALL.len()],
            start: [(); 3].map(|()| Store::zeros(places)),
            end: [(); 6].map(|()| Store::zeros(places)),
            width: Width::widest(),
            placed: false,
        }
    }

    /// Moves the end of the last step to the start of this one, and the end to what skinning has posed. The first placement
    /// sets both.
    pub fn place(&mut self, posed: &Posed) {
        let [x, y, z, ..] = &mut self.end;
        let ends = [x, y, z];
        self.start.iter_mut().zip(ends).for_each(|(start, end)| std::mem::swap(start, end));
        // The end is still where the last step started.
        let [x, y, z, ..] = &self.end;
        let before = [x, y, z].map(|c| ReadColumn::new(c.as_slice()));
        self.moved2 = self.width.run(FastestOfLimbs { from: before, to: columns(&self.start), limbs: &self.limbs_at });
        posed.columns_to(self.end.each_mut().map(Store::as_mut));
        if !self.placed || self.jumped() {
            let Self { start, end, .. } = self;
            start.iter_mut().zip(end).for_each(|(start, end)| start.as_mut().copy_from_slice(end.as_slice()));
            self.placed = true;
            self.moved2 = [f32::INFINITY; BodyPart::ALL.len()];
        }
        let Self { parts, start, width, moved2, .. } = self;
        for PartSurface { part, clusters, boxes, moved, .. } in parts {
            let mine = BodyPart::ALL.iter().zip(&*moved2).filter(|(limb, _)| limb.touches(*part));
            *moved = mine.map(|(_, moved2)| *moved2).fold(0.0, f32::max).sqrt();
            width.run(FillBoxes { clusters, surface: columns(start), boxes });
        }
    }

    /// Whether the body was put somewhere else: its first vertices tell.
    fn jumped(&self) -> bool {
        let far = |i: usize| {
            let moved = |k: usize| self.end[k].as_slice()[i] - self.start[k].as_slice()[i];
            moved(0) * moved(0) + moved(1) * moved(1) + moved(2) * moved(2) > TELEPORT_M * TELEPORT_M
        };
        let looked = (0..self.limbs.len()).step_by(97);
        let count = looked.len();
        looked.filter(|&i| far(i)).count() * 2 > count
    }

    /// Forgets where the body was: the next placement sets start and end alike.
    pub fn reset(&mut self) {
        self.placed = false;
    }

    /// Which of the parts cloth on a part of the body meets; none where it meets nothing, or where nothing was placed yet.
    pub fn of(&self, part: Part) -> Option<&PartSurface> {
        if self.placed { self.parts.iter().find(|p| p.part == part && !p.mesh.is_empty()) } else { None }
    }

    /// Positions at the start of the step (m) `[places]`.
    pub fn start(&self) -> [ReadColumn<'_>; 3] {
        columns(&self.start)
    }

    /// Positions at its end (m) `[places]`.
    pub fn end(&self) -> [ReadColumn<'_>; 3] {
        let [x, y, z, ..] = &self.end;
        [x, y, z].map(|c| ReadColumn::new(c.as_slice()))
    }

    /// Unit normals at its end `[places]`.
    pub fn normals(&self) -> [ReadColumn<'_>; 3] {
        let [.., x, y, z] = &self.end;
        [x, y, z].map(|c| ReadColumn::new(c.as_slice()))
    }

    /// A vertex at the end of the step (m).
    pub fn vertex(&self, place: u32) -> Vec3A {
        let [x, y, z, ..] = &self.end;
        Vec3A::from_array([x, y, z].map(|c| c.as_slice()[place as usize]))
    }

    /// The limb of a vertex.
    pub fn limb(&self, place: u32) -> BodyPart {
        self.limbs[place as usize]
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        let part = |p: &PartSurface| p.mesh.bytes() + p.clusters.bytes() + p.boxes.bytes();
        self.parts.iter().map(part).sum::<usize>()
            + self.start.iter().chain(&self.end).map(Store::bytes).sum::<usize>()
            + size_of_val(&*self.limbs)
            + size_of_val(&*self.limbs_at)
    }
}

/// The square of how far the fastest vertex of each limb moves (m2); a vertex near a limb may count as its own.
struct FastestOfLimbs<'a> {
    from: [ReadColumn<'a>; 3],
    to: [ReadColumn<'a>; 3],
    limbs: &'a [u8],
}

impl Kernel for FastestOfLimbs<'_> {
    type Out = [f32; BodyPart::ALL.len()];

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Out {
        let mut most = [0.0f32; BodyPart::ALL.len()];
        let mut at = 0;
        for &limbs in self.limbs {
            let end = (at + MOST).min(self.to[0].len());
            let mut fastest = L::splat(0.0);
            while at < end {
                let n = (end - at).min(L::N);
                let moved = V3::<L>::load(self.to, at, n) - V3::<L>::load(self.from, at, n);
                fastest = fastest.max(moved.dot(moved));
                at += n;
            }
            let fastest = -(-fastest).least();
            for (limb, most) in most.iter_mut().enumerate() {
                *most = if limbs >> limb & 1 == 1 { most.max(fastest) } else { *most };
            }
        }
        most
    }
}

fn columns(of: &[Store; 3]) -> [ReadColumn<'_>; 3] {
    of.each_ref().map(|c| ReadColumn::new(c.as_slice()))
}

/// The limb of the bone that weighs most.
fn heaviest(weights: &SkinWeights) -> BodyPart {
    let pairs = weights.bones.iter().zip(weights.weights);
    pairs.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(BodyPart::Trunk, |(b, _)| BodyPart::of_bone(*b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bones_belong_to_limbs_and_limbs_to_parts() {
        let limb = |joint: Joint| BodyPart::of_bone(joint.index() as u8);
        assert_eq!(limb(Joint::LeftShoulder), BodyPart::LeftArm);
        assert_eq!(limb(Joint::RightWrist), BodyPart::RightHand);
        assert_eq!(limb(Joint::RightKnee), BodyPart::RightLeg);
        assert!(BodyPart::LeftHand.touches(Part::LeftArm) && !BodyPart::LeftHand.touches(Part::Trunk));
        assert!(BodyPart::Trunk.touches(Part::RightLeg) && !BodyPart::LeftLeg.touches(Part::RightLeg));
        assert!(!BodyPart::Trunk.touches(Part::Hollow) && !BodyPart::LeftHand.touches(Part::All));
        assert!(BodyPart::LeftHand.joins(BodyPart::LeftArm) && BodyPart::RightLeg.joins(BodyPart::Trunk));
        assert!(!BodyPart::LeftHand.joins(BodyPart::Trunk) && !BodyPart::LeftLeg.joins(BodyPart::RightLeg));
    }
}
